/* core/memory.h - checked allocation through the context, and blocks that are kept from frame to frame. All
 * blocks are 64-byte aligned. */
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

/* ---- blocks kept from frame to frame ----
 *
 * A block that is given back to the system comes again as empty pages. Finding and clearing those took 4 to
 * 15 % of a frame. A reserve lends its blocks instead: every frame takes much the same blocks in the same
 * order, so that each request gets the block that it had in the frame before. */

enum { RESERVE_BLOCKS = 32 };

typedef struct reserve_block {
  void *memory; /* owned; null: none */
  size_t bytes;
} reserve_block;

typedef struct hl_reserve {
  hl_context *context;
  bool keeps;                          /* else what is taken anew is released when it is returned */
  int taken;                           /* blocks of this frame */
  reserve_block block[RESERVE_BLOCKS]; /* zero: none yet */
} hl_reserve;

/* count * size bytes, uninitialised, from the reserve or as hl_allocate() gives them; null where that
 * does. */
void *hl_reserve_take(hl_reserve *reserve, size_t count, size_t size);
/* Of hl_reserve_take() only; null is allowed. */
void hl_reserve_return(hl_reserve *reserve, void *memory);

/* Releases the blocks that this frame has not taken yet. */
void hl_reserve_drop_idle(hl_reserve *reserve);
/* A frame ends, all is returned: those that it did not take are released. */
void hl_reserve_end_frame(hl_reserve *reserve);
/* Releases all; nothing may be lent. */
void hl_reserve_release(hl_reserve *reserve);

#endif
