/* volume/formats/mgh.c - reads FreeSurfer's volumes: .mgh files, and .mgz files, which are .mgh files packed
 * by gzip.
 *
 * All numbers are big-endian: the version 1, three sizes and the number of frames, the type, and a flag. If
 * the flag is set, voxel sizes, the directions of the axes and the middle of the volume follow (RAS,
 * millimetres). Voxels begin at byte 284. Source: FreeSurfer's description of the format
 * ("FsTutorial/MghFormat"). */
#include <math.h>
#include <string.h>

#include "volume/convert.h"
#include "volume/formats/format.h"
#include "volume/io/text.h"

enum { HEADER_BYTES = 284, SIZES = 4, TYPE = 20, IS_GOOD = 28, PLACE = 30, SIZE_MOST = 1 << 24 };

static uint32_t word_at(const unsigned char *at) {
  return (uint32_t)at[0] << 24 | (uint32_t)at[1] << 16 | (uint32_t)at[2] << 8 | at[3];
}

static double real_at(const unsigned char *at) {
  uint32_t bits = word_at(at);
  float value;
  memcpy(&value, &bits, sizeof value);
  return (double)value;
}

/* The voxel type of a code; 0 for a type that is not known. */
static hl_voxel_type type_of(uint32_t code) {
  static const hl_voxel_type types[11] = {
      [0] = HL_VOXEL_U8, [1] = HL_VOXEL_I32, [3] = HL_VOXEL_F32, [4] = HL_VOXEL_I16, [10] = HL_VOXEL_U16};
  return code < 11 ? types[code] : 0;
}

static bool has_content(const unsigned char *bytes, size_t length) {
  if (length < HEADER_BYTES || word_at(bytes) != 1 || type_of(word_at(bytes + TYPE)) == 0) return false;
  for (size_t n = 0; n < 4; n++) {
    uint32_t size = word_at(bytes + SIZES + 4 * n);
    if (size < 1 || size > SIZE_MOST) return false;
  }
  return bytes[IS_GOOD] == 0 && bytes[IS_GOOD + 1] <= 1;
}

/* Sets the volume's axes and origin. The file states the position of the middle, which has the index size / 2
 * along each axis, even if the size is odd. */
static void place(const unsigned char *header, hl_volume_description *grid) {
  /* The axes i, j, k and the position of the middle that are used if the file states none. */
  static const double usual[12] = {-1, 0, 0, 0, 0, -1, 0, 1, 0, 0, 0, 0};
  bool good = header[IS_GOOD + 1] == 1;
  const unsigned char *at = header + PLACE;
  double middle[3];
  for (int axis = 0; axis < 3; axis++) {
    double size = good ? real_at(at + 4 * axis) : 1;
    for (int row = 0; row < 3; row++)
      grid->axis[axis][row] = (good ? real_at(at + 12 + 12 * axis + 4 * row) : usual[3 * axis + row]) * size;
  }
  for (int row = 0; row < 3; row++) {
    middle[row] = good ? real_at(at + 48 + 4 * row) : usual[9 + row];
    grid->origin[row] = middle[row];
    for (int axis = 0; axis < 3; axis++)
      grid->origin[row] -= grid->axis[axis][row] * (double)grid->dimensions[axis] / 2;
  }
  grid->space = HL_SPACE_RAS;
}

static hl_status load(hl_stream **stream, hl_load_request *request, hl_volume **volume, hl_error *error) {
  unsigned char header[HEADER_BYTES];
  hl_payload payload;
  hl_payload_defaults(&payload);
  hl_status status = hl_stream_read_all(*stream, header, sizeof header, error);
  if (status != HL_OK) return status;
  if (!has_content(header, sizeof header))
    return hl_fail(error, HL_ERROR_INPUT, "%s: the header has impossible sizes, or a type that is not known",
                   (*stream)->path);
  for (int axis = 0; axis < 3; axis++)
    payload.grid.dimensions[axis] = word_at(header + SIZES + 4 * (size_t)axis);
  payload.grid.type = type_of(word_at(header + TYPE));
  payload.components = word_at(header + SIZES + 12);
  payload.big_endian = true;
  payload.trailing = HL_TRAILING_IGNORED; /* the scan's times and tags may follow the voxels */
  place(header, &payload.grid);
  request->unit = "millimetre";
  request->is_anatomical = true;
  status = hl_volume_check_grid(&payload.grid, (*stream)->path, error);
  if (status != HL_OK) return status;
  const size_t *n = payload.grid.dimensions;
  payload.block = n[0] * n[1] * n[2];
  if (payload.components > 1) request->selection.times = payload.components;
  status = hl_component_only(request, (*stream)->path, payload.components > 1, &payload, error);
  return status == HL_OK ? hl_payload_read(*stream, &payload, request->spacing, volume, error) : status;
}

/* Claims files by their names, so that load() is also called for files with damaged headers, and reports the
 * damage. */
static hl_status claim_name(hl_stream **stream, bool *claimed, hl_error *error) {
  (void)error;
  static const char *const endings[] = {".mgh", ".mgz", ".mgh.gz"};
  for (size_t n = 0; n < sizeof endings / sizeof *endings; n++)
    *claimed = *claimed || hl_text_ends((*stream)->path, endings[n]);
  return HL_OK;
}

const hl_format hl_format_mgh = {
    .name = "MGH",
    .endings = {".mgh", ".mgz"},
    .beginning = "a version 1 and sizes",
    .has_content = has_content,
    .claim_name = claim_name,
    .load = load,
};
