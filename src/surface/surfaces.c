/* surface/surfaces.c - see surfaces.h. */
#include "surface/surfaces.h"

#include <string.h>

#include "mesh/mesh.h"

surface_look hl_surface_look(const hl_scene_mesh *mesh) {
  surface_look look = {.opacity = mesh->opacity,
                       .material = mesh->material,
                       .smooth = mesh->smooth,
                       .two_sided = mesh->two_sided,
                       .visible = mesh->visible,
                       .casts_shadow = mesh->casts_shadow,
                       .receives_shadow = mesh->receives_shadow};
  memcpy(look.color, mesh->color, sizeof look.color);
  memcpy(look.attenuation_color, mesh->attenuation_color, sizeof look.attenuation_color);
  return look;
}

void hl_surface_corners(const surface_mesh *mesh, double least, vec3 corners[8]) {
  const hl_mesh *triangles = mesh->mesh;
  double low[3], high[3];
  for (int axis = 0; axis < 3; axis++) {
    double middle = (triangles->low[axis] + triangles->high[axis]) / 2;
    double half = fmax((triangles->high[axis] - triangles->low[axis]) / 2, least / 2 / mesh->scale);
    low[axis] = middle - half;
    high[axis] = middle + half;
  }
  for (int corner = 0; corner < 8; corner++)
    corners[corner] = affine3_apply(
        mesh->placement,
        (vec3){corner & 1 ? high[0] : low[0], corner & 2 ? high[1] : low[1], corner & 4 ? high[2] : low[2]});
}

bool hl_surface_is_closed(const surface_mesh *mesh) {
  return mesh->mesh->closed && !mesh->is_cut && mesh->look.opacity >= 1;
}

bool hl_surface_takes_all(const surface_mesh *mesh) {
  const double *color = mesh->look.attenuation_color;
  return mesh->look.casts_shadow && mesh->look.opacity >= 1 && mesh->mesh->opaque &&
         fmin(color[0], fmin(color[1], color[2])) >= 1;
}

bool hl_surface_is_opaque(const surface_mesh *mesh) { return !mesh->is_cut && hl_surface_takes_all(mesh); }

bool hl_surface_is_outside(const surface_mesh *mesh, vec3 centre, double radius) {
  vec3 corner[8];
  hl_surface_corners(mesh, 0, corner);
  for (int axis = 0; axis < 3; axis++) {
    vec3 edge = vec3_subtract(corner[1 << axis], corner[0]);
    double at = vec3_dot(vec3_subtract(centre, corner[0]), edge), squared = vec3_dot(edge, edge),
           beside = radius * sqrt(squared);
    if (at + beside < -0.01 * squared || at - beside > 1.01 * squared) return true;
  }
  return false;
}

void hl_surfaces_key_add(hl_key *key, const surfaces *all) {
  for (size_t m = 0; all != NULL && m < all->mesh_count; m++) {
    const surface_mesh *mesh = &all->meshes[m];
    hl_key_add(key, &mesh->mesh->mark, sizeof mesh->mesh->mark);
    hl_key_add_numbers(key, &mesh->look.opacity, 1);
    hl_key_add_numbers(key, mesh->look.attenuation_color, 3);
    hl_key_add_whole(key, 2 * mesh->look.visible + mesh->look.casts_shadow);
    hl_key_add_numbers(key, &mesh->placement.linear.row[0].x, 9);
    hl_key_add_numbers(key, &mesh->placement.offset.x, 3);
    if (mesh->is_cut) hl_cuts_key_add(key, all->cuts, all->cut_count);
  }
}
