/* json/mesh_arrays.c - reads the arrays of a mesh whose elements the scene itself lists. */
#include <string.h>

#include "core/memory.h"
#include "json/parts.h"
#include "mesh/mesh.h"

const char *const hl_json_mesh_keys[] = {"vertices", "triangles",     "normals", "colors",      "face_colors",
                                         "spheres",  "sphere_colors", "lines",   "line_colors", NULL};

/* The rule for an array of rows of numbers: the possible lengths of a row, and the value of missing
 * numbers. */
typedef struct row_kind {
  size_t least, most; /* the least and the greatest number of numbers in a row */
  double rest;        /* the value of numbers that a row lacks */
  const char *wanted; /* for errors: the value that the scene should give instead */
} row_kind;

/* Reads one row of an array of numbers into `to`, which has kind->most places. */
static hl_status read_row(hl_json_reader *reader, const json_t *row, const row_kind *kind, float *to) {
  double numbers[4];
  size_t count = json_array_size(row);
  if (count < kind->least || count > kind->most)
    return hl_json_fail(reader, HL_ERROR_INPUT, NULL, "has %zu numbers: give %s", count, kind->wanted);
  hl_status status = hl_json_row(reader, row, NULL, count, numbers);
  for (size_t n = 0; status == HL_OK && n < kind->most; n++)
    to[n] = (float)(n < count ? numbers[n] : kind->rest);
  return status;
}

/* Reads the rows of an array. */
static hl_status read_rows(hl_json_reader *reader, const json_t *rows, const row_kind *kind, float *to) {
  hl_status status = HL_OK;
  for (size_t n = 0; status == HL_OK && n < json_array_size(rows); n++) {
    size_t mark = hl_json_enter_index(reader, n);
    status = read_row(reader, json_array_get(rows, n), kind, to + n * kind->most);
    if (status == HL_OK) hl_json_leave(reader, mark);
  }
  return status;
}

/* Reads an array of rows. If the array is absent, *to is not changed. wanted: the number of rows that the
 * array must have; SIZE_MAX for any number. */
static hl_status read_array(hl_json_reader *reader, const json_t *object, const char *key,
                            const row_kind *kind, size_t wanted, size_t *count, void *to) {
  const json_t *rows = json_object_get(object, key);
  if (rows == NULL) return HL_OK;
  size_t mark = hl_json_enter(reader, key);
  hl_status status = hl_json_array(reader, rows, 0, HL_LIMIT_LINE_POINTS);
  if (status != HL_OK) return status;
  *count = json_array_size(rows);
  if (wanted != SIZE_MAX && *count != wanted)
    return hl_json_fail(reader, HL_ERROR_INPUT, NULL, "has %zu rows: give one for each of %zu", *count,
                        wanted);
  float *made = hl_allocate(reader->context, *count * kind->most, sizeof *made);
  if (made == NULL) return hl_fail_memory(reader->error, *count * kind->most * sizeof *made, "a mesh");
  memcpy(to, &made, sizeof made);
  status = read_rows(reader, rows, kind, made);
  if (status == HL_OK) hl_json_leave(reader, mark);
  return status;
}

static hl_status read_triangles(hl_json_reader *reader, const json_t *object, mesh_parts *parts) {
  const json_t *rows = json_object_get(object, "triangles");
  if (rows == NULL && parts->positions == NULL) return HL_OK;
  if (rows == NULL)
    return hl_json_fail(reader, HL_ERROR_INPUT, "triangles",
                        "is missing: give three vertices of each triangle");
  size_t mark = hl_json_enter(reader, "triangles");
  hl_status status = hl_json_array(reader, rows, 0, HL_LIMIT_LINE_POINTS);
  for (size_t n = 0; status == HL_OK && n < json_array_size(rows); n++) {
    size_t inner = hl_json_enter_index(reader, n);
    double corner[3];
    status = hl_json_row(reader, json_array_get(rows, n), NULL, 3, corner);
    for (int i = 0; status == HL_OK && i < 3; i++)
      if (!(corner[i] >= 0 && corner[i] < (double)parts->vertex_count &&
            corner[i] == (double)(size_t)corner[i]))
        status = hl_json_fail(reader, HL_ERROR_INPUT, NULL, "names vertex %g: there are %zu, counted from 0",
                              corner[i], parts->vertex_count);
    if (status == HL_OK)
      status = hl_mesh_add_triangle(parts, (uint32_t)corner[0], (uint32_t)corner[1], (uint32_t)corner[2],
                                    reader->error);
    if (status == HL_OK) hl_json_leave(reader, inner);
  }
  if (status == HL_OK) hl_json_leave(reader, mark);
  return status;
}

