/* grid/prefilter.h - the coefficients of the interpolating kernel.
 *
 * A B-spline over the voxels' values blurs them. Over these coefficients it passes through the values
 * (Unser, Aldroubi and Eden, "B-Spline Signal Processing", 1993). Coefficients overshoot: between voxels the
 * sum may leave the range of the volume's values, where transfer functions take it for the nearest value of
 * the range. */
#ifndef HL_GRID_PREFILTER_H
#define HL_GRID_PREFILTER_H

#include "grid/grid.h"

/* Turns finite_voxels, which hold the grid's finite values, into coefficients. */
void hl_prefilter(hl_pool *pool, grid *grid);

#endif
