/* surface/triangle.h - functions for triangles alone: their normals, and where rays meet them. They are
 * inlined into loops. */
#ifndef HL_SURFACE_TRIANGLE_H
#define HL_SURFACE_TRIANGLE_H

#include "mesh/mesh.h"
#include "surface/primitive.h"

/* A triangle's unit normal. *from: receives the distance of `point` from the triangle's plane, above 0 on the
 * normal's side. */
vec3 hl_triangle_normal(const surfaces *all, uint32_t triangle, vec3 point, double *from);

/* Functions of the table in primitive.h for triangles that are in files of their own: `count`, `lay_out` and
 * `place` (triangle_place.c), `look` (triangle_look.c) and `bend` (late/triangle_bend.c). */
size_t hl_triangle_count(const hl_mesh_description *mesh);
void hl_triangle_lay_out(surfaces *made, hl_layout *layout);
void hl_triangle_place(hl_pool *pool, surfaces *made, const surface_mesh *mesh);
vec3 hl_triangle_look(const surfaces *all, const surface_mesh *mesh, uint32_t triangle, vec3 at, vec3 *normal,
                      double color[3]);
double hl_triangle_bend(const surfaces *all, const surface_mesh *mesh, uint32_t triangle, vec3 at,
                        vec3 normal, vec3 along);

/* The normal at a corner of a triangle: at a sharp edge the triangle's own normal, else the vertex's
 * normal. */
static inline vec3 hl_corner_normal(const surfaces *all, const surface_mesh *mesh, uint32_t triangle, int i) {
  uint32_t edge = mesh->edges != NULL ? mesh->edges[triangle - mesh->primitives[PRIMITIVE_triangle].first][i]
                                      : HL_NO_EDGE;
  return hl_surface_vector(edge != HL_NO_EDGE ? all->edge_normals[mesh->first_edge_normal + edge]
                                              : all->normals[all->triangles[triangle][i]]);
}

/* The normal at corner i that is interpolated over the triangle. It lies on the same side as `flat`, the
 * triangle's own normal. */
static inline vec3 hl_rounded_normal(const surfaces *all, const surface_mesh *mesh, uint32_t triangle, int i,
                                     vec3 flat) {
  vec3 own = hl_corner_normal(all, mesh, triangle, i);
  double along = vec3_dot(own, flat);
  if (fabs(along) < HL_MESH_ROUNDED) return flat;
  return along < 0 ? vec3_scale(own, -1) : own;
}

/* Finds where a ray meets a triangle, by Moeller and Trumbore, "Fast, minimum storage ray/triangle
 * intersection" (1997). */
static inline int hl_meet_triangle(const surfaces *all, uint32_t primitive, const surface_ray *ray,
                                   double distance[2]) {
  const uint32_t *corners = all->triangles[primitive];
  vec3 a = hl_surface_vector(all->positions[corners[0]]),
       ab = vec3_subtract(hl_surface_vector(all->positions[corners[1]]), a),
       ac = vec3_subtract(hl_surface_vector(all->positions[corners[2]]), a);
  vec3 p = vec3_cross(ray->way, ac), away = vec3_subtract(ray->origin, a), q = vec3_cross(away, ab);
  double determinant = vec3_dot(ab, p);
  if (determinant == 0) return false;
  double u = vec3_dot(away, p) / determinant, v = vec3_dot(ray->way, q) / determinant;
  *distance = vec3_dot(ac, q) / determinant;
  return u >= 0 && v >= 0 && u + v <= 1 && *distance > ray->first && *distance < ray->last;
}

#endif
