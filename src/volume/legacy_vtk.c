/* volume/legacy_vtk.c - legacy .vtk files with STRUCTURED_POINTS, ASCII or BINARY (big-endian).
 *
 * After three lines (mark, title, ASCII or BINARY) come keywords. A first pass lists the arrays under
 * POINT_DATA (SCALARS, COLOR_SCALARS, VECTORS, NORMALS, TENSORS, TEXTURE_COORDINATES and the arrays of a
 * FIELD), up to the first unknown keyword; a second pass stops at the values of the chosen array. A pipe
 * cannot be read twice: it is read once, up to the first array of one component or of the wanted name. */
#include <string.h>

#include "volume/convert.h"
#include "volume/decoders.h"
#include "volume/format.h"
#include "volume/text.h"

enum { WORD_BYTES = 256 };

typedef struct vtk_header {
  hl_stream *stream;
  hl_payload payload;
  int line;
  bool has_dimensions, in_point_data;
  size_t tuples; /* values per array of the POINT_DATA or CELL_DATA section; of the volume's array once it is
                    found */
  hl_load_request *request;
  bool lists;    /* first pass: arrays are listed */
  bool once;     /* there is no second pass: stop at the first suitable array */
  size_t arrays; /* number of arrays under POINT_DATA so far */
  bool found;    /* the stream is at the voxels */
} vtk_header;

static hl_status fail(const vtk_header *header, const char *message, const char *text, hl_error *error) {
  char shown[HL_PRINTABLE_BYTES];
  return HL_FAIL_LINE(error, HL_ERROR_INPUT, header->stream, header->line, "%s \"%s\"", message,
                      hl_text_printable(shown, text));
}

static hl_status next_line(vtk_header *header, char line[HL_LINE_BYTES], bool *ended, hl_error *error) {
  header->line++;
  return hl_stream_line(header->stream, line, ended, error);
}

static hl_status read_opening(vtk_header *header, hl_error *error) {
  char line[HL_LINE_BYTES];
  bool ended;
  hl_status status = next_line(header, line, &ended, error); /* "# vtk DataFile Version x.y" */
  if (status == HL_OK) status = next_line(header, line, &ended, error);
  do {
    if (status == HL_OK) status = next_line(header, line, &ended, error);
  } while (status == HL_OK && !ended && *hl_text_trim(line) == 0);
  if (status != HL_OK) return status;
  header->payload.text = hl_text_equal(hl_text_trim(line), "ASCII");
  header->payload.big_endian = true;
  if (header->payload.text || hl_text_equal(hl_text_trim(line), "BINARY")) return HL_OK;
  return fail(header, "expected ASCII or BINARY, not", line, error);
}

static hl_status read_type(const vtk_header *header, const char *name, hl_voxel_type *type, hl_error *error) {
  static const hl_named_type types[] = {
      {"unsigned_char", HL_VOXEL_U8},
      {"char|signed_char", HL_VOXEL_I8},
      {"unsigned_short", HL_VOXEL_U16},
      {"short", HL_VOXEL_I16},
      {"unsigned_int", HL_VOXEL_U32},
      {"int|vtkIdType", HL_VOXEL_I32}, /* VTK writes indices as int, whatever their width in memory */
      {"unsigned_long|vtktypeuint64", HL_VOXEL_U64},
      {"long|vtktypeint64", HL_VOXEL_I64},
      {"float", HL_VOXEL_F32},
      {"double", HL_VOXEL_F64}};
  if (hl_find_type(types, sizeof types / sizeof *types, name, type)) return HL_OK;
  char shown[HL_PRINTABLE_BYTES];
  return HL_FAIL_LINE(error, hl_text_is_one_of(name, "bit|string") ? HL_ERROR_UNSUPPORTED : HL_ERROR_INPUT,
                      header->stream, header->line,
                      "values of type \"%s\" are not read: integers, float and double are",
                      hl_text_printable(shown, name));
}

