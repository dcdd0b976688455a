/* volume/formats/nifti.c - reads NIfTI-1 and NIfTI-2: .nii, and pairs of .hdr and .img; also ANALYZE 7.5 and
 * SPM99 files, whose headers are like the header of NIfTI-1.
 *
 * ANALYZE headers state no orientation. As in nibabel, the orientation is taken from SPM's file NAME.mat
 * beside the header. Without this file, x runs to the left, and the world's origin is a voxel: the voxel that
 * SPM's field states, if this voxel lies near the volume, else the voxel in the middle of the volume.
 *
 * World coordinates are the coordinates of the file (x to the right, y to the front, z up). The map from
 * indices to the world is the sform; without an sform it is the qform, and without a qform it follows from
 * the voxel sizes alone. Source of the fields: nifti1.h and nifti2.h of the NIfTI Data Format Working
 * Group. */
#include <math.h>
#include <string.h>

#include "core/context.h"
#include "core/memory.h"
#include "volume/formats/format.h"
#include "volume/formats/spm_mat.h"
#include "volume/io/decoders.h"
#include "volume/io/text.h"

enum { HEADER_1_BYTES = 348, HEADER_2_BYTES = 540, NAME_BYTES = 1024 };

/* The offsets of the fields in the header of one version of the format. */
typedef struct nifti_layout {
  int version;
  size_t header_bytes, magic, dim, intent, datatype, pixdim, vox_offset, slope, intercept, qform_code,
      sform_code, quaternion, qoffset, srow;
} nifti_layout;

static const nifti_layout layout_1 = {
    1, HEADER_1_BYTES, 344, 40, 68, 70, 76, 108, 112, 116, 252, 254, 256, 268, 280};
static const nifti_layout layout_2 = {
    2, HEADER_2_BYTES, 4, 16, 504, 12, 104, 168, 176, 184, 344, 348, 352, 376, 400};

typedef struct nifti_header {
  unsigned char bytes[HEADER_2_BYTES];
  const nifti_layout *layout;
  bool big_endian, is_pair, is_analyze;
  hl_context *context;
  const char *path;
} nifti_header;

static uint64_t load_bits(const nifti_header *header, size_t place, size_t length) {
  uint64_t bits = 0;
  for (size_t n = 0; n < length; n++)
    bits = bits << 8 | header->bytes[place + (header->big_endian ? n : length - 1 - n)];
  return bits;
}

/* Loads a whole number from the header. The width of the number differs between the two versions of the
 * format. */
static int64_t load_short(const nifti_header *header, size_t place) {
  return (int16_t)load_bits(header, place, 2);
}
static int64_t load_code(const nifti_header *header, size_t place) {
  return header->layout->version == 1 ? load_short(header, place) : (int32_t)load_bits(header, place, 4);
}
static double load_real(const nifti_header *header, size_t place, int index) {
  if (header->layout->version == 1) {
    uint32_t bits = (uint32_t)load_bits(header, place + 4 * (size_t)index, 4);
    float value;
    memcpy(&value, &bits, 4);
    return (double)value;
  }
  uint64_t bits = load_bits(header, place + 8 * (size_t)index, 8);
  double value;
  memcpy(&value, &bits, 8);
  return value;
}
static int64_t load_dimension(const nifti_header *header, int index) {
  if (header->layout->version == 1) return load_short(header, header->layout->dim + 2 * (size_t)index);
  return (int64_t)load_bits(header, header->layout->dim + 8 * (size_t)index, 8);
}

/* Finds the layout and the byte order of a header from its first four bytes, which state its length. Returns
 * null if the bytes do not begin a header. */
