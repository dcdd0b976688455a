/* shadow/light_shadow.c - one light's shadows in one sweep: its method chosen, planned, begun and ended. */
#include "core/memory.h"
#include "shadow/shadow_method.h"

hl_status hl_light_shadow_plan(light_shadow *shadow, const shadow_setup *setup, hl_error *error) {
  const shadow_method *method = setup->seen_count == 0 ? NULL : hl_shadow_method(setup->source);
  *shadow = (light_shadow){.setup = *setup, .plan = {.spare = PIXEL_TO_SPARE}};
  if (method == NULL) return HL_OK;
  if (method->state_bytes > 0) {
    shadow->state = hl_allocate_zeroed(setup->context, 1, method->state_bytes);
    if (shadow->state == NULL) return hl_fail_memory(error, method->state_bytes, "a light's shadows");
  }
  shadow->method = method;
  method->plan(shadow);
  return HL_OK;
}

static shadow_buffer_size size_of_buffer(const light_shadow *shadow) {
  const shadow_plan *plan = &shadow->plan;
  return (shadow_buffer_size){&plan->view, shadow->setup.channels, plan->second, plan->reach};
}

uint64_t hl_light_shadow_buffer_bytes(const light_shadow *shadow) {
  const shadow_buffer_size size = size_of_buffer(shadow);
  return hl_shadow_buffer_bytes(&size);
}

shadow_layouts hl_light_shadow_count(light_shadow *shadow) {
  shadow_layouts layouts = {0};
  if (shadow->method->lay_out != NULL) shadow->method->lay_out(shadow, &layouts);
  return layouts;
}

/* Room for what the method keeps from frame to frame. */
static hl_status grow(hl_context *context, shadow_memory *memory, size_t bytes, hl_error *error) {
  if (memory->capacity >= bytes) return HL_OK;
  hl_release(context, memory->planes);
  *memory = (shadow_memory){.planes = hl_allocate(context, bytes, 1)};
  if (memory->planes == NULL) return hl_fail_memory(error, bytes, "a light's shadows");
  memory->capacity = bytes;
  return HL_OK;
}

static hl_status hand_out(light_shadow *shadow, shadow_memory *kept, hl_error *error) {
  const shadow_setup *setup = &shadow->setup;
  shadow_layouts counted = hl_light_shadow_count(shadow);
  hl_status status = grow(setup->context, kept, counted.kept.bytes, error);
  if (status != HL_OK) return status;
  shadow->passing = hl_reserve_take(setup->reserve, counted.passing.bytes, 1);
  if (shadow->passing == NULL) return hl_fail_memory(error, counted.passing.bytes, "a light's shadows");
  shadow->kept = kept;
  shadow_layouts handed = {.kept.base = kept->planes, .passing.base = shadow->passing};
  shadow->method->lay_out(shadow, &handed);
  return HL_OK;
}

hl_status hl_light_shadow_begin(light_shadow *shadow, shadow_buffer *buffer, shadow_memory *memory,
                                hl_error *error) {
  const shadow_setup *setup = &shadow->setup;
  const shadow_buffer_size size = size_of_buffer(shadow);
  shadow->buffer = buffer;
  hl_status status = hl_shadow_buffer_reset(setup->context, setup->pool, buffer, &size, error);
  shadow->lookup.map = hl_map_of_view(&shadow->plan.view);
  shadow->lookup.map.stride = buffer->stride;
  for (int c = 0; c < setup->channels; c++) shadow->lookup.transmittance[c] = buffer->transmittance[c];
  if (status == HL_OK && shadow->method->check != NULL) status = shadow->method->check(shadow, error);
  if (status == HL_OK && shadow->method->lay_out != NULL) status = hand_out(shadow, memory, error);
  if (status == HL_OK && shadow->method->begin != NULL) status = shadow->method->begin(shadow, error);
  return status;
}

void hl_light_shadow_end(light_shadow *shadow) {
  if (shadow->method != NULL && shadow->method->end != NULL) shadow->method->end(shadow);
  if (shadow->passing != NULL) hl_reserve_return(shadow->setup.reserve, shadow->passing);
  hl_release(shadow->setup.context, shadow->state);
  *shadow = (light_shadow){0};
}
