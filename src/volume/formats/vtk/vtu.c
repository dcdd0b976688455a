/* volume/formats/vtk/vtu.c - the cells of VTK's XML unstructured grids (.vtu) and curvilinear grids (.vts),
 * as volumes.
 *
 * A first pass over the tags lists the pieces and their arrays. A second pass reads the points, the cells and
 * the chosen array piece by piece. Arrays are chosen as in image data (vti.c). */
#include <halflight/grids.h>
#include <math.h>
#include <string.h>

#include "core/door.h"
#include "core/memory.h"
#include "volume/convert.h"
#include "volume/formats/format.h"
#include "volume/formats/vtk/cell_mesh.h"
#include "volume/formats/vtk/vtk_xml.h"
#include "volume/io/numbers.h"
#include "volume/io/text.h"

/* Further arrays of a piece are ignored. A file with more than MOST_PIECES pieces is refused. */
enum { MOST_ARRAYS = 1024, MOST_PIECES = 4096 };

typedef enum section {
  SECTION_POINTS,
  SECTION_CELLS,
  SECTION_POINT_DATA,
  SECTION_CELL_DATA,
  SECTION_NONE
} section;
static const char *const section_names[SECTION_NONE] = {"Points", "Cells", "PointData", "CellData"};

typedef struct grid_array {
  hl_vtk_array array;
  section section;
  char name[HL_VTK_NAME_BYTES];
  size_t components;
} grid_array;

typedef struct grid_piece {
  size_t point_count, cell_count;
  size_t size[3]; /* points along each axis of a curvilinear grid */
  size_t first_array, array_count;
} grid_piece;

typedef struct grid_file {
  hl_load_request *request;
  hl_vtk_xml xml;
  section section;
  char active[HL_VTK_NAME_BYTES]; /* the section's active scalars */
  int chosen_active;              /* index of the active scalars among the request's arrays; -1 if none */
  grid_piece *pieces;             /* owned; [piece_count]; those with points */
  grid_array *arrays;             /* owned; [array_count]; piece after piece */
  size_t piece_count, piece_room, array_count, array_room;
  bool is_curvilinear, in_piece;
} grid_file;

/* ---- tags ---- */

/* Reads a curvilinear piece's extent "x0 x1 y0 y1 z0 z1" of points. */
static hl_status read_extent(const grid_file *file, const hl_xml_tag *tag, grid_piece *piece,
                             hl_error *error) {
  const char *value = hl_xml_attribute(tag, "Extent");
  double extent[6];
  size_t points = 1;
  bool sound = value != NULL && hl_text_numbers(value, extent, 6) == 6;
  for (int axis = 0; axis < 3 && sound; axis++) {
    double size = extent[2 * axis + 1] - extent[2 * axis] + 1;
    sound = size >= 0 && size <= 1 << 30 && size == floor(size);
    piece->size[axis] = sound ? (size_t)size : 0;
    sound = sound && hl_multiply(points, piece->size[axis], &points);
  }
  if (!sound)
    return hl_vtk_xml_refuse(&file->xml, HL_ERROR_INPUT, "a Piece's Extent", value != NULL ? value : "",
                             error);
  piece->point_count = points;
  piece->cell_count = 1;
  for (int axis = 0; axis < 3; axis++) piece->cell_count *= piece->size[axis] > 1 ? piece->size[axis] - 1 : 1;
  return HL_OK;
}

/* Pieces without points are ignored: programs that write in parallel leave them. */
static hl_status read_piece_tag(grid_file *file, const hl_xml_tag *tag, hl_error *error) {
  grid_piece piece = {.first_array = file->array_count};
  hl_status status = file->is_curvilinear
                         ? read_extent(file, tag, &piece, error)
                         : hl_vtk_xml_count(&file->xml, tag, "NumberOfPoints", &piece.point_count, error);
  if (status == HL_OK && !file->is_curvilinear)
    status = hl_vtk_xml_count(&file->xml, tag, "NumberOfCells", &piece.cell_count, error);
  file->in_piece = piece.point_count > 0;
  if (status != HL_OK || !file->in_piece) return status;
  if (file->piece_count == MOST_PIECES)
    return hl_fail(error, HL_ERROR_UNSUPPORTED, "%s: has more than %d pieces: save it as one",
                   file->xml.stream->path, MOST_PIECES);
  status = hl_vtk_xml_grow(file->request->context, &file->xml, (void **)&file->pieces, file->piece_count,
                           &file->piece_room, sizeof piece, error);
  if (status == HL_OK) file->pieces[file->piece_count++] = piece;
  return status;
}

