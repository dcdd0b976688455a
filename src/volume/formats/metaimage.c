/* volume/formats/metaimage.c - reads MetaImage files: .mha (voxels in the same file) and .mhd (voxels in
 * another file).
 *
 * The header consists of lines "Key = value", of which ElementDataFile is the last. World: physical = Offset
 * + sum over axes of index * spacing * row of TransformMatrix, as ITK reads the matrix. */
#include <math.h>
#include <string.h>

#include "core/context.h"
#include "core/memory.h"
#include "volume/formats/format.h"
#include "volume/io/decoders.h"
#include "volume/io/file_list.h"
#include "volume/io/text.h"

enum { MOST_AXES = 10, NAME_BYTES = 1024 };

typedef struct meta_header {
  const hl_stream *stream;
  int line;
  struct {
    int dimension; /* 0 if not yet stated */
    size_t size[MOST_AXES];
    double spacing[MOST_AXES], element_size[MOST_AXES], offset[MOST_AXES];
    double matrix[MOST_AXES * MOST_AXES]; /* row `a` of the matrix is the direction in the world of index axis
                                           * `a` */
    bool has_sizes, has_spacing, has_element_size, has_offset, has_matrix, is_anatomical;
  } grid;
  hl_voxel_type type; /* 0 if not yet stated */
  size_t channels, header_bytes;
  bool header_is_rest; /* whether HeaderSize is -1, which means that the voxels are the last bytes of the
                        * file */
  bool big_endian, compressed, text;
  double slope, intercept;
  char data_file[NAME_BYTES];
  hl_file_list files; /* owned; the list of several data files */
  bool is_list;       /* whether the names of data files follow the header */
} meta_header;

static bool has_content(const unsigned char *bytes, size_t length) {
  static const char *const keys[] = {"ObjectType", "NDims",   "Comment",    "ObjectSubType",
                                     "ID",         "DimSize", "BinaryData", "ElementType"};
  for (size_t n = 0; n < sizeof keys / sizeof *keys; n++) {
    size_t place = strlen(keys[n]);
    if (length <= place || memcmp(bytes, keys[n], place) != 0) continue;
    while (place < length && (bytes[place] == ' ' || bytes[place] == '\t')) place++;
    if (place < length && bytes[place] == '=') return true;
  }
  return false;
}

static hl_status refuse(const meta_header *header, const char *key, const char *value, hl_error *error) {
  char shown[HL_PRINTABLE_BYTES];
  return HL_FAIL_LINE(error, HL_ERROR_INPUT, header->stream, header->line, "%s cannot be \"%s\"", key,
                      hl_text_printable(shown, value));
}

static bool read_flag(const char *value, bool *flag) {
  *flag = hl_text_equal(value, "True") || hl_text_equal(value, "1");
  return *flag || hl_text_equal(value, "False") || hl_text_equal(value, "0");
}

static hl_status read_type(meta_header *header, const char *value, hl_error *error) {
  static const hl_named_type types[] = {
      {"MET_UCHAR", HL_VOXEL_U8},           {"MET_CHAR", HL_VOXEL_I8},
      {"MET_USHORT", HL_VOXEL_U16},         {"MET_SHORT", HL_VOXEL_I16},
      {"MET_UINT|MET_ULONG", HL_VOXEL_U32}, {"MET_INT|MET_LONG", HL_VOXEL_I32},
      {"MET_FLOAT", HL_VOXEL_F32},          {"MET_DOUBLE", HL_VOXEL_F64},
      {"MET_ULONG_LONG", HL_VOXEL_U64},     {"MET_LONG_LONG", HL_VOXEL_I64}};
  if (hl_find_type(types, sizeof types / sizeof *types, value, &header->type)) return HL_OK;
  char shown[HL_PRINTABLE_BYTES];
  return HL_FAIL_LINE(error, hl_text_starts(value, "MET_") ? HL_ERROR_UNSUPPORTED : HL_ERROR_INPUT,
                      header->stream, header->line,
                      "ElementType \"%s\" is not read: MET_UCHAR, MET_SHORT, MET_FLOAT and the like are: "
                      "save it as one of these",
                      hl_text_printable(shown, value));
}

static hl_status read_numbers(meta_header *header, const char *key, const char *value, double *numbers,
                              int count, bool *present, hl_error *error) {
  if (header->grid.dimension == 0)
    return HL_FAIL_LINE(error, HL_ERROR_INPUT, header->stream, header->line, "NDims must come before %s",
                        key);
  if (hl_text_numbers(value, numbers, count) != count) return refuse(header, key, value, error);
  *present = true;
  return HL_OK;
}

static hl_status read_dimension(meta_header *header, const char *key, const char *value, hl_error *error) {
  size_t dimension;
  if (hl_text_sizes(value, &dimension, 1) != 1 || dimension < 1 || dimension > MOST_AXES)
    return refuse(header, key, value, error);
  header->grid.dimension = (int)dimension;
  return HL_OK;
}

