/* surface/triangle_look.c - finds the normal and the colour at a point of a triangle (triangle.h).
 *
 * In: a triangle, and a point of its plane. Out: the normal and the colour at this point, interpolated
 * between the triangle's corners. */
#include "surface/triangle.h"

/* The weights of a triangle's corners at a point of its plane. */
static void find_weights(const vec3 corner[3], vec3 cross, vec3 at, double weight[3]) {
  double area = vec3_dot(cross, cross), sum = 0;
  for (int i = 0; i < 3; i++) {
    vec3 a = corner[(i + 1) % 3], b = corner[(i + 2) % 3];
    double part = vec3_dot(cross, vec3_cross(vec3_subtract(a, at), vec3_subtract(b, at)));
    weight[i] = area > 0 ? fmax(part / area, 0) : 1;
    sum += weight[i];
  }
  for (int i = 0; i < 3; i++) weight[i] = sum > 0 ? weight[i] / sum : 1.0 / 3;
}

static vec3 smooth_normal(const surfaces *all, const surface_mesh *mesh, uint32_t triangle,
                          const double weight[3], vec3 flat) {
  vec3 sum = {0, 0, 0};
  for (int i = 0; i < 3; i++)
    sum = vec3_add(sum, vec3_scale(hl_rounded_normal(all, mesh, triangle, i, flat), weight[i]));
  return vec3_normalise(sum);
}

static void interpolate_color(const surface_mesh *mesh, const uint32_t *corner, const double weight[3],
                              double color[3]) {
  for (int c = 0; c < 3; c++) {
    double own = 0;
    for (int i = 0; i < 3; i++) own += weight[i] * mesh->colors[corner[i] - mesh->first_vertex][c];
    color[c] = mesh->look.color[c] * own;
  }
}

vec3 hl_triangle_look(const surfaces *all, const surface_mesh *mesh, uint32_t triangle, vec3 point,
                      vec3 *normal, double color[3]) {
  const uint32_t *corner = all->triangles[triangle];
  vec3 at[3];
  double weight[3];
  for (int i = 0; i < 3; i++) at[i] = hl_surface_vector(all->positions[corner[i]]);
  vec3 cross = vec3_cross(vec3_subtract(at[1], at[0]), vec3_subtract(at[2], at[0])),
       flat = vec3_normalise(cross);
  find_weights(at, cross, point, weight);
  *normal = mesh->look.smooth ? smooth_normal(all, mesh, triangle, weight, flat) : flat;
  if (mesh->face_colors != NULL)
    hl_primitive_color(mesh, mesh->face_colors[triangle - mesh->primitives[PRIMITIVE_triangle].first], color);
  else if (mesh->colors != NULL) interpolate_color(mesh, corner, weight, color);
  else hl_primitive_color(mesh, NULL, color);
  return flat;
}
