/* volume/io/stream.h - reads streams of bytes. Bytes are read in order, through a chain that consists of a
 * file and the decoders on top of it.
 *
 * A format's reader reads the header from the top of the chain, pushes decoders for the voxels, and then
 * reads the voxels. Each stream holds no more than its buffer, so that loading takes little memory beside the
 * volume. */
#ifndef HL_VOLUME_STREAM_H
#define HL_VOLUME_STREAM_H

#include "core/error.h"

#include <stdbool.h>

enum { HL_STREAM_BUFFER_BYTES = 65536, HL_LINE_BYTES = 16384 };

typedef struct hl_stream hl_stream;

/* The common part of every kind of stream. */
struct hl_stream {
  hl_context *context;
  char *path;            /* path of the file at the bottom of the chain; owned by that stream */
  hl_stream *below;      /* owned; null for a file */
  unsigned char *buffer; /* owned; HL_STREAM_BUFFER_BYTES; the bytes [begin, end) have not been read yet */
  size_t begin, end;
  uint64_t offset; /* number of bytes read from the stream so far */
  bool ended;      /* whether `pull` gives no further bytes */
  bool cut_short;  /* whether the stream ended in the middle of compressed or encoded data */
  bool line_end_known, line_end_is_return;
  /* Reads up to `capacity` further bytes, without the buffer. *count is 0 at the stream's end. */
  hl_status (*pull)(hl_stream *stream, unsigned char *bytes, size_t capacity, size_t *count, hl_error *error);
  /* An upper bound of the number of bytes that `pull` can still give; UINT64_MAX if unknown. */
  uint64_t (*at_most)(const hl_stream *stream);
  void (*close)(hl_stream *stream); /* releases the memory that this kind of stream owns; may be null */
};

/* Opens a file. regular_only: whether to refuse pipes and devices, as for a file that another file names. */
hl_status hl_stream_open(hl_context *context, const char *path, bool regular_only, hl_stream **stream,
                         hl_error *error);
/* Makes a stream of a block of memory, which is read like a file. The memory must outlive the stream. path:
 * the file's name in error lines. If the content names other files, these files are searched in the folder of
 * `path`. */
hl_status hl_stream_open_memory(hl_context *context, const char *path, const void *bytes, size_t byte_count,
                                hl_stream **stream, hl_error *error);
/* Replaces *stream by another file, whose name is relative to the folder of the file of *stream. */
hl_status hl_stream_switch(hl_stream **stream, const char *name, hl_error *error);
/* Returns whether the file of *stream can be read a second time, because it is a regular file or memory. */
bool hl_stream_can_restart(const hl_stream *stream);
/* Returns whether the stream is a regular file without any decoders on top of it. */
bool hl_stream_is_plain_file(const hl_stream *stream);
/* The descriptor of a plain file. */
int hl_stream_descriptor(const hl_stream *stream);
/* Returns whether the stream is the caller's memory without any decoders on top of it. *bytes, *length: set
 * to the memory and its length. */
bool hl_stream_memory(const hl_stream *stream, const unsigned char **bytes, size_t *length);
/* Replaces *stream by a new stream that reads the same file from its start. hl_stream_can_restart() must be
 * true. */
hl_status hl_stream_restart(hl_stream **stream, hl_error *error);
void hl_stream_close(hl_stream *stream); /* closes the whole chain; null is allowed */

/* Makes a stream for an implementation of a kind of streams: a block of `size` zero bytes, which begins with
 * an hl_stream. below: the stream from which the new stream reads; may be null. */
hl_stream *hl_stream_make(hl_context *context, size_t size, hl_stream *below);

/* Gives access to at least `wanted` bytes (at most HL_STREAM_BUFFER_BYTES) without consuming them; *available
 * is less than `wanted` only at the stream's end. The bytes stay valid until the next call. */
hl_status hl_stream_peek(hl_stream *stream, size_t wanted, const unsigned char **bytes, size_t *available,
                         hl_error *error);
/* Consumes the next `count` bytes, which hl_stream_peek() has given. */
void hl_stream_take(hl_stream *stream, size_t count);
/* Reads `wanted` bytes. *count is less than `wanted` only at the stream's end. */
hl_status hl_stream_read(hl_stream *stream, void *bytes, size_t wanted, size_t *count, hl_error *error);
/* Reads exactly the requested bytes, or fails. */
hl_status hl_stream_read_all(hl_stream *stream, void *bytes, size_t wanted, hl_error *error);
/* Reads all bytes that are left. Callers use hl_stream_read_rest() for pipes, and for compressed data whose
 * parts are needed in any order. *bytes must be null before the call; the caller owns *bytes, also on
 * failure. */
hl_status hl_stream_read_rest(hl_stream *stream, unsigned char **bytes, size_t *length, hl_error *error);
hl_status hl_stream_skip(hl_stream *stream, uint64_t count, hl_error *error);
/* Reads one line, without its line end. A line ends with LF or CR LF; if the first line ends with CR alone,
 * all lines end with CR. *ended: set to whether the stream has no further line. */
hl_status hl_stream_line(hl_stream *stream, char line[HL_LINE_BYTES], bool *ended, hl_error *error);
/* An upper bound of the number of bytes that can still be read from the stream; UINT64_MAX if unknown. */
uint64_t hl_stream_at_most(const hl_stream *stream);

#endif
