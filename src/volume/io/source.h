/* volume/io/source.h - reads bytes at any position of a file, of memory, or of deflated data.
 *
 * Streams (stream.h) are read once, in order. Sources serve formats whose headers contain positions in the
 * file. */
#ifndef HL_VOLUME_SOURCE_H
#define HL_VOLUME_SOURCE_H

#include <stdbool.h>

#include "core/error.h"

enum { HL_SOURCE_WINDOW_BYTES = 65536 };

typedef struct hl_source hl_source;

/* Opens a regular file. quiet: whether the context's `reads` callback is not called. quiet must be true on
 * threads other than the caller's, and for files that were reported to `reads` before. */
hl_status hl_source_open(hl_context *context, const char *path, bool quiet, hl_source **source,
                         hl_error *error);
/* Makes a source of the first `size` bytes of an open file. The caller still owns the descriptor, which must
 * stay open as long as the source exists. */
hl_status hl_source_of_descriptor(hl_context *context, const char *path, int descriptor, uint64_t size,
                                  hl_source **source, hl_error *error);
/* A part of a file. The part's bytes are the first bytes of the descriptor's own file. */
typedef struct hl_source_part {
  int descriptor;
  uint64_t begin, count; /* the position of the part in the whole file, and the number of its bytes */
} hl_source_part;

/* Opens a file of which some parts are known. parts: [count], copied; the caller still owns the descriptors,
 * which must stay open as long as the source exists. whole: the file's size. At a position that lies in no
 * known part, the source gives no bytes, as at the end of a file. */
hl_status hl_source_of_parts(hl_context *context, const char *path, const hl_source_part *parts, size_t count,
                             uint64_t whole, hl_source **source, hl_error *error);
/* Makes a source of bytes in memory. path: the name in error lines. The bytes must outlive the source. */
hl_status hl_source_of_memory(hl_context *context, const char *path, const void *bytes, size_t count,
                              hl_source **source, hl_error *error);
/* Makes a source of the bytes [begin, begin + count) of *source. The new source replaces *source and owns
 * it. */
hl_status hl_source_cut(hl_source **source, uint64_t begin, uint64_t count, hl_error *error);
/* Makes a source of the bytes to which deflate data inflate. The data have no header, and begin at position
 * `begin` of *source. At most `limit` bytes are inflated. Bytes are inflated when they are first needed, and
 * then stay in memory. The new source replaces *source and owns it. */
hl_status hl_source_inflate(hl_source **source, uint64_t begin, uint64_t limit, hl_error *error);
void hl_source_close(hl_source *source); /* null is allowed */

hl_context *hl_source_context(const hl_source *source);
const char *hl_source_path(const hl_source *source);
/* The length of the source in bytes; for deflated data an upper bound of the length. */
uint64_t hl_source_size(const hl_source *source);

/* Gives access to up to `wanted` bytes (at most HL_SOURCE_WINDOW_BYTES) from `offset` on; *available is less
 * than `wanted` only at the source's end. The bytes stay valid until the next call. */
hl_status hl_source_peek(hl_source *source, uint64_t offset, size_t wanted, const unsigned char **bytes,
                         size_t *available, hl_error *error);
/* Copies `wanted` bytes from `offset` on. *count is less than `wanted` only at the source's end. */
hl_status hl_source_read(hl_source *source, uint64_t offset, void *bytes, size_t wanted, size_t *count,
                         hl_error *error);
/* Reads all bytes of a source. Fails if the source has more than `most` bytes. *bytes must be null before the
 * call; the caller owns *bytes (hl_release), also after a failure. *length: number of bytes. name: the file's
 * name, for error lines. */
hl_status hl_source_read_whole(hl_source *source, const char *name, uint64_t most, unsigned char **bytes,
                               size_t *length, hl_error *error);

#endif
