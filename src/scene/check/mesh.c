/* scene/check/mesh.c - checks a mesh of a scene: its settings, and the places of its corners. */
#include <math.h>
#include <stdio.h>

#include "mesh/mesh.h"
#include "scene/check/check.h"
#include "scene/geometry/placement.h"

/* Checks that the placed mesh lies within the part of the world whose coordinates floats can hold. */
static hl_status check_corners(const hl_checker *check, const hl_scene_mesh *mesh) {
  const hl_mesh *triangles = mesh->mesh;
  affine3 placement = hl_scene_mesh_to_world(mesh);
  for (int corner = 0; corner < 8; corner++) {
    vec3 at = affine3_apply(placement, (vec3){corner & 1 ? triangles->high[0] : triangles->low[0],
                                              corner & 2 ? triangles->high[1] : triangles->low[1],
                                              corner & 4 ? triangles->high[2] : triangles->low[2]});
    double farthest = fmax(fmax(fabs(at.x), fabs(at.y)), fabs(at.z));
    if (!(farthest <= HL_LIMIT_CORNER))
      return hl_check_refuse(check, "transform",
                             "moves the mesh farther than 1e14 from the origin: move or scale it");
  }
  return HL_OK;
}

hl_status hl_scene_mesh_check(const hl_scene_mesh *mesh, size_t index, hl_error *error) {
  hl_checker check = {error, ""};
  snprintf(check.place, sizeof check.place, "/meshes/%zu", index);
  if (mesh->mesh == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "%s/mesh: is null: give a mesh", check.place);
  hl_status status = hl_check_settings(&check, HL_SETTINGS_MESH, mesh, 0);
  if (status == HL_OK) {
    hl_checker material = {error, ""};
    snprintf(material.place, sizeof material.place, "/meshes/%zu/material", index);
    status = hl_check_settings(&material, HL_SETTINGS_MATERIAL, &mesh->material, 0);
  }
  return status == HL_OK ? check_corners(&check, mesh) : status;
}
