/* volume/formats/nrrd_header.c - reads the header of an NRRD file.
 *
 * The header consists of lines "field: value" (in any case) up to an empty line. Pairs "key:=value" and
 * fields that Halflight does not need are skipped. Source: the format's definition by Teem, "Definition of
 * NRRD File Format". */
#include "volume/formats/nrrd_header.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/context.h"
#include "core/memory.h"
#include "volume/formats/format.h"
#include "volume/io/text.h"

/* ---- fields ---- */

typedef hl_status field_function(nrrd_header *header, const char *value, hl_error *error);

static hl_status refuse(const nrrd_header *header, const char *field, const char *value, hl_error *error) {
  char shown[HL_PRINTABLE_BYTES];
  return HL_FAIL_LINE(error, HL_ERROR_INPUT, header->stream, header->line, "%s cannot be \"%s\"", field,
                      hl_text_printable(shown, value));
}

static hl_status read_dimension(nrrd_header *header, const char *value, hl_error *error) {
  size_t dimension;
  if (hl_text_sizes(value, &dimension, 1) != 1 || dimension < 1 || dimension > NRRD_MOST_AXES)
    return refuse(header, "dimension", value, error);
  header->dimension = (int)dimension;
  return HL_OK;
}

static hl_status need_dimension(const nrrd_header *header, const char *field, hl_error *error) {
  if (header->dimension > 0) return HL_OK;
  return HL_FAIL_LINE(error, HL_ERROR_INPUT, header->stream, header->line,
                      "the field dimension must come before %s", field);
}

static hl_status read_sizes(nrrd_header *header, const char *value, hl_error *error) {
  size_t sizes[NRRD_MOST_AXES];
  hl_status status = need_dimension(header, "sizes", error);
  if (status != HL_OK) return status;
  if (hl_text_sizes(value, sizes, NRRD_MOST_AXES) != header->dimension) {
    char shown[HL_PRINTABLE_BYTES];
    return HL_FAIL_LINE(error, HL_ERROR_INPUT, header->stream, header->line,
                        "sizes must be %d whole numbers, as the dimension says, not \"%s\"",
                        header->dimension, hl_text_printable(shown, value));
  }
  for (int axis = 0; axis < header->dimension; axis++) header->axis[axis].size = sizes[axis];
  header->has_sizes = true;
  return HL_OK;
}

static hl_status read_type(nrrd_header *header, const char *value, hl_error *error) {
  static const hl_named_type types[] = {
      {"uchar|unsigned char|uint8|uint8_t", HL_VOXEL_U8},
      {"signed char|char|int8|int8_t", HL_VOXEL_I8},
      {"ushort|unsigned short|unsigned short int|uint16|uint16_t", HL_VOXEL_U16},
      {"short|short int|signed short|signed short int|int16|int16_t", HL_VOXEL_I16},
      {"uint|unsigned int|uint32|uint32_t", HL_VOXEL_U32},
      {"int|signed int|int32|int32_t", HL_VOXEL_I32},
      {"ulonglong|unsigned long long|unsigned long long int|uint64|uint64_t", HL_VOXEL_U64},
      {"longlong|long long|long long int|signed long long|signed long long int|int64|int64_t", HL_VOXEL_I64},
      {"float", HL_VOXEL_F32},
      {"double", HL_VOXEL_F64}};
  if (hl_find_type(types, sizeof types / sizeof *types, value, &header->type)) return HL_OK;
  char shown[HL_PRINTABLE_BYTES];
  return HL_FAIL_LINE(
      error, hl_text_equal(value, "block") ? HL_ERROR_UNSUPPORTED : HL_ERROR_INPUT, header->stream,
      header->line,
      "type \"%s\" is not read: integers, float and double are: save it as one of these (unu convert)",
      hl_text_printable(shown, value));
}

