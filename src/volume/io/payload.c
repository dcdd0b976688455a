/* volume/io/payload.c - reads the voxels that a header promises.
 *
 * In: a stream at the first voxel, and the header. Out: the volume. The file's bytes are read into the
 * volume's own memory, and are converted in this memory piece by piece. Voxels of 8 bytes, whose stored
 * values are shorter, are read through a small buffer. If a volume is larger than memory, the voxels are read
 * piece by piece, and each piece is copied into pages. */
#include "volume/io/payload.h"

#include <math.h>
#include <pthread.h>
#include <string.h>

#include "core/context.h"
#include "core/memory.h"
#include "core/pool.h"
#include "volume/convert.h"
#include "volume/io/destination.h"
#include "volume/io/numbers.h"
#include "volume/io/parallel.h"
#include "volume/io/text.h"

enum { PIECE_BYTES = 1 << 20, STAGE_VOXELS = 8192, SKIPPED_BYTES = 1 << 16 };

static const bool native_is_big_endian = __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__;

void hl_payload_defaults(hl_payload *payload) {
  memset(payload, 0, sizeof *payload);
  hl_volume_description_defaults(&payload->grid);
  for (int axis = 0; axis < 3; axis++) payload->grid.dimensions[axis] = 1;
  payload->components = 1;
  payload->trailing = HL_TRAILING_WARNS;
  payload->promiser = "the header";
}

static size_t voxel_count(const hl_payload *payload) {
  const size_t *dimension = payload->grid.dimensions;
  return dimension[0] * dimension[1] * dimension[2];
}

/* The number of values of all components; UINT64_MAX on overflow. */
static uint64_t value_count(const hl_payload *payload) {
  uint64_t values;
  return __builtin_mul_overflow((uint64_t)voxel_count(payload), payload->components, &values) ? UINT64_MAX
                                                                                              : values;
}

uint64_t hl_payload_bytes(const hl_payload *payload) {
  uint64_t bytes;
  bool beyond = __builtin_mul_overflow(value_count(payload), hl_voxel_type_bytes(payload->grid.type), &bytes);
  return beyond ? UINT64_MAX : bytes;
}

static hl_status check_promise(const hl_stream *stream, const hl_payload *payload, hl_error *error) {
  hl_status status = hl_volume_check_grid(&payload->grid, stream->path, error);
  if (status != HL_OK) return status;
  uint64_t most = hl_stream_at_most(stream), promised = hl_payload_bytes(payload);
  if (payload->text)
    promised = value_count(payload) > UINT64_MAX / 2
                   ? UINT64_MAX
                   : 2 * value_count(payload) - 1; /* each value has at least one digit, and a separator
                                                    * follows each value but the last */
  if (promised <= most) return HL_OK;
  return hl_fail_offset(
      error, HL_ERROR_INPUT, (int64_t)stream->offset,
      "%s: %s promises %llu bytes of voxels%s (%zu x %zu x %zu %s), the file %s %llu bytes", stream->path,
      payload->promiser, (unsigned long long)promised, payload->text ? " as text or more" : "",
      payload->grid.dimensions[0], payload->grid.dimensions[1], payload->grid.dimensions[2],
      hl_voxel_type_name(payload->grid.type), stream->below == NULL ? "has only" : "can decode to at most",
      (unsigned long long)most);
}

/* Reports the progress of reading. Fails if the user has cancelled. */
static hl_status report(const hl_stream *stream, size_t done, size_t count, hl_error *error) {
  hl_progress(stream->context, "load", (double)done / (double)count);
  return hl_cancelled(stream->context) ? hl_fail(error, HL_ERROR_CANCELLED, "%s: cancelled", stream->path)
                                       : HL_OK;
}

static hl_status fail_short(const hl_stream *stream, const hl_payload *payload, uint64_t found,
                            hl_error *error) {
  return hl_fail_offset(error, HL_ERROR_INPUT, (int64_t)stream->offset,
                        "%s: %s promises %llu bytes of voxels (%zu x %zu x %zu %s), but the data end after "
                        "%llu%s",
                        stream->path, payload->promiser, (unsigned long long)hl_payload_bytes(payload),
                        payload->grid.dimensions[0], payload->grid.dimensions[1], payload->grid.dimensions[2],
                        hl_voxel_type_name(payload->grid.type), (unsigned long long)found,
                        stream->cut_short ? ": the file is cut short" : ": correct its sizes or type");
}

