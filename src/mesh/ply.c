/* mesh/ply.c - reads PLY files (Turk 1994), ASCII and binary of either byte order: vertices with normals and
 * colours, and faces with colours. Other elements and properties are ignored. A file without faces is a cloud
 * of points. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "image/srgb.h"
#include "mesh/mesh.h"
#include "volume/io/numbers.h"

typedef enum ply_type {
  PLY_NONE,
  PLY_I8,
  PLY_U8,
  PLY_I16,
  PLY_U16,
  PLY_I32,
  PLY_U32,
  PLY_F32,
  PLY_F64
} ply_type;
static const struct {
  const char *names; /* the names of the type in files, with "|" between them */
  ply_type type;
  hl_voxel_type voxel; /* the voxel type with the same kind of numbers */
  int bytes;
} types[] = {{"", PLY_NONE, HL_VOXEL_U8, 0},
             {"char|int8", PLY_I8, HL_VOXEL_I8, 1},
             {"uchar|uint8", PLY_U8, HL_VOXEL_U8, 1},
             {"short|int16", PLY_I16, HL_VOXEL_I16, 2},
             {"ushort|uint16", PLY_U16, HL_VOXEL_U16, 2},
             {"int|int32", PLY_I32, HL_VOXEL_I32, 4},
             {"uint|uint32", PLY_U32, HL_VOXEL_U32, 4},
             {"float|float32", PLY_F32, HL_VOXEL_F32, 4},
             {"double|float64", PLY_F64, HL_VOXEL_F64, 8}};

/* The number of the mesh that a property of a vertex or a face becomes. */
typedef enum ply_role {
  ROLE_NONE = -1,
  ROLE_X,
  ROLE_NORMAL = 3,
  ROLE_COLOR = 6,
  ROLE_CORNERS = 10,
  ROLES
} ply_role;
static const char *const role_names[ROLES] = {"x",
                                              "y",
                                              "z",
                                              "nx",
                                              "ny",
                                              "nz",
                                              "red|r|diffuse_red",
                                              "green|g|diffuse_green",
                                              "blue|b|diffuse_blue",
                                              "alpha|a",
                                              "vertex_indices|vertex_index"};

enum { MOST_PROPERTIES = 64, MOST_ELEMENTS = 16, WORD_BYTES = 64 };

typedef struct ply_property {
  /* count: if the property is a list, the type of the number before the list, which tells the list's length;
   * PLY_NONE: the property is no list. type: the type of the property's numbers */
  ply_type count, type;
  int role;
} ply_property;

typedef struct ply_element {
  /* the kind of the element's items: vertices, faces or strips of triangles. Strips are faces whose corners
   * make strips of triangles, with -1 between strips */
  bool vertices, faces, strips;
  bool face_colors; /* whether faces have colours */
  size_t count;
  ply_property property[MOST_PROPERTIES];
  int property_count;
} ply_element;

typedef struct ply_reader {
  mesh_parts *parts;
  const char *at, *end; /* the part of the file that has not been read yet */
  int line;             /* number of the header line */
  bool ascii, big_endian;
  char line_end; /* the end of header lines: LF, or CR alone */
  ply_element element[MOST_ELEMENTS];
  int element_count;
  size_t face_color_room; /* number of triangles for which parts->face_colors has memory */
  size_t colored;         /* number of triangles that have colours */
  bool has_vertices;      /* whether the element with the vertices has been read already */
  hl_error *error;
} ply_reader;

static hl_status fail(ply_reader *reader, const char *what) {
  return hl_fail_at(reader->error, HL_ERROR_INPUT, reader->line, 0, "%s:%d: %s", reader->parts->path,
                    reader->line, what);
}

static hl_status fail_short(ply_reader *reader) {
  return hl_fail(reader->error, HL_ERROR_INPUT, "%s: ends before its last vertex or face",
                 reader->parts->path);
}

/* ---- header ---- */

static bool next_line(ply_reader *reader, const char **line, size_t *length) {
  if (reader->at >= reader->end) return false;
  const char *stop = memchr(reader->at, reader->line_end, (size_t)(reader->end - reader->at));
  *line = reader->at;
  *length = (size_t)((stop != NULL ? stop : reader->end) - reader->at);
  reader->at = stop != NULL ? stop + 1 : reader->end;
  reader->line++;
  return true;
}

/* Splits a header line into words, and returns the number of words. */
static int split(const char *line, size_t length, char word[6][WORD_BYTES]) {
  int count = 0;
  for (size_t at = 0; at < length && count < 6;) {
    while (at < length && hl_is_space(line[at])) at++;
    size_t start = at;
    while (at < length && !hl_is_space(line[at])) at++;
    if (at == start) break;
    size_t bytes = at - start < WORD_BYTES - 1 ? at - start : WORD_BYTES - 1;
    memcpy(word[count], line + start, bytes);
    word[count++][bytes] = 0;
  }
  return count;
}