static hl_status read_encoding(nrrd_header *header, const char *value, hl_error *error) {
  static const char *const names[] = {"raw", "gzip|gz", "bzip2|bz2", "ascii|text|txt",
                                      "hex"}; /* names of the encodings, in the order of nrrd_encoding */
  for (int n = NRRD_RAW; n <= NRRD_HEX; n++)
    if (hl_text_is_one_of(value, names[n])) {
      header->encoding = (nrrd_encoding)n;
      header->has_encoding = true;
      return HL_OK;
    }
  bool known = hl_text_equal(value, "zrl");
  char shown[HL_PRINTABLE_BYTES];
  return HL_FAIL_LINE(error, known ? HL_ERROR_UNSUPPORTED : HL_ERROR_INPUT, header->stream, header->line,
                      "encoding \"%s\" is not read: raw, gzip, bzip2, ascii and hex are: convert it by unu "
                      "save -f nrrd -e gzip",
                      hl_text_printable(shown, value));
}

static hl_status read_endian(nrrd_header *header, const char *value, hl_error *error) {
  header->big_endian = hl_text_equal(value, "big");
  header->has_endian = true;
  return header->big_endian || hl_text_equal(value, "little") ? HL_OK
                                                              : refuse(header, "endian", value, error);
}

/* Reads a field that has one number for each axis; NaN is allowed. place: the offset of the member of
 * nrrd_axis that gets the number. */
static hl_status read_per_axis(nrrd_header *header, const char *field, const char *value, size_t place,
                               hl_error *error) {
  double numbers[NRRD_MOST_AXES];
  hl_status status = need_dimension(header, field, error);
  if (status != HL_OK) return status;
  if (hl_text_numbers(value, numbers, NRRD_MOST_AXES) != header->dimension)
    return refuse(header, field, value, error);
  for (int axis = 0; axis < header->dimension; axis++)
    memcpy((char *)&header->axis[axis] + place, &numbers[axis], sizeof *numbers);
  return HL_OK;
}

static hl_status read_spacings(nrrd_header *header, const char *value, hl_error *error) {
  return read_per_axis(header, "spacings", value, offsetof(nrrd_axis, spacing), error);
}
static hl_status read_minima(nrrd_header *header, const char *value, hl_error *error) {
  return read_per_axis(header, "axis mins", value, offsetof(nrrd_axis, minimum), error);
}
static hl_status read_maxima(nrrd_header *header, const char *value, hl_error *error) {
  return read_per_axis(header, "axis maxs", value, offsetof(nrrd_axis, maximum), error);
}

static hl_status read_centers(nrrd_header *header, const char *value, hl_error *error) {
  hl_status status = need_dimension(header, "centers", error);
  char word[NRRD_KIND_BYTES];
  const char *cursor = value;
  for (int axis = 0; status == HL_OK && axis < header->dimension; axis++) {
    if (!hl_text_word(&cursor, word, sizeof word)) return refuse(header, "centers", value, error);
    header->axis[axis].is_node = hl_text_equal(word, "node");
  }
  return status;
}

static hl_status read_kinds(nrrd_header *header, const char *value, hl_error *error) {
  hl_status status = need_dimension(header, "kinds", error);
  const char *cursor = value;
  for (int axis = 0; status == HL_OK && axis < header->dimension; axis++)
    if (!hl_text_word(&cursor, header->axis[axis].kind, NRRD_KIND_BYTES))
      return refuse(header, "kinds", value, error);
  return status;
}

/* Reads the first three numbers of a vector "(x, y, z)"; missing numbers become 0. *beyond: set to whether
 * any further number, such as one of time, is not 0. */
static bool scan_vector(const char **cursor, double vector[3], bool *beyond) {
  const char *text = *cursor;
  while (hl_is_space(*text)) text++;
  const char *end = *text == '(' ? strchr(text, ')') : NULL;
  if (end == NULL) return false;
  char inside[256];
  size_t length = (size_t)(end - text) - 1;
  if (length >= sizeof inside) return false;
  for (size_t n = 0; n < length; n++) inside[n] = text[n + 1] == ',' ? ' ' : text[n + 1];
  inside[length] = 0;
  double numbers[NRRD_MOST_AXES] = {0};
  *cursor = end + 1;
  int count = hl_text_numbers(inside, numbers, NRRD_MOST_AXES);
  memcpy(vector, numbers, 3 * sizeof *vector);
  *beyond = false;
  for (int n = 3; n < count; n++) *beyond = *beyond || numbers[n] != 0;
  return count >= 1;
}

