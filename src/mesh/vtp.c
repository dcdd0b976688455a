/* mesh/vtp.c - VTK XML PolyData (.vtp): ascii, base64 and appended arrays, plain or in zlib blocks.
 *
 * A first pass over the tags lists the arrays; then each one that is needed is read, cells before the arrays
 * whose length they tell. */
#include <string.h>

#include "core/memory.h"
#include "mesh/polydata.h"
#include "volume/convert.h"
#include "volume/numbers.h"
#include "volume/vtk_xml.h"

enum { MOST_ARRAYS = 256 };

/* The elements that hold arrays: the four kinds of cells first. */
typedef enum section {
  SECTION_POINTS = CELL_KINDS,
  SECTION_POINT_DATA,
  SECTION_CELL_DATA,
  SECTION_NONE
} section;
static const char *const section_names[SECTION_NONE] = {"Verts",  "Lines",     "Polys",   "Strips",
                                                        "Points", "PointData", "CellData"};
static const char *const count_names[CELL_KINDS] = {"NumberOfVerts", "NumberOfLines", "NumberOfPolys",
                                                    "NumberOfStrips"};

typedef struct vtp_array {
  hl_vtk_array array;
  section section;
  char name[HL_VTK_NAME_BYTES];
  size_t components;
  bool active;
} vtp_array;

typedef struct vtp_file {
  hl_vtk_xml xml;
  mesh_text text;
  polydata data;
  section section;
  char active_scalars[HL_VTK_NAME_BYTES], active_normals[HL_VTK_NAME_BYTES]; /* of the section */
  bool has_piece, passes_over; /* passes over the arrays of an empty piece beside another one */
  size_t array_count;
  vtp_array arrays[MOST_ARRAYS];
} vtp_file;

static hl_status read_count(vtp_file *file, const hl_xml_tag *tag, const char *name, size_t *count,
                            hl_error *error) {
  const char *value = hl_xml_attribute(tag, name);
  if (value == NULL || hl_text_sizes(value, count, 1) == 1) return HL_OK;
  return hl_vtk_xml_refuse(&file->xml, HL_ERROR_INPUT, name, value, error);
}

static hl_status read_piece_tag(vtp_file *file, const hl_xml_tag *tag, hl_error *error) {
  size_t points = 0;
  hl_status status = read_count(file, tag, "NumberOfPoints", &points, error);
  file->passes_over = file->has_piece && points == 0;
  if (status != HL_OK || file->passes_over) return status;
  if (file->has_piece && file->data.point_count > 0)
    return hl_fail(error, HL_ERROR_UNSUPPORTED, "%s: meshes in several pieces are not read: save it as one",
                   file->xml.stream->path);
  file->has_piece = true;
  file->array_count = 0; /* those of empty pieces before this one */
  file->data.point_count = points;
  for (int kind = 0; status == HL_OK && kind < CELL_KINDS; kind++)
    status = read_count(file, tag, count_names[kind], &file->data.cells[kind].count, error);
  return status;
}

static void copy_name(char to[HL_VTK_NAME_BYTES], const char *name) {
  to[0] = 0;
  if (name != NULL && strlen(name) < HL_VTK_NAME_BYTES) strcpy(to, name);
}

static hl_status read_array_tag(vtp_file *file, const hl_xml_tag *tag, hl_error *error) {
  if (file->section == SECTION_NONE || file->passes_over || file->array_count == MOST_ARRAYS) return HL_OK;
  vtp_array *array = &file->arrays[file->array_count];
  *array = (vtp_array){.section = file->section, .components = 1};
  hl_status status = hl_vtk_xml_array_tag(&file->xml, tag, &array->array, error);
  if (status == HL_OK) status = read_count(file, tag, "NumberOfComponents", &array->components, error);
  if (status != HL_OK) return status;
  copy_name(array->name, hl_xml_attribute(tag, "Name"));
  array->active = array->name[0] != 0 && strcmp(array->name, file->active_scalars) == 0;
  if (array->name[0] != 0 && strcmp(array->name, file->active_normals) == 0) strcpy(array->name, "Normals");
  file->array_count++;
  return HL_OK;
}

