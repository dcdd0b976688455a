/* volume/formats/particles/vtp.c - reads the points of VTK's XML PolyData (.vtp) as particles.
 *
 * PolyData count as particles if they have neither lines nor surfaces, but have an array of masses or of
 * smoothing lengths at their points. All other PolyData are meshes (mesh/vtp.c). All other arrays at the
 * points are quantities. The quantity of an array of vectors is the length of the vectors. */
#include <halflight/particles.h>
#include <math.h>
#include <string.h>

#include "core/door.h"
#include "core/memory.h"
#include "volume/formats/particles/particle_columns.h"
#include "volume/formats/vtk/vtk_pieces.h"
#include "volume/io/text.h"

static const char *const types[] = {"PolyData"};

/* ---- data sets that hold particles ---- */

static bool are_particles(const hl_vtk_pieces *pieces) {
  bool found = false;
  for (size_t n = 0; n < pieces->piece_count; n++)
    if (pieces->pieces[n].surface_count > 0) return false;
  for (size_t n = 0; pieces->piece_count > 0 && n < pieces->pieces[0].array_count; n++) {
    const hl_vtk_piece_array *array = &pieces->arrays[pieces->pieces[0].first_array + n];
    hl_particle_role role = hl_particle_role_of(array->name);
    found = found || (array->section == HL_VTK_POINT_DATA && array->components == 1 &&
                      (role == HL_COLUMN_MASS || role == HL_COLUMN_LENGTH));
  }
  return found;
}

int hl_volume_reads_particles(hl_context *context, const char *path) {
  HL_DOOR;
  hl_vtk_pieces pieces = {.context = context, .types = types, .type_count = 1};
  hl_error unused;
  if (context == NULL || path == NULL || !hl_text_ends(path, ".vtp")) return 0;
  hl_status status = hl_stream_open(context, path, true, &pieces.xml.stream, &unused);
  if (status == HL_OK) status = hl_stream_unpack(&pieces.xml.stream, &unused);
  if (status == HL_OK) status = hl_vtk_pieces_read(&pieces, &unused);
  bool found = status == HL_OK && are_particles(&pieces);
  hl_stream_close(pieces.xml.stream);
  hl_vtk_pieces_release(&pieces);
  return found;
}

/* ---- arrays ---- */

/* Makes a column of each array of the first piece. No array becomes a coordinate, because the points have
 * coordinates of their own. names: [HL_PARTICLE_COLUMNS_MOST]; set to the arrays' names in the file. The
 * names of the columns may differ from the arrays' names, because names of columns are printable. */
static void name_columns(const hl_vtk_pieces *pieces, hl_particle_columns *columns, const char **names) {
  for (size_t n = 0; n < pieces->pieces[0].array_count; n++) {
    const hl_vtk_piece_array *array = &pieces->arrays[pieces->pieces[0].first_array + n];
    hl_voxel_type type;
    if (array->section != HL_VTK_POINT_DATA || !hl_vtk_xml_find_type(array->array.type, &type)) continue;
    if (columns->column_count == HL_PARTICLE_COLUMNS_MOST) return;
    names[columns->column_count] = array->name;
    hl_particle_columns_add(columns, array->name);
    hl_particle_column *column = &columns->column[columns->column_count - 1];
    bool is_coordinate = column->role <= HL_COLUMN_Z, is_vector = array->components != 1;
    if (is_coordinate || is_vector) column->role = HL_COLUMN_QUANTITY;
    column->is_scaled = false;
  }
}

/* Appends tuples to a column. The appended value is the number in a tuple of one component, and the vector's
 * length for a tuple of several components. */
static hl_status append(const hl_particle_columns *columns, hl_particle_column *column, const double *numbers,
                        size_t tuples, size_t components, hl_error *error) {
  float *values = hl_reallocate(columns->context, column->values, columns->count + tuples, sizeof *values);
  if (values == NULL) return hl_fail_memory(error, (columns->count + tuples) * sizeof *values, "particles");
  column->values = values;
  for (size_t n = 0; n < tuples; n++) {
    double squares = 0;
    for (size_t c = 0; c < components; c++)
      squares += numbers[n * components + c] * numbers[n * components + c];
    values[columns->count + n] = (float)(components == 1 ? numbers[n] : sqrt(squares));
  }
  return HL_OK;
}

