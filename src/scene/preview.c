/* scene/preview.c - makes copies of a scene's volumes at coarser resolutions, and chooses the copies that
 * suit the scene's sheets (halflight/preview.h). If a scene later uses a volume in another way, as labels or
 * as values, copies for this use are made when the scene needs them. */
#include <halflight/preview.h>
#include <math.h>
#include <pthread.h>
#include <string.h>

#include "core/context.h"
#include "core/door.h"
#include "core/memory.h"
#include "scene/geometry/placement.h"
#include "scene/scene.h"
#include "volume/coarser.h"
#include "volume/store/pages.h"

enum { MOST_LEVELS = 3, LEAST_VOXELS = 64 * 64 * 64 };

/* A volume, and its copies from fine to coarse. `count` is 0 if the volume can have no copies of this kind.
 */
typedef struct levels {
  hl_volume *volume;               /* the volume; retained */
  hl_coarser_kind kind;            /* the use for which the copies are made: as labels or as values */
  hl_volume *coarser[MOST_LEVELS]; /* retained; [count]; the copies */
  size_t count;
} levels;

/* Two numbers whose product is the greatest number of lists of copies for a scene's volume. MAPS: the volume
 * and its mask have lists. KINDS: the volume and the mask may each be used as values and as labels. */
enum { MAPS = 2, KINDS = 2 };

struct hl_preview {
  hl_context *context;
  pthread_mutex_t adding; /* held while `volumes` is read or grows */
  size_t count;
  levels volumes[]; /* [count]; with room for all kinds of all volumes and masks */
};

static void release_levels(levels *l) {
  hl_volume_release(l->volume);
  for (size_t n = 0; n < l->count; n++) hl_volume_release(l->coarser[n]);
  *l = (levels){0};
}

void hl_preview_destroy(hl_preview *preview) {
  if (preview == NULL) return;
  for (size_t v = 0; v < preview->count; v++) release_levels(&preview->volumes[v]);
  pthread_mutex_destroy(&preview->adding);
  hl_release(preview->context, preview);
}

static bool can_be_coarser(const hl_volume *v, hl_coarser_kind kind) {
  if (v->colors != NULL || (v->pages != NULL && v->pages->blocks != NULL)) return false;
  return kind == HL_COARSER_MEANS || (v->bricks == NULL && !hl_volume_is_exact(v));
}

static hl_coarser_kind kind_of(const hl_scene_volume *volume) {
  return volume->label_count > 0 ? HL_COARSER_LABELS : HL_COARSER_MEANS;
}

static hl_status make_levels(levels *l, hl_error *error) {
  const hl_volume *last = l->volume;
  hl_status status = HL_OK;
  while (status == HL_OK && l->count < MOST_LEVELS && hl_volume_voxel_count(last) >= LEAST_VOXELS) {
    status = hl_volume_make_coarser(last, l->kind, &l->coarser[l->count], error);
    if (status == HL_OK) last = l->coarser[l->count++];
  }
  return status;
}

static const levels *levels_of(const hl_preview *preview, const hl_volume *volume, hl_coarser_kind kind) {
  for (size_t v = 0; v < preview->count; v++)
    if (preview->volumes[v].volume == volume && preview->volumes[v].kind == kind) return &preview->volumes[v];
  return NULL;
}

static bool is_known(const hl_preview *preview, const hl_volume *volume) {
  return levels_of(preview, volume, HL_COARSER_MEANS) != NULL ||
         levels_of(preview, volume, HL_COARSER_LABELS) != NULL;
}

/* Makes the copies of a volume for a use, if the volume can have such copies and has none yet. If memory is
 * short, the copies that were made are kept, and no further copies are tried later. */
static hl_status add_levels(hl_preview *preview, hl_volume *volume, hl_coarser_kind kind, hl_error *error) {
  if (volume == NULL || levels_of(preview, volume, kind) != NULL) return HL_OK;
  levels *l = &preview->volumes[preview->count];
  l->volume = volume;
  l->kind = kind;
  hl_volume_retain(volume);
  hl_status status = can_be_coarser(volume, kind) ? make_levels(l, error) : HL_OK;
  if (status == HL_OK || status == HL_ERROR_MEMORY) preview->count++;
  else release_levels(l);
  return status;
}

/* Makes the copies of all volumes and masks of a scene for their use in this scene. known: if set, copies are
 * made only of volumes and masks that have copies for another use. */
