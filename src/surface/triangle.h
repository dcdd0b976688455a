/* surface/triangle.h - where a ray meets a triangle, for loops that inline it. */
#ifndef HL_SURFACE_TRIANGLE_H
#define HL_SURFACE_TRIANGLE_H

#include "surface/primitive.h"

/* Moeller and Trumbore, "Fast, minimum storage ray/triangle intersection" (1997). */
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
