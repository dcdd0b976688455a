/* volume/vti.c - VTK XML image data (.vti): ascii, base64 and appended arrays, plain or in zlib blocks.
 *
 * A first pass over the tags lists the arrays. The volume is the array that the caller named; without a name
 * the active scalars, else the first array of one component at points, else at cells. A second pass goes to
 * the values. World: Origin + Direction * (Spacing * index), where indices count from the extent's start. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "volume/decoders.h"
#include "volume/format.h"
#include "volume/text.h"
#include "volume/xml.h"

enum { NAME_BYTES = 256 };

typedef enum section { SECTION_NONE, SECTION_POINTS, SECTION_CELLS } section;
typedef enum array_format { FORMAT_ASCII, FORMAT_BINARY, FORMAT_APPENDED } array_format;

typedef struct vti_array {
  char type[NAME_BYTES];
  array_format format;
  uint64_t
      place; /* offset of the values: in the file for inline values, in the appended data for appended ones */
} vti_array;

typedef struct vti_header {
  hl_stream *stream;
  bool big_endian, compressed;
  size_t header_bytes; /* bytes of each integer before binary values */
  double extent[6];    /* first and last point index along x, y, z */
  double origin[3], spacing[3], direction[9];
  bool has_extent, has_piece;
  bool is_whole; /* the section's last tag or the appended data has been seen */
  section section;
  char active[NAME_BYTES];         /* name of the section's active scalars */
  vti_array *arrays;               /* owned; [HL_ARRAYS_MOST]; null before the first */
  int active_points, active_cells; /* index of the active scalars; -1: none */
  hl_load_request *request;        /* lists the same arrays */
  uint64_t appended;               /* offset in the file of the appended data's first byte; 0: none */
  bool appended_is_base64;
} vti_header;

static bool has_content(const unsigned char *bytes, size_t length) {
  size_t n = length >= 3 && memcmp(bytes, "\xef\xbb\xbf", 3) == 0 ? 3 : 0; /* byte order mark */
  while (n < length && hl_is_space((char)bytes[n])) n++;
  return (length - n >= 5 && memcmp(bytes + n, "<?xml", 5) == 0) ||
         (length - n >= 8 && memcmp(bytes + n, "<VTKFile", 8) == 0);
}

static hl_status refuse(const vti_header *header, hl_status code, const char *what, const char *value,
                        hl_error *error) {
  char shown[HL_PRINTABLE_BYTES];
  return hl_fail_offset(error, code, (int64_t)header->stream->offset, "%s, before byte %llu: %s \"%s\"%s",
                        header->stream->path, (unsigned long long)header->stream->offset, what,
                        hl_text_printable(shown, value),
                        code == HL_ERROR_UNSUPPORTED ? " is not read" : " is impossible");
}

static hl_status read_file_tag(vti_header *header, const hl_xml_tag *tag, hl_error *error) {
  const char *type = hl_xml_attribute(tag, "type"), *order = hl_xml_attribute(tag, "byte_order");
  const char *header_type = hl_xml_attribute(tag, "header_type"),
             *compressor = hl_xml_attribute(tag, "compressor");
  if (type == NULL || strcmp(type, "ImageData") != 0)
    return refuse(header, HL_ERROR_UNSUPPORTED, "a VTKFile of type", type == NULL ? "" : type, error);
  if (order != NULL && strcmp(order, "BigEndian") != 0 && strcmp(order, "LittleEndian") != 0)
    return refuse(header, HL_ERROR_INPUT, "byte_order", order, error);
  header->big_endian = order != NULL && strcmp(order, "BigEndian") == 0;
  if (header_type != NULL && strcmp(header_type, "UInt32") != 0 && strcmp(header_type, "UInt64") != 0)
    return refuse(header, HL_ERROR_INPUT, "header_type", header_type, error);
  header->header_bytes = header_type != NULL && strcmp(header_type, "UInt64") == 0 ? 8 : 4;
  header->compressed = compressor != NULL && *compressor != 0;
  if (header->compressed && strcmp(compressor, "vtkZLibDataCompressor") != 0)
    return refuse(header, HL_ERROR_UNSUPPORTED, "data compressed by", compressor, error);
  return HL_OK;
}

