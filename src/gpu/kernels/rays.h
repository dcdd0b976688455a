/* gpu/kernels/rays.h - finds where a pixel's ray meets a sheet, and where it enters and leaves the volume's
 * box. The functions compute for one pixel the same numbers as view/rays_lanes.h for sixteen. */
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

/* Returns whether the sheet lies ahead of the view's origin, or at most `reach` behind it. */
DEVICE int is_ahead(GLOBAL const plan_rays *rays, float climb, float reach) {
  return fused(magnitude(climb), reach, climb * rays->step) > 0.0f;
}

/* The length of the ray's way from one sheet to the next; 0 behind the view's origin. */
DEVICE float path_through_sheet(GLOBAL const plan_rays *rays, int perspective, float path, float u, float v) {
  if (!perspective) return path;
  vector w = direction_of(rays, u, v);
  float climb = climb_of(rays, u, v);
  float way = divided(root(dot3(w, w)), magnitude(climb)) * path;
  return is_ahead(rays, climb, 0.0f) ? way : 0.0f;
}

/* The section of a ray from `first` to `last`, in units of the ray's own direction vector. */
typedef struct ray_section {
  float first, last;
} ray_section;

DEVICE ray_section section_in_box(GLOBAL const plan_box *box, float u, float v) {
  ray_section section;
  section.first = box->least;
  section.last = 1e30f;
  for (int axis = 0; axis < 3; axis++) {
    float start = linear_in_view(box->start[axis], box->start_u[axis], box->start_v[axis], u, v);
    float direction = linear_in_view(box->direction[axis], box->direction_u[axis], box->direction_v[axis], u,
                                     v);
    if (magnitude(direction) < 1e-12f) direction = 1e-12f;
    float a = divided(box->low[axis] - start, direction), b = divided(box->high[axis] - start, direction);
    section.first = greater(section.first, lesser(a, b));
    section.last = lesser(section.last, greater(a, b));
  }
  return section;
}

/* The section of a ray within the unit sphere: the roots s of |start + s direction| = 1. */
DEVICE ray_section roots_of_sphere(vector start, vector direction) {
  float squared = dot3(direction, direction), along = dot3(start, direction);
  float rest = fused(along, along, squared * (1.0f - dot3(start, start))), size = root(greater(rest, 0.0f));
  ray_section section;
  section.first = rest > 0.0f ? divided(-along - size, squared) : 1e30f;
  section.last = rest > 0.0f ? divided(size - along, squared) : -1e30f;
  return section;
}

DEVICE ray_section section_in_sphere(GLOBAL const plan_box *box, float u, float v) {
  ray_section section = roots_of_sphere(
      linear_vector(box->start, box->start_u, box->start_v, u, v),
      linear_vector(box->direction, box->direction_u, box->direction_v, u, v));
  section.first = greater(section.first, box->least);
  return section;
}

/* The heights at which a ray enters the box and leaves it. */
typedef struct heights_in_box {
  float enter, leave;
} heights_in_box;

DEVICE heights_in_box heights_of(GLOBAL const plan_box *box, float u, float v) {
  const ray_section section = CUTS && box->sphere ? section_in_sphere(box, u, v) : section_in_box(box, u, v);
  float base = linear_in_view(box->start_height, box->start_height_u, box->start_height_v, u, v);
  float climb = linear_in_view(box->climb, box->climb_u, box->climb_v, u, v);
  float a = fused(section.first, climb, base), b = fused(section.last, climb, base);
  const int missed = section.first > section.last;
  heights_in_box heights;
  heights.enter = missed ? 1e30f : lesser(a, b);
  heights.leave = missed ? -1e30f : greater(a, b);
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
