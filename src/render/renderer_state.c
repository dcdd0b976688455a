/* render/renderer_state.c - see renderer_state.h. */
#include "render/renderer_state.h"

#include "core/context.h"
#include "core/memory.h"
#include "render/estimate.h"

uint64_t hl_renderer_estimate(const hl_renderer *renderer) { return renderer->estimate; }

void hl_renderer_exchange(hl_renderer *renderer, const light_exchange *exchange) {
  renderer->part = exchange->part;
  renderer->parts = exchange->parts;
  renderer->exchange = *exchange;
}

void hl_renderer_release_buffers(hl_renderer *renderer) {
  for (size_t i = 0; i < renderer->cache.buffer_count; i++)
    hl_shadow_buffer_release(renderer->context, &renderer->cache.buffers[i]);
  hl_release(renderer->context, renderer->cache.buffers);
  for (int i = 0; i < FRAME_LIGHTS; i++) {
    hl_release(renderer->context, renderer->cache.shadow_memory[i].planes);
    renderer->cache.shadow_memory[i] = (shadow_memory){0};
  }
  renderer->cache.buffers = NULL;
  renderer->cache.buffer_count = 0;
}

hl_status hl_renderer_check_room(hl_renderer *renderer, uint64_t bytes, hl_error *error) {
  uint64_t limit = renderer->context->options.memory_limit;
  if (limit != 0 && hl_context_memory_held(renderer->context) + bytes > limit)
    hl_reserve_drop_idle(&renderer->cache.reserve);
  hl_status status = hl_check_room(renderer->context, bytes, &renderer->estimate, error);
  for (size_t v = 0; v < renderer->cache.prepared_count && status == HL_OK; v++)
    if (renderer->cache.prepared[v].grid.pages != NULL)
      hl_pages_leave_room(renderer->cache.prepared[v].grid.pages, bytes);
  return status;
}
