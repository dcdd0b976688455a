/* mesh/legacy_polydata.c - reads legacy .vtk files with POLYDATA, ASCII or BINARY (big-endian): cells as
 * lists of "count, points" (up to version 4.2), or as OFFSETS and CONNECTIVITY (5.1). */
#include <string.h>

#include "core/memory.h"
#include "mesh/polydata.h"
#include "volume/formats/vtk/legacy_arrays.h"
#include "volume/io/numbers.h"

typedef struct legacy_file {
  hl_legacy_vtk file; /* this member must be the first one, because callbacks get its address and find the
                       * other members from it */
  polydata data;
  bool is_polydata;
} legacy_file;

/* Reads `count` numbers of a file. *numbers is owned by the caller. */
static hl_status read_numbers(hl_legacy_vtk *file, hl_voxel_type type, size_t count, double **numbers,
                              hl_error *error) {
  hl_number_code code = {.type = type, .text = file->text, .big_endian = true};
  hl_release(file->stream->context, *numbers);
  *numbers = NULL;
  return hl_read_numbers(file->stream, &code, count, numbers, error);
}

/* Reads "POINTS n type" and the coordinates that follow. */
static hl_status read_points(legacy_file *reader, const char *arguments, hl_error *error) {
  char number[HL_LEGACY_WORD_BYTES], type_name[HL_LEGACY_WORD_BYTES];
  const char *cursor = arguments;
  hl_voxel_type type;
  if (!hl_text_word(&cursor, number, sizeof number) || !hl_text_word(&cursor, type_name, sizeof type_name) ||
      hl_text_sizes(number, &reader->data.point_count, 1) != 1 || reader->data.point_count > SIZE_MAX / 24)
    return hl_legacy_vtk_fail(&reader->file, "expected \"POINTS number type\", not", arguments, error);
  hl_status status = hl_legacy_vtk_type(&reader->file, type_name, &type, error);
  return status == HL_OK
             ? read_numbers(&reader->file, type, 3 * reader->data.point_count, &reader->data.points, error)
             : status;
}

/* Reads the next line that is not empty: "keyword type". */
static hl_status read_named(hl_legacy_vtk *file, const char *keyword, hl_voxel_type *type, hl_error *error) {
  char line[HL_LINE_BYTES], word[HL_LEGACY_WORD_BYTES], type_name[HL_LEGACY_WORD_BYTES];
  bool ended = false, found = false;
  const char *cursor = line;
  while (!found && !ended) {
    hl_status status = hl_legacy_vtk_line(file, line, &ended, error);
    if (status != HL_OK) return status;
    cursor = line;
    found = hl_text_word(&cursor, word, sizeof word);
  }
  if (!found || !hl_text_equal(word, keyword) || !hl_text_word(&cursor, type_name, sizeof type_name))
    return hl_legacy_vtk_fail(file, "expected OFFSETS, then CONNECTIVITY, not", line, error);
  return hl_legacy_vtk_type(file, type_name, type, error);
}

/* Reads the cells of a file of version 5.1. CONNECTIVITY has the points of all cells; OFFSETS has the index
 * in CONNECTIVITY at which each cell begins, and the index at which the last cell ends. */
static hl_status read_offsets(hl_legacy_vtk *file, cells *cells, size_t offsets, size_t points,
                              hl_error *error) {
  hl_voxel_type type;
  hl_status status = read_named(file, "OFFSETS", &type, error);
  if (status == HL_OK) status = read_numbers(file, type, offsets, &cells->ends, error);
  if (status == HL_OK) status = read_named(file, "CONNECTIVITY", &type, error);
  if (status == HL_OK) status = read_numbers(file, type, points, &cells->points, error);
  if (status != HL_OK) return status;
  cells->count = offsets > 0 ? offsets - 1 : 0;
  cells->point_count = points;
  if (offsets > 0 && cells->ends[0] != 0)
    return hl_legacy_vtk_fail(file, "OFFSETS must begin with", "0", error);
  if (cells->count > 0) memmove(cells->ends, cells->ends + 1, cells->count * sizeof *cells->ends);
  return HL_OK;
}

/* Reads the cells of a file of an older version. For each cell the file has its number of points, and then
 * its points. The numbers of points are left out of cells->points. */
static hl_status read_lists(hl_legacy_vtk *file, cells *cells, size_t count, size_t numbers,
                            hl_error *error) {
  hl_status status = HL_OK;
  if (count > numbers)
    return hl_legacy_vtk_fail(file, "more cells than numbers under", "a kind of cells", error);
  status = read_numbers(file, HL_VOXEL_I32, numbers, &cells->points, error);
  if (status != HL_OK || count == 0) return status;
  cells->ends = hl_allocate(file->stream->context, count, sizeof *cells->ends);
  if (cells->ends == NULL) return hl_fail_memory(error, count * sizeof *cells->ends, file->stream->path);
  size_t at = 0, to = 0;
  for (size_t n = 0; n < count; n++) {
    double length = at < numbers ? cells->points[at++] : -1;
    if (!(length >= 0 && length <= (double)(numbers - at)) || length != (double)(size_t)length)
      return hl_legacy_vtk_fail(file, "a cell has an impossible number of points under", "a kind of cells",
                                error);
    memmove(cells->points + to, cells->points + at, (size_t)length * sizeof *cells->points);
    at += (size_t)length, to += (size_t)length;
    cells->ends[n] = (double)to;
  }
  cells->count = count;
  cells->point_count = to;
  return HL_OK;
}

