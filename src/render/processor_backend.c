/* render/processor_backend.c - the processors as a back end: each sweep of a plan is run by sweep_loop.c. */
#include "core/context.h"
#include "core/memory.h"
#include "render/backend.h"
#include "render/estimate.h"
#include "render/sweep.h"

static sweep_means means_of(hl_renderer *renderer) {
  return (sweep_means){.context = renderer->context,
                       .pool = renderer->pool,
                       .reserve = &renderer->cache.reserve,
                       .hot = hl_hot_functions(renderer->context->options.instruction_set)};
}

/* The number of bytes of the shadow buffers that the renderer has kept from the frame before. */
static uint64_t kept_buffers(const frame_cache *cache) {
  uint64_t bytes = 0;
  for (size_t i = 0; i < cache->buffer_count; i++) bytes += cache->buffers[i].capacity;
  for (int i = 0; i < FRAME_LIGHTS; i++) bytes += cache->shadow_memory[i].capacity;
  return bytes;
}

/* Refuses, before the first sheet, a frame whose sweeps cannot fit into memory. The picture's memory is
 * allocated already. */
static hl_status prepare(hl_renderer *renderer, const frame_plan *plan, const frame_target *target,
                         hl_error *error) {
  const sweep_means means = means_of(renderer);
  sweeps_memory memory = {0};
  for (int s = 0; s < plan->sweeps.count; s++) {
    const sweep_target of_sweep = {.layers = &target->layers, .maximum = &target->maximum};
    sweep counted;
    hl_sweep_set_up(&counted, &means, plan, &plan->sweeps.list[s], &of_sweep);
    hl_sweep_count_memory(&counted, &memory);
  }
  uint64_t needed = hl_sweeps_bytes(&memory), kept = kept_buffers(&renderer->cache);
  return hl_renderer_check_room(renderer, needed > kept ? needed - kept : 0, error);
}

static hl_status run(hl_renderer *renderer, const frame_plan *plan, int index, frame_target *target,
                     hl_render_statistics *statistics, hl_error *error) {
  const sweep_means means = means_of(renderer);
  const sweep_plan *of = &plan->sweeps.list[index];
  float *pixels = hl_frame_target_pixels(target, plan, index);
  int32_t *shown_from = NULL;
  sweep sweep;
  hl_status status = hl_find_hidden(&means, plan, of, pixels, &shown_from, statistics, error);
  if (status == HL_OK) {
    const sweep_target of_sweep = {pixels, shown_from, &target->layers, &target->maximum};
    hl_sweep_set_up(&sweep, &means, plan, of, &of_sweep);
    status = hl_sweep_begin(&sweep, renderer->cache.buffers, renderer->cache.shadow_memory, error);
    if (status == HL_OK) status = hl_sweep_run(&sweep, error);
    if (status == HL_OK) hl_sweep_count(&sweep, statistics);
    hl_sweep_end(&sweep);
  }
  hl_release(renderer->context, shown_from);
  return status;
}

const backend hl_processor_backend = {.prepare = prepare, .run = run};
