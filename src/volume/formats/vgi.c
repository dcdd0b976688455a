/* volume/formats/vgi.c - reads .vgi headers of VGStudio, which describe bare voxels in another file.
 *
 * The text consists of parts such as "{volume1}", which contain sections such as "[file1]" with lines "Key =
 * value". The first part "{volumeN}" has the sections [representation] and [file1], which state the number,
 * the type and the file of the voxels. The section [geometry] of the part "{volumeprimitiveN}" states the
 * distances of voxels. Voxels are little-endian. */
#include <string.h>

#include "volume/formats/format.h"
#include "volume/io/decoders.h"
#include "volume/io/text.h"

enum { NAME_BYTES = 1024, WORD_BYTES = 64 };

/* The facts about voxels that one section states. */
typedef struct voxel_section {
  size_t size[3], bits;
  bool has_size;
  char type[WORD_BYTES]; /* "" if not stated */
} voxel_section;

typedef struct vgi_header {
  const hl_stream *stream;
  int line;
  char part[WORD_BYTES], section[WORD_BYTES], volume[WORD_BYTES]; /* volume: name of the first part
                                                                   * "{volumeN}", which is read */
  voxel_section grid, file; /* the sections [representation] and [file1]; a value that [file1] states has
                             * priority */
  size_t skip;
  double spacing[3];
  bool has_spacing;
  const char *unit;
  char data_file[NAME_BYTES];
} vgi_header;

static bool is_digit(unsigned char byte) { return byte >= '0' && byte <= '9'; }
static bool is_word_byte(unsigned char byte) {
  return is_digit(byte) || (byte >= 'a' && byte <= 'z') || (byte >= 'A' && byte <= 'Z');
}

/* Returns whether a file begins with a word in braces. JSON files are excluded, because in JSON a quotation
 * mark follows the brace. */
static bool has_content(const unsigned char *bytes, size_t length) {
  size_t at = length >= 3 && memcmp(bytes, "\xef\xbb\xbf", 3) == 0 ? 3 : 0;
  while (at < length && hl_is_space((char)bytes[at])) at++;
  if (at >= length || bytes[at++] != '{') return false;
  size_t begin = at;
  while (at < length && is_word_byte(bytes[at])) at++;
  return at > begin && at < length && bytes[at] == '}';
}

static hl_status refuse(const vgi_header *header, const char *key, const char *value, hl_error *error) {
  char shown[HL_PRINTABLE_BYTES];
  return HL_FAIL_LINE(error, HL_ERROR_INPUT, header->stream, header->line, "%s cannot be \"%s\"", key,
                      hl_text_printable(shown, value));
}

/* Returns whether a part's name consists of `word` and a number. */
static bool is_numbered(const char *name, const char *word) {
  return hl_text_starts(name, word) && is_digit((unsigned char)name[strlen(word)]);
}

/* Stores the name of the part or section that begins at a line in brackets. */
static hl_status enter(vgi_header *header, char *text, hl_error *error) {
  bool is_part = text[0] == '{';
  size_t length = strlen(text);
  if (text[length - 1] != (is_part ? '}' : ']') || length - 1 > WORD_BYTES)
    return refuse(header, is_part ? "a part's name" : "a section's name", text, error);
  text[length - 1] = 0;
  strcpy(is_part ? header->part : header->section, hl_text_trim(text + 1));
  if (is_part) header->section[0] = 0;
  if (is_part && header->volume[0] == 0 && is_numbered(header->part, "volume"))
    strcpy(header->volume, header->part);
  if (is_numbered(header->section, "file") && !hl_text_equal(header->section, "file1") &&
      hl_text_equal(header->part, header->volume))
    return HL_FAIL_LINE(error, HL_ERROR_UNSUPPORTED, header->stream, header->line, "%s",
                        "voxels in several files are not read: save them as one file");
  return HL_OK;
}

