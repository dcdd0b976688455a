/* splat/rays_lanes.h - where the pixels of a 4x4 block meet a sheet, sixteen at a time. */
#ifndef HL_SPLAT_RAYS_LANES_H
#define HL_SPLAT_RAYS_LANES_H

#include "simd/lanes.h"
#include "splat/view.h"

typedef struct lanes3 { lanes x, y, z; } lanes3;

static const float block_column[LANES] __attribute__((unused)) = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};
static const float block_row[LANES] __attribute__((unused)) = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};

/* Whole-pixel coordinates of the block whose first pixel is (x, y). */
LANES_INLINE lanes block_u(int x) { return lanes_load(block_column) + (float)x; }
LANES_INLINE lanes block_v(int y) { return lanes_load(block_row) + (float)y; }

/* Directions W = w0 + u wu + v wv of the rays (perspective), or positions (parallel). */
LANES_INLINE lanes3 rays_linear(const sheet_rays *rays, lanes u, lanes v) {
  return (lanes3){u * rays->wu[0] + (v * rays->wv[0] + rays->w0[0]), u * rays->wu[1] + (v * rays->wv[1] + rays->w0[1]),
                  u * rays->wu[2] + (v * rays->wv[2] + rays->w0[2])};
}

LANES_INLINE lanes3 rays_positions(const sheet_rays *rays, lanes u, lanes v) {
  lanes3 p = rays_linear(rays, u, v);
  if (!rays->perspective) return p;
  lanes s = rays->step / (u * rays->hu + (v * rays->hv + rays->h0));
  return (lanes3){p.x * s + rays->origin[0], p.y * s + rays->origin[1], p.z * s + rays->origin[2]};
}

#endif
