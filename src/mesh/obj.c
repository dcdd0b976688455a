/* mesh/obj.c - reads Wavefront OBJ files: vertices, their normals and colours, faces, and the colours of
 * their materials.
 *
 * Groups, texture coordinates and curves are ignored. A vertex has one normal; if faces give it several, the
 * last one counts. If vertices have colours, the colours of materials are not used. */
#define _GNU_SOURCE /* for memrchr() */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "image/srgb.h"
#include "mesh/obj_materials.h"
#include "volume/io/text.h"

typedef struct obj_reader {
  mesh_parts *parts;
  const char *at, *end; /* the part of the text that has not been read yet */
  int line;
  float (*normals)[3]; /* owned; [normal_count]; the file's normals */
  size_t normal_count, normal_room;
  obj_materials materials;
  const obj_material *material; /* the material of the faces that follow; null if there is none */
  size_t face_color_room;       /* number of triangles for which parts->face_colors has memory */
  hl_error *error;
} obj_reader;

static hl_status fail(obj_reader *reader, const char *what) {
  return hl_fail_at(reader->error, HL_ERROR_INPUT, reader->line, 0, "%s:%d: %s", reader->parts->path,
                    reader->line, what);
}

static bool ends_line(char c) { return c == '\n' || c == '\r'; }

/* The number of bytes of a line's end at `at`, which is CR, LF or both; 0 if there is no line's end. */
static size_t line_end(const obj_reader *reader, const char *at) {
  if (at >= reader->end || !ends_line(*at)) return 0;
  return *at == '\r' && at + 1 < reader->end && at[1] == '\n' ? 2 : 1;
}

/* The number of bytes at `at` of a backslash and a line's end, which mean that the line continues; 0 if they
 * are not there. */
static size_t continuation(const obj_reader *reader, const char *at) {
  size_t end = at < reader->end && *at == '\\' ? line_end(reader, at + 1) : 0;
  return end > 0 ? end + 1 : 0;
}

/* Takes the next word of the line, which may continue after a backslash. Returns false at the line's end, or
 * at a comment. */
static bool next_word(obj_reader *reader, const char **word, size_t *length) {
  for (size_t skipped;;) {
    skipped = continuation(reader, reader->at);
    if (skipped > 0) reader->line++;
    else if (reader->at < reader->end && !ends_line(*reader->at) && hl_is_space(*reader->at)) skipped = 1;
    if (skipped == 0) break;
    reader->at += skipped;
  }
  *word = reader->at;
  if (reader->at < reader->end && *reader->at == '#') {
    *length = 0;
    return false;
  }
  while (reader->at < reader->end && !hl_is_space(*reader->at) && continuation(reader, reader->at) == 0)
    reader->at++;
  *length = (size_t)(reader->at - *word);
  return *length > 0;
}

/* Copies the rest of the line, without blanks around it and without a comment. A rest that is too long for
 * the buffer is cut off. */
static void rest_of_line(obj_reader *reader, char *text, size_t size) {
  size_t length = 0;
  const char *at = reader->at;
  while (at < reader->end && !ends_line(*at) && *at != '#' && length + 1 < size) text[length++] = *at++;
  text[length] = 0;
  char *trimmed = hl_text_trim(text);
  memmove(text, trimmed, strlen(trimmed) + 1);
}

static void skip_line(obj_reader *reader) {
  size_t end;
  while (reader->at < reader->end && !ends_line(*reader->at)) {
    size_t skipped = continuation(reader, reader->at);
    reader->line += skipped > 0;
    reader->at += skipped > 0 ? skipped : 1;
  }
  end = line_end(reader, reader->at);
  reader->at += end;
  reader->line++;
}

/* Reads at most `most` numbers of the line. Returns the number of numbers that were read, or -1 if a word is
 * no number. */
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

/* The index of a vertex, normal or texture coordinate that a face's corner names. The text counts from 1, or
 * backwards from -1, which stands for the last of the `count` vertices, normals or coordinates so far.
 * Returns -1 if the index is out of range. */
static int64_t index_of(const char *text, size_t length, size_t count) {
  double number;
  if (!hl_text_number(text, length, &number) || fabs(number) > 1e15 || number != floor(number)) return -1;
  double index = number < 0 ? (double)count + number : number - 1;
  return index >= 0 && index < (double)count ? (int64_t)index : -1;
}

