/* analytic/mesh_stage.h - small scenes of meshes, built in code. */
#ifndef MESH_STAGE_H
#define MESH_STAGE_H

#include "reference_stage.h"

enum { STAGE_MESHES = 4 };

/* A stage with meshes, and with a transparent volume of one voxel in the middle, whose voxel sets the
 * distance of the sheets. */
typedef struct mesh_stage {
  stage set;
  hl_scene_mesh meshes[STAGE_MESHES]; /* each mesh holds a reference to its hl_mesh */
} mesh_stage;

/* Opens a stage without meshes. side: of the picture, in pixels. height: of the picture, in world units. The
 * eye looks along -z in parallel, and y is up. */
void mesh_stage_open(mesh_stage *all, int side, double height);
void mesh_stage_close(mesh_stage *all);

/* Adds a white, diffuse mesh, which the stage then owns. */
hl_scene_mesh *mesh_stage_add(mesh_stage *all, hl_mesh *made);

/* Adds a mesh from a description. The test fails if the description is refused. */
hl_scene_mesh *mesh_stage_describe(mesh_stage *all, const hl_mesh_description *description);

/* Sets the shadows. kind: 0: hard shadows; 1: soft shadows of the directional light by the cascade; 2: soft
 * shadows by the paper's method; 3: soft shadows by sub-lights. The directional light gets the angular
 * diameter. */
void mesh_stage_choose_shadows(mesh_stage *all, hl_light *light, int kind, double diameter_deg);

#endif
