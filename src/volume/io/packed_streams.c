/* volume/io/packed_streams.c - makes streams that unpack whole files of bzip2 and xz. Files of bzip2, xz and
 * gzip are recognised by their first bytes.
 *
 * In: packed bytes from the stream below. Out: plain bytes, never more than the reader requests. The
 * libraries allocate memory of their own: libbz2 about 4 MB, liblzma at most XZ_MEMORY. */
#include <limits.h>
#include <string.h>
#ifdef HL_HAS_BZIP2
#include <bzlib.h>
#endif
#ifdef HL_HAS_LZMA
#include <lzma.h>
#endif

#include "core/memory.h"
#include "volume/io/decoders.h"

#if defined(HL_HAS_BZIP2) || defined(HL_HAS_LZMA)
static hl_status fail_damaged(const hl_stream *stream, hl_error *error) {
  return hl_fail_offset(error, HL_ERROR_INPUT, (int64_t)stream->below->offset,
                        "%s, byte %llu: the compressed data are damaged", stream->path,
                        (unsigned long long)stream->below->offset);
}

static uint64_t times(const hl_stream *stream, uint64_t ratio) {
  uint64_t below = hl_stream_at_most(stream->below), most;
  return __builtin_mul_overflow(below, ratio, &most) ? UINT64_MAX : most;
}

static unsigned at_most(size_t count) { return count < INT_MAX ? (unsigned)count : (unsigned)INT_MAX; }
#endif

#if !defined(HL_HAS_BZIP2) || !defined(HL_HAS_LZMA)
static hl_status fail_absent(const hl_stream *stream, const char *name, hl_error *error) {
  return hl_fail(error, HL_ERROR_UNSUPPORTED,
                 "%s: packed by %s, and this program was built without its library: unpack it, or install "
                 "the library and build anew",
                 stream->path, name);
}
#endif

/* ---- bzip2 ---- */

#ifdef HL_HAS_BZIP2

/* The greatest number of bytes to which one byte packed by bzip2 unpacks. A block of 900000 bytes is packed
 * to about 40 bytes or more. */
enum { BZIP2_GREATEST_RATIO = 25000 };

typedef struct bzip2_stream {
  hl_stream base;
  bz_stream bzip2;
  bool started, finished;
} bzip2_stream;

static void *bzip2_allocate(void *context, int items, int size) {
  return hl_allocate(context, (size_t)items, (size_t)size);
}
static void bzip2_release(void *context, void *memory) { hl_release(context, memory); }

static hl_status bzip2_start(bzip2_stream *stream, hl_error *error) {
  stream->bzip2 = (bz_stream){
      .bzalloc = bzip2_allocate, .bzfree = bzip2_release, .opaque = stream->base.context};
  stream->started = BZ2_bzDecompressInit(&stream->bzip2, 0, 0) == BZ_OK;
  return stream->started ? HL_OK : hl_fail_memory(error, 100000, stream->base.path);
}

/* Prepares the next bzip2 stream, if the stream that has ended is followed by another stream. Programs that
 * pack in parallel write several streams. */
static hl_status bzip2_next(bzip2_stream *stream, hl_error *error) {
  const unsigned char *bytes;
  size_t available;
  hl_status status = hl_stream_peek(stream->base.below, 3, &bytes, &available, error);
  BZ2_bzDecompressEnd(&stream->bzip2);
  stream->started = false;
  stream->finished = status != HL_OK || available < 3 || memcmp(bytes, "BZh", 3) != 0;
  return stream->finished ? status : bzip2_start(stream, error);
}

static hl_status bzip2_pull(hl_stream *base, unsigned char *bytes, size_t capacity, size_t *count,
                            hl_error *error) {
  bzip2_stream *stream = (bzip2_stream *)base;
  *count = 0;
  while (*count < capacity && !stream->finished) {
    const unsigned char *input;
    size_t available;
    hl_status status = hl_stream_peek(base->below, 1, &input, &available, error);
    if (status != HL_OK) return status;
    unsigned given = at_most(available), room = at_most(capacity - *count);
    stream->bzip2.next_in = (char *)input;
    stream->bzip2.avail_in = given;
    stream->bzip2.next_out = (char *)bytes + *count;
    stream->bzip2.avail_out = room;
    int answer = BZ2_bzDecompress(&stream->bzip2);
    size_t taken = given - stream->bzip2.avail_in, made = room - stream->bzip2.avail_out;
    hl_stream_take(base->below, taken);
    *count += made;
    if (answer == BZ_MEM_ERROR) return hl_fail_memory(error, 4000000, base->path);
    if (answer == BZ_STREAM_END) status = bzip2_next(stream, error);
    else if (answer != BZ_OK) status = fail_damaged(base, error);
    if (status != HL_OK) return status;
    if (answer == BZ_OK && taken == 0 && made == 0) {
      base->cut_short = true;
      break;
    }
  }
  return HL_OK;
}

static uint64_t bzip2_at_most(const hl_stream *stream) { return times(stream, BZIP2_GREATEST_RATIO); }

static void bzip2_close(hl_stream *stream) {
  if (((bzip2_stream *)stream)->started) BZ2_bzDecompressEnd(&((bzip2_stream *)stream)->bzip2);
}

