/* render/sky.h - a frame's sky: collects the input of the sky's field, and checks whether the last frame's
 * field still fits this input. */
#ifndef HL_RENDER_SKY_H
#define HL_RENDER_SKY_H

#include "field/sky_field.h"
#include "plan/frame.h"
#include "render/prepare.h"

/* The scene that a frame's sky lights. */
typedef struct frame_sky {
  const hl_scene_description *scene; /* in frame space */
  const prepared_volume *volumes;    /* [scene->volume_count] */
  const grid *grids;                 /* [scene->volume_count] */
  const frame *frame;
  uint64_t mark;                  /* identifies the pixels of the sky's image */
  const light_exchange *exchange; /* the exchange of light with the other parts of the picture; if null, this
                                   * renderer finds all light by itself */
} frame_sky;

/* Checks whether the sky's field fits a frame, and makes it anew if it does not fit. Without a sky the field
 * is released. room: a function that is called before memory is taken, and that may refuse the memory. */
typedef struct sky_room {
  hl_status (*check)(void *data, uint64_t bytes, hl_error *error);
  void *data;
} sky_room;

hl_status hl_frame_sky_update(hl_context *context, hl_pool *pool, const hot_functions *hot,
                              const frame_sky *of, const sky_room *room, sky_field *field, hl_error *error);

#endif
