/* core/memory.c - implements checked allocation, which counts the context's bytes and enforces its memory
 * limit; and reserves, which keep blocks of memory from frame to frame. */
#include "core/memory.h"

#include <string.h>

#include "core/context.h"

/* Each block starts with a head of 64 bytes, which holds the block's size. The bytes of the block's user
 * after the head are thus aligned for vectors. */
typedef struct block_header {
  size_t size; /* number of bytes that the block's user asked for */
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
  if (!reserve(context->whole, bytes)) return NULL;
  unsigned char *block = context->options.allocate(context->options.user_data, bytes + HEADER_BYTES, 64);
  if (block == NULL) {
    atomic_fetch_sub(&context->whole->held, bytes);
    return NULL;
  }
  if (hl_is_confined(context)) atomic_fetch_add(&context->users, 1);
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
  atomic_fetch_sub(&context->whole->held, header->size);
  context->options.release(context->options.user_data, header);
  if (hl_is_confined(context)) hl_context_leave(context);
}

bool hl_layout_pass(hl_layout *layout, hl_context *context) {
  if (layout->passes == 1) layout->base = hl_allocate(context, layout->counted = layout->bytes, 1);
  if (layout->passes == 2 && layout->bytes != layout->counted) {
    hl_release(context, layout->base);
    layout->base = NULL;
  }
  if (layout->passes == 2 || (layout->passes == 1 && layout->base == NULL)) return false;
  layout->passes++;
  layout->bytes = 0;
  return true;
}

char *hl_copy_text(hl_context *context, const char *text) {
  if (text == NULL) return NULL;
  size_t length = strlen(text) + 1;
  char *copy = hl_allocate(context, length, 1);
  if (copy != NULL) memcpy(copy, text, length);
  return copy;
}

/* ---- blocks kept from frame to frame ---- */

/* The size in bytes from which a block is worth keeping. The allocator serves smaller blocks from pages
 * that the process has already. */
enum { LEAST_KEPT = 1 << 16 };

static bool fits(size_t bytes, size_t wanted) { return bytes >= wanted && bytes / 2 <= wanted; }

static void drop(reserve_block *block, hl_context *context) {
  hl_release(context, block->memory);
  *block = (reserve_block){0};
}

void *hl_reserve_take(hl_reserve *reserve, size_t count, size_t size) {
  size_t bytes;
  if (!reserve->keeps || reserve->taken == RESERVE_BLOCKS || !hl_multiply(count, size, &bytes) ||
      bytes < LEAST_KEPT)
    return hl_allocate(reserve->context, count, size);
  reserve_block *block = &reserve->block[reserve->taken];
  if (!fits(block->bytes, bytes)) {
    drop(block, reserve->context);
    block->memory = hl_allocate(reserve->context, count, size);
    if (block->memory == NULL) return NULL;
    block->bytes = bytes;
  }
  reserve->taken++;
  return block->memory;
}

void hl_reserve_return(hl_reserve *reserve, void *memory) {
  for (int i = 0; i < reserve->taken; i++)
    if (reserve->block[i].memory == memory) return;
  hl_release(reserve->context, memory);
}

void hl_reserve_drop_idle(hl_reserve *reserve) {
  for (int i = reserve->taken; i < RESERVE_BLOCKS; i++) drop(&reserve->block[i], reserve->context);
}

void hl_reserve_end_frame(hl_reserve *reserve) {
  hl_reserve_drop_idle(reserve);
  reserve->taken = 0;
}

void hl_reserve_release(hl_reserve *reserve) {
  reserve->taken = 0;
  hl_reserve_end_frame(reserve);
}
