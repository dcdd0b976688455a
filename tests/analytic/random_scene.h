/* analytic/random_scene.h - small random scenes, each made from a seed number. A seed gives the same scene on
 * every machine. */
#ifndef RANDOM_SCENE_H
#define RANDOM_SCENE_H

#include "reference_stage.h"

enum { RANDOM_POINTS = 6, RANDOM_TEXTURE = 4, RANDOM_VERTICES = 6 };

/* Memory that a scene borrows. Each stage needs a random_scene of its own. */
typedef struct random_scene {
  stage set;
  hl_opacity_point opacity[STAGE_VOLUMES][RANDOM_POINTS];
  hl_color_point color[STAGE_VOLUMES][RANDOM_POINTS];
  float texture[STAGE_LIGHTS][RANDOM_TEXTURE * RANDOM_TEXTURE * 3];
  double vertices[STAGE_LIGHTS][RANDOM_VERTICES][3];
} random_scene;

/* Draws one to three volumes of up to ten voxels a side in any orientation, up to four lights of every kind,
 * and a camera outside or inside. Pictures have 16 to 32 pixels a side. Close the scene by
 * stage_close(&scene->set). */
void random_scene_open(random_scene *scene, uint64_t seed);

#endif