static bool is_swapped(const hl_payload *payload) {
  return !payload->text && payload->big_endian != native_is_big_endian;
}

/* Reads the next `count` values into `raw`, and converts them into `place`, which may be the same memory.
 * done: the number of values that were read before, which is the number of the first voxel in `place`. */
static hl_status read_piece(hl_stream *stream, const hl_payload *payload, uint64_t done, size_t count,
                            void *raw, void *place, hl_destination *destination, hl_error *error) {
  hl_voxel_type type = payload->grid.type;
  size_t file_bytes = hl_voxel_type_bytes(type), got;
  hl_status status = hl_stream_read(stream, raw, count * file_bytes, &got, error);
  if (status != HL_OK) return status;
  if (got < count * file_bytes) return fail_short(stream, payload, done * file_bytes + got, error);
  hl_destination_note(destination, is_swapped(payload), raw, done, count);
  hl_voxels_store(type, is_swapped(payload), raw, count, place);
  return HL_OK;
}

/* The state of reading voxels into pages. One thread at a time reads the next piece of the stream. Each
 * thread copies the piece that it has read into pages. */
typedef struct page_reading {
  hl_stream *stream;
  const hl_payload *payload;
  hl_destination *destination;
  size_t piece, done; /* number of voxels that a thread reads at once; number of voxels that all threads have
                       * read so far */
  bool in_place;      /* whether a voxel of the file has the same number of bytes as a stored voxel */
  bool failed;        /* whether a thread has failed, so that reading has stopped */
  pthread_mutex_t lock;
} page_reading;

/* Reads the next piece of the stream, and stores it. The index is ignored, because a thread always reads the
 * next piece of the stream. */
static hl_status read_into_pages(void *data, size_t index, int worker, hl_error *error) {
  page_reading *r = data;
  (void)index, (void)worker;
  unsigned char stage[STAGE_VOXELS * 8];
  void *place = NULL;
  hl_status status = HL_OK;
  pthread_mutex_lock(&r->lock);
  size_t first = r->done, left = voxel_count(r->payload) - first, count = left < r->piece ? left : r->piece;
  if (!r->failed) {
    status = hl_destination_take(r->destination, first, count, &place, error);
    void *raw = r->in_place ? place : stage;
    if (status == HL_OK)
      status = read_piece(r->stream, r->payload, first, count, raw, place, r->destination, error);
    r->done += count;
    r->failed = status != HL_OK;
  }
  pthread_mutex_unlock(&r->lock);
  hl_destination_put(r->destination, first, count, place);
  return status;
}

/* The number of voxels that a thread reads at once. Storing is fastest for whole slices. Therefore a thread
 * reads a number of whole slices at once, if the pieces of all threads take at most an eighth of the memory
 * limit. Pieces that are smaller than a slice have about PIECE_BYTES: whole rows, or a part of a row. */
static size_t piece_for_pages(const hl_context *context, const hl_payload *payload, int threads,
                              size_t voxel_bytes) {
  enum { SLICES = 8, MOST_BYTES = 1 << 27 };
  const size_t *n = payload->grid.dimensions;
  uint64_t room = context->options.memory_limit / 8 / (uint64_t)threads;
  size_t slice = n[0] * n[1] * voxel_bytes, slices = SLICES, voxels = PIECE_BYTES / voxel_bytes;
  if (room > MOST_BYTES) room = MOST_BYTES;
  while (slices > 1 && slices * slice > room) slices /= 2;
  if (slices * slice <= room) return slices * n[0] * n[1];
  return voxels < n[0] ? voxels : voxels - voxels % n[0];
}

