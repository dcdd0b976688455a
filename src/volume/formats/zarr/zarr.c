/* volume/formats/zarr/zarr.c - reads Zarr arrays and OME-Zarr images in folders, in zip archives and on
 * servers.
 *
 * The steps are in zarr/: metadata.c reads JSON files, array_read.c an array's metadata, image.c OME-Zarr's
 * axes and levels, series.c lists the images of a collection, voxels.c and chunk.c read the voxels. */
#define _GNU_SOURCE
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "core/context.h"
#include "core/file.h"
#include "core/memory.h"
#include "volume/formats/zarr/array_read.h"
#include "volume/formats/zarr/description.h"
#include "volume/formats/zarr/series.h"
#include "volume/formats/zarr/voxels.h"

/* ---- the root of the hierarchy ---- */

static bool is_marker(const char *name) {
  return strcmp(name, "zarr.json") == 0 || strcmp(name, ".zgroup") == 0 || strcmp(name, ".zarray") == 0 ||
         strcmp(name, ".zattrs") == 0;
}

/* Finds the root of the hierarchy in an archive. The root may be a folder of the archive. The root is the
 * folder of the marker file with the fewest folders in its path. */
static bool find_root_of_archive(const hl_bundle *bundle, char folder[HL_ZARR_PATH_BYTES]) {
  int least = HL_BUNDLE_DEPTH_MOST;
  for (size_t n = 0; n < bundle->count; n++) {
    const char *name = bundle->entries[n].name, *last = strrchr(name, '/');
    if (!is_marker(last != NULL ? last + 1 : name)) continue;
    int depth = 0;
    for (const char *c = name; *c != 0; c++) depth += *c == '/';
    size_t length = last != NULL ? (size_t)(last + 1 - name) : 0;
    if (depth >= least || length >= HL_ZARR_PATH_BYTES) continue;
    least = depth;
    memcpy(folder, name, length);
    folder[length] = 0;
  }
  return least < HL_BUNDLE_DEPTH_MOST;
}

static hl_status find_root(hl_bundle *bundle, char folder[HL_ZARR_PATH_BYTES], bool *found, hl_error *error) {
  static const char *const markers[] = {"zarr.json", ".zgroup", ".zarray", ".zattrs"};
  static const char root[1][HL_ZARR_PATH_BYTES] = {""};
  hl_status status = hl_bundle_find_ready(bundle, error);
  folder[0] = 0;
  *found = false;
  if (bundle->is_archive) *found = find_root_of_archive(bundle, folder);
  if (status == HL_OK) status = hl_zarr_metadata_bring(bundle, root, 1, error);
  for (int n = 0; n < 4 && status == HL_OK && !*found && !bundle->is_archive; n++) {
    hl_source *source = NULL;
    status = hl_bundle_find(bundle, markers[n], true, &source, error);
    *found = source != NULL;
    hl_source_close(source);
  }
  return status;
}

/* ---- one image ---- */

/* Finds the sizes along x, y, z of the volume that is made of a level. */
static void level_sizes(const hl_zarr_image *image, int level, size_t sizes[3]) {
  const hl_zarr_array *array = &image->levels[level].array;
  for (int a = 0; a < 3; a++) sizes[a] = 1;
  for (int axis = 0; axis < array->rank; axis++)
    if (image->axis[axis] <= HL_ZARR_Z) sizes[image->axis[axis]] = (size_t)array->shape[axis];
}

static hl_status choose_level(const hl_zarr_image *image, const char *path, hl_load_request *request,
                              hl_error *error) {
  hl_level_size sizes[HL_ZARR_LEVELS_MOST];
  for (int level = 0; level < image->level_count; level++) {
    level_sizes(image, level, sizes[level].dimensions);
    sizes[level].type = image->levels[level].array.type;
  }
  return hl_level_choose(request, path, sizes, (size_t)image->level_count, error);
}

