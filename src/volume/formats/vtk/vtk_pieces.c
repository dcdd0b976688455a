/* volume/formats/vtk/vtk_pieces.c - reads the pieces of XML files of VTK that have points. */
#include "volume/formats/vtk/vtk_pieces.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "volume/convert.h"
#include "volume/io/numbers.h"
#include "volume/io/text.h"

/* MOST_ARRAYS: further arrays of a piece are ignored. MOST_PIECES: a file with more pieces is refused. */
enum { MOST_ARRAYS = 1024, MOST_PIECES = 4096 };

static const char *const section_names[HL_VTK_NO_SECTION] = {"Points", "Cells", "PointData", "CellData"};

/* ---- tags ---- */

/* Reads the extent of a curvilinear piece, "x0 x1 y0 y1 z0 z1", in indices of points. */
static hl_status read_extent(const hl_vtk_pieces *file, const hl_xml_tag *tag, hl_vtk_piece *piece,
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

/* Reads the numbers of a piece's points and cells and, in PolyData, of its lines and surfaces. */
static hl_status read_counts(const hl_vtk_pieces *file, const hl_xml_tag *tag, hl_vtk_piece *piece,
                             hl_error *error) {
  static const char *const names[] = {"NumberOfLines", "NumberOfPolys", "NumberOfStrips"};
  hl_status status = hl_vtk_xml_count(&file->xml, tag, "NumberOfPoints", &piece->point_count, error);
  if (status == HL_OK) status = hl_vtk_xml_count(&file->xml, tag, "NumberOfCells", &piece->cell_count, error);
  for (size_t n = 0; n < sizeof names / sizeof *names && status == HL_OK; n++) {
    size_t count = 0;
    status = hl_vtk_xml_count(&file->xml, tag, names[n], &count, error);
    piece->surface_count = count > SIZE_MAX - piece->surface_count ? SIZE_MAX : piece->surface_count + count;
  }
  return status;
}

/* Reads the tag of a piece. Pieces without points, which programs that write in parallel leave behind, are
 * ignored. */
static hl_status read_piece_tag(hl_vtk_pieces *file, const hl_xml_tag *tag, hl_error *error) {
  hl_vtk_piece piece = {.first_array = file->array_count};
  hl_status status = strcmp(file->types[file->type], "StructuredGrid") == 0
                         ? read_extent(file, tag, &piece, error)
                         : read_counts(file, tag, &piece, error);
  file->in_piece = piece.point_count > 0;
  if (status != HL_OK || !file->in_piece) return status;
  if (file->piece_count == MOST_PIECES)
    return hl_fail(error, HL_ERROR_UNSUPPORTED, "%s: has more than %d pieces: save it as one",
                   file->xml.stream->path, MOST_PIECES);
  status = hl_vtk_xml_grow(file->context, &file->xml, (void **)&file->pieces, file->piece_count,
                           &file->piece_room, sizeof piece, error);
  if (status == HL_OK) file->pieces[file->piece_count++] = piece;
  return status;
}

static hl_status read_array_tag(hl_vtk_pieces *file, const hl_xml_tag *tag, hl_error *error) {
  if (file->section == HL_VTK_NO_SECTION || !file->in_piece) return HL_OK;
  hl_vtk_piece *piece = &file->pieces[file->piece_count - 1];
  hl_vtk_piece_array made = {.section = file->section, .components = 1};
  if (piece->array_count == MOST_ARRAYS) return HL_OK;
  hl_status status = hl_vtk_xml_array_tag(&file->xml, tag, &made.array, error);
  if (status == HL_OK)
    status = hl_vtk_xml_count(&file->xml, tag, "NumberOfComponents", &made.components, error);
  if (status == HL_OK && made.components == 0)
    return hl_vtk_xml_refuse(&file->xml, HL_ERROR_INPUT, "NumberOfComponents", "0", error);
  if (status == HL_OK)
    status = hl_vtk_xml_grow(file->context, &file->xml, (void **)&file->arrays, file->array_count,
                             &file->array_room, sizeof made, error);
  if (status != HL_OK) return status;
  hl_vtk_xml_copy_name(made.name, hl_xml_attribute(tag, "Name"));
  made.is_active = made.name[0] != 0 && strcmp(made.name, file->active) == 0;
  for (int n = 0; n < 2; n++) made.is_id |= made.name[0] != 0 && strcmp(made.name, file->ids[n]) == 0;
  file->arrays[file->array_count++] = made;
  piece->array_count++;
  return HL_OK;
}

static hl_status read_file_tag(hl_vtk_pieces *file, const hl_xml_tag *tag, hl_error *error) {
  const char *type = hl_xml_attribute(tag, "type");
  file->type = 0;
  for (size_t n = 0; type != NULL && n < file->type_count; n++)
    if (strcmp(type, file->types[n]) == 0) file->type = n;
  return hl_vtk_xml_file_tag(&file->xml, tag, file->types[file->type], error);
}

static hl_status read_tag(void *data, const hl_xml_tag *tag, hl_error *error) {
  hl_vtk_pieces *file = data;
  for (int n = 0; n < HL_VTK_NO_SECTION; n++)
    if (strcmp(tag->name, section_names[n]) == 0) {
      file->section = tag->is_start && !tag->is_end ? (hl_vtk_section)n : HL_VTK_NO_SECTION;
      hl_vtk_xml_copy_name(file->active, hl_xml_attribute(tag, "Scalars"));
      hl_vtk_xml_copy_name(file->ids[0], hl_xml_attribute(tag, "GlobalIds"));
      hl_vtk_xml_copy_name(file->ids[1], hl_xml_attribute(tag, "PedigreeIds"));
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

hl_status hl_vtk_pieces_read(hl_vtk_pieces *pieces, hl_error *error) {
  pieces->section = HL_VTK_NO_SECTION;
  hl_status status = hl_vtk_xml_read_tags(&pieces->xml, read_tag, pieces, error);
  return status == HL_OK && pieces->piece_count > 0 ? hl_vtk_xml_check_end(&pieces->xml, error) : status;
}

void hl_vtk_pieces_release(hl_vtk_pieces *pieces) {
  hl_release(pieces->context, pieces->pieces);
  hl_release(pieces->context, pieces->arrays);
}

/* ---- arrays ---- */

const hl_vtk_piece_array *hl_vtk_pieces_find(const hl_vtk_pieces *file, const hl_vtk_piece *piece,
                                             hl_vtk_section which, const char *name) {
  for (size_t n = 0; n < piece->array_count; n++) {
    const hl_vtk_piece_array *array = &file->arrays[piece->first_array + n];
    if (array->section == which && (name == NULL || strcmp(array->name, name) == 0)) return array;
  }
  return NULL;
}

hl_status hl_vtk_pieces_numbers(hl_stream **stream, hl_vtk_pieces *file, const hl_vtk_piece_array *array,
                                size_t tuples, double **numbers, hl_error *error) {
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

hl_status hl_vtk_pieces_fail_missing(const hl_vtk_pieces *file, const char *what, hl_error *error) {
  return hl_fail(error, HL_ERROR_INPUT, "%s: a piece has no array of %s", file->xml.stream->path, what);
}
