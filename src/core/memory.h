/* core/memory.h - declares checked allocation through the context, and blocks that are kept from frame to
 * frame. All blocks are 64-byte aligned. */
#ifndef HL_CORE_MEMORY_H
#define HL_CORE_MEMORY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "core/error.h"

/* Allocates count * size uninitialised bytes. Returns null on overflow, at the context's memory limit, or if
 * the allocator fails. A request for 0 bytes gives a valid block. */
void *hl_allocate(hl_context *context, size_t count, size_t size);

/* Allocates like hl_allocate(), with all bytes zero. */
void *hl_allocate_zeroed(hl_context *context, size_t count, size_t size);

/* Moves a block's content to a block of another size. The content is cut if the new block is smaller. On
 * failure the function returns null and does not change the old block. old: may be null. */
void *hl_reallocate(hl_context *context, void *old, size_t count, size_t size);

/* releases a block; does nothing if either pointer is null */
void hl_release(hl_context *context, void *memory);

/* A copy of a null-terminated text; null if the text is null or memory is short. */
char *hl_copy_text(hl_context *context, const char *text);

/* Sets *product to a * b. Returns false on overflow. */
bool hl_multiply(size_t a, size_t b, size_t *product);

/* ---- blocks kept from frame to frame ----
 *
 * When a block returns to the system and is allocated again, the system has to find and clear new pages: 4 to
 * 15 % of a frame's time. Therefore a reserve keeps the blocks, and lends them to each frame. Every frame
 * requests nearly the same blocks in the same order, so that each request gets the same block as in the frame
 * before. */

enum { RESERVE_BLOCKS = 32 };

typedef struct reserve_block {
  void *memory; /* owned; memory of the block; null if the entry has no block */
  size_t bytes;
} reserve_block;

typedef struct hl_reserve {
  hl_context *context;
  /* whether blocks are kept; if false, every block is allocated when it is taken, and released when it is
   * returned */
  bool keeps;
  int taken;                           /* number of blocks that were requested in this frame so far */
  reserve_block block[RESERVE_BLOCKS]; /* block[n] is the n-th block that each frame takes; an entry of 0
                                        * bytes has no block */
} hl_reserve;

/* Takes a block of count * size uninitialised bytes from the reserve, or else from hl_allocate(). The result
 * is null if the reserve has no such block and hl_allocate() fails. */
void *hl_reserve_take(hl_reserve *reserve, size_t count, size_t size);
/* Returns a block that hl_reserve_take() gave. The block may be null. */
void hl_reserve_return(hl_reserve *reserve, void *memory);

/* Releases the blocks of a reserve that the current frame has not taken yet. */
void hl_reserve_drop_idle(hl_reserve *reserve);
/* Ends a frame, and releases the blocks that this frame did not take. All blocks must have been returned
 * before. */
void hl_reserve_end_frame(hl_reserve *reserve);
/* Releases all blocks of a reserve. All blocks must have been returned before. */
void hl_reserve_release(hl_reserve *reserve);

/* ---- Memory that is planned once ----
 *
 * The function that lays out an object takes each of the object's arrays from a layout. With a layout of
 * zeros, the function counts bytes and gets null pointers; with `base` set to a block of the counted size, it
 * gets the arrays. An estimate of the size runs the same function, and only counts.
 *
 *     hl_layout layout = {0};
 *     while (hl_layout_pass(&layout, context)) lay_out(thing, &layout);
 *     if (layout.base == NULL) return hl_fail_memory(error, layout.bytes, "the thing");
 *     thing->memory = layout.base;
 *
 * An estimate takes the arrays of many objects from one layout. Arrays that are released before further
 * arrays are allocated are given back (hl_layout_give_back), so that `most` is the peak. */

typedef struct hl_layout {
  unsigned char *base; /* the block from which arrays are taken, aligned to 64 bytes; if null, bytes are only
                        * counted */
  size_t bytes;        /* number of bytes that are taken at present; SIZE_MAX after an overflow */
  size_t most;         /* the greatest number of bytes that were taken at one time */
  /* the number of bytes that the first pass counted, which is the block's size; only hl_layout_pass() uses
   * it */
  size_t counted;
  int passes; /* number of passes that hl_layout_pass() has begun */
} hl_layout;

/* Begins the next pass over a layout. The first pass counts bytes, and the second pass takes arrays from a
 * block of the counted size. Returns true before each of the two passes, and false after them. After the
 * passes, `base` is null if the block could not be allocated. `base` is also null if the second pass took a
 * different number of bytes than the first pass, because arrays might then lie beyond the block. The caller
 * owns the block. */
bool hl_layout_pass(hl_layout *layout, hl_context *context);

/* Takes count * size bytes from a layout, aligned to 64 bytes. Returns null while bytes are only counted. */
static inline void *hl_layout_take(hl_layout *layout, size_t count, size_t size) {
  size_t bytes;
  if (!hl_multiply(count, size, &bytes) || bytes > SIZE_MAX / 2 || layout->bytes > SIZE_MAX / 2) {
    /* SIZE_MAX marks an overflow; allocating SIZE_MAX bytes always fails */
    layout->bytes = layout->most = SIZE_MAX;
    return NULL;
  }
  void *taken = layout->base == NULL ? NULL : layout->base + layout->bytes;
  layout->bytes += (bytes + 63) / 64 * 64;
  if (layout->bytes > layout->most) layout->most = layout->bytes;
  return taken;
}

/* Gives back, in a pass that counts, all bytes that were taken since layout->bytes had the value `bytes`. */
static inline void hl_layout_give_back(hl_layout *layout, size_t bytes) {
  if (layout->bytes != SIZE_MAX) layout->bytes = bytes;
}

#endif
