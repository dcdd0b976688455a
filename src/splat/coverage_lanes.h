/* splat/coverage_lanes.h - rays against a box (slab method), and the covered part of a sheet. */
#ifndef HL_SPLAT_COVERAGE_LANES_H
#define HL_SPLAT_COVERAGE_LANES_H

#include "splat/coverage.h"
#include "splat/fill.h"
#include "splat/rays_lanes.h"

static void coverage_tile(const box_rays *rays, int tile_x, int tile_y, float *enter, float *leave) {
  for (int block = 0; block < TILE_BLOCKS; block++) {
    lanes u = block_u(tile_x * TILE + block % 4 * BLOCK), v = block_v(tile_y * TILE + block / 4 * BLOCK);
    lanes first = lanes_set(rays->least), last = lanes_set(1e30f);
    for (int axis = 0; axis < 3; axis++) {
      lanes start = linear_in_view(rays->start[axis], rays->start_u[axis], rays->start_v[axis], u, v);
      lanes direction = linear_in_view(rays->direction[axis], rays->direction_u[axis],
                                       rays->direction_v[axis], u, v);
      /* a ray along the slab: a tiny direction sends both crossings far out on the right sides */
      direction = lanes_select(lanes_abs(direction) < 1e-12f, lanes_set(1e-12f), direction);
      lanes a = (rays->low[axis] - start) / direction, b = (rays->high[axis] - start) / direction;
      first = lanes_max(first, lanes_min(a, b));
      last = lanes_min(last, lanes_max(a, b));
    }
    lanes base = linear_in_view(rays->start_height, rays->start_height_u, rays->start_height_v, u, v);
    lanes climb = linear_in_view(rays->climb, rays->climb_u, rays->climb_v, u, v);
    lanes a = lanes_fma(first, climb, base), b = lanes_fma(last, climb, base);
    lanes_int missed = first > last;
    lanes_store(enter + block * BLOCK_PIXELS, lanes_select(missed, lanes_set(1e30f), lanes_min(a, b)));
    lanes_store(leave + block * BLOCK_PIXELS, lanes_select(missed, lanes_set(-1e30f), lanes_max(a, b)));
  }
}

/* Where the covered part of the slab [height - spacing, height] begins and how long it is, in slabs. */
typedef struct covered_part {
  lanes begin, length;
} covered_part;

LANES_INLINE covered_part covered(lanes enter, lanes leave, float height, float spacing) {
  lanes top = lanes_min(leave, lanes_set(height));
  lanes bottom = lanes_max(enter, lanes_set(height - spacing));
  return (covered_part){lanes_min((bottom - (height - spacing)) * (1.0f / spacing), lanes_set(1.0f)),
                        lanes_max((top - bottom) * (1.0f / spacing), lanes_set(0))};
}

#endif
