/* shadow/shadow_plan.c - the size of a shadow buffer's pixels and the region that it covers, for all methods.
 */
#include "shadow/shadow_method.h"

/* Pixels of shadow buffers are as large as possible without visibly adding to the sheets' error (measured
 * against the reference, docs/performance.md): three quarters of the sheets' distance, between three tenths
 * and three quarters of a voxel. SHADOW_PIXEL_PER_IMAGE_PIXEL is for buffers that are blurred. */
static const double SHADOW_PIXEL_PER_SPACING = 0.75, LEAST_SHADOW_PIXEL = 0.3, GREATEST_SHADOW_PIXEL = 0.75;
static const double SHADOW_PIXEL_PER_IMAGE_PIXEL = 1.4;
/* Cubic convolution on pixels larger by this fraction of a voxel is as exact as bilinear look-ups on the
 * others. */
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
  /* a pixel on the sheets is narrower seen along the light: as large as a hard shadow's there */
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

/* The buffer's margin for penumbrae: the whole width of this sweep's widest penumbra, in the buffer's units.
 * A penumbra reaches half its width beyond its occluder; blurs in several steps reach further. */
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
