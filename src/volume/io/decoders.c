/* volume/io/decoders.c - makes streams that decode the bytes of the stream below them.
 *
 * In: coded bytes from the stream below. Out: plain bytes, never more than the reader requests. The memory of
 * a decoder is bounded: zlib's window, one packed block, one small header, or one group of digits. */
#include "volume/io/decoders.h"

#include <limits.h>
#include <string.h>
#include <zlib.h>

#include "core/memory.h"
#include "volume/io/unpack.h"

/* ---- compressed: gzip, zlib, VTK's blocks ---- */

enum {
  DEFLATE_GREATEST_RATIO = 1032, /* the greatest number of bytes to which one deflated byte unpacks: two bits,
                                  * the codes of a length and a distance, can stand for 258 bytes (RFC
                                  * 1951) */
  PENDING_BYTES = 65536,         /* more bytes than zlib can hold back in its window and its bit buffer */
  /* In zlib.h, 15 is the largest window; 32 added to it makes zlib find out whether the data are gzip or
   * zlib. */
  AUTOMATIC_WINDOW = 15 + 32
};

typedef struct inflate_stream {
  hl_stream base;
  z_stream zlib;
  bool started, finished;
} inflate_stream;

typedef struct blocks_stream {
  hl_stream base;
  z_stream zlib;
  bool started;
  uint64_t block_count, block_bytes, last_bytes; /* number of blocks; bytes of an unpacked block; bytes of the
                                                  * last unpacked block */
  uint64_t *compressed_bytes;                    /* owned; [block_count] */
  uint64_t block;                                /* index of the current block */
  uint64_t plain_left, compressed_left;          /* number of unpacked and of packed bytes of the current
                                                  * block that are left */
  hl_vtk_packing packing;
  unsigned char *packed, *whole; /* owned; the current block of LZ4 or xz, before and after it is unpacked;
                                  * null for zlib */
  size_t whole_done;             /* number of bytes of `whole` that were given to the reader; 0 until `whole`
                                  * is filled */
} blocks_stream;

static void *zlib_allocate(void *context, unsigned items, unsigned size) {
  return hl_allocate(context, items, size);
}
static void zlib_release(void *context, void *memory) { hl_release(context, memory); }

static hl_status start_zlib(z_stream *zlib, hl_stream *stream, bool *started, hl_error *error) {
  zlib->zalloc = zlib_allocate;
  zlib->zfree = zlib_release;
  zlib->opaque = stream->context;
  *started = inflateInit2(zlib, AUTOMATIC_WINDOW) == Z_OK;
  return *started ? HL_OK : hl_fail_memory(error, PENDING_BYTES, stream->path);
}

/* The result of one call of zlib's inflate(). At the end of the input, consumed and made may both be 0. */
typedef struct inflate_result {
  size_t consumed, made; /* bytes */
  int code;              /* the result of inflate() */
} inflate_result;

/* Calls zlib's inflate() once, on at most input_limit bytes of the stream below. bytes: [capacity]; the
 * unpacked bytes. */
static hl_status inflate_step(hl_stream *stream, z_stream *zlib, uint64_t input_limit, unsigned char *bytes,
                              size_t capacity, inflate_result *result, hl_error *error) {
  const unsigned char *input;
  size_t available;
  hl_status status = hl_stream_peek(stream->below, 1, &input, &available, error);
  if (status != HL_OK) return status;
  zlib->next_in = (unsigned char *)input;
  zlib->avail_in = (unsigned)(available < input_limit ? available : input_limit);
  zlib->next_out = bytes;
  zlib->avail_out = (unsigned)(capacity < INT_MAX ? capacity : INT_MAX);
  size_t input_before = zlib->avail_in, output_before = zlib->avail_out;
  result->code = inflate(zlib, Z_NO_FLUSH);
  result->consumed = input_before - zlib->avail_in;
  result->made = output_before - zlib->avail_out;
  hl_stream_take(stream->below, result->consumed);
  if (result->code == Z_MEM_ERROR) return hl_fail_memory(error, PENDING_BYTES, stream->path);
  if (result->code == Z_DATA_ERROR || result->code == Z_NEED_DICT || result->code == Z_STREAM_ERROR)
    return hl_fail_offset(error, HL_ERROR_INPUT, (int64_t)stream->below->offset,
                          "%s, byte %llu: the compressed data are damaged (%s)", stream->path,
                          (unsigned long long)stream->below->offset,
                          zlib->msg != NULL ? zlib->msg : "bad stream");
  return HL_OK;
}

