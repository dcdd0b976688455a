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

uint64_t hl_light_shadow_buffer_bytes(const light_shadow *shadow) {
  const shadow_plan *plan = &shadow->plan;
  return hl_shadow_buffer_bytes(&plan->view, shadow->setup.channels, plan->second, plan->reach);
}

shadow_bytes hl_light_shadow_bytes(const light_shadow *shadow) {
  return shadow->method->bytes == NULL ? (shadow_bytes){0} : shadow->method->bytes(shadow);
}

hl_status hl_light_shadow_begin(light_shadow *shadow, shadow_buffer *buffer, shadow_memory *memory,
                                hl_error *error) {
  const shadow_setup *setup = &shadow->setup;
  const shadow_plan *plan = &shadow->plan;
  shadow->buffer = buffer;
  hl_status status = hl_shadow_buffer_reset(setup->context, setup->pool, buffer, &plan->view, setup->channels,
                                            plan->second, plan->reach, error);
  shadow->lookup.map = hl_map_of_view(&plan->view);
  shadow->lookup.map.stride = buffer->stride;
  for (int c = 0; c < setup->channels; c++) shadow->lookup.transmittance[c] = buffer->transmittance[c];
  if (status == HL_OK && shadow->method->begin != NULL) status = shadow->method->begin(shadow, memory, error);
  return status;
}

void hl_light_shadow_end(light_shadow *shadow) {
  if (shadow->method != NULL && shadow->method->end != NULL) shadow->method->end(shadow);
  hl_release(shadow->setup.context, shadow->state);
  *shadow = (light_shadow){0};
}