/* Returns whether a vector is no direction in space. Vectors of NaN, which some programs write in place of
 * "none", are no directions. A vector that runs only along a fourth axis, such as time, is no direction in
 * space either. */
static bool is_no_direction(const double v[3], bool beyond) {
  return (isnan(v[0]) && isnan(v[1]) && isnan(v[2])) || (beyond && v[0] == 0 && v[1] == 0 && v[2] == 0);
}

static hl_status read_directions(nrrd_header *header, const char *value, hl_error *error) {
  hl_status status = need_dimension(header, "space directions", error);
  if (status != HL_OK) return status;
  const char *cursor = value;
  for (int axis = 0; axis < header->dimension; axis++) {
    while (hl_is_space(*cursor)) cursor++;
    nrrd_axis *place = &header->axis[axis];
    place->has_direction = !hl_text_starts(cursor, "none");
    if (!place->has_direction) cursor += 4;
    else {
      bool beyond;
      if (!scan_vector(&cursor, place->direction, &beyond))
        return refuse(header, "space directions", value, error);
      if (is_no_direction(place->direction, beyond)) place->has_direction = false;
    }
    header->space.has_directions = header->space.has_directions || place->has_direction;
  }
  return HL_OK;
}

static hl_status read_origin(nrrd_header *header, const char *value, hl_error *error) {
  const char *cursor = value;
  bool beyond;
  if (!scan_vector(&cursor, header->space.origin, &beyond))
    return refuse(header, "space origin", value, error);
  header->space.has_origin = true;
  return HL_OK;
}

/* Reads the field "space". Only the three names in this function, with or without time, state an anatomical
 * space. */
static hl_status read_space(nrrd_header *header, const char *value, hl_error *error) {
  (void)error;
  static const struct {
    const char *names;
    hl_space space;
  } spaces[] = {{"right-anterior-superior|RAS|right-anterior-superior-time|RAST", HL_SPACE_RAS},
                {"left-posterior-superior|LPS|left-posterior-superior-time|LPST", HL_SPACE_LPS},
                {"left-anterior-superior|LAS|left-anterior-superior-time|LAST", HL_SPACE_LAS}};
  for (size_t n = 0; n < sizeof spaces / sizeof *spaces; n++)
    if (hl_text_is_one_of(value, spaces[n].names)) header->space.kind = spaces[n].space;
  return HL_OK;
}

/* The unit of length that a word in quotes names; null if the word names no unit of length. */
static const char *find_unit(const char *word) {
  static const struct {
    const char *words, *unit;
  } units[] = {{"\"m\"|\"meter\"|\"metre\"", "metre"},
               {"\"mm\"|\"millimeter\"|\"millimetre\"", "millimetre"},
               {"\"um\"|\"micron\"|\"microns\"|\"micrometer\"|\"micrometre\"", "micrometre"},
               {"\"A\"|\"angstrom\"|\"angstroms\"", "angstrom"}};
  for (size_t n = 0; n < sizeof units / sizeof *units; n++)
    if (hl_text_is_one_of(word, units[n].words)) return units[n].unit;
  return NULL;
}

/* Reads units such as "mm" "mm" "mm", or "" "mm" "mm" "mm" if the first axis has components. Returns the unit
 * that three axes share; null if three axes share no unit, or if a further axis has a different unit of
 * length. */
static const char *scan_units(const char *text) {
  char word[NRRD_KIND_BYTES];
  const char *told = NULL;
  int axes = 0;
  while (hl_text_word(&text, word, sizeof word)) {
    const char *unit = find_unit(word);
    if (unit != NULL && told != NULL && unit != told) return NULL;
    if (unit != NULL) told = unit, axes++;
  }
  return axes == 3 ? told : NULL;
}

static hl_status read_space_units(nrrd_header *header, const char *value, hl_error *error) {
  (void)error;
  header->space.unit = scan_units(value);
  header->space.has_units = true;
  return HL_OK;
}

