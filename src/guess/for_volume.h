/* guess/for_volume.h - chooses the default camera and the default light of a scene. */
#ifndef HL_GUESS_FOR_VOLUME_H
#define HL_GUESS_FOR_VOLUME_H

#include "scene/scene.h"

/* The camera of a scene that gives no camera: a three-quarter view that frames the volumes. Type and fovy_deg
 * are kept. */
hl_status hl_scene_frame(const hl_scene_description *description, hl_camera *camera, hl_error *error);

/* Smooths a bare volume if its voxels would show as stairs, terraces or grain (smoothing.h), provided that
 * the memory limit leaves room for smoothing. *smoothed: owned by the caller; null if the volume is not
 * smoothed. */
hl_status hl_smooth_where_needed(hl_volume *volume, const char *file, hl_volume **smoothed, hl_error *error);

/* The light of a scene that gives no light: a soft light from the camera's upper left, which moves with the
 * camera. */
void hl_scene_key_light(hl_light *light);

/* The colours, linear RGB, of lamps that make the lit side of objects warm and the rest cool. The two colours
 * together are nearly white. */
#define HL_WARM_LIGHT \
  { 1.06, 1, 0.92 }
#define HL_COOL_LIGHT \
  { 0.90, 0.98, 1.12 }

/* The key light of bare volumes and meshes: the light of hl_scene_key_light(), in a warm colour. */
void hl_scene_warm_key_light(double intensity, hl_light *light);

/* A fill light from the eye, without shadows. The caller sets its intensity. */
void hl_scene_fill_light(hl_light *light);

/* The bytes that the memory limit must leave free beside voxels, so that a scene gets a sky. The sky's field
 * and the scratch memory for making the field take less than half of these bytes. */
#define HL_ROOM_FOR_SKY (512u << 20)

/* A scene with more sheets than this may get a warning. A single volume of 2048 cubic voxels along each side
 * has fewer sheets. */
#define HL_MANY_SHEETS 4096

/* Chooses a dark grey as the background of a scene that gives no background. */
void hl_scene_choose_background(hl_scene_description *description);

/* Constant light beside a sky, as a fraction of the sky's strength, so that no hollow is black. */
#define BESIDE_SKY 0.04

/* Chooses a cool sky that is brighter above than below, so that folds and hollows are darker, and a little
 * constant light beside the sky. With the strength 0, the scene gets neither a sky nor constant light. */
void hl_scene_choose_sky(double strength, hl_scene_description *description);

#endif
