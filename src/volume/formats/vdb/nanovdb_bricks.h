/* volume/formats/vdb/nanovdb_bricks.h - makes bricks (bricks/bricks.h) from a NanoVDB grid of floats, without
 * the empty space between the bricks. */
#ifndef HL_VOLUME_NANOVDB_BRICKS_H
#define HL_VOLUME_NANOVDB_BRICKS_H

#include "bricks/build.h"
#include "volume/formats/vdb/nanovdb_grid.h"

/* Makes bricks whose coefficients are the grid's voxels, if they take less than 0.6 of the bytes of the box
 * of all active voxels. grid: must have one number in each voxel, which is stored as a 32-bit float.
 * description: as made by nanovdb_grid_describe(). *bricks: owned by the caller (hl_bricks_release). It has
 * no directory if a dense volume is better, or after a failure. */
hl_status nanovdb_bricks_read(const nanovdb_grid *grid, const hl_volume_description *description,
                              hl_bricks *bricks, hl_error *error);

#endif