static const nifti_layout *identify(const unsigned char *bytes, bool *big_endian) {
  uint32_t little = (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 |
                    (uint32_t)bytes[3] << 24;
  uint32_t big = __builtin_bswap32(little);
  *big_endian = big == HEADER_1_BYTES || big == HEADER_2_BYTES;
  uint32_t size = *big_endian ? big : little;
  return size == HEADER_1_BYTES ? &layout_1 : size == HEADER_2_BYTES ? &layout_2 : NULL;
}

static bool has_magic(const unsigned char *bytes, const nifti_layout *layout) {
  const unsigned char *magic = bytes + layout->magic;
  return magic[0] == 'n' && (magic[1] == '+' || magic[1] == 'i') && magic[2] == '0' + layout->version &&
         magic[3] == 0;
}

static bool has_content(const unsigned char *bytes, size_t length) {
  bool big_endian;
  const nifti_layout *layout = length < HEADER_1_BYTES ? NULL : identify(bytes, &big_endian);
  return layout != NULL && length >= layout->header_bytes && has_magic(bytes, layout);
}

static hl_status read_header(hl_stream *stream, nifti_header *header, hl_error *error) {
  header->path = stream->path;
  header->context = stream->context;
  hl_status status = hl_stream_read_all(stream, header->bytes, 4, error);
  if (status != HL_OK) return status;
  header->layout = identify(header->bytes, &header->big_endian);
  if (header->layout == NULL)
    return hl_fail_offset(error, HL_ERROR_INPUT, 0, "%s, byte 0: a NIfTI header begins with 348 or 540",
                          stream->path);
  status = hl_stream_read_all(stream, header->bytes + 4, header->layout->header_bytes - 4, error);
  if (status != HL_OK) return status;
  header->is_analyze = !has_magic(header->bytes, header->layout);
  if (header->is_analyze && header->layout->version != 1)
    return hl_fail_offset(error, HL_ERROR_INPUT, (int64_t)header->layout->magic,
                          "%s, byte %zu: no NIfTI mark", stream->path, header->layout->magic);
  header->is_pair = header->is_analyze || header->bytes[header->layout->magic + 1] == 'i';
  return HL_OK;
}

/* Reads the sizes of the first three axes. *series: set to the size of the fourth axis. *others: set to the
 * product of the sizes of all later axes. */
static hl_status read_dimensions(const nifti_header *header, size_t dimensions[3], size_t *series,
                                 size_t *others, hl_error *error) {
  int64_t count = load_dimension(header, 0);
  if (count < 1 || count > 7)
    return hl_fail_offset(error, HL_ERROR_INPUT, (int64_t)header->layout->dim,
                          "%s, byte %zu: dim[0] is %lld, must be 1 to 7", header->path, header->layout->dim,
                          (long long)count);
  for (int n = 1; n <= count; n++) {
    int64_t size = load_dimension(header, n);
    if (size < 1 && n > 1) { /* a size below 1 counts as 1, as in the format's reference implementation
                              * nifti1_io.c */
      hl_log(header->context, HL_LOG_WARNING, "%s: dim[%d] is %lld: 1 is taken", header->path, n,
             (long long)size);
      size = 1;
    }
    if (size < 1)
      return hl_fail_offset(error, HL_ERROR_INPUT, (int64_t)header->layout->dim,
                            "%s, byte %zu: dim[%d] is %lld, must be at least 1", header->path,
                            header->layout->dim, n, (long long)size);
    size_t *product = n == 4 ? series : others;
    if (n <= 3) dimensions[n - 1] = (size_t)size;
    else if (!hl_multiply(*product, (size_t)size, product)) *product = SIZE_MAX;
  }
  return HL_OK;
}

/* The unit of lengths, from the lower three bits of xyzt_units. */
static const char *unit_of(const nifti_header *header) {
  static const char *const units[8] = {NULL, "metre", "millimetre", "micrometre"};
  enum { AT_1 = 123, AT_2 = 500 };
  uint64_t code = header->layout->version == 1 ? header->bytes[AT_1] : load_bits(header, AT_2, 4);
  return units[code & 7];
}

/* Returns whether the header's intent code says that values are labels (nifti1.h, NIFTI_INTENT_LABEL). In
 * ANALYZE headers the bytes of the intent code hold another field. */
static bool says_labels(const nifti_header *header) {
  enum { LABEL = 1002 };
  return !header->is_analyze && load_code(header, header->layout->intent) == LABEL;
}

/* Reads the voxel type. *components: set to the number of values that lie side by side in each voxel; greater
 * than 1 for colours and complex numbers. */
static hl_status read_type(const nifti_header *header, hl_voxel_type *type, size_t *components,
                           hl_error *error) {
  static const struct {
    int code;
    hl_voxel_type type;
    size_t components;
  } types[] = {{2, HL_VOXEL_U8, 1},     {256, HL_VOXEL_I8, 1},  {512, HL_VOXEL_U16, 1},
               {4, HL_VOXEL_I16, 1},    {768, HL_VOXEL_U32, 1}, {8, HL_VOXEL_I32, 1},
               {16, HL_VOXEL_F32, 1},   {64, HL_VOXEL_F64, 1},  {1280, HL_VOXEL_U64, 1},
               {1024, HL_VOXEL_I64, 1}, {32, HL_VOXEL_F32, 2},  {1792, HL_VOXEL_F64, 2},
               {128, HL_VOXEL_U8, 3},   {2304, HL_VOXEL_U8, 4}};
  static const struct {
    int code;
    const char *name;
  } others[] = {{1, "one bit"}, {1536, "float128"}, {2048, "complex float128"}};
  int64_t code = load_short(header, header->layout->datatype);
  for (size_t n = 0; n < sizeof types / sizeof *types; n++)
    if (types[n].code == code) {
      *type = types[n].type;
      *components = types[n].components;
      return HL_OK;
    }
  for (size_t n = 0; n < sizeof others / sizeof *others; n++)
    if (others[n].code == code)
      return hl_fail_offset(error, HL_ERROR_UNSUPPORTED, (int64_t)header->layout->datatype,
                            "%s: voxels of type %lld (%s) are not read: convert them to one number each",
                            header->path, (long long)code, others[n].name);
  return hl_fail_offset(error, HL_ERROR_INPUT, (int64_t)header->layout->datatype,
                        "%s, byte %zu: there is no NIfTI datatype %lld", header->path,
                        header->layout->datatype, (long long)code);
}

/* Reads the slope and the intercept of data values. A slope of 0, NaN or infinity means that values are not
 * scaled. */
static hl_status read_scale(const nifti_header *header, hl_volume_description *grid, hl_error *error) {
  double slope = load_real(header, header->layout->slope, 0),
         intercept = load_real(header, header->layout->intercept, 0);
  if (slope == 0 || !isfinite(slope)) return HL_OK;
  if (!isfinite(intercept) && header->is_analyze) intercept = 0;
  if (!isfinite(intercept))
    return hl_fail_offset(error, HL_ERROR_INPUT, (int64_t)header->layout->intercept,
                          "%s, byte %zu: scl_inter is not a finite number though scl_slope is %g",
                          header->path, header->layout->intercept, slope);
  grid->value_scale = slope;
  grid->value_offset = intercept;
  return HL_OK;
}

/* Sets axes and origin by the format's method 3, in which the header states the rows of an affine matrix. */
static void place_by_sform(const nifti_header *header, hl_volume_description *grid) {
  for (int row = 0; row < 3; row++) {
    for (int axis = 0; axis < 3; axis++)
      grid->axis[axis][row] = load_real(header, header->layout->srow, 4 * row + axis);
    grid->origin[row] = load_real(header, header->layout->srow, 4 * row + 3);
  }
}

/* The limit of a * a below which a counts as 0. For a half turn the component a of the quaternion is 0; an a
 * * a below the limit is only the rounding error of the floats b, c, d. The function nifti_quatern_to_mat44()
 * of the reference implementation, nifti1_io.c, treats half turns in the same way. */
static const double HALF_TURN = 1e-7;

/* Sets axes and origin by the format's method 2, in which the header states a rotation, voxel sizes and an
 * offset. The rotation is the unit quaternion (a, b, c, d). The header states only b, c and d; the number a
 * >= 0 follows from them. */
static void place_by_qform(const nifti_header *header, const double spacing[3], hl_volume_description *grid) {
  double b = load_real(header, header->layout->quaternion, 0),
         c = load_real(header, header->layout->quaternion, 1);
  double d = load_real(header, header->layout->quaternion, 2), square = 1 - (b * b + c * c + d * d);
  double a = square >= HALF_TURN ? sqrt(square) : 0, length = sqrt(a * a + b * b + c * c + d * d);
  a /= length, b /= length, c /= length, d /= length;
  double rotation[3][3] = {{a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c)},
                           {2 * (b * c + a * d), a * a + c * c - b * b - d * d, 2 * (c * d - a * b)},
                           {2 * (b * d - a * c), 2 * (c * d + a * b), a * a + d * d - b * b - c * c}};
  double handedness = load_real(header, header->layout->pixdim, 0) < 0 ? -1 : 1; /* the field "qfac" */
  for (int axis = 0; axis < 3; axis++) {
    for (int row = 0; row < 3; row++)
      grid->axis[axis][row] = rotation[row][axis] * spacing[axis] * (axis == 2 ? handedness : 1);
    grid->origin[axis] = load_real(header, header->layout->qoffset, axis);
  }
}

