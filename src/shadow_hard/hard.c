/* shadow_hard/hard.c - makes hard shadows (section 3 of the paper). A light has one shadow buffer,
 * perpendicular to the light's direction. Each slab, as seen from the light's centre, attenuates the buffer.
 */
#include "shadow/shadow_method.h"

static bool is_read_cubic(const shadow_setup *setup) {
  hl_shadow_lookup lookup = setup->settings->shadow_lookup;
  return lookup == HL_LOOKUP_AUTO ? hl_cubic_is_better(setup) : lookup == HL_LOOKUP_CUBIC;
}

static void plan_hard(light_shadow *shadow) {
  shadow_plan *plan = &shadow->plan;
  plan->cubic = is_read_cubic(&shadow->setup);
  plan->extent = hl_extent_of_seen(&shadow->setup, hl_sharp_pixel(&shadow->setup, plan->cubic));
  hl_shadow_view(shadow->setup.source, shadow->setup.source->direction, &plan->extent, &plan->view);
}

const shadow_method hl_shadow_hard = {.name = "hard", .surface_delay = 1, .plan = plan_hard, .divides = true};
