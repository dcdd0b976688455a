/* render/sky.h - a frame's sky: what its field is made of, and whether the last frame's still holds. */
#ifndef HL_RENDER_SKY_H
#define HL_RENDER_SKY_H

#include "field/sky_field.h"
#include "plan/frame.h"
#include "render/prepare.h"

/* What a frame's sky lights. */
typedef struct frame_sky {
  const hl_scene_description *scene; /* in frame space */
  const prepared_volume *volumes;    /* [scene->volume_count] */
  const grid *grids;                 /* the same */
  const frame *frame;
  uint64_t mark;                  /* of the pixels of the sky's image */
  const light_exchange *exchange; /* with the other parts of the picture; null: this renderer finds all */
} frame_sky;

/* Checks a field against a frame and makes it anew where it does not fit; without a sky it is released.
 * `room` is asked for the bytes first. */
typedef struct sky_room {
  hl_status (*check)(void *data, uint64_t bytes, hl_error *error);
  void *data;
} sky_room;

hl_status hl_frame_sky_update(hl_context *context, hl_pool *pool, const hot_functions *hot,
                              const frame_sky *of, const sky_room *room, sky_field *field, hl_error *error);

#endif
