/* scene/drawn_scene.c - see drawn_scene.h. */
#include "scene/drawn_scene.h"

#include "core/memory.h"
#include "scene/function/function_plane.h"

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

static hl_status make(hl_context *context, const hl_scene_description *given,
                      const hl_scene_description *placed, drawn_scene *drawn, hl_error *error) {
  drawn->description = *placed;
  hl_status status = hl_labels_draw(context, &drawn->description, &drawn->labels, error);
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
