/* volume/formats/vtk/legacy_vtk.c - reads legacy .vtk files with STRUCTURED_POINTS or RECTILINEAR_GRID, ASCII
 * or BINARY (big-endian). legacy_cells.c reads grids of cells.
 *
 * A file begins with three lines: the mark, the title, and ASCII or BINARY. Lines with keywords follow. A
 * first pass lists the arrays under POINT_DATA and CELL_DATA (SCALARS, COLOR_SCALARS, VECTORS, NORMALS,
 * TENSORS, TEXTURE_COORDINATES and the arrays of a FIELD), up to the first unknown keyword; a second pass
 * stops at the values of the chosen array. A pipe cannot be read twice. A pipe is read once, up to the array
 * with the wanted name or, if the caller names no array, up to the first array of one component. */
#include <string.h>

#include "core/memory.h"
#include "volume/convert.h"
#include "volume/formats/format.h"
#include "volume/formats/vtk/legacy_arrays.h"
#include "volume/formats/vtk/legacy_cells.h"
#include "volume/formats/vtk/rectilinear.h"
#include "volume/io/decoders.h"
#include "volume/io/numbers.h"
#include "volume/io/text.h"

typedef struct vtk_header {
  hl_legacy_vtk file; /* must be the first member, because callbacks convert the address of this member to the
                       * address of the whole struct */
  hl_payload payload;
  bool has_dimensions, is_rectilinear, is_of_cells;
  double *coordinates[3]; /* owned; the coordinates of a rectilinear grid; null for other grids */
  size_t counts[3];
  size_t tuples; /* number of tuples of the volume's array, set when the array is found */
  hl_load_request *request;
  bool of_cells; /* whether the volume's array has values for cells instead of points */
  bool lists;    /* whether this is the first pass, in which arrays are listed */
  bool once;     /* whether the file can be read only once, so that the first pass already stops at the first
                  * suitable array */
  size_t arrays; /* number of arrays met so far in this pass that can hold the volume */
} vtk_header;

/* Returns whether this pass stops at the array with the index `index`. */
static bool is_wanted(const vtk_header *header, const hl_legacy_array *array, size_t index) {
  const hl_load_request *request = header->request;
  if (!header->lists) return index == request->chosen;
  if (!header->once) return false;
  return request->array != NULL ? strcmp(request->array, array->name) == 0 : array->components == 1;
}

/* The `meet` function, called for each array. The function stops reading at the volume's array. */
static hl_status meet_array(hl_legacy_vtk *file, const hl_legacy_array *array, hl_error *error) {
  vtk_header *header = (vtk_header *)file;
  size_t index = header->arrays;
  hl_status status = HL_OK;
  const size_t *n = header->payload.grid.dimensions;
  /* an array before POINT_DATA and CELL_DATA can become the volume if the array has a value for each point */
  bool usable = !array->of_neither || (header->has_dimensions && array->tuples > 1 &&
                                       (double)array->tuples == (double)n[0] * (double)n[1] * (double)n[2]);
  bool of_cells = !array->of_points && !array->of_neither;
  if (usable) header->arrays++;
  if (usable && header->lists)
    status = hl_arrays_add(header->request, array->name, array->components, array->type, of_cells, error);
  if (status != HL_OK) return status;
  if (!usable || !is_wanted(header, array, index)) return hl_legacy_vtk_skip_array(file, array, error);
  if (header->once) header->request->chosen = index;
  header->payload.text = file->text;
  header->payload.text_is_fraction = array->is_fraction;
  header->payload.big_endian = true;
  header->payload.grid.type = array->type;
  header->payload.components = array->components;
  header->payload.block = 1;
  /* VTK shows arrays of unsigned bytes as colours. */
  if (array->type == HL_VOXEL_U8) header->payload.colors = HL_COLORS_MEANT;
  header->tuples = array->tuples;
  header->of_cells = of_cells;
  file->found = true;
  return HL_OK;
}

static hl_status read_geometry(vtk_header *header, const char *keyword, const char *arguments,
                               hl_error *error) {
  hl_volume_description *grid = &header->payload.grid;
  double numbers[3];
  bool sound = true;
  if (hl_text_equal(keyword, "DIMENSIONS")) {
    sound = header->has_dimensions = hl_text_sizes(arguments, grid->dimensions, 3) == 3;
  } else if (hl_text_numbers(arguments, numbers, 3) != 3) {
    sound = false;
  } else {
    for (int axis = 0; axis < 3; axis++)
      if (hl_text_equal(keyword, "ORIGIN")) grid->origin[axis] = numbers[axis];
      else grid->axis[axis][axis] = numbers[axis];
  }
  return sound ? HL_OK : hl_legacy_vtk_fail(&header->file, "expected three numbers, not", arguments, error);
}

