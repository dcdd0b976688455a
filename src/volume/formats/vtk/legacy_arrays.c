/* volume/formats/vtk/legacy_arrays.c - reads the part of legacy .vtk files that all of their data sets share:
 * the opening lines and the arrays of POINT_DATA and CELL_DATA.
 *
 * In: a stream of lines with keywords. Out: a call of `meet` for each array, with the stream at the array's
 * values. */
#include "volume/formats/vtk/legacy_arrays.h"

#include <string.h>

#include "volume/convert.h"
#include "volume/formats/format.h"
#include "volume/io/text.h"

enum { WORD_BYTES = HL_LEGACY_WORD_BYTES };

hl_status hl_legacy_vtk_fail(const hl_legacy_vtk *file, const char *message, const char *text,
                             hl_error *error) {
  char shown[HL_PRINTABLE_BYTES];
  return HL_FAIL_LINE(error, HL_ERROR_INPUT, file->stream, file->line, "%s \"%s\"", message,
                      hl_text_printable(shown, text));
}

hl_status hl_legacy_vtk_line(hl_legacy_vtk *file, char line[HL_LINE_BYTES], bool *ended, hl_error *error) {
  file->line++;
  return hl_stream_line(file->stream, line, ended, error);
}

static hl_status read_opening(hl_legacy_vtk *file, hl_error *error) {
  char line[HL_LINE_BYTES];
  bool ended;
  /* Reads the line "# vtk DataFile Version x.y". */
  hl_status status = hl_legacy_vtk_line(file, line, &ended, error);
  if (status == HL_OK) status = hl_legacy_vtk_line(file, line, &ended, error);
  do {
    if (status == HL_OK) status = hl_legacy_vtk_line(file, line, &ended, error);
  } while (status == HL_OK && !ended && *hl_text_trim(line) == 0);
  if (status != HL_OK) return status;
  file->text = hl_text_equal(hl_text_trim(line), "ASCII");
  if (file->text || hl_text_equal(hl_text_trim(line), "BINARY")) return HL_OK;
  return hl_legacy_vtk_fail(file, "expected ASCII or BINARY, not", line, error);
}

hl_status hl_legacy_vtk_type(const hl_legacy_vtk *file, const char *name, hl_voxel_type *type,
                             hl_error *error) {
  static const hl_named_type types[] = {
      {"unsigned_char", HL_VOXEL_U8},
      {"char|signed_char", HL_VOXEL_I8},
      {"unsigned_short", HL_VOXEL_U16},
      {"short", HL_VOXEL_I16},
      {"unsigned_int", HL_VOXEL_U32},
      {"int|vtkIdType", HL_VOXEL_I32}, /* VTK writes indices (vtkIdType) as int, independently of their size
                                        * in memory */
      {"unsigned_long|vtktypeuint64", HL_VOXEL_U64},
      {"long|vtktypeint64", HL_VOXEL_I64},
      {"float", HL_VOXEL_F32},
      {"double", HL_VOXEL_F64}};
  if (hl_find_type(types, sizeof types / sizeof *types, name, type)) return HL_OK;
  char shown[HL_PRINTABLE_BYTES];
  return HL_FAIL_LINE(
      error, hl_text_is_one_of(name, "bit|string") ? HL_ERROR_UNSUPPORTED : HL_ERROR_INPUT, file->stream,
      file->line,
      "values of type \"%s\" are not read: integers, float and double are: save it as one of these",
      hl_text_printable(shown, name));
}

/* Skips `count` values of an array. */
static hl_status skip_values(hl_legacy_vtk *file, size_t count, size_t value_bytes, hl_error *error) {
  if (!file->text) return hl_stream_skip(file->stream, (uint64_t)count * value_bytes, error);
  for (bool inside = false; count > 0;) {
    const unsigned char *bytes;
    size_t available, n;
    hl_status status = hl_stream_peek(file->stream, 1, &bytes, &available, error);
    if (status != HL_OK || available == 0) return status;
    for (n = 0; n < available && count > 0; n++) {
      bool space = hl_is_space((char)bytes[n]);
      if (inside && space) count--;
      inside = !space;
    }
    hl_stream_take(file->stream, n);
  }
  return HL_OK;
}