static void place_by_sizes(const double spacing[3], hl_volume_description *grid) {
  memset(grid->axis, 0, sizeof grid->axis);
  memset(grid->origin, 0, sizeof grid->origin);
  for (int axis = 0; axis < 3; axis++) grid->axis[axis][axis] = spacing[axis];
}

/* Sets axes and origin of an ANALYZE volume, as the beginning of this file describes. SPM's origin is the
 * index of a voxel: three whole numbers at byte 253, counted from 1. */
static void place_by_origin(const nifti_header *header, const double spacing[3],
                            hl_volume_description *grid) {
  enum { ORIGIN = 253 };
  double origin[3];
  bool any = false, near = true;
  if (hl_spm_mat_place(header->context, header->path, grid)) {
    hl_log(header->context, HL_LOG_WARNING,
           "%s: an ANALYZE header, which tells no orientation: SPM's .mat file beside it does", header->path);
    return;
  }
  place_by_sizes(spacing, grid);
  grid->axis[0][0] = -spacing[0];
  for (int axis = 0; axis < 3; axis++) {
    double size = (double)grid->dimensions[axis];
    origin[axis] = (double)load_short(header, ORIGIN + 2 * (size_t)axis);
    any = any || origin[axis] != 0;
    near = near && origin[axis] > -size && origin[axis] < 2 * size;
  }
  for (int axis = 0; axis < 3; axis++) {
    double middle = ((double)grid->dimensions[axis] - 1) / 2;
    grid->origin[axis] = -(any && near ? origin[axis] - 1 : middle) * grid->axis[axis][axis];
  }
  hl_log(header->context, HL_LOG_WARNING,
         "%s: an ANALYZE header, which tells no orientation: x is taken to run from right to left, and %s "
         "for the origin",
         header->path, any && near ? "SPM's origin" : "the volume's middle");
}