static hl_status read_numbers(const vti_header *header, const hl_xml_tag *tag, const char *name,
                              double *numbers, int count, hl_error *error) {
  const char *value = hl_xml_attribute(tag, name);
  if (value == NULL || hl_text_numbers(value, numbers, count) == count) return HL_OK;
  return refuse(header, HL_ERROR_INPUT, name, value, error);
}

static hl_status read_extent(vti_header *header, const hl_xml_tag *tag, const char *name, hl_error *error) {
  const char *value = hl_xml_attribute(tag, name);
  if (value == NULL) return HL_OK;
  hl_status status = read_numbers(header, tag, name, header->extent, 6, error);
  for (int axis = 0; status == HL_OK && axis < 3; axis++) {
    double first = header->extent[2 * axis], last = header->extent[2 * axis + 1];
    if (first != floor(first) || last != floor(last) || !(first >= -2147483648.0) ||
        !(last <= 2147483647.0) || last < first)
      status = refuse(header, HL_ERROR_INPUT, name, value, error);
  }
  header->has_extent = true;
  return status;
}

static hl_status read_image_tag(vti_header *header, const hl_xml_tag *tag, hl_error *error) {
  hl_status status = read_extent(header, tag, "WholeExtent", error);
  if (status == HL_OK) status = read_numbers(header, tag, "Origin", header->origin, 3, error);
  if (status == HL_OK) status = read_numbers(header, tag, "Spacing", header->spacing, 3, error);
  if (status == HL_OK) status = read_numbers(header, tag, "Direction", header->direction, 9, error);
  return status;
}

static hl_status read_piece_tag(vti_header *header, const hl_xml_tag *tag, hl_error *error) {
  if (header->has_piece)
    return hl_fail(error, HL_ERROR_UNSUPPORTED, "%s: images in several pieces are not read: save it as one",
                   header->stream->path);
  header->has_piece = true;
  return read_extent(header, tag, "Extent", error);
}

static void begin_section(vti_header *header, const hl_xml_tag *tag, section which) {
  const char *active = hl_xml_attribute(tag, "Scalars");
  header->section = tag->is_end ? SECTION_NONE : which;
  header->active[0] = 0;
  if (active != NULL && strlen(active) < NAME_BYTES) strcpy(header->active, active);
}

static bool find_type(const char *name, hl_voxel_type *type) {
  static const hl_named_type types[] = {
      {"UInt8", HL_VOXEL_U8},   {"Int8", HL_VOXEL_I8},   {"UInt16", HL_VOXEL_U16},  {"Int16", HL_VOXEL_I16},
      {"UInt32", HL_VOXEL_U32}, {"Int32", HL_VOXEL_I32}, {"Float32", HL_VOXEL_F32}, {"Float64", HL_VOXEL_F64},
      {"UInt64", HL_VOXEL_U64}, {"Int64", HL_VOXEL_I64}};
  return hl_find_type(types, sizeof types / sizeof *types, name, type);
}

/* Reads where an array's values are and how they are encoded. */
static hl_status read_array_place(const vti_header *header, const hl_xml_tag *tag, vti_array *array,
                                  hl_error *error) {
  const char *type = hl_xml_attribute(tag, "type"), *format = hl_xml_attribute(tag, "format");
  const char *offset = hl_xml_attribute(tag, "offset");
  size_t appended = 0;
  *array = (vti_array){.place = header->stream->offset};
  if (type == NULL || strlen(type) >= NAME_BYTES)
    return refuse(header, HL_ERROR_INPUT, "a DataArray's type", type == NULL ? "" : type, error);
  strcpy(array->type, type);
  array->format = format == NULL || strcmp(format, "ascii") == 0 ? FORMAT_ASCII
                  : strcmp(format, "appended") == 0              ? FORMAT_APPENDED
                                                                 : FORMAT_BINARY;
  if (array->format == FORMAT_BINARY && strcmp(format, "binary") != 0)
    return refuse(header, HL_ERROR_INPUT, "a DataArray's format", format, error);
  if (array->format != FORMAT_APPENDED) return HL_OK;
  if (offset == NULL || hl_text_sizes(offset, &appended, 1) != 1)
    return refuse(header, HL_ERROR_INPUT, "an appended DataArray's offset", offset == NULL ? "" : offset,
                  error);
  array->place = appended;
  return HL_OK;
}

