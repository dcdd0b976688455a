/* fill/mask_lanes.h - finds the factor by which a mask multiplies a volume's extinction, at sixteen
 * points. */
#ifndef HL_FILL_MASK_LANES_H
#define HL_FILL_MASK_LANES_H

#include "grid/mask_lattice.h"
#include "simd/gathers.h"
#include "view/rays_lanes.h"

/* The cells of a mask's lattice in which sixteen points lie, and the points' places within these cells. */
typedef struct mask_places {
  lanes_int cell[3], outside;
  lanes part[3];
} mask_places;

/* Finds the cells of the mask's lattice in which points of frame space lie. Points outside the lattice are
 * moved to its border. */
LANES_INLINE mask_places places_in_mask(const mask_lattice *lattice, lanes3 point) {
  mask_places p = {.outside = lanes_set_int(0)};
  for (int a = 0; a < 3; a++) {
    lanes at = row_of_point(lattice->to_index[a], point);
    float last = (float)lattice->last[a];
    p.outside |= (at < -0.5f) | (at > last + 0.5f);
    at = lanes_clamp(at, 0, last);
    p.cell[a] = lanes_truncate(at);
    p.part[a] = at - lanes_from_int(p.cell[a]);
  }
  return p;
}

/* Finds, along each axis, the lattice's points before and after the places, as offsets in points from the
 * lattice's first point. */
LANES_INLINE void points_of_places(const mask_lattice *lattice, const mask_places *p, lanes_int near[3],
                                   lanes_int far[3]) {
  for (int a = 0; a < 3; a++) {
    lanes_int next = p->cell[a] + 1, end = lanes_set_int(lattice->last[a]);
    near[a] = p->cell[a] * lattice->step[a];
    far[a] = lanes_select_int(next > end, end, next) * lattice->step[a];
  }
}

/* The offsets, in bytes from the first brick of a mask's lattice, of the bricks that hold the points. */
LANES_INLINE lanes_int bricks_of_places(const mask_lattice *lattice, const mask_places *p) {
  lanes_int at = lanes_set_int(0);
  for (int a = 0; a < 3; a++) at += (p->cell[a] >> HL_MASK_BRICK_SHIFT) * lattice->brick_step[a];
  return at * (int32_t)sizeof *lattice->bricks;
}

/* Loads the first 32-bit word (`word` is 0) or the second one (`word` is 1) of each lane's brick. bricks: the
 * bricks' offsets in bytes. */
LANES_INLINE lanes_int words_of_bricks(const mask_lattice *lattice, lanes_int bricks, int word) {
  return lanes_gather_bytes((const unsigned char *)&lattice->bricks[0][word], bricks);
}

/* Interpolates the mask's factor linearly between the lattice's points. The result is in the steps in which
 * factors are stored. */
LANES_INLINE lanes steps_between_points(const mask_lattice *lattice, const mask_places *p) {
  lanes_int near[3], far[3];
  lanes plane[2];
  points_of_places(lattice, p, near, far);
  for (int k = 0; k < 2; k++) {
    lanes line[2];
    for (int j = 0; j < 2; j++) {
      /* a, b: neighbouring points along an axis; at the lattice's end, b is an arbitrary number with the
       * weight 0 */
      lanes_int a, b;
      lanes_gather_short_pairs(lattice->factors, near[0] + (j ? far[1] : near[1]) + (k ? far[2] : near[2]),
                               &a, &b);
      line[j] = lanes_fma(lanes_from_int(b - a), p->part[0], lanes_from_int(a));
    }
    plane[k] = lanes_fma(line[1] - line[0], p->part[1], line[0]);
  }
  return lanes_fma(plane[1] - plane[0], p->part[2], plane[0]);
}

/* The mask's factor at points of frame space: linear between the lattice's points, and `rest` outside the
 * lattice. Only active lanes get a result. If all factors of a brick are equal, the result is this factor,
 * which linear interpolation would give, too. */
LANES_INLINE lanes mask_factor(const mask_lattice *lattice, lanes3 point, uint32_t active) {
  mask_places p = places_in_mask(lattice, point);
  lanes_int words = words_of_bricks(lattice, bricks_of_places(lattice, &p), 0);
  lanes steps = lanes_from_int(words & 0xffff);
  if ((lanes_bits((words & HL_MASK_EVEN) == 0) & active) != 0) steps = steps_between_points(lattice, &p);
  lanes factor = lanes_clamp(lanes_line(steps, lattice->scale, lattice->offset), 0, 1);
  return lanes_select(p.outside, lanes_set(lattice->rest), factor);
}

/* The depth of points of frame space behind the walls of a mesh of cells, for a mask whose lattice stores
 * this depth: the factor before it is clamped to [0, 1], less 1/2. The depth is negative beyond the walls. */
LANES_INLINE lanes depth_behind_walls(const mask_lattice *lattice, lanes3 point) {
  mask_places p = places_in_mask(lattice, point);
  lanes depth = lanes_line(steps_between_points(lattice, &p), lattice->scale, lattice->offset) - 0.5f;
  return lanes_select(p.outside, lanes_set(-0.5f), depth);
}

/* Interpolates the slopes of the mask's factor linearly between the lattice's points. A slope is the change
 * of the factor per step of the lattice along an axis. */
LANES_INLINE void slopes_between_points(const mask_lattice *lattice, const mask_places *p, lanes sum[3]) {
  lanes_int near[3], far[3];
  points_of_places(lattice, p, near, far);
  for (int corner = 0; corner < 8; corner++) {
    lanes_int at = lanes_set_int(0);
    lanes share = lanes_set(1.0f);
    for (int a = 0; a < 3; a++) {
      at += corner >> a & 1 ? far[a] : near[a];
      share = share * (corner >> a & 1 ? p->part[a] : 1.0f - p->part[a]);
    }
    lanes_int word = lanes_gather_bytes((const unsigned char *)lattice->slopes, at * 4);
    for (int a = 0; a < 3; a++) sum[a] = lanes_fma(share, lanes_from_int(word << (24 - 8 * a) >> 24), sum[a]);
  }
}

/* The factor's slope at points of frame space, per frame unit, linear between the slopes of the lattice's
 * points. Only active lanes get a result. */
LANES_INLINE lanes3 mask_slope(const mask_lattice *lattice, lanes3 point, uint32_t active) {
  mask_places p = places_in_mask(lattice, point);
  lanes sum[3] = {lanes_set(0), lanes_set(0), lanes_set(0)};
  lanes3 slope = {lanes_set(0), lanes_set(0), lanes_set(0)};
  lanes_int words = words_of_bricks(lattice, bricks_of_places(lattice, &p), 0);
  if ((lanes_bits((words & HL_MASK_EVEN) == 0) & active) == 0) return slope;
  slopes_between_points(lattice, &p, sum);
  for (int a = 0; a < 3; a++)
    slope = add_scaled3(slope, set3(lattice->to_index[a]),
                        lanes_select(p.outside, lanes_set(0), sum[a] * lattice->slope_scale));
  return slope;
}

#endif