/* Sets axes and origin by the first method for which the file has numbers and which results in valid axes. */
static void place(const nifti_header *header, hl_volume_description *grid) {
  double spacing[3];
  for (int axis = 0; axis < 3; axis++) {
    spacing[axis] = fabs(load_real(header, header->layout->pixdim, axis + 1));
    if (!(spacing[axis] > 0) || !isfinite(spacing[axis])) spacing[axis] = 1;
  }
  if (header->is_analyze) {
    place_by_origin(header, spacing, grid);
    return;
  }
  if (load_code(header, header->layout->sform_code) > 0) {
    place_by_sform(header, grid);
    if (hl_volume_check_grid(grid, header->path, NULL) == HL_OK) return;
  }
  if (load_code(header, header->layout->qform_code) > 0) {
    place_by_qform(header, spacing, grid);
    if (hl_volume_check_grid(grid, header->path, NULL) == HL_OK) return;
  }
  place_by_sizes(spacing, grid);
}

/* Replaces the header's file of a pair by the file of its voxels, whose name has .img (or .img.gz) in place
 * of .hdr. */
static hl_status switch_to_image(hl_stream **stream, hl_error *error) {
  const char *slash = strrchr((*stream)->path, '/'), *name = slash == NULL ? (*stream)->path : slash + 1;
  char image[NAME_BYTES];
  size_t length = strlen(name);
  if (hl_text_ends(name, ".hdr")) length -= 4;
  else if (hl_text_ends(name, ".hdr.gz")) length -= 7;
  else if (hl_text_ends(name, ".nii")) length -= 4;
  if (length + 8 > sizeof image)
    return hl_fail(error, HL_ERROR_INPUT, "%s: the name is too long", (*stream)->path);
  memcpy(image, name, length);
  strcpy(image + length, ".img");
  hl_status status = hl_stream_switch(stream, image, error);
  if (status == HL_ERROR_IO) {
    strcpy(image + length, ".img.gz");
    hl_status compressed = hl_stream_switch(stream, image, NULL);
    if (compressed != HL_ERROR_IO) status = compressed;
  }
  return status;
}

static hl_status go_to_voxels(hl_stream **stream, const nifti_header *header, const hl_payload *payload,
                              hl_error *error) {
  double offset = header->layout->version == 1
                      ? load_real(header, header->layout->vox_offset, 0)
                      : (double)(int64_t)load_bits(header, header->layout->vox_offset, 8);
  if (header->is_analyze && offset < 0)
    offset = -offset; /* in ANALYZE, a negative number is an offset within each volume */
  if (!(offset >= 0 && offset < 9e15) || offset != floor(offset))
    return hl_fail_offset(error, HL_ERROR_INPUT, (int64_t)header->layout->vox_offset,
                          "%s, byte %zu: vox_offset is %g, must be a whole number of bytes", header->path,
                          header->layout->vox_offset, offset);
  uint64_t skip = (uint64_t)offset;
  if (!header->is_pair) {
    uint64_t least = header->layout->header_bytes + 4; /* the header is followed by four bytes, which say
                                                        * whether extensions follow */
    skip = (skip < least ? least : skip) - header->layout->header_bytes;
    return hl_stream_skip(*stream, skip, error);
  }
  hl_status status = switch_to_image(stream, error);
  if (status == HL_OK && hl_stream_at_most(*stream) != skip + hl_payload_bytes(payload))
    status = hl_stream_unpack(stream, error);
  return status == HL_OK ? hl_stream_skip(*stream, skip, error) : status;
}

