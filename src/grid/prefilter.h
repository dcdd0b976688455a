/* grid/prefilter.h - the coefficients of the interpolating kernel.
 *
 * A B-spline over the voxels' values blurs them. Over these coefficients it passes through the values (Unser,
 * Aldroubi and Eden, "B-Spline Signal Processing", 1993). Coefficients overshoot: between voxels the sum may
 * leave the range of the volume's values. Transfer functions then use the nearest value of the range. */
#ifndef HL_GRID_PREFILTER_H
#define HL_GRID_PREFILTER_H

#include <float.h>
#include <math.h>

#include "grid/grid.h"
#include "grid/kernel.h"

/* The greatest distance of a value from 0. Coefficients are up to 27 times as far from 0: 3 times along each
 * axis, by the sum of the filter's weights (derived). Greater values would leave the range of floats, and are
 * replaced by this one. */
static inline float hl_greatest_value(const kernel *kernel) {
  return kernel->interpolates ? FLT_MAX / 64 : FLT_MAX;
}

/* The value that sampling uses for a stored one. empty: replaces a value that is not finite. */
static inline float hl_grid_value(float stored, float greatest, float empty) {
  return isfinite(stored) ? fminf(fmaxf(stored, -greatest), greatest) : empty;
}

/* Turns finite_voxels, which hold the grid's finite values, into coefficients. */
void hl_prefilter(hl_pool *pool, grid *grid);

/* ---- its parts ---- */

/* Filters a slice along x and y, in place. slice: [height][width]. */
void hl_prefilter_slice(float *slice, size_t width, size_t height);

/* Filter along an axis of `count` voxels, 2 or more: first forward, from each voxel to the next; then back,
 * from each voxel but the last to the one before. here, before, after: [width]; neighbouring lines' values at
 * voxel `at`, and at the voxels before and after it, which must have been filtered already. before: null for
 * the first voxel. */
void hl_prefilter_forward(float *here, const float *before, size_t width, size_t at, size_t count);
void hl_prefilter_back(float *here, const float *after, size_t width, size_t at, size_t count);

#endif