static hl_status read_data_file(meta_header *header, const char *key, const char *value, hl_error *error) {
  header->is_list = strncmp(value, "LIST", 4) == 0 && (value[4] == 0 || hl_is_space(value[4]));
  if (strchr(value, '%') != NULL) {
    bool sound;
    hl_status status = hl_file_list_pattern(&header->files, value, &sound, error);
    if (status != HL_OK) return status;
    if (sound) value = "LIST";
  }
  if (*value == 0 || strlen(value) >= sizeof header->data_file) return refuse(header, key, value, error);
  strcpy(header->data_file, value);
  return HL_OK;
}

static hl_status read_key(meta_header *header, const char *key, const char *value, hl_error *error) {
  int n = header->grid.dimension;
  bool sound = true, flag, unused;
  if (hl_text_equal(key, "NDims")) return read_dimension(header, key, value, error);
  if (hl_text_equal(key, "ElementType")) return read_type(header, value, error);
  if (hl_text_equal(key, "ElementDataFile")) return read_data_file(header, key, value, error);
  if (hl_text_equal(key, "ElementSpacing"))
    return read_numbers(header, key, value, header->grid.spacing, n, &header->grid.has_spacing, error);
  if (hl_text_equal(key, "ElementSize"))
    return read_numbers(header, key, value, header->grid.element_size, n, &header->grid.has_element_size,
                        error);
  if (hl_text_is_one_of(key, "Offset|Position|Origin"))
    return read_numbers(header, key, value, header->grid.offset, n, &header->grid.has_offset, error);
  if (hl_text_is_one_of(key, "TransformMatrix|Rotation|Orientation"))
    return read_numbers(header, key, value, header->grid.matrix, n * n, &header->grid.has_matrix, error);
  if (hl_text_equal(key, "ElementToIntensityFunctionSlope"))
    return read_numbers(header, key, value, &header->slope, 1, &unused, error);
  if (hl_text_equal(key, "ElementToIntensityFunctionOffset"))
    return read_numbers(header, key, value, &header->intercept, 1, &unused, error);
  if (hl_text_equal(key, "DimSize")) {
    sound = header->grid.has_sizes = n > 0 && hl_text_sizes(value, header->grid.size, MOST_AXES) == n;
  } else if (hl_text_equal(key, "ElementNumberOfChannels")) {
    sound = hl_text_sizes(value, &header->channels, 1) == 1;
  } else if (hl_text_is_one_of(key, "ElementByteOrderMSB|BinaryDataByteOrderMSB")) {
    sound = read_flag(value, &header->big_endian);
  } else if (hl_text_equal(key, "CompressedData")) {
    sound = read_flag(value, &header->compressed);
  } else if (hl_text_equal(key, "BinaryData")) {
    sound = read_flag(value, &flag);
    header->text = !flag;
  } else if (hl_text_equal(key, "HeaderSize")) {
    header->header_is_rest = hl_text_equal(value, "-1");
    sound = header->header_is_rest || hl_text_sizes(value, &header->header_bytes, 1) == 1;
  } else if (hl_text_equal(key, "AnatomicalOrientation")) {
    header->grid.is_anatomical = value[0] != 0 && strchr(value, '?') == NULL;
  } else if (hl_text_equal(key, "ObjectType")) {
    sound = hl_text_equal(value, "Image");
  }
  return sound ? HL_OK : refuse(header, key, value, error);
}

static hl_status read_header(hl_stream *stream, meta_header *header, hl_error *error) {
  char line[HL_LINE_BYTES], shown[HL_PRINTABLE_BYTES];
  header->stream = stream;
  header->channels = 1;
  header->slope = 1;
  for (header->line = 1; header->data_file[0] == 0; header->line++) {
    bool ended;
    hl_status status = hl_stream_line(stream, line, &ended, error);
    if (status != HL_OK) return status;
    if (ended)
      return HL_FAIL_LINE(error, HL_ERROR_INPUT, stream, header->line, "%s",
                          "the file ends without ElementDataFile, which must be the header's last key");
    char *equals = strpbrk(line, "=:");
    if (equals == NULL && *hl_text_trim(line) == 0) continue;
    if (equals == NULL)
      return HL_FAIL_LINE(error, HL_ERROR_INPUT, stream, header->line, "expected \"Key = value\", not \"%s\"",
                          hl_text_printable(shown, line));
    *equals = 0;
    status = read_key(header, hl_text_trim(line), hl_text_trim(equals + 1), error);
    if (status != HL_OK) return status;
  }
  for (bool ended = false; header->is_list && !ended; header->line++) {
    hl_status status = hl_stream_line(stream, line, &ended, error);
    const char *name = status == HL_OK && !ended ? hl_text_trim(line) : "";
    if (status == HL_OK && *name != 0) status = hl_file_list_add(&header->files, name, error);
    if (status != HL_OK) return status;
  }
  if (header->type != 0 && header->grid.has_sizes) return HL_OK;
  return hl_fail(error, HL_ERROR_INPUT, "%s: the header has no %s, which MetaImage needs", stream->path,
                 header->grid.has_sizes ? "ElementType" : "DimSize");
}

