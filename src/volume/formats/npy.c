/* volume/formats/npy.c - reads NumPy arrays, .npy format 1.0 to 3.0: axes [z][y][x], in C or Fortran order.
 *
 * The header consists of a mark, two bytes of version, the length of a text, and the text, which is a
 * dictionary of descr, fortran_order and shape. The axes of an array with two axes are [y][x]. If an array
 * has four axes, the last axis holds the components of voxels if its size is at most four; otherwise the
 * first axis is a series of volumes. Since the file states no positions, the spacing is 1 and the origin 0.
 * Source: NumPy's format specification, numpy/lib/format.py (NEP 1). */
#include <string.h>

#include "core/memory.h"
#include "volume/convert.h"
#include "volume/formats/format.h"
#include "volume/io/text.h"

enum { MARK_BYTES = 8, TEXT_BYTES_MOST = 65536, MOST_AXES = 4, MOST_COMPONENTS = 4 };

static const char mark[] = "\x93NUMPY";

typedef struct npy_header {
  const char *path;
  const char *at; /* position in the text, which ends with a zero byte */
  hl_voxel_type type;
  size_t numbers; /* the number of numbers in a value: 2 for complex values, else 1 */
  bool big_endian, fortran, has_type, has_order, has_shape;
  int axes;
  size_t shape[MOST_AXES];
} npy_header;

static bool has_content(const unsigned char *bytes, size_t length) {
  return length >= MARK_BYTES && memcmp(bytes, mark, sizeof mark - 1) == 0;
}

static hl_status refuse(const npy_header *header, hl_status code, const char *what, const char *text,
                        hl_error *error) {
  char shown[HL_PRINTABLE_BYTES];
  return hl_fail(error, code, "%s: %s \"%s\"", header->path, what, hl_text_printable(shown, text));
}

/* ---- the header's dictionary ---- */

static void skip_spaces(npy_header *header) {
  while (hl_is_space(*header->at)) header->at++;
}

static bool take(npy_header *header, const char *token) {
  skip_spaces(header);
  if (strncmp(header->at, token, strlen(token)) != 0) return false;
  header->at += strlen(token);
  return true;
}

/* Reads a text in single or double quotes. */
static bool take_text(npy_header *header, char *text, size_t capacity) {
  skip_spaces(header);
  char quote = *header->at;
  if (quote != '\'' && quote != '"') return false;
  const char *end = strchr(header->at + 1, quote);
  if (end == NULL || (size_t)(end - header->at) > capacity) return false;
  size_t length = (size_t)(end - header->at) - 1;
  memcpy(text, header->at + 1, length);
  text[length] = 0;
  header->at = end + 1;
  return true;
}

static hl_status take_type(npy_header *header, hl_error *error) {
  static const struct {
    const char *name;
    hl_voxel_type type;
    size_t numbers;
  } types[] = {{"b1", HL_VOXEL_U8, 1},  {"u1", HL_VOXEL_U8, 1},  {"i1", HL_VOXEL_I8, 1},
               {"u2", HL_VOXEL_U16, 1}, {"i2", HL_VOXEL_I16, 1}, {"u4", HL_VOXEL_U32, 1},
               {"i4", HL_VOXEL_I32, 1}, {"u8", HL_VOXEL_U64, 1}, {"i8", HL_VOXEL_I64, 1},
               {"f2", HL_VOXEL_F16, 1}, {"f4", HL_VOXEL_F32, 1}, {"f8", HL_VOXEL_F64, 1},
               {"c8", HL_VOXEL_F32, 2}, {"c16", HL_VOXEL_F64, 2}};
  char text[16] = "";
  if (!take_text(header, text, sizeof text))
    return refuse(header, HL_ERROR_UNSUPPORTED, "save it as an array of one plain type, such as '<f4', not",
                  header->at, error);
  header->big_endian = text[0] == '>' || (text[0] == '=' && __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__);
  for (size_t n = 0; n < sizeof types / sizeof *types && text[0] != 0; n++)
    if (strchr("<>|=", text[0]) != NULL && strcmp(text + 1, types[n].name) == 0) {
      header->type = types[n].type;
      header->numbers = types[n].numbers;
      header->has_type = true;
      return HL_OK;
    }
  return refuse(header, HL_ERROR_UNSUPPORTED,
                "save it as bool, integers, floats or complex numbers, not as elements of type", text, error);
}