hl_status hl_stream_push_bzip2(hl_stream **stream, hl_error *error) {
  bzip2_stream *made = (bzip2_stream *)hl_stream_make((*stream)->context, sizeof *made, *stream);
  if (made == NULL) return hl_fail_memory(error, HL_STREAM_BUFFER_BYTES, (*stream)->path);
  made->base.pull = bzip2_pull;
  made->base.at_most = bzip2_at_most;
  made->base.close = bzip2_close;
  *stream = &made->base;
  return bzip2_start(made, error);
}
#else
hl_status hl_stream_push_bzip2(hl_stream **stream, hl_error *error) {
  return fail_absent(*stream, "bzip2", error);
}
#endif

/* ---- xz ---- */

#ifdef HL_HAS_LZMA

/* The greatest number of bytes of memory that liblzma may allocate to unpack xz. Files packed with the
 * strongest setting need 65 MiB. */
#define XZ_MEMORY ((uint64_t)256 << 20)
/* The greatest number of bytes to which one byte packed by xz unpacks. Derived: the longest match repeats 273
 * bytes, and costs fourteen binary decisions of at least log2(2048 / 2017) = .022 bits each, so that one byte
 * unpacks to at most 7,090 bytes. */
enum { XZ_GREATEST_RATIO = 8192 };

typedef struct xz_stream {
  hl_stream base;
  lzma_stream xz;
  bool finished;
} xz_stream;

static hl_status xz_pull(hl_stream *base, unsigned char *bytes, size_t capacity, size_t *count,
                         hl_error *error) {
  xz_stream *stream = (xz_stream *)base;
  *count = 0;
  while (*count < capacity && !stream->finished) {
    const unsigned char *input;
    size_t available;
    hl_status status = hl_stream_peek(base->below, 1, &input, &available, error);
    if (status != HL_OK) return status;
    stream->xz.next_in = input;
    stream->xz.avail_in = available;
    stream->xz.next_out = bytes + *count;
    stream->xz.avail_out = capacity - *count;
    lzma_ret answer = lzma_code(&stream->xz, available == 0 ? LZMA_FINISH : LZMA_RUN);
    hl_stream_take(base->below, available - stream->xz.avail_in);
    *count = capacity - stream->xz.avail_out;
    stream->finished = answer == LZMA_STREAM_END;
    if (answer == LZMA_MEM_ERROR || answer == LZMA_MEMLIMIT_ERROR)
      return hl_fail_memory(error, (size_t)XZ_MEMORY, base->path);
    if (answer == LZMA_BUF_ERROR) {
      base->cut_short = true;
      break;
    }
    if (answer != LZMA_OK && answer != LZMA_STREAM_END) return fail_damaged(base, error);
  }
  return HL_OK;
}

static uint64_t xz_at_most(const hl_stream *stream) { return times(stream, XZ_GREATEST_RATIO); }
static void xz_close(hl_stream *stream) { lzma_end(&((xz_stream *)stream)->xz); }

hl_status hl_stream_push_xz(hl_stream **stream, hl_error *error) {
  static const lzma_stream none = LZMA_STREAM_INIT;
  xz_stream *made = (xz_stream *)hl_stream_make((*stream)->context, sizeof *made, *stream);
  if (made == NULL) return hl_fail_memory(error, HL_STREAM_BUFFER_BYTES, (*stream)->path);
  made->xz = none;
  made->base.pull = xz_pull;
  made->base.at_most = xz_at_most;
  made->base.close = xz_close;
  *stream = &made->base;
  return lzma_stream_decoder(&made->xz, XZ_MEMORY, LZMA_CONCATENATED) == LZMA_OK
             ? HL_OK
             : hl_fail_memory(error, 100000, made->base.path);
}
#else
hl_status hl_stream_push_xz(hl_stream **stream, hl_error *error) { return fail_absent(*stream, "xz", error); }
#endif

/* ---- by the first bytes ---- */

hl_status hl_stream_unpack(hl_stream **stream, hl_error *error) {
  const unsigned char *bytes;
  size_t length;
  hl_status status = hl_stream_peek(*stream, 10, &bytes, &length, error);
  if (status != HL_OK) return status;
  if (length >= 3 && memcmp(bytes, "\x1f\x8b\x08", 3) == 0) return hl_stream_push_inflate(stream, error);
  /* the mark of bzip2 is "BZh", a digit, and six bytes: digits of pi or, if the file is empty, digits of the
   * square root of pi. A file that was cut off may have fewer than these six bytes */
  size_t marked = length < 10 ? (length > 4 ? length - 4 : 0) : 6;
  if (length >= 4 && memcmp(bytes, "BZh", 3) == 0 && bytes[3] >= '1' && bytes[3] <= '9' &&
      (memcmp(bytes + 4, "\x31\x41\x59\x26\x53\x59", marked) == 0 ||
       memcmp(bytes + 4, "\x17\x72\x45\x38\x50\x90", marked) == 0))
    return hl_stream_push_bzip2(stream, error);
  if (length >= 6 && memcmp(bytes, "\3757zXZ\0", 6) == 0) return hl_stream_push_xz(stream, error);
  return HL_OK;
}
