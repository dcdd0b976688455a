/* volume/formats/vtk/vti.c - reads VTK XML image data (.vti), rectilinear grids (.vtr), and image data in
 * several files (.pvti): ascii, base64 and appended arrays, plain or in compressed blocks.
 *
 * A first pass over the tags lists the arrays of the first piece. The volume is the array that the caller
 * named. If the caller names no array, the volume is the array of the active scalars, else the first array of
 * one component at points, else the first array of one component at cells. A second pass reads the values,
 * piece by piece. World: Origin + Direction * (Spacing * index), where the first point has the extent's first
 * index. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "volume/convert.h"
#include "volume/formats/format.h"
#include "volume/formats/pieces.h"
#include "volume/formats/vtk/rectilinear.h"
#include "volume/formats/vtk/vtk_xml.h"
#include "volume/io/numbers.h"
#include "volume/io/text.h"

typedef enum section { SECTION_NONE, SECTION_POINTS, SECTION_CELLS, SECTION_COORDINATES } section;
typedef enum vti_kind { KIND_IMAGE, KIND_RECTILINEAR, KIND_PARALLEL } vti_kind;
static const char *const kind_names[] = {"ImageData", "RectilinearGrid", "PImageData"};

enum { PIECES_MOST = 65536, ENTRIES_MOST = 1 << 20 };

/* A piece of the whole volume: the piece's extent and, if the volume consists of several files, the name of
 * the piece's file. */
typedef struct vti_piece {
  double extent[6];
  char *source; /* owned; name of the piece's file; null if the piece is in this file */
} vti_piece;

/* An array of a piece. */
typedef struct vti_entry {
  size_t piece;
  bool cells;
  char name[HL_VTK_NAME_BYTES];
  hl_vtk_array array;
} vti_entry;

typedef struct vti_header {
  hl_vtk_xml xml;
  struct {
    double extent[6]; /* indices of the first and the last point along x, y, z */
    double origin[3], spacing[3], direction[9];
    bool has_extent;
    hl_vtk_array coordinates[3]; /* coordinates of a rectilinear grid's first piece */
    int coordinate_count;
  } grid;
  vti_kind kind;
  vti_piece *pieces;  /* owned; [piece_count] */
  vti_entry *entries; /* owned; [entry_count]; the arrays of all pieces */
  size_t piece_count, piece_room, entry_count, entry_room;
  section section;
  char active[HL_VTK_NAME_BYTES];  /* name of the section's active scalars */
  int active_points, active_cells; /* indices of the arrays of active scalars at points and at cells; -1 if
                                    * the file marks none */
  hl_load_request *request;        /* the request to load the volume; lists the arrays of the first piece */
} vti_header;

static hl_status read_numbers(const vti_header *header, const hl_xml_tag *tag, const char *name,
                              double *numbers, int count, hl_error *error) {
  const char *value = hl_xml_attribute(tag, name);
  if (value == NULL || hl_text_numbers(value, numbers, count) == count) return HL_OK;
  return hl_vtk_xml_refuse(&header->xml, HL_ERROR_INPUT, name, value, error);
}

/* Reads an extent from an attribute. If the attribute is absent, `extent` is not changed. An extent is empty
 * if a last index is less than the first index. */
static hl_status read_extent(vti_header *header, const hl_xml_tag *tag, const char *name, double extent[6],
                             bool may_be_empty, hl_error *error) {
  const char *value = hl_xml_attribute(tag, name);
  if (value == NULL) return HL_OK;
  hl_status status = read_numbers(header, tag, name, extent, 6, error);
  for (int axis = 0; status == HL_OK && axis < 3; axis++) {
    double first = extent[2 * axis], last = extent[2 * axis + 1];
    if (first != floor(first) || last != floor(last) || !(first >= -2147483648.0) ||
        !(last <= 2147483647.0) || (last < first && !may_be_empty))
      status = hl_vtk_xml_refuse(&header->xml, HL_ERROR_INPUT, name, value, error);
  }
  header->grid.has_extent = true;
  return status;
}

