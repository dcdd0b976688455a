/* guess/sample.h - takes a sorted sample of a volume's voxels, from which automatic choices are made.
 *
 * Values are relative to the volume's range, where 0 is its least value and 1 its greatest. So automatic
 * choices do not depend on the data's units. */
#ifndef HL_GUESS_SAMPLE_H
#define HL_GUESS_SAMPLE_H

#include <stdbool.h>

#include "core/error.h"
#include "volume/store/glimpse.h"

typedef struct hl_sample {
  hl_context *context;
  double low, range; /* data value = low + range * relative value */
  float *values; /* owned; [count]; relative values of finite voxels on a regular sub-lattice, ascending */
  size_t count;
  float *border; /* owned; [border_count]; relative values of voxels on the grid's six faces, ascending */
  size_t border_count;
  size_t step; /* number of voxels from one sample to the next along each axis */
} hl_sample;

/* Takes a sample of a volume. The arrays `values` and `border` may be empty if voxels are NaN. Fails only for
 * lack of memory. */
hl_status hl_sample_make(const hl_volume *volume, hl_sample *sample, hl_error *error);
void hl_sample_release(hl_sample *sample);

/* The quantile of an ascending array: the fraction `fraction` (0 to 1) of the array's elements lies below the
 * quantile. */
double hl_quantile(const float *ascending, size_t count, double fraction);

/* The commonest value of an ascending array. The function takes the densest half of the array again and again
 * (half-sample mode; Bickel and Fruehwirth 2006). */
double hl_mode(const float *ascending, size_t count);

/* The threshold, among values greater than `above`, for which the variance between the two classes on its
 * sides is greatest (Otsu 1979). */
double hl_threshold_otsu(const float *ascending, size_t count, double above);

/* The threshold for which the cross entropy between the values and the means of the two classes on its sides
 * is least (Li and Tam 1998). Values must not be below 0. floor: the least mean that is used, because 0 has
 * no logarithm. */
double hl_threshold_cross_entropy(const float *ascending, size_t count, double floor);

/* The roughness of objects: the sum of |second differences| divided by the sum of |first differences|, over
 * the voxels whose relative value differs from `background` by more than `distance`. Smooth simulations have
 * a roughness of less than about 0.5, turbulence and noise of more than about 0.7. */
double hl_roughness(const hl_volume *volume, const hl_sample *sample, double background, double distance);

/* The noise of objects, relative to the range: the standard deviation of white noise with the same median of
 * the mixed difference. The mixed difference is of second order along each of the three axes, so that values
 * which change linearly along an axis have the difference 0 (after Immerkaer 1996). Objects have relative
 * values beyond `from` in the direction (+1: above; -1: below). Fails only for lack of memory. */
hl_status hl_noise(const hl_volume *volume, const hl_sample *sample, double from, double direction,
                   double *noise, hl_error *error);

/* Sorts values in ascending order. Returns false if memory is lacking. */
bool hl_sort(hl_context *context, float *values, size_t count);

#endif
