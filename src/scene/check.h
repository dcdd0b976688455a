/* scene/check.h - is a description possible? Limits that several checks share; the range of each setting is
 * in settings.c. */
#ifndef HL_SCENE_CHECK_H
#define HL_SCENE_CHECK_H

#include <halflight/layers.h>
#include <halflight/scene.h>

#define HL_LIMIT_PIXELS         32768 /* image width and height */
#define HL_LIMIT_LIGHTS         256
#define HL_LIMIT_VOLUMES        256
#define HL_LIMIT_VERTICES       1024  /* of one polygon */
#define HL_LIMIT_TEXTURE_SIDE   32768 /* pixels of a light's texture */
#define HL_LIMIT_TEXTURE_PIXELS (1 << 26)
#define HL_LIMIT_POINTS         65536 /* of one transfer function */
#define HL_LIMIT_LENGTH         1e15  /* any coordinate or length: squares and cubes stay finite */
#define HL_LIMIT_CORNER \
  1e14 /* of a volume from the origin: a camera that frames it stands within HL_LIMIT_LENGTH */
#define HL_LIMIT_INTENSITY \
  1e35 /* where light falls with the square of a distance that may be in nanometres */
#define HL_LIMIT_BRIGHTNESS \
  1e20 /* of a light a smallest voxel's edge away: what floats hold with materials and sums */
#define HL_LIMIT_REACH         1e12 /* distances and lengths, in smallest voxel edges */
#define HL_LIMIT_TEXTURE_VALUE 1e6
#define HL_LIMIT_VOXEL_VALUE   1e36 /* differences and sums of these are floats */
#define HL_LIMIT_LIGHT_SAMPLES 64
#define HL_LIMIT_THREADS       1024
#define HL_LIMIT_SHININESS     10000
#define HL_LIMIT_EMISSION      1e6
#define HL_LIMIT_EXPOSURE      32 /* stops, either way */

/* Every field of a description; the first fault is reported as "JSON pointer: what is wrong: the mend". */
hl_status hl_description_check(const hl_scene_description *description, hl_error *error);

/* One volume of a description, before a camera is to frame it. */
hl_status hl_scene_volume_check(const hl_scene_volume *volume, size_t index, hl_error *error);

/* One transfer function; place is what errors call it ("/volumes/0/transfer_function"). */
hl_status hl_transfer_function_check(const hl_transfer_function *function, const char *place,
                                     hl_error *error);

/* The layers that a frame of this scene is asked for; null: none. */
hl_status hl_layers_check(const hl_layers *layers, const hl_scene_description *scene, hl_error *error);

#endif
