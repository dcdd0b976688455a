/* analytic/mesh_stage.h - small scenes of meshes, built in code. */
#ifndef MESH_STAGE_H
#define MESH_STAGE_H

#include "reference_stage.h"

enum { STAGE_MESHES = 4 };

/* A stage with meshes, and a clear volume of one voxel in the middle, which tells the size of voxels. */
typedef struct mesh_stage {
  stage set;
  hl_scene_mesh meshes[STAGE_MESHES]; /* each holds a reference to its hl_mesh */
} mesh_stage;

/* No meshes yet; side x side pixels of a square `height` high, seen orthographically along -z, up +y. */
void mesh_stage_open(mesh_stage *all, int side, double height);
void mesh_stage_close(mesh_stage *all);

/* Adds a white, diffuse mesh, which the stage then owns. */
hl_scene_mesh *mesh_stage_add(mesh_stage *all, hl_mesh *made);

/* The same of a description; the test fails where it is refused. */
hl_scene_mesh *mesh_stage_describe(mesh_stage *all, const hl_mesh_description *description);

/* kind 0: hard shadows; 1 to 3: soft ones of the directional light, which gets this angular diameter, by the
 * cascade, the paper's method and sub-lights. */
void mesh_stage_choose_shadows(mesh_stage *all, hl_light *light, int kind, double diameter_deg);

#endif
