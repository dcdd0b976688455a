/* page/seen.c - finds the box of a volume outside which nothing is visible.
 *
 * Planes of voxels without visible matter are left out at both ends of each axis. A plane has visible matter
 * if any value between the least and the greatest value of the plane and its neighbouring planes is visible.
 * The field between voxels has no other values, because all kernels except the interpolating one are means
 * with positive weights. In a label map, a voxel counts as 1 if its label is visible, else as 0. */
#include "page/seen.h"

#include <math.h>
#include <string.h>

#include "core/context.h"
#include "core/memory.h"
#include "volume/volume.h"

enum { AROUND = 3 }; /* number of voxels, on each side of the visible voxels, that kernels and normals read */

/* ---- the opacity of a value ---- */

static bool has_opacity_at(const hl_transfer_function *function, double value) {
  const hl_opacity_point *point = function->opacity;
  size_t count = function->opacity_count, n = 0;
  while (n < count && point[n].value < value) n++;
  if (n == count) return count > 0 && point[count - 1].opacity > 0;
  if (n == 0 || point[n].value == value) return point[n].opacity > 0;
  return point[n].opacity > 0 || point[n - 1].opacity > 0; /* the opacity is a straight line between two
                                                            * points */
}

static bool label_shows(const hl_scene_volume *volume, int64_t value) {
  size_t low = 0, high = volume->label_count;
  while (low < high) { /* the labels are sorted by value */
    size_t middle = (low + high) / 2;
    if (volume->labels[middle].value < value) low = middle + 1;
    else high = middle;
  }
  return low < volume->label_count && volume->labels[low].value == value && volume->labels[low].visible;
}

static bool shows(const hl_scene_volume *volume, double low, double high) {
  if (!(low <= high)) return false;
  if (volume->label_count > 0) return high > 0;
  for (size_t n = 0; n < volume->iso_count; n++)
    if (volume->iso[n].value >= low && volume->iso[n].value <= high) return true;
  const hl_transfer_function *function = &volume->transfer_function;
  for (size_t n = 0; n < function->opacity_count; n++) {
    const hl_opacity_point *point = &function->opacity[n];
    if (point->opacity > 0 && point->value >= low && point->value <= high) return true;
  }
  return has_opacity_at(function, low) || has_opacity_at(function, high);
}

/* ---- planes of voxels ---- */

typedef struct plane_range {
  double low, high; /* the least and the greatest finite value of the voxels; low > high if no voxel is
                     * finite */
} plane_range;

static void widen(plane_range *range, double value) {
  range->low = fmin(range->low, value);
  range->high = fmax(range->high, value);
}

/* Finds the ranges of the values in all planes: first the planes along i, then the planes along j and k.
 * *bytes: whether all values are whole numbers from 0 to 255. */
static hl_status find_ranges(hl_context *context, const hl_scene_volume *volume, const size_t n[3],
                             plane_range *ranges, bool *bytes, hl_error *error) {
  plane_range *of_i = ranges, *of_j = of_i + n[0], *of_k = of_j + n[1];
  for (size_t p = 0; p < n[0] + n[1] + n[2]; p++) ranges[p] = (plane_range){INFINITY, -INFINITY};
  *bytes = true;
  for (size_t k = 0; k < n[2]; k++) {
    if (hl_cancelled(context)) return hl_fail(error, HL_ERROR_CANCELLED, "cancelled");
    for (size_t j = 0; j < n[1]; j++)
      for (size_t i = 0; i < n[0]; i++) {
        double value = hl_volume_value(volume->volume, i, j, k);
        *bytes = *bytes && value >= 0 && value <= 255 && value == floor(value);
        if (!isfinite(value)) continue;
        int64_t label;
        if (volume->label_count > 0)
          value = hl_volume_whole(volume->volume, i, j, k, &label) == HL_WHOLE_FOUND &&
                  label_shows(volume, label);
        widen(&of_i[i], value);
        widen(&of_j[j], value);
        widen(&of_k[k], value);
      }
  }
  return HL_OK;
}

static bool plane_shows(const hl_scene_volume *volume, const plane_range *planes, size_t count,
                        size_t number) {
  plane_range range = planes[number];
  for (size_t p = number > 0 ? number - 1 : 0; p <= number + 1 && p < count; p++) {
    range.low = fmin(range.low, planes[p].low);
    range.high = fmax(range.high, planes[p].high);
  }
  return shows(volume, range.low, range.high);
}

/* Finds the planes that are kept: from the first to the last plane with visible matter, and AROUND more
 * planes at each end. If no plane has visible matter, all planes are kept. */
static void find_ends(const hl_scene_volume *volume, const plane_range *planes, size_t count, size_t *begin,
                      size_t *end) {
  size_t first = 0, last = count - 1;
  while (first < count && !plane_shows(volume, planes, count, first)) first++;
  if (first == count) return;
  while (!plane_shows(volume, planes, count, last)) last--;
  *begin = first > AROUND ? first - AROUND : 0;
  *end = last + 1 + AROUND < count ? last + 1 + AROUND : count;
}

/* ---- all steps together ---- */

static bool stays_whole(const hl_scene_description *d, const hl_scene_volume *volume) {
  if (d->render.kernel == HL_KERNEL_INTERPOLATING) return true;
  /* A label map with isosurfaces also shows values, whose visibility this file does not test. */
  if (volume->label_count > 0 && volume->iso_count > 0) return true;
  for (size_t n = 0; n < d->volume_count; n++) {
    const char *other = d->volumes[n].transfer_function.plane.second == HL_SECOND_VOLUME
                            ? d->volumes[n].transfer_function.plane.volume
                            : NULL;
    if (other != NULL && volume->name != NULL && strcmp(other, volume->name) == 0) return true;
  }
  return false;
}

hl_status hl_seen_part(hl_context *context, const hl_scene *scene, size_t number,
                       hl_volume_save_options *options, hl_error *error) {
  const hl_scene_description *d = hl_scene_describe(scene);
  const hl_scene_volume *volume = &d->volumes[number];
  hl_volume_info info = {.struct_size = sizeof info};
  hl_status status = hl_volume_get_info(volume->volume, &info);
  if (status != HL_OK) return hl_fail(error, status, "volume %zu: has no size", number);
  const size_t *n = info.dimensions;
  size_t count = n[0] + n[1] + n[2];
  plane_range *ranges = hl_allocate(context, count, sizeof *ranges), *planes = ranges;
  bool bytes = false;
  if (ranges == NULL) return hl_fail_memory(error, count * sizeof *ranges, "ranges of planes");
  status = find_ranges(context, volume, n, ranges, &bytes, error);
  for (int axis = 0; axis < 3 && status == HL_OK && !stays_whole(d, volume); planes += n[axis++])
    find_ends(volume, planes, n[axis], &options->begin[axis], &options->end[axis]);
  if (status == HL_OK && bytes) options->type = HL_VOXEL_U8;
  hl_release(context, ranges);
  return status;
}