/* Describes the volume's grid, and finds which of the array's axes are the grid's axes. */
static void describe(const hl_zarr_image *image, int number, hl_payload *payload, hl_zarr_choice *choice) {
  const hl_zarr_level *level = &image->levels[number];
  double known = 1;
  hl_payload_defaults(payload);
  *choice = (hl_zarr_choice){.axis = {-1, -1, -1}};
  level_sizes(image, number, payload->grid.dimensions);
  payload->grid.type = level->array.type;
  for (int axis = 0; axis < level->array.rank; axis++) {
    int a = (int)image->axis[axis];
    if (a > HL_ZARR_Z) continue;
    choice->axis[a] = axis;
    payload->grid.axis[a][a] = level->scale[axis];
    payload->grid.origin[a] = level->translation[axis];
    known = level->scale[axis];
  }
  if (choice->axis[HL_ZARR_Z] < 0) payload->grid.axis[HL_ZARR_Z][HL_ZARR_Z] = known;
}

/* The size of the array along the axis of a kind, such as time; 1 without such an axis. *axis: set to the
 * index of the axis; -1 if the array has no such axis. */
static size_t count_along(const hl_zarr_image *image, const hl_zarr_array *array, hl_zarr_axis kind,
                          int *axis) {
  *axis = -1;
  for (int n = 0; n < array->rank; n++)
    if (image->axis[n] == kind) *axis = n;
  return *axis >= 0 ? (size_t)array->shape[*axis] : 1;
}

static hl_status choose_steps(const hl_zarr_image *image, const hl_zarr_array *array, const char *path,
                              const json_t *ome, hl_load_request *request, hl_zarr_choice *choice,
                              hl_error *error) {
  int time, channel;
  size_t times = count_along(image, array, HL_ZARR_TIME, &time),
         channels = count_along(image, array, HL_ZARR_CHANNEL, &channel);
  hl_status status = hl_steps_choose(request, path, times, channels, error);
  if (status == HL_OK && ome != NULL) status = hl_zarr_describe_channels(ome, path, request, error);
  if (time >= 0) choice->index[time] = (uint64_t)request->selection.time;
  if (channel >= 0) choice->index[channel] = (uint64_t)request->selection.channel;
  for (int axis = 0; axis < array->rank && status == HL_OK; axis++)
    if (image->axis[axis] == HL_ZARR_OTHER && array->shape[axis] > 1)
      hl_log(request->context, HL_LOG_WARNING, "%.300s: axis %d has %llu entries: the first is taken", path,
             axis, (unsigned long long)array->shape[axis]);
  return status;
}

/* Reads the voxels of an image. ome: the metadata that describe its channels; null if the file has no such
 * metadata. */
static hl_status load_image(const hl_bundle *bundle, const hl_zarr_image *image, const json_t *ome,
                            hl_load_request *request, hl_volume **volume, hl_error *error) {
  hl_payload payload;
  hl_zarr_choice choice;
  hl_status status = choose_level(image, bundle->path, request, error);
  if (status != HL_OK) return status;
  const hl_zarr_array *array = &image->levels[request->selection.level].array;
  describe(image, request->selection.level, &payload, &choice);
  if (image->has_unit) request->unit = "micrometre";
  status = choose_steps(image, array, bundle->path, ome, request, &choice, error);
  if (status == HL_OK) status = hl_volume_check_grid(&payload.grid, bundle->path, error);
  if (status == HL_OK && request->array_count == 0)
    status = hl_component_only(request, bundle->path, false, &payload, error);
  else if (status == HL_OK) status = hl_component_choose(request, bundle->path, false, &payload, error);
  if (status != HL_OK) return status;
  hl_volume_description grid = hl_payload_grid(&payload, request->spacing);
  hl_beyond_prepare(request->coarse, request->seen, request->seen_count, &grid, &choice.beyond);
  hl_destination to = {.context = NULL};
  status = hl_zarr_voxels_read(bundle, array, &choice, &grid, &to, &request->absence,
                               &request->resolutions.is_part, error);
  if (status == HL_OK) status = hl_destination_adopt(&to, &grid, volume, error);
  hl_destination_close(&to);
  return status;
}

/* ---- arrays without OME-Zarr's metadata ---- */

