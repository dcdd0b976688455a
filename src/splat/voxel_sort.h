/* splat/voxel_sort.h - the bucket sort of step 2: relevant voxels by tile of a view and by first sheet. */
#ifndef HL_SPLAT_VOXEL_SORT_H
#define HL_SPLAT_VOXEL_SORT_H

#include "splat/occupancy.h"

hl_status hl_voxel_lists_build(hl_context *context, hl_pool *pool, const grid *grid, const kernel *kernel,
                               const view *view, const sheet_stack *sheets, voxel_lists *lists,
                               hl_error *error);
void hl_voxel_lists_release(hl_context *context, voxel_lists *lists);

#endif