/* Finds whether cells are written as in version 5.1: whether the line after the keyword's line begins with
 * OFFSETS. */
static hl_status is_newer(hl_legacy_vtk *file, bool *newer, hl_error *error) {
  const unsigned char *bytes;
  size_t available;
  hl_status status = hl_stream_peek(file->stream, 7, &bytes, &available, error);
  *newer = status == HL_OK && available >= 7 && hl_text_starts((const char *)bytes, "OFFSETS");
  return status;
}

static hl_status read_cells(legacy_file *reader, cell_kind kind, const char *arguments, hl_error *error) {
  size_t sizes[2];
  bool newer;
  cells *cells = &reader->data.cells[kind];
  if (hl_text_sizes(arguments, sizes, 2) != 2)
    return hl_legacy_vtk_fail(&reader->file, "expected two numbers after a kind of cells, not", arguments,
                              error);
  if (cells->ends != NULL || cells->points != NULL)
    return hl_legacy_vtk_fail(&reader->file, "cells of one kind twice, before", arguments, error);
  hl_status status = is_newer(&reader->file, &newer, error);
  if (status != HL_OK) return status;
  return newer ? read_offsets(&reader->file, cells, sizes[0], sizes[1], error)
               : read_lists(&reader->file, cells, sizes[0], sizes[1], error);
}

static hl_status read_keyword(hl_legacy_vtk *file, const char *keyword, const char *arguments,
                              hl_error *error) {
  static const char *const kinds[CELL_KINDS] = {"VERTICES", "LINES", "POLYGONS", "TRIANGLE_STRIPS"};
  legacy_file *reader = (legacy_file *)file;
  if (hl_text_equal(keyword, "DATASET")) {
    reader->is_polydata = hl_text_equal(arguments, "POLYDATA");
    return reader->is_polydata
               ? HL_OK
               : hl_legacy_vtk_fail(file, "a mesh is a data set of kind POLYDATA, not", arguments, error);
  }
  if (hl_text_equal(keyword, "POINTS") && reader->data.points == NULL)
    return read_points(reader, arguments, error);
  for (int kind = 0; kind < CELL_KINDS; kind++)
    if (hl_text_equal(keyword, kinds[kind])) return read_cells(reader, (cell_kind)kind, arguments, error);
  return hl_legacy_vtk_fail(file, "cannot follow here:", keyword, error);
}

static hl_status meet_array(hl_legacy_vtk *file, const hl_legacy_array *array, hl_error *error) {
  legacy_file *reader = (legacy_file *)file;
  cell_values shape = {.tuples = array->tuples, .components = array->components, .type = array->type};
  const char *name = strcmp(array->kind, "NORMALS") == 0 ? "normals" : array->name;
  bool active = hl_text_is_one_of(array->kind, "SCALARS|COLOR_SCALARS");
  cell_values *values = hl_polydata_claim(&reader->data, name, &shape,
                                          array->of_points ? AT_POINTS : AT_CELLS, active);
  /* An array of the whole file (FIELD) may have a number of tuples that is not the number of points or
   * cells. */
  if (values == NULL || array->tuples != file->tuples) return hl_legacy_vtk_skip_array(file, array, error);
  shape.values = values->values;
  size_t count = array->tuples * array->components;
  hl_status status = read_numbers(file, array->type, count, &shape.values, error);
  *values = shape;
  for (size_t n = 0; status == HL_OK && array->is_fraction && file->text && n < count; n++)
    shape.values[n] *= 255;
  return status;
}

hl_status hl_mesh_read_legacy_vtk(mesh_text text, mesh_parts *parts, hl_error *error) {
  legacy_file reader = {.file = {.meet = meet_array, .keyword = read_keyword},
                        .data = {.context = parts->context, .path = parts->path}};
  hl_status status = hl_stream_open_memory(parts->context, parts->path, text.bytes, text.length,
                                           &reader.file.stream, error);
  if (status == HL_OK) status = hl_legacy_vtk_read(&reader.file, error);
  if (status == HL_OK && !reader.is_polydata)
    status = hl_fail(error, HL_ERROR_INPUT, "%s: has no \"DATASET POLYDATA\"", parts->path);
  if (status == HL_OK) status = hl_polydata_to_parts(&reader.data, parts, error);
  hl_stream_close(reader.file.stream);
  hl_polydata_release(&reader.data);
  return status;
}
