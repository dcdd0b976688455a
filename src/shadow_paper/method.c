/* shadow_paper/method.c - the paper's soft shadows as a method of shadows. */
#include "shadow/shadow_method.h"
#include "shadow_paper/paper.h"

static void plan_paper(light_shadow *shadow) {
  const shadow_setup *setup = &shadow->setup;
  const sheet_stack *sheets = setup->sheets;
  shadow_plan *plan = &shadow->plan;
  soft_paper *soft = shadow->state;
  plan->cubic = setup->settings->shadow_lookup == HL_LOOKUP_CUBIC;
  plan->second = true; /* between two blurs */
  hl_plan_soft(shadow, hl_blurred_pixel(setup, plan->cubic));
  hl_shadow_view(setup->source, sheets->normal, &plan->extent, &plan->view);
  hl_soft_paper_begin(soft, setup->source, sheets->normal, sheets->first, &plan->view, setup->image);
  plan->reach = hl_soft_paper_reach(soft, sheets->first, sheets->spacing, sheets->count);
}

static void advance_paper(light_shadow *shadow, const occupancy *occupancy, int sheet) {
  (void)occupancy;
  hl_soft_paper_convolve(shadow->state, shadow->buffer, hl_sheet_height(shadow->setup.sheets, sheet + 1),
                         shadow->setup.pool, &shadow->setup.functions->blur);
}

const shadow_method hl_shadow_paper = {.name = "paper",
                                       .state_bytes = sizeof(soft_paper),
                                       .first_slab = 1,
                                       .plan = plan_paper,
                                       .advance = advance_paper};