/* Reads the field "units", which counts only in a header without the field "space units". */
static hl_status read_units(nrrd_header *header, const char *value, hl_error *error) {
  (void)error;
  if (!header->space.has_units) header->space.unit = scan_units(value);
  return HL_OK;
}

static hl_status read_data_file(nrrd_header *header, const char *value, hl_error *error) {
  header->data.is_list = strncmp(value, "LIST", 4) == 0 && (value[4] == 0 || hl_is_space(value[4]));
  if (header->data.is_list) return HL_OK;
  if (strchr(value, '%') != NULL) {
    bool sound;
    hl_status status = hl_file_list_pattern(&header->data.files, value, &sound, error);
    if (status != HL_OK || sound) return status;
  }
  if (*value == 0 || strlen(value) >= sizeof header->data.file)
    return refuse(header, "data file", value, error);
  strcpy(header->data.file, value);
  return HL_OK;
}

static hl_status read_line_skip(nrrd_header *header, const char *value, hl_error *error) {
  return hl_text_sizes(value, &header->data.line_skip, 1) == 1 ? HL_OK
                                                               : refuse(header, "line skip", value, error);
}

static hl_status read_byte_skip(nrrd_header *header, const char *value, hl_error *error) {
  header->data.skip_to_last = hl_text_equal(value, "-1");
  if (header->data.skip_to_last || hl_text_sizes(value, &header->data.byte_skip, 1) == 1) return HL_OK;
  return refuse(header, "byte skip", value, error);
}

static hl_status pass_over(nrrd_header *header, const char *value, hl_error *error) {
  (void)header, (void)value, (void)error;
  return HL_OK;
}

static field_function *find_field(const char *name) {
  static const struct {
    const char *names;
    field_function *read;
  } fields[] = {{"dimension", read_dimension},
                {"sizes", read_sizes},
                {"type", read_type},
                {"encoding", read_encoding},
                {"endian", read_endian},
                {"spacings", read_spacings},
                {"axis mins|axismins", read_minima},
                {"axis maxs|axismaxs", read_maxima},
                {"centers|centerings", read_centers},
                {"kinds", read_kinds},
                {"space directions", read_directions},
                {"space origin", read_origin},
                {"data file|datafile", read_data_file},
                {"line skip|lineskip", read_line_skip},
                {"byte skip|byteskip", read_byte_skip},
                {"space", read_space},
                {"space units", read_space_units},
                {"units", read_units},
                {"space dimension|measurement frame|content|number|block size|blocksize|min|max|"
                 "old min|oldmin|old max|oldmax|thicknesses|labels|sample units|sampleunits",
                 pass_over}};
  for (size_t n = 0; n < sizeof fields / sizeof *fields; n++)
    if (hl_text_is_one_of(name, fields[n].names)) return fields[n].read;
  return NULL;
}

static bool is_color(const double srgb[3]) {
  for (int c = 0; c < 3; c++)
    if (!(srgb[c] >= 0 && srgb[c] <= 1)) return false;
  return true;
}

/* ---- segmentations: pairs "Segment0_Name:=liver", as Slicer writes them in .seg.nrrd files ---- */

/* Makes the list of segments long enough for segment `number`. */
static hl_status need_segment(nrrd_header *header, size_t number, hl_error *error) {
  if (number < header->segment_count) return HL_OK;
  hl_context *context = header->stream->context;
  size_t count = number + 1;
  hl_segment *segments = hl_reallocate(context, header->segments, count, sizeof *segments);
  if (segments == NULL) return hl_fail_memory(error, count * sizeof *segments, "the names of segments");
  memset(segments + header->segment_count, 0, (count - header->segment_count) * sizeof *segments);
  header->segments = segments;
  header->segment_count = count;
  return HL_OK;
}

/* Reads a pair "key:=value". Pairs that do not describe segments are ignored. colon: points to the colon in
 * the line. */