/* Reads "X_COORDINATES number type" and the numbers. */
static hl_status read_coordinates(vtk_header *header, int axis, const char *arguments, hl_error *error) {
  char number[HL_LEGACY_WORD_BYTES], type_name[HL_LEGACY_WORD_BYTES];
  const char *cursor = arguments;
  hl_number_code code = {.text = header->file.text, .big_endian = true};
  if (!hl_text_word(&cursor, number, sizeof number) || !hl_text_word(&cursor, type_name, sizeof type_name) ||
      hl_text_sizes(number, &header->counts[axis], 1) != 1 || header->counts[axis] > SIZE_MAX / 8 ||
      header->coordinates[axis] != NULL)
    return hl_legacy_vtk_fail(
        &header->file, "expected \"number type\" after a kind of coordinates, once, not", arguments, error);
  hl_status status = hl_legacy_vtk_type(&header->file, type_name, &code.type, error);
  return status == HL_OK ? hl_read_numbers(header->file.stream, &code, header->counts[axis],
                                           &header->coordinates[axis], error)
                         : status;
}

/* Reads a keyword that describes structured points or a rectilinear grid. */
static hl_status read_keyword(hl_legacy_vtk *file, const char *keyword, const char *arguments,
                              hl_error *error) {
  char shown[HL_PRINTABLE_BYTES];
  if (hl_text_equal(keyword, "DATASET")) {
    ((vtk_header *)file)->is_rectilinear = hl_text_equal(arguments, "RECTILINEAR_GRID");
    ((vtk_header *)file)->is_of_cells = file->found = hl_legacy_is_of_cells(arguments);
    if (hl_text_equal(arguments, "STRUCTURED_POINTS") || ((vtk_header *)file)->is_rectilinear || file->found)
      return HL_OK;
    return HL_FAIL_LINE(error, HL_ERROR_UNSUPPORTED, file->stream, file->line,
                        "a data set of kind \"%s\" is not read: save it as a grid of points or cells "
                        "(ParaView: Resample To Image)",
                        hl_text_printable(shown, arguments));
  }
  static const char *const geometry[] = {"DIMENSIONS", "SPACING", "ASPECT_RATIO", "ORIGIN"};
  for (int n = 0; n < 4; n++)
    if (hl_text_equal(keyword, geometry[n]))
      return read_geometry((vtk_header *)file, keyword, arguments, error);
  static const char *const coordinates[] = {"X_COORDINATES", "Y_COORDINATES", "Z_COORDINATES"};
  for (int axis = 0; axis < 3; axis++)
    if (hl_text_equal(keyword, coordinates[axis]))
      return read_coordinates((vtk_header *)file, axis, arguments, error);
  return HL_FAIL_LINE(error, HL_ERROR_UNSUPPORTED, file->stream, file->line,
                      "\"%s\" is not read: save the volume as SCALARS or in a FIELD, before other data",
                      hl_text_printable(shown, keyword));
}

static vtk_header begin(hl_stream *stream, hl_load_request *request, bool lists) {
  vtk_header header = {.file = {.stream = stream, .meet = meet_array, .keyword = read_keyword},
                       .request = request,
                       .lists = lists,
                       .once = lists && !hl_stream_can_restart(stream)};
  hl_payload_defaults(&header.payload);
  header.payload.trailing = HL_TRAILING_IGNORED;
  return header;
}

static void release(vtk_header *header) {
  for (int axis = 0; axis < 3; axis++) {
    hl_release(header->request->context, header->coordinates[axis]);
    header->coordinates[axis] = NULL;
  }
}

/* Returns whether an error can be ignored, because a suitable array was listed before the error occurred. */
static bool is_enough(const hl_load_request *request, hl_status status) {
  if (status != HL_ERROR_INPUT && status != HL_ERROR_UNSUPPORTED) return false;
  for (size_t n = 0; n < request->array_count; n++)
    if (request->array != NULL ? strcmp(request->arrays[n].name, request->array) == 0
                               : request->arrays[n].components == 1)
      return true;
  return false;
}

