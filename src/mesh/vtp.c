/* mesh/vtp.c - reads VTK's XML files of PolyData (.vtp) and the surfaces of unstructured grids (.vtu): ascii,
 * base64 and appended arrays, plain or in compressed blocks.
 *
 * A first pass over the tags lists the pieces and their arrays; a second pass reads the needed arrays piece
 * by piece. Cells are read before the arrays whose length depends on them. The pieces are then joined. */
#include <string.h>

#include "core/memory.h"
#include "mesh/polydata.h"
#include "mesh/unstructured.h"
#include "volume/convert.h"
#include "volume/formats/vtk/vtk_xml.h"
#include "volume/io/numbers.h"

/* MOST_ARRAYS: the greatest number of arrays of a piece; further arrays are ignored. MOST_PIECES: the
 * greatest number of pieces; a file with more is refused. */
enum { MOST_ARRAYS = 256, MOST_PIECES = 4096 };

/* The elements of the file that hold arrays. The four kinds of cells come first. */
typedef enum section {
  SECTION_POINTS = CELL_KINDS,
  SECTION_POINT_DATA,
  SECTION_CELL_DATA,
  SECTION_GRID, /* the cells of an unstructured grid */
  SECTION_NONE
} section;
static const char *const section_names[SECTION_NONE] = {"Verts",  "Lines",     "Polys",    "Strips",
                                                        "Points", "PointData", "CellData", "Cells"};
static const char *const count_names[CELL_KINDS] = {"NumberOfVerts", "NumberOfLines", "NumberOfPolys",
                                                    "NumberOfStrips"};

typedef struct vtp_array {
  hl_vtk_array array;
  section section;
  char name[HL_VTK_NAME_BYTES];
  size_t components;
  bool active;
} vtp_array;

/* A piece of a file that has points. */
typedef struct vtp_piece {
  polydata data;
  unstructured_cells grid; /* the cells of the piece, if the file is an unstructured grid */
  size_t *sources;         /* owned; for each cell, the index of the grid's cell from which it was made; null
                            * for PolyData */
  size_t first_array, array_count;
} vtp_piece;

typedef struct vtp_file {
  hl_context *context;
  hl_vtk_xml xml;
  mesh_text text;
  section section;
  /* The names of the arrays that the current section's tag declares active. */
  char active_scalars[HL_VTK_NAME_BYTES], active_normals[HL_VTK_NAME_BYTES];
  vtp_piece *pieces; /* owned; [piece_count]; the pieces of the file */
  vtp_array *arrays; /* owned; [array_count]; the arrays of the file, one piece after the other */
  size_t piece_count, piece_room, array_count, array_room;
  bool is_grid;  /* whether the file is an unstructured grid */
  bool in_piece; /* whether the tag of a piece is open, so that arrays belong to the last piece */
} vtp_file;

/* Reads the tag of a piece. Pieces without points are ignored; programs that write in parallel produce such
 * pieces. */
static hl_status read_piece_tag(vtp_file *file, const hl_xml_tag *tag, hl_error *error) {
  vtp_piece piece = {.data = {.context = file->context, .path = file->xml.stream->path},
                     .first_array = file->array_count};
  hl_status status = hl_vtk_xml_count(&file->xml, tag, "NumberOfPoints", &piece.data.point_count, error);
  file->in_piece = piece.data.point_count > 0;
  for (int kind = 0; status == HL_OK && kind < CELL_KINDS; kind++)
    status = hl_vtk_xml_count(&file->xml, tag, count_names[kind], &piece.data.cells[kind].count, error);
  if (status == HL_OK && file->is_grid)
    status = hl_vtk_xml_count(&file->xml, tag, "NumberOfCells", &piece.grid.count, error);
  if (status != HL_OK || !file->in_piece) return status;
  if (file->piece_count == MOST_PIECES)
    return hl_fail(error, HL_ERROR_UNSUPPORTED, "%s: has more than %d pieces: save it as one",
                   piece.data.path, MOST_PIECES);
  status = hl_vtk_xml_grow(file->context, &file->xml, (void **)&file->pieces, file->piece_count,
                           &file->piece_room, sizeof piece, error);
  if (status == HL_OK) file->pieces[file->piece_count++] = piece;
  return status;
}

