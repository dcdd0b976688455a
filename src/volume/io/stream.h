/* volume/io/stream.h - streams: bytes that are pulled in order through a chain of a file and any decoders on
 * top of it.
 *
 * A format's reader reads its header from the top of the chain, pushes decoders for the voxels, and reads on.
 * No stream holds more than its buffer, so a load needs little memory beside the volume itself. */
#ifndef HL_VOLUME_STREAM_H
#define HL_VOLUME_STREAM_H

#include "core/error.h"

#include <stdbool.h>

enum { HL_STREAM_BUFFER_BYTES = 65536, HL_LINE_BYTES = 16384 };

typedef struct hl_stream hl_stream;

/* The common part of every kind of stream. */
struct hl_stream {
  hl_context *context;
  char *path;            /* path of the file at the bottom of the chain, which owns it */
  hl_stream *below;      /* owned; null for a file */
  unsigned char *buffer; /* owned; HL_STREAM_BUFFER_BYTES; bytes [begin, end) are not yet read */
  size_t begin, end;
  uint64_t offset; /* number of bytes read from the stream so far */
  bool ended;      /* whether nothing more can be pulled */
  bool cut_short;  /* whether the stream ended within compressed or encoded data */
  bool line_end_known, line_end_is_return;
  /* Pulls up to `capacity` bytes more. *count is 0 at the end. */
  hl_status (*pull)(hl_stream *stream, unsigned char *bytes, size_t capacity, size_t *count, hl_error *error);
  /* An upper bound of the bytes that can still be pulled; UINT64_MAX if unknown. */
  uint64_t (*at_most)(const hl_stream *stream);
  void (*close)(hl_stream *stream); /* releases the owned memory of this kind of stream; may be null */
};

/* Opens a file. regular_only: whether to refuse pipes and devices, for files that another file names. */
hl_status hl_stream_open(hl_context *context, const char *path, bool regular_only, hl_stream **stream,
                         hl_error *error);
/* Opens a block of memory as the content of a file. The memory must outlive the stream. path: the file's name
 * in error lines; other files that the content names are looked for in the folder of `path`. */
hl_status hl_stream_open_memory(hl_context *context, const char *path, const void *bytes, size_t byte_count,
                                hl_stream **stream, hl_error *error);
/* Replaces *stream by the file that its own file names (relative to its folder). */
hl_status hl_stream_switch(hl_stream **stream, const char *name, hl_error *error);
/* Whether the file of *stream can be read a second time: a regular file or memory. */
bool hl_stream_can_restart(const hl_stream *stream);
/* Whether the stream is a regular file itself, without decoders, pipes or memory. */
bool hl_stream_is_plain_file(const hl_stream *stream);
/* The descriptor of a plain file. */
int hl_stream_descriptor(const hl_stream *stream);
/* Whether the stream is the caller's memory itself, from its first byte to its last. */
bool hl_stream_memory(const hl_stream *stream, const unsigned char **bytes, size_t *length);
/* Opens *stream's file again from the start. hl_stream_can_restart() must be true. */
hl_status hl_stream_restart(hl_stream **stream, hl_error *error);
void hl_stream_close(hl_stream *stream); /* closes the whole chain; null is allowed */

/* For implementations of streams: allocates a zeroed block of `size` bytes that starts with an hl_stream on
 * top of `below`, which may be null. */
hl_stream *hl_stream_make(hl_context *context, size_t size, hl_stream *below);

/* Shows at least `wanted` bytes (at most HL_STREAM_BUFFER_BYTES) without consuming them, fewer only at the
 * end. The bytes stay valid until the next call. */
hl_status hl_stream_peek(hl_stream *stream, size_t wanted, const unsigned char **bytes, size_t *available,
                         hl_error *error);
/* Consumes peeked bytes. */
void hl_stream_take(hl_stream *stream, size_t count);
/* Reads `wanted` bytes. *count is less than wanted only at the end. */
hl_status hl_stream_read(hl_stream *stream, void *bytes, size_t wanted, size_t *count, hl_error *error);
/* Reads exactly the requested bytes, or fails. */
hl_status hl_stream_read_all(hl_stream *stream, void *bytes, size_t wanted, hl_error *error);
/* Reads all bytes that are left: of a pipe, or of compressed data whose parts are needed in any order. *bytes
 * must be null before; the caller owns it, also on failure. */
hl_status hl_stream_read_rest(hl_stream *stream, unsigned char **bytes, size_t *length, hl_error *error);
hl_status hl_stream_skip(hl_stream *stream, uint64_t count, hl_error *error);
/* Reads one line, without its line end. A line ends with LF, with CR LF or, if the first line ends with it,
 * with CR. *ended: whether there are no more lines. */
hl_status hl_stream_line(hl_stream *stream, char line[HL_LINE_BYTES], bool *ended, hl_error *error);
/* An upper bound of the bytes that can still be read; UINT64_MAX if unknown. */
uint64_t hl_stream_at_most(const hl_stream *stream);

#endif
