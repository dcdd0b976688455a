/* fill/voxel_lists.h - lists the relevant voxels, sorted by tile and sheet for splatting (step 2 of the
 * paper). */
#ifndef HL_FILL_VOXEL_LISTS_H
#define HL_FILL_VOXEL_LISTS_H

#include "view/occupancy.h"

/* The voxels that touch each tile of a view, sorted by the first sheet that their kernels touch. */
typedef struct voxel_lists {
  int tiles_x, tiles_y;
  int bucket_count; /* number of buckets of a tile: number of sheets + span - 1 */
  int span; /* number of sheets that a kernel can touch. Sheet k reads the buckets k to k + span - 1. A voxel
             * at the grid's border touches more sheets, because its value continues outside the grid, and is
             * listed again every `span` sheets */
  uint32_t *start; /* owned; [tiles * bucket_count + 1]; the index in `voxel` at which each bucket begins */
  uint32_t *voxel; /* owned; [start[last]]; indices of voxels in the grid padded by 2 voxels on every side */
} voxel_lists;

/* The voxels to sort, and the view for which they are sorted. */
typedef struct voxel_sort {
  const grid *grid;
  const kernel *kernel;
  const view *view;
  const sheet_stack *sheets;
} voxel_sort;

hl_status hl_voxel_lists_build(hl_context *context, hl_pool *pool, const voxel_sort *sort, voxel_lists *lists,
                               hl_error *error);
void hl_voxel_lists_release(hl_context *context, voxel_lists *lists);

#endif
