/* render/estimate.c - see estimate.h. Adds up the memory of hl_prepare_volumes(), the frame and
 * hl_sweep_begin(). It leaves out light textures and the lists of splatted voxels. Their sizes are known only
 * when they are made; the memory limit may refuse them then. */
#include "render/estimate.h"

#include "core/context.h"

enum { SMALL_PARTS = 64 << 10 /* descriptions, sweeps, corners, counts */ };

void hl_prepare_count(const hl_scene_description *scene, const prepared_volume *prepared,
                      const grid_functions *functions, int threads, hl_layout *layout) {
  hl_layout_take(layout, SMALL_PARTS, 1);
  for (size_t i = 0; i < scene->volume_count; i++)
    if (prepared[i].volume == NULL)
      hl_prepared_count(&scene->volumes[i], scene->render.kernel, functions, threads, layout);
}

size_t hl_sweeps_bytes(const sweeps_memory *sweeps) {
  hl_layout all = {.bytes = sweeps->buffers.bytes};
  for (int i = 0; i < FRAME_LIGHTS; i++) hl_layout_take(&all, sweeps->kept[i], 1);
  hl_layout_take(&all, sweeps->passing.most, 1);
  hl_layout_take(&all, SMALL_PARTS, 1);
  return all.bytes;
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
