/* mesh/obj_materials.c - see obj_materials.h. A material's diffuse colour (Kd, which programs write as sRGB)
 * and opacity (d, or 1 - Tr) are read. */
#include "mesh/obj_materials.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/context.h"
#include "core/memory.h"
#include "image/srgb.h"
#include "mesh/gltf.h"
#include "volume/io/text.h"

const obj_material *hl_obj_find_material(const obj_materials *materials, const char *name) {
  for (size_t n = materials->count; n > 0; n--)
    if (strcmp(materials->list[n - 1].name, name) == 0) return &materials->list[n - 1];
  return NULL;
}

static hl_status add_material(hl_context *context, const char *name, obj_materials *materials,
                              hl_error *error) {
  if (materials->count == materials->room) {
    size_t room = 2 * materials->room + 16;
    void *grown = hl_reallocate(context, materials->list, room, sizeof *materials->list);
    if (grown == NULL) return hl_fail_memory(error, room * sizeof *materials->list, "materials");
    materials->list = grown;
    materials->room = room;
  }
  obj_material *made = &materials->list[materials->count++];
  *made = (obj_material){.color = {1, 1, 1, 1}};
  snprintf(made->name, sizeof made->name, "%s", name);
  return HL_OK;
}

/* Reads one line of a library: a keyword and its values. */
static hl_status read_line(hl_context *context, char *line, obj_materials *materials, hl_error *error) {
  char word[16];
  const char *rest = line;
  double numbers[3];
  char *comment = strchr(line, '#');
  if (comment != NULL) *comment = 0;
  if (!hl_text_word(&rest, word, sizeof word)) return HL_OK;
  char *arguments = hl_text_trim(line + (rest - line));
  if (strcmp(word, "newmtl") == 0) return add_material(context, arguments, materials, error);
  if (materials->count == 0) return HL_OK;
  if (strcmp(word, "map_Kd") == 0) materials->has_images = true;
  float *color = materials->list[materials->count - 1].color;
  if (strcmp(word, "Kd") == 0 && hl_text_numbers(arguments, numbers, 3) == 3)
    for (int c = 0; c < 3; c++) color[c] = (float)hl_srgb_decode(fmin(fmax(numbers[c], 0), 1));
  if (strcmp(word, "d") == 0 && hl_text_numbers(arguments, numbers, 1) == 1)
    color[3] = (float)fmin(fmax(numbers[0], 0), 1);
  if (strcmp(word, "Tr") == 0 && hl_text_numbers(arguments, numbers, 1) == 1)
    color[3] = (float)fmin(fmax(1 - numbers[0], 0), 1);
  return HL_OK;
}

hl_status hl_obj_read_materials(hl_context *context, const char *path, const char *name,
                                obj_materials *materials, hl_error *error) {
  const gltf_file beside = {.context = context, .path = path};
  gltf_buffer buffer = {NULL, 0, false};
  hl_error told = {0};
  hl_status status = hl_gltf_read_beside(&beside, name, &buffer, &told);
  if (status != HL_OK) {
    char shown[HL_PRINTABLE_BYTES];
    if (status == HL_ERROR_MEMORY || status == HL_ERROR_CANCELLED)
      return hl_fail(error, status, "%s", told.message);
    hl_log(context, HL_LOG_WARNING,
           "%s: its materials \"%s\" cannot be read: its faces get no colours from them", path,
           hl_text_printable(shown, name));
    return HL_OK;
  }
  bool had_images = materials->has_images;
  /* the block is owned here, so the text in it may be changed; a zero byte follows the text */
  char *text = (char *)buffer.bytes;
  for (char *line = text; status == HL_OK && line != NULL && line < text + buffer.length;) {
    size_t length = strcspn(line, "\r\n");
    bool last = line + length >= text + buffer.length;
    line[length] = 0;
    status = read_line(context, line, materials, error);
    line = last ? NULL : line + length + 1;
  }
  hl_release(context, text);
  if (status == HL_OK && materials->has_images && !had_images)
    hl_log(context, HL_LOG_WARNING,
           "%s: its textures (map_Kd) are not shown: colours are its materials' (Kd)", path);
  return status;
}
