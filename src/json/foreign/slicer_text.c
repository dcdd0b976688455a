/* json/foreign/slicer_text.c - reads volume properties that 3D Slicer has written as text: a preset of its
 * presets.xml, and its older .vp files.
 *
 * A function is a line "N x y x y ..." or "N x r g b ...". N is the number of numbers that follow. An x that
 * is less than the x before it counts as equal to that x (vtkMRMLVolumePropertyNode). Shade and lighting are
 * ignored, because the scene has its own light. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "json/foreign/foreign_nodes.h"
#include "json/foreign/slicer.h"
#include "text/edit_distance.h"
#include "volume/io/text.h"
#include "volume/io/xml.h"

enum { MOST_PRESETS = 256, NAME_BYTES = 64 };

/* The texts of a volume property: its three functions, and its interpolation. Texts are borrowed. */
typedef struct property {
  const char *interpolation, *opacity, *gradient, *color;
} property;

/* ---- the functions ---- */

/* Reads the points of a function. Each point has the number x and `ordinates` further numbers. *nodes is
 * owned by the caller. */
static hl_status read_nodes(hl_json_reader *reader, const char *key, const char *text, size_t ordinates,
                            hl_foreign_node **nodes, size_t *count) {
  size_t width = 1 + ordinates, most = HL_FOREIGN_NODES * width + 1;
  if (text == NULL)
    return hl_json_fail(reader, HL_ERROR_INPUT, key, "is missing: give the function's points");
  double *numbers = hl_allocate(reader->context, most, sizeof *numbers);
  if (numbers == NULL) return hl_fail_memory(reader->error, most * sizeof *numbers, "a transfer function");
  int read = hl_text_numbers(text, numbers, (int)most);
  *count = read > 1 ? (size_t)(read - 1) / width : 0;
  *nodes = NULL;
  hl_status status = HL_OK;
  if (*count == 0 || numbers[0] != read - 1 || (size_t)(read - 1) % width != 0)
    status = hl_json_fail(reader, HL_ERROR_INPUT, key,
                          "is no list of points: give how many numbers follow, then %zu for each point",
                          width);
  for (int n = 0; status == HL_OK && n < read; n++)
    if (!isfinite(numbers[n]))
      status = hl_json_fail(reader, HL_ERROR_INPUT, key, "number %d is not finite: give finite numbers", n);
  if (status == HL_OK) *nodes = hl_allocate_zeroed(reader->context, *count, sizeof **nodes);
  if (status == HL_OK && *nodes == NULL)
    status = hl_fail_memory(reader->error, *count * sizeof **nodes, "a transfer function");
  for (size_t n = 0; status == HL_OK && n < *count; n++) {
    const double *row = &numbers[1 + n * width];
    hl_foreign_node *node = &(*nodes)[n];
    *node = (hl_foreign_node){n > 0 ? fmax(row[0], node[-1].value) : row[0], {row[1]}, 0.5, 0};
    memcpy(node->y, row + 1, ordinates * sizeof *row);
  }
  hl_release(reader->context, numbers);
  return status;
}

static hl_status read_opacity(hl_json_reader *reader, const char *key, const char *text,
                              const hl_opacity_point **points, size_t *point_count) {
  hl_foreign_node *nodes = NULL;
  size_t count = 0;
  hl_status status = read_nodes(reader, key, text, 1, &nodes, &count);
  if (status == HL_OK)
    status = hl_foreign_opacity(reader->context, nodes, count, points, point_count, reader->error);
  hl_release(reader->context, nodes);
  return status;
}

static hl_status read_property(hl_json_reader *reader, const property *from, hl_transfer_function *function) {
  hl_foreign_node *nodes = NULL;
  size_t count = 0;
  if (from->interpolation != NULL && strcmp(from->interpolation, "0") == 0)
    return hl_json_fail(reader, HL_ERROR_UNSUPPORTED, "interpolation",
                        "of the nearest voxel is not supported: set it to 1, linear");
  hl_status status = read_opacity(reader, "scalarOpacity", from->opacity, &function->opacity,
                                  &function->opacity_count);
  if (status == HL_OK && from->gradient != NULL)
    status = read_opacity(reader, "gradientOpacity", from->gradient, &function->gradient_opacity,
                          &function->gradient_opacity_count);
  if (status == HL_OK) status = read_nodes(reader, "colorTransfer", from->color, 3, &nodes, &count);
  if (status == HL_OK)
    status = hl_foreign_color(reader->context, nodes, count, HL_SPACE_RGB, function, reader->error);
  hl_release(reader->context, nodes);
  if (status == HL_OK) hl_slicer_drop_even_gradient(reader->context, function);
  return status;
}

/* ---- presets.xml ---- */

/* The name of the preset in PATH.xml:PRESET, as a pointer into path; null if path names no preset. */
static const char *preset_name(const char *path) {
  const char *found = NULL;
  for (const char *at = path; (at = strstr(at, ".xml:")) != NULL; at++) found = at + strlen(".xml:");
  return found;
}

bool hl_slicer_is_text(const char *path) {
  return hl_text_ends(path, ".vp") || hl_text_ends(path, ".xml") || preset_name(path) != NULL;
}

