/* core/memory.c - checked allocation: counts what the context holds and keeps its limit. */
#include "core/memory.h"

#include <string.h>

#include "core/context.h"

/* Each block starts with its size; 64 bytes keep the payload aligned for vectors. */
typedef struct block_header {
  size_t size; /* payload bytes */
} block_header;

enum { HEADER_BYTES = 64 };

bool hl_multiply(size_t a, size_t b, size_t *product) { return !__builtin_mul_overflow(a, b, product); }

static bool reserve(hl_context *context, size_t bytes) {
  uint64_t held = atomic_fetch_add(&context->held, bytes) + bytes;
  uint64_t limit = context->options.memory_limit;
  if (limit != 0 && held > limit) {
    atomic_fetch_sub(&context->held, bytes);
    return false;
  }
  uint64_t peak = atomic_load(&context->peak);
  while (held > peak && !atomic_compare_exchange_weak(&context->peak, &peak, held)) {}
  return true;
}

void *hl_allocate(hl_context *context, size_t count, size_t size) {
  size_t bytes;
  if (!hl_multiply(count, size, &bytes) || bytes > SIZE_MAX / 2) return NULL;
  if (!reserve(context, bytes)) return NULL;
  unsigned char *block = context->options.allocate(context->options.user_data, bytes + HEADER_BYTES, 64);
  if (block == NULL) {
    atomic_fetch_sub(&context->held, bytes);
    return NULL;
  }
  ((block_header *)block)->size = bytes;
  return block + HEADER_BYTES;
}

void *hl_allocate_zeroed(hl_context *context, size_t count, size_t size) {
  void *memory = hl_allocate(context, count, size);
  if (memory != NULL) memset(memory, 0, count * size);
  return memory;
}

static block_header *header_of(void *memory) {
  return (block_header *)((unsigned char *)memory - HEADER_BYTES);
}

void *hl_reallocate(hl_context *context, void *old, size_t count, size_t size) {
  void *fresh = hl_allocate(context, count, size);
  if (fresh == NULL || old == NULL) return fresh;
  size_t kept = header_of(old)->size < count * size ? header_of(old)->size : count * size;
  memcpy(fresh, old, kept);
  hl_release(context, old);
  return fresh;
}

void hl_release(hl_context *context, void *memory) {
  if (context == NULL || memory == NULL) return;
  block_header *header = header_of(memory);
  atomic_fetch_sub(&context->held, header->size);
  context->options.release(context->options.user_data, header);
}

char *hl_copy_text(hl_context *context, const char *text) {
  if (text == NULL) return NULL;
  size_t length = strlen(text) + 1;
  char *copy = hl_allocate(context, length, 1);
  if (copy != NULL) memcpy(copy, text, length);
  return copy;
}
