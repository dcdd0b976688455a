/* platform/byte_stream.h - opens a stream of the C library whose bytes go to functions of the caller. */
#ifndef HL_PLATFORM_BYTE_STREAM_H
#define HL_PLATFORM_BYTE_STREAM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

typedef struct hl_byte_stream {
  void *data;
  /* Reads or writes bytes at the stream's position, and moves the position. Returns false, with errno set, on
   * failure. */
  bool (*write)(void *data, const char *bytes, size_t length);
  /* Moves the stream's position, as fseek() does. Returns the new position; -1 if the position would lie
   * before the stream's beginning. */
  int64_t (*seek)(void *data, int64_t offset, int whence);
} hl_byte_stream;

/* Opens a stream, which the caller closes by fclose(). Returns null, with errno set, on failure. */
FILE *hl_byte_stream_open(hl_byte_stream *stream);

/* Flushes the stream, so that write() has received all bytes. Returns false on failure. */
bool hl_byte_stream_finish(hl_byte_stream *stream, FILE *file);

#endif
