/* fill/mask_lanes.h - what a mask multiplies a volume's extinction by, at sixteen points. */
#ifndef HL_FILL_MASK_LANES_H
#define HL_FILL_MASK_LANES_H

#include "grid/mask_lattice.h"
#include "view/rays_lanes.h"

/* point: frame space. Linear between the lattice's points; `rest` outside the lattice. */
LANES_INLINE lanes mask_factor(const mask_lattice *lattice, lanes3 point) {
  lanes_int near[3], far[3], outside = lanes_set_int(0);
  lanes part[3];
  for (int a = 0; a < 3; a++) {
    lanes at = row_of_point(lattice->to_index[a], point);
    float last = (float)lattice->last[a];
    outside |= (at < -0.5f) | (at > last + 0.5f);
    at = lanes_clamp(at, 0, last);
    lanes_int first = lanes_truncate(at), next = first + 1, end = lanes_set_int(lattice->last[a]);
    part[a] = at - lanes_from_int(first);
    near[a] = first * lattice->step[a];
    far[a] = lanes_select_int(next > end, end, next) * lattice->step[a];
  }
  lanes plane[2];
  for (int k = 0; k < 2; k++) {
    lanes line[2];
    for (int j = 0; j < 2; j++) {
      lanes_int a, b; /* where the lattice ends, b is any number, with the weight 0 */
      lanes_gather_short_pairs(lattice->factors, near[0] + (j ? far[1] : near[1]) + (k ? far[2] : near[2]),
                               &a, &b);
      line[j] = lanes_fma(lanes_from_int(b - a), part[0], lanes_from_int(a));
    }
    plane[k] = lanes_fma(line[1] - line[0], part[1], line[0]);
  }
  lanes factor = lanes_fma(plane[1] - plane[0], part[2], plane[0]) * (1.0f / 65535);
  return lanes_select(outside, lanes_set(lattice->rest), factor);
}

#endif
