/* render/isosurface_mesh.c - hl_mesh_of_isosurface and hl_mesh_of_labels: the meshes that a frame makes of a
 * volume's isosurface, and of labels' surface, for other programs. */
#include <math.h>

#include "core/context.h"
#include "core/door.h"
#include "grid/make_grid.h"
#include "isosurface/isosurface.h"
#include "label/solids.h"
#include "render/hot.h"
#include "scene/geometry/placement.h"

static hl_status make_mesh(hl_pool *pool, const hl_scene_volume *seen, double value, hl_mesh **mesh,
                           hl_error *error) {
  hl_context *context = seen->volume->context;
  const hot_functions *hot = hl_hot_functions(context->options.instruction_set);
  const kernel *kernel = hl_kernel_get(HL_KERNEL_BSPLINE);
  const grid_source source = {seen, kernel, hl_scene_volume_index_to_world(seen),
                              hl_scene_volume_empty_value(seen)};
  grid grid = {0};
  hl_status status = hl_grid_create(context, pool, hot->grid, &source, &grid, error);
  if (status == HL_OK) status = hl_pool_check(pool, "preparing", error);
  if (status == HL_OK && !hl_grid_place(&grid, source.index_to_frame))
    status = hl_fail(error, HL_ERROR_INPUT, "a volume's axes are singular: the three must span space");
  if (status == HL_OK) status = hl_isosurface_create(pool, seen, &grid, kernel, value, NULL, mesh, error);
  hl_grid_release(context, &grid);
  return status;
}

hl_status hl_mesh_of_isosurface(hl_context *context, hl_volume *volume, double value, hl_mesh **mesh,
                                hl_error *error) {
  HL_DOOR;
  if (context == NULL || volume == NULL || mesh == NULL || !isfinite(value))
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "hl_mesh_of_isosurface: null context, volume or mesh, or a value that is not finite");
  *mesh = NULL;
  static const hl_opacity_point clear = {0, 0};
  hl_scene_volume seen;
  hl_scene_volume_defaults(&seen);
  seen.volume = volume;
  seen.transfer_function = (hl_transfer_function){.opacity = &clear, .opacity_count = 1, .unit_distance = 1};
  hl_pool *pool = NULL;
  hl_status status = hl_pool_create(context, 0, &pool, error);
  if (status != HL_OK) return status;
  status = make_mesh(pool, &seen, value, mesh, error);
  hl_pool_destroy(pool);
  if (status == HL_OK && *mesh == NULL)
    return hl_fail(error, HL_ERROR_INPUT,
                   "no surface: nowhere does the volume have the value %.9g: its values go "
                   "from %.9g to %.9g",
                   value, volume->minimum, volume->maximum);
  return status;
}

/* The occupancy at the surface of labels (label/occupancy.h). */
#define LABEL_SURFACE 0.5

hl_status hl_mesh_of_labels(hl_context *context, hl_volume *map, const hl_label *labels, size_t count,
                            hl_mesh **mesh, hl_error *error) {
  HL_DOOR;
  if (context == NULL || map == NULL || (labels == NULL && count > 0) || mesh == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_mesh_of_labels: null context, map, labels or mesh");
  *mesh = NULL;
  size_t shown = 0;
  hl_volume *occupancy = NULL;
  hl_label *solids = hl_allocate_zeroed(context, count > 0 ? count : 1, sizeof *solids);
  if (solids == NULL) return hl_fail_memory(error, count * sizeof *solids, "labels");
  for (size_t n = 0; n < count; n++)
    if (labels[n].visible) solids[shown++] = (hl_label){.value = labels[n].value, .opacity = 1, .visible = 1};
  hl_status status = shown > 0 ? hl_label_solids(context, 0, map, solids, shown, &occupancy, error) : HL_OK;
  if (status == HL_OK && occupancy == NULL)
    status = hl_fail(error, HL_ERROR_INPUT, "no surface: the label map has none of the labels");
  if (status == HL_OK) status = hl_mesh_of_isosurface(context, occupancy, LABEL_SURFACE, mesh, error);
  hl_volume_release(occupancy);
  hl_release(context, solids);
  return status;
}
