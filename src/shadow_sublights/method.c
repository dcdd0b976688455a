/* shadow_sublights/method.c - sub-lights as a method of shadows. */
#include "shadow/shadow_method.h"
#include "shadow_sublights/sublights.h"

static const double SUBLIGHT_PIXEL_PER_IMAGE_PIXEL = 1.5;

static void plan_sublights(light_shadow *shadow) {
  const shadow_setup *setup = &shadow->setup;
  shadow_plan *plan = &shadow->plan;
  hl_plan_soft(shadow, fmin(SUBLIGHT_PIXEL_PER_IMAGE_PIXEL * setup->middle_pixel,
                            hl_shadow_pixel(setup, plan->cubic)));
  plan->extent.u = plan->seen.u;
  plan->reach = SUBLIGHT_REACH;
  hl_shadow_view(setup->source, setup->sheets->normal, &plan->extent, &plan->view);
}

static shadow_bytes bytes_of_sublights(const light_shadow *shadow) {
  const shadow_setup *setup = &shadow->setup;
  return (shadow_bytes){.passing = hl_sublights_bytes(setup->source, setup->image,
                                                      setup->settings->light_samples, setup->sheets->normal,
                                                      &shadow->plan.extent, setup->channels,
                                                      &shadow->plan.view, shadow->plan.reach)};
}

static hl_status begin_sublights(light_shadow *shadow, shadow_memory *memory, hl_error *error) {
  (void)memory;
  const shadow_setup *setup = &shadow->setup;
  sublights *all = shadow->state;
  hl_status status = hl_sublights_begin(setup->reserve, setup->pool, all, setup->source, setup->image,
                                        setup->settings->light_samples, setup->sheets->normal,
                                        &shadow->plan.extent, shadow->buffer, error);
  shadow->sublights = all->lookups;
  shadow->sublight_count = all->count;
  return status;
}

static void find_lit(light_shadow *shadow, size_t tile) {
  hl_sublights_find_lit(shadow->state, shadow->buffer, tile);
}

static void advance_sublights(light_shadow *shadow, const occupancy *occupancy, int sheet) {
  (void)occupancy;
  const sheet_stack *sheets = shadow->setup.sheets;
  hl_sublights_advance(shadow->state, shadow->buffer, sheets->normal, hl_sheet_height(sheets, sheet - 1),
                       hl_sheet_height(sheets, sheet), shadow->setup.pool,
                       shadow->setup.functions->sublights);
}

static void end_sublights(light_shadow *shadow) {
  hl_sublights_release(shadow->setup.reserve, shadow->state);
}

const shadow_method hl_shadow_sublights = {.name = "sublights",
                                           .state_bytes = sizeof(sublights),
                                           .first_slab = 1,
                                           .plan = plan_sublights,
                                           .bytes = bytes_of_sublights,
                                           .begin = begin_sublights,
                                           .find_lit = find_lit,
                                           .advance = advance_sublights,
                                           .end = end_sublights};
