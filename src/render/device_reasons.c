/* render/device_reasons.c - see device_reasons.h. */
#include "render/device_reasons.h"

#include "volume/store/pages.h"

static const frame_volume *volume_of(const frame_plan *plan) { return &plan->volumes.list[0]; }

static bool has_no_volume(const frame_plan *plan) {
  return plan->volumes.count == 0 || plan->frame.content.point_count == 0;
}
static bool has_volumes(const frame_plan *plan) { return plan->volumes.count > 1; }
static bool is_hidden(const frame_plan *plan) { return !volume_of(plan)->visible; }
static bool has_layers(const frame_plan *plan) { return plan->picture.layers != NULL; }
static bool is_shared(const frame_plan *plan) { return plan->picture.share.parts > 1; }
static bool has_surfaces(const frame_plan *plan) { return plan->frame.surfaces != NULL; }
static bool scatters(const frame_plan *plan) { return plan->fields.scatters; }
static bool splats(const frame_plan *plan) { return plan->volumes.splat; }
static bool is_over_ranks(const frame_plan *plan) {
  return plan->volumes.grids[0].pages != NULL && plan->volumes.grids[0].pages->blocks != NULL;
}
static bool is_thin(const frame_plan *plan) {
  const int32_t *dimension = plan->volumes.grids[0].dimension;
  if (plan->volumes.grids[0].bricks != NULL) return false;
  return dimension[0] < 4 || dimension[1] < 4 || dimension[2] < 4;
}
static bool has_second_volume(const frame_plan *plan) {
  const plane_table *plane = &volume_of(plan)->classifier->plane;
  return plane->sums != NULL && plane->axis != HL_SECOND_GRADIENT;
}
/* Sums of more numbers of 16 bits are rounded. Their mean may exceed 1, and the processors limit it only
 * where some pixel of a block is near a face. */
enum { MOST_SUBLIGHTS = 16 };
static bool has_many_sublights(const frame_plan *plan) {
  for (int i = 0; i < plan->frame.light_count; i++)
    if (hl_shadow_method(&plan->frame.lights[i]) == &hl_shadow_sublights &&
        plan->settings.light_samples > MOST_SUBLIGHTS)
      return true;
  return false;
}

static bool is_masked(const frame_plan *plan) { return volume_of(plan)->classifier->mask.factors != NULL; }

/* Returns whether slabs are so thick that they may lead from visible matter into a brick that a mask hides. A
 * device skips slabs whose ends lie in such bricks. Around these bricks the mask is 0 for three voxels
 * (grid/relevant.c), and no ray's way through a slab is longer than twice its thickness. */
static bool masks_thick_slabs(const frame_plan *plan) {
  const double most = 1.5 * hl_smallest_edge(&plan->volumes.grids[0]);
  for (int i = 0; i < plan->sweeps.count; i++)
    if (is_masked(plan) && plan->sweeps.list[i].geometry->sheets.spacing > most) return true;
  return false;
}

/* Returns whether the shadows of some light are blurred by the image that the light shows on its surface.
 * Sub-lights are weighed by the image, which a device can do. */
static bool blurs_by_images(const frame_plan *plan) {
  for (int i = 0; i < plan->sweeps.count; i++)
    for (int l = 0; l < plan->sweeps.list[i].geometry->light_count; l++) {
      const light_shadow *shadow = &plan->sweeps.list[i].lights[l].shadow;
      if (shadow->setup.emission != NULL &&
          (shadow->method == &hl_shadow_cascade || shadow->method == &hl_shadow_paper))
        return true;
    }
  return false;
}

/* The reasons why a device cannot make a frame, each with a function that tells whether it applies. The user
 * gets the first reason that applies. */
static const struct {
  bool (*applies)(const frame_plan *plan);
  const char *reason;
} reasons[] = {
    {has_no_volume, "it shows no volume"},
    {has_layers, "layers"},
    {is_shared, "a part of a shared picture"},
    {has_surfaces, "meshes or isosurfaces"},
    {has_volumes, "several volumes"},
    {is_hidden, "a volume that only casts shadows"},
    {scatters, "multiple scattering"},
    {splats, "splatting in place of gathering"},
    {is_over_ranks, "voxels of several processes"},
    {is_thin, "a volume less than four voxels thick"},
    {has_second_volume, "a function of two volumes' values"},
    {masks_thick_slabs, "a mask with sheets more than 1.5 voxels apart"},
    {has_many_sublights, "more than 16 x 16 sub-lights"},
    {blurs_by_images, "blurred shadows of lights that show images on their surfaces"},
};

const char *hl_reason_for_processors(const frame_plan *plan) {
  for (size_t i = 0; i < sizeof reasons / sizeof *reasons; i++)
    if (reasons[i].applies(plan)) return reasons[i].reason;
  return NULL;
}