/* Passes over count values of an array. */
static hl_status skip_values(vtk_header *header, size_t count, size_t value_bytes, hl_error *error) {
  if (!header->payload.text) return hl_stream_skip(header->stream, (uint64_t)count * value_bytes, error);
  for (bool inside = false; count > 0;) {
    const unsigned char *bytes;
    size_t available, n;
    hl_status status = hl_stream_peek(header->stream, 1, &bytes, &available, error);
    if (status != HL_OK || available == 0) return status;
    for (n = 0; n < available && count > 0; n++) {
      bool space = hl_is_space((char)bytes[n]);
      if (inside && space) count--;
      inside = !space;
    }
    hl_stream_take(header->stream, n);
  }
  return HL_OK;
}

/* Whether this pass stops at the array of this number and name, under POINT_DATA. */
static bool is_wanted(const vtk_header *header, const char *name, size_t components, size_t index) {
  const hl_load_request *request = header->request;
  if (!header->lists) return index == request->chosen;
  if (!header->once) return false;
  return request->array != NULL ? strcmp(request->array, name) == 0 : components == 1;
}

/* The values of an array come next: stops there if it is the volume's array. */
static hl_status meet_array(vtk_header *header, const char *name, const char *type_name, size_t components,
                            size_t tuples, hl_error *error) {
  hl_voxel_type type = HL_VOXEL_U8;
  hl_status status = read_type(header, type_name, &type, error);
  if (status != HL_OK) return status;
  size_t index = header->arrays;
  if (header->in_point_data) header->arrays++;
  if (header->in_point_data && header->lists)
    status = hl_arrays_add(header->request, name, components, type, false, error);
  if (status != HL_OK) return status;
  if (!header->in_point_data || !is_wanted(header, name, components, index)) {
    size_t values;
    if (__builtin_mul_overflow(tuples, components, &values) || values > SIZE_MAX / 8)
      return fail(header, "impossible number of values in an array of type", type_name, error);
    return skip_values(header, values, hl_voxel_type_bytes(type), error);
  }
  if (header->once) header->request->chosen = index;
  header->payload.grid.type = type;
  header->payload.components = components;
  header->payload.block = 1;
  if (type == HL_VOXEL_U8) header->payload.colors = HL_COLORS_MEANT; /* as VTK's mappers take bytes */
  header->tuples = tuples;
  header->found = true;
  return HL_OK;
}

/* "SCALARS name type [components]", then, in all but some old files, "LOOKUP_TABLE name". */
static hl_status read_scalars(vtk_header *header, const char *arguments, hl_error *error) {
  char name[WORD_BYTES], type[WORD_BYTES], line[HL_LINE_BYTES];
  const char *cursor = arguments;
  size_t components = 1;
  if (!hl_text_word(&cursor, name, sizeof name) || !hl_text_word(&cursor, type, sizeof type) ||
      hl_text_sizes(cursor, &components, 1) < 0 || components < 1 || components > 1024)
    return fail(header, "expected \"SCALARS name type [components]\", not", arguments, error);
  const unsigned char *bytes;
  size_t available;
  hl_status status = hl_stream_peek(header->stream, 12, &bytes, &available, error);
  if (status == HL_OK && available >= 12 && hl_text_starts((const char *)bytes, "LOOKUP_TABLE")) {
    bool ended;
    status = next_line(header, line, &ended, error);
  }
  return status == HL_OK ? meet_array(header, name, type, components, header->tuples, error) : status;
}

/* "VECTORS name type" and other keywords with a fixed number of components. */
static hl_status read_vectors(vtk_header *header, size_t components, const char *arguments, hl_error *error) {
  char name[WORD_BYTES], type[WORD_BYTES];
  const char *cursor = arguments;
  if (!hl_text_word(&cursor, name, sizeof name) || !hl_text_word(&cursor, type, sizeof type))
    return fail(header, "expected \"name type\", not", arguments, error);
  return meet_array(header, name, type, components, header->tuples, error);
}

