/* shadow/shadow_method.c - makes the shadows of one light in one sweep: chooses the shadow method, and lets
 * the method plan, begin and end. This file also has the tools that all methods use. */
#include "shadow/shadow_method.h"

#include <string.h>

#include "core/memory.h"

hl_status hl_light_shadow_plan(light_shadow *shadow, const shadow_setup *setup, hl_error *error) {
  const shadow_method *method = setup->seen_count == 0 ? NULL : hl_shadow_method(setup->source);
  *shadow = (light_shadow){.setup = *setup, .plan = {.spare = PIXEL_TO_SPARE, .outside = setup->surfaces}};
  if (method == NULL) return HL_OK;
  if (method->state_bytes > 0) {
    shadow->state = hl_allocate_zeroed(setup->context, 1, method->state_bytes);
    if (shadow->state == NULL) return hl_fail_memory(error, method->state_bytes, "a light's shadows");
  }
  shadow->method = method;
  method->plan(shadow);
  return HL_OK;
}

shadow_buffer_size hl_light_shadow_buffer_size(const light_shadow *shadow, int ring) {
  const shadow_plan *plan = &shadow->plan;
  return (shadow_buffer_size){.view = &plan->view,
                              .channels = shadow->setup.channels,
                              .outside = plan->outside,
                              .second = plan->second,
                              .reach = plan->reach,
                              .ring = ring};
}

shadow_layouts hl_light_shadow_count(light_shadow *shadow) {
  shadow_layouts layouts = {0};
  if (shadow->method->lay_out != NULL) shadow->method->lay_out(shadow, &layouts);
  return layouts;
}

/* Makes the memory that a method keeps from frame to frame at least `bytes` large. */
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
  shadow->passing = hl_reserve_take(shadow->means.reserve, counted.passing.bytes, 1);
  if (shadow->passing == NULL) return hl_fail_memory(error, counted.passing.bytes, "a light's shadows");
  shadow->kept = kept;
  shadow_layouts handed = {.kept.base = kept->planes, .passing.base = shadow->passing};
  shadow->method->lay_out(shadow, &handed);
  return HL_OK;
}

static hl_status set_up_lookups(light_shadow *shadow, hl_error *error) {
  const shadow_buffer *buffer = shadow->buffer;
  size_t ring = (size_t)buffer->ring;
  shadow->lookups = hl_allocate_zeroed(shadow->setup.context, ring, sizeof *shadow->lookups);
  if (shadow->lookups == NULL) return hl_fail_memory(error, ring * sizeof *shadow->lookups, "look-ups");
  for (int sheet = 0; sheet < buffer->ring; sheet++) {
    shadow_lookup *lookup = &shadow->lookups[sheet];
    lookup->map = hl_map_of_view(&shadow->plan.view);
    lookup->map.stride = buffer->stride;
    for (int c = 0; c < buffer->channels; c++) {
      lookup->transmittance[c] = hl_shadow_plane_at(buffer, sheet, SHADOW_TRANSMITTANCE, c);
      if (buffer->has_outside) lookup->outside[c] = hl_shadow_plane_at(buffer, sheet, SHADOW_OUTSIDE, c);
    }
  }
  return HL_OK;
}

/* Copies the method's own data from the planned shadow to the shadow that begins. */
static hl_status copy_state(const light_shadow *planned, light_shadow *shadow, hl_error *error) {
  const size_t bytes = planned->method->state_bytes;
  if (bytes == 0) return HL_OK;
  shadow->state = hl_allocate(planned->setup.context, 1, bytes);
  if (shadow->state == NULL) return hl_fail_memory(error, bytes, "a light's shadows");
  memcpy(shadow->state, planned->state, bytes);
  return HL_OK;
}

hl_status hl_light_shadow_begin(light_shadow *shadow, const light_shadow *planned, const shadow_means *means,
                                int ring, shadow_buffer *buffer, shadow_memory *memory, hl_error *error) {
  const shadow_setup *setup = &shadow->setup;
  *shadow = *planned;
  shadow->means = *means;
  shadow->state = NULL;
  hl_status status = copy_state(planned, shadow, error);
  if (status != HL_OK) return status;
  const shadow_buffer_size size = hl_light_shadow_buffer_size(shadow, ring);
  shadow->buffer = buffer;
  status = hl_shadow_buffer_reset(setup->context, means->pool, buffer, &size, error);
  if (status == HL_OK) status = set_up_lookups(shadow, error);
  if (status == HL_OK && shadow->method->check != NULL) status = shadow->method->check(shadow, error);
  if (status == HL_OK && shadow->method->lay_out != NULL) status = hand_out(shadow, memory, error);
  if (status == HL_OK && shadow->method->begin != NULL) status = shadow->method->begin(shadow, error);
  return status;
}

void hl_light_shadow_end(light_shadow *shadow) {
  if (shadow->buffer != NULL && shadow->method->end != NULL) shadow->method->end(shadow);
  if (shadow->passing != NULL) hl_reserve_return(shadow->means.reserve, shadow->passing);
  hl_release(shadow->setup.context, shadow->lookups);
  hl_release(shadow->setup.context, shadow->state);
  *shadow = (light_shadow){0};
}