/* Sets a vertex's normal if the corner, "v//n" or "v/t/n", names one. */
static hl_status set_normal(obj_reader *reader, uint32_t vertex, const char *text, size_t length) {
  mesh_parts *parts = reader->parts;
  const char *slash = memrchr(text, '/', length);
  if (slash == NULL || slash == memchr(text, '/', length) || slash + 1 == text + length) return HL_OK;
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

/* Gives the colour of a face's material to the triangles of this face, which are the triangles from number
 * `first` on. As soon as one face has a colour, all triangles have one; without a material it is white. */
static hl_status color_face(obj_reader *reader, size_t first) {
  mesh_parts *parts = reader->parts;
  if (parts->face_colors == NULL && reader->material == NULL) return HL_OK;
  if (parts->triangle_count > reader->face_color_room || parts->face_colors == NULL) {
    size_t room = 2 * parts->triangle_count + 1024;
    float(*grown)[4] = hl_reallocate(parts->context, parts->face_colors, room, sizeof *grown);
    if (grown == NULL) return hl_fail_memory(reader->error, room * sizeof *grown, parts->path);
    if (parts->face_colors == NULL)
      for (size_t t = 0; t < first; t++)
        for (int c = 0; c < 4; c++) grown[t][c] = 1;
    parts->face_colors = grown;
    reader->face_color_room = room;
  }
  static const float white[4] = {1, 1, 1, 1};
  for (size_t t = first; t < parts->triangle_count; t++)
    memcpy(parts->face_colors[t], reader->material != NULL ? reader->material->color : white, sizeof white);
  return HL_OK;
}

static hl_status read_library(obj_reader *reader) {
  char name[1024], copy[128] = "";
  rest_of_line(reader, name, sizeof name);
  if (name[0] == 0) return HL_OK;
  if (reader->material != NULL) memcpy(copy, reader->material->name, sizeof copy);
  hl_status status = hl_obj_read_materials(reader->parts->context, reader->parts->path, name,
                                           &reader->materials, reader->error);
  if (reader->material != NULL) /* the materials have moved in memory */
    reader->material = hl_obj_find_material(&reader->materials, copy);
  return status;
}

static void use_material(obj_reader *reader) {
  char name[128];
  rest_of_line(reader, name, sizeof name);
  reader->material = hl_obj_find_material(&reader->materials, name);
}

static hl_status read_face(obj_reader *reader) {
  const char *word;
  size_t length, first_triangle = reader->parts->triangle_count;
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
  hl_status status = hl_mesh_note_polygon(reader->parts, first_triangle, reader->error);
  return status == HL_OK ? color_face(reader, first_triangle) : status;
}

static hl_status read_line(obj_reader *reader) {
  const char *word;
  size_t length;
  if (!next_word(reader, &word, &length)) return HL_OK;
  if (length == 1 && word[0] == 'v') return read_vertex(reader);
  if (length == 2 && memcmp(word, "vn", 2) == 0) return read_normal(reader);
  if (length == 1 && word[0] == 'f') return read_face(reader);
  if (length == 6 && memcmp(word, "mtllib", 6) == 0) return read_library(reader);
  if (length == 6 && memcmp(word, "usemtl", 6) == 0) use_material(reader);
  return HL_OK;
}

hl_status hl_mesh_read_obj(mesh_text text, mesh_parts *parts, hl_error *error) {
  const char *start = (const char *)text.bytes;
  obj_reader reader = {.parts = parts, .at = start, .end = start + text.length, .line = 1, .error = error};
  hl_status status = HL_OK;
  /* skips the byte order mark */
  if (text.length >= 3 && memcmp(start, "\xef\xbb\xbf", 3) == 0) reader.at += 3;
  while (status == HL_OK && reader.at < reader.end) {
    status = read_line(&reader);
    if (status == HL_OK) skip_line(&reader);
  }
  if (parts->colors != NULL) {
    hl_release(parts->context, parts->face_colors);
    parts->face_colors = NULL;
  }
  hl_release(parts->context, reader.normals);
  hl_release(parts->context, reader.materials.list);
  return status;
}
