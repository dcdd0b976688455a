/* volume/io/stream.c - functions that all streams share, which fill the buffer, read lines, and skip bytes.
 * The file stream.c also implements streams of files and of memory. */
#define _GNU_SOURCE
#include "volume/io/stream.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/context.h"
#include "core/file.h"
#include "core/memory.h"

typedef struct file_stream {
  hl_stream base;
  int descriptor; /* -1 until the file is open */
  bool regular;
  uint64_t size, position;     /* length in bytes of a regular file, and the current position in it */
  const unsigned char *memory; /* borrowed; [size]; the content if it is in memory, else null */
} file_stream;

hl_stream *hl_stream_make(hl_context *context, size_t size, hl_stream *below) {
  hl_stream *stream = hl_allocate_zeroed(context, 1, size);
  if (stream == NULL) return NULL;
  stream->context = context;
  stream->buffer = hl_allocate(context, HL_STREAM_BUFFER_BYTES, 1);
  if (stream->buffer == NULL) {
    hl_release(context, stream);
    return NULL;
  }
  stream->below = below;
  if (below != NULL) stream->path = below->path;
  return stream;
}

void hl_stream_close(hl_stream *stream) {
  while (stream != NULL) {
    hl_stream *below = stream->below;
    if (stream->close != NULL) stream->close(stream);
    hl_release(stream->context, stream->buffer);
    hl_release(stream->context, stream);
    stream = below;
  }
}

static hl_status file_pull(hl_stream *stream, unsigned char *bytes, size_t capacity, size_t *count,
                           hl_error *error) {
  file_stream *file = (file_stream *)stream;
  hl_status status = hl_file_pull(stream->context, file->descriptor, stream->path, bytes, capacity, count,
                                  error);
  file->position += *count;
  return status;
}

static hl_status memory_pull(hl_stream *stream, unsigned char *bytes, size_t capacity, size_t *count,
                             hl_error *error) {
  (void)error;
  file_stream *file = (file_stream *)stream;
  uint64_t left = file->size - file->position;
  *count = left < capacity ? (size_t)left : capacity;
  memcpy(bytes, file->memory + file->position, *count);
  file->position += *count;
  return HL_OK;
}

static uint64_t file_at_most(const hl_stream *stream) {
  const file_stream *file = (const file_stream *)stream;
  if (!file->regular) return UINT64_MAX;
  return file->position < file->size ? file->size - file->position : 0;
}

static void file_close(hl_stream *stream) {
  file_stream *file = (file_stream *)stream;
  if (file->descriptor >= 0) close(file->descriptor);
  hl_release(stream->context, stream->path);
}

static hl_status file_begin(file_stream *file, const char *path, bool regular_only, hl_error *error) {
  struct stat information;
  file->base.path = hl_copy_text(file->base.context, path);
  if (file->base.path == NULL) return hl_fail_memory(error, strlen(path), path);
  hl_status status = hl_file_open(file->base.context, path, &file->descriptor, error);
  if (status != HL_OK) return status;
  if (fstat(file->descriptor, &information) != 0)
    return hl_fail(error, HL_ERROR_IO, "%s: cannot open: %s", path, strerror(errno));
  file->regular = S_ISREG(information.st_mode);
  file->size = file->regular && information.st_size > 0 ? (uint64_t)information.st_size : 0;
  if (S_ISDIR(information.st_mode))
    return hl_fail(error, HL_ERROR_IO, "%s: is a folder, expected a volume file", path);
  if (regular_only && !file->regular) return hl_fail(error, HL_ERROR_IO, "%s: is not a regular file", path);
  return HL_OK;
}

hl_status hl_stream_open(hl_context *context, const char *path, bool regular_only, hl_stream **stream,
                         hl_error *error) {
  *stream = NULL;
  file_stream *file = (file_stream *)hl_stream_make(context, sizeof *file, NULL);
  if (file == NULL) return hl_fail_memory(error, HL_STREAM_BUFFER_BYTES, path);
  file->descriptor = -1;
  file->base.pull = file_pull;
  file->base.at_most = file_at_most;
  file->base.close = file_close;
  hl_status status = file_begin(file, path, regular_only, error);
  if (status == HL_OK) *stream = &file->base;
  else hl_stream_close(&file->base);
  return status;
}

hl_status hl_stream_open_memory(hl_context *context, const char *path, const void *bytes, size_t byte_count,
                                hl_stream **stream, hl_error *error) {
  *stream = NULL;
  file_stream *file = (file_stream *)hl_stream_make(context, sizeof *file, NULL);
  if (file == NULL) return hl_fail_memory(error, HL_STREAM_BUFFER_BYTES, path);
  file->descriptor = -1;
  file->base.pull = memory_pull;
  file->base.at_most = file_at_most;
  file->base.close = file_close;
  file->regular = true;
  file->memory = bytes;
  file->size = byte_count;
  file->base.path = hl_copy_text(context, path);
  if (file->base.path == NULL) {
    hl_stream_close(&file->base);
    return hl_fail_memory(error, strlen(path), path);
  }
  *stream = &file->base;
  return HL_OK;
}

