/* surface/sphere_coverage.c - see sphere_coverage.h. */
#include "surface/sphere_coverage.h"

#include <string.h>

#include "surface/sample_rows.h"

enum { SAMPLES = 16 };

sphere_rays hl_sphere_rays(const view *view, const float sphere[4]) {
  vec3 zero = {0, 0, 0}, centre = hl_surface_vector(sphere);
  sphere_rays rays = {.radius = sphere[3], .centre = centre, .perspective = view->perspective};
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

/* A quarter of the discriminant of the equation for s, |A + s B|^2 = r^2, or B.B s^2 + 2 A.B s + A.A - r^2 =
 * 0. The ray A + s B meets the sphere if the discriminant is at least 0. */
static double discriminant(const sphere_rays *rays, double u, double v) {
  vec3 a = at_pixel(rays->start, rays->start_u, rays->start_v, u, v),
       b = at_pixel(rays->way, rays->way_u, rays->way_v, u, v);
  double along = vec3_dot(a, b);
  return along * along - vec3_dot(b, b) * (vec3_dot(a, a) - rays->radius * rays->radius);
}

static int clamp_pixel(double pixel) { return pixel < 0 ? 0 : pixel > TILE - 1 ? TILE - 1 : (int)pixel; }

/* The discriminant as a quadratic function of the pixel: c0 + c1 u + c2 v + c3 uu + c4 uv + c5 vv. The
 * coefficients are found from the discriminant's values around a point. Derived: they are exact for both
 * kinds of views, because A is constant in a perspective view, and B in a parallel view, so that the
 * discriminant has degree 2. */
typedef struct quadratic {
  double c[6];
} quadratic;

static quadratic quadratic_of(const sphere_rays *rays, double u, double v) {
  double m = discriminant(rays, u, v), e = discriminant(rays, u + 1, v), w = discriminant(rays, u - 1, v),
         s = discriminant(rays, u, v + 1), n = discriminant(rays, u, v - 1),
         se = discriminant(rays, u + 1, v + 1);
  return (quadratic){{m, (e - w) / 2, (s - n) / 2, (e + w) / 2 - m, se - e - s + m, (s + n) / 2 - m}};
}

/* A rectangle that holds all covered samples; in pixels, counted from the corner of the current pixel. */
typedef struct sample_bounds {
  double x0, y0, x1, y1;
} sample_bounds;

/* The first column of samples whose middle does not lie before x; 16 if there is no such column. x: in
 * pixels. */
static int first_column(double x) {
  double column = x * SAMPLES - 0.5;
  return column <= 0 ? 0 : column > SAMPLES - 1 ? SAMPLES : (int)column + ((int)column < column);
}

static uint32_t cover_pixel(const quadratic *q, double u, double v, const sample_bounds *within) {
  uint32_t bits = 0;
  int end = first_column(within->x1);
  for (int s = first_column(within->x0); s < end; s++) {
    double row = (SAMPLE_ROWS[s] + 0.5) / SAMPLES, x = u + (s + 0.5) / SAMPLES, y = v + row;
    if (row < within->y0 || row > within->y1) continue;
    double value = q->c[0] + x * (q->c[1] + x * q->c[3] + y * q->c[4]) + y * (q->c[2] + y * q->c[5]);
    bits |= (uint32_t)(value >= 0) << s;
  }
  return bits;
}

/* The number of pixels by which bounds are widened. The errors of rounding are far smaller. */
static const double AROUND = 1e-3;

bool hl_cover_sphere(const view *view, const float sphere[4], const seen_bounds *bounds, int tile_x,
                     int tile_y, pixel_span *span, uint16_t covered[TILE_PIXELS]) {
  double left = (double)tile_x * TILE, top = (double)tile_y * TILE;
  if (bounds->u1 < left || bounds->v1 < top || bounds->u0 >= left + TILE || bounds->v0 >= top + TILE)
    return false;
  sphere_rays rays = hl_sphere_rays(view, sphere);
  *span = (pixel_span){clamp_pixel(floor(bounds->u0 - left)), clamp_pixel(floor(bounds->v0 - top)),
                       clamp_pixel(floor(bounds->u1 - left)), clamp_pixel(floor(bounds->v1 - top))};
  double u = left + (span->x0 + span->x1 + 1) / 2.0, v = top + (span->y0 + span->y1 + 1) / 2.0;
  quadratic q = quadratic_of(&rays, u, v);
  uint32_t any = 0;
  for (int row = span->y0; row <= span->y1; row++)
    for (int column = span->x0; column <= span->x1; column++) {
      const sample_bounds within = {bounds->u0 - AROUND - (left + column), bounds->v0 - AROUND - (top + row),
                                    bounds->u1 + AROUND - (left + column), bounds->v1 + AROUND - (top + row)};
      uint32_t bits = cover_pixel(&q, left + column - u, top + row - v, &within);
      covered[row * TILE + column] = (uint16_t)bits;
      any |= bits;
    }
  return any != 0;
}

bool hl_meet_sphere(const sphere_rays *rays, double u, double v, bool leaving, vec3 *point) {
  vec3 a = at_pixel(rays->start, rays->start_u, rays->start_v, u, v),
       b = at_pixel(rays->way, rays->way_u, rays->way_v, u, v);
  double along = vec3_dot(a, b), bb = vec3_dot(b, b),
         root = sqrt(fmax(along * along - bb * (vec3_dot(a, a) - rays->radius * rays->radius), 0));
  double s = (leaving ? -along + root : -along - root) / bb;
  *point = vec3_add(rays->centre, vec3_add(a, vec3_scale(b, s)));
  return !rays->perspective || s > 0;
}