static hl_status read_voxel_key(vgi_header *header, voxel_section *section, const char *key,
                                const char *value, hl_error *error) {
  bool sound = true;
  if (hl_text_equal(key, "size")) {
    sound = section->has_size = hl_text_sizes(value, section->size, 3) == 3;
  } else if (hl_text_equal(key, "bitsperelement")) {
    sound = hl_text_sizes(value, &section->bits, 1) == 1 && section->bits > 0;
  } else if (hl_text_equal(key, "datatype")) {
    sound = *value != 0 && strlen(value) < sizeof section->type;
    if (sound) strcpy(section->type, value);
  }
  return sound ? HL_OK : refuse(header, key, value, error);
}

static hl_status read_file_key(vgi_header *header, const char *key, const char *value, hl_error *error) {
  bool sound = true;
  if (hl_text_equal(key, "Name")) {
    sound = *value != 0 && strlen(value) < sizeof header->data_file;
    if (sound) strcpy(header->data_file, value);
  } else if (hl_text_equal(key, "SkipHeader")) {
    sound = hl_text_sizes(value, &header->skip, 1) == 1;
  } else if (hl_text_equal(key, "FileFormat") && !hl_text_equal(value, "raw")) {
    char shown[HL_PRINTABLE_BYTES];
    return HL_FAIL_LINE(error, HL_ERROR_UNSUPPORTED, header->stream, header->line,
                        "FileFormat \"%s\" is not read: save the voxels as raw",
                        hl_text_printable(shown, value));
  }
  return sound ? read_voxel_key(header, &header->file, key, value, error) : refuse(header, key, value, error);
}

static hl_status read_geometry_key(vgi_header *header, const char *key, const char *value, hl_error *error) {
  static const struct {
    const char *word, *unit;
  } units[] = {{"m", "metre"},       {"cm", "centimetre"}, {"mm", "millimetre"},
               {"um", "micrometre"}, {"µm", "micrometre"}, {"nm", "nanometre"}};
  if (hl_text_equal(key, "resolution")) {
    header->has_spacing = hl_text_numbers(value, header->spacing, 3) == 3;
    return header->has_spacing ? HL_OK : refuse(header, key, value, error);
  }
  for (size_t n = 0; n < sizeof units / sizeof *units && hl_text_equal(key, "unit"); n++)
    if (hl_text_equal(value, units[n].word)) header->unit = units[n].unit;
  return HL_OK;
}

static hl_status read_line(vgi_header *header, char *text, hl_error *error) {
  if (*text == 0) return HL_OK;
  if (*text == '{' || *text == '[') return enter(header, text, error);
  char *equals = strchr(text, '=');
  if (equals == NULL) return HL_OK;
  *equals = 0;
  const char *key = hl_text_trim(text), *value = hl_text_trim(equals + 1);
  if (header->volume[0] != 0 && hl_text_equal(header->part, header->volume)) {
    if (hl_text_equal(header->section, "representation"))
      return read_voxel_key(header, &header->grid, key, value, error);
    if (hl_text_equal(header->section, "file1")) return read_file_key(header, key, value, error);
  }
  if (is_numbered(header->part, "volumeprimitive") && hl_text_equal(header->section, "geometry") &&
      !(header->has_spacing && hl_text_equal(key, "resolution")))
    return read_geometry_key(header, key, value, error);
  return HL_OK;
}

