/* surface/cluster_order.h - the primitives of a mesh in an order in which those that follow each other lie
 * beside each other. */
#ifndef HL_SURFACE_CLUSTER_ORDER_H
#define HL_SURFACE_CLUSTER_ORDER_H

#include "surface/surfaces.h"

/* The numbers of `spare` that hl_cluster_order_fill() needs for each primitive. */
enum { ORDER_SPARE = 3 };

/* Writes the numbers of the primitives first to first + count - 1, of one kind and mesh, to all->order at
 * `first`, along a curve that fills space. spare: [ORDER_SPARE][count]; for use here. */
void hl_cluster_order_fill(hl_pool *pool, surfaces *all, uint32_t first, uint32_t count, uint32_t *spare);

#endif
