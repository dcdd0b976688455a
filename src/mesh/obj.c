/* mesh/obj.c - Wavefront OBJ files: vertices, their normals and colours, and faces.
 *
 * Materials, groups, texture coordinates and curves are passed over. A vertex has one normal: where faces
 * give it several, the last one. */
#define _GNU_SOURCE /* memrchr */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "image/srgb.h"
#include "mesh/mesh.h"
#include "volume/text.h"

typedef struct obj_reader {
  mesh_parts *parts;
  const char *at, *end; /* the rest of the text */
  int line;
  float (*normals)[3]; /* owned; [normal_count]; those of the file */
  size_t normal_count, normal_room;
  hl_error *error;
} obj_reader;

static hl_status fail(obj_reader *reader, const char *what) {
  return hl_fail_at(reader->error, HL_ERROR_INPUT, reader->line, 0, "%s:%d: %s", reader->parts->path,
                    reader->line, what);
}

/* The next word of the line. False at its end. */
static bool next_word(obj_reader *reader, const char **word, size_t *length) {
  while (reader->at < reader->end && *reader->at != '\n' && hl_is_space(*reader->at)) reader->at++;
  *word = reader->at;
  while (reader->at < reader->end && !hl_is_space(*reader->at)) reader->at++;
  *length = (size_t)(reader->at - *word);
  return *length > 0;
}

static void skip_line(obj_reader *reader) {
  const char *next = memchr(reader->at, '\n', (size_t)(reader->end - reader->at));
  reader->at = next != NULL ? next + 1 : reader->end;
  reader->line++;
}

/* Reads up to `most` numbers of the line; returns how many, -1 for words that are none. */
static int read_numbers(obj_reader *reader, double *numbers, int most) {
  const char *word;
  size_t length;
  int count = 0;
  while (count < most && next_word(reader, &word, &length))
    if (!hl_text_number(word, length, &numbers[count++])) return -1;
  return count;
}

static hl_status read_vertex(obj_reader *reader) {
  mesh_parts *parts = reader->parts;
  double numbers[7];
  int count = read_numbers(reader, numbers, 7);
  if (count < 3) return fail(reader, "a vertex is three numbers");
  bool colored = count >= 6 && (parts->vertex_count == 0 || parts->colors != NULL);
  if (parts->vertex_count == UINT32_MAX) return fail(reader, "more vertices than 32 bits count");
  hl_status status = hl_mesh_reserve_vertices(parts, parts->vertex_count + 1, parts->normals != NULL,
                                              colored || parts->colors != NULL, reader->error);
  if (status != HL_OK) return status;
  for (int axis = 0; axis < 3; axis++) parts->positions[parts->vertex_count][axis] = (float)numbers[axis];
  if (parts->normals != NULL) memset(parts->normals[parts->vertex_count], 0, sizeof *parts->normals);
  for (int c = 0; parts->colors != NULL && c < 4; c++)
    parts->colors[parts->vertex_count][c] = c < 3 && colored
                                                ? (float)hl_srgb_decode(fmin(fmax(numbers[3 + c], 0), 1))
                                                : 1;
  parts->vertex_count++;
  return HL_OK;
}

static hl_status read_normal(obj_reader *reader) {
  double numbers[3];
  if (read_numbers(reader, numbers, 3) != 3) return fail(reader, "a normal is three numbers");
  if (reader->normal_count == reader->normal_room) {
    size_t room = 2 * reader->normal_room + 64;
    void *grown = hl_reallocate(reader->parts->context, reader->normals, room, sizeof *reader->normals);
    if (grown == NULL)
      return hl_fail_memory(reader->error, room * sizeof *reader->normals, "a mesh's normals");
    reader->normals = grown;
    reader->normal_room = room;
  }
  for (int axis = 0; axis < 3; axis++) reader->normals[reader->normal_count][axis] = (float)numbers[axis];
  reader->normal_count++;
  return HL_OK;
}

/* An index of a face's corner: from 1 on, or negative from the last one back; -1 where it is out of range. */
static int64_t index_of(const char *text, size_t length, size_t count) {
  double number;
  if (!hl_text_number(text, length, &number) || fabs(number) > 1e15 || number != floor(number)) return -1;
  double index = number < 0 ? (double)count + number : number - 1;
  return index >= 0 && index < (double)count ? (int64_t)index : -1;
}

/* Gives a vertex the normal that a corner "v//n" or "v/t/n" names, if it names one. */
static hl_status set_normal(obj_reader *reader, uint32_t vertex, const char *text, size_t length) {
  mesh_parts *parts = reader->parts;
  const char *slash = memrchr(text, '/', length);
  if (slash == NULL || slash == memchr(text, '/', length)) return HL_OK;
  int64_t normal = index_of(slash + 1, length - (size_t)(slash + 1 - text), reader->normal_count);
  if (normal < 0) return fail(reader, "a corner names a normal that is not there");
  if (parts->normals == NULL) {
    parts->normals = hl_allocate_zeroed(parts->context, parts->vertex_room, sizeof *parts->normals);
    if (parts->normals == NULL)
      return hl_fail_memory(reader->error, parts->vertex_room * sizeof *parts->normals, "a mesh's normals");
  }
  memcpy(parts->normals[vertex], reader->normals[normal], sizeof *parts->normals);
  return HL_OK;
}

static hl_status read_face(obj_reader *reader) {
  const char *word;
  size_t length;
  uint32_t first = 0, before = 0;
  for (int corner = 0; next_word(reader, &word, &length); corner++) {
    const char *slash = memchr(word, '/', length);
    int64_t vertex = index_of(word, slash != NULL ? (size_t)(slash - word) : length,
                              reader->parts->vertex_count);
    if (vertex < 0) return fail(reader, "a face names a vertex that is not there: vertices count from 1");
    hl_status status = set_normal(reader, (uint32_t)vertex, word, length);
    if (status == HL_OK && corner >= 2)
      status = hl_mesh_add_triangle(reader->parts, first, before, (uint32_t)vertex, reader->error);
    if (status != HL_OK) return status;
    if (corner == 0) first = (uint32_t)vertex;
    before = (uint32_t)vertex;
  }
  return HL_OK;
}

static hl_status read_line(obj_reader *reader) {
  const char *word;
  size_t length;
  if (!next_word(reader, &word, &length)) return HL_OK;
  if (length == 1 && word[0] == 'v') return read_vertex(reader);
  if (length == 2 && memcmp(word, "vn", 2) == 0) return read_normal(reader);
  if (length == 1 && word[0] == 'f') return read_face(reader);
  return HL_OK;
}

hl_status hl_mesh_read_obj(mesh_text text, mesh_parts *parts, hl_error *error) {
  const char *start = (const char *)text.bytes;
  obj_reader reader = {.parts = parts, .at = start, .end = start + text.length, .line = 1, .error = error};
  hl_status status = HL_OK;
  while (status == HL_OK && reader.at < reader.end) {
    status = read_line(&reader);
    if (status == HL_OK) skip_line(&reader);
  }
  hl_release(parts->context, reader.normals);
  return status;
}