static hl_status read_binary_into_pages(hl_stream *stream, const hl_payload *payload,
                                        hl_destination *destination, hl_error *error) {
  page_reading r = {.stream = stream, .payload = payload, .destination = destination};
  r.in_place = hl_voxel_type_bytes(payload->grid.type) == destination->voxel_bytes;
  hl_pool *pool = NULL;
  hl_status status = hl_pool_create(stream->context, 0, &pool, error);
  if (status != HL_OK) return status;
  pthread_mutex_init(&r.lock, NULL);
  r.piece = r.in_place
                ? piece_for_pages(stream->context, payload, hl_pool_threads(pool), destination->voxel_bytes)
                : STAGE_VOXELS;
  size_t pieces = (voxel_count(payload) + r.piece - 1) / r.piece;
  status = hl_parallel_read(stream->context, pool, stream->path, pieces, read_into_pages, &r, error);
  pthread_mutex_destroy(&r.lock);
  hl_pool_destroy(pool);
  return status;
}

static hl_status read_binary(hl_stream *stream, const hl_payload *payload, hl_destination *destination,
                             hl_error *error) {
  hl_voxel_type type = payload->grid.type;
  size_t file_bytes = hl_voxel_type_bytes(type), stored_bytes = hl_storage_bytes(hl_voxel_type_storage(type));
  bool in_place = file_bytes == stored_bytes;
  size_t count = voxel_count(payload), piece = in_place ? PIECE_BYTES / file_bytes : STAGE_VOXELS;
  if (destination->pages != NULL) return read_binary_into_pages(stream, payload, destination, error);
  unsigned char stage[STAGE_VOXELS * 8];
  for (size_t done = 0; done < count;) {
    size_t wanted = count - done < piece ? count - done : piece;
    void *place = NULL;
    hl_status status;
    if (!hl_destination_wants(destination, done, wanted)) {
      status = hl_stream_skip(stream, wanted * file_bytes, error);
    } else {
      status = hl_destination_take(destination, done, wanted, &place, error);
      if (status != HL_OK) return status;
      status = read_piece(stream, payload, done, wanted, in_place ? place : stage, place, destination, error);
      hl_destination_put(destination, done, wanted, place);
    }
    done += wanted;
    if (status == HL_OK) status = report(stream, done, count, error);
    if (status != HL_OK) return status;
  }
  return HL_OK;
}

static bool fits_type(hl_voxel_type type, double value) {
  static const double low[HL_VOXEL_I64 + 1] = {[HL_VOXEL_I8] = INT8_MIN,
                                               [HL_VOXEL_I16] = INT16_MIN,
                                               [HL_VOXEL_I32] = INT32_MIN,
                                               [HL_VOXEL_I64] = -0x1p63};
  static const double high[HL_VOXEL_I64 + 1] = {
      [HL_VOXEL_U8] = UINT8_MAX,  [HL_VOXEL_I8] = INT8_MAX,    [HL_VOXEL_U16] = UINT16_MAX,
      [HL_VOXEL_I16] = INT16_MAX, [HL_VOXEL_U32] = UINT32_MAX, [HL_VOXEL_I32] = INT32_MAX,
      [HL_VOXEL_U64] = 0x1p64,    [HL_VOXEL_I64] = 0x1p63};
  if (type == HL_VOXEL_F16 || type == HL_VOXEL_F32 || type == HL_VOXEL_F64) return true;
  return value >= low[type] && value <= high[type] && value == floor(value);
}

/* The type of values directly after reading. The read type is the payload's type, except that numbers in a
 * text are read as floats instead of halves. */
static hl_voxel_type read_type(const hl_payload *payload) {
  return payload->text && payload->grid.type == HL_VOXEL_F16 ? HL_VOXEL_F32 : payload->grid.type;
}

#define PUT(type)                                                \
  do {                                                           \
    type number = (type)value;                                   \
    memcpy(raw + index * sizeof number, &number, sizeof number); \
  } while (0)

