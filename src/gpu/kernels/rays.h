/* gpu/kernels/rays.h - where a pixel's ray meets a sheet, and where it enters and leaves the volume's box.
 * The functions do for one pixel what view/rays_lanes.h does for sixteen. */
#ifndef HL_GPU_RAYS_H
#define HL_GPU_RAYS_H

#include "gpu/device_sweep.h"
#include "gpu/kernels/numbers.h"

DEVICE float climb_of(GLOBAL const plan_rays *rays, float u, float v) {
  return linear_in_view(rays->h0, rays->hu, rays->hv, u, v);
}
DEVICE vector direction_of(GLOBAL const plan_rays *rays, float u, float v) {
  return linear_vector(rays->w0, rays->wu, rays->wv, u, v);
}
DEVICE vector position_on(GLOBAL const plan_rays *rays, int perspective, float u, float v) {
  vector p = linear_vector(rays->p0, rays->pu, rays->pv, u, v);
  if (!perspective) return p;
  float s = divided(1.0f, climb_of(rays, u, v));
  return vector_of(fused(p.x, s, rays->base[0]), fused(p.y, s, rays->base[1]), fused(p.z, s, rays->base[2]));
}

/* Whether the sheet lies ahead of the view's origin, or at most `reach` behind it. */
DEVICE int is_ahead(GLOBAL const plan_rays *rays, float climb, float reach) {
  return fused(magnitude(climb), reach, climb * rays->step) > 0.0f;
}

/* The length of the ray's way through one sheet; 0 behind the view's origin. */
DEVICE float path_through_sheet(GLOBAL const plan_rays *rays, int perspective, float path, float u, float v) {
  if (!perspective) return path;
  vector w = direction_of(rays, u, v);
  float climb = climb_of(rays, u, v);
  float way = divided(root(dot3(w, w)), magnitude(climb)) * path;
  return is_ahead(rays, climb, 0.0f) ? way : 0.0f;
}

/* The heights at which the ray enters the box and leaves it. */
typedef struct heights_in_box {
  float enter, leave;
} heights_in_box;

DEVICE heights_in_box heights_of(GLOBAL const plan_box *box, float u, float v) {
  float first = box->least, last = 1e30f;
  for (int axis = 0; axis < 3; axis++) {
    float start = linear_in_view(box->start[axis], box->start_u[axis], box->start_v[axis], u, v);
    float direction = linear_in_view(box->direction[axis], box->direction_u[axis], box->direction_v[axis], u,
                                     v);
    if (magnitude(direction) < 1e-12f) direction = 1e-12f;
    float a = divided(box->low[axis] - start, direction), b = divided(box->high[axis] - start, direction);
    first = greater(first, lesser(a, b));
    last = lesser(last, greater(a, b));
  }
  float base = linear_in_view(box->start_height, box->start_height_u, box->start_height_v, u, v);
  float climb = linear_in_view(box->climb, box->climb_u, box->climb_v, u, v);
  float a = fused(first, climb, base), b = fused(last, climb, base);
  heights_in_box heights;
  heights.enter = first > last ? 1e30f : lesser(a, b);
  heights.leave = first > last ? -1e30f : greater(a, b);
  return heights;
}

/* The part of a slab that lies in the box, as fractions of the slab. */
typedef struct covered_span {
  float begin, length;
} covered_span;

DEVICE covered_span covered(heights_in_box in_box, float height, float spacing) {
  float top = lesser(in_box.leave, height), bottom = greater(in_box.enter, height - spacing);
  covered_span span;
  span.begin = lesser((bottom - (height - spacing)) * divided(1.0f, spacing), 1.0f);
  span.length = greater((top - bottom) * divided(1.0f, spacing), 0.0f);
  return span;
}
DEVICE covered_span whole_slab(void) {
  covered_span span;
  span.begin = 0.0f;
  span.length = 1.0f;
  return span;
}

#endif
