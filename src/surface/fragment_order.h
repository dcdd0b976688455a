/* surface/fragment_order.h - sorts the fragments of a tile, and finds for each fragment the fraction that it
 * absorbs of the light that reaches it. */
#ifndef HL_SURFACE_FRAGMENT_ORDER_H
#define HL_SURFACE_FRAGMENT_ORDER_H

#include <stdbool.h>
#include <stddef.h>

#include "surface/fragment.h"
#include "view/view.h"

/* The settings by which the fragments of a view are ordered and composited. */
typedef struct fragment_order {
  const float *least; /* [mesh_count]; borrowed; a mesh's opacity has one factor each for red, green and blue
                       * light. This is the least of the three factors */
  bool falling;       /* whether the view meets greater heights first */
  bool slabs;         /* whether the view is a light's, and its buffer also serves rays in other directions
                       * than the view's own rays */
  bool apart;         /* whether fragments are composited as if no fragment hid another */
  double spacing;     /* distance of the sheets; frame units */
} fragment_order;

/* The key of a fragment for sorting a pixel's fragments. Keys are sorted in place of fragments. */
typedef struct order_key {
  uint64_t key;   /* The fragment with the least key comes first. The upper half of the key is made from the
                   * fragment's height, the lower half is the number of its primitive */
  uint32_t index; /* index in the list */
} order_key;

/* Turns a float into a whole number. These whole numbers have the same order as the floats, or the reverse
 * order if `falling` is set. */
uint32_t hl_ordered_bits(float height, bool falling);

/* Sorts keys in rising order; equal keys keep their order. spare: [count]. */
void hl_sort_keys(order_key *list, order_key *spare, size_t count);

/* Returns whether a fragment absorbs all light that arrives at its samples. */
static inline bool hl_is_opaque(const fragment *f, const float *least) {
  return f->opacity * least[f->mesh] >= 1;
}

/* Sorts fragments by pixels, and within a pixel in the order in which the view meets the fragments. Leaves
 * out each fragment whose samples are all covered by opaque fragments before it, even if its surface comes as
 * near to the view as the reaches allow. Leaves out no fragment if order->slabs or order->apart is set.
 * Returns the number of fragments that are left. keys: [2 count], memory for this call. sorted: [count]. */
size_t hl_sort_by_pixel(const fragment *list, size_t count, const fragment_order *order, order_key *keys,
                        fragment *sorted);

/* Sorts fragments by slabs, within a slab by pixels, and within a pixel of a slab by rising heights. list:
 * must be sorted by pixels, and within a pixel in the order in which the view meets the fragments. If
 * order->falling is set, the order of fragments is reversed within each pixel of a slab: the fragment that
 * the view meets first comes last, even among fragments of the same height. places: [slabs + 2], memory for
 * this call. slabs: the greatest number of a slab. sorted: [count]. */
void hl_sort_by_slab(const fragment *list, size_t count, const fragment_order *order, uint32_t *places,
                     int slabs, fragment *sorted);

/* Finds the opacities of fragments, which must be sorted by pixels. Keeps only fragments that absorb any
 * light, and returns their number. */
size_t hl_resolve_fragments(fragment *list, size_t count, const fragment_order *order);

#endif
