/* volume/formats/slc.c - reads VolVis' volumes (.slc), as VTK's example data have them.
 *
 * The header is text: the mark 11111, three sizes and the bits of a voxel, three spacings, and four numbers
 * that stand for the unit of length, the origin of the data, the processing of the data, and the packing of
 * voxels. The size of a small picture and an X follow, then the picture's bytes, three for each pixel. The
 * slices of voxels come last; x is the fastest axis. A packed slice begins with the number of its packed
 * bytes and an X. Source: the files of VTK's example data, and the names that VolVis' own source gives to the
 * header's numbers. */
#include <string.h>

#include "core/memory.h"
#include "volume/formats/format.h"
#include "volume/io/text.h"

enum { WORD_BYTES = 64, MARK = 11111, MARK_BYTES = 5, SIZE_MOST = 1 << 24, RUN_MOST = 127 };
enum { PLAIN = 0, RUNS = 1 }; /* the packings of voxels */

typedef struct slc_header {
  size_t size[3], bits, packing;
  double spacing[3];
  const char *unit;
} slc_header;

/* ---- words of text ---- */

static hl_status fail_at(const hl_stream *stream, const char *what, hl_error *error) {
  return hl_fail_offset(error, HL_ERROR_INPUT, (int64_t)stream->offset, "%s, byte %llu: %s", stream->path,
                        (unsigned long long)stream->offset, what);
}

/* Reads the next word, which white space or the letter X ends; an X is a word of its own. */
static hl_status read_word(hl_stream *stream, char word[WORD_BYTES], hl_error *error) {
  size_t length = 0;
  for (;;) {
    const unsigned char *bytes;
    size_t available;
    hl_status status = hl_stream_peek(stream, 1, &bytes, &available, error);
    if (status != HL_OK) return status;
    const bool is_end = available == 0 || hl_is_space((char)*bytes) || (*bytes == 'X' && length > 0);
    if (is_end && (length > 0 || available == 0)) break;
    if (!is_end && length + 1 == WORD_BYTES)
      return fail_at(stream, "a number of the header is too long", error);
    const bool is_mark = *bytes == 'X';
    if (!is_end) word[length++] = (char)*bytes;
    hl_stream_take(stream, 1);
    if (is_mark) break;
  }
  word[length] = 0;
  return HL_OK;
}

static hl_status read_sizes(hl_stream *stream, size_t *values, int count, hl_error *error) {
  char word[WORD_BYTES];
  for (int n = 0; n < count; n++) {
    hl_status status = read_word(stream, word, error);
    if (status != HL_OK) return status;
    if (hl_text_sizes(word, &values[n], 1) != 1)
      return fail_at(stream, "a whole number must stand here", error);
  }
  return HL_OK;
}

/* Reads the X that ends the text before binary data. */
static hl_status read_mark(hl_stream *stream, hl_error *error) {
  char word[WORD_BYTES];
  hl_status status = read_word(stream, word, error);
  return status != HL_OK || strcmp(word, "X") == 0 ? status : fail_at(stream, "an X must stand here", error);
}

static hl_status read_spacings(hl_stream *stream, double spacing[3], hl_error *error) {
  char word[WORD_BYTES];
  for (int axis = 0; axis < 3; axis++) {
    hl_status status = read_word(stream, word, error);
    if (status != HL_OK) return status;
    if (!hl_text_number(word, strlen(word), &spacing[axis]))
      return fail_at(stream, "a spacing must stand here", error);
  }
  return HL_OK;
}

/* Reads the header, and skips the small picture. */
static hl_status read_header(hl_stream *stream, slc_header *header, hl_error *error) {
  static const char *const units[] = {"metre", "millimetre", "micrometre"};
  size_t mark, kinds[4], picture[2];
  hl_status status = read_sizes(stream, &mark, 1, error);
  if (status == HL_OK && mark != MARK) return fail_at(stream, "the file does not begin with 11111", error);
  if (status == HL_OK) status = read_sizes(stream, header->size, 3, error);
  if (status == HL_OK) status = read_sizes(stream, &header->bits, 1, error);
  if (status == HL_OK) status = read_spacings(stream, header->spacing, error);
  if (status == HL_OK) status = read_sizes(stream, kinds, 4, error);
  if (status == HL_OK) status = read_sizes(stream, picture, 2, error);
  if (status == HL_OK) status = read_mark(stream, error);
  if (status != HL_OK) return status;
  if (picture[0] > SIZE_MOST || picture[1] > SIZE_MOST)
    return fail_at(stream, "the header's picture is too large", error);
  header->unit = kinds[0] < sizeof units / sizeof *units ? units[kinds[0]] : NULL;
  header->packing = kinds[3];
  return hl_stream_skip(stream, 3 * (uint64_t)picture[0] * picture[1], error);
}

/* ---- packed slices ---- */

/* A stream that unpacks slices. The packed data are runs. The first byte of a run holds a count of 1 to 127
 * in its lower seven bits. If the highest bit of this byte is set, `count` bytes follow. If the highest bit
 * is not set, one byte follows, which is repeated `count` times. A count of 0 ends the slice. */
typedef struct run_stream {
  hl_stream base;
  size_t slice_bytes, slices; /* number of bytes of an unpacked slice; number of slices that have not begun */
  size_t left;                /* number of unpacked bytes of the current slice that belong to later runs */
  size_t packed;              /* number of packed bytes of the slice that have not been read */
  size_t run;                 /* number of bytes of the current run that have not been given to the reader */
  bool repeats;
  unsigned char value; /* the byte that is repeated */
} run_stream;