hl_status hl_stream_switch(hl_stream **stream, const char *name, hl_error *error) {
  hl_context *context = (*stream)->context;
  char *folder = hl_path_folder(context, (*stream)->path);
  char *path = folder == NULL ? NULL : hl_path_join(context, folder, name);
  hl_release(context, folder);
  if (path == NULL) return hl_fail_memory(error, strlen(name), name);
  hl_stream *opened;
  hl_error inner = {0};
  hl_status status = hl_stream_open(context, path, true, &opened, &inner);
  hl_release(context, path);
  if (status != HL_OK) return hl_fail(error, status, "%s: its data file %s", (*stream)->path, inner.message);
  hl_stream_close(*stream);
  *stream = opened;
  return HL_OK;
}

static const file_stream *file_of(const hl_stream *stream) {
  while (stream->below != NULL) stream = stream->below;
  return (const file_stream *)stream;
}

bool hl_stream_can_restart(const hl_stream *stream) { return file_of(stream)->regular; }

bool hl_stream_is_plain_file(const hl_stream *stream) {
  return stream->below == NULL && file_of(stream)->regular && file_of(stream)->memory == NULL;
}

int hl_stream_descriptor(const hl_stream *stream) { return file_of(stream)->descriptor; }

bool hl_stream_memory(const hl_stream *stream, const unsigned char **bytes, size_t *length) {
  const file_stream *file = file_of(stream);
  if (stream->below != NULL || file->memory == NULL) return false;
  *bytes = file->memory;
  *length = (size_t)file->size;
  return true;
}

hl_status hl_stream_restart(hl_stream **stream, hl_error *error) {
  const file_stream *file = file_of(*stream);
  hl_stream *opened;
  hl_status status = file->memory != NULL
                         ? hl_stream_open_memory((*stream)->context, (*stream)->path, file->memory,
                                                 file->size, &opened, error)
                         : hl_stream_open((*stream)->context, (*stream)->path, true, &opened, error);
  if (status != HL_OK) return status;
  hl_stream_close(*stream);
  *stream = opened;
  return HL_OK;
}

static hl_status pull(hl_stream *stream, unsigned char *bytes, size_t capacity, size_t *count,
                      hl_error *error) {
  *count = 0;
  if (stream->ended) return HL_OK;
  hl_status status = stream->pull(stream, bytes, capacity, count, error);
  if (status != HL_OK || *count == 0) stream->ended = true;
  return status;
}

hl_status hl_stream_peek(hl_stream *stream, size_t wanted, const unsigned char **bytes, size_t *available,
                         hl_error *error) {
  if (stream->end - stream->begin < wanted && stream->begin > 0) {
    memmove(stream->buffer, stream->buffer + stream->begin, stream->end - stream->begin);
    stream->end -= stream->begin;
    stream->begin = 0;
  }
  hl_status status = HL_OK;
  while (status == HL_OK && stream->end - stream->begin < wanted && !stream->ended) {
    size_t count;
    status = pull(stream, stream->buffer + stream->end, HL_STREAM_BUFFER_BYTES - stream->end, &count, error);
    stream->end += count;
  }
  *bytes = stream->buffer + stream->begin;
  *available = stream->end - stream->begin;
  return status;
}

void hl_stream_take(hl_stream *stream, size_t count) {
  stream->begin += count;
  stream->offset += count;
}

hl_status hl_stream_read(hl_stream *stream, void *bytes, size_t wanted, size_t *count, hl_error *error) {
  unsigned char *destination = bytes;
  *count = 0;
  hl_status status = HL_OK;
  while (status == HL_OK && *count < wanted) {
    size_t left = wanted - *count, got;
    if (stream->begin == stream->end &&
        left >= HL_STREAM_BUFFER_BYTES) { /* large amounts are read without the buffer */
      status = pull(stream, destination + *count, left, &got, error);
      stream->offset += got;
    } else {
      const unsigned char *buffered;
      status = hl_stream_peek(stream, 1, &buffered, &got, error);
      if (got > left) got = left;
      if (got > 0) memcpy(destination + *count, buffered, got);
      hl_stream_take(stream, got);
    }
    if (got == 0) break;
    *count += got;
  }
  return status;
}

hl_status hl_stream_read_all(hl_stream *stream, void *bytes, size_t wanted, hl_error *error) {
  size_t count;
  hl_status status = hl_stream_read(stream, bytes, wanted, &count, error);
  if (status == HL_OK && count < wanted)
    status = hl_fail_offset(error, HL_ERROR_INPUT, (int64_t)stream->offset,
                            "%s, byte %llu: the file ends here, in the middle of its header", stream->path,
                            (unsigned long long)stream->offset);
  return status;
}

