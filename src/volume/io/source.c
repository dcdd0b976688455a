/* volume/io/source.c - reads bytes at any position of a file, of memory, or of deflated data. Files are read
 * by pread(). Deflated data are inflated up to the last byte that was requested so far, and the inflated
 * bytes stay in memory. */
#define _GNU_SOURCE
#include "volume/io/source.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include "core/file.h"
#include "core/memory.h"

enum { FIRST_LOOK_BYTES = 2048 };

struct hl_source {
  hl_context *context;
  char *path;            /* owned */
  int descriptor;        /* a file's descriptor, else -1 */
  bool is_borrowed;      /* whether the caller owns the descriptor */
  hl_source_part *parts; /* owned; [part_count]; the known parts of a file; null for other sources */
  size_t part_count;
  const unsigned char *memory; /* borrowed; [size]; may be null */
  uint64_t size;
  unsigned char *window; /* owned; for files: the bytes [window_begin, + window_length) */
  uint64_t window_begin;
  size_t window_length, window_most; /* number of bytes in the window; number of bytes that the last call read
                                      * from the file */
  /* The following members are set for a source that is a part of another source, or that inflates a part. */
  hl_source *below;  /* owned; may be null */
  uint64_t below_at; /* position of the next byte to read from `below` */
  struct {
    unsigned char *bytes; /* owned; [capacity]; the first `length` bytes have been inflated */
    size_t length, capacity;
    bool ended;
    z_stream zlib;
  } inflated; /* the bytes to which the deflated data were inflated so far */
};

static voidpf zlib_allocate(voidpf context, uInt count, uInt size) {
  return hl_allocate(context, count, size);
}
static void zlib_release(voidpf context, voidpf memory) { hl_release(context, memory); }

static hl_status make(hl_context *context, const char *path, hl_source **source, hl_error *error) {
  *source = hl_allocate_zeroed(context, 1, sizeof **source);
  if (*source == NULL) return hl_fail_memory(error, sizeof **source, path);
  (*source)->context = context;
  (*source)->descriptor = -1;
  (*source)->path = hl_copy_text(context, path);
  if ((*source)->path != NULL) return HL_OK;
  hl_source_close(*source);
  *source = NULL;
  return hl_fail_memory(error, strlen(path), path);
}

void hl_source_close(hl_source *source) {
  if (source == NULL) return;
  hl_source_close(source->below);
  if (source->inflated.zlib.state != NULL) inflateEnd(&source->inflated.zlib);
  if (source->descriptor >= 0 && !source->is_borrowed) close(source->descriptor);
  hl_release(source->context, source->parts);
  hl_release(source->context, source->inflated.bytes);
  hl_release(source->context, source->window);
  hl_release(source->context, source->path);
  hl_release(source->context, source);
}

static hl_status make_window(hl_source *source, hl_error *error) {
  source->window = hl_allocate(source->context, HL_SOURCE_WINDOW_BYTES, 1);
  return source->window != NULL ? HL_OK : hl_fail_memory(error, HL_SOURCE_WINDOW_BYTES, source->path);
}

static hl_status begin_file(hl_source *source, bool quiet, hl_error *error) {
  hl_status status = HL_OK;
  if (quiet) status = hl_file_open_again(source->context, source->path, &source->descriptor, error);
  else status = hl_file_open(source->context, source->path, &source->descriptor, error);
  if (status != HL_OK) return status;
  struct stat about;
  if (fstat(source->descriptor, &about) != 0)
    return hl_fail(error, HL_ERROR_IO, "%s: cannot open: %s", source->path, strerror(errno));
  if (!S_ISREG(about.st_mode)) return hl_fail(error, HL_ERROR_IO, "%s: is not a regular file", source->path);
  source->size = about.st_size > 0 ? (uint64_t)about.st_size : 0;
  return make_window(source, error);
}