static ply_type type_of(const char *name) {
  for (size_t n = 1; n < sizeof types / sizeof *types; n++)
    if (hl_text_is_one_of(name, types[n].names)) return types[n].type;
  return PLY_NONE;
}

static int role_of(const char *name) {
  for (int role = 0; role < ROLES; role++)
    if (hl_text_is_one_of(name, role_names[role])) return role;
  return ROLE_NONE;
}

static hl_status add_element(ply_reader *reader, char word[6][WORD_BYTES], int words) {
  size_t count;
  if (words != 3 || hl_text_sizes(word[2], &count, 1) != 1)
    return fail(reader, "an element has a name and a number");
  if (reader->element_count == MOST_ELEMENTS) return fail(reader, "more than 16 elements");
  reader->element[reader->element_count++] = (ply_element){
      .vertices = hl_text_equal(word[1], "vertex"),
      .faces = hl_text_equal(word[1], "face") || hl_text_equal(word[1], "tristrips"),
      .strips = hl_text_equal(word[1], "tristrips"),
      .count = count};
  return HL_OK;
}

static hl_status add_property(ply_reader *reader, char word[6][WORD_BYTES], int words) {
  ply_element *element = reader->element_count > 0 ? &reader->element[reader->element_count - 1] : NULL;
  bool list = words == 5 && strcmp(word[1], "list") == 0;
  if (element == NULL || (!list && words != 3))
    return fail(reader, "a property is TYPE NAME or list TYPE TYPE NAME");
  if (element->property_count == MOST_PROPERTIES)
    return fail(reader, "more than 64 properties of an element");
  ply_property property = {.count = list ? type_of(word[2]) : PLY_NONE, .type = type_of(word[list ? 3 : 1])};
  if (property.type == PLY_NONE || (list && (property.count == PLY_NONE || property.count >= PLY_F32)))
    return fail(reader, "a property of an unknown type");
  property.role = role_of(word[list ? 4 : 2]);
  bool of_faces = property.role == ROLE_CORNERS || property.role >= ROLE_COLOR;
  if (list != (property.role == ROLE_CORNERS) || (element->faces && !of_faces) || (!element->faces && list))
    property.role = ROLE_NONE;
  element->property[element->property_count++] = property;
  return HL_OK;
}

static hl_status read_header(ply_reader *reader) {
  const char *line;
  size_t length;
  bool known = false;
  while (next_line(reader, &line, &length)) {
    char word[6][WORD_BYTES];
    int words = split(line, length, word);
    hl_status status = HL_OK;
    if (words == 0 || strcmp(word[0], "comment") == 0 || strcmp(word[0], "obj_info") == 0) continue;
    if (strcmp(word[0], "end_header") == 0) return known ? HL_OK : fail(reader, "the format is missing");
    if (strcmp(word[0], "format") == 0 && words >= 2) {
      reader->ascii = strcmp(word[1], "ascii") == 0;
      reader->big_endian = strcmp(word[1], "binary_big_endian") == 0;
      known = reader->ascii || reader->big_endian || strcmp(word[1], "binary_little_endian") == 0;
      if (!known) status = fail(reader, "the format is ascii, binary_little_endian or binary_big_endian");
    } else if (strcmp(word[0], "element") == 0) status = add_element(reader, word, words);
    else if (strcmp(word[0], "property") == 0) status = add_property(reader, word, words);
    if (status != HL_OK) return status;
  }
  return fail(reader, "the header has no end_header");
}

/* ---- numbers ---- */

static bool read_word(ply_reader *reader, double *value) {
  while (reader->at < reader->end && hl_is_space(*reader->at)) reader->at++;
  const char *start = reader->at;
  while (reader->at < reader->end && !hl_is_space(*reader->at)) reader->at++;
  return hl_text_number(start, (size_t)(reader->at - start), value);
}

/* Reads the next number, which has a given type. Returns false at the end of the file. */
static bool read_number(ply_reader *reader, ply_type type, double *value) {
  if (reader->ascii) return read_word(reader, value);
  int bytes = types[type].bytes;
  if (reader->end - reader->at < bytes) return false;
  *value = hl_binary_number((const unsigned char *)reader->at, types[type].voxel, reader->big_endian);
  reader->at += bytes;
  return true;
}

/* ---- elements ---- */

