/* volume/formats/zarr/series.c - lists the images of a collection.
 *
 * Sources: the layout `bioformats2raw.layout` 3, plates ("plate") and wells ("well") of OME-NGFF 0.4 and 0.5.
 * For a plate, the first field of each well is listed. */
#include "volume/formats/zarr/series.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "text/plain.h"
#include "volume/io/text.h"

enum { SERIES_MOST = 256 };

/* Adds the image in base/path to the list. *found: set to false if no image has this path. */
static hl_status add_image(const hl_bundle *bundle, const char *base, const char *path,
                           hl_load_request *request, bool *found, hl_error *error) {
  char folder[HL_ZARR_PATH_BYTES];
  json_t *attributes = NULL;
  hl_zarr_image image = {.levels = NULL};
  *found = false;
  if (strlen(path) >= HL_SERIES_TEXT_BYTES || !hl_zarr_join(folder, base, path)) return HL_OK;
  hl_status status = hl_zarr_attributes_read(bundle, folder, &attributes, error);
  if (status == HL_OK && json_object_get(hl_zarr_ome(attributes), "multiscales") != NULL) {
    status = hl_zarr_image_read(bundle, folder, hl_zarr_ome(attributes), &image, error);
    hl_series_entry *entry = &request->series_list[request->series_count];
    *found = status == HL_OK;
    *entry = (hl_series_entry){.number = (double)request->series_count, .dimensions = {1, 1, 1}};
    strcpy(entry->uid, path);
    memcpy(entry->description, image.name, sizeof image.name);
    for (int axis = 0; *found && axis < image.levels[0].array.rank; axis++)
      if (image.axis[axis] <= HL_ZARR_Z)
        entry->dimensions[image.axis[axis]] = image.levels[0].array.shape[axis];
    request->series_count += *found;
  }
  hl_zarr_image_release(&image);
  json_decref(attributes);
  return status;
}

static hl_status list_numbered(const hl_bundle *bundle, const char *base, hl_load_request *request,
                               hl_error *error) {
  bool found = true;
  hl_status status = HL_OK;
  for (int n = 0; n < SERIES_MOST && found && status == HL_OK; n++) {
    char path[16];
    snprintf(path, sizeof path, "%d", n);
    status = add_image(bundle, base, path, request, &found, error);
  }
  return status;
}

/* Lists the images of an array of objects, such as the fields of a well. list: the JSON array of objects. An
 * object's "path", followed by `tail`, is the path of an image. */
static hl_status list_paths(const hl_bundle *bundle, const char *base, const json_t *list, const char *tail,
                            hl_load_request *request, hl_error *error) {
  hl_status status = HL_OK;
  for (size_t n = 0; n < json_array_size(list) && status == HL_OK; n++) {
    const char *name = json_string_value(json_object_get(json_array_get(list, n), "path"));
    char path[HL_SERIES_TEXT_BYTES];
    bool found;
    if (name == NULL || request->series_count == SERIES_MOST) continue;
    if ((size_t)snprintf(path, sizeof path, "%s%s", name, tail) >= sizeof path) continue;
    status = add_image(bundle, base, path, request, &found, error);
  }
  return status;
}

static bool is_named(const hl_series_entry *entry, const char *wanted) {
  char number[32];
  hl_plain_print(number, sizeof number, "%.0f", entry->number);
  return strcmp(wanted, number) == 0 || strcmp(wanted, entry->uid) == 0 ||
         strcmp(wanted, entry->description) == 0;
}

static hl_status choose(const hl_bundle *bundle, hl_load_request *request, hl_error *error) {
  size_t count = request->series_count, n = 0;
  if (count == 0)
    return hl_fail(error, HL_ERROR_INPUT, "%s: a collection of images, and none of them is there",
                   bundle->path);
  while (request->series != NULL && n < count && !is_named(&request->series_list[n], request->series)) n++;
  if (n == count) {
    char shown[HL_PRINTABLE_BYTES];
    return hl_fail(error, HL_ERROR_INPUT,
                   "%s: there is no series \"%s\": choose 0 to %zu, or a path as \"%s\"", bundle->path,
                   hl_text_printable(shown, request->series), count - 1, request->series_list[0].uid);
  }
  request->chosen_series = n;
  if (count > 1 && request->series == NULL)
    snprintf(request->selection_told, sizeof request->selection_told,
             "%.200s: of %zu images, \"%s\" is taken: choose by \"series\" (--series): 0 to %zu",
             bundle->path, count, request->series_list[0].uid, count - 1);
  return HL_OK;
}

hl_status hl_zarr_series_choose(const hl_bundle *bundle, const json_t *ome, hl_load_request *request,
                                char folder[HL_ZARR_PATH_BYTES], bool *is_collection, hl_error *error) {
  const json_t *plate = json_object_get(ome, "plate"), *well = json_object_get(ome, "well");
  bool is_numbered = json_object_get(ome, "bioformats2raw.layout") != NULL;
  *is_collection = plate != NULL || well != NULL || is_numbered;
  if (!*is_collection) return HL_OK;
  request->series_list = hl_allocate_zeroed(bundle->context, SERIES_MOST, sizeof *request->series_list);
  if (request->series_list == NULL) return hl_fail_memory(error, 100000, "a list of series");
  hl_status status = plate != NULL
                         ? list_paths(bundle, folder, json_object_get(plate, "wells"), "/0", request, error)
                     : well != NULL
                         ? list_paths(bundle, folder, json_object_get(well, "images"), "", request, error)
                         : list_numbered(bundle, folder, request, error);
  if (status == HL_OK) status = choose(bundle, request, error);
  if (status == HL_OK && !hl_zarr_join(folder, folder, request->series_list[request->chosen_series].uid))
    status = hl_fail(error, HL_ERROR_INPUT, "%s: the path of an image is too long", bundle->path);
  return status;
}