hl_status hl_source_open(hl_context *context, const char *path, bool quiet, hl_source **source,
                         hl_error *error) {
  hl_status status = make(context, path, source, error);
  if (status == HL_OK) status = begin_file(*source, quiet, error);
  if (status == HL_OK) return HL_OK;
  hl_source_close(*source);
  *source = NULL;
  return status;
}

hl_status hl_source_of_descriptor(hl_context *context, const char *path, int descriptor, uint64_t size,
                                  hl_source **source, hl_error *error) {
  hl_status status = make(context, path, source, error);
  if (status != HL_OK) return status;
  (*source)->descriptor = descriptor;
  (*source)->is_borrowed = true;
  (*source)->size = size;
  status = make_window(*source, error);
  if (status == HL_OK) return HL_OK;
  hl_source_close(*source);
  *source = NULL;
  return status;
}

hl_status hl_source_of_parts(hl_context *context, const char *path, const hl_source_part *parts, size_t count,
                             uint64_t whole, hl_source **source, hl_error *error) {
  hl_status status = make(context, path, source, error);
  if (status != HL_OK) return status;
  (*source)->size = whole;
  (*source)->part_count = count;
  (*source)->parts = hl_allocate(context, count, sizeof *parts);
  if ((*source)->parts == NULL) status = hl_fail_memory(error, count * sizeof *parts, path);
  else memcpy((*source)->parts, parts, count * sizeof *parts);
  if (status == HL_OK) status = make_window(*source, error);
  if (status == HL_OK) return HL_OK;
  hl_source_close(*source);
  *source = NULL;
  return status;
}

hl_status hl_source_of_memory(hl_context *context, const char *path, const void *bytes, size_t count,
                              hl_source **source, hl_error *error) {
  hl_status status = make(context, path, source, error);
  if (status != HL_OK) return status;
  (*source)->memory = bytes;
  (*source)->size = count;
  return HL_OK;
}

hl_status hl_source_cut(hl_source **source, uint64_t begin, uint64_t count, hl_error *error) {
  hl_source *below = *source, *made;
  hl_status status = make(below->context, below->path, &made, error);
  if (status != HL_OK) return status;
  uint64_t left = begin < below->size ? below->size - begin : 0;
  made->below = below;
  made->below_at = begin;
  made->size = count < left ? count : left;
  *source = made;
  return HL_OK;
}

hl_status hl_source_inflate(hl_source **source, uint64_t begin, uint64_t limit, hl_error *error) {
  hl_source *below = *source, *made;
  hl_status status = make(below->context, below->path, &made, error);
  if (status != HL_OK) return status;
  made->inflated.zlib.zalloc = zlib_allocate;
  made->inflated.zlib.zfree = zlib_release;
  made->inflated.zlib.opaque = below->context;
  /* In zlib.h, 15 is the largest window; the negative sign means that the data have no header. */
  if (inflateInit2(&made->inflated.zlib, -15) != Z_OK) {
    hl_source_close(made);
    return hl_fail_memory(error, 50000, "decompression");
  }
  /* one byte of deflate data unpacks to at most 1032 bytes, because two bits can stand for 258 bytes */
  uint64_t left = begin < below->size ? below->size - begin : 0;
  uint64_t most = left > UINT64_MAX / 1032 ? UINT64_MAX : left * 1032;
  made->below = below;
  made->below_at = begin;
  made->size = limit < most ? limit : most;
  *source = made;
  return HL_OK;
}

hl_context *hl_source_context(const hl_source *source) { return source->context; }
const char *hl_source_path(const hl_source *source) { return source->path; }
uint64_t hl_source_size(const hl_source *source) { return source->size; }

/* Finds the part that holds the byte at `offset`, and returns the part's descriptor, or -1 if no part holds
 * the byte. *offset is set to the byte's position in the descriptor. *wanted is reduced to the number of
 * bytes up to the part's end, or to 0 if no part holds the byte. */
