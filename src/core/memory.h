/* core/memory.h - checked allocation through the context. All blocks are 64-byte aligned. */
#ifndef HL_CORE_MEMORY_H
#define HL_CORE_MEMORY_H

#include <stdbool.h>

#include "core/error.h"

/* count * size bytes, uninitialised; null on overflow, at the limit, or when the allocator has no
 * more. A request for 0 bytes gives a valid block. */
void *hl_allocate(hl_context *context, size_t count, size_t size);

/* The same, all zero bytes. */
void *hl_allocate_zeroed(hl_context *context, size_t count, size_t size);

/* Moves a block to a new size, keeping what fits; null leaves the old block as it was. old may be null. */
void *hl_reallocate(hl_context *context, void *old, size_t count, size_t size);

void hl_release(hl_context *context, void *memory); /* null is allowed for either: nothing is done */

/* A copy of a null-terminated text; null for null, or when there is no memory. */
char *hl_copy_text(hl_context *context, const char *text);

/* *product = a * b; false on overflow. */
bool hl_multiply(size_t a, size_t b, size_t *product);

#endif
