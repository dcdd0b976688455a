/* render/device_reasons.c - see device_reasons.h. */
#include "render/device_reasons.h"

#include "render/device_volume.h"
#include "volume/store/pages.h"

static bool has_no_volume(const frame_plan *plan) {
  return plan->volumes.count == 0 || plan->frame.content.point_count == 0;
}
static bool has_many_volumes(const frame_plan *plan) { return plan->volumes.count > PLAN_VOLUMES; }

/* Returns whether the volumes' voxels have several types. Kernels are compiled for one type. */
static bool has_mixed_voxels(const frame_plan *plan) {
  for (int v = 1; v < plan->volumes.count; v++)
    if (hl_device_storage(&plan->volumes.grids[v]) != hl_device_storage(&plan->volumes.grids[0])) return true;
  return false;
}
static bool projects_volumes(const frame_plan *plan) {
  return plan->volumes.count > 1 && plan->volumes.shown != NULL;
}
/* Returns whether some volume has a property. */
static bool any_volume(const frame_plan *plan, bool (*has)(const grid *grid, const frame_volume *volume)) {
  for (int v = 0; v < plan->volumes.count; v++)
    if (has(&plan->volumes.grids[v], &plan->volumes.list[v])) return true;
  return false;
}
/* Returns whether there are several volumes, of which some have a property. */
static bool any_of_several(const frame_plan *plan,
                           bool (*has)(const grid *grid, const frame_volume *volume)) {
  return plan->volumes.count > 1 && any_volume(plan, has);
}

/* Where a mask hides matter of one volume, the processors may still place the matter of another volume by
 * the hidden matter, which depends on the pixels of a block. */
static bool has_mask(const grid *grid, const frame_volume *volume) {
  (void)grid;
  return volume->classifier->mask.factors != NULL;
}
static bool masks_one_of_several(const frame_plan *plan) { return any_of_several(plan, has_mask); }

/* Light goes through the removed part of a volume's matter in a slab, beside the eye's ray. The processors
 * know this matter for all pixels of a block, and a device only for pixels whose own rays meet visible
 * bricks. */
static bool has_removed_part(const grid *grid, const frame_volume *volume) {
  (void)grid;
  return volume->is_cut || volume->is_clipped;
}
static bool cuts_one_of_several(const frame_plan *plan) { return any_of_several(plan, has_removed_part); }

static bool is_seen(const grid *grid, const frame_volume *volume) {
  (void)grid;
  return volume->visible;
}
static bool hides_all(const frame_plan *plan) { return !any_volume(plan, is_seen); }
static bool has_layers(const frame_plan *plan) { return plan->picture.layers != NULL; }
static bool is_shared(const frame_plan *plan) { return plan->picture.share.parts > 1; }
static bool has_surfaces(const frame_plan *plan) { return plan->frame.surfaces != NULL; }
static bool scatters(const frame_plan *plan) { return plan->fields.scatters; }
static bool splats(const frame_plan *plan) { return plan->volumes.splat; }
static bool has_blocks_of_ranks(const grid *grid, const frame_volume *volume) {
  (void)volume;
  return grid->pages != NULL && grid->pages->blocks != NULL;
}
static bool is_over_ranks(const frame_plan *plan) { return any_volume(plan, has_blocks_of_ranks); }
static bool has_few_slices(const grid *grid, const frame_volume *volume) {
  const int32_t *dimension = grid->dimension;
  (void)volume;
  return grid->bricks == NULL && (dimension[0] < 4 || dimension[1] < 4 || dimension[2] < 4);
}
static bool is_thin(const frame_plan *plan) { return any_volume(plan, has_few_slices); }
static bool reads_second_volume(const grid *grid, const frame_volume *volume) {
  (void)grid;
  return volume->classifier->plane.sums != NULL && volume->classifier->plane.axis != HL_SECOND_GRADIENT;
}
static bool has_second_volume(const frame_plan *plan) { return any_volume(plan, reads_second_volume); }
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

/* Returns whether slabs are so thick that they may lead from visible matter into a brick that a mask hides. A
 * device skips slabs whose ends lie in such bricks. Around these bricks the mask is 0 for three voxels
 * (grid/relevant.c), and no ray's way through a slab is longer than twice its thickness. */
static bool masks_thick_slabs(const frame_plan *plan) {
  for (int v = 0; v < plan->volumes.count; v++) {
    const double most = 1.5 * hl_smallest_edge(&plan->volumes.grids[v]);
    if (plan->volumes.list[v].classifier->mask.factors == NULL) continue;
    for (int i = 0; i < plan->sweeps.count; i++)
      if (plan->sweeps.list[i].geometry->sheets.spacing > most) return true;
  }
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
    {has_many_volumes, "more than 16 volumes"},
    {has_mixed_voxels, "several volumes with different types of voxels"},
    {masks_one_of_several, "several volumes of which one has a mask"},
    {cuts_one_of_several, "several volumes of which one is cut or clipped"},
    {projects_volumes, "a maximum projection of several volumes"},
    {hides_all, "it shows no volume"},
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