static hl_status read_array_tag(vti_header *header, const hl_xml_tag *tag, hl_error *error) {
  if (header->section == SECTION_NONE) return HL_OK;
  const char *name = hl_xml_attribute(tag, "Name"), *stated = hl_xml_attribute(tag, "NumberOfComponents");
  vti_array array;
  size_t components = 1, index = header->request->array_count;
  hl_voxel_type type = 0;
  bool cells = header->section == SECTION_CELLS;
  hl_status status = read_array_place(header, tag, &array, error);
  if (status != HL_OK) return status;
  if (stated != NULL && (hl_text_sizes(stated, &components, 1) != 1 || components == 0))
    return refuse(header, HL_ERROR_INPUT, "NumberOfComponents", stated, error);
  find_type(array.type, &type);
  status = hl_arrays_add(header->request, name != NULL ? name : "", components, type, cells, error);
  if (status != HL_OK || header->request->array_count == index) return status;
  if (header->arrays == NULL) {
    header->arrays = hl_allocate(header->request->context, HL_ARRAYS_MOST, sizeof *header->arrays);
    if (header->arrays == NULL)
      return hl_fail_memory(error, HL_ARRAYS_MOST * sizeof array, header->stream->path);
  }
  header->arrays[index] = array;
  int *active = cells ? &header->active_cells : &header->active_points;
  if (header->active[0] != 0 && name != NULL && strcmp(name, header->active) == 0 && *active < 0)
    *active = (int)index;
  return HL_OK;
}

/* The appended data begin after the first '_'. */
static hl_status read_appended_tag(vti_header *header, const hl_xml_tag *tag, hl_error *error) {
  const char *encoding = hl_xml_attribute(tag, "encoding");
  header->appended_is_base64 = encoding == NULL || strcmp(encoding, "base64") == 0;
  if (!header->appended_is_base64 && strcmp(encoding, "raw") != 0)
    return refuse(header, HL_ERROR_INPUT, "the encoding of AppendedData", encoding, error);
  for (;;) {
    const unsigned char *bytes;
    size_t available;
    hl_status status = hl_stream_peek(header->stream, 1, &bytes, &available, error);
    if (status != HL_OK) return status;
    if (available == 0 || (bytes[0] != '_' && !hl_is_space((char)bytes[0])))
      return hl_fail_offset(error, HL_ERROR_INPUT, (int64_t)header->stream->offset,
                            "%s, byte %llu: appended data must begin with '_'", header->stream->path,
                            (unsigned long long)header->stream->offset);
    bool begins = bytes[0] == '_';
    hl_stream_take(header->stream, 1);
    if (begins) break;
  }
  header->appended = header->stream->offset;
  return HL_OK;
}

static hl_status read_tag(vti_header *header, const hl_xml_tag *tag, hl_error *error) {
  if (!tag->is_start) {
    if (strcmp(tag->name, "PointData") == 0 || strcmp(tag->name, "CellData") == 0)
      header->section = SECTION_NONE;
    if (strcmp(tag->name, "VTKFile") == 0) header->is_whole = true;
    return HL_OK;
  }
  if (header->header_bytes == 0 && strcmp(tag->name, "VTKFile") != 0)
    return refuse(header, HL_ERROR_UNSUPPORTED, "an XML file whose first element is", tag->name, error);
  if (strcmp(tag->name, "VTKFile") == 0) return read_file_tag(header, tag, error);
  if (strcmp(tag->name, "ImageData") == 0) return read_image_tag(header, tag, error);
  if (strcmp(tag->name, "Piece") == 0) return read_piece_tag(header, tag, error);
  if (strcmp(tag->name, "DataArray") == 0) return read_array_tag(header, tag, error);
  if (strcmp(tag->name, "AppendedData") == 0) return read_appended_tag(header, tag, error);
  if (strcmp(tag->name, "PointData") == 0) begin_section(header, tag, SECTION_POINTS);
  if (strcmp(tag->name, "CellData") == 0) begin_section(header, tag, SECTION_CELLS);
  return HL_OK;
}