/* "TEXTURE_COORDINATES name components type" */
static hl_status read_coordinates(vtk_header *header, const char *arguments, hl_error *error) {
  char name[WORD_BYTES], dimension[WORD_BYTES], type[WORD_BYTES];
  const char *cursor = arguments;
  size_t components;
  if (!hl_text_word(&cursor, name, sizeof name) || !hl_text_word(&cursor, dimension, sizeof dimension) ||
      !hl_text_word(&cursor, type, sizeof type) || hl_text_sizes(dimension, &components, 1) != 1 ||
      components < 1 || components > 1024)
    return fail(header, "expected \"name components type\", not", arguments, error);
  return meet_array(header, name, type, components, header->tuples, error);
}

/* "LOOKUP_TABLE name size" with four bytes, or numbers, for each colour: passed over. */
static hl_status skip_table(vtk_header *header, const char *arguments, hl_error *error) {
  char name[WORD_BYTES];
  const char *cursor = arguments;
  size_t colors;
  if (!hl_text_word(&cursor, name, sizeof name) || hl_text_sizes(cursor, &colors, 1) != 1 ||
      colors > SIZE_MAX / 8)
    return fail(header, "expected \"LOOKUP_TABLE name size\", not", arguments, error);
  return skip_values(header, 4 * colors, 1, error);
}

/* "COLOR_SCALARS name components", which VTK writes for 8 bit scalars: bytes, or fractions of 255 as text. */
static hl_status read_color_scalars(vtk_header *header, const char *arguments, hl_error *error) {
  char name[WORD_BYTES];
  const char *cursor = arguments;
  size_t components;
  if (!hl_text_word(&cursor, name, sizeof name) || hl_text_sizes(cursor, &components, 1) != 1 ||
      components < 1 || components > 1024)
    return fail(header, "expected \"COLOR_SCALARS name components\", not", arguments, error);
  hl_status status = meet_array(header, name, "unsigned_char", components, header->tuples, error);
  header->payload.text_is_fraction = header->found;
  return status;
}

/* Skips what newer files add after an array: lines up to an empty one. */
static hl_status skip_metadata(vtk_header *header, hl_error *error) {
  char line[HL_LINE_BYTES];
  bool ended;
  hl_status status;
  do status = next_line(header, line, &ended, error);
  while (status == HL_OK && !ended && *hl_text_trim(line) != 0);
  return status;
}

/* "FIELD name n", then n times "name components tuples type" and the values. */
static hl_status read_fields(vtk_header *header, const char *arguments, hl_error *error) {
  char word[WORD_BYTES], line[HL_LINE_BYTES];
  const char *cursor = arguments;
  size_t arrays, shape[2];
  if (!hl_text_word(&cursor, word, sizeof word) || hl_text_sizes(cursor, &arrays, 1) != 1)
    return fail(header, "expected \"FIELD name number\", not", arguments, error);
  while (arrays > 0 && !header->found) {
    bool ended;
    hl_status status = next_line(header, line, &ended, error);
    if (status != HL_OK || ended) return status;
    cursor = line;
    if (!hl_text_word(&cursor, word, sizeof word)) continue; /* the line's end after the values */
    if (hl_text_equal(word, "METADATA")) {
      status = skip_metadata(header, error);
      if (status != HL_OK) return status;
      continue;
    }
    char sizes[2 * WORD_BYTES], second[WORD_BYTES], type[WORD_BYTES];
    if (!hl_text_word(&cursor, sizes, WORD_BYTES) || !hl_text_word(&cursor, second, sizeof second) ||
        hl_text_sizes(sizes, &shape[0], 1) != 1 || hl_text_sizes(second, &shape[1], 1) != 1 ||
        !hl_text_word(&cursor, type, sizeof type) || shape[0] < 1)
      return fail(header, "expected \"name components tuples type\", not", line, error);
    status = meet_array(header, word, type, shape[0], shape[1], error);
    if (status != HL_OK) return status;
    arrays--;
  }
  return HL_OK;
}

