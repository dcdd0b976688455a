/* surface/surface_plane.c - see surface_plane.h. */
#include "surface/surface_plane.h"

#include "surface/small_triangles.h"

static void set_linear(double f[3], vec3 normal, vec3 at, vec3 by_u, vec3 by_v) {
  f[0] = vec3_dot(normal, at), f[1] = vec3_dot(normal, by_u), f[2] = vec3_dot(normal, by_v);
}

/* The plane through a point. */
static void set_plane(const view *view, const sheet_stack *sheets, vec3 n, vec3 point, surface_plane *plane) {
  vec3 zero = {0, 0, 0}, h = sheets->normal;
  vec3 a = view->perspective ? view->origin : view->corner,
       b = view->perspective ? view->corner : view->direction;
  vec3 au = view->perspective ? zero : view->du, av = view->perspective ? zero : view->dv;
  vec3 bu = view->perspective ? view->du : zero, bv = view->perspective ? view->dv : zero;
  set_linear(plane->rise, vec3_scale(n, -1), vec3_subtract(a, point), au, av);
  set_linear(plane->way, n, b, bu, bv);
  set_linear(plane->above, h, a, au, av);
  set_linear(plane->climb, h, b, bu, bv);
  plane->above[0] -= sheets->first;
}

void hl_plane_of_triangle(const view *view, const sheet_stack *sheets, const surfaces *all, uint32_t triangle,
                          surface_plane *plane) {
  const uint32_t *corner = all->triangles[triangle];
  vec3 point[3];
  for (int i = 0; i < 3; i++) point[i] = hl_surface_vector(all->positions[corner[i]]);
  vec3 n = vec3_normalise(vec3_cross(vec3_subtract(point[1], point[0]), vec3_subtract(point[2], point[0])));
  set_plane(view, sheets, n, point[0], plane);
  plane->lowest = INFINITY, plane->highest = -INFINITY;
  for (int i = 0; i < 3; i++) {
    double height = vec3_dot(sheets->normal, point[i]) - sheets->first;
    plane->lowest = fmin(plane->lowest, height);
    plane->highest = fmax(plane->highest, height);
  }
}

void hl_plane_of_sphere(const view *view, const sheet_stack *sheets, const float sphere[4], vec3 point,
                        surface_plane *plane) {
  vec3 centre = hl_surface_vector(sphere);
  double middle = vec3_dot(sheets->normal, centre) - sheets->first;
  set_plane(view, sheets, vec3_normalise(vec3_subtract(point, centre)), point, plane);
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
  return slope < STEEPEST_SLOPE ? slope : STEEPEST_SLOPE; /* not a number: the steepest */
}
