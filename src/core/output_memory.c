/* core/output_memory.c - an output that grows in memory, for encoders that write to a FILE.
 *
 * In: what an encoder writes, in any order of places. Out: the bytes, counted by the context.
 */
#define _GNU_SOURCE
#include "core/output_memory.h"

#include <errno.h>
#include <string.h>

#include "core/memory.h"

/* Makes room for `end` bytes; what was not written before is zero. */
static bool reserve(hl_output_memory *memory, size_t end) {
  if (end <= memory->capacity) return true;
  size_t capacity = memory->capacity > 0 ? memory->capacity : 65536;
  while (capacity < end)
    if (!hl_multiply(capacity, 2, &capacity)) return false;
  unsigned char *larger = hl_reallocate(memory->output.context, memory->bytes, capacity, 1);
  if (larger == NULL) return false;
  memset(larger + memory->capacity, 0, capacity - memory->capacity);
  memory->bytes = larger;
  memory->capacity = capacity;
  return true;
}

static ssize_t on_write(void *cookie, const char *bytes, size_t length) {
  hl_output_memory *memory = cookie;
  if (memory->place > SIZE_MAX - length || !reserve(memory, memory->place + length)) {
    memory->full = true;
    errno = ENOMEM;
    return 0;
  }
  memcpy(memory->bytes + memory->place, bytes, length);
  memory->place += length;
  if (memory->place > memory->length) memory->length = memory->place;
  return (ssize_t)length;
}

static int on_seek(void *cookie, off64_t *offset, int whence) {
  hl_output_memory *memory = cookie;
  off64_t from = whence == SEEK_SET ? 0 : (off64_t)(whence == SEEK_CUR ? memory->place : memory->length);
  if (from + *offset < 0) return -1;
  memory->place = (size_t)(from + *offset);
  *offset = from + *offset;
  return 0;
}

hl_status hl_output_memory_begin(hl_context *context, const char *name, hl_output_memory *memory,
                                 hl_error *error) {
  memset(memory, 0, sizeof *memory);
  memory->output.context = context;
  memory->output.path = hl_copy_text(context, name);
  cookie_io_functions_t functions = {.write = on_write, .seek = on_seek};
  if (memory->output.path != NULL) memory->output.file = fopencookie(memory, "wb", functions);
  if (memory->output.file != NULL) return HL_OK;
  hl_output_memory_abort(memory);
  return hl_fail_memory(error, 65536, name);
}

hl_status hl_output_memory_commit(hl_output_memory *memory, unsigned char **bytes, size_t *length,
                                  hl_error *error) {
  bool failed = fflush(memory->output.file) != 0 || ferror(memory->output.file);
  if (failed) {
    hl_fail_memory(error, memory->capacity > 0 ? memory->capacity : 65536, memory->output.path);
    hl_output_memory_abort(memory);
    return HL_ERROR_MEMORY;
  }
  *bytes = memory->bytes;
  *length = memory->length;
  memory->bytes = NULL;
  hl_output_memory_abort(memory);
  return HL_OK;
}

void hl_output_memory_abort(hl_output_memory *memory) {
  hl_context *context = memory->output.context;
  hl_output_abort(&memory->output);
  hl_release(context, memory->bytes);
  memory->bytes = NULL;
}