static hl_status read_geometry(vtk_header *header, const char *keyword, const char *arguments,
                               hl_error *error) {
  hl_volume_description *grid = &header->payload.grid;
  double numbers[3];
  bool sound = true;
  if (hl_text_equal(keyword, "DIMENSIONS")) {
    sound = header->has_dimensions = hl_text_sizes(arguments, grid->dimensions, 3) == 3;
  } else if (hl_text_numbers(arguments, numbers, 3) != 3) {
    sound = false;
  } else {
    for (int axis = 0; axis < 3; axis++)
      if (hl_text_equal(keyword, "ORIGIN")) grid->origin[axis] = numbers[axis];
      else grid->axis[axis][axis] = numbers[axis];
  }
  return sound ? HL_OK : fail(header, "expected three numbers, not", arguments, error);
}

static hl_status begin_section(vtk_header *header, bool points, const char *arguments, hl_error *error) {
  header->in_point_data = points;
  if (hl_text_sizes(arguments, &header->tuples, 1) != 1)
    return fail(header, "expected the number of values, not", arguments, error);
  return HL_OK;
}

static hl_status read_keyword(vtk_header *header, const char *keyword, const char *arguments,
                              hl_error *error) {
  char shown[HL_PRINTABLE_BYTES];
  if (hl_text_equal(keyword, "DATASET")) {
    if (hl_text_equal(arguments, "STRUCTURED_POINTS")) return HL_OK;
    return HL_FAIL_LINE(error, HL_ERROR_UNSUPPORTED, header->stream, header->line,
                        "a data set of kind \"%s\" is not read: STRUCTURED_POINTS is",
                        hl_text_printable(shown, arguments));
  }
  static const char *const geometry[] = {"DIMENSIONS", "SPACING", "ASPECT_RATIO", "ORIGIN"};
  for (int n = 0; n < 4; n++)
    if (hl_text_equal(keyword, geometry[n])) return read_geometry(header, keyword, arguments, error);
  if (hl_text_equal(keyword, "POINT_DATA")) return begin_section(header, true, arguments, error);
  if (hl_text_equal(keyword, "CELL_DATA")) return begin_section(header, false, arguments, error);
  if (hl_text_equal(keyword, "SCALARS")) return read_scalars(header, arguments, error);
  if (hl_text_equal(keyword, "COLOR_SCALARS")) return read_color_scalars(header, arguments, error);
  if (hl_text_equal(keyword, "FIELD")) return read_fields(header, arguments, error);
  if (hl_text_is_one_of(keyword, "VECTORS|NORMALS")) return read_vectors(header, 3, arguments, error);
  if (hl_text_equal(keyword, "TENSORS")) return read_vectors(header, 9, arguments, error);
  if (hl_text_equal(keyword, "TENSORS6")) return read_vectors(header, 6, arguments, error);
  if (hl_text_equal(keyword, "TEXTURE_COORDINATES")) return read_coordinates(header, arguments, error);
  if (hl_text_equal(keyword, "LOOKUP_TABLE")) return skip_table(header, arguments, error);
  if (hl_text_equal(keyword, "METADATA")) return skip_metadata(header, error);
  return HL_FAIL_LINE(
      error, HL_ERROR_UNSUPPORTED, header->stream, header->line,
      "\"%s\" is not read: the volume must be SCALARS or in a FIELD, and come before other data",
      hl_text_printable(shown, keyword));
}

