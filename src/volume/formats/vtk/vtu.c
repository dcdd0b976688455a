/* volume/formats/vtk/vtu.c - makes volumes of the cells of VTK's XML unstructured grids (.vtu) and
 * curvilinear grids (.vts).
 *
 * A first pass over the tags lists the pieces and their arrays. A second pass reads the points, the cells and
 * the chosen array piece by piece. The array is chosen by the same rules as in image data (vti.c). */
#include <halflight/grids.h>
#include <math.h>
#include <string.h>

#include "core/door.h"
#include "core/memory.h"
#include "volume/convert.h"
#include "volume/formats/format.h"
#include "volume/formats/vtk/cell_mesh.h"
#include "volume/formats/vtk/vtk_pieces.h"
#include "volume/io/numbers.h"
#include "volume/io/text.h"

static const char *const types[] = {"UnstructuredGrid", "StructuredGrid"};
enum { TYPES = sizeof types / sizeof *types };

typedef struct grid_file {
  hl_load_request *request;
  hl_vtk_pieces pieces;
  int chosen_active; /* index of the active scalars in the request's list of arrays; -1 if the file marks
                      * none */
} grid_file;

/* Lists in the request the arrays of the first piece that hold values of points or cells. */
static hl_status list_arrays(grid_file *file, hl_error *error) {
  hl_status status = HL_OK;
  const hl_vtk_pieces *pieces = &file->pieces;
  for (size_t n = 0; pieces->piece_count > 0 && n < pieces->pieces[0].array_count && status == HL_OK; n++) {
    const hl_vtk_piece_array *array = &pieces->arrays[pieces->pieces[0].first_array + n];
    size_t index = file->request->array_count;
    hl_voxel_type type = 0;
    bool of_cells = array->section == HL_VTK_CELL_DATA;
    if (array->section != HL_VTK_POINT_DATA && !of_cells) continue;
    hl_vtk_xml_find_type(array->array.type, &type);
    status = hl_arrays_add(file->request, array->name, array->components, type, of_cells, error);
    if (file->request->array_count > index) file->request->arrays[index].is_id = array->is_id;
    if (status == HL_OK && array->is_active && (file->chosen_active < 0 || !of_cells) &&
        array->components == 1)
      file->chosen_active = (int)index;
  }
  return status;
}

static hl_status read_pieces_of(grid_file *file, hl_error *error) {
  hl_status status = hl_vtk_pieces_read(&file->pieces, error);
  return status == HL_OK ? list_arrays(file, error) : status;
}

/* ---- arrays ---- */

static bool is_curvilinear(const grid_file *file) { return file->pieces.type == 1; }

static hl_status read_points(hl_stream **stream, grid_file *file, const hl_vtk_piece *piece,
                             hl_cell_mesh *mesh, hl_error *error) {
  const hl_vtk_piece_array *points = hl_vtk_pieces_find(&file->pieces, piece, HL_VTK_POINTS, NULL);
  double *numbers = NULL;
  if (points == NULL || points->components != 3)
    return hl_vtk_pieces_fail_missing(&file->pieces, "points", error);
  hl_status status = hl_vtk_pieces_numbers(stream, &file->pieces, points, piece->point_count, &numbers,
                                           error);
  if (status == HL_OK) status = hl_cell_mesh_begin_piece(mesh, numbers, piece->point_count, error);
  hl_release(file->request->context, numbers);
  return status;
}

static hl_status read_cells(hl_stream **stream, grid_file *file, const hl_vtk_piece *piece,
                            hl_cell_mesh *mesh, hl_error *error) {
  const hl_vtk_piece_array *of_ends = hl_vtk_pieces_find(&file->pieces, piece, HL_VTK_CELLS, "offsets"),
                           *of_corners = hl_vtk_pieces_find(&file->pieces, piece, HL_VTK_CELLS,
                                                            "connectivity"),
                           *of_types = hl_vtk_pieces_find(&file->pieces, piece, HL_VTK_CELLS, "types");
  double *ends = NULL, *corners = NULL, *types = NULL, last = 0;
  if (is_curvilinear(file)) return hl_cell_mesh_add_grid(mesh, piece->size, error);
  if (piece->cell_count == 0) return HL_OK;
  if (of_ends == NULL || of_corners == NULL || of_types == NULL)
    return hl_vtk_pieces_fail_missing(&file->pieces, "offsets, connectivity or types", error);
  hl_status status = hl_vtk_pieces_numbers(stream, &file->pieces, of_ends, piece->cell_count, &ends, error);
  if (status == HL_OK)
    status = hl_vtk_pieces_numbers(stream, &file->pieces, of_types, piece->cell_count, &types, error);
  if (status == HL_OK) {
    last = ends[piece->cell_count - 1];
    if (!(last >= 0 && last <= 1e15))
      status = hl_fail(error, HL_ERROR_INPUT, "%s: cells end at point %.9g", (*stream)->path, last);
  }
  if (status == HL_OK)
    status = hl_vtk_pieces_numbers(stream, &file->pieces, of_corners, (size_t)last, &corners, error);
  if (status == HL_OK)
    status = hl_cell_mesh_add_cells(mesh, types, ends, piece->cell_count, corners, (size_t)last, error);
  hl_release(file->request->context, ends);
  hl_release(file->request->context, corners);
  hl_release(file->request->context, types);
  return status;
}

