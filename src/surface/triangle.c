/* surface/triangle.c - defines the table of functions for primitives that are triangles (primitive.h). */
#include "surface/triangle.h"
#include "surface/primitive_lattice.h"
#include "surface/primitive_raster.h"

static const float *point_of(const surfaces *all, uint32_t primitive) {
  return all->positions[all->triangles[primitive][0]];
}

static float lower(float a, float b) { return a < b ? a : b; }
static float higher(float a, float b) { return a > b ? a : b; }

static double lesser(double a, double b) { return a < b ? a : b; }
static double greater(double a, double b) { return a > b ? a : b; }

static void bound(const surfaces *all, uint32_t primitive, float low[3], float high[3]) {
  const uint32_t *corners = all->triangles[primitive];
  for (int a = 0; a < 3; a++) {
    low[a] = high[a] = all->positions[corners[0]][a];
    for (int i = 1; i < 3; i++) {
      low[a] = lower(low[a], all->positions[corners[i]][a]);
      high[a] = higher(high[a], all->positions[corners[i]][a]);
    }
  }
}

static double clamped(float opacity) { return fmin(fmax((double)opacity, 0), 1); }

static double opacity(const surfaces *all, const surface_mesh *mesh, uint32_t primitive) {
  double opacity = mesh->look.opacity, sum = 0;
  if (mesh->face_colors != NULL)
    return opacity * clamped(mesh->face_colors[primitive - mesh->primitives[PRIMITIVE_triangle].first][3]);
  if (mesh->colors == NULL) return opacity;
  for (int i = 0; i < 3; i++)
    sum += clamped(mesh->colors[all->triangles[primitive][i] - mesh->first_vertex][3]);
  return opacity * sum / 3;
}

vec3 hl_triangle_normal(const surfaces *all, uint32_t triangle, vec3 point, double *from) {
  vec3 a = hl_surface_vector(all->positions[all->triangles[triangle][0]]),
       normal = hl_surface_normal(all, triangle);
  *from = vec3_dot(normal, vec3_subtract(point, a));
  return normal;
}

static vec3 normal(const surfaces *all, uint32_t primitive, vec3 met, vec3 point, double *from) {
  (void)met;
  return hl_triangle_normal(all, primitive, point, from);
}

static void plane(const view *view, const sheet_stack *sheets, const surfaces *all, uint32_t primitive,
                  vec3 met, surface_plane *plane) {
  (void)met;
  hl_plane_of_triangle(view, sheets, all, primitive, plane);
}

/* Returns whether balls lie, at least in part, on both sides of a triangle's plane. */
static bool parts(const surfaces *all, uint32_t primitive, const hull_ball *balls, int count, double least) {
  double first;
  vec3 normal = hl_triangle_normal(all, primitive, balls[0].at, &first);
  double lowest = first - balls[0].radius, highest = first + balls[0].radius;
  for (int i = 1; i < count; i++) {
    double from = first + vec3_dot(normal, vec3_subtract(balls[i].at, balls[0].at));
    lowest = lesser(lowest, from - balls[i].radius);
    highest = greater(highest, from + balls[i].radius);
  }
  return lowest < -least && highest > least;
}

const primitive_kind hl_primitive_triangle = {.noun = "triangles",
                                              .has_corners = true,
                                              .raster = &hl_raster_triangle,
                                              .lattice = &hl_lattice_triangle,
                                              .count = hl_triangle_count,
                                              .lay_out = hl_triangle_lay_out,
                                              .place = hl_triangle_place,
                                              .point = point_of,
                                              .bound = bound,
                                              .opacity = opacity,
                                              .normal = normal,
                                              .plane = plane,
                                              .look = hl_triangle_look,
                                              .bend = hl_triangle_bend,
                                              .intersect = hl_meet_triangle,
                                              .parts = parts};
