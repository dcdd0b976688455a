/* volume/in_bricks.h - volumes whose field is bricks of B-spline coefficients at levels (bricks/bricks.h)
 * instead of voxels. */
#ifndef HL_VOLUME_IN_BRICKS_H
#define HL_VOLUME_IN_BRICKS_H

#include "bricks/bricks.h"
#include "volume/volume.h"

/* Makes a volume of a field in bricks. Its smoothing and its interpolating kernel are the same: the field of
 * the coefficients. bricks: its arrays, blocks of hl_allocate(), are taken over, also on failure; *bricks is
 * empty afterwards. grid: the voxels that stand for the field where voxels are wanted: dimensions, axis and
 * origin (of voxel (0,0,0), which is at bricks->origin in the lattice), space. Its type must be HL_VOXEL_F32,
 * its value_scale 1 and value_offset 0; its `voxels` are not read. Every voxel's centre must lie within the
 * directory. subject: starts the error lines. *volume is owned by the caller (release it). */
hl_status hl_volume_take_bricks(hl_context *context, hl_bricks *bricks, const hl_volume_description *grid,
                                const char *subject, hl_volume **volume, hl_error *error);

#endif