static hl_status read_image_tag(vti_header *header, const hl_xml_tag *tag, hl_error *error) {
  hl_status status = read_extent(header, tag, "WholeExtent", header->grid.extent, false, error);
  if (status == HL_OK) status = read_numbers(header, tag, "Origin", header->grid.origin, 3, error);
  if (status == HL_OK) status = read_numbers(header, tag, "Spacing", header->grid.spacing, 3, error);
  if (status == HL_OK) status = read_numbers(header, tag, "Direction", header->grid.direction, 9, error);
  return status;
}

/* Makes room for one more element of a list. */
static hl_status grow(const vti_header *header, void **list, size_t count, size_t *room, size_t size,
                      size_t most, hl_error *error) {
  if (count == most)
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "%s: more than %zu pieces or arrays: save it as one, with fewer", header->xml.stream->path,
                   most);
  if (count < *room) return HL_OK;
  size_t wanted = 2 * *room + 16;
  void *grown = hl_reallocate(header->request->context, *list, wanted, size);
  if (grown == NULL) return hl_fail_memory(error, wanted * size, header->xml.stream->path);
  *list = grown;
  *room = wanted;
  return HL_OK;
}

static hl_status read_piece_tag(vti_header *header, const hl_xml_tag *tag, hl_error *error) {
  const char *source = hl_xml_attribute(tag, "Source");
  hl_status status = grow(header, (void **)&header->pieces, header->piece_count, &header->piece_room,
                          sizeof *header->pieces, PIECES_MOST, error);
  if (status != HL_OK) return status;
  vti_piece *piece = &header->pieces[header->piece_count++];
  *piece = (vti_piece){.source = NULL};
  memcpy(piece->extent, header->grid.extent, sizeof piece->extent);
  if (header->kind == KIND_PARALLEL) {
    if (source == NULL) return hl_vtk_xml_refuse(&header->xml, HL_ERROR_INPUT, "a Piece's Source", "", error);
    piece->source = hl_copy_text(header->request->context, source);
    if (piece->source == NULL) return hl_fail_memory(error, strlen(source), header->xml.stream->path);
  }
  return read_extent(header, tag, "Extent", piece->extent, true, error);
}

static void begin_section(vti_header *header, const hl_xml_tag *tag, section which) {
  const char *active = hl_xml_attribute(tag, "Scalars");
  header->section = tag->is_end ? SECTION_NONE : which;
  header->active[0] = 0;
  if (active != NULL && strlen(active) < HL_VTK_NAME_BYTES) strcpy(header->active, active);
}

static hl_status read_array_tag(vti_header *header, const hl_xml_tag *tag, hl_error *error) {
  if (header->section == SECTION_NONE) return HL_OK;
  const char *name = hl_xml_attribute(tag, "Name"), *stated = hl_xml_attribute(tag, "NumberOfComponents");
  hl_vtk_array array;
  size_t components = 1, index = header->request->array_count;
  hl_voxel_type type = 0;
  bool cells = header->section == SECTION_CELLS;
  hl_status status = hl_vtk_xml_array_tag(&header->xml, tag, &array, error);
  if (status != HL_OK) return status;
  if (header->section == SECTION_COORDINATES) {
    if (header->grid.coordinate_count < 3 && header->piece_count <= 1)
      header->grid.coordinates[header->grid.coordinate_count++] = array;
    return HL_OK;
  }
  status = grow(header, (void **)&header->entries, header->entry_count, &header->entry_room,
                sizeof *header->entries, ENTRIES_MOST, error);
  if (status != HL_OK) return status;
  vti_entry *entry = &header->entries[header->entry_count++];
  *entry = (vti_entry){
      .piece = header->piece_count > 0 ? header->piece_count - 1 : 0, .cells = cells, .array = array};
  if (name != NULL && strlen(name) < sizeof entry->name) strcpy(entry->name, name);
  if (entry->piece > 0) return HL_OK; /* only arrays of the first piece are listed in the request */
  if (stated != NULL && (hl_text_sizes(stated, &components, 1) != 1 || components == 0))
    return hl_vtk_xml_refuse(&header->xml, HL_ERROR_INPUT, "NumberOfComponents", stated, error);
  hl_vtk_xml_find_type(array.type, &type);
  status = hl_arrays_add(header->request, name != NULL ? name : "", components, type, cells, error);
  if (status != HL_OK || header->request->array_count == index) return status;
  int *active = cells ? &header->active_cells : &header->active_points;
  if (header->active[0] != 0 && name != NULL && strcmp(name, header->active) == 0 && *active < 0)
    *active = (int)index;
  return HL_OK;
}