/* Prepares the next gzip member, if the member that has ended is followed by another member. Any other bytes
 * end the stream. */
static hl_status next_member(inflate_stream *stream, hl_error *error) {
  const unsigned char *bytes;
  size_t available;
  hl_status status = hl_stream_peek(stream->base.below, 2, &bytes, &available, error);
  stream->finished = status != HL_OK || available < 2 || bytes[0] != 0x1f || bytes[1] != 0x8b;
  if (!stream->finished) inflateReset(&stream->zlib);
  return status;
}

static hl_status inflate_pull(hl_stream *base, unsigned char *bytes, size_t capacity, size_t *count,
                              hl_error *error) {
  inflate_stream *stream = (inflate_stream *)base;
  *count = 0;
  while (*count < capacity && !stream->finished) {
    inflate_result step;
    hl_status status = inflate_step(base, &stream->zlib, UINT_MAX, bytes + *count, capacity - *count, &step,
                                    error);
    if (status == HL_OK && step.code == Z_STREAM_END) status = next_member(stream, error);
    if (status != HL_OK) return status;
    *count += step.made;
    if (step.code != Z_STREAM_END && step.consumed == 0 && step.made == 0) {
      base->cut_short = true;
      break;
    }
  }
  return HL_OK;
}

static uint64_t inflate_at_most(const hl_stream *stream) {
  uint64_t below = hl_stream_at_most(stream->below), most;
  if (__builtin_mul_overflow(below, (uint64_t)DEFLATE_GREATEST_RATIO, &most)) return UINT64_MAX;
  return most > UINT64_MAX - PENDING_BYTES ? UINT64_MAX : most + PENDING_BYTES;
}

static void inflate_close(hl_stream *stream) {
  if (((inflate_stream *)stream)->started) inflateEnd(&((inflate_stream *)stream)->zlib);
}

hl_status hl_stream_push_inflate(hl_stream **stream, hl_error *error) {
  hl_context *context = (*stream)->context;
  inflate_stream *made = (inflate_stream *)hl_stream_make(context, sizeof *made, *stream);
  if (made == NULL) return hl_fail_memory(error, HL_STREAM_BUFFER_BYTES, (*stream)->path);
  made->base.pull = inflate_pull;
  made->base.at_most = inflate_at_most;
  made->base.close = inflate_close;
  *stream = &made->base; /* the caller must close *stream even if zlib cannot be started */
  return start_zlib(&made->zlib, &made->base, &made->started, error);
}

static void begin_block(blocks_stream *stream) {
  if (stream->block >= stream->block_count) return;
  stream->whole_done = 0;
  stream->plain_left = stream->block + 1 == stream->block_count ? stream->last_bytes : stream->block_bytes;
  stream->compressed_left = stream->compressed_bytes[stream->block];
  inflateReset(&stream->zlib);
}

static hl_status fail_block(const blocks_stream *stream, hl_error *error) {
  return hl_fail_offset(
      error, HL_ERROR_INPUT, (int64_t)stream->base.below->offset,
      "%s: compressed block %llu of %llu does not have the %llu bytes that its header promises",
      stream->base.path, (unsigned long long)stream->block + 1, (unsigned long long)stream->block_count,
      (unsigned long long)(stream->block + 1 == stream->block_count ? stream->last_bytes
                                                                    : stream->block_bytes));
}

/* Ends the current block after the reader got all its bytes. zlib verifies the checksum, and the rest of the
 * packed bytes is skipped. */
static hl_status end_block(blocks_stream *stream, hl_error *error) {
  inflate_result step = {.code = Z_OK};
  while (step.code != Z_STREAM_END) {
    unsigned char surplus;
    hl_status status = inflate_step(&stream->base, &stream->zlib, stream->compressed_left, &surplus, 1, &step,
                                    error);
    if (status != HL_OK) return status;
    stream->compressed_left -= step.consumed;
    if (step.made > 0 || (step.consumed == 0 && step.code != Z_STREAM_END)) return fail_block(stream, error);
  }
  hl_status status = hl_stream_skip(stream->base.below, stream->compressed_left, error);
  stream->block++;
  begin_block(stream);
  return status;
}

