/* surface/sphere_coverage.c - see sphere_coverage.h. */
#include "surface/sphere_coverage.h"

#include <string.h>

#include "surface/sample_rows.h"

enum { SAMPLES = 16 };

/* The ray A + s B of a pixel, from the sphere's centre; both are linear in the pixel. */
typedef struct centred_rays {
  vec3 start, start_u, start_v, way, way_u, way_v;
  double radius;
} centred_rays;

static centred_rays rays_about(const view *view, const float sphere[4]) {
  vec3 zero = {0, 0, 0}, centre = hl_surface_vector(sphere);
  centred_rays rays = {.radius = sphere[3]};
  if (view->perspective) {
    rays.start = vec3_subtract(view->origin, centre);
    rays.start_u = rays.start_v = zero;
    rays.way = view->corner, rays.way_u = view->du, rays.way_v = view->dv;
  } else {
    rays.start = vec3_subtract(view->corner, centre);
    rays.start_u = view->du, rays.start_v = view->dv;
    rays.way = view->direction, rays.way_u = rays.way_v = zero;
  }
  return rays;
}

static vec3 at_pixel(vec3 at, vec3 by_u, vec3 by_v, double u, double v) {
  return vec3_add(at, vec3_add(vec3_scale(by_u, u), vec3_scale(by_v, v)));
}

/* |A + s B|^2 = r^2 is B.B s^2 + 2 A.B s + A.A - r^2 = 0: a ray meets the sphere where the quarter of its
 * discriminant is at least 0. That of a parallel view is a quadratic function of the pixel: p + q (u, v). */
static double discriminant(const centred_rays *rays, double u, double v) {
  vec3 a = at_pixel(rays->start, rays->start_u, rays->start_v, u, v),
       b = at_pixel(rays->way, rays->way_u, rays->way_v, u, v);
  double along = vec3_dot(a, b);
  return along * along - vec3_dot(b, b) * (vec3_dot(a, a) - rays->radius * rays->radius);
}

static int clamp_pixel(double pixel) { return pixel < 0 ? 0 : pixel > TILE - 1 ? TILE - 1 : (int)pixel; }

/* The quadratic function c0 + c1 u + c2 v + c3 uu + c4 uv + c5 vv that the discriminant is, from its values
 * about a point: exact for both kinds of views, in which it has degree 2 (derived: in a perspective view A is
 * constant; in a parallel one B is). */
typedef struct quadratic {
  double c[6];
} quadratic;

static quadratic quadratic_of(const centred_rays *rays, double u, double v) {
  double m = discriminant(rays, u, v), e = discriminant(rays, u + 1, v), w = discriminant(rays, u - 1, v),
         s = discriminant(rays, u, v + 1), n = discriminant(rays, u, v - 1),
         se = discriminant(rays, u + 1, v + 1);
  return (quadratic){{m, (e - w) / 2, (s - n) / 2, (e + w) / 2 - m, se - e - s + m, (s + n) / 2 - m}};
}

static uint32_t cover_pixel(const quadratic *q, double u, double v) {
  uint32_t bits = 0;
  for (int s = 0; s < SAMPLES; s++) {
    double x = u + (s + 0.5) / SAMPLES, y = v + (SAMPLE_ROWS[s] + 0.5) / SAMPLES;
    double value = q->c[0] + x * (q->c[1] + x * q->c[3] + y * q->c[4]) + y * (q->c[2] + y * q->c[5]);
    bits |= (uint32_t)(value >= 0) << s;
  }
  return bits;
}

bool hl_cover_sphere(const view *view, const float sphere[4], const seen_bounds *bounds, int tile_x,
                     int tile_y, pixel_span *span, uint16_t covered[TILE_PIXELS]) {
  double left = (double)tile_x * TILE, top = (double)tile_y * TILE;
  if (bounds->u1 < left || bounds->v1 < top || bounds->u0 >= left + TILE || bounds->v0 >= top + TILE)
    return false;
  centred_rays rays = rays_about(view, sphere);
  *span = (pixel_span){clamp_pixel(floor(bounds->u0 - left)), clamp_pixel(floor(bounds->v0 - top)),
                       clamp_pixel(floor(bounds->u1 - left)), clamp_pixel(floor(bounds->v1 - top))};
  double u = left + (span->x0 + span->x1 + 1) / 2.0, v = top + (span->y0 + span->y1 + 1) / 2.0;
  quadratic q = quadratic_of(&rays, u, v);
  uint32_t any = 0;
  for (int row = span->y0; row <= span->y1; row++)
    for (int column = span->x0; column <= span->x1; column++) {
      uint32_t bits = cover_pixel(&q, left + column - u, top + row - v);
      covered[row * TILE + column] = (uint16_t)bits;
      any |= bits;
    }
  return any != 0;
}

bool hl_meet_sphere(const view *view, const float sphere[4], double u, double v, bool leaving, vec3 *point) {
  centred_rays rays = rays_about(view, sphere);
  vec3 a = at_pixel(rays.start, rays.start_u, rays.start_v, u, v),
       b = at_pixel(rays.way, rays.way_u, rays.way_v, u, v);
  double along = vec3_dot(a, b), bb = vec3_dot(b, b), root = sqrt(fmax(discriminant(&rays, u, v), 0));
  double s = (leaving ? -along + root : -along - root) / bb;
  vec3 from_centre = vec3_add(a, vec3_scale(b, s));
  *point = vec3_add(hl_surface_vector(sphere), from_centre);
  return !view->perspective || s > 0;
}
