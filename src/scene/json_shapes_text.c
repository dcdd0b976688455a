/* scene/json_shapes_text.c - lists of shapes that stand for themselves, with their groups in place. */
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "scene/json_shapes.h"
#include "shape/shape.h"

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

/* Without memory jansson leaves keys out and calls it a success. */
static bool says(const char *text, const json_t *root) {
  json_t *again = text != NULL ? json_loads(text, 0, NULL) : NULL;
  bool same = json_equal(root, again);
  json_decref(again);
  return same;
}

char *hl_json_shapes_text(hl_context *context, const json_t *shapes, const json_t *groups,
                          double voxel_size) {
  json_t *root = json_pack("{s:o, s:f}", "shapes", hl_json_expand_shapes(shapes, groups), "voxel_size",
                           voxel_size);
  char *dumped = root != NULL ? json_dumps(root, JSON_COMPACT | JSON_REAL_PRECISION(17)) : NULL;
  char *text = says(dumped, root) ? hl_copy_text(context, dumped) : NULL;
  json_decref(root);
  free(dumped);
  return text;
}
