/* surface/fragment_order.h - the fragments of a tile sorted, and what each takes of the light that reaches
 * it.
 */
#ifndef HL_SURFACE_FRAGMENT_ORDER_H
#define HL_SURFACE_FRAGMENT_ORDER_H

#include <stdbool.h>
#include <stddef.h>

#include "surface/fragment.h"
#include "view/view.h"

/* How the fragments of a view are ordered and composited. */
typedef struct fragment_order {
  const float *least; /* [mesh_count]; borrowed; the least fraction of their opacity that meshes take of any
                         colour of light */
  bool falling;       /* the view meets great heights first */
  bool slabs;         /* of a light's view whose buffer is also used for rays of other directions */
  bool apart;         /* no fragment hides another */
  double spacing;     /* of the sheets; frame units */
} fragment_order;

/* A fragment's place in the order of its pixel: keys are sorted in place of fragments. */
typedef struct order_key {
  uint64_t key;   /* the height, then the primitive: less comes first */
  uint32_t index; /* in the list */
} order_key;

/* A float's bits, so that they grow as the float does; turned round where heights fall. */
uint32_t hl_ordered_bits(float height, bool falling);

/* Sorts by rising keys; equal ones keep their order. spare: [count]. */
void hl_sort_keys(order_key *list, order_key *spare, size_t count);

/* Whether a fragment takes all light of its samples. */
static inline bool hl_is_opaque(const fragment *f, const float *least) {
  return f->opacity * least[f->mesh] >= 1;
}

/* Sorts by pixels, and within a pixel in the order that the view meets the fragments. Leaves out those whose
 * samples opaque fragments before them cover, also where their surfaces reach nearest, except where
 * order->slabs or order->apart; returns how many are left. keys: [2 count], for use here; sorted: [count]. */
size_t hl_sort_by_pixel(const fragment *list, size_t count, const fragment_order *order, order_key *keys,
                        fragment *sorted);

/* Sorts by slabs fragments that are sorted by pixels and in the order that the view meets them; within a slab
 * by pixels, then by rising heights: the other way round where order->falling, so that of several at one
 * height, too, the one that the view meets first comes last. places: [slabs + 2], for use here; slabs: the
 * greatest number that a slab may have; sorted: [count]. */
void hl_sort_by_slab(const fragment *list, size_t count, const fragment_order *order, uint32_t *places,
                     int slabs, fragment *sorted);

/* Finds the opacities of fragments, which are sorted by pixels, and keeps those that take anything; returns
 * how many. */
size_t hl_resolve_fragments(fragment *list, size_t count, const fragment_order *order);

#endif