static hl_status read_values(hl_stream **stream, grid_file *file, const hl_vtk_piece *piece,
                             hl_cell_mesh *mesh, hl_error *error) {
  const hl_array_entry *chosen = &file->request->arrays[file->request->chosen];
  const hl_vtk_piece_array *array = hl_vtk_pieces_find(
      &file->pieces, piece, chosen->of_cells ? HL_VTK_CELL_DATA : HL_VTK_POINT_DATA, chosen->name);
  size_t tuples = chosen->of_cells ? piece->cell_count : piece->point_count;
  double *values = NULL;
  if (array == NULL || array->components != chosen->components)
    return hl_fail(error, HL_ERROR_INPUT, "%s: a piece has no array \"%.60s\" of %zu components",
                   (*stream)->path, chosen->name, chosen->components);
  hl_status status = hl_vtk_pieces_numbers(stream, &file->pieces, array, tuples, &values, error);
  if (status == HL_OK)
    status = hl_cell_mesh_set_values(mesh, values, tuples, array->components, file->request->chosen_component,
                                     chosen->of_cells, error);
  hl_release(file->request->context, values);
  return status;
}

/* ---- all steps together ---- */

static hl_status choose(grid_file *file, hl_error *error) {
  hl_load_request *request = file->request;
  const char *path = file->pieces.xml.stream->path;
  if (file->pieces.piece_count == 0)
    return hl_fail(error, HL_ERROR_INPUT, "%s: the grid has no points", path);
  return hl_cell_mesh_choose(request, path, file->chosen_active, error);
}

static hl_status read_pieces(hl_stream **stream, grid_file *file, hl_cell_mesh *mesh, hl_error *error) {
  hl_status status = HL_OK;
  for (size_t n = 0; n < file->pieces.piece_count && status == HL_OK; n++) {
    const hl_vtk_piece *piece = &file->pieces.pieces[n];
    status = read_points(stream, file, piece, mesh, error);
    if (status == HL_OK) status = read_cells(stream, file, piece, mesh, error);
    if (status == HL_OK) status = read_values(stream, file, piece, mesh, error);
  }
  return status;
}

static hl_status load(hl_stream **stream, hl_load_request *request, hl_volume **volume, hl_error *error) {
  grid_file file = {.request = request,
                    .pieces = {.context = request->context, .types = types, .type_count = TYPES},
                    .chosen_active = -1};
  hl_cell_mesh mesh = {.context = request->context};
  char *path = hl_copy_text(request->context, (*stream)->path); /* reading an array opens the stream anew */
  file.pieces.xml.stream = *stream;
  hl_status status = path != NULL ? read_pieces_of(&file, error) : hl_fail_memory(error, 1, "a path");
  mesh.subject = path;
  if (status == HL_OK) status = choose(&file, error);
  if (status == HL_OK) status = read_pieces(stream, &file, &mesh, error);
  if (status == HL_OK) status = hl_cell_mesh_finish(&mesh, volume, error);
  hl_cell_mesh_release(&mesh);
  hl_vtk_pieces_release(&file.pieces);
  hl_release(request->context, path);
  return status;
}

/* ---- which grids are volumes ---- */

/* Finds whether any cell of a piece encloses a volume. */
static hl_status find_cell(hl_stream **stream, grid_file *file, const hl_vtk_piece *piece, bool *found,
                           hl_error *error) {
  const hl_vtk_piece_array *of_types = hl_vtk_pieces_find(&file->pieces, piece, HL_VTK_CELLS, "types");
  double *types = NULL;
  *found = false;
  if (of_types == NULL) return HL_OK;
  hl_status status = hl_vtk_pieces_numbers(stream, &file->pieces, of_types, piece->cell_count, &types, error);
  for (size_t n = 0; status == HL_OK && n < piece->cell_count && !*found; n++)
    *found = hl_cell_kind_is_read(types[n]);
  hl_release(file->request->context, types);
  return status;
}

int hl_volume_reads_cells(hl_context *context, const char *path) {
  HL_DOOR;
  hl_load_request request = {.context = context, .selection = {1, 1, 1, 0, 0, 0, 0}};
  grid_file file = {.request = &request,
                    .pieces = {.context = context, .types = types, .type_count = TYPES},
                    .chosen_active = -1};
  hl_error unused;
  bool found = false;
  if (context == NULL || path == NULL || !hl_text_ends(path, ".vtu")) return 0;
  hl_status status = hl_stream_open(context, path, true, &file.pieces.xml.stream, &unused);
  if (status == HL_OK) status = hl_stream_unpack(&file.pieces.xml.stream, &unused);
  if (status == HL_OK) status = read_pieces_of(&file, &unused);
  hl_stream *stream = file.pieces.xml.stream;
  for (size_t n = 0; status == HL_OK && n < file.pieces.piece_count && !found && request.array_count > 0; n++)
    status = find_cell(&stream, &file, &file.pieces.pieces[n], &found, &unused);
  hl_stream_close(stream);
  hl_arrays_release(context, request.arrays, request.array_count);
  hl_vtk_pieces_release(&file.pieces);
  return found;
}

/* Returns whether the first tag says that the file is an unstructured or a curvilinear grid. */
static bool has_content(const unsigned char *bytes, size_t length) {
  return hl_vtk_xml_is_of(bytes, length, types, TYPES);
}

const hl_format hl_format_vtu = {
    .name = "VTK .vtu",
    .endings = {".vtu", ".vts"},
    .beginning = "\"<VTKFile\" of type \"UnstructuredGrid\" or \"StructuredGrid\"",
    .has_content = has_content,
    .load = load,
};
