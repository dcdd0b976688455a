/* fill/mask_lanes.h - what a mask multiplies a volume's extinction by, at sixteen points. */
#ifndef HL_FILL_MASK_LANES_H
#define HL_FILL_MASK_LANES_H

#include "grid/mask_lattice.h"
#include "view/rays_lanes.h"

/* The lattice's points around sixteen points, in points from the first along each axis, and their parts of
 * the way between them. */
typedef struct mask_places {
  lanes_int near[3], far[3], outside;
  lanes part[3];
} mask_places;

/* point: frame space. Points outside are taken to the border. */
LANES_INLINE mask_places places_in_mask(const mask_lattice *lattice, lanes3 point) {
  mask_places p = {.outside = lanes_set_int(0)};
  for (int a = 0; a < 3; a++) {
    lanes at = row_of_point(lattice->to_index[a], point);
    float last = (float)lattice->last[a];
    p.outside |= (at < -0.5f) | (at > last + 0.5f);
    at = lanes_clamp(at, 0, last);
    lanes_int first = lanes_truncate(at), next = first + 1, end = lanes_set_int(lattice->last[a]);
    p.part[a] = at - lanes_from_int(first);
    p.near[a] = first * lattice->step[a];
    p.far[a] = lanes_select_int(next > end, end, next) * lattice->step[a];
  }
  return p;
}

/* point: frame space. Linear between the lattice's points; `rest` outside the lattice. */
LANES_INLINE lanes mask_factor(const mask_lattice *lattice, lanes3 point) {
  mask_places p = places_in_mask(lattice, point);
  lanes plane[2];
  for (int k = 0; k < 2; k++) {
    lanes line[2];
    for (int j = 0; j < 2; j++) {
      lanes_int a, b; /* where the lattice ends, b is any number, with the weight 0 */
      lanes_gather_short_pairs(lattice->factors,
                               p.near[0] + (j ? p.far[1] : p.near[1]) + (k ? p.far[2] : p.near[2]), &a, &b);
      line[j] = lanes_fma(lanes_from_int(b - a), p.part[0], lanes_from_int(a));
    }
    plane[k] = lanes_fma(line[1] - line[0], p.part[1], line[0]);
  }
  lanes factor = lanes_fma(plane[1] - plane[0], p.part[2], plane[0]) * (1.0f / 65535);
  return lanes_select(p.outside, lanes_set(lattice->rest), factor);
}

/* The factor's slope at points of frame space, per frame unit: linear between those of the lattice's points.
 */
LANES_INLINE lanes3 mask_slope(const mask_lattice *lattice, lanes3 point) {
  mask_places p = places_in_mask(lattice, point);
  lanes sum[3] = {lanes_set(0), lanes_set(0), lanes_set(0)};
  lanes_int words[8], any = lanes_set_int(0);
  lanes3 slope = {lanes_set(0), lanes_set(0), lanes_set(0)};
  for (int corner = 0; corner < 8; corner++) {
    lanes_int at = lanes_set_int(0);
    for (int a = 0; a < 3; a++) at += corner >> a & 1 ? p.far[a] : p.near[a];
    words[corner] = lanes_gather_bytes((const unsigned char *)lattice->slopes, at * 4);
    any |= words[corner];
  }
  if (lanes_bits(any != 0) == 0) return slope;
  for (int corner = 0; corner < 8; corner++) {
    lanes share = lanes_set(1.0f);
    for (int a = 0; a < 3; a++) share = share * (corner >> a & 1 ? p.part[a] : 1.0f - p.part[a]);
    for (int a = 0; a < 3; a++)
      sum[a] = lanes_fma(share, lanes_from_int(words[corner] << (24 - 8 * a) >> 24), sum[a]);
  }
  for (int a = 0; a < 3; a++)
    slope = add_scaled3(slope, set3(lattice->to_index[a]),
                        lanes_select(p.outside, lanes_set(0), sum[a] * (1.0f / 254)));
  return slope;
}

#endif
