/* render/prepare.c - prepares volumes for frames. A volume's grid is made anew when its voxels change. Its
 * tables and relevant bricks are made anew when its transfer function changes. */
#include "render/prepare.h"

#include <string.h>

#include "core/memory.h"
#include "grid/faces.h"
#include "grid/make_grid.h"
#include "grid/relevant.h"
#include "isosurface/caps.h"
#include "isosurface/isosurface.h"
#include "scene/label/draw_labels.h"

static bool same_points(const void *a, const void *b, size_t bytes) {
  return bytes == 0 || memcmp(a, b, bytes) == 0;
}

static bool same_function(const hl_transfer_function *a, const hl_transfer_function *b) {
  return a->unit_distance == b->unit_distance && a->opacity_count == b->opacity_count &&
         a->color_count == b->color_count && a->gradient_opacity_count == b->gradient_opacity_count &&
         a->plane.second == b->plane.second && a->plane.second_scale == b->plane.second_scale &&
         same_points(a->opacity, b->opacity, a->opacity_count * sizeof *a->opacity) &&
         same_points(a->color, b->color, a->color_count * sizeof *a->color) &&
         same_points(a->gradient_opacity, b->gradient_opacity,
                     a->gradient_opacity_count * sizeof *a->gradient_opacity);
}

static bool same_clip(const prepared_volume *prepared, const hl_scene_volume *scene) {
  if (prepared->clipped != scene->clipped) return false;
  return !scene->clipped || (memcmp(prepared->clip, scene->clip_min, sizeof scene->clip_min) == 0 &&
                             memcmp(prepared->clip + 3, scene->clip_max, sizeof scene->clip_max) == 0);
}

/* The shape of a cut in the grid's index space, which may be shifted against the volume's index space. */
static cut_shape cut_in_grid(const hl_scene_volume *scene, size_t cut, const grid *grid) {
  cut_shape shape = hl_cut_shape(scene, cut);
  const vec3 shift = mat3_apply(shape.to_shape.linear, vec3_of(grid->shift));
  shape.to_shape.offset = vec3_subtract(shape.to_shape.offset, shift);
  return shape;
}

static bool same_cuts(const prepared_volume *prepared, const hl_scene_volume *scene) {
  const grid *grid = &prepared->grid;
  if (grid->cut_count != scene->cut_count) return false;
  for (size_t i = 0; i < scene->cut_count; i++) {
    cut_shape shape = cut_in_grid(scene, i, grid);
    if (!hl_cut_same(&prepared->cuts[i], &shape)) return false;
  }
  return grid->cut_count == 0 || grid->cut_casts_shadow == (scene->cut_casts_shadow != 0);
}

static hl_status keep_cuts(hl_context *context, prepared_volume *prepared, const hl_scene_volume *scene,
                           hl_error *error) {
  grid *grid = &prepared->grid;
  hl_release(context, prepared->cuts);
  grid->cuts = prepared->cuts = NULL;
  grid->cut_count = 0;
  if (scene->cut_count > 0) {
    prepared->cuts = hl_allocate(context, scene->cut_count, sizeof *prepared->cuts);
    if (prepared->cuts == NULL)
      return hl_fail_memory(error, scene->cut_count * sizeof *prepared->cuts, "cuts");
  }
  for (size_t i = 0; i < scene->cut_count; i++) prepared->cuts[i] = cut_in_grid(scene, i, grid);
  grid->cuts = prepared->cuts;
  grid->cut_count = scene->cut_count;
  grid->cut_casts_shadow = scene->cut_casts_shadow != 0;
  return HL_OK;
}

/* Memory into which a transfer function's points are copied. */
typedef struct function_points {
  hl_opacity_point *opacity; /* owns the block */
  hl_color_point *color;
  hl_opacity_point *gradient_opacity;
} function_points;

static void lay_out_points(const hl_transfer_function *function, function_points *points, hl_layout *layout) {
  points->opacity = hl_layout_take(layout, function->opacity_count, sizeof *points->opacity);
  points->color = hl_layout_take(layout, function->color_count, sizeof *points->color);
  points->gradient_opacity = hl_layout_take(layout, function->gradient_opacity_count,
                                            sizeof *points->gradient_opacity);
}

void hl_prepared_count(const hl_scene_volume *scene, hl_kernel kernel, const grid_functions *functions,
                       int threads, hl_layout *layout) {
  hl_grid_count(scene->volume, hl_kernel_get(hl_kernel_of_volume(scene, kernel)), functions, threads, layout);
  hl_classifier_lay_out(&scene->transfer_function, &(classifier){0}, layout);
  lay_out_points(&scene->transfer_function, &(function_points){0}, layout);
}

