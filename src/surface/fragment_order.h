/* surface/fragment_order.h - sorts the fragments of a tile, and finds the fraction of the light reaching it
 * that each of them takes. */
#ifndef HL_SURFACE_FRAGMENT_ORDER_H
#define HL_SURFACE_FRAGMENT_ORDER_H

#include <stdbool.h>
#include <stddef.h>

#include "surface/fragment.h"
#include "view/view.h"

/* How the fragments of a view are ordered and composited. */
typedef struct fragment_order {
  const float *least; /* [mesh_count]; borrowed; least[m] is the least fraction of its opacity that mesh m
                       * takes of any colour of light */
  bool falling;       /* the view meets great heights first */
  bool slabs;         /* the view is a light's, and its buffer is also used for rays of other directions */
  bool apart;         /* no fragment hides another */
  double spacing;     /* distance of the sheets; frame units */
} fragment_order;

/* A fragment's place in the order of its pixel. Keys are sorted instead of fragments. */
typedef struct order_key {
  uint64_t key;   /* made of the height, then the primitive; the least key comes first */
  uint32_t index; /* index in the list */
} order_key;

/* A float's bits, changed so that they grow as the float does, or fall as it grows where `falling`. */
uint32_t hl_ordered_bits(float height, bool falling);

/* Sorts by rising keys; equal keys keep their order. spare: [count]. */
void hl_sort_keys(order_key *list, order_key *spare, size_t count);

/* Whether a fragment takes all light of its samples. */
static inline bool hl_is_opaque(const fragment *f, const float *least) {
  return f->opacity * least[f->mesh] >= 1;
}

/* Sorts by pixels, and within a pixel in the order in which the view meets the fragments. Unless order->slabs
 * or order->apart is set, leaves out fragments whose samples opaque fragments before them cover, also where
 * their surfaces come nearest. Returns the number of fragments that are left. keys: [2 count], memory for
 * this call. sorted: [count]. */
size_t hl_sort_by_pixel(const fragment *list, size_t count, const fragment_order *order, order_key *keys,
                        fragment *sorted);

/* Sorts fragments by slabs, and within a slab by pixels. They must be sorted by pixels, and within a pixel in
 * the order in which the view meets them. In a pixel of a slab, heights then rise; where order->falling is
 * set the view's order is reversed, so that of several fragments at one height, too, the fragment that the
 * view meets first comes last. places: [slabs + 2], memory for this call. slabs: the greatest number that a
 * slab may have. sorted: [count]. */
void hl_sort_by_slab(const fragment *list, size_t count, const fragment_order *order, uint32_t *places,
                     int slabs, fragment *sorted);

/* Finds the opacities of fragments, which are sorted by pixels. Keeps fragments that take any light, and
 * returns their number. */
size_t hl_resolve_fragments(fragment *list, size_t count, const fragment_order *order);

#endif