/* Stores a number as a value of a type. The caller passes only numbers within the type's range. */
static void put_number(hl_voxel_type type, double value, size_t index, unsigned char *raw) {
  switch (type) {
    case HL_VOXEL_U8: PUT(uint8_t); break;
    case HL_VOXEL_I8: PUT(int8_t); break;
    case HL_VOXEL_U16: PUT(uint16_t); break;
    case HL_VOXEL_I16: PUT(int16_t); break;
    case HL_VOXEL_U32: PUT(uint32_t); break;
    case HL_VOXEL_I32: PUT(int32_t); break;
    case HL_VOXEL_U64:
      value = fmin(value, 0x1p64 - 2048); /* the greatest double below 2^64 */
      PUT(uint64_t);
      break;
    case HL_VOXEL_I64:
      value = fmin(value, 0x1p63 - 1024); /* the greatest double below 2^63 */
      PUT(int64_t);
      break;
    case HL_VOXEL_F64: PUT(double); break;
    default: PUT(float); break;
  }
}

/* Reads the next number of a text. done: how many numbers of the text were read before. */
static hl_status read_text_value(hl_stream *stream, const hl_payload *payload, uint64_t done, size_t index,
                                 unsigned char *raw, hl_error *error) {
  double value;
  bool found;
  hl_status status = hl_next_number(stream, &value, &found, error);
  if (status != HL_OK) return status;
  if (!found)
    return hl_fail_offset(error, HL_ERROR_INPUT, (int64_t)stream->offset,
                          "%s: %s promises %llu voxels, but only %llu numbers follow", stream->path,
                          payload->promiser, (unsigned long long)value_count(payload),
                          (unsigned long long)done);
  if (payload->text_is_fraction) value = floor(255 * value + 0.5);
  if (!fits_type(payload->grid.type, value))
    return hl_fail_offset(error, HL_ERROR_INPUT, (int64_t)stream->offset,
                          "%s, before byte %llu: %.17g does not fit the type %s", stream->path,
                          (unsigned long long)stream->offset, value, hl_voxel_type_name(payload->grid.type));
  put_number(read_type(payload), value, index, raw);
  return HL_OK;
}

/* Reads `count` values into `raw`, as values of the type read_type(). done: the number of values that were
 * read earlier. */
static hl_status read_values(hl_stream *stream, const hl_payload *payload, uint64_t done, size_t count,
                             unsigned char *raw, hl_error *error) {
  size_t bytes = hl_voxel_type_bytes(payload->grid.type), got;
  hl_status status = HL_OK;
  for (size_t n = 0; payload->text && n < count && status == HL_OK; n++)
    status = read_text_value(stream, payload, done + n, n, raw, error);
  if (payload->text) return status;
  status = hl_stream_read(stream, raw, count * bytes, &got, error);
  if (status == HL_OK && got < count * bytes) status = fail_short(stream, payload, done * bytes + got, error);
  return status;
}

static hl_status read_text(hl_stream *stream, const hl_payload *payload, hl_destination *destination,
                           hl_error *error) {
  unsigned char raw[STAGE_VOXELS * 8];
  size_t count = voxel_count(payload);
  for (size_t done = 0, wanted; done < count; done += wanted) {
    wanted = count - done < STAGE_VOXELS ? count - done : STAGE_VOXELS;
    hl_status status = read_values(stream, payload, done, wanted, raw, error);
    if (status != HL_OK) return status;
    hl_destination_note(destination, false, raw, done, wanted);
    hl_voxels_store(read_type(payload), false, raw, wanted,
                    destination->voxels + done * destination->voxel_bytes);
    status = report(stream, done, count, error);
    if (status != HL_OK) return status;
  }
  return HL_OK;
}

/* ---- several components: one of them, or their magnitude ----
 *
 * The file holds [outer][component][block] values: `block` is the number of consecutive values of one
 * component. If the components of a voxel lie side by side, `block` is 1. If each component is a whole
 * volume, `block` is the number of all voxels. The magnitude is accumulated in the voxels, so that no order
 * of components needs further memory. */

/* The position of the next value: its block, its component and its index in the block. */
typedef struct component_place {
  size_t first; /* number of the voxel to which the current block's first value belongs */
  size_t component;
  size_t in_block;
} component_place;