static hl_status read_tag(void *data, const hl_xml_tag *tag, hl_error *error) {
  vti_header *header = data;
  if (!tag->is_start) {
    if (strcmp(tag->name, "PointData") == 0 || strcmp(tag->name, "CellData") == 0 ||
        strcmp(tag->name, "Coordinates") == 0)
      header->section = SECTION_NONE;
    return HL_OK;
  }
  if (header->xml.header_bytes == 0 && strcmp(tag->name, "VTKFile") != 0)
    return hl_vtk_xml_refuse(&header->xml, HL_ERROR_UNSUPPORTED, "an XML file whose first element is",
                             tag->name, error);
  if (strcmp(tag->name, "VTKFile") == 0) {
    const char *type = hl_xml_attribute(tag, "type");
    for (int kind = KIND_IMAGE; type != NULL && kind <= KIND_PARALLEL; kind++)
      if (strcmp(type, kind_names[kind]) == 0) header->kind = (vti_kind)kind;
    return hl_vtk_xml_file_tag(&header->xml, tag, kind_names[header->kind], error);
  }
  if (strcmp(tag->name, kind_names[header->kind]) == 0) return read_image_tag(header, tag, error);
  if (strcmp(tag->name, "Piece") == 0) return read_piece_tag(header, tag, error);
  if (strcmp(tag->name, "DataArray") == 0) return read_array_tag(header, tag, error);
  if (strcmp(tag->name, "AppendedData") == 0) return hl_vtk_xml_appended_tag(&header->xml, tag, error);
  if (strcmp(tag->name, "PointData") == 0) begin_section(header, tag, SECTION_POINTS);
  if (strcmp(tag->name, "CellData") == 0) begin_section(header, tag, SECTION_CELLS);
  if (strcmp(tag->name, "Coordinates") == 0) begin_section(header, tag, SECTION_COORDINATES);
  return HL_OK;
}

static void make_grid(const vti_header *header, const double extent[6], bool cells,
                      hl_volume_description *grid) {
  for (int axis = 0; axis < 3; axis++) {
    size_t points = (size_t)(extent[2 * axis + 1] - extent[2 * axis]) + 1;
    grid->dimensions[axis] = cells && points > 1 ? points - 1 : points;
    grid->origin[axis] = header->grid.origin[axis];
    for (int row = 0; row < 3; row++)
      grid->axis[axis][row] = header->grid.direction[3 * row + axis] * header->grid.spacing[axis];
  }
  for (int axis = 0; axis < 3; axis++) {
    bool between = cells && extent[2 * axis + 1] > extent[2 * axis];
    double first = extent[2 * axis] + (between ? 0.5 : 0); /* a cell's centre lies between points */
    for (int row = 0; row < 3; row++) grid->origin[row] += first * grid->axis[axis][row];
  }
}

/* The index of the array that is read by default. The result is the active scalars at points. If the file
 * marks no active scalars at points, the result is the active scalars at cells, unless the file has an array
 * of one component at points. In all other cases the result is -1. */
static int active_array(const vti_header *header) {
  if (header->active_points >= 0) return header->active_points;
  for (size_t n = 0; n < header->request->array_count; n++)
    if (!header->request->arrays[n].of_cells && header->request->arrays[n].components == 1) return -1;
  return header->active_cells;
}

