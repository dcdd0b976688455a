/* volume/formats/mrc.c - reads MRC and CCP4 maps of electron microscopy and crystallography: .mrc, .map,
 * .ccp4, .rec, .st.
 *
 * Source of the fields: the MRC2014 format (Cheng et al., Journal of Structural Biology 192, 2015, and the
 * CCP-EM project's page about the format). The header has 1024 bytes of 4-byte words. The byte order is the
 * order in which the header's sizes and mode are possible numbers. World coordinates are the cell's X, Y, Z
 * in Angstroms. The header's MAPC, MAPR and MAPS say along which of the cell's axes the file's columns, rows
 * and sections run. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "elementary/elementary.h"
#include "volume/formats/format.h"
#include "volume/io/text.h"

enum {
  HEADER_BYTES = 1024,
  /* offsets in bytes of the header's words */
  AT_SIZES = 0,
  AT_MODE = 12,
  AT_START = 16,
  AT_INTERVALS = 28,
  AT_CELL = 40,
  AT_ANGLES = 52,
  AT_AXES = 64,
  AT_SPACE_GROUP = 88,
  AT_EXTENDED = 92,
  AT_IMOD_STAMP = 152,
  AT_IMOD_FLAGS = 156,
  AT_ORIGIN = 196,
  AT_MARK = 208
};

typedef struct mrc_header {
  unsigned char bytes[HEADER_BYTES];
  bool big_endian;
  int64_t sizes[3]; /* numbers of columns, rows and sections */
  int64_t mode;
  bool packed; /* whether a byte holds two voxels */
} mrc_header;

static uint32_t load_word(const unsigned char *bytes, bool big_endian) {
  uint32_t word = 0;
  for (int n = 0; n < 4; n++) word = word << 8 | bytes[big_endian ? n : 3 - n];
  return word;
}

static int64_t load_integer(const mrc_header *header, int place) {
  return (int32_t)load_word(header->bytes + place, header->big_endian);
}

static double load_real(const mrc_header *header, int place) {
  uint32_t bits = load_word(header->bytes + place, header->big_endian);
  float value;
  memcpy(&value, &bits, 4);
  return (double)value;
}

/* Returns whether a number is a mode that the pages of IMOD or CCP-EM list. */
static bool is_mode(int64_t mode) {
  return (mode >= 0 && mode <= 4) || mode == 6 || mode == 12 || mode == 16 || mode == 101;
}

/* Returns whether the sizes and the mode are possible if they are read in this byte order. */
static bool is_possible(const unsigned char *bytes, bool big_endian) {
  for (int axis = 0; axis < 3; axis++)
    if ((int32_t)load_word(bytes + AT_SIZES + 4 * axis, big_endian) < 1) return false;
  return is_mode((int32_t)load_word(bytes + AT_MODE, big_endian));
}

static bool has_content(const unsigned char *bytes, size_t length) {
  return length >= HEADER_BYTES && memcmp(bytes + AT_MARK, "MAP", 3) == 0 &&
         (is_possible(bytes, false) || is_possible(bytes, true));
}

static hl_status read_header(hl_stream *stream, mrc_header *header, hl_error *error) {
  hl_status status = hl_stream_read_all(stream, header->bytes, HEADER_BYTES, error);
  if (status != HL_OK) return status;
  bool little = is_possible(header->bytes, false), big = is_possible(header->bytes, true);
  /* both byte orders are possible if sizes are numbers like 16777216; in this case the machine stamp decides:
   * 0x11 means big-endian */
  header->big_endian = big && (!little || header->bytes[AT_MARK + 4] == 0x11);
  if (!little && !big) {
    int64_t mode = load_integer(header, AT_MODE);
    return hl_fail_offset(
        error, HL_ERROR_INPUT, 0,
        "%s, byte 0: an MRC header begins with three sizes above 0 and a mode (0 to 4, 6, 12, "
        "16 or 101), not %lld x %lld x %lld and %lld",
        stream->path, (long long)load_integer(header, AT_SIZES),
        (long long)load_integer(header, AT_SIZES + 4), (long long)load_integer(header, AT_SIZES + 8),
        (long long)mode);
  }
  for (int axis = 0; axis < 3; axis++) header->sizes[axis] = load_integer(header, AT_SIZES + 4 * axis);
  header->mode = load_integer(header, AT_MODE);
  header->packed = header->mode == 101;
  return HL_OK;
}