static hl_status blocks_pull(hl_stream *base, unsigned char *bytes, size_t capacity, size_t *count,
                             hl_error *error) {
  blocks_stream *stream = (blocks_stream *)base;
  *count = 0;
  while (*count < capacity && stream->block < stream->block_count) {
    size_t room = capacity - *count < stream->plain_left ? capacity - *count : (size_t)stream->plain_left;
    inflate_result step;
    hl_status status = inflate_step(base, &stream->zlib, stream->compressed_left, bytes + *count, room, &step,
                                    error);
    if (status != HL_OK) return status;
    *count += step.made;
    stream->compressed_left -= step.consumed;
    stream->plain_left -= step.made;
    if (stream->plain_left == 0) status = end_block(stream, error);
    else if (step.code == Z_STREAM_END || (step.consumed == 0 && step.made == 0))
      status = fail_block(stream, error);
    if (status != HL_OK) return status;
  }
  return HL_OK;
}

/* Unpacks the current block of LZ4 or xz into `whole`. */
static hl_status unpack_block(blocks_stream *stream, hl_error *error) {
  hl_stream *base = &stream->base;
  hl_context *context = base->context;
  size_t length = (size_t)stream->compressed_left, plain = (size_t)stream->plain_left;
  bool lz4 = stream->packing == HL_VTK_LZ4, sound = false;
  if (stream->compressed_left > hl_stream_at_most(base->below) ||
      !hl_packed_can_hold(length, plain, lz4 ? HL_LZ4_RATIO : HL_XZ_RATIO))
    return fail_block(stream, error);
  hl_release(context, stream->packed);
  hl_release(context, stream->whole);
  stream->packed = hl_allocate(context, length + 1, 1);
  stream->whole = hl_allocate(context, plain, 1);
  if (stream->packed == NULL || stream->whole == NULL)
    return hl_fail_memory(error, length + plain, base->path);
  hl_status status = hl_stream_read_all(base->below, stream->packed, length, error);
  if (status == HL_OK)
    status = lz4 ? hl_unpack_lz4(base->path, stream->packed, length, stream->whole, plain, &sound, error)
                 : hl_unpack_xz(base->path, stream->packed, length, stream->whole, plain, &sound, error);
  return status == HL_OK && !sound ? fail_block(stream, error) : status;
}

static hl_status whole_blocks_pull(hl_stream *base, unsigned char *bytes, size_t capacity, size_t *count,
                                   hl_error *error) {
  blocks_stream *stream = (blocks_stream *)base;
  *count = 0;
  while (*count < capacity && stream->block < stream->block_count) {
    if (stream->whole_done == 0) {
      hl_status status = unpack_block(stream, error);
      if (status != HL_OK) return status;
    }
    size_t room = capacity - *count < stream->plain_left ? capacity - *count : (size_t)stream->plain_left;
    memcpy(bytes + *count, stream->whole + stream->whole_done, room);
    *count += room;
    stream->whole_done += room;
    stream->plain_left -= room;
    if (stream->plain_left > 0) continue;
    stream->block++;
    begin_block(stream);
  }
  return HL_OK;
}

static uint64_t whole_blocks_at_most(const hl_stream *stream) {
  uint64_t below = hl_stream_at_most(stream->below), most;
  return __builtin_mul_overflow(below, (uint64_t)HL_XZ_RATIO, &most) ? UINT64_MAX : most;
}

static void blocks_close(hl_stream *base) {
  blocks_stream *stream = (blocks_stream *)base;
  hl_release(base->context, stream->packed);
  hl_release(base->context, stream->whole);
  if (stream->started) inflateEnd(&stream->zlib);
  hl_release(base->context, stream->compressed_bytes);
}

static uint64_t load_integer(const unsigned char *bytes, size_t length, bool big_endian) {
  uint64_t value = 0;
  for (size_t n = 0; n < length; n++) value = value << 8 | bytes[big_endian ? n : length - 1 - n];
  return value;
}

static hl_status read_integers(hl_stream *stream, size_t header_bytes, bool big_endian, uint64_t *values,
                               uint64_t count, hl_error *error) {
  unsigned char bytes[8];
  for (uint64_t n = 0; n < count; n++) {
    hl_status status = hl_stream_read_all(stream, bytes, header_bytes, error);
    if (status != HL_OK) return status;
    values[n] = load_integer(bytes, header_bytes, big_endian);
  }
  return HL_OK;
}

