/* json/shapes_volume.c - hl_volume_from_shapes(), and the text of shapes with their groups expanded. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/door.h"
#include "core/memory.h"
#include "json/shapes.h"
#include "shape/shape.h"
#include "text/plain_json.h"

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
  HL_DOOR;
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

/* ---- expanding groups ---- */

/* Replaces named groups in a list by their shapes. left: the number of shapes that may still be added to the
 * whole list. */
static json_t *expand_list(const json_t *shapes, const json_t *groups, int depth, int *left) {
  json_t *expanded = json_array();
  for (size_t n = 0; n < json_array_size(shapes); n++) {
    const json_t *shape = json_array_get(shapes, n), *members = json_object_get(shape, "shapes");
    const json_t *type = json_object_get(shape, "type"), *name = json_object_get(shape, "name");
    json_t *copy = hl_json_copy(shape);
    if (json_is_string(type) && strcmp(json_string_value(type), "group") == 0) {
      if (members == NULL && json_is_string(name)) members = json_object_get(groups, json_string_value(name));
      json_t *inner = depth < HL_SHAPES_DEEPEST && members != NULL
                          ? expand_list(members, groups, depth + 1, left)
                          : NULL;
      if (json_object_set_new(copy, "shapes", inner) != 0) json_decref(copy), copy = NULL;
    }
    bool too_many = (*left)-- == 0;
    if (json_array_append_new(expanded, copy) != 0 || too_many) {
      json_decref(expanded);
      return NULL;
    }
  }
  return expanded;
}

json_t *hl_json_expand_shapes(const json_t *shapes, const json_t *groups) {
  int left = HL_SHAPE_COUNT;
  return expand_list(shapes, groups, 0, &left);
}

/* Returns whether a JSON text contains the whole tree `root`. If memory is short, jansson leaves keys out of
 * the text, and still reports success. */
static bool says(const char *text, const json_t *root) {
  json_t *again = text != NULL ? hl_plain_json_load_text(text) : NULL;
  bool same = json_equal(root, again);
  json_decref(again);
  return same;
}

/* Returns an integer in place of a real number without a fraction; null for any other value. A page that
 * reads a scene and writes it again turns 5.0 into 5, and both must become the same text here. */
static json_t *whole_of(const json_t *value) {
  const double most = 9007199254740992.0; /* 2^53 */
  double number = json_real_value(value);
  bool whole = json_is_real(value) && number == floor(number) && fabs(number) <= most;
  return whole ? json_integer((json_int_t)number) : NULL;
}

static void spell_whole_numbers(json_t *tree) {
  json_t *value, *whole;
  const char *key;
  void *next;
  size_t index;
  json_object_foreach_safe(tree, next, key, value) {
    if ((whole = whole_of(value)) != NULL) json_object_set_new(tree, key, whole);
    else spell_whole_numbers(value);
  }
  json_array_foreach(tree, index, value) {
    if ((whole = whole_of(value)) != NULL) json_array_set_new(tree, index, whole);
    else spell_whole_numbers(value);
  }
}

char *hl_json_shapes_text(hl_context *context, const json_t *shapes, const json_t *groups,
                          double voxel_size) {
  json_t *shared = json_pack("{s:o, s:f}", "shapes", hl_json_expand_shapes(shapes, groups), "voxel_size",
                             voxel_size);
  json_t *root = json_deep_copy(shared);
  json_decref(shared);
  spell_whole_numbers(root);
  char *dumped = root != NULL ? hl_plain_json_dump(root, JSON_COMPACT | JSON_REAL_PRECISION(17)) : NULL;
  char *text = says(dumped, root) ? hl_copy_text(context, dumped) : NULL;
  json_decref(root);
  free(dumped);
  return text;
}