/* The greatest number of values of an array. */
static const size_t VALUES_MOST = SIZE_MAX / 8;

/* Checks the type and the size of an array, and calls the file's `meet` function for the array. */
static hl_status meet(hl_legacy_vtk *file, hl_legacy_array array, const char *type_name, hl_error *error) {
  size_t values;
  hl_status status = hl_legacy_vtk_type(file, type_name, &array.type, error);
  if (status != HL_OK) return status;
  if (__builtin_mul_overflow(array.tuples, array.components, &values) || values > VALUES_MOST)
    return hl_legacy_vtk_fail(file, "impossible number of values in an array of type", type_name, error);
  array.of_points = file->in_point_data;
  array.of_neither = !file->has_section;
  return file->meet(file, &array, error);
}

hl_status hl_legacy_vtk_skip_array(hl_legacy_vtk *file, const hl_legacy_array *array, hl_error *error) {
  return skip_values(file, array->tuples * array->components, hl_voxel_type_bytes(array->type), error);
}

/* Reads the line "SCALARS name type [components]" and the line "LOOKUP_TABLE name" after it, which some old
 * files lack. */
static hl_status read_scalars(hl_legacy_vtk *file, const char *arguments, hl_error *error) {
  char name[WORD_BYTES], type[WORD_BYTES], line[HL_LINE_BYTES];
  const char *cursor = arguments;
  size_t components = 1;
  if (!hl_text_word(&cursor, name, sizeof name) || !hl_text_word(&cursor, type, sizeof type) ||
      hl_text_sizes(cursor, &components, 1) < 0 || components < 1 || components > 1024)
    return hl_legacy_vtk_fail(file, "expected \"SCALARS name type [components]\", not", arguments, error);
  const unsigned char *bytes;
  size_t available;
  hl_status status = hl_stream_peek(file->stream, 12, &bytes, &available, error);
  if (status == HL_OK && available >= 12 && hl_text_starts((const char *)bytes, "LOOKUP_TABLE")) {
    bool ended;
    status = hl_legacy_vtk_line(file, line, &ended, error);
  }
  return status == HL_OK
             ? meet(file,
                    (hl_legacy_array){
                        .kind = "SCALARS", .name = name, .components = components, .tuples = file->tuples},
                    type, error)
             : status;
}

/* Reads the line "VECTORS name type", or the line of another keyword with a fixed number of components, such
 * as NORMALS. */
static hl_status read_vectors(hl_legacy_vtk *file, const char *kind, size_t components, const char *arguments,
                              hl_error *error) {
  char name[WORD_BYTES], type[WORD_BYTES];
  const char *cursor = arguments;
  if (!hl_text_word(&cursor, name, sizeof name) || !hl_text_word(&cursor, type, sizeof type))
    return hl_legacy_vtk_fail(file, "expected \"name type\", not", arguments, error);
  return meet(file,
              (hl_legacy_array){.kind = kind, .name = name, .components = components, .tuples = file->tuples},
              type, error);
}

/* Reads "TEXTURE_COORDINATES name components type". */
static hl_status read_coordinates(hl_legacy_vtk *file, const char *arguments, hl_error *error) {
  char name[WORD_BYTES], dimension[WORD_BYTES], type[WORD_BYTES];
  const char *cursor = arguments;
  size_t components;
  if (!hl_text_word(&cursor, name, sizeof name) || !hl_text_word(&cursor, dimension, sizeof dimension) ||
      !hl_text_word(&cursor, type, sizeof type) || hl_text_sizes(dimension, &components, 1) != 1 ||
      components < 1 || components > 1024)
    return hl_legacy_vtk_fail(file, "expected \"name components type\", not", arguments, error);
  return meet(
      file,
      (hl_legacy_array){
          .kind = "TEXTURE_COORDINATES", .name = name, .components = components, .tuples = file->tuples},
      type, error);
}

/* Skips "LOOKUP_TABLE name size" and its colours, each of which is four bytes or, in a text file, four
 * numbers. */
