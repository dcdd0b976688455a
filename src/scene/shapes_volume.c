/* scene/shapes_volume.c - volumes of shapes for programs: hl_volume_from_shapes(). */
#include "core/memory.h"
#include "scene/json_shapes.h"

enum { LEAST_SIZE = 16, MOST_SIZE = 4096 };

void hl_shapes_options_defaults(hl_shapes_options *options) {
  if (options == NULL) return;
  *options = (hl_shapes_options){.struct_size = sizeof *options};
}

static hl_status check_options(const hl_shapes_options *options, hl_error *error) {
  if (options->struct_size != sizeof *options)
    return hl_fail(
        error, HL_ERROR_ARGUMENT,
        "hl_volume_from_shapes: struct_size is %zu, not %zu: call hl_shapes_options_defaults() first",
        options->struct_size, sizeof *options);
  if (options->size != 0 && (options->size < LEAST_SIZE || options->size > MOST_SIZE))
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_volume_from_shapes: a size of %d voxels: give %d to %d",
                   options->size, LEAST_SIZE, MOST_SIZE);
  return HL_OK;
}

static hl_status require_shapes(hl_json_reader *reader, const json_t *root) {
  return json_object_get(root, "shapes") != NULL
             ? HL_OK
             : hl_json_fail(reader, HL_ERROR_INPUT, "shapes", "is missing: give a list of shapes");
}

hl_status hl_volume_from_shapes(hl_context *context, const char *text, size_t length, const char *name,
                                const hl_shapes_options *options, hl_volume **volume, hl_error *error) {
  static const char *const keys[] = {"shapes", "voxel_size", "groups", NULL};
  if (context == NULL || text == NULL || volume == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_volume_from_shapes: null context, text or volume");
  *volume = NULL;
  hl_shapes_options defaults;
  hl_shapes_options_defaults(&defaults);
  if (options == NULL) options = &defaults;
  hl_status status = check_options(options, error);
  if (status != HL_OK) return status;
  hl_json_reader reader = {.context = context, .name = name != NULL ? name : "shapes", .error = error};
  json_t *root = NULL;
  double voxel_size = 0;
  status = hl_json_parse(text, length, reader.name, &root, error);
  if (status == HL_OK) status = hl_json_object(&reader, root, keys);
  if (status == HL_OK) status = require_shapes(&reader, root);
  if (status == HL_OK) status = hl_json_check_groups(&reader, json_object_get(root, "groups"));
  if (status == HL_OK)
    status = hl_json_read_shapes(&reader, root, json_object_get(root, "groups"), options, volume,
                                 &voxel_size);
  json_decref(root);
  return status;
}
