/* volume/formats/zarr/image.c - reads OME-Zarr's metadata of an image. */
#include "volume/formats/zarr/image.h"

#include <math.h>
#include <string.h>

#include "core/context.h"
#include "core/memory.h"
#include "volume/formats/zarr/array_read.h"
#include "volume/io/lengths.h"
#include "volume/io/text.h"

static hl_status make_levels(const hl_bundle *bundle, int count, hl_zarr_image *image, hl_error *error) {
  *image = (hl_zarr_image){.context = bundle->context, .level_count = count};
  image->levels = hl_allocate_zeroed(bundle->context, (size_t)count, sizeof *image->levels);
  if (image->levels == NULL) return hl_fail_memory(error, sizeof *image->levels, "a list of levels");
  for (int level = 0; level < count; level++)
    for (int axis = 0; axis < HL_ZARR_AXES_MOST; axis++) image->levels[level].scale[axis] = 1;
  return HL_OK;
}

void hl_zarr_image_release(hl_zarr_image *image) {
  if (image->levels != NULL) hl_release(image->context, image->levels);
  image->levels = NULL;
}

/* ---- axes ---- */

static hl_zarr_axis axis_of_name(const char *name) {
  static const char *const names[] = {"x", "y", "z", "t|time", "c|channel"};
  for (int n = 0; name != NULL && n < HL_ZARR_OTHER; n++)
    if (hl_text_is_one_of(name, names[n])) return (hl_zarr_axis)n;
  return HL_ZARR_OTHER;
}

/* Assigns kinds to axes without known names. Counted from the last axis, the kinds are x, y, z, channel and
 * time. */
static void take_places(int rank, hl_zarr_axis *axis) {
  static const hl_zarr_axis from_end[] = {HL_ZARR_X, HL_ZARR_Y, HL_ZARR_Z, HL_ZARR_CHANNEL, HL_ZARR_TIME};
  for (int n = 0; n < rank; n++) axis[rank - 1 - n] = n < HL_ZARR_OTHER ? from_end[n] : HL_ZARR_OTHER;
}

static bool names_are_known(int rank, const hl_zarr_axis *axis) {
  int seen[HL_ZARR_OTHER + 1] = {0};
  for (int n = 0; n < rank; n++) seen[axis[n]]++;
  for (int n = 0; n < HL_ZARR_OTHER; n++)
    if (seen[n] > 1) return false;
  return seen[HL_ZARR_X] == 1 && seen[HL_ZARR_Y] == 1;
}

/* Reads the axes. unit: set to the factors that convert lengths to micrometres, if all axes of space have
 * known units; otherwise set to 1. Returns whether all axes of space have known units. */
static bool read_axes(const json_t *axes, int rank, hl_zarr_axis *axis, double unit[3]) {
  bool told = json_array_size(axes) == (size_t)rank, all = true;
  for (int n = 0; n < rank && told; n++) {
    const json_t *entry = json_array_get(axes, (size_t)n);
    const char *name = json_string_value(json_is_string(entry) ? entry : json_object_get(entry, "name"));
    axis[n] = axis_of_name(name);
  }
  if (!told || !names_are_known(rank, axis)) take_places(rank, axis);
  for (int n = 0; n < rank; n++) {
    if (axis[n] > HL_ZARR_Z) continue;
    double length = hl_micrometres(
        json_string_value(json_object_get(json_array_get(axes, (size_t)n), "unit")));
    all = all && length > 0;
    unit[axis[n]] = length;
  }
  for (int a = 0; a < 3 && !all; a++) unit[a] = 1;
  return all;
}

/* ---- transformations ---- */

/* Applies a list of scales and translations to a level's coordinates, one after the other: x -> scale x +
 * translation. */
static hl_status apply(const hl_bundle *bundle, const char *folder, const json_t *transformations, int rank,
                       hl_zarr_level *level, hl_error *error) {
  for (size_t t = 0; t < json_array_size(transformations); t++) {
    const json_t *entry = json_array_get(transformations, t);
    const char *kind = json_string_value(json_object_get(entry, "type"));
    if (kind == NULL || strcmp(kind, "identity") == 0) continue;
    bool is_scale = strcmp(kind, "scale") == 0;
    const json_t *numbers = json_object_get(entry, kind);
    bool sound = (is_scale || strcmp(kind, "translation") == 0) && json_array_size(numbers) == (size_t)rank;
    for (int n = 0; n < rank && sound; n++) {
      double value = json_number_value(json_array_get(numbers, (size_t)n));
      sound = isfinite(value) && (!is_scale || value > 0);
      if (is_scale) level->scale[n] *= value;
      level->translation[n] = is_scale ? level->translation[n] * value : level->translation[n] + value;
    }
    if (!sound)
      return hl_zarr_fail(bundle, folder, error, HL_ERROR_UNSUPPORTED,
                          "\"coordinateTransformations\" other than \"scale\" (above 0) and \"translation\" "
                          "of a number for each axis: write the image with these");
  }
  return HL_OK;
}

/* Finds the scales of levels from their shapes, for versions before 0.4, in which no level states its scale.
 * All levels are assumed to cover the same space. */
static void scale_by_shape(hl_zarr_image *image) {
  for (int n = 1; n < image->level_count; n++)
    for (int axis = 0; axis < image->levels[0].array.rank; axis++) {
      double ratio = (double)image->levels[0].array.shape[axis] / (double)image->levels[n].array.shape[axis];
      image->levels[n].scale[axis] = ratio;
      image->levels[n].translation[axis] = (ratio - 1) / 2;
    }
}