/* ---- the size of a shadow buffer's pixels and the region that it covers, for all methods ---- */

/* The sizes of a shadow buffer's pixels. Pixels are as large as possible without visibly adding to the error
 * of the sheets (measured against the reference, docs/experiments.md). A pixel's edge is
 * SHADOW_PIXEL_PER_SPACING times the distance between sheets. The edge is at least LEAST_SHADOW_PIXEL and at
 * most GREATEST_SHADOW_PIXEL of a voxel's edge, and at most SHADOW_PIXEL_PER_IMAGE_PIXEL times the edge of a
 * picture's pixel. */
static const double SHADOW_PIXEL_PER_SPACING = 0.75, LEAST_SHADOW_PIXEL = 0.3, GREATEST_SHADOW_PIXEL = 0.75;
static const double SHADOW_PIXEL_PER_IMAGE_PIXEL = 1.4;
/* If a buffer is read by cubic convolution, its pixels may be larger by this fraction of a voxel: the
 * look-ups are still as exact as bilinear look-ups of smaller pixels. */
static const double CUBIC_LARGER = 1.0 / 8;
enum { SHADOW_PIXELS_PER_IMAGE_PIXEL = 4, LEAST_SHADOW_PIXELS = 1 << 20 };

static double pixel_of_sheets(const shadow_setup *setup) {
  double of_sheets = SHADOW_PIXEL_PER_SPACING * setup->sheets->spacing / setup->voxel;
  return fmin(fmax(of_sheets, LEAST_SHADOW_PIXEL), GREATEST_SHADOW_PIXEL);
}

double hl_shadow_pixel(const shadow_setup *setup, bool cubic) {
  return (pixel_of_sheets(setup) + (cubic ? CUBIC_LARGER : 0)) * setup->voxel;
}

bool hl_cubic_is_better(const shadow_setup *setup) {
  return pixel_of_sheets(setup) + CUBIC_LARGER <= GREATEST_SHADOW_PIXEL;
}

double hl_sharp_pixel(const shadow_setup *setup, bool cubic) {
  return fmin(SHADOW_PIXEL_PER_IMAGE_PIXEL * setup->pixel,
              fmin(hl_shadow_pixel(setup, cubic), GREATEST_SHADOW_PIXEL * setup->voxel));
}

double hl_blurred_pixel(const shadow_setup *setup, bool cubic) {
  const light_source *source = setup->source;
  /* Seen along the light, a pixel that lies on the sheets looks narrower than a pixel of a hard shadow's
   * buffer, which faces the light. So the pixel on the sheets is enlarged until the two pixels look equally
   * wide. */
  double slant = source->parallel ? fabs(vec3_dot(source->direction, setup->sheets->normal)) : 1;
  return fmin(SHADOW_PIXEL_PER_IMAGE_PIXEL * setup->middle_pixel,
              hl_shadow_pixel(setup, cubic) / sqrt(fmax(slant, 0.5)));
}

shadow_extent hl_extent_of_seen(const shadow_setup *setup, double pixel) {
  size_t greatest = setup->picture_pixels * SHADOW_PIXELS_PER_IMAGE_PIXEL;
  return (shadow_extent){.points = setup->seen,
                         .point_count = setup->seen_count,
                         .pixel = pixel,
                         .resolution = setup->settings->shadow_resolution,
                         .greatest_pixels = greatest < LEAST_SHADOW_PIXELS ? LEAST_SHADOW_PIXELS : greatest,
                         .content = setup->content,
                         .content_count = setup->content_count};
}

/* The margin around the buffer for penumbrae, in the buffer's units. The margin is as wide as the widest
 * penumbra of this sweep. A penumbra reaches only half of its width beyond its occluder, but blurs in several
 * steps reach further. */
static double penumbra_margin(const shadow_setup *setup, const sheet_light *seen) {
  const sheet_stack *sheets = setup->sheets;
  double width = fmax(seen->width_u, seen->width_v), depth = sheets->spacing * sheets->count;
  if (setup->source->parallel) return width * depth;
  double nearest = fmax(sheets->first - vec3_dot(setup->source->position, sheets->normal), 0);
  return width * (1 / nearest - 1 / (nearest + depth));
}

void hl_plan_soft(light_shadow *shadow, double pixel) {
  shadow_plan *plan = &shadow->plan;
  plan->extent = hl_extent_of_seen(&shadow->setup, pixel);
  plan->seen = hl_light_on_sheets(shadow->setup.source, shadow->setup.sheets->normal);
  plan->extent.margin = penumbra_margin(&shadow->setup, &plan->seen);
}

/* ---- the list of methods ---- */

#define HL_SOFT_METHOD(value, name) [value] = &hl_shadow_##name,
static const shadow_method *const soft_methods[] = {HL_SOFT_METHODS};

const shadow_method *hl_shadow_method(const light_source *source) {
  if (source->shadows == HL_SHADOWS_OFF) return NULL;
  return source->shadows == HL_SHADOWS_HARD ? &hl_shadow_hard : soft_methods[source->soft_method];
}
