/* shadow_cascade/method.c - the cascade as a method of shadows. */
#include "shadow/shadow_method.h"
#include "shadow_cascade/cascade.h"

static bool is_read_cubic(const shadow_setup *setup) {
  hl_shadow_lookup lookup = setup->settings->shadow_lookup;
  return lookup == HL_LOOKUP_AUTO ? setup->image == NULL : lookup == HL_LOOKUP_CUBIC;
}

/* The greatest tangent of a view's rays against the sheets' normal (a quadrangle's rays meet a sheet in one:
 * corners are farthest). Infinite where some rays run along the sheets. */
static double steepest_tangent(const view *view, vec3 normal) {
  double greatest = 0, first = 0;
  for (int corner = 0; corner < 4; corner++) {
    vec3 start, way;
    hl_view_ray(view, corner % 2 * view->width, corner / 2 * view->height, &start, &way);
    double climb = vec3_dot(way, normal);
    if (corner == 0) first = climb;
    if (!(climb * first > 0)) return INFINITY;
    greatest = fmax(greatest, vec3_length(vec3_subtract(way, vec3_scale(normal, climb))) / fabs(climb));
  }
  return greatest;
}

/* A cascade keeps its buffer where it is looked up. What is seen of a brick is looked up in the middle of the
 * slab, up to half a slab further along the eye's ray: derived, in a buffer parallel to the sheets that is
 * half their distance times the difference of the two rays' tangents away. Near a light within the content a
 * tile must do. */
static double look_up_spare(const shadow_setup *setup, const shadow_plan *plan) {
  const sheet_stack *sheets = setup->sheets;
  const view *view = &plan->view;
  double nearest = 1, pixel = fmin(vec3_length(view->du), vec3_length(view->dv));
  if (view->perspective) nearest = fmax(sheets->first - vec3_dot(view->origin, sheets->normal), 1e-9 * pixel);
  double tangents = steepest_tangent(setup->eye, sheets->normal) + steepest_tangent(view, sheets->normal);
  int taps = plan->cubic ? 2 * PIXEL_TO_SPARE : PIXEL_TO_SPARE;
  return taps + fmin(0.5 * sheets->spacing * tangents / (pixel * nearest), TILE);
}

static void plan_cascade(light_shadow *shadow) {
  const shadow_setup *setup = &shadow->setup;
  shadow_plan *plan = &shadow->plan;
  light_source middle = *setup->source;
  plan->cubic = is_read_cubic(setup);
  plan->second = true; /* the light that receivers fade from */
  hl_plan_soft(shadow, hl_blurred_pixel(setup, plan->cubic));
  plan->extent.u = plan->seen.u;
  if (middle.parallel) middle.direction = vec3_normalise(plan->seen.middle);
  else middle.position = plan->seen.middle;
  hl_shadow_view(&middle, setup->sheets->normal, &plan->extent, &plan->view);
  plan->spare = look_up_spare(setup, plan);
  if (setup->image != NULL)
    hl_light_image_see(setup->source, &plan->seen, setup->sheets->normal, setup->image);
}

static void before_shading(light_shadow *shadow, int sheet) {
  shadow->lookup.young = hl_soft_cascade_age(shadow->state, shadow->setup.sheets, sheet);
}

static void before_slab(light_shadow *shadow, int sheet) {
  hl_soft_cascade_reach(shadow->state, shadow->setup.sheets, sheet);
}

static void before_tile(const light_shadow *shadow, size_t tile, attenuate_job *job) {
  const shadow_buffer *buffer = shadow->buffer;
  size_t x = tile % (size_t)buffer->tiles_x * TILE, y = tile / (size_t)buffer->tiles_x * TILE;
  for (int c = 0; c < job->channels; c++) job->older[c] = buffer->second[c] + y * buffer->stride + x;
  hl_soft_cascade_count(shadow->state, tile, job);
}

static void after_tile(light_shadow *shadow, size_t tile) {
  soft_cascade *cascade = shadow->state;
  cascade->touched[tile] = 1;
}

static void advance_cascade(light_shadow *shadow, const occupancy *occupancy, int sheet) {
  hl_soft_cascade_advance(shadow->state, shadow->buffer, occupancy, shadow->setup.sheets, sheet,
                          shadow->setup.pool, shadow->setup.functions->cascade);
}

static void end_cascade(light_shadow *shadow) {
  hl_soft_cascade_release(shadow->setup.context, shadow->setup.pool, shadow->state);
}

const shadow_method hl_shadow_cascade = {.name = "cascade",
                                         .state_bytes = sizeof(soft_cascade),
                                         .first_slab = 1,
                                         .plan = plan_cascade,
                                         .bytes = hl_soft_cascade_bytes,
                                         .begin = hl_soft_cascade_begin,
                                         .before_shading = before_shading,
                                         .before_slab = before_slab,
                                         .before_tile = before_tile,
                                         .after_tile = after_tile,
                                         .advance = advance_cascade,
                                         .end = end_cascade};