static void begin_section(vtp_file *file, const hl_xml_tag *tag) {
  for (int n = 0; n < SECTION_NONE; n++) {
    if (strcmp(tag->name, section_names[n]) != 0) continue;
    file->section = tag->is_end ? SECTION_NONE : (section)n;
    copy_name(file->active_scalars, hl_xml_attribute(tag, "Scalars"));
    copy_name(file->active_normals, hl_xml_attribute(tag, "Normals"));
  }
}

static hl_status read_tag(vtp_file *file, const hl_xml_tag *tag, hl_error *error) {
  if (!tag->is_start) {
    for (int n = 0; n < SECTION_NONE; n++)
      if (strcmp(tag->name, section_names[n]) == 0) file->section = SECTION_NONE;
    return HL_OK;
  }
  if (file->xml.header_bytes == 0 && strcmp(tag->name, "VTKFile") != 0)
    return hl_vtk_xml_refuse(&file->xml, HL_ERROR_UNSUPPORTED, "an XML file whose first element is",
                             tag->name, error);
  if (strcmp(tag->name, "VTKFile") == 0) return hl_vtk_xml_file_tag(&file->xml, tag, "PolyData", error);
  if (strcmp(tag->name, "Piece") == 0) return read_piece_tag(file, tag, error);
  if (strcmp(tag->name, "DataArray") == 0) return read_array_tag(file, tag, error);
  if (strcmp(tag->name, "AppendedData") == 0) return hl_vtk_xml_appended_tag(&file->xml, tag, error);
  begin_section(file, tag);
  return HL_OK;
}

static hl_status read_tags(vtp_file *file, hl_error *error) {
  hl_xml_tag tag;
  bool ended = false;
  while (!ended && file->xml.appended == 0) {
    hl_status status = hl_xml_next_tag(file->xml.stream, &tag, &ended, error);
    if (status == HL_OK && !ended) status = read_tag(file, &tag, error);
    if (status != HL_OK) return status;
  }
  return HL_OK;
}

/* Reads `count` numbers of an array; *numbers is owned by the caller. */
static hl_status read_numbers(vtp_file *file, const vtp_array *array, size_t count, double **numbers,
                              hl_error *error) {
  hl_number_code code = {.text = array->array.encoding == HL_VTK_ASCII, .big_endian = file->xml.big_endian};
  hl_stream *stream = NULL;
  hl_status status = hl_vtk_xml_type(&file->xml, array->array.type, &code.type, error);
  if (status != HL_OK || count == 0) return status;
  if (count > SIZE_MAX / 8)
    return hl_fail(error, HL_ERROR_INPUT, "%s: impossible number of values in an array", file->data.path);
  status = hl_stream_open_memory(file->data.context, file->data.path, file->text.bytes, file->text.length,
                                 &stream, error);
  if (status != HL_OK) return status;
  status = hl_vtk_xml_open_array(&stream, &file->xml, &array->array, count * hl_voxel_type_bytes(code.type),
                                 error);
  hl_release(file->data.context, *numbers);
  *numbers = NULL;
  if (status == HL_OK) status = hl_read_numbers(stream, &code, count, numbers, error);
  hl_stream_close(stream);
  return status;
}

/* The first array of a section and name; null: none. */
static const vtp_array *find_array(const vtp_file *file, section section, const char *name) {
  for (size_t n = 0; n < file->array_count; n++)
    if (file->arrays[n].section == section && (name == NULL || strcmp(file->arrays[n].name, name) == 0))
      return &file->arrays[n];
  return NULL;
}

static hl_status fail_missing(const vtp_file *file, const char *what, hl_error *error) {
  return hl_fail(error, HL_ERROR_INPUT, "%s: has no array of %s", file->data.path, what);
}