static hl_status read_tags(vti_header *header, hl_error *error) {
  hl_xml_tag tag;
  bool ended = false;
  while (!ended && header->appended == 0) {
    hl_status status = hl_xml_next_tag(header->stream, &tag, &ended, error);
    if (status == HL_OK && !ended) status = read_tag(header, &tag, error);
    if (status != HL_OK) return status;
  }
  return HL_OK;
}

static hl_status read_type(const vti_header *header, const char *name, hl_voxel_type *type, hl_error *error) {
  if (find_type(name, type)) return HL_OK;
  bool known = hl_text_is_one_of(name, "String|Bit");
  return refuse(header, known ? HL_ERROR_UNSUPPORTED : HL_ERROR_INPUT, "a DataArray of type", name, error);
}

static void make_grid(const vti_header *header, bool cells, hl_volume_description *grid) {
  for (int axis = 0; axis < 3; axis++) {
    size_t points = (size_t)(header->extent[2 * axis + 1] - header->extent[2 * axis]) + 1;
    grid->dimensions[axis] = cells && points > 1 ? points - 1 : points;
    grid->origin[axis] = header->origin[axis];
    for (int row = 0; row < 3; row++)
      grid->axis[axis][row] = header->direction[3 * row + axis] * header->spacing[axis];
  }
  for (int axis = 0; axis < 3; axis++) {
    bool between = cells && header->extent[2 * axis + 1] > header->extent[2 * axis];
    double first = header->extent[2 * axis] + (between ? 0.5 : 0); /* cells are centred between points */
    for (int row = 0; row < 3; row++) grid->origin[row] += first * grid->axis[axis][row];
  }
}

/* Opens the file again and skips to the first byte of the array's encoded values. */
static hl_status go_to_array(hl_stream **stream, const vti_header *header, const vti_array *array,
                             hl_error *error) {
  uint64_t place = array->place;
  if (array->format == FORMAT_APPENDED) {
    if (header->appended == 0)
      return hl_fail(error, HL_ERROR_INPUT,
                     "%s: the file ends without the AppendedData that its DataArray refers to",
                     (*stream)->path);
    if (__builtin_add_overflow(place, header->appended, &place))
      return hl_fail(error, HL_ERROR_INPUT, "%s: impossible offset %llu of a DataArray", (*stream)->path,
                     (unsigned long long)array->place);
  }
  hl_status status = hl_stream_restart(stream, error);
  if (status == HL_OK) status = hl_stream_inflate_if_gzip(stream, error);
  return status == HL_OK ? hl_stream_skip(*stream, place, error) : status;
}

/* Reads the byte count in front of uncompressed values. */
static hl_status read_length(hl_stream *stream, const vti_header *header, uint64_t promised,
                             hl_error *error) {
  unsigned char bytes[8];
  hl_status status = hl_stream_read_all(stream, bytes, header->header_bytes, error);
  if (status != HL_OK) return status;
  uint64_t length = 0;
  for (size_t n = 0; n < header->header_bytes; n++)
    length = length << 8 | bytes[header->big_endian ? n : header->header_bytes - 1 - n];
  if (length == promised) return HL_OK;
  return hl_fail_offset(error, HL_ERROR_INPUT, (int64_t)stream->offset,
                        "%s: the extent promises %llu bytes of voxels, the array has %llu", stream->path,
                        (unsigned long long)promised, (unsigned long long)length);
}

