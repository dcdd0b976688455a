/* platform/windows/byte_stream.c - opens streams whose bytes go to functions of the caller. Windows' C
 * library can only make streams of files. Therefore the bytes are written to a file without a name, and are
 * given to the functions when the stream is finished. */
#include "platform/byte_stream.h"

FILE *hl_byte_stream_open(hl_byte_stream *stream) {
  (void)stream;
  return tmpfile();
}

bool hl_byte_stream_finish(hl_byte_stream *stream, FILE *file) {
  char bytes[1 << 16];
  bool good = fflush(file) == 0 && !ferror(file);
  rewind(file);
  for (size_t got; good && (got = fread(bytes, 1, sizeof bytes, file)) > 0;)
    good = stream->write(stream->data, bytes, got);
  return good && !ferror(file);
}
