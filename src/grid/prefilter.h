/* grid/prefilter.h - computes the coefficients of the interpolating kernel.
 *
 * A B-spline over the voxels' values blurs the values. A B-spline over the coefficients that this file
 * computes passes through the values (Unser, Aldroubi and Eden, "B-Spline Signal Processing", 1993). Between
 * voxels, the sum over coefficients may leave the range of the volume's values. Transfer functions then use
 * the nearest value of the range. */
#ifndef HL_GRID_PREFILTER_H
#define HL_GRID_PREFILTER_H

#include <float.h>
#include <math.h>

#include "grid/grid.h"
#include "grid/kernel.h"

/* The greatest magnitude of a value that sampling uses. Derived: coefficients have up to 27 times the
 * magnitude of the values, a factor of 3 for each axis. This factor is the sum of the magnitudes of the
 * filter's weights. Values of greater magnitude are replaced by this magnitude with their own sign, because
 * their coefficients would leave the range of floats. */
static inline float hl_greatest_value(const kernel *kernel) {
  return kernel->interpolates ? FLT_MAX / 64 : FLT_MAX;
}

/* The value that sampling uses in place of a stored value. empty: the value that replaces a value that is not
 * finite. */
static inline float hl_grid_value(float stored, float greatest, float empty) {
  return isfinite(stored) ? fminf(fmaxf(stored, -greatest), greatest) : empty;
}

/* Turns finite_voxels, which hold the grid's finite values, into coefficients. */
void hl_prefilter(hl_pool *pool, grid *grid);

/* ---- its parts ---- */

/* Filters a slice along x and y, in place. slice: [height][width]. */
void hl_prefilter_slice(float *slice, size_t width, size_t height);

/* hl_prefilter_forward() and hl_prefilter_back() filter `width` neighbouring lines along an axis of `count`
 * voxels, 2 or more. First call hl_prefilter_forward() for each voxel of the lines, from the first to the
 * last. After these calls, call hl_prefilter_back() for each voxel except the last, in the opposite order.
 * here: [width]; the lines' values at voxel `at`. before, after: [width]; the values at the voxel before or
 * after voxel `at`, which must have been filtered already; `before` is null for the first voxel. */
void hl_prefilter_forward(float *here, const float *before, size_t width, size_t at, size_t count);
void hl_prefilter_back(float *here, const float *after, size_t width, size_t at, size_t count);

#endif