static hl_status take_shape(npy_header *header, hl_error *error) {
  if (!take(header, "("))
    return refuse(header, HL_ERROR_INPUT, "expected a shape such as (64, 64, 64), not", header->at, error);
  header->axes = 0;
  while (!take(header, ")")) {
    skip_spaces(header);
    size_t length = strspn(header->at, "0123456789"), count = 0;
    if (length == 0 || length > 18)
      return refuse(header, HL_ERROR_INPUT, "expected a count in the shape, not", header->at, error);
    for (size_t n = 0; n < length; n++) count = 10 * count + (size_t)(header->at[n] - '0');
    if (header->axes == MOST_AXES)
      return hl_fail(error, HL_ERROR_UNSUPPORTED,
                     "%s: an array of more than four axes: save a part of three, [z][y][x]", header->path);
    header->shape[header->axes++] = count;
    header->at += length;
    skip_spaces(header);
    if (*header->at != ')' && !take(header, ","))
      return refuse(header, HL_ERROR_INPUT, "expected ',' or ')', not", header->at, error);
  }
  header->has_shape = true;
  return HL_OK;
}

static hl_status take_entry(npy_header *header, hl_error *error) {
  char key[20];
  const char *before = header->at;
  if (!take_text(header, key, sizeof key) || !take(header, ":"))
    return refuse(header, HL_ERROR_INPUT, "expected a key and ':', not", before, error);
  if (strcmp(key, "descr") == 0) return take_type(header, error);
  if (strcmp(key, "shape") == 0) return take_shape(header, error);
  if (strcmp(key, "fortran_order") != 0)
    return refuse(header, HL_ERROR_INPUT, "expected the keys descr, fortran_order and shape, not", key,
                  error);
  header->fortran = take(header, "True");
  header->has_order = header->fortran || take(header, "False");
  return header->has_order ? HL_OK
                           : refuse(header, HL_ERROR_INPUT, "expected True or False, not", header->at, error);
}

static hl_status parse(npy_header *header, hl_error *error) {
  if (!take(header, "{"))
    return refuse(header, HL_ERROR_INPUT, "expected a header that begins with '{', not", header->at, error);
  while (!take(header, "}")) {
    hl_status status = take_entry(header, error);
    if (status != HL_OK) return status;
    skip_spaces(header);
    if (*header->at != '}' && !take(header, ","))
      return refuse(header, HL_ERROR_INPUT, "expected ',' or '}', not", header->at, error);
  }
  if (header->has_type && header->has_order && header->has_shape) return HL_OK;
  return hl_fail(error, HL_ERROR_INPUT, "%s: the header lacks %s", header->path,
                 !header->has_type    ? "descr"
                 : !header->has_order ? "fortran_order"
                                      : "shape");
}

static hl_status read_header(hl_stream *stream, npy_header *header, char *text, hl_error *error) {
  unsigned char bytes[MARK_BYTES + 4];
  hl_status status = hl_stream_read_all(stream, bytes, MARK_BYTES + 2, error);
  if (status != HL_OK) return status;
  int version = bytes[6];
  if (version < 1 || version > 3)
    return hl_fail_offset(
        error, HL_ERROR_UNSUPPORTED, 6,
        "%s, byte 6: version %d of the format: 1, 2 and 3 are read: save it with numpy.save", stream->path,
        version);
  size_t length = bytes[8] | (size_t)bytes[9] << 8;
  if (version > 1) {
    status = hl_stream_read_all(stream, bytes + MARK_BYTES + 2, 2, error);
    if (status != HL_OK) return status;
    length |= (size_t)bytes[10] << 16 | (size_t)bytes[11] << 24;
  }
  if (length >= TEXT_BYTES_MOST)
    return hl_fail_offset(error, HL_ERROR_INPUT, 8, "%s, byte 8: a header of %zu bytes: at most %d are read",
                          stream->path, length, TEXT_BYTES_MOST - 1);
  status = hl_stream_read_all(stream, text, length, error);
  text[status == HL_OK ? length : 0] = 0;
  header->path = stream->path;
  header->at = text;
  return status == HL_OK ? parse(header, error) : status;
}

/* ---- the voxels ---- */

/* Makes the payload. The payload's sizes are in the order of the file, which begins with the fastest axis.
 * The fastest axis is the last axis in C order, and the first axis in Fortran order. */