/* The keywords up to the volume's values, or to the file's end. */
static hl_status read_header(vtk_header *header, hl_error *error) {
  char line[HL_LINE_BYTES], keyword[WORD_BYTES];
  hl_status status = read_opening(header, error);
  while (status == HL_OK && !header->found) {
    bool ended;
    status = next_line(header, line, &ended, error);
    if (status != HL_OK || ended) return status;
    const char *cursor = hl_text_trim(line);
    if (*cursor == 0) continue;
    if (!hl_text_word(&cursor, keyword, sizeof keyword))
      return fail(header, "expected a keyword, not", line, error);
    while (hl_is_space(*cursor)) cursor++;
    status = read_keyword(header, keyword, cursor, error);
  }
  return status;
}

static vtk_header begin(hl_stream *stream, hl_load_request *request, bool lists) {
  vtk_header header = {
      .stream = stream, .request = request, .lists = lists, .once = lists && !hl_stream_can_restart(stream)};
  hl_payload_defaults(&header.payload);
  header.payload.trailing = HL_TRAILING_IGNORED;
  return header;
}

/* Whether the wanted array was found before the error. */
static bool is_enough(const hl_load_request *request, hl_status status) {
  if (status != HL_ERROR_INPUT && status != HL_ERROR_UNSUPPORTED) return false;
  for (size_t n = 0; n < request->array_count; n++)
    if (request->array != NULL ? strcmp(request->arrays[n].name, request->array) == 0
                               : request->arrays[n].components == 1)
      return true;
  return false;
}

/* Goes to the values of the chosen array. Errors after them in the file do not matter. */
static hl_status find_volume(hl_stream **stream, hl_load_request *request, vtk_header *header,
                             hl_error *error) {
  *header = begin(*stream, request, true);
  hl_error first = {0};
  hl_status status = read_header(header, &first);
  if (status != HL_OK && !is_enough(request, status)) {
    if (error != NULL) *error = first;
    return status;
  }
  if (request->array_count == 0)
    return HL_FAIL_LINE(error, HL_ERROR_INPUT, *stream, header->line, "%s",
                        "the file ends without POINT_DATA and SCALARS, which hold the volume");
  if (header->once && header->found) return HL_OK;
  status = hl_arrays_choose(request, (*stream)->path, -1, error);
  if (status == HL_OK) status = hl_stream_restart(stream, error);
  if (status == HL_OK) status = hl_stream_inflate_if_gzip(stream, error);
  if (status != HL_OK) return status;
  *header = begin(*stream, request, false);
  return read_header(header, error);
}

static bool has_content(const unsigned char *bytes, size_t length) {
  return length >= 14 && memcmp(bytes, "# vtk DataFile", 14) == 0;
}

static hl_status load(hl_stream **stream, hl_load_request *request, hl_volume **volume, hl_error *error) {
  vtk_header header;
  hl_status status = find_volume(stream, request, &header, error);
  if (status != HL_OK) return status;
  if (!header.has_dimensions)
    return HL_FAIL_LINE(error, HL_ERROR_INPUT, *stream, header.line, "%s", "the file has no DIMENSIONS");
  status = hl_volume_check_grid(&header.payload.grid, (*stream)->path, error);
  if (status != HL_OK) return status;
  const size_t *dimension = header.payload.grid.dimensions;
  if (!header.found || header.tuples != dimension[0] * dimension[1] * dimension[2])
    return hl_fail(error, HL_ERROR_INPUT,
                   "%s: POINT_DATA has %zu values, DIMENSIONS %zu x %zu x %zu need %zu", (*stream)->path,
                   header.tuples, dimension[0], dimension[1], dimension[2],
                   dimension[0] * dimension[1] * dimension[2]);
  status = hl_component_choose(request, (*stream)->path, false, &header.payload, error);
  return status == HL_OK ? hl_payload_read(*stream, &header.payload, request->spacing, volume, error)
                         : status;
}

const hl_format hl_format_legacy_vtk = {
    .name = ".vtk",
    .endings = {".vtk"},
    .beginning = "\"# vtk DataFile Version\"",
    .has_content = has_content,
    .load = load,
};
