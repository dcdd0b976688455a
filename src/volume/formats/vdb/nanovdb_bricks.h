/* volume/formats/vdb/nanovdb_bricks.h - makes bricks (bricks/bricks.h) from a NanoVDB grid of floats, without
 * the empty space between the bricks. */
#ifndef HL_VOLUME_NANOVDB_BRICKS_H
#define HL_VOLUME_NANOVDB_BRICKS_H

#include "bricks/build.h"
#include "volume/formats/vdb/nanovdb_grid.h"

/* Makes bricks whose coefficients are the grid's voxels, if they take less than 0.6 of the bytes of the box
 * of all active voxels. grid: a grid whose voxels are single 32-bit floats. description: as made by
 * nanovdb_grid_describe(). *bricks: owned by the caller (hl_bricks_release). *bricks has no directory after a
 * failure, or if the bricks would take too many bytes. */
hl_status nanovdb_bricks_read(const nanovdb_grid *grid, const hl_volume_description *description,
                              hl_bricks *bricks, hl_error *error);

#endif
