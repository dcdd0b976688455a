/* core/reserve.h - large blocks kept from frame to frame.
 *
 * A block that is given back to the system comes again as empty pages, and finding and clearing those took 4
 * to 15 % of a frame. Blocks are lent instead: frames take much the same blocks in the same order, so that
 * each gets the one it had before. */
#ifndef HL_CORE_RESERVE_H
#define HL_CORE_RESERVE_H

#include <stdbool.h>

#include "core/error.h"

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