static hl_status keep_key(hl_context *context, prepared_volume *prepared, const hl_scene_volume *scene,
                          hl_error *error) {
  const hl_transfer_function *function = &scene->transfer_function;
  function_points points = {0};
  hl_layout layout = {0};
  while (hl_layout_pass(&layout, context)) lay_out_points(function, &points, &layout);
  if (layout.base == NULL) return hl_fail_memory(error, layout.bytes, "a transfer function");
  if (function->opacity_count > 0)
    memcpy(points.opacity, function->opacity, function->opacity_count * sizeof *points.opacity);
  if (function->color_count > 0)
    memcpy(points.color, function->color, function->color_count * sizeof *points.color);
  if (function->gradient_opacity_count > 0)
    memcpy(points.gradient_opacity, function->gradient_opacity,
           function->gradient_opacity_count * sizeof *points.gradient_opacity);
  prepared->function = *function;
  prepared->function.opacity = points.opacity;
  prepared->function.color = points.color;
  prepared->function.gradient_opacity = points.gradient_opacity;
  prepared->clipped = scene->clipped;
  memcpy(prepared->clip, scene->clip_min, sizeof scene->clip_min);
  memcpy(prepared->clip + 3, scene->clip_max, sizeof scene->clip_max);
  return HL_OK;
}

static void release_function(hl_context *context, prepared_volume *prepared) {
  hl_release(context, (void *)prepared->function.opacity);
  memset(&prepared->function, 0, sizeof prepared->function);
  hl_classifier_release(context, &prepared->classifier);
}

static void release_iso(hl_context *context, prepared_volume *prepared) {
  for (size_t i = 0; i < prepared->iso_count; i++) hl_mesh_release(prepared->iso[i].mesh);
  hl_release(context, prepared->iso);
  prepared->iso = NULL;
  prepared->iso_count = 0;
}

void hl_prepared_release(hl_context *context, prepared_volume *prepared) {
  release_function(context, prepared);
  release_iso(context, prepared);
  hl_grid_release(context, &prepared->grid);
  hl_release(context, prepared->cuts);
  hl_volume_release(prepared->volume);
  hl_volume_release(prepared->mask);
  hl_volume_release(prepared->second);
  *prepared = (prepared_volume){.version = prepared->version, .tables_version = prepared->tables_version};
}

/* Returns whether the grid that was kept still fits the scene's volume. */
static bool has_same_voxels(const prepared_volume *prepared, const hl_scene_volume *scene, hl_kernel kernel) {
  return prepared->volume == scene->volume && prepared->kernel == hl_kernel_of_volume(scene, kernel) &&
         prepared->empty == hl_scene_volume_empty_value(scene) && same_clip(prepared, scene);
}

void hl_prepared_release_stale(hl_context *context, const hl_scene_description *scene,
                               prepared_volume *prepared) {
  for (size_t i = 0; i < scene->volume_count; i++)
    if (!has_same_voxels(&prepared[i], &scene->volumes[i], scene->render.kernel))
      hl_prepared_release(context, &prepared[i]);
}

/* The context, the threads and the scene's kernel with which volumes are prepared. */
typedef struct preparation {
  hl_context *context;
  hl_pool *pool;
  const grid_functions *functions;
  hl_kernel kernel;
} preparation;

/* Keeps the volume's mask. The mask is retained so that no other mask can get its address: the address is
 * part of the keys of kept light. Returns whether the mask is the same as in the frame before. */
static bool hold_mask(prepared_volume *prepared, const hl_scene_volume *scene) {
  const mask_lattice before = prepared->classifier.mask;
  hl_volume_retain(scene->mask.volume);
  hl_volume_release(prepared->mask);
  prepared->mask = scene->mask.volume;
  hl_mask_lattice_set_up(&prepared->classifier.mask, scene);
  const mask_lattice *now = &prepared->classifier.mask;
  return now->factors == before.factors && now->rest == before.rest;
}

/* The volume whose values are the second number of a function of two numbers; null if there is no such
 * volume. */
static const hl_scene_volume *second_of(const hl_scene_description *all, const hl_scene_volume *scene) {
  const hl_function_plane *plane = &scene->transfer_function.plane;
  return plane->second == HL_SECOND_VOLUME ? hl_scene_volume_named(all, plane->volume) : NULL;
}

