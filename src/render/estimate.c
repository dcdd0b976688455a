/* render/estimate.c - see estimate.h. Adds up the memory of hl_prepare_volumes(), the frame and
 * hl_sweep_begin(). Left out are light textures and the lists of splatted voxels: their sizes are known only
 * when they are made, and the memory limit refuses them then. */
#include "render/estimate.h"

#include "core/context.h"
#include "render/prepare.h"

enum { SMALL_PARTS = 64 << 10 /* descriptions, sweeps, corners, counts */ };

uint64_t hl_prepare_bytes(const hl_scene_description *scene, const prepared_volume *prepared,
                          const grid_functions *functions, int threads) {
  uint64_t bytes = SMALL_PARTS;
  for (size_t i = 0; i < scene->volume_count; i++)
    if (prepared[i].volume == NULL)
      bytes += hl_prepared_bytes(&scene->volumes[i], scene->render.kernel, functions, threads);
  return bytes;
}

uint64_t hl_pixels_bytes(const frame *frame, int sweep_count, const hl_layers *layers) {
  uint64_t tiles = (uint64_t)hl_tiles(frame->width) * (uint64_t)hl_tiles(frame->height),
           floats = 4 * (uint64_t)sweep_count;
  if (layers != NULL && layers->ambient != NULL) floats += 4;
  if (layers != NULL && layers->emission != NULL) floats += 4;
  if (layers != NULL && layers->sky != NULL) floats += 4;
  if (layers != NULL && layers->sky_shadow != NULL) floats += 8;
  if (hl_layers_measure(layers)) floats += MEASURES;
  for (int i = 0; i < frame->light_count && layers != NULL; i++) {
    const hl_light_layers light = hl_layers_of_light(layers, &frame->lights[i]);
    floats += light.picture != NULL ? 4 : 0;
    if (light.shadow != NULL) floats += frame->lights[i].light->of_sky > 0 ? 8 : 4;
  }
  return tiles * TILE_PIXELS * floats * sizeof(float);
}

uint64_t hl_sweeps_bytes(const sweep_bytes *sweeps, int count, bool with_layers) {
  uint64_t buffers = 0, passing = 0, memory[FRAME_LIGHTS] = {0};
  for (int s = 0; s < count; s++) {
    buffers += sweeps[s].buffers;
    if (sweeps[s].passing > passing) passing = sweeps[s].passing;
    for (int i = 0; i < FRAME_LIGHTS; i++)
      if (sweeps[s].memory[i] > memory[i]) memory[i] = sweeps[s].memory[i];
  }
  for (int i = 0; i < FRAME_LIGHTS; i++) buffers += memory[i];
  uint64_t white = with_layers ? (CLASSIFIER_ENTRIES + 2) * 4 * sizeof(float) : 0; /* a table of ones */
  return buffers + passing + white + SMALL_PARTS;
}

hl_status hl_check_room(const hl_context *context, uint64_t bytes, uint64_t *estimate, hl_error *error) {
  uint64_t held = hl_context_memory_held(context), limit = context->options.memory_limit;
  if (held + bytes > *estimate) *estimate = held + bytes;
  if (limit == 0 || held + bytes <= limit) return HL_OK;
  double mega = 1 << 20;
  return hl_fail(error, HL_ERROR_MEMORY,
                 "this frame needs about %.1f MiB beside the %.1f MiB held already, the memory limit is %.1f "
                 "MiB: make the "
                 "picture smaller, light_samples fewer or shadow_resolution lower, or raise the limit",
                 (double)bytes / mega, (double)held / mega, (double)limit / mega);
}