/* Lists an array of values of the first piece in the request. */
static hl_status list_array(grid_file *file, const grid_array *array, hl_error *error) {
  size_t index = file->request->array_count;
  hl_voxel_type type = 0;
  bool of_cells = array->section == SECTION_CELL_DATA;
  if (array->section != SECTION_POINT_DATA && !of_cells) return HL_OK;
  hl_vtk_xml_find_type(array->array.type, &type);
  hl_status status = hl_arrays_add(file->request, array->name, array->components, type, of_cells, error);
  bool is_active = file->active[0] != 0 && strcmp(array->name, file->active) == 0;
  if (status == HL_OK && is_active && (file->chosen_active < 0 || !of_cells) && array->components == 1)
    file->chosen_active = (int)index;
  return status;
}

static hl_status read_array_tag(grid_file *file, const hl_xml_tag *tag, hl_error *error) {
  if (file->section == SECTION_NONE || !file->in_piece) return HL_OK;
  grid_piece *piece = &file->pieces[file->piece_count - 1];
  grid_array made = {.section = file->section, .components = 1};
  if (piece->array_count == MOST_ARRAYS) return HL_OK;
  hl_status status = hl_vtk_xml_array_tag(&file->xml, tag, &made.array, error);
  if (status == HL_OK)
    status = hl_vtk_xml_count(&file->xml, tag, "NumberOfComponents", &made.components, error);
  if (status == HL_OK && made.components == 0)
    return hl_vtk_xml_refuse(&file->xml, HL_ERROR_INPUT, "NumberOfComponents", "0", error);
  if (status == HL_OK)
    status = hl_vtk_xml_grow(file->request->context, &file->xml, (void **)&file->arrays, file->array_count,
                             &file->array_room, sizeof made, error);
  if (status != HL_OK) return status;
  hl_vtk_xml_copy_name(made.name, hl_xml_attribute(tag, "Name"));
  file->arrays[file->array_count++] = made;
  piece->array_count++;
  return file->piece_count == 1 ? list_array(file, &made, error) : HL_OK;
}

static hl_status read_file_tag(grid_file *file, const hl_xml_tag *tag, hl_error *error) {
  const char *type = hl_xml_attribute(tag, "type");
  file->is_curvilinear = type != NULL && strcmp(type, "StructuredGrid") == 0;
  return hl_vtk_xml_file_tag(&file->xml, tag, file->is_curvilinear ? "StructuredGrid" : "UnstructuredGrid",
                             error);
}

static hl_status read_tag(void *data, const hl_xml_tag *tag, hl_error *error) {
  grid_file *file = data;
  for (int n = 0; n < SECTION_NONE; n++)
    if (strcmp(tag->name, section_names[n]) == 0) {
      file->section = tag->is_start && !tag->is_end ? (section)n : SECTION_NONE;
      hl_vtk_xml_copy_name(file->active, hl_xml_attribute(tag, "Scalars"));
      return HL_OK;
    }
  if (!tag->is_start) return HL_OK;
  if (file->xml.header_bytes == 0 && strcmp(tag->name, "VTKFile") != 0)
    return hl_vtk_xml_refuse(&file->xml, HL_ERROR_UNSUPPORTED, "an XML file whose first element is",
                             tag->name, error);
  if (strcmp(tag->name, "VTKFile") == 0) return read_file_tag(file, tag, error);
  if (strcmp(tag->name, "Piece") == 0) return read_piece_tag(file, tag, error);
  if (strcmp(tag->name, "DataArray") == 0) return read_array_tag(file, tag, error);
  if (strcmp(tag->name, "AppendedData") == 0) return hl_vtk_xml_appended_tag(&file->xml, tag, error);
  return HL_OK;
}

/* ---- arrays ---- */

/* The first array with this name in a piece's section; null if there is none. name: null for any. */
static const grid_array *find_array(const grid_file *file, const grid_piece *piece, section which,
                                    const char *name) {
  for (size_t n = 0; n < piece->array_count; n++) {
    const grid_array *array = &file->arrays[piece->first_array + n];
    if (array->section == which && (name == NULL || strcmp(array->name, name) == 0)) return array;
  }
  return NULL;
}