static hl_status choose_array(const vti_header *header, hl_error *error) {
  if (header->request->array_count > 0 && header->grid.has_extent) {
    hl_status status = hl_arrays_choose(header->request, header->xml.stream->path, active_array(header),
                                        error);
    const hl_array_entry *chosen = &header->request->arrays[header->request->chosen];
    bool is_last_resort = header->request->array == NULL && (chosen->of_cells || chosen->components > 1);
    return status == HL_OK && is_last_resort ? hl_vtk_xml_check_end(&header->xml, error) : status;
  }
  return hl_fail(error, HL_ERROR_INPUT, "%s: the file has no %s", header->xml.stream->path,
                 header->grid.has_extent ? "DataArray in PointData or CellData" : "WholeExtent or Extent");
}

static bool is_empty(const vti_piece *piece) {
  const double *e = piece->extent;
  return e[1] < e[0] || e[3] < e[2] || e[5] < e[4];
}

/* Finds the chosen array in a piece; null if the piece lacks this array. */
static const vti_entry *entry_of(const vti_header *header, size_t piece) {
  const hl_array_entry *chosen = &header->request->arrays[header->request->chosen];
  for (size_t n = 0; n < header->entry_count; n++) {
    const vti_entry *entry = &header->entries[n];
    if (entry->piece == piece && entry->cells == chosen->of_cells && strcmp(entry->name, chosen->name) == 0)
      return entry;
  }
  return NULL;
}

/* Describes a piece's voxels in the file. */
static hl_status describe(const vti_header *header, const vti_piece *piece, const hl_vtk_array *array,
                          hl_payload *payload, hl_error *error) {
  const hl_array_entry *chosen = &header->request->arrays[header->request->chosen];
  hl_payload_defaults(payload);
  payload->trailing = HL_TRAILING_IGNORED;
  hl_status status = hl_vtk_xml_type(&header->xml, array->type, &payload->grid.type, error);
  if (status != HL_OK) return status;
  make_grid(header, piece->extent, chosen->of_cells, &payload->grid);
  payload->big_endian = header->xml.big_endian;
  payload->text = array->encoding == HL_VTK_ASCII;
  payload->components = chosen->components;
  payload->block = 1;
  bool alone = header->piece_count == 1;
  if (!alone) payload->colors = HL_COLORS_UNREAD;
  else if (payload->grid.type == HL_VOXEL_U8)
    payload->colors = HL_COLORS_MEANT; /* VTK shows unsigned bytes as colours */
  status = hl_volume_check_grid(&payload->grid, header->xml.stream->path, error);
  return status == HL_OK
             ? hl_component_choose(header->request, header->xml.stream->path, false, payload, error)
             : status;
}

/* Reads a piece's chosen array as a volume of its own. */
static hl_status read_piece(hl_stream **stream, vti_header *header, size_t index, hl_volume **volume,
                            hl_error *error) {
  header->xml.stream = *stream; /* the stream may have been replaced when the piece before was read */
  const vti_entry *entry = entry_of(header, index);
  hl_payload payload;
  if (entry == NULL)
    return hl_fail(error, HL_ERROR_INPUT, "%s: piece %zu has no array \"%.60s\"", (*stream)->path, index + 1,
                   header->request->arrays[header->request->chosen].name);
  hl_status status = describe(header, &header->pieces[index], &entry->array, &payload, error);
  if (status == HL_OK)
    status = hl_vtk_xml_open_array(stream, &header->xml, &entry->array, hl_payload_bytes(&payload), error);
  return status == HL_OK ? hl_payload_read(*stream, &payload, header->request->spacing, volume, error)
                         : status;
}