static hl_status read_array_tag(vtp_file *file, const hl_xml_tag *tag, hl_error *error) {
  if (file->section == SECTION_NONE || !file->in_piece) return HL_OK;
  vtp_piece *piece = &file->pieces[file->piece_count - 1];
  vtp_array made = {.section = file->section, .components = 1};
  if (piece->array_count == MOST_ARRAYS) return HL_OK;
  hl_status status = hl_vtk_xml_array_tag(&file->xml, tag, &made.array, error);
  if (status == HL_OK)
    status = hl_vtk_xml_count(&file->xml, tag, "NumberOfComponents", &made.components, error);
  if (status == HL_OK)
    status = hl_vtk_xml_grow(file->context, &file->xml, (void **)&file->arrays, file->array_count,
                             &file->array_room, sizeof made, error);
  if (status != HL_OK) return status;
  hl_vtk_xml_copy_name(made.name, hl_xml_attribute(tag, "Name"));
  made.active = made.name[0] != 0 && strcmp(made.name, file->active_scalars) == 0;
  if (made.name[0] != 0 && strcmp(made.name, file->active_normals) == 0) strcpy(made.name, "Normals");
  file->arrays[file->array_count++] = made;
  piece->array_count++;
  return HL_OK;
}

static void begin_section(vtp_file *file, const hl_xml_tag *tag) {
  for (int n = 0; n < SECTION_NONE; n++) {
    if (strcmp(tag->name, section_names[n]) != 0) continue;
    file->section = tag->is_end ? SECTION_NONE : (section)n;
    hl_vtk_xml_copy_name(file->active_scalars, hl_xml_attribute(tag, "Scalars"));
    hl_vtk_xml_copy_name(file->active_normals, hl_xml_attribute(tag, "Normals"));
  }
}

static hl_status read_tag(void *data, const hl_xml_tag *tag, hl_error *error) {
  vtp_file *file = data;
  if (!tag->is_start) {
    for (int n = 0; n < SECTION_NONE; n++)
      if (strcmp(tag->name, section_names[n]) == 0) file->section = SECTION_NONE;
    return HL_OK;
  }
  if (file->xml.header_bytes == 0 && strcmp(tag->name, "VTKFile") != 0)
    return hl_vtk_xml_refuse(&file->xml, HL_ERROR_UNSUPPORTED, "an XML file whose first element is",
                             tag->name, error);
  if (strcmp(tag->name, "VTKFile") == 0) {
    const char *type = hl_xml_attribute(tag, "type");
    file->is_grid = type != NULL && strcmp(type, "UnstructuredGrid") == 0;
    return hl_vtk_xml_file_tag(&file->xml, tag, file->is_grid ? "UnstructuredGrid" : "PolyData", error);
  }
  if (strcmp(tag->name, "Piece") == 0) return read_piece_tag(file, tag, error);
  if (strcmp(tag->name, "DataArray") == 0) return read_array_tag(file, tag, error);
  if (strcmp(tag->name, "AppendedData") == 0) return hl_vtk_xml_appended_tag(&file->xml, tag, error);
  begin_section(file, tag);
  return HL_OK;
}

/* Reads `count` numbers of an array. *numbers is owned by the caller. */
static hl_status read_numbers(vtp_file *file, const vtp_array *array, size_t count, double **numbers,
                              hl_error *error) {
  hl_number_code code = {.text = array->array.encoding == HL_VTK_ASCII, .big_endian = file->xml.big_endian};
  hl_stream *stream = NULL;
  hl_status status = hl_vtk_xml_type(&file->xml, array->array.type, &code.type, error);
  if (status != HL_OK || count == 0) return status;
  if (count > SIZE_MAX / 8)
    return hl_fail(error, HL_ERROR_INPUT, "%s: impossible number of values in an array",
                   file->xml.stream->path);
  status = hl_stream_open_memory(file->context, file->xml.stream->path, file->text.bytes, file->text.length,
                                 &stream, error);
  if (status != HL_OK) return status;
  status = hl_vtk_xml_open_array(&stream, &file->xml, &array->array, count * hl_voxel_type_bytes(code.type),
                                 error);
  hl_release(file->context, *numbers);
  *numbers = NULL;
  if (status == HL_OK) status = hl_read_numbers(stream, &code, count, numbers, error);
  hl_stream_close(stream);
  return status;
}

