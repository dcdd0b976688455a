/* volume/in_bricks.h - volumes whose field is bricks of B-spline coefficients at levels (bricks/bricks.h)
 * instead of voxels. */
#ifndef HL_VOLUME_IN_BRICKS_H
#define HL_VOLUME_IN_BRICKS_H

#include "bricks/build.h"
#include "volume/volume.h"

/* Makes a volume of a field in bricks. For such a volume, the smoothing kernel and the interpolating kernel
 * give the same field, whose coefficients are the bricks' coefficients. bricks: its arrays, blocks of
 * hl_allocate(), are taken over, also on failure; *bricks is empty afterwards. grid: the voxels at which the
 * field is evaluated where voxels are wanted: dimensions, axis, space, and origin, the place of voxel
 * (0,0,0), which is at bricks->origin in the lattice. Its type must be HL_VOXEL_F32, its value_scale 1 and
 * value_offset 0; its `voxels` are not read. Every voxel's centre must lie within the directory. Where
 * coefficients or constants are not finite, there are no data, and space is empty. subject: starts the error
 * lines. *volume is owned by the caller (release it). */
hl_status hl_volume_take_bricks(hl_context *context, hl_bricks *bricks, const hl_volume_description *grid,
                                const char *subject, hl_volume **volume, hl_error *error);

/* Returns whether a volume is a field at several levels. Such a field is a sum of B-splines, and other
 * kernels cannot show it. */
static inline bool hl_volume_has_levels(const hl_volume *volume) {
  return volume->bricks != NULL && volume->bricks->levels > 1;
}

/* Stores the greatest difference between a new volume's field and its source, for
 * hl_volume_get_field_error(). kind, source: static. */
void hl_volume_set_field_error(hl_volume *volume, double value, const char *kind, const char *source);

/* ---- for create.c ---- */

/* Fails if the bricks do not fit the grid of voxels. */
hl_status hl_volume_check_bricks(const hl_bricks *bricks, const hl_volume_description *grid,
                                 const char *subject, hl_error *error);

/* Finds the statistics of a volume from the coefficients that hl_volume_visit_bricks() visits. Coefficients
 * that are not finite do not count in range and mean. */
hl_status hl_volume_measure_bricks(hl_volume *volume, const char *subject, hl_error *error);

/* A coefficient, and the number of cells of level 0 for which it counts. It counts as often as its cell
 * contains cells of level 0 in the volume's box, so that the counts of all coefficients add up to the number
 * of voxels. */
typedef void hl_coefficient_visit(void *data, float value, uint64_t count);
/* Calls `visit` for the coefficients of all bricks. Returns false if cancelled. */
bool hl_volume_visit_bricks(const hl_volume *volume, hl_coefficient_visit *visit, void *data);

/* The number of a voxel. If voxels are lattice points, it is the coefficient of level 0: a dense volume of
 * these numbers has the same field under the smoothing kernel. Otherwise it is the field's value. */
float hl_volume_value_of_bricks(const hl_volume *volume, const size_t voxel[3]);
/* Finds the values of hl_volume_value_of_bricks() for all voxels of a row. row: [dimension[0]]. */
void hl_volume_row_of_bricks(const hl_volume *volume, size_t j, size_t k, float *row);

#endif
