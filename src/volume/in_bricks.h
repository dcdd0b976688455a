/* volume/in_bricks.h - volumes whose field is bricks of B-spline coefficients at levels (bricks/bricks.h)
 * instead of voxels. */
#ifndef HL_VOLUME_IN_BRICKS_H
#define HL_VOLUME_IN_BRICKS_H

#include "bricks/build.h"
#include "volume/volume.h"

/* Makes a volume of a field in bricks. The smoothing and the interpolating kernel are the same for such a
 * volume: both give the field of the coefficients. bricks: its arrays, blocks of hl_allocate(), are taken
 * over, also on failure; *bricks is empty afterwards. grid: the voxels that stand for the field where
 * voxels are wanted: dimensions, axis and origin (of voxel (0,0,0), which is at bricks->origin in the
 * lattice), space. Its type must be HL_VOXEL_F32, its value_scale 1 and value_offset 0; its `voxels` are
 * not read. Every voxel's centre must lie within the directory. Coefficients and constants that are not
 * finite are places without data: empty space. subject: starts the error lines. *volume is owned by the
 * caller (release it). */
hl_status hl_volume_take_bricks(hl_context *context, hl_bricks *bricks, const hl_volume_description *grid,
                                const char *subject, hl_volume **volume, hl_error *error);

/* Notes how much a new volume's field differs from its source, for hl_volume_get_field_error(). kind,
 * source: static. */
void hl_volume_set_field_error(hl_volume *volume, double value, const char *kind, const char *source);

/* ---- for create.c ---- */

/* Fails where bricks and voxels do not fit each other. */
hl_status hl_volume_check_bricks(const hl_bricks *bricks, const hl_volume_description *grid,
                                 const char *subject, hl_error *error);

/* Finds the statistics of a volume's coefficients. Each coefficient has a cell, and counts once for each cell
 * of level 0 in it that lies in the volume's box. So all coefficients together count as often as there are
 * voxels. Coefficients that are not finite do not count in range and mean. */
hl_status hl_volume_measure_bricks(hl_volume *volume, const char *subject, hl_error *error);

/* The number that stands for a voxel: where voxels stand on points of the lattice, the coefficient of level
 * 0, so that a dense volume of these voxels has the same field under the smoothing kernel; else the field's
 * value. */
float hl_volume_value_of_bricks(const hl_volume *volume, const size_t voxel[3]);
/* Finds the values of hl_volume_value_of_bricks() for all voxels of a row. row: [dimension[0]]. */
void hl_volume_row_of_bricks(const hl_volume *volume, size_t j, size_t k, float *row);

#endif
