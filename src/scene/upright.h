/* scene/upright.h - which way up a volume is, where its file cannot say. */
#ifndef HL_SCENE_UPRIGHT_H
#define HL_SCENE_UPRIGHT_H

#include "core/vector.h"
#include "scene/automatic.h"

/* Up: an axis of the world, or its opposite. And the three-quarter view: which azimuth shows most. */
typedef struct hl_upright {
  vec3 up;
  double azimuth_deg;
} hl_upright;

/* Of a volume whose file has no anatomy. Axes that are not the grid's own are believed: z is up. Smoke comes
 * from computer graphics, where y is up. Scanned things stand on, or are cut off by, their bottom; heads and
 * vessels are mirrored left to right, never top to bottom. Else z is up. Of the four three-quarter views the
 * one is taken whose sides have the most relief, so that heads show their faces. Fails for lack of memory and
 * when cancelled. */
hl_status hl_scene_upright(const hl_scene_volume *volume, const hl_data_analysis *analysis,
                           hl_upright *upright, hl_error *error);

#endif