/* ---- levels ---- */

static hl_status read_level(const hl_bundle *bundle, const char *folder, const json_t *dataset,
                            hl_zarr_level *level, hl_error *error) {
  const char *path = json_string_value(json_object_get(dataset, "path"));
  char joined[HL_ZARR_PATH_BYTES];
  bool found = false;
  if (path == NULL || !hl_zarr_join(joined, folder, path))
    return hl_zarr_fail(bundle, folder, error, HL_ERROR_INPUT,
                        "a level of \"datasets\" needs a \"path\" in the folder");
  hl_status status = hl_zarr_array_read(bundle, joined, &level->array, &found, error);
  return status == HL_OK && !found
             ? hl_zarr_fail(bundle, joined, error, HL_ERROR_INPUT, "there is no array, which a level names")
             : status;
}

/* Fetches the metadata of all levels from a server, in one request. Levels whose path is invalid are left
 * out; read_level() reports them. */
static hl_status bring_levels(const hl_bundle *bundle, const char *folder, const json_t *datasets,
                              hl_error *error) {
  char folders[HL_ZARR_LEVELS_MOST][HL_ZARR_PATH_BYTES];
  size_t count = 0;
  for (size_t n = 0; n < json_array_size(datasets) && count < HL_ZARR_LEVELS_MOST; n++) {
    const char *path = json_string_value(json_object_get(json_array_get(datasets, n), "path"));
    count += path != NULL && hl_zarr_join(folders[count], folder, path);
  }
  return hl_zarr_metadata_bring(bundle, folders, count, error);
}

static hl_status read_levels(const hl_bundle *bundle, const char *folder, const json_t *multiscale,
                             hl_zarr_image *image, hl_error *error) {
  const json_t *datasets = json_object_get(multiscale, "datasets");
  double unit[3];
  bool told = false;
  hl_status status = bring_levels(bundle, folder, datasets, error);
  for (int n = 0; n < image->level_count && status == HL_OK; n++) {
    hl_zarr_level *level = &image->levels[n];
    const json_t *dataset = json_array_get(datasets, (size_t)n);
    status = read_level(bundle, folder, dataset, level, error);
    int rank = level->array.rank;
    if (status == HL_OK && (rank < 2 || rank != image->levels[0].array.rank))
      status = hl_zarr_fail(bundle, folder, error, HL_ERROR_INPUT,
                            "levels must have two axes or more, and as many as the first level");
    if (n == 0 && status == HL_OK)
      image->has_unit = read_axes(json_object_get(multiscale, "axes"), rank, image->axis, unit);
    const json_t *own = json_object_get(dataset, "coordinateTransformations"),
                 *all = json_object_get(multiscale, "coordinateTransformations");
    told = told || json_array_size(own) > 0 || json_array_size(all) > 0;
    if (status == HL_OK) status = apply(bundle, folder, own, rank, level, error);
    if (status == HL_OK) status = apply(bundle, folder, all, rank, level, error);
    for (int axis = 0; axis < rank && status == HL_OK; axis++) {
      double factor = image->axis[axis] <= HL_ZARR_Z ? unit[image->axis[axis]] : 1;
      level->scale[axis] *= factor;
      level->translation[axis] *= factor;
    }
  }
  if (status == HL_OK && !told) scale_by_shape(image);
  return status;
}

hl_status hl_zarr_image_read(const hl_bundle *bundle, const char *folder, const json_t *ome,
                             hl_zarr_image *image, hl_error *error) {
  const json_t *multiscale = json_array_get(json_object_get(ome, "multiscales"), 0);
  size_t count = json_array_size(json_object_get(multiscale, "datasets"));
  *image = (hl_zarr_image){.context = bundle->context};
  if (count < 1 || count > HL_ZARR_LEVELS_MOST)
    return hl_zarr_fail(bundle, folder, error, HL_ERROR_INPUT,
                        "\"multiscales\" must name 1 to %d levels in \"datasets\"", HL_ZARR_LEVELS_MOST);
  size_t images = json_array_size(json_object_get(ome, "multiscales"));
  if (images > 1)
    hl_log(bundle->context, HL_LOG_WARNING,
           "%.300s: its \"multiscales\" describes %zu images: the first is taken", bundle->path, images);
  hl_status status = make_levels(bundle, (int)count, image, error);
  const char *name = json_string_value(json_object_get(multiscale, "name"));
  if (name != NULL) hl_text_printable(image->name, name);
  return status == HL_OK ? read_levels(bundle, folder, multiscale, image, error) : status;
}

hl_status hl_zarr_image_of_array(const hl_bundle *bundle, const hl_zarr_array *array, hl_zarr_image *image,
                                 hl_error *error) {
  *image = (hl_zarr_image){.context = bundle->context};
  if (array->rank < 2)
    return hl_zarr_fail(bundle, array->folder, error, HL_ERROR_INPUT, "an array of one axis is no volume");
  hl_status status = make_levels(bundle, 1, image, error);
  if (status != HL_OK) return status;
  image->levels[0].array = *array;
  for (int axis = 0; axis < array->rank; axis++) image->axis[axis] = axis_of_name(array->axis_name[axis]);
  if (!names_are_known(array->rank, image->axis)) take_places(array->rank, image->axis);
  return HL_OK;
}