/* Finds the chosen array, and moves the stream to its values. Errors in the file after the chosen array's
 * values are ignored. */
static hl_status find_volume(hl_stream **stream, hl_load_request *request, vtk_header *header,
                             hl_error *error) {
  *header = begin(*stream, request, true);
  hl_error first = {0};
  hl_status status = hl_legacy_vtk_read(&header->file, &first);
  if (status != HL_OK && !is_enough(request, status)) {
    if (error != NULL) *error = first;
    return status;
  }
  if (header->is_of_cells) return HL_OK;
  if (request->array_count == 0)
    return HL_FAIL_LINE(error, HL_ERROR_INPUT, *stream, header->file.line, "%s",
                        "the file ends without POINT_DATA and SCALARS, which hold the volume");
  if (header->once && header->file.found) return HL_OK;
  status = hl_arrays_choose(request, (*stream)->path, -1, error);
  if (status == HL_OK) status = hl_stream_restart(stream, error);
  if (status == HL_OK) status = hl_stream_unpack(stream, error);
  if (status != HL_OK) return status;
  release(header);
  *header = begin(*stream, request, false);
  return hl_legacy_vtk_read(&header->file, error);
}

/* Changes the grid of points to the grid of the cells between them. Along each axis with several points, the
 * number of cells is one less than the number of points, and the first cell's centre lies half a step after
 * the first point. */
static void move_to_cells(hl_volume_description *grid) {
  for (int axis = 0; axis < 3; axis++) {
    if (grid->dimensions[axis] < 2) continue;
    grid->dimensions[axis]--;
    grid->origin[axis] += grid->axis[axis][axis] / 2;
  }
}

static hl_status read_volume(hl_stream **stream, vtk_header *header, hl_volume **volume, hl_error *error) {
  hl_load_request *request = header->request;
  hl_volume_description *grid = &header->payload.grid;
  if (!header->has_dimensions)
    return HL_FAIL_LINE(error, HL_ERROR_INPUT, *stream, header->file.line, "%s",
                        "the file has no DIMENSIONS");
  if (header->of_cells) move_to_cells(grid);
  hl_status status = hl_volume_check_grid(grid, (*stream)->path, error);
  if (status != HL_OK) return status;
  const size_t *dimension = grid->dimensions;
  if (!header->file.found || header->tuples != dimension[0] * dimension[1] * dimension[2])
    return hl_fail(error, HL_ERROR_INPUT, "%s: %s has %zu values, DIMENSIONS %zu x %zu x %zu need %zu",
                   (*stream)->path, header->of_cells ? "CELL_DATA" : "POINT_DATA", header->tuples,
                   dimension[0] + header->of_cells, dimension[1] + header->of_cells,
                   dimension[2] + header->of_cells, dimension[0] * dimension[1] * dimension[2]);
  status = hl_component_choose(request, (*stream)->path, false, &header->payload, error);
  if (status == HL_OK) status = hl_payload_read(*stream, &header->payload, request->spacing, volume, error);
  if (status != HL_OK || !header->is_rectilinear || request->spacing[0] > 0) return status;
  for (int axis = 0; axis < 3; axis++)
    if (header->coordinates[axis] == NULL || header->counts[axis] == 0) {
      hl_volume_release(*volume);
      *volume = NULL;
      return hl_fail(error, HL_ERROR_INPUT, "%s: a rectilinear grid without %c_COORDINATES", (*stream)->path,
                     "XYZ"[axis]);
    }
  return hl_rectilinear_place(volume, header->coordinates, header->counts, header->of_cells, (*stream)->path,
                              error);
}

static hl_status load(hl_stream **stream, hl_load_request *request, hl_volume **volume, hl_error *error) {
  vtk_header header;
  hl_status status = find_volume(stream, request, &header, error);
  if (status == HL_OK)
    status = header.is_of_cells ? hl_legacy_cells_load(stream, request, volume, error)
                                : read_volume(stream, &header, volume, error);
  release(&header);
  return status;
}

const hl_format hl_format_legacy_vtk = {
    .name = ".vtk",
    .title = "VTK .vtk",
    .endings = {".vtk"},
    .beginning = "\"# vtk DataFile Version\"",
    .has_content = hl_legacy_vtk_has_content,
    .load = load,
};