/* The first array with a given name in one section of a piece; null if there is none. */
static const vtp_array *find_array(const vtp_file *file, const vtp_piece *piece, section section,
                                   const char *name) {
  for (size_t n = 0; n < piece->array_count; n++) {
    const vtp_array *array = &file->arrays[piece->first_array + n];
    if (array->section == section && (name == NULL || strcmp(array->name, name) == 0)) return array;
  }
  return NULL;
}

static hl_status fail_missing(const vtp_file *file, const char *what, hl_error *error) {
  return hl_fail(error, HL_ERROR_INPUT, "%s: has no array of %s", file->xml.stream->path, what);
}

static hl_status read_points(vtp_file *file, vtp_piece *piece, hl_error *error) {
  const vtp_array *points = find_array(file, piece, SECTION_POINTS, NULL);
  if (points == NULL || points->components != 3) return fail_missing(file, "points", error);
  if (piece->data.point_count > SIZE_MAX / 24) return fail_missing(file, "so many points", error);
  return read_numbers(file, points, 3 * piece->data.point_count, &piece->data.points, error);
}

static hl_status read_cells(vtp_file *file, vtp_piece *piece, int kind, hl_error *error) {
  cells *cells = &piece->data.cells[kind];
  const vtp_array *ends = find_array(file, piece, (section)kind, "offsets"),
                  *points = find_array(file, piece, (section)kind, "connectivity");
  if (cells->count == 0) return HL_OK;
  if (ends == NULL || points == NULL) return fail_missing(file, "offsets or connectivity", error);
  hl_status status = read_numbers(file, ends, cells->count, &cells->ends, error);
  if (status != HL_OK) return status;
  double last = cells->ends[cells->count - 1];
  if (!(last >= 0 && last <= 1e15))
    return hl_fail(error, HL_ERROR_INPUT, "%s: cells end at point %.9g", piece->data.path, last);
  cells->point_count = (size_t)last;
  return read_numbers(file, points, cells->point_count, &cells->points, error);
}

/* Reads the cells of an unstructured grid, and converts them to cells of PolyData. */
static hl_status read_grid(vtp_file *file, vtp_piece *piece, hl_error *error) {
  unstructured_cells *grid = &piece->grid;
  const vtp_array *ends = find_array(file, piece, SECTION_GRID, "offsets"),
                  *points = find_array(file, piece, SECTION_GRID, "connectivity"),
                  *types = find_array(file, piece, SECTION_GRID, "types");
  if (grid->count == 0) return HL_OK;
  if (ends == NULL || points == NULL || types == NULL)
    return fail_missing(file, "offsets, connectivity or types", error);
  hl_status status = read_numbers(file, ends, grid->count, &grid->ends, error);
  if (status == HL_OK) status = read_numbers(file, types, grid->count, &grid->types, error);
  if (status != HL_OK) return status;
  double last = grid->ends[grid->count - 1];
  if (!(last >= 0 && last <= 1e15))
    return hl_fail(error, HL_ERROR_INPUT, "%s: cells end at point %.9g", piece->data.path, last);
  grid->point_count = (size_t)last;
  status = read_numbers(file, points, grid->point_count, &grid->points, error);
  return status == HL_OK ? hl_unstructured_convert(grid, &piece->data, &piece->sources, error) : status;
}

/* Gives each cell the values of the grid's cell from which it was made. */
static hl_status spread_values(const vtp_file *file, const vtp_piece *piece, cell_values *values,
                               hl_error *error) {
  size_t count = hl_polydata_tuples(&piece->data, AT_CELLS), components = values->components;
  double *spread = hl_allocate(file->context, count * components + 1, sizeof *spread);
  if (spread == NULL) return hl_fail_memory(error, count * components * sizeof *spread, piece->data.path);
  for (size_t n = 0; n < count; n++)
    memcpy(spread + n * components, values->values + piece->sources[n] * components,
           components * sizeof *spread);
  hl_release(file->context, values->values);
  values->values = spread;
  values->tuples = count;
  return HL_OK;
}