static hl_status read_points(vtp_file *file, hl_error *error) {
  const vtp_array *points = find_array(file, SECTION_POINTS, NULL);
  if (points == NULL || points->components != 3) return fail_missing(file, "points", error);
  if (file->data.point_count > SIZE_MAX / 24) return fail_missing(file, "so many points", error);
  return read_numbers(file, points, 3 * file->data.point_count, &file->data.points, error);
}

static hl_status read_cells(vtp_file *file, int kind, hl_error *error) {
  cells *cells = &file->data.cells[kind];
  const vtp_array *ends = find_array(file, (section)kind, "offsets"),
                  *points = find_array(file, (section)kind, "connectivity");
  if (cells->count == 0) return HL_OK;
  if (ends == NULL || points == NULL) return fail_missing(file, "offsets or connectivity", error);
  hl_status status = read_numbers(file, ends, cells->count, &cells->ends, error);
  if (status != HL_OK) return status;
  double last = cells->ends[cells->count - 1];
  if (!(last >= 0 && last <= 1e15))
    return hl_fail(error, HL_ERROR_INPUT, "%s: cells end at point %.9g", file->data.path, last);
  cells->point_count = (size_t)last;
  return read_numbers(file, points, cells->point_count, &cells->points, error);
}

static size_t cell_count(const vtp_file *file) {
  size_t count = 0;
  for (int kind = 0; kind < CELL_KINDS; kind++) count += file->data.cells[kind].count;
  return count;
}

/* Reads an array of values where it is of use. */
static hl_status read_values(vtp_file *file, const vtp_array *array, hl_error *error) {
  value_place place = array->section == SECTION_POINT_DATA ? AT_POINTS : AT_CELLS;
  cell_values shape = {.components = array->components,
                       .tuples = place == AT_POINTS ? file->data.point_count : cell_count(file)};
  if (!hl_vtk_xml_find_type(array->array.type, &shape.type)) return HL_OK;
  cell_values *values = hl_polydata_claim(&file->data, array->name, &shape, place, array->active);
  if (values == NULL || shape.tuples == 0) return HL_OK;
  if (shape.components == 0 || shape.components > SIZE_MAX / 8 / shape.tuples)
    return hl_fail(error, HL_ERROR_INPUT, "%s: impossible number of values in an array", file->data.path);
  shape.values = values->values;
  hl_status status = read_numbers(file, array, shape.tuples * shape.components, &shape.values, error);
  *values = shape;
  return status;
}

static hl_status read_arrays(vtp_file *file, hl_error *error) {
  hl_status status = read_points(file, error);
  for (int kind = 0; status == HL_OK && kind < CELL_KINDS; kind++) status = read_cells(file, kind, error);
  for (size_t n = 0; status == HL_OK && n < file->array_count; n++)
    if (file->arrays[n].section == SECTION_POINT_DATA || file->arrays[n].section == SECTION_CELL_DATA)
      status = read_values(file, &file->arrays[n], error);
  return status;
}

hl_status hl_mesh_read_vtp(mesh_text text, mesh_parts *parts, hl_error *error) {
  vtp_file *file = hl_allocate_zeroed(parts->context, 1, sizeof *file);
  if (file == NULL) return hl_fail_memory(error, sizeof *file, parts->path);
  file->text = text;
  file->section = SECTION_NONE;
  file->data = (polydata){.context = parts->context, .path = parts->path};
  hl_status status = hl_stream_open_memory(parts->context, parts->path, text.bytes, text.length,
                                           &file->xml.stream, error);
  if (status == HL_OK) status = read_tags(file, error);
  if (status == HL_OK) status = read_arrays(file, error);
  if (status == HL_OK) status = hl_polydata_to_parts(&file->data, parts, error);
  hl_stream_close(file->xml.stream);
  hl_polydata_release(&file->data);
  hl_release(parts->context, file);
  return status;
}