/* Finds the components. Components are either the colours of a voxel, which lie side by side, or the volumes
 * of a series and of further axes, which follow each other. */
static hl_status find_components(const nifti_header *header, size_t side_by_side, size_t series,
                                 size_t others, hl_payload *payload, hl_error *error) {
  const size_t *dimension = payload->grid.dimensions;
  size_t volumes;
  if (!hl_multiply(series, others, &volumes)) volumes = SIZE_MAX;
  if (side_by_side > 1 && volumes > 1)
    return hl_fail(error, HL_ERROR_UNSUPPORTED, "%s: %zu components in each of %zu volumes: save one of them",
                   header->path, side_by_side, volumes);
  payload->components = side_by_side > 1 ? side_by_side : volumes;
  payload->block = side_by_side > 1 ? 1 : dimension[0] * dimension[1] * dimension[2];
  return HL_OK;
}

static hl_status load(hl_stream **stream, hl_load_request *request, hl_volume **volume, hl_error *error) {
  nifti_header header = {.layout = NULL};
  hl_payload payload;
  size_t side_by_side = 1, series = 1, others = 1;
  hl_payload_defaults(&payload);
  hl_status status = read_header(*stream, &header, error);
  if (status == HL_OK) status = read_dimensions(&header, payload.grid.dimensions, &series, &others, error);
  if (status == HL_OK) status = read_type(&header, &payload.grid.type, &side_by_side, error);
  if (status == HL_OK) status = read_scale(&header, &payload.grid, error);
  if (status != HL_OK) return status;
  place(&header, &payload.grid);
  payload.grid.space = HL_SPACE_RAS;
  request->is_anatomical = true;
  request->says_labels = says_labels(&header);
  request->unit = header.is_analyze ? "millimetre" : unit_of(&header);
  status = hl_volume_check_grid(&payload.grid, (*stream)->path, error);
  payload.big_endian = header.big_endian;
  if (side_by_side > 2) payload.colors = HL_COLORS_MEANT;
  if (status == HL_OK) status = find_components(&header, side_by_side, series, others, &payload, error);
  if (series > 1) request->selection.times = series, request->selection.channels = others;
  if (status == HL_OK) status = hl_component_only(request, (*stream)->path, series > 1, &payload, error);
  if (status == HL_OK) status = go_to_voxels(stream, &header, &payload, error);
  return status == HL_OK ? hl_payload_read(*stream, &payload, request->spacing, volume, error) : status;
}

/* If *stream is NAME.img, which holds the voxels of a pair, replaces it by the header NAME.hdr. *switched:
 * set to whether *stream was replaced. */
static hl_status switch_to_header(hl_stream **stream, bool *switched, hl_error *error) {
  const char *slash = strrchr((*stream)->path, '/'), *name = slash == NULL ? (*stream)->path : slash + 1;
  char header[NAME_BYTES];
  size_t length = strlen(name);
  *switched = false;
  if (hl_text_ends(name, ".img.gz")) length -= 7;
  else if (hl_text_ends(name, ".img")) length -= 4;
  else return HL_OK;
  if (length + 8 > sizeof header) return HL_OK;
  memcpy(header, name, length);
  static const char *const endings[] = {".hdr", ".hdr.gz"};
  for (int n = 0; n < 2; n++) {
    strcpy(header + length, endings[n]);
    hl_status status = hl_stream_switch(stream, header, error);
    *switched = status == HL_OK;
    if (status == HL_OK) return hl_stream_unpack(stream, error);
    if (status != HL_ERROR_IO) return status;
  }
  return HL_OK;
}

/* Claims files by their names, so that load() is also called for files with damaged headers, and reports the
 * damage. */
static hl_status claim_name(hl_stream **stream, bool *claimed, hl_error *error) {
  const unsigned char *bytes;
  size_t length;
  hl_status status = hl_stream_peek(*stream, 1, &bytes, &length, error);
  const char *path = (*stream)->path;
  *claimed = status == HL_OK && length > 0 &&
             (hl_text_ends(path, ".nii") || hl_text_ends(path, ".nii.gz") || hl_text_ends(path, ".hdr"));
  return status != HL_OK || *claimed ? status : switch_to_header(stream, claimed, error);
}

const hl_format hl_format_nifti = {
    .name = "NIfTI",
    .more_endings = ".nii .hdr .img",
    .has_content = has_content,
    .claim_name = claim_name,
    .load = load,
};
