/* render/late/hollow.c - see hollow.h. */
#include "render/late/hollow.h"

#include "render/surface_point.h"
#include "surface/late/lateness.h"

static double bend_of_sphere(const float sphere[4], vec3 point, vec3 normal) {
  vec3 inwards = vec3_subtract(hl_surface_vector(sphere), point);
  return (vec3_dot(inwards, normal) > 0 ? 1 : -1) / (double)sphere[3];
}

/* The corners of a triangle, with the normals that are interpolated between them. */
typedef struct bent_triangle {
  vec3 at[3], normal[3];
  vec3 cross; /* of two of its edges */
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

/* Derived: the weight of corner i grows by cross x edge / cross^2 along a way, where `edge` is opposite to
 * it, and the normal is the weighted sum of the corners' own. */
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

/* Whether the triangle bends the other way along one of its edges: then it is rough, or a saddle. */
static bool bends_both_ways(const bent_triangle *bent, double bend) {
  for (int i = 0; i < 3; i++) {
    vec3 edge = vec3_subtract(bent->at[(i + 1) % 3], bent->at[i]),
         turn = vec3_subtract(bent->normal[(i + 1) % 3], bent->normal[i]);
    if (vec3_dot(turn, edge) > OTHER_BEND * bend * vec3_dot(edge, edge)) return true;
  }
  return false;
}

double hl_hollow_bend(const surfaces *all, const surface_batch *batch, int sample, vec3 towards_light) {
  const uint32_t primitive = batch->fragments[sample]->primitive;
  const surface_samples *samples = &batch->samples;
  vec3 point = {samples->position[0][sample], samples->position[1][sample], samples->position[2][sample]},
       normal = {samples->normal[0][sample], samples->normal[1][sample], samples->normal[2][sample]};
  vec3 above = vec3_scale(normal, vec3_dot(towards_light, normal)),
       along = vec3_normalise(vec3_subtract(towards_light, above));
  if (!hl_is_triangle(all, primitive)) {
    const float(*colors)[4] = batch->mesh->sphere_colors;
    const uint32_t sphere = primitive - all->triangle_count;
    bool passes = colors != NULL && colors[sphere - batch->mesh->first_sphere][3] < 1;
    return passes ? 0 : bend_of_sphere(hl_sphere_of(all, primitive), point, normal);
  }
  if (!batch->mesh->scene->smooth) return 0;
  const bent_triangle bent = bent_triangle_of(all, batch->mesh, primitive, normal);
  double bend = bend_along(&bent, along);
  return bends_both_ways(&bent, bend) ? 0 : bend;
}