static hl_status find_type(const vgi_header *header, hl_voxel_type *type, hl_error *error) {
  static const struct {
    const char *words;
    size_t bits;
    hl_voxel_type type;
  } types[] = {{"unsigned integer", 8, HL_VOXEL_U8},         {"unsigned integer", 16, HL_VOXEL_U16},
               {"unsigned integer", 32, HL_VOXEL_U32},       {"signed integer|integer", 8, HL_VOXEL_I8},
               {"signed integer|integer", 16, HL_VOXEL_I16}, {"signed integer|integer", 32, HL_VOXEL_I32},
               {"float|floating point", 16, HL_VOXEL_F16},   {"float|floating point", 32, HL_VOXEL_F32}};
  const char *words = header->file.type[0] != 0 ? header->file.type : header->grid.type;
  size_t bits = header->file.bits != 0 ? header->file.bits : header->grid.bits;
  for (size_t n = 0; n < sizeof types / sizeof *types; n++)
    if (bits == types[n].bits && hl_text_is_one_of(words, types[n].words)) {
      *type = types[n].type;
      return HL_OK;
    }
  char shown[HL_PRINTABLE_BYTES];
  return hl_fail(
      error, HL_ERROR_UNSUPPORTED,
      "%s: voxels of the type \"%s\" of %zu bits are not read: save integers of 8, 16 or 32 bits, or "
      "floats of 16 or 32 bits",
      header->stream->path, hl_text_printable(shown, words), bits);
}

static hl_status make_grid(const vgi_header *header, hl_volume_description *grid, hl_error *error) {
  const voxel_section *said = header->file.has_size ? &header->file : &header->grid;
  if (header->data_file[0] == 0 || !said->has_size)
    return hl_fail(error, HL_ERROR_INPUT,
                   "%s: a .vgi header needs a part {volume1} with Name and Size in its section [file1]",
                   header->stream->path);
  if (header->grid.has_size && memcmp(said->size, header->grid.size, sizeof said->size) != 0)
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "%s: [file1] and [representation] state different sizes: save the volume at one size",
                   header->stream->path);
  for (int axis = 0; axis < 3; axis++) {
    grid->dimensions[axis] = said->size[axis];
    if (header->has_spacing) grid->axis[axis][axis] = header->spacing[axis];
  }
  return find_type(header, &grid->type, error);
}

/* Refuses a header without a resolution, unless the caller gives the spacing. A missing resolution is a sign
 * that the file was cut off. */
static hl_status check_spacing(const vgi_header *header, const double wanted[3], hl_error *error) {
  if (header->has_spacing || wanted[0] != 0 || wanted[1] != 0 || wanted[2] != 0) return HL_OK;
  return hl_fail(error, HL_ERROR_INPUT,
                 "%s: the header has no resolution in [geometry] of a part {volumeprimitive1}: give the "
                 "distances of voxels (--spacing)",
                 header->stream->path);
}

static hl_status load(hl_stream **stream, hl_load_request *request, hl_volume **volume, hl_error *error) {
  vgi_header header = {.stream = *stream};
  hl_payload payload;
  hl_payload_defaults(&payload);
  payload.promiser = "the .vgi header";
  payload.trailing = HL_TRAILING_REFUSED;
  char line[HL_LINE_BYTES];
  hl_status status = HL_OK;
  for (bool ended = false; status == HL_OK && !ended;) {
    header.line++;
    status = hl_stream_line(*stream, line, &ended, error);
    char *text = line;
    if (header.line == 1 && memcmp(line, "\xef\xbb\xbf", 3) == 0) text += 3;
    if (status == HL_OK && !ended) status = read_line(&header, hl_text_trim(text), error);
  }
  if (status == HL_OK) status = make_grid(&header, &payload.grid, error);
  if (status == HL_OK) status = check_spacing(&header, request->spacing, error);
  if (status == HL_OK) status = hl_volume_check_grid(&payload.grid, (*stream)->path, error);
  if (status == HL_OK) status = hl_component_only(request, (*stream)->path, false, &payload, error);
  request->unit = header.unit;
  if (status == HL_OK) status = hl_stream_switch(stream, header.data_file, error);
  if (status == HL_OK) status = hl_stream_skip(*stream, header.skip, error);
  return status == HL_OK ? hl_payload_read(*stream, &payload, request->spacing, volume, error) : status;
}

const hl_format hl_format_vgi = {
    .name = "VGStudio .vgi",
    .endings = {".vgi"},
    .beginning = "a part's name in braces, such as {volume1}",
    .has_content = has_content,
    .load = load,
};