/* Skips bytes of a plain file or of memory without reading them. A small number of bytes is not skipped by
 * seeking, because seeking would save no time. Returns the number of bytes that were skipped. */
static uint64_t seek_over(hl_stream *stream, uint64_t count) {
  if (stream->below != NULL || !file_of(stream)->regular) return 0;
  file_stream *file = (file_stream *)stream;
  uint64_t buffered = stream->end - stream->begin, left = file_at_most(stream);
  if (count <= buffered + HL_STREAM_BUFFER_BYTES || count - buffered > left) return 0;
  if (file->memory == NULL && lseek(file->descriptor, (off_t)(count - buffered), SEEK_CUR) < 0) return 0;
  file->position += count - buffered;
  stream->offset += count;
  stream->begin = stream->end = 0;
  return count;
}

hl_status hl_stream_skip(hl_stream *stream, uint64_t count, hl_error *error) {
  count -= seek_over(stream, count);
  while (count > 0) {
    const unsigned char *bytes;
    size_t available;
    hl_status status = hl_stream_peek(stream, 1, &bytes, &available, error);
    if (status != HL_OK) return status;
    if (available == 0)
      return hl_fail_offset(error, HL_ERROR_INPUT, (int64_t)stream->offset,
                            "%s: the file ends at byte %llu, %llu bytes before its voxels begin",
                            stream->path, (unsigned long long)stream->offset, (unsigned long long)count);
    size_t step = available < count ? available : (size_t)count;
    hl_stream_take(stream, step);
    count -= step;
  }
  return HL_OK;
}

/* Finds out, from the first line, how lines of the stream end. Lines end with CR only if no LF follows the
 * first CR. */
static void learn_line_end(hl_stream *stream, const unsigned char *bytes, size_t length, size_t available) {
  if (stream->line_end_known) return;
  const unsigned char *carriage_return = memchr(bytes, '\r', length);
  if (carriage_return != NULL) {
    size_t next = (size_t)(carriage_return - bytes) + 1;
    stream->line_end_is_return = next >= available || bytes[next] != '\n';
  }
  stream->line_end_known = true;
}

hl_status hl_stream_line(hl_stream *stream, char line[HL_LINE_BYTES], bool *ended, hl_error *error) {
  const unsigned char *bytes;
  size_t available;
  line[0] = 0;
  hl_status status = hl_stream_peek(stream, HL_LINE_BYTES, &bytes, &available, error);
  *ended = status != HL_OK || available == 0;
  if (*ended) return status;
  size_t searched = available < HL_LINE_BYTES ? available : HL_LINE_BYTES;
  const unsigned char *feed = memchr(bytes, '\n', searched);
  learn_line_end(stream, bytes, feed == NULL ? searched : (size_t)(feed - bytes), available);
  const unsigned char *end = stream->line_end_is_return ? memchr(bytes, '\r', searched) : feed;
  size_t length = end == NULL ? searched : (size_t)(end - bytes);
  if (end == NULL && available >= HL_LINE_BYTES)
    return hl_fail_offset(error, HL_ERROR_INPUT, (int64_t)stream->offset,
                          "%s, byte %llu: a header line of more than %d bytes; is this header text at all?",
                          stream->path, (unsigned long long)stream->offset, HL_LINE_BYTES - 1);
  size_t kept = length > 0 && !stream->line_end_is_return && bytes[length - 1] == '\r' ? length - 1 : length;
  memcpy(line, bytes, kept);
  line[kept] = 0;
  hl_stream_take(stream, end == NULL ? length : length + 1);
  return HL_OK;
}

uint64_t hl_stream_at_most(const hl_stream *stream) {
  uint64_t buffered = stream->end - stream->begin, more = stream->ended ? 0 : stream->at_most(stream);
  return more > UINT64_MAX - buffered ? UINT64_MAX : buffered + more;
}

hl_status hl_stream_read_rest(hl_stream *stream, unsigned char **bytes, size_t *length, hl_error *error) {
  size_t capacity = 0, got = 1;
  hl_status status = HL_OK;
  for (*length = 0; status == HL_OK && got > 0; *length += got) {
    if (*length == capacity) {
      size_t wanted = capacity == 0 ? (size_t)HL_STREAM_BUFFER_BYTES : 2 * capacity;
      unsigned char *larger = hl_reallocate(stream->context, *bytes, wanted, 1);
      if (larger == NULL) return hl_fail_memory(error, wanted, stream->path);
      *bytes = larger;
      capacity = wanted;
    }
    got = 0;
    status = hl_stream_read(stream, *bytes + *length, capacity - *length, &got, error);
    if (status == HL_OK && hl_cancelled(stream->context))
      return hl_fail(error, HL_ERROR_CANCELLED, "%s: cancelled", stream->path);
  }
  if (status == HL_OK && stream->cut_short)
    return hl_fail(error, HL_ERROR_INPUT, "%s: the compressed data are cut short", stream->path);
  return status;
}
