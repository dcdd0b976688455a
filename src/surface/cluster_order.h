/* surface/cluster_order.h - the primitives of a mesh in an order in which primitives that follow each other
 * are close together. */
#ifndef HL_SURFACE_CLUSTER_ORDER_H
#define HL_SURFACE_CLUSTER_ORDER_H

#include "surface/surfaces.h"

/* How many numbers of `spare` hl_cluster_order_fill() needs for each primitive. */
enum { ORDER_SPARE = 3 };

/* Writes the numbers of the primitives first to first + count - 1, which are of one kind and mesh, to
 * all->order at `first`, in their order along a space-filling curve. spare: [ORDER_SPARE][count], memory for
 * this call. */
void hl_cluster_order_fill(hl_pool *pool, surfaces *all, uint32_t first, uint32_t count, uint32_t *spare);

#endif
