/* render/target.h - describes the pixels that the back ends make: pixels of the picture, pixels of its
 * layers, and the values of a maximum projection. */
#ifndef HL_RENDER_TARGET_H
#define HL_RENDER_TARGET_H

#include "plan/frame_plan.h"
#include "render/layers.h"
#include "render/renderer_state.h"
#include "render/slab.h"

typedef struct frame_target {
  float *pixels; /* [sweeps][tiles][16][4][16]; zeros at the start; the target's own pixels, or the caller's
                  * pixels if in_place is true */
  bool in_place;
  float *tile_rows; /* if in_place is true: [threads][tiles_x][16][4][16]; room to reorder rows of tiles */
  layer_pixels layers;
  maximum_values maximum; /* the values of a maximum projection; if its member `values` is null, the picture
                           * shows lit matter */
} frame_target;

/* Makes a frame's target. target: must be zeros before, and must be released after an error, too. */
hl_status hl_frame_target_create(hl_renderer *renderer, const frame_request *request, const frame_plan *plan,
                                 frame_target *target, hl_error *error);
void hl_frame_target_release(hl_renderer *renderer, frame_target *target);

/* A sweep's pixels. */
float *hl_frame_target_pixels(const frame_target *target, const frame_plan *plan, int sweep);
/* Sets all pixels of the picture to zero again. */
void hl_frame_target_clear(hl_renderer *renderer, const frame_plan *plan, frame_target *target);
/* Fills the caller's pixels and layers. */
void hl_frame_target_write(hl_renderer *renderer, const frame_request *request, const frame_plan *plan,
                           frame_target *target);

#endif
