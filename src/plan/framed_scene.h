/* plan/framed_scene.h - converts a scene to frame space. The origin of frame space is the middle of the
 * scene's volumes, and its unit of length is about the volumes' smallest voxel edge. */
#ifndef HL_PLAN_FRAMED_SCENE_H
#define HL_PLAN_FRAMED_SCENE_H

#include <halflight/scene.h>

#include "core/error.h"
#include "scene/scene.h"

/* A scene in frame space. Its lights, volumes and meshes stand in the order of frames (scene/order.h). */
typedef struct framed_scene {
  hl_scene_description
      scene; /* the scene in frame space; voxels, images and texts are borrowed from the scene in the world */
  hl_scene_volume *volumes;    /* owned; [volume_count]; the volumes in frame space */
  hl_light *lights;            /* owned; [light_count]; the lights in frame space */
  hl_scene_mesh *meshes;       /* owned; [mesh_count], with room for the volumes' isosurfaces; the meshes
                                * in frame space */
  int *mesh_objects;           /* owned; [mesh_count], with room for the volumes' isosurfaces; the number of
                                * each mesh in the layer of objects */
  const scene_order *order;    /* borrowed; the place of each light, volume and mesh in the lists of the scene
                                * in the world */
  double (*vertices)[3];       /* owned; the vertices of all polygonal lights */
  hl_opacity_point *gradients; /* owned; the points of gradient opacity, of all volumes */
  hl_cut *cuts;                /* owned; the cuts of the volumes */
  /* owned; [light_count]; for a light that is a sun of the sky, the fraction of its light that lights media;
   * 0 for other lights */
  double *sun_parts;
  uint64_t *plane_marks; /* owned; [volume_count]; marks of functions of two numbers: functions with different
                          * contents have different marks */
  double unit; /* the length in the world of one unit of frame space; the smallest voxel edge is 1 to 2 such
                * units long */
} framed_scene;

/* Makes the framed scene of a scene. scene: borrowed; must live as long as the framed scene. */
hl_status hl_framed_scene_create(hl_context *context, const hl_scene *scene, framed_scene *framed,
                                 hl_error *error);
void hl_framed_scene_release(hl_context *context, framed_scene *framed);

#endif
