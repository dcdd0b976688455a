/* volume/stream.h - bytes pulled in order through a chain: a file, then any decoders on top of it.
 *
 * Formats read their header from the top of the chain, push what decodes the payload, and read on. No
 * stream holds more than its buffer, so a load needs little memory beside the volume itself.
 */
#ifndef HL_VOLUME_STREAM_H
#define HL_VOLUME_STREAM_H

#include "core/error.h"

#include <stdbool.h>

enum { HL_STREAM_BUFFER_BYTES = 65536, HL_LINE_BYTES = 16384 };

typedef struct hl_stream hl_stream;

/* The common part of every kind of stream. */
struct hl_stream {
  hl_context *context;
  char *path;            /* of the file at the bottom, which owns it */
  hl_stream *below;      /* owned; null for a file */
  unsigned char *buffer; /* owned; HL_STREAM_BUFFER_BYTES, bytes [begin, end) are not yet read */
  size_t begin, end;
  uint64_t offset; /* bytes read from this stream so far */
  bool ended;      /* nothing more to pull */
  bool cut_short;  /* the end came in the middle of compressed or encoded data */
  bool line_end_known, line_end_is_return;
  /* Up to capacity bytes more; *count 0 at the end. */
  hl_status (*pull)(hl_stream *stream, unsigned char *bytes, size_t capacity, size_t *count, hl_error *error);
  /* The most bytes that can yet be pulled; UINT64_MAX if unknown. */
  uint64_t (*at_most)(const hl_stream *stream);
  void (*close)(hl_stream *stream); /* releases what this kind of stream owns; may be null */
};

/* Opens a file. regular_only: refuse pipes and devices (files that are named by another file). */
hl_status hl_stream_open(hl_context *context, const char *path, bool regular_only, hl_stream **stream,
                         hl_error *error);
/* The same of a file's content that is in the caller's memory, which must outlive the stream; path names it,
 * and is where files that it names are looked for. */
hl_status hl_stream_open_memory(hl_context *context, const char *path, const void *bytes, size_t byte_count,
                                hl_stream **stream, hl_error *error);
/* Replaces *stream by the file that its own file names (relative to its folder). */
hl_status hl_stream_switch(hl_stream **stream, const char *name, hl_error *error);
/* Whether *stream's file can be read again: an ordinary one, or memory. */
bool hl_stream_can_restart(const hl_stream *stream);
/* Opens *stream's file, which must be one of these, again from the start. */
hl_status hl_stream_restart(hl_stream **stream, hl_error *error);
void hl_stream_close(hl_stream *stream); /* the whole chain; null is allowed */

/* For kinds of streams: a zeroed block of size bytes that starts with an hl_stream over below (or null). */
hl_stream *hl_stream_make(hl_context *context, size_t size, hl_stream *below);

/* At least wanted bytes (at most HL_STREAM_BUFFER_BYTES) without reading them, fewer only at the end. The
 * bytes stay valid until the next call. */
hl_status hl_stream_peek(hl_stream *stream, size_t wanted, const unsigned char **bytes, size_t *available,
                         hl_error *error);
/* Reads bytes that were peeked. */
void hl_stream_take(hl_stream *stream, size_t count);
/* *count < wanted only at the end. */
hl_status hl_stream_read(hl_stream *stream, void *bytes, size_t wanted, size_t *count, hl_error *error);
/* All of the bytes, or an error. */
hl_status hl_stream_read_all(hl_stream *stream, void *bytes, size_t wanted, hl_error *error);
hl_status hl_stream_skip(hl_stream *stream, uint64_t count, hl_error *error);
/* One line without its end, which is LF, CR LF or, if the first line ends so, CR. *ended: there is none. */
hl_status hl_stream_line(hl_stream *stream, char line[HL_LINE_BYTES], bool *ended, hl_error *error);
/* The most bytes that can yet be read; UINT64_MAX if unknown. */
uint64_t hl_stream_at_most(const hl_stream *stream);

#endif
