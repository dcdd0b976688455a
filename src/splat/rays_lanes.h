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

LANES_INLINE lanes3 rays_linear(const float at[3], const float by_u[3], const float by_v[3], lanes u, lanes v) {
  return (lanes3){u * by_u[0] + (v * by_v[0] + at[0]), u * by_u[1] + (v * by_v[1] + at[1]),
                  u * by_u[2] + (v * by_v[2] + at[2])};
}

/* W of a perspective view's rays, not normalised. */
LANES_INLINE lanes3 rays_directions(const sheet_rays *rays, lanes u, lanes v) {
  return rays_linear(rays->w0, rays->wu, rays->wv, u, v);
}

LANES_INLINE lanes3 rays_positions(const sheet_rays *rays, lanes u, lanes v) {
  lanes3 p = rays_linear(rays->p0, rays->pu, rays->pv, u, v);
  if (!rays->perspective) return p;
  lanes s = 1.0f / (u * rays->hu + (v * rays->hv + rays->h0));
  return (lanes3){p.x * s + rays->base[0], p.y * s + rays->base[1], p.z * s + rays->base[2]};
}

#endif
