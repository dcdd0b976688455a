/* tests/unit/scene_parts.h - what the scene tests share: a context, small volumes, a description. */
#ifndef SCENE_PARTS_H
#define SCENE_PARTS_H

#include <stdlib.h>
#include <string.h>

#include "guess/for_volume.h"
#include "scene/scene.h"
#include "small_volume.h"

/* A float volume of n^3 voxels of unit size with its first voxel at 0: values are copied. */
static inline hl_volume *make_volume(hl_context *context, size_t n, const float *values) {
  return volume_of_voxels(context, n, n, n, HL_VOXEL_F32, values);
}

/* A scene with one light, which projects an image, and one volume, in storage that the tests may change. */
typedef struct parts {
  hl_context *context;
  hl_volume *volume;
  hl_opacity_point opacity[4];
  hl_color_point color[3];
  float slide[6];
  float glow[12];
  hl_light light;
  hl_scene_volume scene_volume;
  hl_scene_description description;
} parts;

static inline void parts_make(parts *p) {
  float values[27];
  for (int v = 0; v < 27; v++) values[v] = (float)v;
  memset(p, 0, sizeof *p);
  p->context = make_context();
  p->volume = make_volume(p->context, 3, values);
  for (int n = 0; n < 4; n++) p->opacity[n] = (hl_opacity_point){8.0 * n, 0.25 * n};
  for (int n = 0; n < 3; n++) p->color[n] = (hl_color_point){10.0 * n, {0.5 * n, 0.25 * n, 1 - 0.5 * n}};
  for (int n = 0; n < 6; n++) p->slide[n] = 0.2f * (float)n;
  hl_light_defaults(&p->light);
  p->light.texture = (hl_light_texture){"slide.png", p->slide, 2, 1, {0, 0, 9}, {2, 0, 0}, {0, 1, 0}};
  hl_scene_volume_defaults(&p->scene_volume);
  p->scene_volume.name = "cube";
  p->scene_volume.volume = p->volume;
  p->scene_volume.transfer_function = (hl_transfer_function){
      .unit_distance = 1, .opacity = p->opacity, .opacity_count = 4, .color = p->color, .color_count = 3};
  hl_scene_description_defaults(&p->description);
  p->description.lights = &p->light;
  p->description.light_count = 1;
  p->description.volumes = &p->scene_volume;
  p->description.volume_count = 1;
}

static inline void parts_release(parts *p) {
  hl_volume_release(p->volume);
  assert_int_equal(hl_context_memory_held(p->context), 0);
  hl_context_destroy(p->context);
}

#endif
