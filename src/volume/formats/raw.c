/* volume/formats/raw.c - reads files of bare voxels, whose size and type the file's name states. slice_raw.c
 * reads slices of bare voxels.
 *
 * A name is anything_256x256x128_uint8.raw, with _be (or _le) after the type for the byte order, and .gz for
 * gzip. dat.c reads bare voxels that another file describes. */
#include "volume/formats/raw.h"

#include <string.h>

#include "volume/formats/format.h"
#include "volume/io/text.h"

static bool is_digit(char c) { return c >= '0' && c <= '9'; }

/* Reads "256x256x128_", with `count` sizes. Returns false if the text is something else. */
static bool scan_sizes(const char **cursor, int count, size_t sizes[3]) {
  const char *text = *cursor;
  for (int axis = 0; axis < count; axis++) {
    size_t value = 0;
    if (!is_digit(*text)) return false;
    for (; is_digit(*text); text++) {
      if (value > SIZE_MAX / 64) return false;
      value = 10 * value + (size_t)(*text - '0');
    }
    if (*text++ != (axis < count - 1 ? 'x' : '_')) return false;
    sizes[axis] = value;
  }
  *cursor = text;
  return true;
}

static bool ends_word(char c) { return c == 0 || c == '.' || c == '_' || c == '/'; }

static bool scan_type(const char **cursor, hl_voxel_type *type, bool *big_endian) {
  for (int candidate = HL_VOXEL_U8; candidate <= HL_VOXEL_F16; candidate++) {
    const char *name = hl_voxel_type_name((hl_voxel_type)candidate);
    const char *rest = *cursor + strlen(name);
    if (!hl_text_starts(*cursor, name) || !ends_word(*rest)) continue;
    *type = (hl_voxel_type)candidate;
    *big_endian = hl_text_starts(rest, "_be") && ends_word(rest[3]);
    bool told = *big_endian || (hl_text_starts(rest, "_le") && ends_word(rest[3]));
    *cursor = rest + (told ? 3 : 0);
    return true;
  }
  return false;
}

bool hl_raw_name(const char *path, hl_payload *payload) {
  const char *slash = strrchr(path, '/'), *name = slash == NULL ? path : slash + 1;
  hl_payload_defaults(payload);
  payload->promiser = "its name";
  payload->trailing = HL_TRAILING_REFUSED;
  for (const char *place = name; *place != 0; place++) {
    if (!is_digit(*place) || (place > name && is_digit(place[-1]))) continue;
    const char *cursor = place;
    if (scan_sizes(&cursor, 3, payload->grid.dimensions) &&
        scan_type(&cursor, &payload->grid.type, &payload->big_endian))
      return true;
  }
  return false;
}

bool hl_raw_slice_name(const char *name, size_t length, hl_raw_slice *slice) {
  for (const char *place = name; place < name + length; place++) {
    bool within = place > name && (is_digit(place[-1]) || place[-1] == 'x');
    if (!is_digit(*place) || within) continue;
    for (int count = 2; count <= 3; count++) {
      const char *cursor = place;
      size_t sizes[3] = {0, 0, 1};
      if (!scan_sizes(&cursor, count, sizes) || sizes[2] != 1 ||
          !scan_type(&cursor, &slice->type, &slice->big_endian) || cursor > name + length)
        continue;
      slice->width = sizes[0], slice->height = sizes[1];
      slice->begin = (size_t)(place - name), slice->end = (size_t)(cursor - name);
      return true;
    }
  }
  return false;
}

static hl_status load(hl_stream **stream, hl_load_request *request, hl_volume **volume, hl_error *error) {
  hl_payload payload;
  if (!hl_raw_name((*stream)->path, &payload))
    return hl_fail(
        error, HL_ERROR_INPUT,
        "%s: raw voxels need their size and type in the file's name, as in name_256x256x128_uint8.raw "
        "(uint8, int8, uint16, ... int64, float32 or float64; _be after the type for "
        "big-endian; .raw or .raw.gz), or a header .nhdr that states them and names the file",
        (*stream)->path);
  hl_status status = hl_component_only(request, (*stream)->path, false, &payload, error);
  return status == HL_OK ? hl_payload_read(*stream, &payload, request->spacing, volume, error) : status;
}

/* Returns whether the name states the size of the file. A name that states the size proves the format,
 * because bare voxels may begin with any bytes, even with another format's mark. */
static bool fits(const hl_stream *stream) {
  hl_payload payload;
  return hl_raw_name(stream->path, &payload) && !hl_text_ends(stream->path, ".gz") &&
         hl_stream_at_most(stream) == hl_payload_bytes(&payload);
}

/* Claims all files named .raw. If the name lacks the size or the type, load() reports this error. */
static hl_status claim_name(hl_stream **stream, bool *claimed, hl_error *error) {
  (void)error;
  hl_payload payload;
  const char *path = (*stream)->path;
  *claimed = hl_raw_name(path, &payload) || hl_text_ends(path, ".raw") || hl_text_ends(path, ".raw.gz");
  return HL_OK;
}

const hl_format hl_format_raw = {.title = "bare voxels",
                                 .more_endings = ".raw .raw.gz",
                                 .fits = fits,
                                 .claim_name = claim_name,
                                 .load = load};