/* Returns whether the bytes of a file of mode 0 are unsigned. The format prescribes signed bytes, but IMOD
 * also writes unsigned bytes. A file that IMOD has written has IMOD's stamp, and a flag says whether its
 * bytes are signed. */
static bool has_unsigned_bytes(const mrc_header *header) {
  enum { STAMP = 1146047817, SIGNED = 1 };
  return load_integer(header, AT_IMOD_STAMP) == STAMP && (load_integer(header, AT_IMOD_FLAGS) & SIGNED) == 0;
}

static void read_type(const mrc_header *header, hl_payload *payload) {
  hl_voxel_type type = HL_VOXEL_F32;
  switch (header->mode) {
    case 0: type = has_unsigned_bytes(header) ? HL_VOXEL_U8 : HL_VOXEL_I8; break;
    case 1:
    case 3: type = HL_VOXEL_I16; break;
    case 6: type = HL_VOXEL_U16; break;
    case 12: type = HL_VOXEL_F16; break;
    case 16:
    case 101: type = HL_VOXEL_U8; break;
    default: break;
  }
  payload->grid.type = type;
  payload->components = header->mode == 3 || header->mode == 4 ? 2 /* real and imaginary parts */
                        : header->mode == 16                   ? 3 /* red, green, blue */
                                                               : 1;
  payload->block = 1;
  payload->big_endian = header->big_endian;
}

/* Finds the grid's dimensions, and whether the file is a stack of volumes. Stacks have space groups from 401
 * on; MZ says how many sections each volume has. For a stack, also sets the payload's components and
 * block. */
static hl_status read_stack(const mrc_header *header, const char *path, hl_payload *payload, bool *is_series,
                            hl_error *error) {
  int64_t group = load_integer(header, AT_SPACE_GROUP), each = load_integer(header, AT_INTERVALS + 8),
          sections = header->sizes[2];
  *is_series = group >= 401 && group <= 630 && each >= 1 && each < sections && sections % each == 0;
  for (int axis = 0; axis < 3; axis++) payload->grid.dimensions[axis] = (size_t)header->sizes[axis];
  if (!*is_series) return HL_OK;
  if (payload->components > 1)
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "%s: %zu components in each of %lld volumes: save one of them", path, payload->components,
                   (long long)(sections / each));
  payload->grid.dimensions[2] = (size_t)each;
  payload->components = (size_t)(sections / each);
  size_t rows;
  if (!hl_multiply(payload->grid.dimensions[0], payload->grid.dimensions[1], &rows) ||
      !hl_multiply(rows, (size_t)each, &payload->block))
    payload->block = SIZE_MAX; /* SIZE_MAX is an impossible size, so that the check of the grid refuses the
                                * file */
  return HL_OK;
}

/* Finds the cosine and the sine of an angle in degrees. An angle of 0 means that the program wrote no angle,
 * and counts as 90 degrees. */
static void turn(double degrees, double *cosine, double *sine) {
  bool right = degrees == 90 || degrees == 0 || !isfinite(degrees);
  *cosine = right ? 0 : hl_cos(degrees * (HL_PI / 180));
  *sine = right ? 1 : hl_sin(degrees * (HL_PI / 180));
}

/* Finds the vectors along the cell's axes a, b, c that are as long as one interval of the grid. The cell's
 * angles are alpha (between b and c), beta (c and a) and gamma (a and b). Axis a lies along X, and b in the
 * plane of X and Y, as in International Tables for Crystallography, volume F (2001), chapter 11.1, and in PDB
 * files. The third coordinate of c follows from its length 1. */