static hl_status decode_array(hl_stream **stream, const vti_header *header, const vti_array *array,
                              const hl_payload *payload, hl_error *error) {
  hl_status status = HL_OK;
  bool is_base64 = array->format == FORMAT_BINARY ||
                   (array->format == FORMAT_APPENDED && header->appended_is_base64);
  if (array->format == FORMAT_ASCII) return HL_OK;
  if (is_base64) status = hl_stream_push_base64(stream, error);
  uint64_t promised = hl_payload_bytes(payload);
  if (status != HL_OK) return status;
  return header->compressed
             ? hl_stream_push_vtk_blocks(stream, header->header_bytes, header->big_endian, promised, error)
             : read_length(*stream, header, promised, error);
}

/* The index of the active scalars at points; if no array at points has one component, of the active scalars
 * at cells. */
static int active_array(const vti_header *header) {
  if (header->active_points >= 0) return header->active_points;
  for (size_t n = 0; n < header->request->array_count; n++)
    if (!header->request->arrays[n].of_cells && header->request->arrays[n].components == 1) return -1;
  return header->active_cells;
}

static hl_status choose_array(const vti_header *header, hl_error *error) {
  if (header->request->array_count > 0 && header->has_extent) {
    hl_status status = hl_arrays_choose(header->request, header->stream->path, active_array(header), error);
    const hl_array_entry *chosen = &header->request->arrays[header->request->chosen];
    bool is_last_resort = header->request->array == NULL && (chosen->of_cells || chosen->components > 1);
    if (status == HL_OK && is_last_resort && !header->is_whole && header->appended == 0)
      return hl_fail(error, HL_ERROR_INPUT, "%s: the file is cut short: it ends before </VTKFile>",
                     header->stream->path);
    return status;
  }
  return hl_fail(error, HL_ERROR_INPUT, "%s: the file has no %s", header->stream->path,
                 header->has_extent ? "DataArray in PointData or CellData" : "WholeExtent or Extent");
}

/* Goes to the chosen array and reads it as the volume. */
static hl_status read_array(hl_stream **stream, const vti_header *header, hl_volume **volume,
                            hl_error *error) {
  hl_load_request *request = header->request;
  const vti_array *array = &header->arrays[request->chosen];
  const hl_array_entry *entry = &request->arrays[request->chosen];
  hl_payload payload;
  hl_payload_defaults(&payload);
  payload.trailing = HL_TRAILING_IGNORED;
  hl_status status = read_type(header, array->type, &payload.grid.type, error);
  if (status != HL_OK) return status;
  make_grid(header, entry->of_cells, &payload.grid);
  payload.big_endian = header->big_endian;
  payload.text = array->format == FORMAT_ASCII;
  payload.components = entry->components;
  payload.block = 1;
  if (payload.grid.type == HL_VOXEL_U8) payload.colors = HL_COLORS_MEANT; /* as VTK's mappers take bytes */
  status = hl_volume_check_grid(&payload.grid, (*stream)->path, error);
  if (status == HL_OK) status = hl_component_choose(request, (*stream)->path, false, &payload, error);
  if (status == HL_OK) status = go_to_array(stream, header, array, error);
  if (status == HL_OK) status = decode_array(stream, header, array, &payload, error);
  return status == HL_OK ? hl_payload_read(*stream, &payload, request->spacing, volume, error) : status;
}

static hl_status load(hl_stream **stream, hl_load_request *request, hl_volume **volume, hl_error *error) {
  vti_header header = {.stream = *stream,
                       .spacing = {1, 1, 1},
                       .direction = {1, 0, 0, 0, 1, 0, 0, 0, 1},
                       .active_points = -1,
                       .active_cells = -1,
                       .request = request};
  hl_status status = read_tags(&header, error);
  if (status == HL_OK) status = choose_array(&header, error);
  if (status == HL_OK) status = read_array(stream, &header, volume, error);
  hl_release(request->context, header.arrays);
  return status;
}

const hl_format hl_format_vti = {
    .name = "VTK .vti",
    .endings = {".vti"},
    .beginning = "\"<VTKFile\"",
    .has_content = has_content,
    .load = load,
};
