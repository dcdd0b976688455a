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
  const float *least; /* [mesh_count]; borrowed; for each mesh, the least of three factors on its opacity:
                       * those for red, green and blue light */
  bool falling;       /* the view meets great heights first */
  bool slabs;         /* the view is a light's, and its buffer also serves rays of other directions than the
                       * view's rays */
  bool apart;         /* no fragment hides another */
  double spacing;     /* distance of the sheets; frame units */
} fragment_order;

/* A fragment's place in the order of its pixel. Keys are sorted instead of fragments. */
typedef struct order_key {
  uint64_t key;   /* a number whose upper half is made from the height and whose lower half is the primitive;
                   * the fragment with the least key comes first */
  uint32_t index; /* index in the list */
} order_key;

/* A whole number made from a float's bits. Such numbers have the same order as the floats, or the reverse
 * order where `falling` is set. */
uint32_t hl_ordered_bits(float height, bool falling);

/* Sorts keys so that they rise; equal keys keep their order. spare: [count]. */
void hl_sort_keys(order_key *list, order_key *spare, size_t count);

/* Whether a fragment takes all light of its samples. */
static inline bool hl_is_opaque(const fragment *f, const float *least) {
  return f->opacity * least[f->mesh] >= 1;
}

/* Sorts fragments by pixels, and within a pixel in the order in which the view meets the fragments. Leaves
 * out each fragment that opaque fragments before it cover in all samples, even if surfaces come as near to
 * the view as their reaches allow. Leaves out none if order->slabs or order->apart is set. Returns the number
 * of fragments that are left. keys: [2 count], memory for this call. sorted: [count]. */
size_t hl_sort_by_pixel(const fragment *list, size_t count, const fragment_order *order, order_key *keys,
                        fragment *sorted);

/* Sorts fragments by slabs, within a slab by pixels, and within a pixel of a slab by rising heights. list:
 * sorted by pixels, and within a pixel in the order in which the view meets the fragments. Where
 * order->falling is set, this order is reversed within each pixel of a slab: the fragment that the view meets
 * first comes last, also among fragments of one height. places: [slabs + 2], memory for this call. slabs: the
 * greatest number of a slab. sorted: [count]. */
void hl_sort_by_slab(const fragment *list, size_t count, const fragment_order *order, uint32_t *places,
                     int slabs, fragment *sorted);

/* Finds the opacities of fragments, which are sorted by pixels. Keeps fragments that take any light, and
 * returns their number. */
size_t hl_resolve_fragments(fragment *list, size_t count, const fragment_order *order);

#endif