static hl_status read_pair(nrrd_header *header, char *line, char *colon, hl_error *error) {
  static const char prefix[] = "Segment";
  size_t number = 0;
  *colon = 0;
  if (strncmp(line, prefix, sizeof prefix - 1) != 0) return HL_OK;
  const char *digit = line + sizeof prefix - 1, *value = colon + 2;
  if (*digit < '0' || *digit > '9') return HL_OK;
  for (; *digit >= '0' && *digit <= '9' && number < HL_MOST_SEGMENTS; digit++)
    number = 10 * number + (size_t)(*digit - '0');
  bool name = strcmp(digit, "_Name") == 0, color = strcmp(digit, "_Color") == 0;
  bool label = strcmp(digit, "_LabelValue") == 0, layer = strcmp(digit, "_Layer") == 0;
  if (number >= HL_MOST_SEGMENTS || !(name || color || label || layer)) return HL_OK;
  hl_status status = need_segment(header, number, error);
  if (status != HL_OK) return status;
  hl_segment *segment = &header->segments[number];
  int64_t whole;
  if (name) snprintf(segment->name, sizeof segment->name, "%s", value);
  else if (color)
    segment->has_color = hl_text_numbers(value, segment->srgb, 3) == 3 && is_color(segment->srgb);
  else if (!hl_text_whole(value, &whole) || (layer && (whole < 0 || whole > INT_MAX)))
    return refuse(header, line, value, error);
  else if (label) segment->value = whole;
  else segment->layer = (int)whole;
  return HL_OK;
}

static hl_status read_field_line(nrrd_header *header, char *line, hl_error *error) {
  char shown[HL_PRINTABLE_BYTES];
  char *colon = strchr(line, ':');
  if (colon == NULL)
    return HL_FAIL_LINE(
        error, HL_ERROR_INPUT, header->stream, header->line,
        "expected \"field: value\", an empty line before the voxels, or a # comment, not \"%s\"",
        hl_text_printable(shown, line));
  if (colon[1] == '=') return read_pair(header, line, colon, error);
  *colon = 0;
  char *name = hl_text_trim(line), *value = hl_text_trim(colon + 1);
  field_function *read = find_field(name);
  if (read != NULL) return read(header, value, error);
  hl_log(header->stream->context, HL_LOG_WARNING,
         "%s, line %d: the field \"%s\" is not known and has no effect", header->stream->path, header->line,
         hl_text_printable(shown, name));
  return HL_OK;
}

hl_status hl_nrrd_read_header(hl_stream *stream, nrrd_header *header, hl_error *error) {
  char line[HL_LINE_BYTES];
  bool ended;
  header->stream = stream;
  for (int axis = 0; axis < NRRD_MOST_AXES; axis++)
    header->axis[axis].spacing = header->axis[axis].minimum = header->axis[axis].maximum = NAN;
  for (header->line = 1;; header->line++) {
    hl_status status = hl_stream_line(stream, line, &ended, error);
    if (status != HL_OK) return status;
    if (ended || (line[0] == 0 && header->line > 1)) break;
    if (header->data.is_list) { /* each further line is the name of a data file */
      status = hl_file_list_add(&header->data.files, hl_text_trim(line), error);
      if (status != HL_OK) return status;
      continue;
    }
    if (header->line == 1) {
      if (strncmp(line, "NRRD000", 7) != 0 || line[7] < '1' || line[7] > '5' || line[8] != 0)
        return HL_FAIL_LINE(
            error, HL_ERROR_UNSUPPORTED, stream, 1, "%s",
            "expected NRRD0001 to NRRD0005, the versions of the format: convert it by unu save -f nrrd");
      continue;
    }
    if (line[0] != '#') status = read_field_line(header, line, error);
    if (status != HL_OK) return status;
  }
  if (header->type == 0 || !header->has_sizes || !header->has_encoding)
    return HL_FAIL_LINE(error, HL_ERROR_INPUT, stream, header->line,
                        "the header ends without a field \"%s\", which NRRD needs",
                        header->type == 0    ? "type"
                        : !header->has_sizes ? "sizes"
                                             : "encoding");
  if (ended && header->data.file[0] == 0 && header->data.files.count == 0)
    return HL_FAIL_LINE(
        error, HL_ERROR_INPUT, stream, header->line, "%s",
        "the file ends with its header: neither an empty line and voxels, nor a \"data file\"");
  return HL_OK;
}
