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

/* The smallest idle block that fits; null: none. */
static reserve_block *find_idle(hl_reserve *reserve, size_t bytes) {
  reserve_block *best = NULL;
  for (int i = 0; i < RESERVE_BLOCKS; i++) {
    reserve_block *block = &reserve->block[i];
    if (block->memory == NULL || block->lent || !fits(block->bytes, bytes)) continue;
    if (best == NULL || block->bytes < best->bytes) best = block;
  }
  return best;
}

/* A place for a new block: the largest idle block that is too small makes room, as it is what grew. Null: all are lent. */
static reserve_block *make_place(hl_reserve *reserve, size_t bytes) {
  reserve_block *outgrown = NULL, *place = NULL;
  for (int i = 0; i < RESERVE_BLOCKS; i++) {
    reserve_block *block = &reserve->block[i];
    if (block->memory == NULL) place = block;
    else if (!block->lent && block->bytes < bytes && (outgrown == NULL || block->bytes > outgrown->bytes)) outgrown = block;
  }
  if (outgrown == NULL) return place;
  drop(outgrown, reserve->context);
  return outgrown;
}

void *hl_reserve_take(hl_reserve *reserve, size_t count, size_t size) {
  size_t bytes;
  if (!hl_multiply(count, size, &bytes) || bytes < LEAST_KEPT || !reserve->keeps)
    return hl_allocate(reserve->context, count, size);
  reserve_block *block = find_idle(reserve, bytes);
  if (block == NULL) {
    block = make_place(reserve, bytes);
    void *memory = hl_allocate(reserve->context, count, size);
    if (memory == NULL || block == NULL) return memory;
    *block = (reserve_block){.memory = memory, .bytes = bytes};
  }
  block->lent = block->wanted = true;
  return block->memory;
}

void hl_reserve_return(hl_reserve *reserve, void *memory) {
  for (int i = 0; i < RESERVE_BLOCKS && memory != NULL; i++) {
    if (reserve->block[i].memory != memory) continue;
    reserve->block[i].lent = false;
    return;
  }
  hl_release(reserve->context, memory);
}

void hl_reserve_trim(hl_reserve *reserve) {
  for (int i = 0; i < RESERVE_BLOCKS; i++) {
    reserve_block *block = &reserve->block[i];
    if (!block->lent && !block->wanted) drop(block, reserve->context);
    block->wanted = block->lent;
  }
}

void hl_reserve_release(hl_reserve *reserve) {
  for (int i = 0; i < RESERVE_BLOCKS; i++) drop(&reserve->block[i], reserve->context);
}