static void make_grid(const meta_header *header, hl_volume_description *grid) {
  const double *spacing = header->grid.has_spacing        ? header->grid.spacing
                          : header->grid.has_element_size ? header->grid.element_size
                                                          : NULL;
  for (int axis = 0; axis < 3 && axis < header->grid.dimension; axis++) {
    grid->dimensions[axis] = header->grid.size[axis];
    grid->origin[axis] = header->grid.has_offset ? header->grid.offset[axis] : 0;
    for (int row = 0; row < 3; row++) {
      double direction = row == axis;
      if (header->grid.has_matrix)
        direction = row < header->grid.dimension ? header->grid.matrix[axis * header->grid.dimension + row]
                                                 : 0;
      grid->axis[axis][row] = direction * (spacing != NULL ? spacing[axis] : 1);
    }
  }
  grid->type = header->type;
  /* positions are always in ITK's world (x to the left, y to the back), for all directions of the axes */
  grid->space = header->grid.is_anatomical ? HL_SPACE_LPS : HL_SPACE_UNKNOWN;
  grid->value_scale = header->slope;
  grid->value_offset = header->intercept;
}

/* Finds the components. Components are either the channels of a voxel, which lie side by side, or whole
 * volumes along a fourth or later axis, which follow each other. */
static hl_status find_components(const meta_header *header, bool *is_series, hl_payload *payload,
                                 hl_error *error) {
  size_t series = 1;
  for (int axis = 3; axis < header->grid.dimension; axis++)
    if (!hl_multiply(series, header->grid.size[axis], &series)) series = SIZE_MAX;
  *is_series = series != 1;
  if (series == 0 || header->channels == 0)
    return hl_fail(error, HL_ERROR_INPUT, "%s: the header states %s: each must be at least 1",
                   header->stream->path, series == 0 ? "a size of 0" : "0 channels");
  if (series > 1 && header->channels > 1)
    return hl_fail(error, HL_ERROR_UNSUPPORTED, "%s: %zu channels in each of %zu volumes: save one of them",
                   header->stream->path, header->channels, series);
  payload->components = series > 1 ? series : header->channels;
  payload->block = series > 1 ? payload->grid.dimensions[0] * payload->grid.dimensions[1] *
                                    payload->grid.dimensions[2]
                              : 1;
  return HL_OK;
}

/* Moves the stream to the first voxel. If ElementDataFile is "LOCAL", the voxels follow the header. A
 * separate data file may begin with a header of its own, which is skipped. */
static hl_status go_to_voxels(hl_stream **stream, meta_header *header, const hl_payload *payload,
                              hl_error *error) {
  if (header->is_list || header->files.count > 0) {
    hl_file_list *files = &header->files;
    if (header->text)
      return hl_fail(error, HL_ERROR_UNSUPPORTED, "%s: text in several files: save it as one",
                     (*stream)->path);
    files->byte_skip = header->header_bytes;
    files->skip_to_last = header->header_is_rest;
    files->packing = header->compressed ? HL_FILE_ZLIB : HL_FILE_RAW;
    return hl_stream_push_files(stream, files, hl_payload_bytes(payload), error);
  }
  bool local = hl_text_equal(header->data_file, "LOCAL");
  hl_status status = local ? HL_OK : hl_stream_switch(stream, header->data_file, error);
  if (status != HL_OK) return status;
  uint64_t skip = local ? 0 : header->header_bytes, most = hl_stream_at_most(*stream);
  if (header->header_is_rest) {
    if (header->compressed || header->text || most == UINT64_MAX)
      return hl_fail(error, HL_ERROR_INPUT, "%s: HeaderSize -1 needs plain binary voxels in an ordinary file",
                     (*stream)->path);
    skip = most > hl_payload_bytes(payload) ? most - hl_payload_bytes(payload) : 0;
  }
  status = hl_stream_skip(*stream, skip, error);
  return status == HL_OK && header->compressed ? hl_stream_push_inflate(stream, error) : status;
}

static hl_status load(hl_stream **stream, hl_load_request *request, hl_volume **volume, hl_error *error) {
  meta_header header = {.grid.dimension = 0, .files.context = request->context};
  hl_payload payload;
  hl_payload_defaults(&payload);
  hl_status status = read_header(*stream, &header, error);
  bool is_series = false;
  if (status == HL_OK) make_grid(&header, &payload.grid);
  if (status == HL_OK) status = hl_volume_check_grid(&payload.grid, (*stream)->path, error);
  if (status == HL_OK) status = find_components(&header, &is_series, &payload, error);
  if (status == HL_OK) status = hl_component_only(request, (*stream)->path, is_series, &payload, error);
  payload.big_endian = header.big_endian;
  payload.text = header.text;
  if (status == HL_OK) status = go_to_voxels(stream, &header, &payload, error);
  if (status == HL_OK) status = hl_payload_read(*stream, &payload, request->spacing, volume, error);
  hl_file_list_release(&header.files);
  return status;
}

const hl_format hl_format_metaimage = {
    .name = "MetaImage",
    .endings = {".mha", ".mhd"},
    .beginning = "\"ObjectType = Image\" or \"NDims = 3\"",
    .has_content = has_content,
    .load = load,
};
