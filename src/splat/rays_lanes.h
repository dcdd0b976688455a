/* splat/rays_lanes.h - where the pixels of a 4x4 block meet a sheet, sixteen at a time. */
#ifndef HL_SPLAT_RAYS_LANES_H
#define HL_SPLAT_RAYS_LANES_H

#include "simd/lanes.h"
#include "splat/view.h"

typedef struct lanes3 {
  lanes x, y, z;
} lanes3;

LANES_INLINE lanes dot3(lanes3 a, lanes3 b) { return lanes_fma(a.x, b.x, lanes_fma(a.y, b.y, a.z * b.z)); }
LANES_INLINE lanes3 scale3(lanes3 a, lanes s) { return (lanes3){a.x * s, a.y * s, a.z * s}; }
LANES_INLINE lanes3 add3(lanes3 a, lanes3 b) { return (lanes3){a.x + b.x, a.y + b.y, a.z + b.z}; }
LANES_INLINE lanes3 set3(const float v[3]) {
  return (lanes3){lanes_set(v[0]), lanes_set(v[1]), lanes_set(v[2])};
}
/* a + b s. */
LANES_INLINE lanes3 add_scaled3(lanes3 a, lanes3 b, lanes s) {
  return (lanes3){lanes_fma(b.x, s, a.x), lanes_fma(b.y, s, a.y), lanes_fma(b.z, s, a.z)};
}

/* A row of an affine map at vectors and at points. */
LANES_INLINE lanes row_of_vector(const float row[4], lanes3 v) {
  return lanes_add_scaled(lanes_add_scaled(v.z * row[2], v.y, row[1]), v.x, row[0]);
}
LANES_INLINE lanes row_of_point(const float row[4], lanes3 p) {
  return lanes_add_scaled(lanes_add_scaled(lanes_line(p.z, row[2], row[3]), p.y, row[1]), p.x, row[0]);
}

static const float block_column[LANES]
    __attribute__((unused)) = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};
static const float block_row[LANES]
    __attribute__((unused)) = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};

/* Whole-pixel coordinates of the block whose first pixel is (x, y). */
LANES_INLINE lanes block_u(int x) { return lanes_load(block_column) + (float)x; }
LANES_INLINE lanes block_v(int y) { return lanes_load(block_row) + (float)y; }

LANES_INLINE lanes linear_in_view(float at, float by_u, float by_v, lanes u, lanes v) {
  return lanes_add_scaled(lanes_line(v, by_v, at), u, by_u);
}
LANES_INLINE lanes3 rays_linear(const float at[3], const float by_u[3], const float by_v[3], lanes u,
                                lanes v) {
  return (lanes3){linear_in_view(at[0], by_u[0], by_v[0], u, v),
                  linear_in_view(at[1], by_u[1], by_v[1], u, v),
                  linear_in_view(at[2], by_u[2], by_v[2], u, v)};
}

/* H = h.W of a perspective view's rays. */
LANES_INLINE lanes rays_climb(const sheet_rays *rays, lanes u, lanes v) {
  return linear_in_view(rays->h0, rays->hu, rays->hv, u, v);
}

/* W of a perspective view's rays, not normalised. */
LANES_INLINE lanes3 rays_directions(const sheet_rays *rays, lanes u, lanes v) {
  return rays_linear(rays->w0, rays->wu, rays->wv, u, v);
}

LANES_INLINE lanes3 rays_positions(const sheet_rays *rays, lanes u, lanes v) {
  lanes3 p = rays_linear(rays->p0, rays->pu, rays->pv, u, v);
  if (!rays->perspective) return p;
  lanes s = 1.0f / rays_climb(rays, u, v);
  return (lanes3){lanes_fma(p.x, s, lanes_set(rays->base[0])), lanes_fma(p.y, s, lanes_set(rays->base[1])),
                  lanes_fma(p.z, s, lanes_set(rays->base[2]))};
}

#endif