static hl_status skip_table(hl_legacy_vtk *file, const char *arguments, hl_error *error) {
  char name[WORD_BYTES];
  const char *cursor = arguments;
  size_t colors;
  if (!hl_text_word(&cursor, name, sizeof name) || hl_text_sizes(cursor, &colors, 1) != 1 ||
      colors > SIZE_MAX / 8)
    return hl_legacy_vtk_fail(file, "expected \"LOOKUP_TABLE name size\", not", arguments, error);
  return skip_values(file, 4 * colors, 1, error);
}

/* Reads "COLOR_SCALARS name components", which VTK writes for scalars of 8 bits: as bytes, or in a text file
 * as values divided by 255. */
static hl_status read_color_scalars(hl_legacy_vtk *file, const char *arguments, hl_error *error) {
  char name[WORD_BYTES];
  const char *cursor = arguments;
  size_t components;
  if (!hl_text_word(&cursor, name, sizeof name) || hl_text_sizes(cursor, &components, 1) != 1 ||
      components < 1 || components > 1024)
    return hl_legacy_vtk_fail(file, "expected \"COLOR_SCALARS name components\", not", arguments, error);
  return meet(file,
              (hl_legacy_array){.kind = "COLOR_SCALARS",
                                .name = name,
                                .components = components,
                                .tuples = file->tuples,
                                .is_fraction = true},
              "unsigned_char", error);
}

/* Skips the metadata that newer files add after an array. The metadata end with an empty line. */
static hl_status skip_metadata(hl_legacy_vtk *file, hl_error *error) {
  char line[HL_LINE_BYTES];
  bool ended;
  hl_status status;
  do status = hl_legacy_vtk_line(file, line, &ended, error);
  while (status == HL_OK && !ended && *hl_text_trim(line) != 0);
  return status;
}

/* Skips a text in a binary file. The text begins with its length, in one, two, four or eight bytes; the first
 * two bits state the number of these bytes. The characters follow (vtkDataWriter). */
static hl_status skip_binary_string(hl_legacy_vtk *file, hl_error *error) {
  static const size_t more[4] = {7, 3, 1, 0}; /* number of bytes of the length after its first byte */
  unsigned char first, rest[7];
  hl_status status = hl_stream_read_all(file->stream, &first, 1, error);
  if (status == HL_OK) status = hl_stream_read_all(file->stream, rest, more[first >> 6], error);
  uint64_t length = first & 0x3f;
  for (size_t n = 0; status == HL_OK && n < more[first >> 6]; n++) length = length << 8 | rest[n];
  return status == HL_OK ? hl_stream_skip(file->stream, length, error) : status;
}

/* Skips the values of an array of bits, or of an array of texts. In a text file, each text has a line of its
 * own. */
static hl_status skip_other(hl_legacy_vtk *file, const char *type, size_t values, hl_error *error) {
  char line[HL_LINE_BYTES];
  bool ended = false;
  hl_status status = HL_OK;
  if (hl_text_equal(type, "bit"))
    return file->text ? skip_values(file, values, 1, error)
                      : hl_stream_skip(file->stream, values / 8 + (values % 8 != 0), error);
  for (size_t n = 0; n < values && status == HL_OK && !ended; n++)
    status = file->text ? hl_legacy_vtk_line(file, line, &ended, error) : skip_binary_string(file, error);
  return status;
}

/* Reads "FIELD name n" and the n arrays that follow. Each array consists of a line "name components tuples
 * type" and of values. */