static hl_status load_array(const hl_bundle *bundle, const hl_zarr_array *array, hl_load_request *request,
                            hl_volume **volume, hl_error *error) {
  hl_zarr_image image;
  hl_status status = hl_zarr_image_of_array(bundle, array, &image, error);
  if (status == HL_OK) status = load_image(bundle, &image, NULL, request, volume, error);
  hl_zarr_image_release(&image);
  return status;
}

/* Adds the array `name` of a group to the request's list, if it exists and can hold a volume. A damaged
 * array, and an array of an unknown type, is listed without a type. */
static hl_status list_array(const hl_bundle *bundle, const char *folder, const char *name,
                            hl_load_request *request, hl_error *error) {
  char path[HL_ZARR_PATH_BYTES];
  hl_zarr_array array;
  hl_error unread = {0};
  bool found = false;
  if (!hl_zarr_join(path, folder, name)) return HL_OK;
  hl_status status = hl_zarr_array_read(bundle, path, &array, &found, &unread);
  if (status == HL_ERROR_MEMORY) return hl_fail(error, status, "%s", unread.message);
  if (!found || (status == HL_OK && array.rank < 2)) return HL_OK;
  return hl_arrays_add(request, name, 1, status == HL_OK ? array.type : 0, false, error);
}

static int by_text(const void *a, const void *b) { return strcmp(*(char *const *)a, *(char *const *)b); }

/* Lists the names of the files in a folder, sorted. The list and the names are owned by the caller. */
static hl_status list_folder(const hl_bundle *bundle, char **names, size_t *count, hl_error *error) {
  int descriptor = -1;
  hl_status status = HL_OK;
  *count = 0;
  if (hl_folder_open(bundle->context, bundle->path, &descriptor, NULL) != HL_OK) return HL_OK;
  DIR *folder = fdopendir(descriptor);
  if (folder == NULL) close(descriptor);
  for (struct dirent *entry;
       folder != NULL && status == HL_OK && *count < HL_ARRAYS_MOST && (entry = readdir(folder)) != NULL;) {
    if (entry->d_name[0] == '.') continue;
    names[*count] = hl_copy_text(bundle->context, entry->d_name);
    if (names[*count] == NULL) status = hl_fail_memory(error, strlen(entry->d_name), bundle->path);
    else ++*count;
  }
  if (folder != NULL) closedir(folder);
  qsort(names, *count, sizeof *names, by_text);
  return status;
}

/* Lists the names of the arrays in a folder of an archive. The names are sorted. The caller owns the list and
 * the names. */
static hl_status list_archive(const hl_bundle *bundle, const char *root, char **names, size_t *count,
                              hl_error *error) {
  size_t length = strlen(root);
  hl_status status = HL_OK;
  *count = 0;
  for (size_t n = 0; n < bundle->count && status == HL_OK && *count < HL_ARRAYS_MOST; n++) {
    const char *name = bundle->entries[n].name;
    if (strncmp(name, root, length) != 0) continue;
    const char *slash = strchr(name + length, '/');
    if (slash == NULL || !is_marker(slash + 1)) continue;
    char *copy = hl_copy_text(bundle->context, name + length);
    if (copy == NULL) return hl_fail_memory(error, strlen(name), bundle->path);
    copy[slash - name - (ptrdiff_t)length] = 0;
    bool known = *count > 0 && strcmp(names[*count - 1], copy) == 0;
    if (known) hl_release(bundle->context, copy);
    else names[(*count)++] = copy;
  }
  return status;
}

static hl_status list_arrays(const hl_bundle *bundle, const char *folder, hl_load_request *request,
                             hl_error *error) {
  char **names = hl_allocate_zeroed(bundle->context, HL_ARRAYS_MOST, sizeof *names);
  size_t count = 0;
  if (names == NULL) return hl_fail_memory(error, HL_ARRAYS_MOST * sizeof *names, "a list of arrays");
  hl_status status = bundle->is_archive ? list_archive(bundle, folder, names, &count, error)
                                        : list_folder(bundle, names, &count, error);
  for (size_t n = 0; n < count; n++) {
    if (status == HL_OK) status = list_array(bundle, folder, names[n], request, error);
    hl_release(bundle->context, names[n]);
  }
  hl_release(bundle->context, names);
  return status;
}