static void place_cell(const mrc_header *header, double step[3][3]) {
  double length[3], cosine[3], sine[3];
  for (int axis = 0; axis < 3; axis++) {
    double intervals = (double)load_integer(header, AT_INTERVALS + 4 * axis);
    length[axis] = load_real(header, AT_CELL + 4 * axis) / intervals;
    if (!(length[axis] > 0) || !isfinite(length[axis])) length[axis] = 1;
    turn(load_real(header, AT_ANGLES + 4 * axis), &cosine[axis], &sine[axis]);
  }
  double across = (cosine[0] - cosine[1] * cosine[2]) / sine[2];
  const double unit[3][3] = {{1, 0, 0},
                             {cosine[2], sine[2], 0},
                             {cosine[1], across, sqrt(1 - cosine[1] * cosine[1] - across * across)}};
  for (int axis = 0; axis < 3; axis++)
    for (int row = 0; row < 3; row++) step[axis][row] = length[axis] * unit[axis][row];
}

/* Finds along which of X, Y, Z the file's columns, rows and sections run. If the header's numbers are not a
 * permutation of 1, 2, 3, the order is X, Y, Z. */
static void read_axes(const mrc_header *header, int axes[3]) {
  int seen = 0;
  for (int n = 0; n < 3; n++) {
    int64_t axis = load_integer(header, AT_AXES + 4 * n);
    if (axis >= 1 && axis <= 3) seen |= 1 << axis;
    axes[n] = (int)(axis - 1); /* the subtraction in 64 bits cannot overflow; numbers other than 1, 2, 3 are
                                * replaced below */
  }
  if (seen == (1 << 1 | 1 << 2 | 1 << 3)) return;
  for (int n = 0; n < 3; n++) axes[n] = n;
}

/* Sets the origin of the grid: the position of the first voxel is the header's ORIGIN. If ORIGIN is 0, as in
 * crystallography, the voxel lies NXSTART columns, NYSTART rows and NZSTART sections from the world's
 * origin. */
static void place(const mrc_header *header, hl_volume_description *grid) {
  double step[3][3], origin[3];
  int axes[3];
  place_cell(header, step);
  read_axes(header, axes);
  bool given = false, finite = true;
  for (int n = 0; n < 3; n++) {
    memcpy(grid->axis[n], step[axes[n]], sizeof grid->axis[n]);
    origin[n] = load_real(header, AT_ORIGIN + 4 * n);
    given = given || origin[n] != 0;
    finite = finite && isfinite(origin[n]);
  }
  if (given && finite && memcmp(header->bytes + AT_MARK, "MAP", 3) == 0) {
    memcpy(grid->origin, origin, sizeof origin);
    return;
  }
  for (int row = 0; row < 3; row++)
    for (int n = 0; n < 3; n++)
      grid->origin[row] += (double)load_integer(header, AT_START + 4 * n) * grid->axis[n][row];
}

/* ---- mode 101: voxels of four bits, the lower half of a byte first; each row begins with a byte ---- */

typedef struct nibble_stream {
  hl_stream base;
  uint64_t columns, column; /* numbers in a row; index of the next number within its row */
  unsigned char upper;      /* upper four bits of the last byte that was read, which are its second voxel */
} nibble_stream;

static hl_status pull_nibbles(hl_stream *stream, unsigned char *bytes, size_t capacity, size_t *count,
                              hl_error *error) {
  nibble_stream *nibbles = (nibble_stream *)stream;
  hl_status status = HL_OK;
  for (*count = 0; *count < capacity && status == HL_OK; ++*count) {
    if (nibbles->column % 2 == 1) {
      bytes[*count] = nibbles->upper;
    } else {
      const unsigned char *next;
      size_t available;
      status = hl_stream_peek(stream->below, 1, &next, &available, error);
      if (status != HL_OK || available == 0) break;
      bytes[*count] = next[0] & 15;
      nibbles->upper = next[0] >> 4;
      hl_stream_take(stream->below, 1);
    }
    nibbles->column = nibbles->column + 1 < nibbles->columns ? nibbles->column + 1 : 0;
  }
  return status;
}

