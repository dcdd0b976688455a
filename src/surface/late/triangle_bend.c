/* surface/late/triangle_bend.c - finds how the interpolated normal turns within a triangle (triangle.h).
 *
 * In: a triangle of a smooth mesh, and a direction along the triangle. Out: the bend of the surface in this
 * direction. A surface that bends inwards may shade itself (render/late/contact.c). */
#include "surface/late/lateness.h"
#include "surface/triangle.h"

/* The corners of a triangle, with the normals that are interpolated between them. */
typedef struct bent_triangle {
  vec3 at[3], normal[3];
  vec3 cross; /* the cross product of two of the triangle's edges */
} bent_triangle;

static bent_triangle bent_triangle_of(const surfaces *all, const surface_mesh *mesh, uint32_t triangle,
                                      vec3 normal) {
  bent_triangle bent;
  for (int i = 0; i < 3; i++) bent.at[i] = hl_surface_vector(all->positions[all->triangles[triangle][i]]);
  bent.cross = vec3_cross(vec3_subtract(bent.at[1], bent.at[0]), vec3_subtract(bent.at[2], bent.at[0]));
  vec3 flat = vec3_normalise(bent.cross);
  double side = vec3_dot(flat, normal) < 0 ? -1 : 1;
  for (int i = 0; i < 3; i++)
    bent.normal[i] = vec3_scale(hl_rounded_normal(all, mesh, triangle, i, flat), side);
  return bent;
}

/* Finds how much the normal turns, per length, along a direction on the triangle. Derived: the gradient of
 * corner i's weight is cross x edge / cross^2, where `edge` is the edge opposite to the corner. The normal is
 * the weighted sum of the corners' normals. */
static double bend_along(const bent_triangle *bent, vec3 along) {
  vec3 turn = {0, 0, 0};
  double square = vec3_dot(bent->cross, bent->cross);
  if (!(square > 0)) return 0;
  for (int i = 0; i < 3; i++) {
    vec3 edge = vec3_subtract(bent->at[(i + 2) % 3], bent->at[(i + 1) % 3]);
    turn = vec3_add(turn,
                    vec3_scale(bent->normal[i], vec3_dot(vec3_cross(bent->cross, edge), along) / square));
  }
  return -vec3_dot(turn, along);
}

/* Returns whether the surface bends the other way along one of the triangle's edges. If so, the triangle is
 * rough, or a saddle. */
static bool bends_both_ways(const bent_triangle *bent, double bend) {
  for (int i = 0; i < 3; i++) {
    vec3 edge = vec3_subtract(bent->at[(i + 1) % 3], bent->at[i]),
         turn = vec3_subtract(bent->normal[(i + 1) % 3], bent->normal[i]);
    if (vec3_dot(turn, edge) > OTHER_BEND * bend * vec3_dot(edge, edge)) return true;
  }
  return false;
}

double hl_triangle_bend(const surfaces *all, const surface_mesh *mesh, uint32_t triangle, vec3 at,
                        vec3 normal, vec3 along) {
  (void)at;
  if (!mesh->look.smooth) return 0;
  const bent_triangle bent = bent_triangle_of(all, mesh, triangle, normal);
  double bend = bend_along(&bent, along);
  return bends_both_ways(&bent, bend) ? 0 : bend;
}
