/* guess/smoothing.c - hl_volume_smooth(), and the choice of bare volumes that are smoothed without being
 * asked for.
 *
 * A brain without its skull was cut out voxel by voxel: around it all voxels have one value, and the first
 * voxel inside is as bright as the matter within. No kernel makes a smooth surface of such a cliff. Slices
 * much thicker than their pixels make terraces. */
#include "guess/smoothing.h"

#include <math.h>

#include "core/door.h"
#include "core/memory.h"
#include "guess/looks.h"
#include "volume/smooth.h"

/* The standard deviation, in voxels, of the Gaussian that smooths volumes of both kinds: the least one that
 * leaves no stairs on the gyri of real brains. */
#define SIGMA 0.8
/* The greatest accepted standard deviation. */
#define GREATEST_SIGMA 16
/* The least fraction of voxels that have exactly the background's value. */
#define LEAST_ZEROED 0.2
/* A cliff is a step higher than this part of the way from the background to matter. */
#define CLIFF 0.3
/* The least fraction of steps from the background's value to another one that are cliffs. In a brain that
 * was cut out the fraction is .47; in scans with natural rims it is at most .08 (a stent). */
#define LEAST_CLIFFS 0.25
/* Slices that are thicker than their pixels by this factor make terraces. */
#define THICK_SLICES 1.5

/* The fraction of the steps between neighbours along i, from the background's exact value to another one,
 * that are cliffs; 0: there is no such step. */
static double fraction_of_cliffs(const hl_volume *volume, const hl_data_analysis *analysis, void *buffer) {
  size_t steps = 0, cliffs = 0;
  for (size_t k = 0; k < volume->dimension[2]; k++)
    for (size_t j = 0; j < volume->dimension[1]; j++) {
      const void *row = hl_volume_row_in(volume, j, k, buffer);
      double before = 0;
      for (size_t i = 0; i < volume->dimension[0]; i++) {
        double value = volume->value_scale * hl_stored_number(volume->storage, row, i) + volume->value_offset,
               distance = fabs(value - before);
        bool step = i > 0 && (value == analysis->background) != (before == analysis->background);
        steps += step;
        cliffs += step && distance > CLIFF * analysis->solid;
        before = value;
      }
    }
  return steps > 0 ? (double)cliffs / (double)steps : 0;
}

static double slice_thickness(const hl_volume *volume) {
  double least = INFINITY, greatest = 0;
  for (int a = 0; a < 3; a++) {
    double length = vec3_length(mat3_column(volume->index_to_world.linear, a));
    least = fmin(least, length);
    greatest = fmax(greatest, length);
  }
  return greatest / least;
}

hl_status hl_smoothing_for(const hl_volume *volume, const char *file, const hl_data_analysis *analysis,
                           double *sigma, hl_error *error) {
  *sigma = 0;
  if (!hl_is_body(volume, file, analysis) || volume->pages != NULL || volume->colors != NULL ||
      atomic_load(&volume->smoothing_chosen))
    return HL_OK;
  if (slice_thickness(volume) >= THICK_SLICES) *sigma = SIGMA;
  if (*sigma > 0 || analysis->zeroed < LEAST_ZEROED) return HL_OK;
  void *buffer = hl_allocate(volume->context, volume->dimension[0], hl_storage_bytes(volume->storage));
  if (buffer == NULL) return hl_fail_memory(error, volume->dimension[0], "a row of voxels");
  if (fraction_of_cliffs(volume, analysis, buffer) >= LEAST_CLIFFS) *sigma = SIGMA;
  hl_release(volume->context, buffer);
  return HL_OK;
}

double hl_volume_smoothing(const hl_volume *volume) {
  HL_DOOR;
  return volume != NULL ? volume->smoothing : 0;
}

static hl_status refuse(const hl_volume *volume, const hl_data_analysis *analysis, double sigma,
                        hl_error *error) {
  if (!(sigma >= 0 && sigma <= GREATEST_SIGMA))
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "%.9g voxels of smoothing are out of range: give a number from 0 to %d", sigma,
                   GREATEST_SIGMA);
  if (hl_data_is_label_map(volume, analysis))
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "a label map cannot be smoothed: its numbers are names and have no mean: show its labels, "
                   "which are smooth");
  if (volume->pages != NULL)
    return hl_fail(
        error, HL_ERROR_UNSUPPORTED,
        "a volume larger than memory cannot be smoothed: read a coarser level, or raise the memory limit");
  if (volume->colors != NULL)
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "a volume with colours cannot be smoothed: read one of their components");
  return HL_OK;
}

hl_status hl_volume_smooth(hl_volume *volume, double sigma, hl_volume **smoothed, hl_error *error) {
  HL_DOOR;
  hl_data_analysis analysis;
  if (volume == NULL || smoothed == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_volume_smooth: null volume or smoothed");
  *smoothed = NULL;
  hl_status status = hl_data_analyse(volume, &analysis, error);
  if (status == HL_OK && sigma != 0) status = refuse(volume, &analysis, sigma, error);
  if (status != HL_OK) return status;
  if (sigma == 0) {
    hl_volume_retain(volume);
    *smoothed = volume;
  } else {
    status = hl_volume_convolve(volume, sigma, smoothed, error);
    if (status != HL_OK) return status;
    (*smoothed)->smoothing = hypot(sigma, volume->smoothing);
  }
  atomic_store(&(*smoothed)->smoothing_chosen, true);
  return HL_OK;
}