static double value_of(const hl_payload *payload, const void *stage, size_t index) {
  double stored = 0;
  switch (hl_voxel_type_storage(payload->grid.type)) {
    case HL_STORAGE_U8: stored = ((const uint8_t *)stage)[index]; break;
    case HL_STORAGE_U16: stored = ((const uint16_t *)stage)[index]; break;
    case HL_STORAGE_F32: stored = (double)((const float *)stage)[index]; break;
  }
  return payload->grid.value_scale * (stored - hl_voxel_type_bias(payload->grid.type)) +
         payload->grid.value_offset;
}

/* Adds a component to the magnitude of a vector, which is the square root of the sum of the components'
 * squares. The magnitude is computed in double precision, whose range contains the squares of all floats. */
static void add_square(float *magnitude, size_t component, double value) {
  double before = component > 0 ? (double)*magnitude : 0;
  *magnitude = (float)(component > 0 ? sqrt(before * before + value * value) : fabs(value));
}

/* Stores a value in the volume, if the value's component is wanted. raw: values as they were read. stage: the
 * same values, converted to stored values. */
static void take_value(const hl_payload *payload, const unsigned char *raw, const unsigned char *stage,
                       size_t index, const component_place *place, hl_destination *destination) {
  size_t voxel = place->first + place->in_block;
  unsigned char *voxels = destination->voxels;
  if (payload->component == HL_COMPONENT_MAGNITUDE) {
    add_square((float *)voxels + voxel, place->component, value_of(payload, stage, index));
    return;
  }
  size_t bytes = hl_storage_bytes(hl_voxel_type_storage(payload->grid.type));
  if (hl_component_is_colors(payload->component)) {
    hl_colors_store(payload->grid.type, stage + index * bytes, 1, 1, place->component,
                    voxels + voxel * HL_COLOR_BYTES);
  } else if (place->component == (size_t)payload->component) {
    memcpy(voxels + voxel * bytes, stage + index * bytes, bytes);
    hl_destination_note(destination, is_swapped(payload),
                        raw + index * hl_voxel_type_bytes(read_type(payload)), voxel, 1);
  }
}

static void advance(const hl_payload *payload, component_place *place) {
  if (++place->in_block < payload->block) return;
  place->in_block = 0;
  if (++place->component < payload->components) return;
  place->component = 0;
  place->first += payload->block;
}

/* Skips the current block, if the block is large and its component is not wanted. */
static hl_status skip_block(hl_stream *stream, const hl_payload *payload, component_place *place,
                            bool *skipped, hl_error *error) {
  uint64_t bytes = (uint64_t)payload->block * hl_voxel_type_bytes(payload->grid.type);
  *skipped = place->in_block == 0 && !payload->text && bytes >= SKIPPED_BYTES && payload->component >= 0 &&
             place->component != (size_t)payload->component;
  if (!*skipped) return HL_OK;
  place->in_block = payload->block - 1;
  advance(payload, place);
  return hl_stream_skip(stream, bytes, error);
}

static hl_status read_components(hl_stream *stream, const hl_payload *payload, hl_destination *destination,
                                 hl_error *error) {
  unsigned char raw[STAGE_VOXELS * 8], stage[STAGE_VOXELS * sizeof(float)];
  component_place place = {0, 0, 0};
  size_t count = voxel_count(payload);
  for (uint64_t done = 0; place.first < count;) {
    /* if components follow each other as whole volumes, the components after the wanted one are not needed */
    if (payload->block == count && payload->component >= 0 && place.component > (size_t)payload->component)
      break;
    bool skipped;
    hl_status status = skip_block(stream, payload, &place, &skipped, error);
    if (status != HL_OK) return status;
    if (skipped) {
      done += payload->block;
      continue;
    }
    uint64_t left = (uint64_t)(count - place.first) *
                    payload->components; /* the greatest number of values that may be left to read */
    size_t wanted = left < STAGE_VOXELS ? (size_t)left : STAGE_VOXELS;
    if (payload->block - place.in_block < wanted && payload->block > 1)
      wanted = payload->block - place.in_block;
    if (payload->block == 1 && left - place.component < wanted) wanted = (size_t)(left - place.component);
    status = read_values(stream, payload, done, wanted, raw, error);
    if (status != HL_OK) return status;
    hl_voxels_store(read_type(payload), is_swapped(payload), raw, wanted, stage);
    for (size_t n = 0; n < wanted; n++) {
      take_value(payload, raw, stage, n, &place, destination);
      advance(payload, &place);
    }
    done += wanted;
    status = report(stream, place.first, count, error);
    if (status != HL_OK) return status;
  }
  return HL_OK;
}