/* The names of the presets in a file, which errors list. */
typedef struct preset_list {
  char names[MOST_PRESETS][NAME_BYTES];
  const char *known[MOST_PRESETS + 1]; /* [count + 1]; pointers to the names; null ends the list */
  size_t count;
} preset_list;

static hl_status refuse_preset(hl_json_reader *reader, const char *wanted, const preset_list *list) {
  char suggestion[2048];
  if (list->count == 0)
    return hl_json_fail(reader, HL_ERROR_INPUT, NULL,
                        "holds no VolumeProperty: give a presets.xml of Slicer");
  hl_suggest_name(wanted != NULL ? wanted : "", list->known, suggestion, sizeof suggestion);
  if (wanted == NULL)
    return hl_json_fail(reader, HL_ERROR_INPUT, NULL, "holds several presets: name one, as FILE.xml:NAME: %s",
                        suggestion);
  return hl_json_fail(reader, HL_ERROR_INPUT, NULL, "there is no preset \"%.80s\": %s", wanted, suggestion);
}

static void remember(preset_list *list, const char *name) {
  if (list->count == MOST_PRESETS) return;
  char *kept = list->names[list->count];
  snprintf(kept, NAME_BYTES, "%.*s", NAME_BYTES - 1, name);
  list->known[list->count++] = kept;
}

/* Finds the volume property with the wanted name. If `wanted` is null, takes the only property of the
 * file. */
static hl_status find_preset(hl_json_reader *reader, hl_stream *stream, const char *wanted, hl_xml_tag *tag,
                             preset_list *list, hl_transfer_function *function) {
  bool found = false, ended = false;
  for (;;) {
    hl_status status = hl_xml_next_tag(stream, tag, &ended, reader->error);
    if (status != HL_OK) return status;
    if (ended) break;
    if (!tag->is_start || strcmp(tag->name, "VolumeProperty") != 0) continue;
    const char *name = hl_xml_attribute(tag, "name");
    remember(list, name != NULL ? name : "");
    if (wanted == NULL ? list->count > 1 : name == NULL || strcmp(name, wanted) != 0) continue;
    if (found) continue;
    found = true;
    const property from = {hl_xml_attribute(tag, "interpolation"), hl_xml_attribute(tag, "scalarOpacity"),
                           hl_xml_attribute(tag, "gradientOpacity"), hl_xml_attribute(tag, "colorTransfer")};
    status = read_property(reader, &from, function);
    if (status != HL_OK || wanted != NULL) return status;
  }
  return found && list->count == 1 ? HL_OK : refuse_preset(reader, wanted, list);
}

static hl_status read_presets(hl_json_reader *reader, hl_stream *stream, const char *wanted,
                              hl_transfer_function *function) {
  hl_xml_tag *tag = hl_allocate(reader->context, 1, sizeof *tag);
  preset_list *list = hl_allocate_zeroed(reader->context, 1, sizeof *list);
  hl_status status = tag == NULL || list == NULL
                         ? hl_fail_memory(reader->error, sizeof *list, "the names of presets")
                         : find_preset(reader, stream, wanted, tag, list, function);
  hl_release(reader->context, tag);
  hl_release(reader->context, list);
  return status;
}

/* ---- .vp ---- */

/* Reads a property from its lines. The order of the lines is: interpolation, shade, diffuse, ambient,
 * specular, specular power, opacity, gradient opacity, colour. text: ends with 0; its line ends become 0. */
static hl_status read_lines(hl_json_reader *reader, char *text, hl_transfer_function *function) {
  enum { LINES = 9 };
  const char *lines[LINES] = {NULL};
  size_t count = 0;
  for (char *at = text; at != NULL && *at != 0 && count < LINES;) {
    char *end = strchr(at, '\n');
    if (end != NULL) *end++ = 0;
    lines[count++] = hl_text_trim(at);
    at = end;
  }
  if (count < LINES)
    return hl_json_fail(reader, HL_ERROR_INPUT, NULL, "has %zu lines: a .vp file of Slicer has %d", count,
                        LINES);
  const char *gradient = lines[7][0] != 0 ? lines[7] : NULL;
  return read_property(reader, &(property){lines[0], lines[6], gradient, lines[8]}, function);
}

/* ---- both ---- */

hl_status hl_slicer_read_text(hl_context *context, const char *path, hl_transfer_function *function,
                              hl_error *error) {
  const char *wanted = preset_name(path);
  size_t length = wanted != NULL ? (size_t)(wanted - path) - 1 : strlen(path);
  char *file = hl_copy_text(context, path);
  if (file == NULL) return hl_fail_memory(error, length + 1, "a path");
  file[length] = 0;
  hl_json_reader reader = {.context = context, .name = file, .error = error};
  unsigned char *bytes = NULL;
  size_t size = 0;
  hl_stream *stream = NULL;
  hl_status status = hl_file_read(context, file, HL_JSON_LIMIT, &bytes, &size, error);
  if (status == HL_OK && hl_text_ends(file, ".vp")) {
    status = read_lines(&reader, (char *)bytes, function);
  } else if (status == HL_OK) {
    status = hl_stream_open_memory(context, file, bytes, size, &stream, error);
    if (status == HL_OK) status = read_presets(&reader, stream, wanted, function);
    hl_stream_close(stream);
  }
  hl_release(context, bytes);
  hl_release(context, file);
  return status;
}