/* A colour's channel as a fraction of the greatest number that its type holds. */
static double fraction_of(ply_type type, double value) {
  double most = type == PLY_U8 ? 255 : type == PLY_U16 ? 65535 : 1;
  return fmin(fmax(value / most, 0), 1);
}

/* Sets one channel of a colour, which is linear RGB and alpha. role: ROLE_COLOR for red, the next numbers for
 * green, blue and alpha. */
static void set_color(float color[4], int role, ply_type type, double value) {
  double fraction = fraction_of(type, value);
  bool linear = type >= PLY_F32 || role == ROLE_COLOR + 3;
  color[role - ROLE_COLOR] = (float)(linear ? fraction : hl_srgb_decode(fraction));
}

static void set_vertex(mesh_parts *parts, int role, ply_type type, double value) {
  size_t v = parts->vertex_count;
  if (role < ROLE_NORMAL) parts->positions[v][role] = (float)value;
  else if (role < ROLE_COLOR) parts->normals[v][role - ROLE_NORMAL] = (float)value;
  else set_color(parts->colors[v], role, type, value);
}

/* Gives a face's colour to the triangles of this face, which are the triangles from `first` on. Earlier
 * triangles without colours become white. */
static hl_status color_faces(ply_reader *reader, size_t first, const float color[4]) {
  mesh_parts *parts = reader->parts;
  if (parts->triangle_count > reader->face_color_room || parts->face_colors == NULL) {
    size_t room = 2 * parts->triangle_count + 1024;
    float(*grown)[4] = hl_reallocate(parts->context, parts->face_colors, room, sizeof *grown);
    if (grown == NULL) return hl_fail_memory(reader->error, room * sizeof *grown, parts->path);
    parts->face_colors = grown;
    reader->face_color_room = room;
  }
  static const float white[4] = {1, 1, 1, 1}; /* the colour of earlier triangles, which come from an element
                                               * without colours */
  for (size_t t = reader->colored; t < parts->triangle_count; t++)
    memcpy(parts->face_colors[t], t < first ? white : color, sizeof *parts->face_colors);
  reader->colored = parts->triangle_count;
  return HL_OK;
}

static hl_status fail_corner(const ply_reader *reader, double corner) {
  return hl_fail(reader->error, HL_ERROR_INPUT, "%s: a face names vertex %.9g", reader->parts->path, corner);
}

/* Reads a face's corners, of which a fan of triangles is made. */
static hl_status read_corners(ply_reader *reader, const ply_property *property) {
  double count, corner;
  uint32_t first = 0, before = 0;
  size_t first_triangle = reader->parts->triangle_count;
  if (!read_number(reader, property->count, &count)) return fail_short(reader);
  for (double n = 0; n < count; n++) {
    if (!read_number(reader, property->type, &corner)) return fail_short(reader);
    if (!(corner >= 0 && corner <= UINT32_MAX)) return fail_corner(reader, corner);
    hl_status status = HL_OK;
    if (n >= 2) status = hl_mesh_add_triangle(reader->parts, first, before, (uint32_t)corner, reader->error);
    if (status != HL_OK) return status;
    if (n == 0) first = (uint32_t)corner;
    before = (uint32_t)corner;
  }
  return hl_mesh_note_polygon(reader->parts, first_triangle, reader->error);
}

/* Reads the corners of strips of triangles. Each corner makes a triangle with the two corners before it, and
 * every second triangle is turned over; -1 ends a strip. */
static hl_status read_strips(ply_reader *reader, const ply_property *property) {
  double count, corner;
  uint32_t last[2] = {0, 0};
  size_t length = 0; /* number of corners of the current strip so far */
  if (!read_number(reader, property->count, &count)) return fail_short(reader);
  for (double n = 0; n < count; n++) {
    if (!read_number(reader, property->type, &corner)) return fail_short(reader);
    if (corner == -1) {
      length = 0;
      continue;
    }
    if (!(corner >= 0 && corner <= UINT32_MAX)) return fail_corner(reader, corner);
    bool turned = length % 2 == 1;
    hl_status status = HL_OK;
    if (length >= 2)
      status = hl_mesh_add_triangle(reader->parts, last[turned], last[!turned], (uint32_t)corner,
                                    reader->error);
    if (status != HL_OK) return status;
    last[0] = last[1];
    last[1] = (uint32_t)corner;
    length++;
  }
  return HL_OK;
}

static hl_status skip_list(ply_reader *reader, const ply_property *property) {
  double count, value;
  if (!read_number(reader, property->count, &count)) return fail_short(reader);
  for (double n = 0; n < count; n++)
    if (!read_number(reader, property->type, &value)) return fail_short(reader);
  return HL_OK;
}