static hl_status make_payload(const npy_header *header, bool *is_series, hl_payload *payload,
                              hl_error *error) {
  int axes = header->axes, first = 0;
  if (axes < 2)
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "%s: an array of %d axes: a volume has three, [z][y][x]: save a part of it", header->path,
                   axes);
  bool four = axes == 4, last_is_component = four && header->shape[3] <= MOST_COMPONENTS;
  size_t extra = !four ? 1 : header->shape[last_is_component ? 3 : 0];
  *is_series = four && !last_is_component;
  if (*is_series) first = 1;
  int grid_axes = four ? 3 : axes;
  for (int n = 0; n < grid_axes; n++) /* shape[first] is the size along z; for two axes it is the size along
                                       * y */
    payload->grid.dimensions[header->fortran ? n : grid_axes - 1 - n] = header->shape[first + n];
  if (extra == 0)
    return hl_fail(error, HL_ERROR_INPUT, "%s: the shape has a zero: each must be at least 1", header->path);
  if (extra > 1 && header->numbers > 1)
    return hl_fail(error, HL_ERROR_UNSUPPORTED, "%s: complex numbers of four axes: save a part of three",
                   header->path);
  payload->grid.type = header->type;
  payload->big_endian = header->big_endian;
  payload->components = extra * header->numbers;
  if (last_is_component && header->type == HL_VOXEL_U8) payload->colors = HL_COLORS_MEANT;
  if (header->fortran)
    payload->colors = HL_COLORS_UNREAD; /* in Fortran order the components of a voxel are not adjacent */
  hl_status status = hl_volume_check_grid(&payload->grid, header->path, error);
  if (status != HL_OK) return status;
  size_t voxels = payload->grid.dimensions[0] * payload->grid.dimensions[1] * payload->grid.dimensions[2];
  /* the components of a voxel lie side by side if their axis is the fastest one */
  payload->block = header->numbers > 1 || last_is_component != header->fortran ? 1 : voxels;
  return HL_OK;
}

/* Changes the order of voxels so that x is the fastest axis instead of z. *volume is replaced. */
static hl_status transpose(int grid_axes, hl_volume **volume, hl_error *error) {
  const hl_volume *read = *volume;
  hl_volume_description description;
  hl_volume_description_defaults(&description);
  bool exact = read->exact != NULL; /* whether the volume keeps the file's exact numbers; then these packed
                                     * numbers are rearranged */
  size_t bytes = exact ? hl_voxel_type_bytes(read->type) : hl_storage_bytes(read->storage);
  const ptrdiff_t stride[3] = {(ptrdiff_t)bytes, (ptrdiff_t)(bytes * read->dimension[0]),
                               (ptrdiff_t)(bytes * read->dimension[0] * read->dimension[1])};
  for (int axis = 0; axis < 3; axis++) { /* axis 0 of the file is z; in a file of two axes it is y */
    int turned = axis < grid_axes ? grid_axes - 1 - axis : axis;
    description.dimensions[turned] = read->dimension[axis];
    description.stride_bytes[turned] = stride[axis];
    vec3 step = mat3_column(read->index_to_world.linear, axis);
    description.axis[turned][turned] = vec3_length(step);
  }
  /* The voxel type of each hl_storage. */
  static const hl_voxel_type types[] = {HL_VOXEL_U8, HL_VOXEL_U16, HL_VOXEL_F32};
  description.type = exact ? read->type : types[read->storage];
  description.value_scale = read->value_scale;
  description.value_offset = read->value_offset;
  description.voxels = exact ? read->exact : read->voxels;
  hl_volume *turned = NULL;
  hl_status status = hl_volume_create(read->context, &description, &turned, error);
  if (status == HL_OK) turned->type = read->type;
  hl_volume_release(*volume);
  *volume = turned;
  return status;
}

static hl_status load(hl_stream **stream, hl_load_request *request, hl_volume **volume, hl_error *error) {
  npy_header header = {.numbers = 1};
  hl_payload payload;
  hl_payload_defaults(&payload);
  char *text = hl_allocate(request->context, TEXT_BYTES_MOST, 1);
  if (text == NULL) return hl_fail_memory(error, TEXT_BYTES_MOST, (*stream)->path);
  hl_status status = read_header(*stream, &header, text, error);
  hl_release(request->context, text);
  bool is_series = false;
  if (status == HL_OK) status = make_payload(&header, &is_series, &payload, error);
  if (status == HL_OK) status = hl_component_only(request, (*stream)->path, is_series, &payload, error);
  if (status != HL_OK) return status;
  int grid_axes = header.axes == 4 ? 3 : header.axes;
  double spacing[3];
  for (int axis = 0; axis < 3; axis++) /* the caller's spacing along x, y, z, in the order of the file's
                                        * axes */
    spacing[axis] = request->spacing[header.fortran && axis < grid_axes ? grid_axes - 1 - axis : axis];
  status = hl_payload_read(*stream, &payload, spacing, volume, error);
  return status == HL_OK && header.fortran ? transpose(grid_axes, volume, error) : status;
}

const hl_format hl_format_npy = {
    .name = "NumPy .npy",
    .more_endings = ".npy",
    .has_content = has_content,
    .load = load,
};
