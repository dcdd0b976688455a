/* volume/formats/vtk/legacy_cells.c - reads legacy .vtk files with UNSTRUCTURED_GRID or STRUCTURED_GRID.
 *
 * A first pass reads the geometry and lists the arrays under POINT_DATA and CELL_DATA. A second pass goes to
 * the values of the chosen array. Before version 5.1 of the format, the cells are one list of counts and
 * points. Since version 5.1 the cells are two lists, OFFSETS and CONNECTIVITY. Source: VTK's file formats,
 * "Legacy File Formats", and vtkDataWriter. */
#include "volume/formats/vtk/legacy_cells.h"

#include <string.h>

#include "core/memory.h"
#include "volume/formats/vtk/cell_mesh.h"
#include "volume/formats/vtk/legacy_arrays.h"
#include "volume/io/decoders.h"
#include "volume/io/numbers.h"
#include "volume/io/text.h"

/* A list of numbers that was read from the file. */
typedef struct number_list {
  double *numbers; /* owned; [count] */
  size_t count;
} number_list;

typedef struct cells_file {
  hl_legacy_vtk file; /* must be the first member, because callbacks convert the address of this member to the
                       * address of the whole struct */
  hl_load_request *request;
  bool is_curvilinear;
  size_t size[3]; /* number of points of a curvilinear grid along i, j, k */
  number_list points, types;
  number_list list;             /* the cells of a file before version 5.1: count, points, count, points,
                                 * ... */
  number_list offsets, corners; /* the cells of a file of version 5.1 or newer; the first offset is 0 */
  size_t offset_count, room;    /* numbers of offsets and of corners, as the line CELLS of a newer file states
                                 * them */
  bool lists;                   /* whether this is the first pass, in which arrays are listed */
  size_t arrays;                /* number of arrays met so far in this pass that can hold the volume */
  hl_legacy_array chosen;       /* the chosen array, in the second pass; the texts `kind` and `name` in it are
                                 * not valid */
} cells_file;

bool hl_legacy_is_of_cells(const char *kind) {
  return hl_text_is_one_of(kind, "UNSTRUCTURED_GRID|STRUCTURED_GRID");
}

/* ---- geometry ---- */

/* Reads a list of numbers. A list that an earlier pass has read is replaced. */
static hl_status read_list(cells_file *cells, const char *type_name, size_t count, number_list *list,
                           hl_error *error) {
  hl_number_code code = {.text = cells->file.text, .big_endian = true};
  hl_release(cells->request->context, list->numbers);
  *list = (number_list){.numbers = NULL};
  hl_status status = hl_legacy_vtk_type(&cells->file, type_name, &code.type, error);
  if (status == HL_OK) status = hl_read_numbers(cells->file.stream, &code, count, &list->numbers, error);
  if (status == HL_OK) list->count = count;
  return status;
}

/* Reads "POINTS number type" and the coordinates. */
static hl_status read_points(cells_file *cells, const char *arguments, hl_error *error) {
  char number[HL_LEGACY_WORD_BYTES], type[HL_LEGACY_WORD_BYTES];
  const char *cursor = arguments;
  size_t count;
  if (!hl_text_word(&cursor, number, sizeof number) || !hl_text_word(&cursor, type, sizeof type) ||
      hl_text_sizes(number, &count, 1) != 1 || count > UINT32_MAX)
    return hl_legacy_vtk_fail(&cells->file, "expected \"POINTS number type\", not", arguments, error);
  return read_list(cells, type, 3 * count, &cells->points, error);
}

/* Reads "CELLS number size" and, if no OFFSETS follow, the list of cells. */
static hl_status read_cells(cells_file *cells, const char *arguments, hl_error *error) {
  const unsigned char *bytes;
  size_t available, counts[2];
  if (hl_text_sizes(arguments, counts, 2) != 2 || counts[1] > SIZE_MAX / 8)
    return hl_legacy_vtk_fail(&cells->file, "expected \"CELLS number size\", not", arguments, error);
  hl_status status = hl_stream_peek(cells->file.stream, 7, &bytes, &available, error);
  if (status != HL_OK) return status;
  cells->offset_count = counts[0];
  cells->room = counts[1];
  if (available >= 7 && hl_text_starts((const char *)bytes, "OFFSETS")) return HL_OK;
  return read_list(cells, "int", counts[1], &cells->list, error);
}

static hl_status read_types(cells_file *cells, const char *arguments, hl_error *error) {
  size_t count;
  if (hl_text_sizes(arguments, &count, 1) != 1 || count > SIZE_MAX / 8)
    return hl_legacy_vtk_fail(&cells->file, "expected \"CELL_TYPES number\", not", arguments, error);
  return read_list(cells, "int", count, &cells->types, error);
}

