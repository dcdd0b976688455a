/* render/estimate.h - the memory that a frame will take, so that one that cannot fit is refused before it
 * begins. */
#ifndef HL_RENDER_ESTIMATE_H
#define HL_RENDER_ESTIMATE_H

#include <halflight/render.h>

#include "render/sweep.h"

/* The bytes that the volumes that are not prepared yet take at most. Call hl_prepared_release_stale() before.
 */
uint64_t hl_prepare_bytes(const hl_scene_description *scene, const prepared_volume *prepared,
                          const grid_functions *functions, int threads);

/* The bytes that the picture and its layers take. sweep_count: how many sweeps keep pixels of their own. */
uint64_t hl_pixels_bytes(const frame *frame, int sweep_count, const hl_layers *layers);

/* The bytes that the sweeps take together: buffers stay, the rest is released or shared. sweeps: [count]. */
uint64_t hl_sweeps_bytes(const sweep_bytes *sweeps, int count, bool with_layers);

/* Whether so many bytes more fit below the context's limit; *estimate is raised to the bytes then held. */
hl_status hl_check_room(const hl_context *context, uint64_t bytes, uint64_t *estimate, hl_error *error);

/* The most that the last frame was expected to hold through the context, what was held before included. */
uint64_t hl_renderer_estimate(const hl_renderer *renderer);

#endif
