/* volume/formats/dat.c - reads .dat files, which describe bare voxels in another file.
 *
 * The file has the lines "ObjectFileName: f.raw", "Resolution: 64 64 64", "SliceThickness: 1 1 1" and
 * "Format: UCHAR", in any order. */
#include <string.h>

#include "volume/formats/format.h"
#include "volume/io/decoders.h"
#include "volume/io/text.h"

static bool has_content(const unsigned char *bytes, size_t length) {
  static const char *const keys[] = {"ObjectFileName:", "TaggedFileName:", "Resolution:"};
  for (int n = 0; n < 3; n++)
    if (length > strlen(keys[n]) && memcmp(bytes, keys[n], strlen(keys[n])) == 0) return true;
  return false;
}

typedef struct descriptor {
  hl_payload payload;
  char data_file[1024];
  bool has_sizes, has_type;
} descriptor;

static hl_status read_field(const hl_stream *stream, int line_number, const char *key, const char *value,
                            descriptor *header, hl_error *error) {
  static const hl_named_type formats[] = {
      {"UCHAR|UINT8", HL_VOXEL_U8},    {"CHAR|INT8", HL_VOXEL_I8}, {"USHORT|UINT16|USHORT_12", HL_VOXEL_U16},
      {"SHORT|INT16", HL_VOXEL_I16},   {"UINT", HL_VOXEL_U32},     {"INT", HL_VOXEL_I32},
      {"FLOAT|FLOAT32", HL_VOXEL_F32}, {"DOUBLE", HL_VOXEL_F64}};
  hl_volume_description *grid = &header->payload.grid;
  bool sound = true;
  if (hl_text_equal(key, "ObjectFileName")) {
    sound = *value != 0 && strlen(value) < sizeof header->data_file;
    if (sound) strcpy(header->data_file, value);
  } else if (hl_text_equal(key, "Resolution")) {
    sound = header->has_sizes = hl_text_sizes(value, grid->dimensions, 3) == 3;
  } else if (hl_text_equal(key, "SliceThickness")) {
    double spacing[3];
    sound = hl_text_numbers(value, spacing, 3) == 3;
    for (int axis = 0; sound && axis < 3; axis++) grid->axis[axis][axis] = spacing[axis];
  } else if (hl_text_equal(key, "Format")) {
    sound = header->has_type = hl_find_type(formats, sizeof formats / sizeof *formats, value, &grid->type);
  }
  char shown[HL_PRINTABLE_BYTES];
  return sound ? HL_OK
               : HL_FAIL_LINE(error, HL_ERROR_INPUT, stream, line_number, "%s cannot be \"%s\"", key,
                              hl_text_printable(shown, value));
}

static hl_status load(hl_stream **stream, hl_load_request *request, hl_volume **volume, hl_error *error) {
  descriptor header = {.has_sizes = false};
  hl_payload_defaults(&header.payload);
  header.payload.promiser = "the .dat descriptor";
  header.payload.trailing = HL_TRAILING_REFUSED;
  char line[HL_LINE_BYTES];
  for (int number = 1;; number++) {
    bool ended;
    hl_status status = hl_stream_line(*stream, line, &ended, error);
    if (status != HL_OK) return status;
    if (ended) break;
    char *colon = strchr(line, ':');
    if (colon == NULL) continue;
    *colon = 0;
    status = read_field(*stream, number, hl_text_trim(line), hl_text_trim(colon + 1), &header, error);
    if (status != HL_OK) return status;
  }
  if (header.data_file[0] == 0 || !header.has_sizes || !header.has_type)
    return hl_fail(error, HL_ERROR_INPUT,
                   "%s: a .dat descriptor needs the lines ObjectFileName, Resolution and Format",
                   (*stream)->path);
  hl_status status = hl_stream_switch(stream, header.data_file, error);
  if (status == HL_OK) status = hl_volume_check_grid(&header.payload.grid, (*stream)->path, error);
  if (status == HL_OK) status = hl_component_only(request, (*stream)->path, false, &header.payload, error);
  if (status == HL_OK && hl_stream_at_most(*stream) != hl_payload_bytes(&header.payload))
    status = hl_stream_unpack(stream, error);
  return status == HL_OK ? hl_payload_read(*stream, &header.payload, request->spacing, volume, error)
                         : status;
}

const hl_format hl_format_dat = {
    .title = "descriptors of bare voxels", .more_endings = ".dat", .has_content = has_content, .load = load};
