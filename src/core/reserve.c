/* core/reserve.c - see reserve.h. */
#include "core/reserve.h"

#include "core/memory.h"

/* Smaller blocks come from pages that the process has. */
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
