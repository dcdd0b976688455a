/* core/output_memory.h - an output that grows in memory, for encoders that write to a FILE. */
#ifndef HL_CORE_OUTPUT_MEMORY_H
#define HL_CORE_OUTPUT_MEMORY_H

#include <stdbool.h>

#include "core/file.h"

typedef struct hl_output_memory {
  hl_output output;     /* its path is a name for messages, its file is this memory */
  unsigned char *bytes; /* owned; [capacity], of which length are written */
  size_t length, capacity, place;
  bool full; /* the context had no more memory */
} hl_output_memory;

/* memory must not move until it is committed or aborted. */
hl_status hl_output_memory_begin(hl_context *context, const char *name, hl_output_memory *memory,
                                 hl_error *error);
/* *bytes: owned by the caller (hl_release); untouched on failure. */
hl_status hl_output_memory_commit(hl_output_memory *memory, unsigned char **bytes, size_t *length,
                                  hl_error *error);
/* Releases everything; harmless after a commit. */
void hl_output_memory_abort(hl_output_memory *memory);

#endif