/* Finds the index in the whole volume of a piece's first voxel. */
static void place_of(const vti_header *header, const vti_piece *piece, size_t first[3]) {
  for (int axis = 0; axis < 3; axis++) {
    double before = piece->extent[2 * axis] - header->grid.extent[2 * axis];
    first[axis] = before >= 0 ? (size_t)before : SIZE_MAX; /* a piece that begins before the whole volume gets
                                                            * SIZE_MAX, so that it is refused */
  }
}

/* Reads all pieces of this file, and copies each piece into the whole volume. */
static hl_status read_pieces(hl_stream **stream, vti_header *header, hl_volume **volume, hl_error *error) {
  const vti_piece whole = {.extent = {header->grid.extent[0], header->grid.extent[1], header->grid.extent[2],
                                      header->grid.extent[3], header->grid.extent[4],
                                      header->grid.extent[5]}};
  const vti_entry *first_entry = entry_of(header, 0);
  hl_payload payload;
  hl_pieces pieces = {.to = {.context = NULL}};
  if (first_entry == NULL) return hl_fail(error, HL_ERROR_INPUT, "%s: a piece has no array", (*stream)->path);
  hl_status status = describe(header, &whole, &first_entry->array, &payload, error);
  if (status != HL_OK) return status;
  hl_volume_description grid = hl_payload_grid(&payload, header->request->spacing);
  for (size_t n = 0; n < header->piece_count && status == HL_OK; n++) {
    hl_volume *piece = NULL;
    size_t first[3];
    if (is_empty(&header->pieces[n])) continue;
    place_of(header, &header->pieces[n], first);
    status = read_piece(stream, header, n, &piece, error);
    /* memory for the whole volume is allocated only after a first piece was read, because a header can
     * promise any size */
    if (status == HL_OK && pieces.to.context == NULL)
      status = hl_pieces_begin(header->request->context, &grid, (*stream)->path, &pieces, error);
    if (status == HL_OK) pieces.to.path = (*stream)->path; /* the path of the stream that is currently open */
    if (status == HL_OK) status = hl_pieces_put(&pieces, piece, first, error);
    hl_volume_release(piece);
  }
  if (status == HL_OK && pieces.to.context == NULL)
    status = hl_fail(error, HL_ERROR_INPUT, "%s: all of its pieces are empty", (*stream)->path);
  if (status == HL_OK) status = hl_pieces_adopt(&pieces, volume, error);
  hl_pieces_close(&pieces);
  return status;
}

/* Reads the coordinates of a rectilinear grid, and places the volume's voxels at these coordinates. */
static hl_status place_rectilinear(hl_stream **stream, vti_header *header, hl_volume **volume,
                                   hl_error *error) {
  hl_context *context = header->request->context;
  double *coordinates[3] = {NULL, NULL, NULL};
  size_t counts[3];
  hl_status status = HL_OK;
  for (int axis = 0; axis < 3 && status == HL_OK; axis++) {
    const hl_vtk_array *array = &header->grid.coordinates[axis];
    hl_number_code code = {.text = array->encoding == HL_VTK_ASCII, .big_endian = header->xml.big_endian};
    header->xml.stream = *stream;
    counts[axis] = (size_t)(header->grid.extent[2 * axis + 1] - header->grid.extent[2 * axis]) + 1;
    status = header->grid.coordinate_count == 3
                 ? hl_vtk_xml_type(&header->xml, array->type, &code.type, error)
                 : hl_fail(error, HL_ERROR_INPUT,
                           "%s: a rectilinear grid without three arrays "
                           "of Coordinates",
                           (*stream)->path);
    if (status == HL_OK)
      status = hl_vtk_xml_open_array(stream, &header->xml, array,
                                     counts[axis] * hl_voxel_type_bytes(code.type), error);
    if (status == HL_OK) status = hl_read_numbers(*stream, &code, counts[axis], &coordinates[axis], error);
  }
  if (status == HL_OK) {
    bool of_cells = header->request->arrays[header->request->chosen].of_cells;
    status = hl_rectilinear_place(volume, coordinates, counts, of_cells, (*stream)->path, error);
  } else {
    hl_volume_release(*volume);
    *volume = NULL;
  }
  for (int axis = 0; axis < 3; axis++) hl_release(context, coordinates[axis]);
  return status;
}

