/* scene/drawn_scene.c - see drawn_scene.h. */
#include "scene/drawn_scene.h"

#include "core/memory.h"
#include "scene/function/function_plane.h"
#include "scene/function/transfer_function.h"

drawn_scene *hl_drawn_scene_create(hl_context *context) {
  drawn_scene *drawn = hl_allocate_zeroed(context, 1, sizeof *drawn);
  if (drawn == NULL || pthread_mutex_init(&drawn->lock, NULL) == 0) return drawn;
  hl_release(context, drawn);
  return NULL;
}

static void release_content(hl_context *context, drawn_scene *drawn) {
  hl_scene_order_release(context, &drawn->order);
  hl_release(context, drawn->plane_marks);
  hl_drawn_labels_release(context, &drawn->description, &drawn->labels);
  for (size_t v = 0; drawn->without_scraps != NULL && v < drawn->volume_count; v++)
    hl_volume_release(drawn->without_scraps[v]);
  hl_release(context, drawn->without_scraps);
  hl_release(context, drawn->volumes);
  drawn->without_scraps = NULL;
  drawn->volumes = NULL;
  drawn->order = (scene_order){0};
  drawn->plane_marks = NULL;
  drawn->labels = (drawn_labels){0};
}

void hl_drawn_scene_destroy(hl_context *context, drawn_scene *drawn) {
  if (drawn == NULL) return;
  release_content(context, drawn);
  pthread_mutex_destroy(&drawn->lock);
  hl_release(context, drawn);
}

static hl_status mark_planes(hl_context *context, drawn_scene *drawn, hl_error *error) {
  const hl_scene_description *d = &drawn->description;
  drawn->plane_marks = hl_allocate_zeroed(context, d->volume_count, sizeof *drawn->plane_marks);
  if (drawn->plane_marks == NULL)
    return hl_fail_memory(error, sizeof *drawn->plane_marks, "a scene's volumes");
  for (size_t v = 0; v < d->volume_count; v++)
    if (hl_has_plane(&d->volumes[v].transfer_function))
      drawn->plane_marks[v] = hl_plane_mark(&d->volumes[v].transfer_function.plane);
  return HL_OK;
}

bool hl_hides_scraps(const hl_scene_volume *volume) {
  const hl_transfer_function *function = &volume->transfer_function;
  const double side = volume->scraps_firm >= volume->scraps_faint ? 1 : -1;
  if (!(volume->scraps_least > 0) || volume->label_count > 0 || hl_has_plane(function) ||
      !hl_scraps_apply(volume->volume) || hl_transfer_function_opacity(function, volume->scraps_faint) > 1e-9)
    return false;
  bool hides = true;
  for (size_t p = 0; p < function->opacity_count; p++)
    hides &= side * (function->opacity[p].value - volume->scraps_faint) > 0 ||
             !(function->opacity[p].opacity > 0);
  for (size_t i = 0; i < volume->iso_count; i++)
    hides &= side * (volume->iso[i].value - volume->scraps_faint) >= 0;
  return hides;
}

hl_status hl_hide_scraps(const hl_scene_volume *volume, hl_scraps *scraps, hl_error *error) {
  const hl_scraps_rule rule = {volume->scraps_faint, volume->scraps_firm, volume->scraps_least};
  return hl_scraps_hide(volume->volume, &rule, scraps, error);
}

/* Replaces volumes by volumes without their scraps. */
static hl_status hide_scraps(hl_context *context, drawn_scene *drawn, hl_error *error) {
  hl_scene_description *d = &drawn->description;
  bool any = false;
  for (size_t v = 0; v < d->volume_count; v++) any |= hl_hides_scraps(&d->volumes[v]);
  if (!any) return HL_OK;
  drawn->volume_count = d->volume_count;
  drawn->without_scraps = hl_allocate_zeroed(context, d->volume_count, sizeof *drawn->without_scraps);
  drawn->volumes = hl_allocate(context, d->volume_count, sizeof *drawn->volumes);
  if (drawn->without_scraps == NULL || drawn->volumes == NULL)
    return hl_fail_memory(error, d->volume_count * sizeof *drawn->volumes, "a scene's volumes");
  hl_status status = HL_OK;
  for (size_t v = 0; v < d->volume_count && status == HL_OK; v++) {
    hl_scene_volume *volume = &drawn->volumes[v];
    hl_scraps scraps = {0};
    *volume = d->volumes[v];
    if (hl_hides_scraps(volume)) status = hl_hide_scraps(volume, &scraps, error);
    drawn->without_scraps[v] = scraps.volume;
    if (scraps.volume != NULL) volume->volume = scraps.volume;
  }
  d->volumes = drawn->volumes;
  return status;
}

static hl_status make(hl_context *context, const hl_scene_description *given,
                      const hl_scene_description *placed, drawn_scene *drawn, hl_error *error) {
  drawn->description = *placed;
  hl_status status = hide_scraps(context, drawn, error);
  if (status == HL_OK) status = hl_labels_draw(context, &drawn->description, &drawn->labels, error);
  if (status == HL_OK) status = mark_planes(context, drawn, error);
  if (status == HL_OK)
    status = hl_scene_order_find(context, given, &drawn->description, &drawn->order, error);
  if (status != HL_OK) release_content(context, drawn);
  return status;
}

hl_status hl_drawn_scene_make(hl_context *context, const hl_scene_description *given,
                              const hl_scene_description *placed, drawn_scene *drawn, hl_error *error) {
  pthread_mutex_lock(&drawn->lock);
  hl_status status = drawn->made ? HL_OK : make(context, given, placed, drawn, error);
  drawn->made = status == HL_OK;
  pthread_mutex_unlock(&drawn->lock);
  return status;
}
