/* mesh/stl.c - reads STL files, binary and ASCII. They have triangles without shared vertices.
 *
 * Corners at equal positions become one vertex, so that smooth normals can be found. */
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "mesh/mesh.h"
#include "volume/io/text.h"

enum { HEADER_BYTES = 84, FACET_BYTES = 50 };

static float float_at(const unsigned char *bytes) {
  uint32_t bits = (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 |
                  (uint32_t)bytes[3] << 24;
  float value;
  memcpy(&value, &bits, sizeof value);
  return value;
}

/* ---- corners that are equal become one vertex ---- */

typedef struct corner_table {
  /* owned; [size]; for each slot of the hash table, the index of a vertex plus 1; 0 for a free slot */
  uint32_t *slots;
  size_t size; /* number of slots, a power of two */
} corner_table;

static uint32_t hash_of(const float at[3]) {
  uint32_t bits[3], hash = 2166136261u; /* the hash function FNV-1a over words, mixed once more at the end */
  memcpy(bits, at, sizeof bits);
  for (int i = 0; i < 3; i++) hash = (hash ^ bits[i]) * 16777619u;
  hash ^= hash >> 15;
  return hash * 2246822519u ^ hash >> 13;
}

/* Returns the index of the vertex at a corner's position. If there is no such vertex, it is added. The table
 * must have room for it. */
static uint32_t vertex_at(mesh_parts *parts, corner_table *table, const float at[3]) {
  size_t slot = hash_of(at) & (table->size - 1);
  for (; table->slots[slot] != 0; slot = (slot + 1) & (table->size - 1))
    if (memcmp(parts->positions[table->slots[slot] - 1], at, 3 * sizeof *at) == 0)
      return table->slots[slot] - 1;
  memcpy(parts->positions[parts->vertex_count], at, 3 * sizeof *at);
  table->slots[slot] = (uint32_t)++parts->vertex_count;
  return (uint32_t)parts->vertex_count - 1;
}

/* Makes room for `count` triangles and their corners. */
static hl_status make_room(mesh_parts *parts, corner_table *table, size_t triangles, hl_error *error) {
  if (triangles > HL_LIMIT_TRIANGLES)
    return hl_fail(error, HL_ERROR_UNSUPPORTED, "%s: %zu triangles: at most %d: reduce them (decimate)",
                   parts->path, triangles, HL_LIMIT_TRIANGLES);
  for (table->size = 64; table->size < 4 * triangles;) table->size *= 2;
  table->slots = hl_allocate_zeroed(parts->context, table->size, sizeof *table->slots);
  if (table->slots == NULL) return hl_fail_memory(error, table->size * sizeof *table->slots, "a mesh");
  hl_status status = hl_mesh_reserve_vertices(parts, 3 * triangles, false, false, error);
  return status == HL_OK ? hl_mesh_reserve_triangles(parts, triangles, error) : status;
}

static hl_status add_facet(mesh_parts *parts, corner_table *table, const float corner[3][3],
                           hl_error *error) {
  uint32_t vertex[3];
  for (int i = 0; i < 3; i++) {
    float at[3];
    for (int axis = 0; axis < 3; axis++) at[axis] = corner[i][axis] + 0.0f; /* adding 0 turns -0 into 0 */
    vertex[i] = vertex_at(parts, table, at);
  }
  return hl_mesh_add_triangle(parts, vertex[0], vertex[1], vertex[2], error);
}

/* ---- binary ---- */

static size_t binary_count(mesh_text text) {
  if (text.length < HEADER_BYTES) return 0;
  const unsigned char *at = text.bytes + HEADER_BYTES - 4;
  return (size_t)at[0] | (size_t)at[1] << 8 | (size_t)at[2] << 16 | (size_t)at[3] << 24;
}

static hl_status read_binary(mesh_text text, size_t count, mesh_parts *parts, corner_table *table,
                             hl_error *error) {
  if (count > (text.length - HEADER_BYTES) / FACET_BYTES)
    return hl_fail(error, HL_ERROR_INPUT, "%s: claims %zu triangles, but has bytes for %zu: it is cut short",
                   parts->path, count, (text.length - HEADER_BYTES) / FACET_BYTES);
  hl_status status = make_room(parts, table, count, error);
  for (size_t t = 0; status == HL_OK && t < count; t++) {
    float corner[3][3];
    const unsigned char *at = text.bytes + HEADER_BYTES + t * FACET_BYTES + 12;
    for (int i = 0; i < 9; i++) corner[i / 3][i % 3] = float_at(at + 4 * i);
    status = add_facet(parts, table, (const float(*)[3])corner, error);
  }
  return status;
}

/* ---- ASCII ---- */

/* Takes the next word of the text. Returns false at the text's end. */
static bool next_word(const char **at, const char *end, const char **word, size_t *length) {
  while (*at < end && hl_is_space(**at)) (*at)++;
  *word = *at;
  while (*at < end && !hl_is_space(**at)) (*at)++;
  *length = (size_t)(*at - *word);
  return *length > 0;
}

/* Returns whether a word is a wanted word; upper and lower case count as the same. */
static bool is_word(const char *word, size_t length, const char *wanted) {
  if (length != strlen(wanted)) return false;
  for (size_t n = 0; n < length; n++)
    if ((word[n] | 0x20) != wanted[n]) return false;
  return true;
}

static size_t count_facets(mesh_text text) {
  size_t count = 0;
  for (const char *at = (const char *)text.bytes, *end = at + text.length; at < end; at++)
    if ((*at == 'v' || *at == 'V') && (size_t)(end - at) > 6 && is_word(at, 6, "vertex")) count++;
  return count / 3;
}

static hl_status read_ascii(mesh_text text, mesh_parts *parts, corner_table *table, hl_error *error) {
  const char *at = (const char *)text.bytes, *end = at + text.length, *word;
  size_t length, corners = 0;
  float corner[3][3];
  bool closed = true; /* whether "endsolid" stands behind the last vertex */
  hl_status status = make_room(parts, table, count_facets(text), error);
  while (status == HL_OK && next_word(&at, end, &word, &length)) {
    closed = closed || is_word(word, length, "endsolid");
    if (!is_word(word, length, "vertex")) continue;
    closed = false;
    for (int axis = 0; axis < 3; axis++) {
      double value;
      if (!next_word(&at, end, &word, &length) || !hl_text_number(word, length, &value))
        return hl_fail_offset(error, HL_ERROR_INPUT, (int64_t)(word - (const char *)text.bytes),
                              "%s: byte %zu: a vertex is three numbers", parts->path,
                              (size_t)(word - (const char *)text.bytes));
      corner[corners % 3][axis] = (float)value;
    }
    if (++corners % 3 == 0) status = add_facet(parts, table, (const float(*)[3])corner, error);
  }
  if (status != HL_OK || closed) return status;
  return hl_fail(error, HL_ERROR_INPUT, "%s: the file is cut short: it ends before \"endsolid\"",
                 parts->path);
}

/* Returns whether the file is text. A text begins with "solid", in letters of either case, after an optional
 * byte order mark and blanks. It has no zero bytes near its beginning; a binary file whose title begins with
 * "solid" has some. */
static bool is_text(mesh_text text) {
  enum { LOOKED_AT = 512 };
  const char *at = (const char *)text.bytes, *end = at + text.length, *word;
  size_t length;
  if (text.length >= 3 && memcmp(at, "\xef\xbb\xbf", 3) == 0) at += 3;
  return next_word(&at, end, &word, &length) && is_word(word, length, "solid") &&
         memchr(text.bytes, 0, text.length < LOOKED_AT ? text.length : LOOKED_AT) == NULL;
}

hl_status hl_mesh_read_stl(mesh_text text, mesh_parts *parts, hl_error *error) {
  corner_table table = {0};
  size_t count = binary_count(text);
  bool exact = text.length >= HEADER_BYTES && text.length - HEADER_BYTES == count * FACET_BYTES;
  bool solid = is_text(text);
  hl_status status;
  if (exact || (!solid && text.length >= HEADER_BYTES))
    status = read_binary(text, count, parts, &table, error);
  else if (solid) status = read_ascii(text, parts, &table, error);
  else status = hl_fail(error, HL_ERROR_INPUT, "%s: is too short for an STL file", parts->path);
  hl_release(parts->context, table.slots);
  return status;
}