static hl_status read_column(hl_stream **stream, hl_vtk_pieces *pieces, const hl_vtk_piece *piece,
                             hl_particle_columns *columns, int c, const char *name, hl_error *error) {
  const hl_vtk_piece_array *array = hl_vtk_pieces_find(pieces, piece, HL_VTK_POINT_DATA, name);
  double *numbers = NULL;
  if (array == NULL) return hl_vtk_pieces_fail_missing(pieces, columns->column[c].name, error);
  hl_status status = hl_vtk_pieces_numbers(stream, pieces, array, piece->point_count, &numbers, error);
  if (status == HL_OK)
    status = append(columns, &columns->column[c], numbers, piece->point_count, array->components, error);
  hl_release(pieces->context, numbers);
  return status;
}

static hl_status read_places(hl_stream **stream, hl_vtk_pieces *pieces, const hl_vtk_piece *piece,
                             hl_particle_columns *columns, hl_error *error) {
  const hl_vtk_piece_array *points = hl_vtk_pieces_find(pieces, piece, HL_VTK_POINTS, NULL);
  size_t count = columns->count + piece->point_count;
  double *numbers = NULL;
  if (points == NULL || points->components != 3) return hl_vtk_pieces_fail_missing(pieces, "points", error);
  hl_status status = hl_vtk_pieces_numbers(stream, pieces, points, piece->point_count, &numbers, error);
  if (status == HL_OK) {
    void *positions = hl_reallocate(columns->context, columns->positions, count, sizeof *columns->positions);
    if (positions == NULL) status = hl_fail_memory(error, count * sizeof *columns->positions, "particles");
    else columns->positions = positions;
  }
  if (status == HL_OK)
    memcpy(columns->positions + columns->count, numbers, piece->point_count * sizeof *columns->positions);
  hl_release(pieces->context, numbers);
  return status;
}

static hl_status read_pieces(hl_stream **stream, hl_vtk_pieces *pieces, hl_particle_columns *columns,
                             hl_error *error) {
  const char *names[HL_PARTICLE_COLUMNS_MOST];
  hl_status status = HL_OK;
  name_columns(pieces, columns, names);
  for (size_t n = 0; n < pieces->piece_count && status == HL_OK; n++) {
    const hl_vtk_piece *piece = &pieces->pieces[n];
    status = read_places(stream, pieces, piece, columns, error);
    for (int c = 0; c < columns->column_count && status == HL_OK; c++)
      status = read_column(stream, pieces, piece, columns, c, names[c], error);
    columns->count += piece->point_count;
  }
  return status;
}

/* ---- all steps together ---- */

static hl_status load(hl_stream **stream, hl_load_request *request, hl_volume **volume, hl_error *error) {
  hl_vtk_pieces pieces = {.context = request->context, .types = types, .type_count = 1};
  hl_particle_columns columns = {.context = request->context};
  pieces.xml.stream = *stream;
  char *path = hl_copy_text(request->context, (*stream)->path); /* reading an array opens the stream anew */
  hl_status status = path != NULL ? hl_vtk_pieces_read(&pieces, error) : hl_fail_memory(error, 1, "a path");
  if (status == HL_OK && !are_particles(&pieces))
    status = hl_fail(error, HL_ERROR_UNSUPPORTED,
                     "%s: a mesh, not a volume: give it to `halflight render` beside a volume, or alone",
                     path);
  if (status == HL_OK) status = read_pieces(stream, &pieces, &columns, error);
  if (status == HL_OK) status = hl_particle_columns_volume(&columns, request, path, volume, error);
  hl_particle_columns_release(&columns);
  hl_vtk_pieces_release(&pieces);
  hl_release(request->context, path);
  return status;
}

static bool has_content(const unsigned char *bytes, size_t length) {
  return hl_vtk_xml_is_of(bytes, length, types, 1);
}

const hl_format hl_format_vtp = {
    .name = "VTK .vtp",
    .endings = {".vtp"},
    .beginning = "\"<VTKFile\" of type \"PolyData\"",
    .has_content = has_content,
    .load = load,
};