static bool same_second(const prepared_volume *prepared, const hl_scene_volume *second) {
  if (second == NULL) return prepared->second == NULL;
  return prepared->second == second->volume && prepared->second_empty == hl_scene_volume_empty_value(second);
}

/* Keeps the second volume of a function of two numbers. It is retained so that no other volume can get its
 * address, which is part of the keys of kept light. */
static void hold_second(prepared_volume *prepared, const hl_scene_volume *second) {
  hl_volume *volume = second != NULL ? second->volume : NULL;
  hl_volume_retain(volume);
  hl_volume_release(prepared->second);
  prepared->second = volume;
  if (second != NULL) prepared->second_empty = hl_scene_volume_empty_value(second);
}

static hl_status prepare_volume(const preparation *with, const hl_scene_volume *scene,
                                const hl_scene_volume *second, uint64_t plane_mark, prepared_volume *prepared,
                                hl_error *error) {
  hl_context *context = with->context;
  hl_pool *pool = with->pool;
  const hl_kernel kernel = hl_kernel_of_volume(scene, with->kernel);
  const affine3 index_to_frame = hl_scene_volume_index_to_world(scene);
  hl_status status = HL_OK;
  double empty = hl_scene_volume_empty_value(scene);
  bool same_voxels = has_same_voxels(prepared, scene, kernel);
  bool same_cut = same_voxels && same_cuts(prepared, scene);
  bool same = same_cut && same_function(&prepared->function, &scene->transfer_function) &&
              prepared->plane_mark == plane_mark && same_second(prepared, second);
  if (!same_voxels) {
    hl_prepared_release(context, prepared);
    const grid_source source = {scene, hl_kernel_get(kernel), index_to_frame, empty};
    status = hl_grid_create(context, pool, with->functions, &source, &prepared->grid, error);
    if (status == HL_OK) status = hl_pool_check(pool, "preparing", error);
    if (status != HL_OK) return status;
    hl_volume_retain(scene->volume);
    prepared->version++;
    prepared->volume = scene->volume;
    prepared->empty = empty;
    prepared->kernel = kernel;
  }
  prepared->scene = scene;
  if (!hl_grid_place(&prepared->grid, index_to_frame))
    return hl_fail(error, HL_ERROR_INPUT, "a volume's axes are singular: the three must span space");
  hold_second(prepared, second);
  if (hold_mask(prepared, scene) && same) return HL_OK;
  release_function(context, prepared);
  if (!same_cut) release_iso(context, prepared);
  if (!same_cut && (status = keep_cuts(context, prepared, scene, error)) != HL_OK) return status;
  status = hl_classifier_create(context, scene, second, &prepared->grid, &prepared->classifier, error);
  hl_mask_lattice_set_up(&prepared->classifier.mask, scene);
  if (status == HL_OK) status = keep_key(context, prepared, scene, error);
  prepared->plane_mark = plane_mark;
  if (status != HL_OK) return status;
  hl_grid_mark_relevant(&prepared->grid, with->functions, &prepared->classifier, pool);
  prepared->tables_version++;
  hl_faces_find(pool, hl_kernel_get(kernel), &prepared->classifier, &prepared->grid);
  return hl_pool_check(pool, "preparing", error);
}

hl_status hl_prepare_volumes(hl_context *context, hl_pool *pool, const hot_functions *hot,
                             const hl_scene_description *scene, const uint64_t *plane_marks,
                             prepared_volume *prepared, hl_error *error) {
  const preparation with = {context, pool, hot->grid, scene->render.kernel};
  for (size_t i = 0; i < scene->volume_count; i++) {
    const hl_scene_volume *second = second_of(scene, &scene->volumes[i]);
    hl_status status = prepare_volume(&with, &scene->volumes[i], second, plane_marks[i], &prepared[i], error);
    if (status != HL_OK) {
      hl_prepared_release(context, &prepared[i]);
      return status;
    }
  }
  for (size_t i = 0; i < scene->volume_count; i++) {
    const hl_scene_volume *second = second_of(scene, &scene->volumes[i]);
    if (second != NULL)
      hl_plane_table_set_second(&prepared[i].classifier.plane, second->volume,
                                &prepared[second - scene->volumes].grid);
  }
  return HL_OK;
}

/* ---- isosurfaces ---- */

/* Finds the coloring of isosurface i of a volume. Returns a hash of what it follows from; 0 if the surface
 * has none. */