static hl_status read_dimensions(cells_file *cells, const char *arguments, hl_error *error) {
  return hl_text_sizes(arguments, cells->size, 3) == 3
             ? HL_OK
             : hl_legacy_vtk_fail(&cells->file, "expected three numbers, not", arguments, error);
}

static hl_status read_keyword(hl_legacy_vtk *file, const char *keyword, const char *arguments,
                              hl_error *error) {
  cells_file *cells = (cells_file *)file;
  char shown[HL_PRINTABLE_BYTES];
  if (hl_text_equal(keyword, "DATASET")) {
    cells->is_curvilinear = hl_text_equal(arguments, "STRUCTURED_GRID");
    return HL_OK;
  }
  if (hl_text_equal(keyword, "DIMENSIONS")) return read_dimensions(cells, arguments, error);
  if (hl_text_equal(keyword, "POINTS")) return read_points(cells, arguments, error);
  if (hl_text_equal(keyword, "CELLS")) return read_cells(cells, arguments, error);
  if (hl_text_equal(keyword, "CELL_TYPES")) return read_types(cells, arguments, error);
  if (hl_text_equal(keyword, "OFFSETS"))
    return read_list(cells, arguments, cells->offset_count, &cells->offsets, error);
  if (hl_text_equal(keyword, "CONNECTIVITY"))
    return read_list(cells, arguments, cells->room, &cells->corners, error);
  return HL_FAIL_LINE(error, HL_ERROR_UNSUPPORTED, file->stream, file->line,
                      "\"%s\" is not read: save the values as SCALARS or in a FIELD, before other data",
                      hl_text_printable(shown, keyword));
}

/* ---- arrays ---- */

/* The `meet` function, called for each array. Arrays before POINT_DATA and CELL_DATA, and arrays of colours,
 * cannot become the volume. */
static hl_status meet_array(hl_legacy_vtk *file, const hl_legacy_array *array, hl_error *error) {
  cells_file *cells = (cells_file *)file;
  const bool usable = !array->of_neither && !array->is_fraction;
  const size_t index = cells->arrays;
  hl_status status = HL_OK;
  if (usable) cells->arrays++;
  if (usable && cells->lists)
    status = hl_arrays_add(cells->request, array->name, array->components, array->type, !array->of_points,
                           error);
  if (status != HL_OK) return status;
  if (!usable || cells->lists || index != cells->request->chosen)
    return hl_legacy_vtk_skip_array(file, array, error);
  cells->chosen = *array;
  file->found = true;
  return HL_OK;
}

/* ---- the mesh ---- */

/* Converts an older file's list of counts and points to lists of the cells' ends and corners. */
static hl_status split_list(cells_file *cells, hl_error *error) {
  const number_list *list = &cells->list;
  hl_context *context = cells->request->context;
  if (cells->offset_count > list->count)
    return hl_fail(error, HL_ERROR_INPUT, "%s: CELLS has %zu cells in a list of %zu numbers",
                   cells->file.stream->path, cells->offset_count, list->count);
  hl_release(context, cells->offsets.numbers);
  hl_release(context, cells->corners.numbers);
  double *ends = hl_allocate(context, cells->offset_count + 1, sizeof *ends);
  double *corners = hl_allocate(context, list->count + 1, sizeof *corners);
  size_t at = 0, used = 0, n = 0;
  if (ends != NULL && corners != NULL) {
    ends[0] = 0;
    for (; n < cells->offset_count && at < list->count; n++) {
      const double count = list->numbers[at++];
      if (!(count >= 0 && count <= (double)(list->count - at))) break;
      memcpy(corners + used, list->numbers + at, (size_t)count * sizeof *corners);
      at += (size_t)count;
      used += (size_t)count;
      ends[n + 1] = (double)used;
    }
  }
  cells->offsets = (number_list){ends, cells->offset_count + 1};
  cells->corners = (number_list){corners, used};
  if (ends == NULL || corners == NULL)
    return hl_fail_memory(error, (cells->offset_count + list->count) * sizeof *ends, "a list of cells");
  return n == cells->offset_count
             ? HL_OK
             : hl_fail(error, HL_ERROR_INPUT, "%s: cell %zu of CELLS has more points than the list holds",
                       cells->file.stream->path, n);
}

