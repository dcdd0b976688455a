/* scene/preview.c - see halflight/preview.h: a scene's volumes at coarser resolutions, and which of them suit
 * its sheets. */
#include <halflight/preview.h>
#include <math.h>
#include <string.h>

#include "core/context.h"
#include "core/door.h"
#include "core/memory.h"
#include "scene/geometry/placement.h"
#include "scene/scene.h"
#include "volume/coarser.h"
#include "volume/store/pages.h"

enum { MOST_LEVELS = 3, LEAST_VOXELS = 64 * 64 * 64 };

/* A volume, and copies of it from fine to coarse. */
typedef struct levels {
  hl_volume *volume;               /* retained */
  hl_volume *coarser[MOST_LEVELS]; /* retained; [count] */
  size_t count;
} levels;

struct hl_preview {
  hl_context *context;
  size_t count;
  levels volumes[]; /* [count] */
};

void hl_preview_destroy(hl_preview *preview) {
  if (preview == NULL) return;
  for (size_t v = 0; v < preview->count; v++) {
    levels *l = &preview->volumes[v];
    hl_volume_release(l->volume);
    for (size_t n = 0; n < l->count; n++) hl_volume_release(l->coarser[n]);
  }
  hl_release(preview->context, preview);
}

static bool can_be_coarser(const hl_scene_volume *volume) {
  const hl_volume *v = volume->volume;
  return volume->label_count == 0 && v->colors == NULL && (v->pages == NULL || v->pages->blocks == NULL);
}

static hl_status make_levels(levels *l, hl_error *error) {
  const hl_volume *last = l->volume;
  hl_status status = HL_OK;
  while (status == HL_OK && l->count < MOST_LEVELS && hl_volume_voxel_count(last) >= LEAST_VOXELS) {
    status = hl_volume_make_coarser(last, &l->coarser[l->count], error);
    if (status == HL_OK) last = l->coarser[l->count++];
  }
  return status;
}

static const levels *levels_of(const hl_preview *preview, const hl_scene_volume *volume) {
  if (!can_be_coarser(volume)) return NULL;
  for (size_t v = 0; v < preview->count; v++)
    if (preview->volumes[v].volume == volume->volume) return &preview->volumes[v];
  return NULL;
}

hl_status hl_preview_create(hl_context *context, const hl_scene *scene, hl_preview **preview,
                            hl_error *error) {
  HL_DOOR;
  if (preview == NULL || context == NULL || scene == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_preview_create: null context, scene or preview");
  *preview = NULL;
  const hl_scene_description *d = &scene->description;
  hl_preview *made = hl_allocate_zeroed(context, 1, sizeof *made + d->volume_count * sizeof(levels));
  if (made == NULL) return hl_fail_memory(error, sizeof *made, "a preview");
  made->context = context;
  hl_status status = HL_OK;
  for (size_t v = 0; v < d->volume_count && status == HL_OK; v++) {
    const hl_scene_volume *volume = &d->volumes[v];
    if (!can_be_coarser(volume) || levels_of(made, volume) != NULL) continue;
    levels *l = &made->volumes[made->count++];
    l->volume = volume->volume;
    hl_volume_retain(l->volume);
    status = make_levels(l, error);
  }
  if (status == HL_OK) *preview = made;
  else hl_preview_destroy(made);
  return status;
}

/* The smallest edge of one volume's voxels in the scene. */
static double edge_of(const hl_scene_volume *volume) {
  hl_scene_description alone;
  hl_scene_description_defaults(&alone);
  alone.volumes = volume;
  alone.volume_count = 1;
  return hl_scene_smallest_edge(&alone);
}

/* Gives the volume its coarsest copy whose voxels are about as long as the sheets are apart. False: the
 * volume stays as it is. */
static bool replace(const hl_preview *preview, hl_scene_volume *volume, double apart) {
  const levels *l = levels_of(preview, volume);
  for (size_t n = l != NULL ? l->count : 0; n > 0; n--) {
    hl_scene_volume coarse = *volume;
    coarse.volume = l->coarser[n - 1];
    if (edge_of(&coarse) > apart * sqrt(2)) continue;
    volume->volume = coarse.volume;
    return true;
  }
  return false;
}

hl_status hl_preview_scene(const hl_preview *preview, hl_scene *scene, hl_scene **quick, hl_error *error) {
  HL_DOOR;
  if (preview == NULL || scene == NULL || quick == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_preview_scene: null preview, scene or quick");
  *quick = NULL;
  hl_scene_description d = scene->description;
  bool changed = false;
  hl_scene_volume *volumes = hl_allocate(preview->context, d.volume_count + 1, sizeof *volumes);
  if (volumes == NULL) return hl_fail_memory(error, sizeof *volumes, "a preview's scene");
  double apart = d.volume_count > 0 ? d.render.sheet_spacing * hl_scene_smallest_edge(&d) : 0;
  for (size_t v = 0; v < d.volume_count; v++) {
    volumes[v] = d.volumes[v];
    changed |= replace(preview, &volumes[v], apart);
  }
  d.volumes = volumes;
  hl_status status = HL_OK;
  if (changed) {
    d.render.sheet_spacing = apart / hl_scene_smallest_edge(&d);
    status = hl_scene_create(preview->context, &d, quick, error);
  } else {
    hl_scene_retain(scene);
    *quick = scene;
  }
  hl_release(preview->context, volumes);
  return status;
}