/* Loads one of the arrays of a group that has no metadata of OME-Zarr. */
static hl_status load_group(const hl_bundle *bundle, const char *folder, hl_load_request *request,
                            hl_volume **volume, hl_error *error) {
  char path[HL_ZARR_PATH_BYTES];
  hl_zarr_array array;
  bool found = false;
  if (hl_bundle_is_on_server(bundle))
    return hl_fail(
        error, HL_ERROR_UNSUPPORTED,
        "%s: a Zarr group without an OME-Zarr image, and a server does not list its arrays: give the "
        "URL of one of them",
        bundle->path);
  hl_status status = list_arrays(bundle, folder, request, error);
  if (status == HL_OK && request->array_count == 0)
    return hl_fail(error, HL_ERROR_INPUT,
                   "%s: a Zarr group with neither an OME-Zarr image nor an array of two axes or more in it",
                   bundle->path);
  if (status == HL_OK) status = hl_arrays_choose(request, bundle->path, -1, error);
  if (status != HL_OK) return status;
  if (!hl_zarr_join(path, folder, request->arrays[request->chosen].name))
    return hl_fail(error, HL_ERROR_INPUT, "%s: the name of an array is too long", bundle->path);
  status = hl_zarr_array_read(bundle, path, &array, &found, error);
  return status == HL_OK ? load_array(bundle, &array, request, volume, error) : status;
}

/* ---- all steps together ---- */

static hl_status load_described(const hl_bundle *bundle, const char *folder, const json_t *ome,
                                hl_load_request *request, hl_volume **volume, hl_error *error) {
  hl_zarr_image image;
  hl_status status = hl_zarr_image_read(bundle, folder, ome, &image, error);
  if (status == HL_OK) status = load_image(bundle, &image, ome, request, volume, error);
  hl_zarr_image_release(&image);
  if (status != HL_OK) return status;
  status = hl_zarr_name_labels(ome, *volume, error);
  if (status == HL_OK) status = hl_zarr_list_label_maps(bundle, folder, *volume, error);
  if (status != HL_OK) hl_volume_release(*volume), *volume = NULL;
  return status;
}

/* Loads a group or an array. depth: the number of collections, such as a plate and a well, that contain the
 * group or array. */
static hl_status load_node(const hl_bundle *bundle, char folder[HL_ZARR_PATH_BYTES], int depth,
                           hl_load_request *request, hl_volume **volume, hl_error *error) {
  json_t *attributes;
  bool is_collection = false, found = false;
  hl_zarr_array array;
  hl_status status = hl_zarr_attributes_read(bundle, folder, &attributes, error);
  if (status != HL_OK) return status;
  const json_t *ome = hl_zarr_ome(attributes);
  if (json_object_get(ome, "multiscales") != NULL) {
    status = load_described(bundle, folder, ome, request, volume, error);
  } else {
    if (depth == 0) status = hl_zarr_series_choose(bundle, ome, request, folder, &is_collection, error);
    if (status == HL_OK && is_collection) status = load_node(bundle, folder, 1, request, volume, error);
    else if (status == HL_OK) {
      status = hl_zarr_array_read(bundle, folder, &array, &found, error);
      if (status == HL_OK)
        status = found ? load_array(bundle, &array, request, volume, error)
                       : load_group(bundle, folder, request, volume, error);
    }
  }
  json_decref(attributes);
  return status;
}

static hl_status load_bundle(hl_bundle *bundle, hl_load_request *request, bool *claimed, hl_volume **volume,
                             hl_error *error) {
  char folder[HL_ZARR_PATH_BYTES];
  hl_status status = find_root(bundle, folder, claimed, error);
  return status == HL_OK && *claimed ? load_node(bundle, folder, 0, request, volume, error) : status;
}

const hl_format hl_format_zarr = {.name = "OME-Zarr", .load_bundle = load_bundle, .finds_by_name = true};
