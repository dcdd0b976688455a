/* surface/primitive_bins.h - sorts triangles and spheres into the tiles of a view that they touch. A cluster
 * that touches few tiles is sorted as a whole; the primitives of other clusters are sorted one by one. */
#ifndef HL_SURFACE_PRIMITIVE_BINS_H
#define HL_SURFACE_PRIMITIVE_BINS_H

#include "core/memory.h"
#include "surface/clusters.h"
#include "surface/seen.h"

/* One primitive, or all primitives of a cluster. Some primitives of a cluster may lie outside of the tile, or
 * turn their backs to the view. */
typedef struct primitive_run {
  uint32_t primitive; /* of a cluster the first */
  uint32_t cluster;   /* NO_CLUSTER: this primitive alone */
} primitive_run;

#define NO_CLUSTER UINT32_MAX

typedef struct primitive_bins {
  uint32_t *first;     /* owned; [tiles + 1] */
  primitive_run *runs; /* owned; the runs of tile after tile; within a tile, in the order of primitives */
} primitive_bins;

/* What of a mesh is binned. */
typedef enum binned { BINNED_NOTHING, BINNED_FRONTS, BINNED_ALL } binned;

/* Sorts primitives into tiles. wanted: [mesh_count]; which primitives of each mesh are sorted. BINNED_FRONTS:
 * all primitives except triangles that turn their backs to the view. */
hl_status hl_primitive_bins_create(hl_context *context, hl_pool *pool, const seen_surfaces *seen,
                                   const binned *wanted, primitive_bins *bins, hl_error *error);
/* Counts the memory that hl_primitive_bins_create() takes if each primitive lies in one tile. */
void hl_primitive_bins_count(const surfaces *all, const view *view, hl_layout *layout);
void hl_primitive_bins_release(hl_context *context, primitive_bins *bins);

#endif
