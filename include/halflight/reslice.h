/* halflight/reslice.h - cuts planes of samples out of a volume, at any angle and of any thickness.
 *
 * A plane is a grid of samples. Its place is given in voxel numbers: voxel (i, j, k) has its centre at the
 * coordinates i, j, k. hl_volume_info tells where voxels lie in the world. */
#ifndef HALFLIGHT_RESLICE_H
#define HALFLIGHT_RESLICE_H

#include "volume.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The ways in which the samples of a thick plane that lie behind each other are combined into one value. */
typedef enum hl_blend {
  HL_BLEND_MAXIMUM = 1, /* the greatest value: maximum intensity projection */
  HL_BLEND_MINIMUM = 2,
  HL_BLEND_MEAN = 3
} hl_blend;

typedef struct hl_reslice_options {
  size_t struct_size;          /* set by hl_reslice_options_defaults() */
  size_t width, height, depth; /* the number of samples along a row, the number of rows, and the number of
                                * layers of a thick plane; each at least 1; default 1 */
  double origin[3]; /* the place, in voxel numbers i, j, k, of the first sample of the first row of the first
                     * layer; default 0 */
  double across[3], down[3], through[3]; /* the steps from one sample to the next, from one row to the next
                                          * and from one layer to the next, in voxels along i, j, k; default:
                                          * the unit steps along i, j, k */
  hl_blend blend;                        /* default HL_BLEND_MAXIMUM */
  int interpolate; /* non-zero if values between voxels are interpolated linearly; 0, the default, if a sample
                    * has the value of the nearest voxel */
} hl_reslice_options;

HL_API void hl_reslice_options_defaults(hl_reslice_options *options);

/* Finds the data values of a plane. values: the caller's, [height][width]. A value is NaN if all of its
 * samples are without a value. A sample is without a value beyond half a voxel around the grid, at a voxel
 * that is not finite, and, with interpolation, where one of the voxels that it needs is not finite. At the
 * voxels' centres, in a plane of one layer, the values are the same as for hl_volume_value(), with and
 * without interpolation. Numbers that are not finite, or beyond 1e9 voxels, are HL_ERROR_ARGUMENT. */
HL_API HL_WARN_UNUSED hl_status hl_volume_reslice(const hl_volume *volume, const hl_reslice_options *options,
                                                  double *values, hl_error *error);

#ifdef __cplusplus
}
#endif
#endif