static hl_status next_byte(run_stream *runs, unsigned char *byte, hl_error *error) {
  if (runs->packed == 0) return fail_at(runs->base.below, "the packed slice is too short", error);
  runs->packed--;
  return hl_stream_read_all(runs->base.below, byte, 1, error);
}

/* Skips the remaining bytes of a packed slice, and begins the next slice. */
static hl_status begin_slice(run_stream *runs, hl_error *error) {
  hl_status status = hl_stream_skip(runs->base.below, runs->packed, error);
  if (status == HL_OK) status = read_sizes(runs->base.below, &runs->packed, 1, error);
  if (status == HL_OK) status = read_mark(runs->base.below, error);
  runs->left = runs->slice_bytes;
  runs->slices--;
  return status;
}

static hl_status begin_run(run_stream *runs, hl_error *error) {
  unsigned char byte;
  hl_status status = next_byte(runs, &byte, error);
  if (status != HL_OK) return status;
  runs->run = byte & RUN_MOST;
  runs->repeats = (byte & ~RUN_MOST) == 0;
  if (runs->run == 0 || runs->run > runs->left)
    return fail_at(runs->base.below, "the packed slice is damaged", error);
  runs->left -= runs->run;
  return runs->repeats ? next_byte(runs, &runs->value, error) : HL_OK;
}

/* Copies bytes of the current run to the reader's buffer. */
static hl_status give(run_stream *runs, unsigned char *bytes, size_t capacity, size_t *count,
                      hl_error *error) {
  *count = runs->run < capacity ? runs->run : capacity;
  runs->run -= *count;
  if (runs->repeats) {
    memset(bytes, runs->value, *count);
    return HL_OK;
  }
  if (*count > runs->packed) return fail_at(runs->base.below, "the packed slice is too short", error);
  runs->packed -= *count;
  return hl_stream_read_all(runs->base.below, bytes, *count, error);
}

static hl_status pull(hl_stream *stream, unsigned char *bytes, size_t capacity, size_t *count,
                      hl_error *error) {
  run_stream *runs = (run_stream *)stream;
  hl_status status = HL_OK;
  *count = 0;
  while (status == HL_OK && *count < capacity && (runs->run > 0 || runs->left > 0 || runs->slices > 0)) {
    size_t given = 0;
    if (runs->run > 0) status = give(runs, bytes + *count, capacity - *count, &given, error);
    else status = runs->left > 0 ? begin_run(runs, error) : begin_slice(runs, error);
    *count += given;
  }
  return status;
}

/* An upper bound of the number of bytes that the stream can still give. A run takes at least two packed
 * bytes, and gives at most 127 bytes. */
static uint64_t most_bytes(const hl_stream *stream) {
  const uint64_t bytes = hl_stream_at_most(stream->below);
  return bytes > UINT64_MAX / RUN_MOST ? UINT64_MAX : RUN_MOST * bytes;
}

static hl_status push_runs(hl_stream **stream, const slc_header *header, hl_error *error) {
  run_stream *runs = (run_stream *)hl_stream_make((*stream)->context, sizeof *runs, *stream);
  if (runs == NULL) return hl_fail_memory(error, HL_STREAM_BUFFER_BYTES, (*stream)->path);
  runs->slice_bytes = header->size[0] * header->size[1];
  runs->slices = header->size[2];
  runs->base.pull = pull;
  runs->base.at_most = most_bytes;
  *stream = &runs->base;
  return HL_OK;
}

/* ---- all steps together ---- */

static hl_status load(hl_stream **stream, hl_load_request *request, hl_volume **volume, hl_error *error) {
  slc_header header = {.bits = 0};
  hl_payload payload;
  hl_payload_defaults(&payload);
  hl_status status = read_header(*stream, &header, error);
  if (status != HL_OK) return status;
  if (header.bits != 8 || header.packing > RUNS)
    return hl_fail(
        error, HL_ERROR_UNSUPPORTED,
        "%s: voxels of %zu bits, packed in the way %zu, are not read: save voxels of 8 bits, plain or "
        "run-length encoded",
        (*stream)->path, header.bits, header.packing);
  for (int axis = 0; axis < 3; axis++) {
    payload.grid.dimensions[axis] = header.size[axis];
    payload.grid.axis[axis][axis] = header.spacing[axis];
  }
  payload.grid.type = HL_VOXEL_U8;
  payload.trailing = HL_TRAILING_WARNS;
  request->unit = header.unit;
  status = hl_volume_check_grid(&payload.grid, (*stream)->path, error);
  if (status == HL_OK) status = hl_component_only(request, (*stream)->path, false, &payload, error);
  if (status == HL_OK && header.packing == RUNS) status = push_runs(stream, &header, error);
  return status == HL_OK ? hl_payload_read(*stream, &payload, request->spacing, volume, error) : status;
}

static bool has_content(const unsigned char *bytes, size_t length) {
  return length > MARK_BYTES && memcmp(bytes, "11111", MARK_BYTES) == 0 &&
         hl_is_space((char)bytes[MARK_BYTES]);
}

const hl_format hl_format_slc = {
    .name = "VolVis .slc",
    .endings = {".slc"},
    .beginning = "11111",
    .has_content = has_content,
    .load = load,
};