/* ---- all steps together ---- */

/* Checks that the stream ends after the voxels. Trying to read one more byte also makes a decompressor verify
 * its checksum. */
static hl_status check_end(hl_stream *stream, const hl_payload *payload, hl_error *error) {
  bool to_the_end = payload->components == 1 || payload->component < 0 ||
                    payload->block < voxel_count(payload);
  if (payload->trailing == HL_TRAILING_IGNORED || !to_the_end) return HL_OK;
  const unsigned char *bytes;
  size_t available;
  hl_status status = hl_stream_peek(stream, 1, &bytes, &available, error);
  while (status == HL_OK && payload->text && available > 0 && hl_is_separator(bytes[0])) {
    hl_stream_take(stream, 1);
    status = hl_stream_peek(stream, 1, &bytes, &available, error);
  }
  if (status != HL_OK || available == 0) return status;
  if (payload->trailing == HL_TRAILING_REFUSED)
    return hl_fail_offset(
        error, HL_ERROR_INPUT, (int64_t)stream->offset,
        "%s: %s promises %zu x %zu x %zu %s, %llu bytes, but the data are longer: correct the sizes "
        "or the type",
        stream->path, payload->promiser, payload->grid.dimensions[0], payload->grid.dimensions[1],
        payload->grid.dimensions[2], hl_voxel_type_name(payload->grid.type),
        (unsigned long long)hl_payload_bytes(payload));
  hl_log(stream->context, HL_LOG_WARNING,
         "%s: the data go on after the %llu bytes of voxels that the header promises", stream->path,
         (unsigned long long)hl_payload_bytes(payload));
  return HL_OK;
}

hl_volume_description hl_payload_grid(const hl_payload *payload, const double spacing[3]) {
  hl_volume_description grid = payload->grid;
  if (payload->components > 1 && payload->component == HL_COMPONENT_MAGNITUDE) {
    grid.type = HL_VOXEL_F32;
    grid.value_scale = 1;
    grid.value_offset = 0;
  }
  for (int axis = 0; axis < 3 && spacing[0] > 0; axis++) {
    double length = vec3_length(vec3_of(grid.axis[axis]));
    for (int row = 0; row < 3; row++) grid.axis[axis][row] *= spacing[axis] / length;
  }
  return grid;
}

hl_status hl_payload_read(hl_stream *stream, const hl_payload *payload, const double spacing[3],
                          hl_volume **volume, hl_error *error) {
  hl_status status = check_promise(stream, payload, error);
  if (status != HL_OK) return status;
  hl_volume_description grid = hl_payload_grid(payload, spacing);
  bool colors = payload->components > 1 && hl_component_is_colors(payload->component);
  bool in_order = payload->components == 1 && !payload->text;
  hl_destination to;
  status = hl_destination_open(stream->context, &grid,
                               colors     ? HL_DESTINATION_COLORS
                               : in_order ? HL_DESTINATION_PIECES
                                          : HL_DESTINATION_VOXELS,
                               stream->path, &to, error);
  if (status == HL_OK) status = report(stream, 0, voxel_count(payload), error);
  if (status == HL_OK)
    status = payload->components > 1 ? read_components(stream, payload, &to, error)
             : payload->text         ? read_text(stream, payload, &to, error)
                                     : read_binary(stream, payload, &to, error);
  if (status == HL_OK) status = check_end(stream, payload, error);
  if (status == HL_OK && colors) {
    const hl_color_source source = {&grid, stream->path, payload->components, payload->component, false};
    status = hl_destination_adopt_colors(&to, &source, volume, error);
  } else if (status == HL_OK) {
    status = hl_destination_adopt(&to, &grid, volume, error);
  }
  hl_destination_close(&to);
  return status;
}