/* Reads `tuples` tuples of an array; *numbers is owned by the caller. */
static hl_status read_numbers(hl_stream **stream, grid_file *file, const grid_array *array, size_t tuples,
                              double **numbers, hl_error *error) {
  hl_number_code code = {.text = array->array.encoding == HL_VTK_ASCII, .big_endian = file->xml.big_endian};
  size_t count, bytes;
  file->xml.stream = *stream;
  hl_status status = hl_vtk_xml_type(&file->xml, array->array.type, &code.type, error);
  if (status != HL_OK) return status;
  if (!hl_multiply(tuples, array->components, &count) || !hl_multiply(count, 8, &bytes))
    return hl_fail(error, HL_ERROR_INPUT, "%s: impossible number of values in an array", (*stream)->path);
  status = hl_vtk_xml_open_array(stream, &file->xml, &array->array, count * hl_voxel_type_bytes(code.type),
                                 error);
  file->xml.stream = *stream;
  return status == HL_OK ? hl_read_numbers(*stream, &code, count, numbers, error) : status;
}

static hl_status fail_missing(const grid_file *file, const char *what, hl_error *error) {
  return hl_fail(error, HL_ERROR_INPUT, "%s: a piece has no array of %s", file->xml.stream->path, what);
}

static hl_status read_points(hl_stream **stream, grid_file *file, const grid_piece *piece, hl_cell_mesh *mesh,
                             hl_error *error) {
  const grid_array *points = find_array(file, piece, SECTION_POINTS, NULL);
  double *numbers = NULL;
  if (points == NULL || points->components != 3) return fail_missing(file, "points", error);
  hl_status status = read_numbers(stream, file, points, piece->point_count, &numbers, error);
  if (status == HL_OK) status = hl_cell_mesh_begin_piece(mesh, numbers, piece->point_count, error);
  hl_release(file->request->context, numbers);
  return status;
}

static hl_status read_cells(hl_stream **stream, grid_file *file, const grid_piece *piece, hl_cell_mesh *mesh,
                            hl_error *error) {
  const grid_array *of_ends = find_array(file, piece, SECTION_CELLS, "offsets"),
                   *of_corners = find_array(file, piece, SECTION_CELLS, "connectivity"),
                   *of_types = find_array(file, piece, SECTION_CELLS, "types");
  double *ends = NULL, *corners = NULL, *types = NULL, last = 0;
  if (file->is_curvilinear) return hl_cell_mesh_add_grid(mesh, piece->size, error);
  if (piece->cell_count == 0) return HL_OK;
  if (of_ends == NULL || of_corners == NULL || of_types == NULL)
    return fail_missing(file, "offsets, connectivity or types", error);
  hl_status status = read_numbers(stream, file, of_ends, piece->cell_count, &ends, error);
  if (status == HL_OK) status = read_numbers(stream, file, of_types, piece->cell_count, &types, error);
  if (status == HL_OK) {
    last = ends[piece->cell_count - 1];
    if (!(last >= 0 && last <= 1e15))
      status = hl_fail(error, HL_ERROR_INPUT, "%s: cells end at point %.9g", (*stream)->path, last);
  }
  if (status == HL_OK) status = read_numbers(stream, file, of_corners, (size_t)last, &corners, error);
  if (status == HL_OK)
    status = hl_cell_mesh_add_cells(mesh, types, ends, piece->cell_count, corners, (size_t)last, error);
  hl_release(file->request->context, ends);
  hl_release(file->request->context, corners);
  hl_release(file->request->context, types);
  return status;
}

static hl_status read_values(hl_stream **stream, grid_file *file, const grid_piece *piece, hl_cell_mesh *mesh,
                             hl_error *error) {
  const hl_array_entry *chosen = &file->request->arrays[file->request->chosen];
  const grid_array *array = find_array(file, piece, chosen->of_cells ? SECTION_CELL_DATA : SECTION_POINT_DATA,
                                       chosen->name);
  size_t tuples = chosen->of_cells ? piece->cell_count : piece->point_count;
  double *values = NULL;
  if (array == NULL || array->components != chosen->components)
    return hl_fail(error, HL_ERROR_INPUT, "%s: a piece has no array \"%.60s\" of %zu components",
                   (*stream)->path, chosen->name, chosen->components);
  hl_status status = read_numbers(stream, file, array, tuples, &values, error);
  if (status == HL_OK)
    status = hl_cell_mesh_set_values(mesh, values, tuples, array->components, file->request->chosen_component,
                                     chosen->of_cells, error);
  hl_release(file->request->context, values);
  return status;
}

