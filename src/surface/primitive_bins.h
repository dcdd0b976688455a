/* surface/primitive_bins.h - sorts triangles and spheres into the tiles of a view that they touch. A cluster
 * that touches few tiles is sorted as a whole; the primitives of other clusters are sorted one by one. */
#ifndef HL_SURFACE_PRIMITIVE_BINS_H
#define HL_SURFACE_PRIMITIVE_BINS_H

#include "core/memory.h"
#include "surface/clusters.h"
#include "surface/seen.h"

/* A run: one primitive, or all primitives of a cluster, as an entry in the list of a tile. Some primitives of
 * a cluster may lie outside of the tile, or turn their backs to the view. */
typedef struct primitive_run {
  uint32_t primitive; /* the primitive's number; for a cluster, the number of its first primitive */
  uint32_t cluster;   /* index of the cluster; NO_CLUSTER: the run consists of a single primitive */
} primitive_run;

#define NO_CLUSTER UINT32_MAX

typedef struct primitive_bins {
  uint32_t *first;     /* owned; [tiles + 1]; the index in `runs` of each tile's first run */
  primitive_run *runs; /* owned; the runs of one tile after the other; the runs of a tile are in the order
                        * of primitives */
} primitive_bins;

/* The primitives of a mesh that are sorted into tiles. */
typedef enum binned { BINNED_NOTHING, BINNED_FRONTS, BINNED_ALL } binned;

/* Sorts primitives into tiles. wanted: [mesh_count]; which primitives of each mesh are sorted. BINNED_FRONTS:
 * all primitives except triangles that turn their backs to the view. */
hl_status hl_primitive_bins_create(hl_context *context, hl_pool *pool, const seen_surfaces *seen,
                                   const binned *wanted, primitive_bins *bins, hl_error *error);
/* Counts the memory that hl_primitive_bins_create() takes if each primitive lies in one tile. */
void hl_primitive_bins_count(const surfaces *all, const view *view, hl_layout *layout);
void hl_primitive_bins_release(hl_context *context, primitive_bins *bins);

#endif
