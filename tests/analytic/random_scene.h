/* analytic/random_scene.h - small scenes drawn by a number: the same number, the same scene on every
 * machine. */
#ifndef RANDOM_SCENE_H
#define RANDOM_SCENE_H

#include "reference_stage.h"

enum { RANDOM_POINTS = 6, RANDOM_TEXTURE = 4, RANDOM_VERTICES = 6 };

/* What a scene borrows; one per stage. */
typedef struct random_scene {
  stage set;
  hl_opacity_point opacity[STAGE_VOLUMES][RANDOM_POINTS];
  hl_color_point color[STAGE_VOLUMES][RANDOM_POINTS];
  float texture[STAGE_LIGHTS][RANDOM_TEXTURE * RANDOM_TEXTURE * 3];
  double vertices[STAGE_LIGHTS][RANDOM_VERTICES][3];
} random_scene;

/* One to three volumes of up to ten voxels a side in any orientation, up to four lights of every kind, a
 * camera outside or inside, pictures of 16 to 32 pixels a side. Close it with stage_close(&scene->set). */
void random_scene_open(random_scene *scene, uint64_t seed);

#endif