static int find_part(const hl_source *source, uint64_t *offset, size_t *wanted) {
  for (size_t n = 0; n < source->part_count; n++) {
    const hl_source_part *part = &source->parts[n];
    if (*offset < part->begin || *offset - part->begin >= part->count) continue;
    *offset -= part->begin;
    if (part->count - *offset < *wanted) *wanted = (size_t)(part->count - *offset);
    return part->descriptor;
  }
  *wanted = 0;
  return -1;
}

static hl_status read_file(hl_source *source, uint64_t offset, void *bytes, size_t wanted, size_t *count,
                           hl_error *error) {
  int descriptor = source->parts != NULL ? find_part(source, &offset, &wanted) : source->descriptor;
  for (*count = 0; *count < wanted;) {
    ssize_t got = pread(descriptor, (unsigned char *)bytes + *count, wanted - *count,
                        (off_t)(offset + *count));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return hl_fail(error, HL_ERROR_IO, "%s: cannot read: %s", source->path, strerror(errno));
    if (got == 0) break;
    *count += (size_t)got;
  }
  return HL_OK;
}

static hl_status grow(hl_source *source, uint64_t needed, hl_error *error) {
  enum { LEAST = 1 << 17 };
  if (needed <= source->inflated.capacity) return HL_OK;
  uint64_t capacity = source->inflated.capacity > 0 ? source->inflated.capacity : LEAST;
  while (capacity < needed) capacity *= 2;
  if (capacity > source->size) capacity = source->size;
  if (capacity > SIZE_MAX) return hl_fail_memory(error, SIZE_MAX, source->path);
  unsigned char *larger = hl_reallocate(source->context, source->inflated.bytes, (size_t)capacity, 1);
  if (larger == NULL) return hl_fail_memory(error, (size_t)capacity, source->path);
  source->inflated.bytes = larger;
  source->inflated.capacity = (size_t)capacity;
  return HL_OK;
}

/* Calls zlib's inflate() once. The inflated bytes may fill the free memory in `inflated`. */
static hl_status inflate_more(hl_source *source, hl_error *error) {
  const unsigned char *bytes;
  size_t available;
  hl_status status = hl_source_peek(source->below, source->below_at, HL_SOURCE_WINDOW_BYTES, &bytes,
                                    &available, error);
  if (status != HL_OK) return status;
  size_t room = source->inflated.capacity - source->inflated.length;
  source->inflated.zlib.next_in = (Bytef *)bytes;
  source->inflated.zlib.avail_in = (uInt)available;
  source->inflated.zlib.next_out = source->inflated.bytes + source->inflated.length;
  source->inflated.zlib.avail_out = room > (1u << 30) ? 1u << 30 : (uInt)room;
  uInt offered = source->inflated.zlib.avail_out;
  int answer = inflate(&source->inflated.zlib, Z_NO_FLUSH);
  source->below_at += available - source->inflated.zlib.avail_in;
  source->inflated.length += offered - source->inflated.zlib.avail_out;
  if (answer == Z_STREAM_END || (available == 0 && offered == source->inflated.zlib.avail_out))
    source->inflated.ended = true;
  else if (answer == Z_MEM_ERROR) return hl_fail_memory(error, 50000, "decompression");
  else if (answer != Z_OK && answer != Z_BUF_ERROR)
    return hl_fail(error, HL_ERROR_INPUT, "%s: the compressed data are damaged", source->path);
  return HL_OK;
}

/* Inflates data until at least the first `needed` bytes are in memory, or until the data end. */
static hl_status inflate_up_to(hl_source *source, uint64_t needed, hl_error *error) {
  if (needed > source->size) needed = source->size;
  hl_status status = HL_OK;
  while (status == HL_OK && source->inflated.length < needed && !source->inflated.ended) {
    uint64_t next = source->inflated.length + (uint64_t)HL_SOURCE_WINDOW_BYTES;
    status = grow(source, next < source->size ? next : source->size, error);
    if (status == HL_OK) status = inflate_more(source, error);
  }
  if (status == HL_OK && source->inflated.ended) source->size = source->inflated.length;
  return status;
}

