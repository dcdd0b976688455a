/* core/layout.h - plans memory once: one description both counts the bytes and assigns them.
 *
 * A description is a function that takes each of its arrays from a layout. The first run, with a layout of
 * zeros, counts bytes and gets null pointers. The second run, with `base` set to a block of the counted size,
 * gets the arrays. */
#ifndef HL_CORE_LAYOUT_H
#define HL_CORE_LAYOUT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "core/memory.h"

typedef struct hl_layout {
  unsigned char *base; /* aligned to 64 bytes; null: counts only */
  size_t bytes;        /* bytes taken so far; SIZE_MAX: overflow */
} hl_layout;

/* Takes count * size bytes, aligned to 64; returns null while counting. */
static inline void *hl_layout_take(hl_layout *layout, size_t count, size_t size) {
  size_t bytes;
  if (!hl_multiply(count, size, &bytes) || bytes > SIZE_MAX - 63 - layout->bytes) {
    layout->bytes = SIZE_MAX; /* allocating SIZE_MAX bytes always fails */
    return NULL;
  }
  void *taken = layout->base == NULL ? NULL : layout->base + layout->bytes;
  layout->bytes += (bytes + 63) / 64 * 64;
  return taken;
}

#endif