static hl_status read_item(ply_reader *reader, const ply_element *element) {
  float color[4] = {1, 1, 1, 1};
  size_t first = reader->parts->triangle_count;
  for (int p = 0; p < element->property_count; p++) {
    const ply_property *property = &element->property[p];
    hl_status status = HL_OK;
    double value;
    if (property->count != PLY_NONE && property->role == ROLE_CORNERS)
      status = element->strips ? read_strips(reader, property) : read_corners(reader, property);
    else if (property->count != PLY_NONE) status = skip_list(reader, property);
    else if (!read_number(reader, property->type, &value)) status = fail_short(reader);
    else if (element->vertices && property->role != ROLE_NONE)
      set_vertex(reader->parts, property->role, property->type, value);
    else if (element->face_colors && property->role >= ROLE_COLOR)
      set_color(color, property->role, property->type, value);
    if (status != HL_OK) return status;
  }
  if (element->vertices) reader->parts->vertex_count++;
  return element->face_colors ? color_faces(reader, first, color) : HL_OK;
}

static bool has_role(const ply_element *element, int first, int last) {
  bool found[ROLES] = {false};
  for (int p = 0; p < element->property_count; p++)
    if (element->property[p].role >= 0) found[element->property[p].role] = true;
  for (int role = first; role <= last; role++)
    if (!found[role]) return false;
  return true;
}

/* The least number of bytes that an item of an element takes in the file. */
static size_t least_bytes(const ply_reader *reader, const ply_element *element) {
  size_t bytes = 0;
  for (int p = 0; p < element->property_count; p++) {
    ply_type type = element->property[p].count != PLY_NONE ? element->property[p].count
                                                           : element->property[p].type;
    bytes += reader->ascii ? 2 : (size_t)types[type].bytes;
  }
  return bytes;
}

static hl_status begin_vertices(ply_reader *reader, ply_element *element) {
  mesh_parts *parts = reader->parts;
  if (!has_role(element, ROLE_X, ROLE_X + 2))
    return hl_fail(reader->error, HL_ERROR_INPUT, "%s: its vertices have no x, y and z", parts->path);
  bool normals = has_role(element, ROLE_NORMAL, ROLE_NORMAL + 2),
       colors = has_role(element, ROLE_COLOR, ROLE_COLOR + 2);
  for (int p = 0; p < element->property_count; p++) {
    int *role = &element->property[p].role;
    if ((!normals && *role >= ROLE_NORMAL && *role < ROLE_COLOR) || (!colors && *role >= ROLE_COLOR))
      *role = ROLE_NONE;
  }
  hl_status status = hl_mesh_reserve_vertices(parts, element->count, normals, colors, reader->error);
  for (size_t v = 0; status == HL_OK && colors && v < element->count; v++) parts->colors[v][3] = 1;
  return status;
}

static hl_status read_element(ply_reader *reader, ply_element *element) {
  size_t least = least_bytes(reader, element), left = (size_t)(reader->end - reader->at) + 1;
  if (element->count > UINT32_MAX || (least > 0 && element->count > left / least) ||
      (least == 0 && element->count > 0))
    return hl_fail(reader->error, HL_ERROR_INPUT,
                   "%s: claims an element of %zu items, but has only %zu bytes left", reader->parts->path,
                   element->count, left - 1);
  if (element->vertices && reader->has_vertices) return fail(reader, "the header has vertices twice");
  reader->has_vertices |= element->vertices;
  hl_status status = element->vertices ? begin_vertices(reader, element) : HL_OK;
  element->face_colors = element->faces && has_role(element, ROLE_COLOR, ROLE_COLOR + 2);
  for (size_t n = 0; status == HL_OK && n < element->count; n++) status = read_item(reader, element);
  return status;
}

hl_status hl_mesh_read_ply(mesh_text text, mesh_parts *parts, hl_error *error) {
  ply_reader reader = {.parts = parts, .at = (const char *)text.bytes, .line = 0, .error = error};
  reader.end = reader.at + text.length;
  const char *line;
  size_t length;
  reader.line_end = text.length > 4 && text.bytes[3] == '\r' && text.bytes[4] != '\n' ? '\r' : '\n';
  if (!next_line(&reader, &line, &length)) return fail(&reader, "is empty");
  hl_status status = read_header(&reader);
  for (int e = 0; status == HL_OK && e < reader.element_count; e++)
    status = read_element(&reader, &reader.element[e]);
  static const float none[4] = {1, 1, 1, 1};
  if (status == HL_OK && parts->face_colors != NULL && reader.colored < parts->triangle_count)
    status = color_faces(&reader, parts->triangle_count, none);
  return status == HL_OK ? hl_mesh_show_points(parts, error) : status;
}
