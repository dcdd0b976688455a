/* surface/fragment_order.h - sorts the fragments of a tile, and finds the fraction that each fragment takes
 * of the light that reaches it. */
#ifndef HL_SURFACE_FRAGMENT_ORDER_H
#define HL_SURFACE_FRAGMENT_ORDER_H

#include <stdbool.h>
#include <stddef.h>

#include "surface/fragment.h"
#include "view/view.h"

/* How the fragments of a view are ordered and composited. */
typedef struct fragment_order {
  const float *least; /* [mesh_count]; borrowed; for each mesh, the least of the fractions of its opacity
                       * that it takes of red, green and blue light */
  bool falling;       /* the view meets great heights first */
  bool slabs;         /* the view is a light's, and its buffer is also used for rays of other directions */
  bool apart;         /* no fragment hides another */
  double spacing;     /* distance of the sheets; frame units */
} fragment_order;

/* A fragment's place in the order of its pixel. Keys are sorted instead of fragments. */
typedef struct order_key {
  uint64_t key;   /* a number made of the height and then the primitive; the fragment with the least key
                   * comes first */
  uint32_t index; /* index in the list */
} order_key;

/* A float's bits, changed so that as whole numbers they have the order of the floats, or the reverse order
 * where `falling` is set. */
uint32_t hl_ordered_bits(float height, bool falling);

/* Sorts keys so that they rise; equal keys keep their order. spare: [count]. */
void hl_sort_keys(order_key *list, order_key *spare, size_t count);

/* Whether a fragment takes all light of its samples. */
static inline bool hl_is_opaque(const fragment *f, const float *least) {
  return f->opacity * least[f->mesh] >= 1;
}

/* Sorts fragments by pixels, and within a pixel in the order in which the view meets the fragments. Unless
 * order->slabs or order->apart is set, leaves out fragments all of whose samples are covered by opaque
 * fragments before them, even where the surfaces come nearest to the view. Returns the number of fragments
 * that are left. keys: [2 count], memory for this call. sorted: [count]. */
size_t hl_sort_by_pixel(const fragment *list, size_t count, const fragment_order *order, order_key *keys,
                        fragment *sorted);

/* Sorts fragments by slabs, and within a slab by pixels. They must be sorted by pixels, and within a pixel
 * in the order in which the view meets them. In a pixel of a slab, heights then rise; where order->falling
 * is set, the view's order is reversed. The fragment that the view meets first then comes last, also among
 * fragments of one height. places: [slabs + 2], memory for this call. slabs: the greatest number of a slab.
 * sorted: [count]. */
void hl_sort_by_slab(const fragment *list, size_t count, const fragment_order *order, uint32_t *places,
                     int slabs, fragment *sorted);

/* Finds the opacities of fragments, which are sorted by pixels. Keeps fragments that take any light, and
 * returns their number. */
size_t hl_resolve_fragments(fragment *list, size_t count, const fragment_order *order);

#endif