/* Reads the header, which states the sizes of the blocks. The sum of the blocks' sizes must be the size of
 * the array, which the file states elsewhere. The check of the sum also limits the number of blocks. */
static hl_status read_block_header(blocks_stream *stream, size_t header_bytes, bool big_endian,
                                   uint64_t promised, hl_error *error) {
  hl_stream *below = stream->base.below;
  uint64_t first[3]; /* number of blocks; bytes of an unpacked block; bytes of the last unpacked block, or 0
                      * if the last block is as long as the others */
  hl_status status = read_integers(below, header_bytes, big_endian, first, 3, error);
  if (status != HL_OK) return status;
  stream->block_count = first[0];
  stream->block_bytes = first[1];
  stream->last_bytes = first[2] != 0 ? first[2] : first[1];
  uint64_t total = 0;
  bool sound = first[0] > 0 && first[1] > 0 && first[2] <= first[1] &&
               !__builtin_mul_overflow(first[0] - 1, first[1], &total) &&
               !__builtin_add_overflow(total, stream->last_bytes, &total);
  if (!sound || total != promised)
    return hl_fail_offset(
        error, HL_ERROR_INPUT, (int64_t)below->offset,
        "%s: the header promises %llu bytes of voxels, the compressed blocks (%llu of %llu bytes, "
        "last %llu) hold another number",
        stream->base.path, (unsigned long long)promised, (unsigned long long)first[0],
        (unsigned long long)first[1], (unsigned long long)first[2]);
  if (first[0] > hl_stream_at_most(below) / header_bytes)
    return hl_fail_offset(error, HL_ERROR_INPUT, (int64_t)below->offset,
                          "%s: the header promises %llu compressed blocks, only %llu bytes follow",
                          stream->base.path, (unsigned long long)first[0],
                          (unsigned long long)hl_stream_at_most(below));
  stream->compressed_bytes = hl_allocate(stream->base.context, first[0], sizeof *stream->compressed_bytes);
  if (stream->compressed_bytes == NULL) return hl_fail_memory(error, first[0] * 8, stream->base.path);
  return read_integers(below, header_bytes, big_endian, stream->compressed_bytes, first[0], error);
}

hl_status hl_stream_push_vtk_blocks(hl_stream **stream, hl_vtk_packing packing, size_t header_bytes,
                                    bool big_endian, uint64_t promised, hl_error *error) {
  blocks_stream *made = (blocks_stream *)hl_stream_make((*stream)->context, sizeof *made, *stream);
  if (made == NULL) return hl_fail_memory(error, HL_STREAM_BUFFER_BYTES, (*stream)->path);
  bool zlib = packing == HL_VTK_ZLIB;
  made->packing = packing;
  made->base.pull = zlib ? blocks_pull : whole_blocks_pull;
  made->base.at_most = zlib ? inflate_at_most : whole_blocks_at_most;
  made->base.close = blocks_close;
  *stream = &made->base;
  hl_status status = read_block_header(made, header_bytes, big_endian, promised, error);
  if (status == HL_OK && zlib) status = start_zlib(&made->zlib, &made->base, &made->started, error);
  if (status == HL_OK) begin_block(made);
  return status;
}

/* ---- written as text: base64 (RFC 4648) and hexadecimal ----
 *
 * White space may stand anywhere in the text. A base64 text may hold several padded parts one after the
 * other, because VTK encodes a header and its data separately. The text ends at the first character that is
 * no digit, padding or white space, such as '<'. */

enum { NOT_A_DIGIT = 255, SPACE = 254, PADDING = 253 };

typedef struct coded_stream {
  hl_stream base;
  unsigned char digit[256]; /* value of each character */
  unsigned group_digits;    /* digits in a full group: 4 for base64, 2 for hexadecimal */
  unsigned digit_bits;      /* bits in a digit: 6 for base64, 4 for hexadecimal */
  uint32_t bits;            /* the value of the digits of the current group that were read so far */
  unsigned held, padding;   /* numbers of digits and of padding characters of the current group so far */
  unsigned char left[3];    /* decoded bytes of the last group that did not fit into the reader's memory */
  unsigned left_count;
  bool finished;
} coded_stream;

static hl_status fail_character(const coded_stream *stream, hl_error *error) {
  const hl_stream *below = stream->base.below;
  return hl_fail_offset(error, HL_ERROR_INPUT, (int64_t)below->offset,
                        "%s, byte %llu: a group of %s digits breaks off here", stream->base.path,
                        (unsigned long long)below->offset,
                        stream->digit_bits == 6 ? "base64" : "hexadecimal");
}