/* Reads an array of values at points or cells, if the mesh uses it. */
static hl_status read_values(vtp_file *file, vtp_piece *piece, const vtp_array *array, hl_error *error) {
  value_place place = array->section == SECTION_POINT_DATA ? AT_POINTS : AT_CELLS;
  bool of_grid = piece->sources != NULL && place == AT_CELLS;
  cell_values shape = {.components = array->components,
                       .tuples = of_grid ? piece->grid.count : hl_polydata_tuples(&piece->data, place)};
  if (!hl_vtk_xml_find_type(array->array.type, &shape.type)) return HL_OK;
  cell_values *values = hl_polydata_claim(&piece->data, array->name, &shape, place, array->active);
  if (values == NULL || shape.tuples == 0) return HL_OK;
  if (shape.components == 0 || shape.components > SIZE_MAX / 8 / shape.tuples)
    return hl_fail(error, HL_ERROR_INPUT, "%s: impossible number of values in an array", piece->data.path);
  shape.values = values->values;
  hl_status status = read_numbers(file, array, shape.tuples * shape.components, &shape.values, error);
  *values = shape;
  return status == HL_OK && of_grid ? spread_values(file, piece, values, error) : status;
}

static hl_status read_piece(vtp_file *file, vtp_piece *piece, hl_error *error) {
  hl_status status = read_points(file, piece, error);
  if (status == HL_OK && file->is_grid) status = read_grid(file, piece, error);
  for (int kind = 0; status == HL_OK && !file->is_grid && kind < CELL_KINDS; kind++)
    status = read_cells(file, piece, kind, error);
  for (size_t n = 0; status == HL_OK && n < piece->array_count; n++) {
    const vtp_array *array = &file->arrays[piece->first_array + n];
    if (array->section == SECTION_POINT_DATA || array->section == SECTION_CELL_DATA)
      status = read_values(file, piece, array, error);
  }
  return status;
}

static hl_status read_pieces(vtp_file *file, polydata *whole, hl_error *error) {
  hl_status status = HL_OK;
  for (size_t n = 0; status == HL_OK && n < file->piece_count; n++)
    status = read_piece(file, &file->pieces[n], error);
  polydata **list = hl_allocate(file->context, file->piece_count + 1, sizeof(polydata *));
  if (list == NULL) return hl_fail_memory(error, file->piece_count * sizeof(polydata *), whole->path);
  for (size_t n = 0; n < file->piece_count; n++) list[n] = &file->pieces[n].data;
  if (status == HL_OK) status = hl_polydata_join(list, file->piece_count, whole, error);
  hl_release(file->context, list);
  return status;
}

static void release(vtp_file *file) {
  hl_stream_close(file->xml.stream);
  for (size_t n = 0; n < file->piece_count; n++) {
    hl_polydata_release(&file->pieces[n].data);
    hl_unstructured_release(file->context, &file->pieces[n].grid);
    hl_release(file->context, file->pieces[n].sources);
  }
  hl_release(file->context, file->pieces);
  hl_release(file->context, file->arrays);
}

hl_status hl_mesh_read_vtp(mesh_text text, mesh_parts *parts, hl_error *error) {
  vtp_file file = {.context = parts->context, .text = text, .section = SECTION_NONE};
  polydata whole = {.context = parts->context, .path = parts->path};
  hl_status status = hl_stream_open_memory(parts->context, parts->path, text.bytes, text.length,
                                           &file.xml.stream, error);
  if (status == HL_OK) status = hl_vtk_xml_read_tags(&file.xml, read_tag, &file, error);
  if (status == HL_OK) status = read_pieces(&file, &whole, error);
  if (status == HL_OK) status = hl_vtk_xml_check_end(&file.xml, error);
  if (status == HL_OK) status = hl_polydata_to_parts(&whole, parts, error);
  hl_polydata_release(&whole);
  release(&file);
  return status;
}
