/* platform/posix/byte_stream.c - see platform/byte_stream.h. */
#define _GNU_SOURCE /* fopencookie */
#include "platform/byte_stream.h"

#include <sys/types.h>

static ssize_t on_write(void *cookie, const char *bytes, size_t length) {
  const hl_byte_stream *stream = cookie;
  return stream->write(stream->data, bytes, length) ? (ssize_t)length : 0;
}

static int on_seek(void *cookie, off64_t *offset, int whence) {
  const hl_byte_stream *stream = cookie;
  int64_t place = stream->seek(stream->data, *offset, whence);
  if (place >= 0) *offset = place;
  return place >= 0 ? 0 : -1;
}

FILE *hl_byte_stream_open(hl_byte_stream *stream) {
  cookie_io_functions_t functions = {.write = on_write, .seek = on_seek};
  return fopencookie(stream, "wb", functions);
}

bool hl_byte_stream_finish(hl_byte_stream *stream, FILE *file) {
  (void)stream;
  return fflush(file) == 0 && !ferror(file);
}