/* ---- the whole ---- */

static hl_status choose(grid_file *file, hl_error *error) {
  hl_load_request *request = file->request;
  const char *path = file->xml.stream->path;
  if (file->piece_count == 0) return hl_fail(error, HL_ERROR_INPUT, "%s: the grid has no points", path);
  return hl_cell_mesh_choose(request, path, file->chosen_active, error);
}

static hl_status read_pieces(hl_stream **stream, grid_file *file, hl_cell_mesh *mesh, hl_error *error) {
  hl_status status = HL_OK;
  for (size_t n = 0; n < file->piece_count && status == HL_OK; n++) {
    const grid_piece *piece = &file->pieces[n];
    status = read_points(stream, file, piece, mesh, error);
    if (status == HL_OK) status = read_cells(stream, file, piece, mesh, error);
    if (status == HL_OK) status = read_values(stream, file, piece, mesh, error);
  }
  return status;
}

static hl_status load(hl_stream **stream, hl_load_request *request, hl_volume **volume, hl_error *error) {
  grid_file file = {.request = request, .xml.stream = *stream, .section = SECTION_NONE, .chosen_active = -1};
  hl_cell_mesh mesh = {.context = request->context};
  char *path = hl_copy_text(request->context, (*stream)->path); /* arrays open the stream anew */
  hl_status status = path != NULL ? hl_vtk_xml_read_tags(&file.xml, read_tag, &file, error)
                                  : hl_fail_memory(error, 1, "a path");
  mesh.subject = path;
  if (status == HL_OK) status = choose(&file, error);
  if (status == HL_OK) status = read_pieces(stream, &file, &mesh, error);
  if (status == HL_OK) status = hl_cell_mesh_finish(&mesh, volume, error);
  hl_cell_mesh_release(&mesh);
  hl_release(request->context, file.pieces);
  hl_release(request->context, file.arrays);
  hl_release(request->context, path);
  return status;
}

/* ---- which grids are volumes ---- */

/* Whether a piece has a cell with a volume. */
static hl_status find_cell(hl_stream **stream, grid_file *file, const grid_piece *piece, bool *found,
                           hl_error *error) {
  const grid_array *of_types = find_array(file, piece, SECTION_CELLS, "types");
  double *types = NULL;
  *found = false;
  if (of_types == NULL) return HL_OK;
  hl_status status = read_numbers(stream, file, of_types, piece->cell_count, &types, error);
  for (size_t n = 0; status == HL_OK && n < piece->cell_count && !*found; n++)
    *found = hl_cell_kind_is_read(types[n]);
  hl_release(file->request->context, types);
  return status;
}

int hl_volume_reads_cells(hl_context *context, const char *path) {
  HL_DOOR;
  hl_load_request request = {.context = context, .selection = {1, 1, 1, 0, 0, 0}};
  grid_file file = {.request = &request, .section = SECTION_NONE, .chosen_active = -1};
  hl_error unused;
  bool found = false;
  if (context == NULL || path == NULL || !hl_text_ends(path, ".vtu")) return 0;
  hl_status status = hl_stream_open(context, path, true, &file.xml.stream, &unused);
  if (status == HL_OK) status = hl_stream_unpack(&file.xml.stream, &unused);
  if (status == HL_OK) status = hl_vtk_xml_read_tags(&file.xml, read_tag, &file, &unused);
  hl_stream *stream = file.xml.stream;
  for (size_t n = 0; status == HL_OK && n < file.piece_count && !found && request.array_count > 0; n++)
    status = find_cell(&stream, &file, &file.pieces[n], &found, &unused);
  hl_stream_close(stream);
  hl_arrays_release(context, request.arrays, request.array_count);
  hl_release(context, file.pieces);
  hl_release(context, file.arrays);
  return found;
}

/* Whether the first tag says that the file is such a grid. */
static bool has_content(const unsigned char *bytes, size_t length) {
  static const char *const types[] = {"UnstructuredGrid", "StructuredGrid"};
  return hl_vtk_xml_is_of(bytes, length, types, 2);
}

const hl_format hl_format_vtu = {
    .name = "VTK .vtu",
    .endings = {".vtu", ".vts"},
    .beginning = "\"<VTKFile\" of type \"UnstructuredGrid\" or \"StructuredGrid\"",
    .has_content = has_content,
    .load = load,
};