/* Reads "lines", an array of lines, each of which is an array of points. */
static hl_status read_lines(hl_json_reader *reader, const json_t *object, const row_kind *kind,
                            mesh_parts *parts) {
  const json_t *lines = json_object_get(object, "lines");
  if (lines == NULL) return HL_OK;
  size_t mark = hl_json_enter(reader, "lines"), at = 0, points = 0;
  hl_status status = hl_json_array(reader, lines, 0, HL_LIMIT_LINE_POINTS);
  for (size_t n = 0; status == HL_OK && n < json_array_size(lines); n++)
    points += json_array_size(json_array_get(lines, n));
  if (status != HL_OK) return status;
  parts->line_points = hl_allocate(reader->context, points, sizeof *parts->line_points);
  parts->line_lengths = hl_allocate(reader->context, json_array_size(lines), sizeof *parts->line_lengths);
  if (parts->line_points == NULL || parts->line_lengths == NULL)
    return hl_fail_memory(reader->error, points * sizeof *parts->line_points, "a mesh's lines");
  for (size_t n = 0; status == HL_OK && n < json_array_size(lines); n++) {
    const json_t *line = json_array_get(lines, n);
    size_t inner = hl_json_enter_index(reader, n);
    status = hl_json_array(reader, line, 2, HL_LIMIT_LINE_POINTS);
    if (status == HL_OK) status = read_rows(reader, line, kind, parts->line_points[at]);
    parts->line_lengths[n] = (uint32_t)json_array_size(line);
    at += json_array_size(line);
    if (status == HL_OK) hl_json_leave(reader, inner);
  }
  parts->line_point_count = points;
  parts->line_count = json_array_size(lines);
  if (status == HL_OK) hl_json_leave(reader, mark);
  return status;
}

static hl_status read_parts(hl_json_reader *reader, const json_t *value, mesh_parts *parts) {
  const row_kind place = {3, 3, 0, "x, y and z"},
                 color = {3, 4, 1, "red, green and blue, or an opacity, too"};
  row_kind round = {4, 4, 0, "x, y, z and a radius, or one \"radius\" beside them all"};
  size_t ignored;
  hl_status status = hl_json_number(reader, value, "radius", &round.rest);
  if (json_object_get(value, "radius") != NULL) round.least = 3;
  if (status == HL_OK && round.least == 3 && !(round.rest > 0))
    status = hl_json_fail(reader, HL_ERROR_INPUT, "radius",
                          "%.9g is not above 0: give a length in world units", round.rest);
  if (status == HL_OK)
    status = read_array(reader, value, "vertices", &place, SIZE_MAX, &parts->vertex_count, &parts->positions);
  parts->vertex_room = parts->vertex_count;
  if (status == HL_OK)
    status = read_array(reader, value, "normals", &place, parts->vertex_count, &ignored, &parts->normals);
  if (status == HL_OK)
    status = read_array(reader, value, "colors", &color, parts->vertex_count, &ignored, &parts->colors);
  if (status == HL_OK) status = read_triangles(reader, value, parts);
  if (status == HL_OK)
    status = read_array(reader, value, "face_colors", &color, parts->triangle_count, &ignored,
                        &parts->face_colors);
  if (status == HL_OK)
    status = read_array(reader, value, "spheres", &round, SIZE_MAX, &parts->sphere_count, &parts->spheres);
  if (status == HL_OK)
    status = read_array(reader, value, "sphere_colors", &color, parts->sphere_count, &ignored,
                        &parts->sphere_colors);
  if (status == HL_OK) status = read_lines(reader, value, &round, parts);
  if (status != HL_OK) return status;
  return read_array(reader, value, "line_colors", &color, parts->line_point_count, &ignored,
                    &parts->line_colors);
}

hl_status hl_json_read_mesh_arrays(hl_json_reader *reader, const json_t *value, hl_mesh **mesh) {
  mesh_parts parts = {.context = reader->context, .path = reader->name};
  hl_status status = read_parts(reader, value, &parts);
  if (status == HL_OK) {
    status = hl_mesh_of_parts(&parts, mesh, reader->error);
    if (status == HL_ERROR_INPUT) hl_json_prefix(reader, reader->place);
  }
  hl_mesh_parts_release(&parts);
  return status;
}