/* ---- pieces in files of their own ---- */

static hl_status load_image(hl_stream **stream, hl_load_request *request, bool nested, hl_volume **volume,
                            hl_error *error);

/* Reads one of several files as a volume. part: the request to load this file; the caller owns the request's
 * lists. */
static hl_status read_part(const vti_header *header, size_t index, hl_load_request *part, hl_volume **volume,
                           hl_error *error) {
  hl_stream *stream = NULL;
  hl_status status = hl_stream_open_memory(part->context, header->xml.stream->path, "", 0, &stream, error);
  if (status == HL_OK) status = hl_stream_switch(&stream, header->pieces[index].source, error);
  if (status == HL_OK) status = hl_stream_unpack(&stream, error);
  if (status == HL_OK) status = load_image(&stream, part, true, volume, error);
  hl_stream_close(stream);
  return status;
}

/* The grid of a volume that consists of several files. The grid's voxel type is the type of the first file's
 * volume. of_cells: whether the first file's values belong to cells. */
static hl_volume_description grid_of_parts(const vti_header *header, const hl_volume *part, bool of_cells) {
  hl_volume_description grid;
  hl_volume_description_defaults(&grid);
  make_grid(header, header->grid.extent, of_cells, &grid);
  grid.type = part->type;
  for (int axis = 0; axis < 3 && header->request->spacing[0] > 0; axis++) {
    double length = vec3_length(vec3_of(grid.axis[axis]));
    for (int row = 0; row < 3; row++) grid.axis[axis][row] *= header->request->spacing[axis] / length;
  }
  return grid;
}

static hl_status read_parts(const vti_header *header, hl_volume **volume, hl_error *error) {
  hl_load_request *request = header->request;
  hl_pieces pieces = {.to = {.context = NULL}};
  hl_status status = HL_OK;
  if (!header->grid.has_extent || header->piece_count == 0)
    return hl_fail(error, HL_ERROR_INPUT, "%s: the file has no WholeExtent, or no Piece",
                   header->xml.stream->path);
  for (size_t n = 0; n < header->piece_count && status == HL_OK; n++) {
    if (is_empty(&header->pieces[n])) continue;
    hl_volume *piece = NULL;
    hl_load_request part = {.context = request->context,
                            .component = request->component,
                            .time = -1,
                            .channel = -1,
                            .level = -1,
                            .selection = {1, 1, 1, 0, 0, 0, 0}};
    bool first = pieces.to.context == NULL;
    size_t at[3];
    part.array = first ? request->array : request->arrays[request->chosen].name;
    status = read_part(header, n, &part, &piece, error);
    if (status == HL_OK && first) { /* the array and the component that were chosen in the first file are read
                                     * from all files */
      request->arrays = part.arrays;
      request->array_count = part.array_count;
      request->chosen = part.chosen;
      request->chosen_component = part.chosen_component;
      memcpy(request->array_told, part.array_told, sizeof request->array_told);
      memcpy(request->component_told, part.component_told, sizeof request->component_told);
      hl_volume_description grid = grid_of_parts(header, piece, part.arrays[part.chosen].of_cells);
      status = hl_volume_check_grid(&grid, header->xml.stream->path, error);
      if (status == HL_OK)
        status = hl_pieces_begin(request->context, &grid, header->xml.stream->path, &pieces, error);
    } else {
      hl_arrays_release(request->context, part.arrays, part.array_count);
    }
    place_of(header, &header->pieces[n], at);
    if (status == HL_OK) status = hl_pieces_put(&pieces, piece, at, error);
    hl_volume_release(piece);
  }
  if (status == HL_OK && pieces.to.context == NULL)
    status = hl_fail(error, HL_ERROR_INPUT, "%s: all of its pieces are empty", header->xml.stream->path);
  if (status == HL_OK) status = hl_pieces_adopt(&pieces, volume, error);
  hl_pieces_close(&pieces);
  return status;
}