/* Converts a complete group of digits to bytes. Returns false if the group has an impossible number of
 * padding characters. */
static bool end_group(coded_stream *stream, unsigned char bytes[3], unsigned *count) {
  unsigned bits = stream->held * stream->digit_bits;
  *count = bits / 8;
  if (*count == 0 || (stream->padding > 0 && stream->held + stream->padding != stream->group_digits))
    return false;
  uint32_t aligned = stream->bits << (24 - bits);
  for (unsigned n = 0; n < *count; n++) bytes[n] = (unsigned char)(aligned >> (16 - 8 * n));
  stream->bits = 0;
  stream->held = stream->padding = 0;
  return true;
}

static hl_status coded_pull(hl_stream *base, unsigned char *bytes, size_t capacity, size_t *count,
                            hl_error *error) {
  coded_stream *stream = (coded_stream *)base;
  *count = 0;
  while (stream->left_count > 0 && *count < capacity) {
    bytes[(*count)++] = stream->left[0];
    memmove(stream->left, stream->left + 1, --stream->left_count);
  }
  while (*count < capacity && !stream->finished) {
    const unsigned char *text;
    size_t available, n = 0;
    hl_status status = hl_stream_peek(base->below, 1, &text, &available, error);
    if (status != HL_OK) return status;
    if (available == 0) stream->finished = true;
    for (; n < available && *count < capacity; n++) {
      unsigned value = stream->digit[text[n]];
      if (value == SPACE) continue;
      if (value == NOT_A_DIGIT || (stream->padding > 0 && value != PADDING)) {
        stream->finished = true;
        break;
      }
      if (value == PADDING) stream->padding++;
      else {
        stream->bits = stream->bits << stream->digit_bits | value;
        stream->held++;
      }
      if (stream->held + stream->padding < stream->group_digits) continue;
      unsigned char group[3];
      unsigned made;
      if (!end_group(stream, group, &made)) return fail_character(stream, error);
      unsigned kept = made < capacity - *count ? made : (unsigned)(capacity - *count);
      memcpy(bytes + *count, group, kept);
      *count += kept;
      stream->left_count = made - kept;
      memcpy(stream->left, group + kept, made - kept);
    }
    hl_stream_take(base->below, n);
  }
  if (stream->finished && stream->held + stream->padding > 0) base->cut_short = true;
  return HL_OK;
}

static uint64_t coded_at_most(const hl_stream *base) {
  const coded_stream *stream = (const coded_stream *)base;
  uint64_t below = hl_stream_at_most(base->below);
  if (below == UINT64_MAX) return below;
  return below / stream->group_digits * (stream->group_digits * stream->digit_bits / 8) + 6;
}

static hl_status push_coded(hl_stream **stream, const char *digits, unsigned digit_bits, hl_error *error) {
  coded_stream *made = (coded_stream *)hl_stream_make((*stream)->context, sizeof *made, *stream);
  if (made == NULL) return hl_fail_memory(error, HL_STREAM_BUFFER_BYTES, (*stream)->path);
  made->base.pull = coded_pull;
  made->base.at_most = coded_at_most;
  made->digit_bits = digit_bits;
  made->group_digits = digit_bits == 6 ? 4 : 2;
  memset(made->digit, NOT_A_DIGIT, sizeof made->digit);
  for (unsigned n = 0; digits[n] != 0; n++)
    made->digit[(unsigned char)digits[n]] = (unsigned char)(n & ((1u << digit_bits) - 1));
  for (const char *space = " \t\r\n"; *space != 0; space++) made->digit[(unsigned char)*space] = SPACE;
  if (digit_bits == 6) made->digit['='] = PADDING;
  *stream = &made->base;
  return HL_OK;
}

hl_status hl_stream_push_base64(hl_stream **stream, hl_error *error) {
  return push_coded(stream, "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/", 6, error);
}

hl_status hl_stream_push_hex(hl_stream **stream, hl_error *error) {
  hl_status status = push_coded(stream, "0123456789abcdef", 4, error);
  coded_stream *made = (coded_stream *)*stream;
  for (unsigned n = 10; status == HL_OK && n < 16; n++) made->digit['A' + n - 10] = (unsigned char)n;
  return status;
}