static size_t clip(const hl_source *source, uint64_t offset, size_t wanted) {
  uint64_t left = offset < source->size ? source->size - offset : 0;
  return left < wanted ? (size_t)left : wanted;
}

static hl_status peek_inflated(hl_source *source, uint64_t offset, size_t wanted, const unsigned char **bytes,
                               size_t *available, hl_error *error) {
  hl_status status = inflate_up_to(source, offset > UINT64_MAX - wanted ? UINT64_MAX : offset + wanted,
                                   error);
  *available = clip(source, offset, wanted);
  if (offset >= source->inflated.length) *available = 0;
  else if (source->inflated.length - offset < *available)
    *available = (size_t)(source->inflated.length - offset);
  if (*available > 0) /* If no byte is available, *bytes stays the empty block that the caller has set. */
    *bytes = source->inflated.bytes + offset;
  return status;
}

hl_status hl_source_peek(hl_source *source, uint64_t offset, size_t wanted, const unsigned char **bytes,
                         size_t *available, hl_error *error) {
  static const unsigned char none[1];
  *bytes = none;
  *available = clip(source, offset, wanted);
  if (*available == 0 && source->inflated.zlib.state == NULL) return HL_OK;
  if (source->memory != NULL) {
    *bytes = source->memory + offset;
    return HL_OK;
  }
  if (source->inflated.zlib.state != NULL)
    return peek_inflated(source, offset, wanted, bytes, available, error);
  if (source->below != NULL)
    return hl_source_peek(source->below, source->below_at + offset, *available, bytes, available, error);
  if (offset < source->window_begin || offset + *available > source->window_begin + source->window_length) {
    /* the first call reads few bytes, because most headers are short; each later call reads up to four times
     * as many */
    size_t most = source->window_most > 0 ? 4 * source->window_most : FIRST_LOOK_BYTES;
    source->window_most = most < *available ? *available : most;
    if (source->window_most > HL_SOURCE_WINDOW_BYTES) source->window_most = HL_SOURCE_WINDOW_BYTES;
    source->window_begin = offset;
    hl_status status = read_file(source, offset, source->window, source->window_most, &source->window_length,
                                 error);
    if (status != HL_OK) {
      source->window_length = *available = 0;
      return status;
    }
  }
  size_t skipped = (size_t)(offset - source->window_begin), known = source->window_length - skipped;
  *bytes = source->window + skipped;
  if (known < *available) *available = known; /* the file has shrunk */
  return HL_OK;
}

hl_status hl_source_read(hl_source *source, uint64_t offset, void *bytes, size_t wanted, size_t *count,
                         hl_error *error) {
  *count = 0;
  if (source->descriptor >= 0 || source->parts != NULL)
    return read_file(source, offset, bytes, clip(source, offset, wanted), count, error);
  if (source->below != NULL && source->inflated.zlib.state == NULL)
    return hl_source_read(source->below, source->below_at + offset, bytes, clip(source, offset, wanted),
                          count, error);
  const unsigned char *known;
  hl_status status = hl_source_peek(source, offset, wanted, &known, count, error);
  if (status == HL_OK && *count > 0) memcpy(bytes, known, *count);
  return status;
}

hl_status hl_source_read_whole(hl_source *source, const char *name, uint64_t most, unsigned char **bytes,
                               size_t *length, hl_error *error) {
  uint64_t size = hl_source_size(source);
  *length = 0;
  if (size > most || size > SIZE_MAX)
    return hl_fail(error, HL_ERROR_INPUT, "%s: %llu bytes, more than the %llu that are read at once", name,
                   (unsigned long long)size, (unsigned long long)most);
  *bytes = hl_allocate(source->context, (size_t)size, 1);
  if (*bytes == NULL) return hl_fail_memory(error, (size_t)size, name);
  return hl_source_read(source, 0, *bytes, (size_t)size, length, error);
}