static hl_status add_unstructured(cells_file *cells, hl_cell_mesh *mesh, hl_error *error) {
  hl_status status = cells->list.numbers != NULL ? split_list(cells, error) : HL_OK;
  if (status != HL_OK) return status;
  if (cells->offsets.count != cells->types.count + 1)
    return hl_fail(error, HL_ERROR_INPUT, "%s: CELL_TYPES has %zu types, and CELLS %zu cells", mesh->subject,
                   cells->types.count, cells->offsets.count > 0 ? cells->offsets.count - 1 : 0);
  return hl_cell_mesh_add_cells(mesh, cells->types.numbers, cells->offsets.numbers + 1, cells->types.count,
                                cells->corners.numbers, cells->corners.count, error);
}

static hl_status add_curvilinear(cells_file *cells, hl_cell_mesh *mesh, hl_error *error) {
  const size_t *n = cells->size;
  if ((double)n[0] * (double)n[1] * (double)n[2] != (double)mesh->point_count)
    return hl_fail(error, HL_ERROR_INPUT, "%s: DIMENSIONS %zu x %zu x %zu, and POINTS has %zu", mesh->subject,
                   n[0], n[1], n[2], mesh->point_count);
  return hl_cell_mesh_add_grid(mesh, n, error);
}

static hl_status set_values(cells_file *cells, hl_cell_mesh *mesh, hl_error *error) {
  const hl_legacy_array *array = &cells->chosen;
  const hl_number_code code = {array->type, cells->file.text, true};
  const size_t cell_count = cells->is_curvilinear ? mesh->cell_count : cells->types.count;
  const size_t wanted = array->of_points ? mesh->point_count : cell_count;
  double *values = NULL;
  if (array->tuples != wanted)
    return hl_fail(error, HL_ERROR_INPUT, "%s: %s has %zu values, and there are %zu", mesh->subject,
                   array->of_points ? "POINT_DATA" : "CELL_DATA", array->tuples, wanted);
  hl_status status = hl_read_numbers(cells->file.stream, &code, array->tuples * array->components, &values,
                                     error);
  if (status == HL_OK)
    status = hl_cell_mesh_set_values(mesh, values, array->tuples, array->components,
                                     cells->request->chosen_component, !array->of_points, error);
  hl_release(cells->request->context, values);
  return status;
}

static hl_status make_volume(cells_file *cells, hl_volume **volume, hl_error *error) {
  hl_cell_mesh mesh = {.context = cells->request->context, .subject = cells->file.stream->path};
  hl_status status = cells->points.count == 0
                         ? hl_fail(error, HL_ERROR_INPUT, "%s: the grid has no POINTS", mesh.subject)
                         : hl_cell_mesh_begin_piece(&mesh, cells->points.numbers, cells->points.count / 3,
                                                    error);
  if (status == HL_OK)
    status = cells->is_curvilinear ? add_curvilinear(cells, &mesh, error)
                                   : add_unstructured(cells, &mesh, error);
  if (status == HL_OK) status = set_values(cells, &mesh, error);
  if (status == HL_OK) status = hl_cell_mesh_finish(&mesh, volume, error);
  hl_cell_mesh_release(&mesh);
  return status;
}

/* ---- all steps together ---- */

/* Reads the file from its start. lists: whether this is the first pass, which lists the arrays. */
static hl_status read_pass(hl_stream **stream, cells_file *cells, bool lists, hl_error *error) {
  hl_status status = hl_stream_restart(stream, error);
  if (status == HL_OK) status = hl_stream_unpack(stream, error);
  cells->file = (hl_legacy_vtk){.stream = *stream, .meet = meet_array, .keyword = read_keyword};
  cells->lists = lists;
  cells->arrays = 0;
  return status == HL_OK ? hl_legacy_vtk_read(&cells->file, error) : status;
}

hl_status hl_legacy_cells_load(hl_stream **stream, hl_load_request *request, hl_volume **volume,
                               hl_error *error) {
  cells_file cells = {.request = request};
  if (!hl_stream_can_restart(*stream))
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "%s: a grid of cells is not read from a pipe: give the name of a file", (*stream)->path);
  hl_status status = read_pass(stream, &cells, true, error);
  if (status == HL_OK) status = hl_cell_mesh_choose(request, (*stream)->path, -1, error);
  if (status == HL_OK) status = read_pass(stream, &cells, false, error);
  if (status == HL_OK) status = make_volume(&cells, volume, error);
  number_list *const lists[] = {&cells.points, &cells.types, &cells.list, &cells.offsets, &cells.corners};
  for (int n = 0; n < 5; n++) hl_release(request->context, lists[n]->numbers);
  return status;
}
