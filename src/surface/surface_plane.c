/* surface/surface_plane.c - see surface_plane.h. */
#include "surface/surface_plane.h"

#include "surface/small_triangles.h"

static void set_linear(double f[3], vec3 normal, vec3 at, vec3 by_u, vec3 by_v) {
  f[0] = vec3_dot(normal, at), f[1] = vec3_dot(normal, by_u), f[2] = vec3_dot(normal, by_v);
}

void hl_plane_begin(const view *view, const sheet_stack *sheets, surface_plane *plane) {
  vec3 zero = {0, 0, 0}, h = sheets->normal;
  bool eye = view->perspective;
  set_linear(plane->above, h, eye ? view->origin : view->corner, eye ? zero : view->du,
             eye ? zero : view->dv);
  set_linear(plane->climb, h, eye ? view->corner : view->direction, eye ? view->du : zero,
             eye ? view->dv : zero);
  plane->above[0] -= sheets->first;
}

/* Sets the plane through a point, after hl_plane_begin(). n: the plane's normal. */
static void set_plane(const view *view, vec3 n, vec3 point, surface_plane *plane) {
  vec3 zero = {0, 0, 0};
  bool eye = view->perspective;
  set_linear(plane->rise, vec3_scale(n, -1), vec3_subtract(eye ? view->origin : view->corner, point),
             eye ? zero : view->du, eye ? zero : view->dv);
  set_linear(plane->way, n, eye ? view->corner : view->direction, eye ? view->du : zero,
             eye ? view->dv : zero);
}

void hl_plane_of_triangle(const view *view, const sheet_stack *sheets, const surfaces *all, uint32_t triangle,
                          surface_plane *plane) {
  const uint32_t *corner = all->triangles[triangle];
  vec3 point[3];
  for (int i = 0; i < 3; i++) point[i] = hl_surface_vector(all->positions[corner[i]]);
  vec3 n = vec3_normalise(vec3_cross(vec3_subtract(point[1], point[0]), vec3_subtract(point[2], point[0])));
  hl_plane_begin(view, sheets, plane);
  set_plane(view, n, point[0], plane);
  plane->lowest = INFINITY, plane->highest = -INFINITY;
  for (int i = 0; i < 3; i++) {
    double height = vec3_dot(sheets->normal, point[i]) - sheets->first;
    plane->lowest = fmin(plane->lowest, height);
    plane->highest = fmax(plane->highest, height);
  }
}

void hl_plane_of_sphere(const view *view, const sheet_stack *sheets, const float sphere[4], vec3 point,
                        surface_plane *plane) {
  hl_plane_begin(view, sheets, plane);
  hl_plane_touch_sphere(view, sheets, sphere, point, plane);
}

void hl_plane_touch_sphere(const view *view, const sheet_stack *sheets, const float sphere[4], vec3 point,
                           surface_plane *plane) {
  vec3 centre = hl_surface_vector(sphere);
  double middle = vec3_dot(sheets->normal, centre) - sheets->first;
  set_plane(view, vec3_normalise(vec3_subtract(point, centre)), point, plane);
  plane->lowest = middle - sphere[3];
  plane->highest = middle + sphere[3];
}

double hl_plane_height(const surface_plane *plane, double u, double v) {
  return hl_plane_linear(plane->above, u, v) + hl_plane_linear(plane->rise, u, v) /
                                                   hl_plane_linear(plane->way, u, v) *
                                                   hl_plane_linear(plane->climb, u, v);
}

double hl_plane_slope(const surface_plane *plane, double u, double v) {
  double height = hl_plane_height(plane, u, v);
  double slope = fabs(hl_plane_height(plane, u + 1, v) - height) +
                 fabs(hl_plane_height(plane, u, v + 1) - height);
  return slope < STEEPEST_SLOPE ? slope : STEEPEST_SLOPE; /* a slope that is NaN counts as the steepest
                                                           * slope */
}
