/* render/estimate.h - estimates the memory that a frame will take. A frame that cannot fit into memory is
 * refused before it begins. */
#ifndef HL_RENDER_ESTIMATE_H
#define HL_RENDER_ESTIMATE_H

#include <halflight/render.h>

#include "render/prepare.h"
#include "render/sweep.h"

/* Counts the bytes of the volumes that are not prepared yet. Call hl_prepared_release_stale() before. */
void hl_prepare_count(const hl_scene_description *scene, const prepared_volume *prepared,
                      const grid_functions *functions, int threads, hl_layout *layout);

/* The bytes that the counted sweeps of a frame take together. */
size_t hl_sweeps_bytes(const sweeps_memory *sweeps);

/* Returns whether `bytes` more bytes fit below the context's limit. *estimate is raised to the number of
 * bytes that the context would hold then. */
hl_status hl_check_room(const hl_context *context, uint64_t bytes, uint64_t *estimate, hl_error *error);

/* The greatest number of bytes that the context was expected to hold during the last frame. It includes the
 * bytes held before the frame. */
uint64_t hl_renderer_estimate(const hl_renderer *renderer);

#endif