static uint64_t most_nibbles(const hl_stream *stream) {
  uint64_t bytes = hl_stream_at_most(stream->below);
  return bytes > UINT64_MAX / 2 - 1 ? UINT64_MAX : 2 * bytes + 1;
}

static hl_status push_nibbles(hl_stream **stream, const mrc_header *header, hl_error *error) {
  nibble_stream *nibbles = (nibble_stream *)hl_stream_make((*stream)->context, sizeof *nibbles, *stream);
  if (nibbles == NULL) return hl_fail_memory(error, HL_STREAM_BUFFER_BYTES, (*stream)->path);
  nibbles->columns = (uint64_t)header->sizes[0];
  nibbles->base.pull = pull_nibbles;
  nibbles->base.at_most = most_nibbles;
  *stream = &nibbles->base;
  return HL_OK;
}

/* ---- all steps together ---- */

static hl_status skip_extended_header(hl_stream *stream, const mrc_header *header, hl_error *error) {
  int64_t bytes = load_integer(header, AT_EXTENDED);
  if (bytes < 0)
    return hl_fail_offset(error, HL_ERROR_INPUT, AT_EXTENDED,
                          "%s, byte %d: the extended header has %lld bytes, must be 0 or more", stream->path,
                          AT_EXTENDED, (long long)bytes);
  return hl_stream_skip(stream, (uint64_t)bytes, error);
}

static hl_status load(hl_stream **stream, hl_load_request *request, hl_volume **volume, hl_error *error) {
  mrc_header header = {.mode = 0};
  hl_payload payload;
  bool is_series = false;
  hl_payload_defaults(&payload);
  hl_status status = read_header(*stream, &header, error);
  if (status != HL_OK) return status;
  read_type(&header, &payload);
  request->unit = "angstrom";
  place(&header, &payload.grid);
  status = read_stack(&header, (*stream)->path, &payload, &is_series, error);
  if (status == HL_OK) status = hl_volume_check_grid(&payload.grid, (*stream)->path, error);
  if (status == HL_OK) status = hl_component_only(request, (*stream)->path, is_series, &payload, error);
  if (status == HL_OK) status = skip_extended_header(*stream, &header, error);
  if (status == HL_OK && header.packed) status = push_nibbles(stream, &header, error);
  return status == HL_OK ? hl_payload_read(*stream, &payload, request->spacing, volume, error) : status;
}

/* Claims files by their names, so that load() reads files older than the mark "MAP", and reports damaged
 * headers. */
static hl_status claim_name(hl_stream **stream, bool *claimed, hl_error *error) {
  static const char *const endings[] = {".mrc", ".mrcs", ".map", ".ccp4", ".rec", ".ali", ".st"};
  const unsigned char *bytes;
  size_t length;
  hl_status status = hl_stream_peek(*stream, 1, &bytes, &length, error);
  char plain[1024];
  const char *path = (*stream)->path;
  if (hl_text_ends(path, ".gz") && strlen(path) < sizeof plain) {
    strcpy(plain, path);
    plain[strlen(plain) - 3] = 0;
    path = plain;
  }
  for (size_t n = 0; status == HL_OK && length > 0 && n < sizeof endings / sizeof *endings; n++)
    *claimed = *claimed || hl_text_ends(path, endings[n]);
  return status;
}

const hl_format hl_format_mrc = {.name = "MRC",
                                 .more_endings = ".mrc .mrcs .map .ccp4 .rec .ali .st",
                                 .has_content = has_content,
                                 .claim_name = claim_name,
                                 .load = load};
