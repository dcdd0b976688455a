/* json/foreign/paraview.c - reads ParaView's colour maps, which are the files in which ParaView saves
 * transfer functions. */
#include <string.h>

#include "core/memory.h"
#include "json/foreign/foreign_nodes.h"

/* Reads one of ParaView's flat arrays, which have four numbers per point. If `ordinates` is 3, these are
 * value, red, green and blue; if it is 1, they are value, opacity, midpoint and sharpness. */
static hl_status read_flat(hl_json_reader *reader, const json_t *map, const char *key, size_t ordinates,
                           hl_foreign_node **nodes, size_t *count) {
  const json_t *value = json_object_get(map, key);
  size_t mark = hl_json_enter(reader, key);
  hl_status status = hl_json_array(reader, value, 4, 4 * HL_FOREIGN_NODES);
  if (status != HL_OK) return status;
  if (json_array_size(value) % 4 != 0)
    return hl_json_fail(reader, HL_ERROR_INPUT, NULL, "has %zu numbers: give groups of four",
                        json_array_size(value));
  *count = json_array_size(value) / 4;
  *nodes = hl_allocate(reader->context, *count, sizeof **nodes);
  if (*nodes == NULL) return hl_fail_memory(reader->error, *count * sizeof **nodes, "a transfer function");
  for (size_t n = 0; n < *count; n++) {
    double row[4];
    for (size_t e = 0; e < 4; e++) {
      const json_t *element = json_array_get(value, 4 * n + e);
      if (!json_is_number(element)) {
        hl_json_enter_index(reader, 4 * n + e);
        return hl_json_fail(reader, HL_ERROR_INPUT, NULL, "is no number: give one");
      }
      row[e] = json_number_value(element);
    }
    (*nodes)[n] = ordinates == 3 ? (hl_foreign_node){row[0], {row[1], row[2], row[3]}, 0.5, 0}
                                 : (hl_foreign_node){row[0], {row[1]}, row[2], row[3]};
  }
  status = hl_foreign_check(reader, *nodes, *count);
  if (status == HL_OK) hl_json_leave(reader, mark);
  return status;
}

static const char *const space_names[] = {"RGB", "HSV", "Lab", "Diverging", "Step", NULL};

hl_status hl_json_read_paraview_map(hl_json_reader *reader, const json_t *map,
                                    hl_transfer_function *function) {
  hl_status status = HL_OK;
  int space = HL_SPACE_RGB;
  double logarithmic = 0, by_arc = 0;
  hl_foreign_node *nodes = NULL;
  size_t count = 0;
  if (!json_is_object(map) || json_object_get(map, "RGBPoints") == NULL)
    return hl_json_fail(reader, HL_ERROR_INPUT, "RGBPoints", "is missing: a ParaView colour map needs it");
  const char *name = json_string_value(json_object_get(map, "ColorSpace"));
  if (name != NULL && strcmp(name, "CIELAB") == 0) space = HL_SPACE_LAB;
  else status = hl_json_choice(reader, map, "ColorSpace", space_names, 0, &space);
  if (status == HL_OK) status = hl_json_number(reader, map, "HSVWrap", &by_arc);
  if (space == HL_SPACE_HSV && by_arc != 0) space = HL_SPACE_HSV_ARC;
  if (status == HL_OK) status = hl_json_number(reader, map, "UseLogScale", &logarithmic);
  if (status == HL_OK && logarithmic != 0)
    status = hl_json_fail(reader, HL_ERROR_UNSUPPORTED, "UseLogScale",
                          "logarithmic colour maps are not supported: save the map with a linear scale");
  if (status == HL_OK) status = read_flat(reader, map, "RGBPoints", 3, &nodes, &count);
  if (status == HL_OK)
    status = hl_foreign_color(reader->context, nodes, count, (hl_color_space)space, function, reader->error);
  hl_release(reader->context, nodes);
  nodes = NULL;
  if (status == HL_OK && json_object_get(map, "Points") != NULL) {
    status = read_flat(reader, map, "Points", 1, &nodes, &count);
    if (status == HL_OK)
      status = hl_foreign_opacity(reader->context, nodes, count, &function->opacity, &function->opacity_count,
                                  reader->error);
    hl_release(reader->context, nodes);
  }
  return status;
}

hl_status hl_json_read_paraview(hl_json_reader *reader, const json_t *root, hl_transfer_function *function) {
  hl_status status = hl_json_array(reader, root, 1, 1);
  if (status != HL_OK) return status;
  hl_json_enter_index(reader, 0);
  return hl_json_read_paraview_map(reader, json_array_get(root, 0), function);
}