static uint64_t find_coloring(const hl_scene_volume *second, const prepared_volume *prepared, size_t i,
                              iso_coloring *coloring) {
  const hl_scene_volume *scene = prepared->scene;
  if (second == NULL || !hl_iso_has_second_color(scene, i)) return 0;
  affine3 to_index;
  if (!affine3_invert(hl_scene_volume_index_to_world(second), &to_index)) return 0;
  *coloring = (iso_coloring){
      .second = second,
      .index_to_second = affine3_multiply(to_index, hl_scene_volume_index_to_world(scene)),
      .own_color = scene->iso[i].color};
  const uint64_t parts[] = {prepared->plane_mark, (uint64_t)(uintptr_t)second->volume,
                            hl_key_mark(&coloring->index_to_second, sizeof coloring->index_to_second),
                            hl_key_mark(scene->iso[i].color, sizeof scene->iso[i].color)};
  return hl_key_mark(parts, sizeof parts) | 1;
}

/* Finds the isosurface of the frame before that has the same value, axes, caps and colours as the wanted one;
 * null if there is none. If voxels, clip box or cuts have changed, prepare_volume() has already released all
 * surfaces of the frame before. */
static const prepared_iso *known_iso(const prepared_volume *prepared, const prepared_iso *wanted) {
  for (size_t i = 0; i < prepared->iso_count; i++) {
    const prepared_iso *known = &prepared->iso[i];
    if (known->value == wanted->value && known->capped == wanted->capped && known->colors == wanted->colors &&
        memcmp(known->axis_scale, wanted->axis_scale, sizeof wanted->axis_scale) == 0)
      return known;
  }
  return NULL;
}

/* Prepares the isosurfaces of a volume. second: the volume of its function's second number; may be null.
 * grid: the prepared grid, whose faces are open where another volume continues the matter. */
static hl_status prepare_iso(hl_context *context, hl_pool *pool, const hl_scene_volume *second,
                             const grid *grid, prepared_volume *prepared, hl_error *error) {
  const hl_scene_volume *scene = prepared->scene;
  prepared_iso *made = hl_allocate_zeroed(context, scene->iso_count, sizeof *made);
  hl_status status = HL_OK;
  if (made == NULL) return hl_fail_memory(error, scene->iso_count * sizeof *made, "isosurfaces");
  for (size_t i = 0; i < scene->iso_count && status == HL_OK; i++) {
    iso_coloring coloring;
    made[i].value = scene->iso[i].value;
    made[i].colors = find_coloring(second, prepared, i, &coloring);
    made[i].capped = hl_iso_capped_faces(grid);
    memcpy(made[i].axis_scale, scene->axis_scale, sizeof made[i].axis_scale);
    const prepared_iso *known = known_iso(prepared, &made[i]);
    if (known != NULL) {
      made[i].mesh = known->mesh;
      hl_mesh_retain(known->mesh);
    } else {
      status = hl_isosurface_create(pool, scene, grid, hl_kernel_get(prepared->kernel), made[i].value,
                                    made[i].colors != 0 ? &coloring : NULL, &made[i].mesh, error);
    }
  }
  release_iso(context, prepared);
  prepared->iso = made;
  prepared->iso_count = scene->iso_count;
  if (status != HL_OK) release_iso(context, prepared);
  return status;
}

/* Makes a copy of a volume's grid whose faces are open where another volume continues the matter. */
static grid grid_with_open_faces(const hl_scene_description *scene, const prepared_volume *prepared,
                                 size_t volume) {
  grid grid = prepared[volume].grid;
  for (int axis = 0; axis < 3; axis++) {
    grid.face_low[axis] = (float)grid.box_low[axis];
    grid.face_high[axis] = (float)grid.box_high[axis];
  }
  for (size_t i = 0; i < scene->volume_count; i++)
    if (i != volume && scene->volumes[i].casts_shadow) hl_open_faces(&grid, &prepared[i].grid);
  return grid;
}

hl_status hl_prepare_isosurfaces(hl_context *context, hl_pool *pool, const hl_scene_description *scene,
                                 prepared_volume *prepared, hl_error *error) {
  hl_status status = HL_OK;
  for (size_t i = 0; i < scene->volume_count && status == HL_OK; i++) {
    if (scene->volumes[i].iso_count == 0 && prepared[i].iso_count == 0) continue;
    const grid grid = grid_with_open_faces(scene, prepared, i);
    status = prepare_iso(context, pool, second_of(scene, &scene->volumes[i]), &grid, &prepared[i], error);
  }
  return status;
}
