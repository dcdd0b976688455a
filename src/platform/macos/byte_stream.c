/* platform/macos/byte_stream.c - see platform/byte_stream.h. */
#include "platform/byte_stream.h"

static int on_write(void *cookie, const char *bytes, int length) {
  const hl_byte_stream *stream = cookie;
  return stream->write(stream->data, bytes, (size_t)length) ? length : -1;
}

static fpos_t on_seek(void *cookie, fpos_t offset, int whence) {
  const hl_byte_stream *stream = cookie;
  return stream->seek(stream->data, offset, whence);
}

FILE *hl_byte_stream_open(hl_byte_stream *stream) { return funopen(stream, NULL, on_write, on_seek, NULL); }

bool hl_byte_stream_finish(hl_byte_stream *stream, FILE *file) {
  (void)stream;
  return fflush(file) == 0 && !ferror(file);
}