/* ---- all steps together ---- */

/* Completes the list of pieces. A file without any Piece gets a piece with the whole extent. If the file has
 * one piece, the whole extent is set to the extent of this piece, unless further pieces may have been cut
 * off. */
static hl_status finish_pieces(vti_header *header, hl_error *error) {
  if (header->piece_count == 0 && header->grid.has_extent) {
    hl_status status = grow(header, (void **)&header->pieces, 0, &header->piece_room, sizeof *header->pieces,
                            PIECES_MOST, error);
    if (status != HL_OK) return status;
    header->pieces[header->piece_count++] = (vti_piece){.source = NULL};
    memcpy(header->pieces[0].extent, header->grid.extent, sizeof header->grid.extent);
  }
  if (header->piece_count != 1 || header->kind == KIND_PARALLEL) return HL_OK;
  const bool is_part = memcmp(header->grid.extent, header->pieces[0].extent, sizeof header->grid.extent) != 0;
  hl_status status = is_part ? hl_vtk_xml_check_end(&header->xml, error) : HL_OK;
  if (status != HL_OK) return status;
  memcpy(header->grid.extent, header->pieces[0].extent, sizeof header->grid.extent);
  if (is_empty(&header->pieces[0]))
    return hl_fail(error, HL_ERROR_INPUT, "%s: its Extent is empty", header->xml.stream->path);
  return HL_OK;
}

static hl_status read_image(hl_stream **stream, vti_header *header, bool nested, hl_volume **volume,
                            hl_error *error) {
  if (header->kind == KIND_PARALLEL && nested)
    return hl_fail(error, HL_ERROR_INPUT, "%s: a list of files that another list names", (*stream)->path);
  if (header->kind == KIND_PARALLEL) return read_parts(header, volume, error);
  if (header->kind == KIND_RECTILINEAR && header->piece_count > 1)
    return hl_fail(error, HL_ERROR_UNSUPPORTED, "%s: a rectilinear grid in several pieces: save it as one",
                   (*stream)->path);
  hl_status status = choose_array(header, error);
  if (status == HL_OK && header->pieces == NULL)
    return hl_fail(error, HL_ERROR_INPUT, "%s: the file has no WholeExtent or Extent", (*stream)->path);
  if (status == HL_OK)
    status = header->piece_count > 1 ? read_pieces(stream, header, volume, error)
                                     : read_piece(stream, header, 0, volume, error);
  bool places = header->kind == KIND_RECTILINEAR && !(header->request->spacing[0] > 0);
  return status == HL_OK && places ? place_rectilinear(stream, header, volume, error) : status;
}

static hl_status load_image(hl_stream **stream, hl_load_request *request, bool nested, hl_volume **volume,
                            hl_error *error) {
  vti_header header = {.xml.stream = *stream,
                       .grid.spacing = {1, 1, 1},
                       .grid.direction = {1, 0, 0, 0, 1, 0, 0, 0, 1},
                       .active_points = -1,
                       .active_cells = -1,
                       .request = request};
  hl_status status = hl_vtk_xml_read_tags(&header.xml, read_tag, &header, error);
  if (status == HL_OK) status = finish_pieces(&header, error);
  if (status == HL_OK) status = read_image(stream, &header, nested, volume, error);
  for (size_t n = 0; n < header.piece_count; n++) hl_release(request->context, header.pieces[n].source);
  hl_release(request->context, header.pieces);
  hl_release(request->context, header.entries);
  return status;
}

static hl_status load(hl_stream **stream, hl_load_request *request, hl_volume **volume, hl_error *error) {
  return load_image(stream, request, false, volume, error);
}

const hl_format hl_format_vti = {
    .name = "VTK .vti",
    .endings = {".vti", ".pvti", ".vtr"},
    .beginning = "\"<VTKFile\"",
    .has_content = hl_vtk_xml_has_content,
    .load = load,
};