static hl_status read_fields(hl_legacy_vtk *file, const char *arguments, hl_error *error) {
  char word[WORD_BYTES], line[HL_LINE_BYTES];
  const char *cursor = arguments;
  size_t arrays, shape[2];
  if (!hl_text_word(&cursor, word, sizeof word) || hl_text_sizes(cursor, &arrays, 1) != 1)
    return hl_legacy_vtk_fail(file, "expected \"FIELD name number\", not", arguments, error);
  while (arrays > 0 && !file->found) {
    bool ended;
    hl_status status = hl_legacy_vtk_line(file, line, &ended, error);
    if (status != HL_OK || ended) return status;
    cursor = line;
    /* An empty line is the end of the last line of the values before. */
    if (!hl_text_word(&cursor, word, sizeof word)) continue;
    if (hl_text_equal(word, "METADATA")) {
      status = skip_metadata(file, error);
      if (status != HL_OK) return status;
      continue;
    }
    char sizes[2 * WORD_BYTES], second[WORD_BYTES], type[WORD_BYTES];
    if (!hl_text_word(&cursor, sizes, WORD_BYTES) || !hl_text_word(&cursor, second, sizeof second) ||
        hl_text_sizes(sizes, &shape[0], 1) != 1 || hl_text_sizes(second, &shape[1], 1) != 1 ||
        !hl_text_word(&cursor, type, sizeof type) || shape[0] < 1)
      return hl_legacy_vtk_fail(file, "expected \"name components tuples type\", not", line, error);
    size_t values;
    if (shape[1] == 0) { /* an array without values */
      arrays--;
      continue;
    }
    if (hl_text_is_one_of(type, "string|bit")) {
      if (__builtin_mul_overflow(shape[0], shape[1], &values) || values > VALUES_MOST)
        return hl_legacy_vtk_fail(file, "impossible number of values in", line, error);
      status = skip_other(file, type, values, error);
      if (status != HL_OK) return status;
      arrays--;
      continue;
    }
    status = meet(
        file, (hl_legacy_array){.kind = "FIELD", .name = word, .components = shape[0], .tuples = shape[1]},
        type, error);
    if (status != HL_OK) return status;
    arrays--;
  }
  return HL_OK;
}

static hl_status begin_section(hl_legacy_vtk *file, bool points, const char *arguments, hl_error *error) {
  file->in_point_data = points;
  file->has_section = true;
  if (hl_text_sizes(arguments, &file->tuples, 1) != 1)
    return hl_legacy_vtk_fail(file, "expected the number of values, not", arguments, error);
  return HL_OK;
}
static hl_status read_keyword(hl_legacy_vtk *file, const char *keyword, const char *arguments,
                              hl_error *error) {
  if (hl_text_equal(keyword, "POINT_DATA")) return begin_section(file, true, arguments, error);
  if (hl_text_equal(keyword, "CELL_DATA")) return begin_section(file, false, arguments, error);
  if (hl_text_equal(keyword, "SCALARS")) return read_scalars(file, arguments, error);
  if (hl_text_equal(keyword, "COLOR_SCALARS")) return read_color_scalars(file, arguments, error);
  if (hl_text_equal(keyword, "FIELD")) return read_fields(file, arguments, error);
  if (hl_text_is_one_of(keyword, "VECTORS|NORMALS")) return read_vectors(file, keyword, 3, arguments, error);
  if (hl_text_equal(keyword, "TENSORS")) return read_vectors(file, keyword, 9, arguments, error);
  if (hl_text_equal(keyword, "TENSORS6")) return read_vectors(file, keyword, 6, arguments, error);
  if (hl_text_equal(keyword, "TEXTURE_COORDINATES")) return read_coordinates(file, arguments, error);
  if (hl_text_equal(keyword, "LOOKUP_TABLE")) return skip_table(file, arguments, error);
  if (hl_text_equal(keyword, "METADATA")) return skip_metadata(file, error);
  return file->keyword(file, keyword, arguments, error);
}

hl_status hl_legacy_vtk_read(hl_legacy_vtk *file, hl_error *error) {
  char line[HL_LINE_BYTES], keyword[WORD_BYTES];
  hl_status status = read_opening(file, error);
  while (status == HL_OK && !file->found) {
    bool ended;
    status = hl_legacy_vtk_line(file, line, &ended, error);
    if (status != HL_OK || ended) return status;
    const char *cursor = hl_text_trim(line);
    if (*cursor == 0) continue;
    if (!hl_text_word(&cursor, keyword, sizeof keyword))
      return hl_legacy_vtk_fail(file, "expected a keyword, not", line, error);
    while (hl_is_space(*cursor)) cursor++;
    status = read_keyword(file, keyword, cursor, error);
  }
  return status;
}

bool hl_legacy_vtk_has_content(const unsigned char *bytes, size_t length) {
  return length >= 14 && memcmp(bytes, "# vtk DataFile", 14) == 0;
}
