/* surface/cluster_order.h - orders the primitives of a mesh so that primitives that follow each other are
 * close together. */
#ifndef HL_SURFACE_CLUSTER_ORDER_H
#define HL_SURFACE_CLUSTER_ORDER_H

#include "surface/surfaces.h"

/* The number of elements of `spare` that hl_cluster_order_fill() needs for each primitive. */
enum { ORDER_SPARE = 3 };

/* Orders the primitives `first` to first + count - 1 along a space-filling curve, and writes their numbers to
 * all->order from index `first` on. The primitives must be of one kind and one mesh. spare:
 * [ORDER_SPARE][count], memory for this call. */
void hl_cluster_order_fill(hl_pool *pool, surfaces *all, uint32_t first, uint32_t count, uint32_t *spare);

#endif
