/* core/layout.h - memory that is described once: the same description counts the bytes and hands them out.
 *
 * A description is a function that takes each of its arrays from a layout. Run with a layout of zeros it
 * counts: pointers are null. Run again with base set to a block of the counted bytes it sets them. */
#ifndef HL_CORE_LAYOUT_H
#define HL_CORE_LAYOUT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "core/memory.h"

typedef struct hl_layout {
  unsigned char *base; /* aligned to 64 bytes; null: counts only */
  size_t bytes;        /* taken so far; SIZE_MAX: more than there can be */
} hl_layout;

/* count * size bytes, aligned to 64; null while counting. */
static inline void *hl_layout_take(hl_layout *layout, size_t count, size_t size) {
  size_t bytes;
  if (!hl_multiply(count, size, &bytes) || bytes > SIZE_MAX - 63 - layout->bytes) {
    layout->bytes = SIZE_MAX; /* an allocation of so much fails */
    return NULL;
  }
  void *taken = layout->base == NULL ? NULL : layout->base + layout->bytes;
  layout->bytes += (bytes + 63) / 64 * 64;
  return taken;
}

#endif
