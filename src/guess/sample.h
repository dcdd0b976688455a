/* guess/sample.h - a sample of a volume's voxels, sorted: the ground that automatic choices stand on.
 *
 * Values are relative to the volume's range, 0 its least and 1 its greatest, so that it does not matter in
 * which units a volume is.
 */
#ifndef HL_GUESS_SAMPLE_H
#define HL_GUESS_SAMPLE_H

#include <stdbool.h>

#include "core/error.h"
#include "volume/volume.h"

typedef struct hl_sample {
  hl_context *context;
  double low, range; /* data value = low + range * relative value */
  float *values; /* owned; [count]; relative values of finite voxels on a regular sub-lattice, ascending */
  size_t count;
  float *border; /* owned; [border_count]; the same for the grid's six faces */
  size_t border_count;
  size_t step; /* voxels from one sample to the next along each axis */
} hl_sample;

/* The step along each axis of a lattice of at most `most` places in a grid, thin grids included; at least
 * 1. */
size_t hl_lattice_step(const size_t dimension[3], double most);

/* Fails for lack of memory alone; either array may be empty where the volume is full of NaNs. */
hl_status hl_sample_make(const hl_volume *volume, hl_sample *sample, hl_error *error);
void hl_sample_release(hl_sample *sample);

/* The value below which the fraction (0..1) of an ascending array lies. */
double hl_quantile(const float *ascending, size_t count, double fraction);

/* The commonest value: the densest half of the densest half of ... an ascending array (half-sample mode;
 * Bickel and Fruehwirth 2006). */
double hl_mode(const float *ascending, size_t count);

/* Threshold between two classes of greatest variance between them (Otsu 1979); of values above `above`
 * only. */
double hl_threshold_otsu(const float *ascending, size_t count, double above);

/* Threshold of least cross entropy between an image and its two classes' means (Li and Tam 1998), of values
 * that are 0 or more; floor stands for a mean of zero, whose logarithm does not exist. */
double hl_threshold_cross_entropy(const float *ascending, size_t count, double floor);

/* How rough the things are: mean |second difference| / |first difference| of voxels whose relative value is
 * further than `distance` from `background`. Smooth simulations have less than about 0.5, turbulence and
 * noise more than about 0.7. */
double hl_roughness(const hl_volume *volume, const hl_sample *sample, double background, double distance);

/* Ascending order; false without memory. */
bool hl_sort(hl_context *context, float *values, size_t count);

#endif
