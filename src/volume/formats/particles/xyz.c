/* volume/formats/particles/xyz.c - reads XYZ files, which hold atoms of molecules. A file is recognised by
 * its name's ending.
 *
 * A frame consists of the number of atoms, a comment, and for each atom a line with its element, x, y and z.
 * The comment of an extended XYZ file states the columns (Properties=species:S:1:pos:R:3:...) and the box
 * (Lattice="ax ay az bx by bz cx cy cz"). A box parallel to the axes is periodic along each axis; if the
 * comment has the key pbc, it is periodic only along axes with the value T. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "volume/formats/particles/particle_columns.h"
#include "volume/io/text.h"

static hl_status claim_name(hl_stream **stream, bool *claimed, hl_error *error) {
  (void)error;
  const char *path = (*stream)->path;
  *claimed = hl_text_ends(path, ".xyz") || hl_text_ends(path, ".extxyz") || hl_text_ends(path, ".xyz.gz");
  return HL_OK;
}

/* Copies the value of a key from a comment. The value follows "key=" and ends at a space, or stands in
 * quotes. The value is "" if the comment lacks the key. */
static void value_of(const char *comment, const char *key, char *value, size_t capacity) {
  size_t length = strlen(key);
  value[0] = 0;
  for (const char *at = comment; *at != 0; at++) {
    bool begins = at == comment || hl_is_space(at[-1]);
    if (!begins || !hl_text_starts(at, key) || at[length] != '=') continue;
    at += length + 1;
    bool quoted = *at == '"';
    size_t count = strcspn(at + quoted, quoted ? "\"" : " \t\r\n");
    if (count < capacity) memcpy(value, at + quoted, count), value[count] = 0;
    return;
  }
}

/* Names the columns by a text such as "species:S:1:pos:R:3:charge:R:1". */
static void name_columns(char *properties, hl_particle_columns *columns) {
  static const char axes[] = "xyz";
  for (char *field = properties; field != NULL && *field != 0;) {
    char *type = strchr(field, ':'), *count = type != NULL ? strchr(type + 1, ':') : NULL;
    if (count == NULL) return;
    *type = *count = 0;
    char *end = strchr(count + 1, ':');
    if (end != NULL) *end = 0;
    size_t numbers = 0;
    if (hl_text_sizes(count + 1, &numbers, 1) != 1 || numbers > HL_PARTICLE_COLUMNS_MOST) return;
    int of = (int)numbers;
    bool places = (strcmp(field, "pos") == 0 || strcmp(field, "position") == 0) && of == 3;
    for (int n = 0; n < of; n++) {
      char name[HL_PARTICLE_NAME_BYTES];
      if (places) snprintf(name, sizeof name, "%c", axes[n]);
      else if (of == 1) snprintf(name, sizeof name, "%.50s", field);
      else snprintf(name, sizeof name, "%.50s_%d", field, n);
      hl_particle_columns_add(columns, name);
    }
    field = end != NULL ? end + 1 : NULL;
  }
}

static void read_box(const char *comment, hl_particle_columns *columns) {
  char text[256], pbc[32];
  double vector[9];
  value_of(comment, "Lattice", text, sizeof text);
  value_of(comment, "pbc", pbc, sizeof pbc);
  if (hl_text_numbers(text, vector, 9) != 9) return;
  for (int n = 0; n < 9; n++)
    if (n % 4 != 0 && vector[n] != 0) return;
  const char *at = pbc;
  for (int axis = 0; axis < 3; axis++) {
    at += strspn(at, " ");
    bool periodic = *at == 0 || *at == 'T' || *at == 't' || *at == '1';
    if (*at != 0) at += strcspn(at, " ");
    columns->box[axis] = vector[4 * axis];
    if (periodic && vector[4 * axis] > 0) columns->period[axis] = vector[4 * axis];
  }
}

static void read_comment(char *comment, hl_particle_columns *columns) {
  char properties[1024];
  read_box(comment, columns);
  value_of(comment, "Properties", properties, sizeof properties);
  name_columns(properties, columns);
  if (hl_particle_columns_are_places(columns)) return;
  static const char *const plain[] = {"element", "x", "y", "z"};
  columns->column_count = 0;
  for (int n = 0; n < 4; n++) hl_particle_columns_add(columns, plain[n]);
}

static hl_status load(hl_stream **stream, hl_load_request *request, hl_volume **volume, hl_error *error) {
  hl_particle_columns columns = {.context = request->context};
  size_t wanted = request->time > 0 ? (size_t)request->time : 0, frames = 0, left = 0;
  char line[HL_LINE_BYTES];
  bool ended = false, comment = false;
  hl_status status = HL_OK;
  for (int number = 1; status == HL_OK; number++) {
    status = hl_stream_line(*stream, line, &ended, error);
    if (status != HL_OK || ended) break;
    bool is_wanted = frames == wanted + 1;
    if (comment) {
      if (is_wanted) read_comment(line, &columns);
      comment = false;
    } else if (left > 0) {
      if (is_wanted) status = hl_particle_columns_row(&columns, line, *stream, number, error);
      left--;
    } else if (line[strspn(line, " \t\r")] != 0) {
      if (hl_text_sizes(line, &left, 1) != 1)
        status = HL_FAIL_LINE(error, HL_ERROR_INPUT, *stream, number, "%s",
                              "the number of atoms is expected");
      frames++, comment = true;
    }
  }
  if (status == HL_OK && (left > 0 || comment))
    status = hl_fail(error, HL_ERROR_INPUT, "%s: the file ends before the last %zu atoms of its frame %zu",
                     (*stream)->path, left, frames);
  if (status == HL_OK) status = hl_steps_choose(request, (*stream)->path, frames > 0 ? frames : 1, 1, error);
  if (status == HL_OK) status = hl_particle_columns_volume(&columns, request, (*stream)->path, volume, error);
  hl_particle_columns_release(&columns);
  return status;
}

const hl_format hl_format_xyz = {
    .name = "XYZ", .more_endings = ".xyz .extxyz", .claim_name = claim_name, .load = load};
