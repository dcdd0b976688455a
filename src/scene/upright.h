/* scene/upright.h - which way up a volume is, where its file cannot say. */
#ifndef HL_SCENE_UPRIGHT_H
#define HL_SCENE_UPRIGHT_H

#include "core/vector.h"
#include "scene/automatic.h"

/* The view of azimuth 0: up, and where the picture's right is; unit axes of the world, perpendicular. And the
 * three-quarter view: which azimuth shows most. */
typedef struct hl_upright { vec3 up, right; double azimuth_deg; } hl_upright;

/* Known orientation (a NIfTI file; axes that are not the grid's own) is kept: z is up, and the eye is in
 * front, where NIfTI has +y. Smoke comes from computer graphics, where y is up. Scanned things without
 * orientation stand on, or are cut off by, their bottom; heads and vessels are mirrored left to right, never
 * top to bottom. Else z is up. Of the four three-quarter views the one is taken whose sides have the most
 * relief, so that heads show their faces. Fails for lack of memory and when cancelled. */
hl_status hl_scene_upright(const hl_scene_volume *volume, const hl_data_analysis *analysis, hl_upright *upright,
                           hl_error *error);

/* hl_camera_frame() with another view of azimuth 0. */
hl_status hl_camera_frame_upright(const hl_scene_description *description, hl_upright upright,
                                  double azimuth_deg, double elevation_deg, double zoom, hl_camera *camera);

#endif