static hl_status add_scene(hl_preview *preview, const hl_scene_description *d, bool known, hl_error *error) {
  hl_status status = HL_OK;
  for (size_t v = 0; v < d->volume_count && status == HL_OK; v++) {
    const hl_scene_volume *volume = &d->volumes[v];
    hl_volume *mask = volume->mask.volume;
    if (!known || is_known(preview, volume->volume))
      status = add_levels(preview, volume->volume, kind_of(volume), error);
    if (status == HL_OK && (!known || is_known(preview, mask)))
      status = add_levels(preview, mask, HL_COARSER_LABELS, error);
  }
  return status;
}

hl_status hl_preview_create(hl_context *context, const hl_scene *scene, hl_preview **preview,
                            hl_error *error) {
  HL_DOOR;
  if (preview == NULL || context == NULL || scene == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_preview_create: null context, scene or preview");
  *preview = NULL;
  const hl_scene_description *d = &scene->description;
  const size_t most = MAPS * KINDS * d->volume_count;
  hl_preview *made = hl_allocate_zeroed(context, 1, sizeof *made + most * sizeof(levels));
  if (made == NULL) return hl_fail_memory(error, sizeof *made, "a preview");
  made->context = context;
  if (pthread_mutex_init(&made->adding, NULL) != 0) {
    hl_release(context, made);
    return hl_fail_memory(error, sizeof *made, "a preview");
  }
  hl_status status = add_scene(made, d, false, error);
  if (status == HL_OK) *preview = made;
  else hl_preview_destroy(made);
  return status;
}

/* The shortest edge, in the scene's world, of a voxel of a map (a volume or a mask) that is placed like the
 * scene's volume. */
static double edge_of(const hl_scene_volume *volume, hl_volume *map) {
  hl_scene_volume placed = *volume;
  hl_scene_description alone;
  placed.volume = map;
  hl_scene_description_defaults(&alone);
  alone.volumes = &placed;
  alone.volume_count = 1;
  return hl_scene_smallest_edge(&alone);
}

/* The coarsest copy of a volume, or of its mask, whose voxels are not much longer than the distance between
 * sheets; null if the volume has no copies, or if all copies are coarser. */
static hl_volume *copy_for(const hl_preview *preview, const hl_scene_volume *volume, const hl_volume *map,
                           hl_coarser_kind kind, double apart) {
  const levels *l = levels_of(preview, map, kind);
  for (size_t n = l != NULL ? l->count : 0; n > 0; n--)
    if (edge_of(volume, l->coarser[n - 1]) <= apart * sqrt(2)) return l->coarser[n - 1];
  return NULL;
}

/* Replaces a volume and its mask by their coarser copies. Returns false if neither the volume nor the mask is
 * replaced. */
static bool replace(const hl_preview *preview, hl_scene_volume *volume, double apart) {
  hl_volume *copy = copy_for(preview, volume, volume->volume, kind_of(volume), apart);
  hl_volume *mask = copy_for(preview, volume, volume->mask.volume, HL_COARSER_LABELS, apart);
  if (copy != NULL) volume->volume = copy;
  if (mask != NULL) volume->mask.volume = mask;
  return copy != NULL || mask != NULL;
}

/* Makes the copies that a scene needs and that are missing. Where memory is short, fewer copies are made. */
static hl_status add_missing(hl_preview *preview, const hl_scene_description *d, hl_error *error) {
  hl_error short_of = {0};
  hl_status status = add_scene(preview, d, true, &short_of);
  if (status == HL_OK || status == HL_ERROR_MEMORY) return HL_OK;
  if (error != NULL) *error = short_of;
  return status;
}

hl_status hl_preview_scene(hl_preview *preview, hl_scene *scene, hl_scene **quick, hl_error *error) {
  HL_DOOR;
  if (preview == NULL || scene == NULL || quick == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_preview_scene: null preview, scene or quick");
  *quick = NULL;
  hl_scene_description d = scene->description;
  bool changed = false;
  hl_scene_volume *volumes = hl_allocate(preview->context, d.volume_count + 1, sizeof *volumes);
  if (volumes == NULL) return hl_fail_memory(error, sizeof *volumes, "a preview's scene");
  double apart = d.volume_count > 0 ? d.render.sheet_spacing * hl_scene_smallest_edge(&d) : 0;
  pthread_mutex_lock(&preview->adding);
  hl_status status = add_missing(preview, &d, error);
  for (size_t v = 0; v < d.volume_count; v++) {
    volumes[v] = d.volumes[v];
    changed |= replace(preview, &volumes[v], apart);
  }
  pthread_mutex_unlock(&preview->adding);
  d.volumes = volumes;
  if (status == HL_OK && changed) {
    d.render.sheet_spacing = apart / hl_scene_smallest_edge(&d);
    status = hl_scene_create(preview->context, &d, quick, error);
  } else if (status == HL_OK) {
    hl_scene_retain(scene);
    *quick = scene;
  }
  hl_release(preview->context, volumes);
  return status;
}
