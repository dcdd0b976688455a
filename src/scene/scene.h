/* scene/scene.h - struct hl_scene: a checked deep copy of a description. */
#ifndef HL_SCENE_SCENE_H
#define HL_SCENE_SCENE_H

#include <stdatomic.h>

#include <halflight/scene.h>

#include "scene/camera.h"
#include "scene/placement.h"
#include "scene/transfer_function.h"
#include "volume/volume.h"

struct hl_scene {
  hl_context *context;
  atomic_int references;
  hl_scene_description description; /* its arrays and texts are owned by the scene */
  hl_scene_description
      placed; /* the same with all lights in the world, for rendering; owns its array of lights */
};

/* Frees the pixels and file names of a light's texture and emission, where they are owned. */
void hl_light_images_release(hl_context *context, hl_light *light);

#endif
