/* guess/smoothing.c - hl_volume_smooth(), and the choice of the bare volumes that are smoothed by default.
 *
 * A brain without its skull was cut out voxel by voxel: around the brain all voxels have one value, and the
 * first voxel inside is as bright as the matter within. No reconstruction kernel makes a smooth surface of
 * such a cliff. Where voxels stand further apart than the scanner resolves, as thick slices do, surfaces have
 * terraces. A scanner's noise makes surfaces grainy. */
#include "guess/smoothing.h"

#include <math.h>

#include "core/door.h"
#include "elementary/elementary.h"
#include "guess/looks.h"
#include "volume/smooth.h"
#include "volume/store/gathered.h"
#include "volume/unsmoothed.h"

/* The standard deviation, in voxels, of the Gaussian for all three kinds of volumes that are smoothed. A
 * smaller deviation leaves stairs on the gyri of real brains. */
#define SIGMA 0.8
/* The greatest accepted standard deviation. */
#define GREATEST_SIGMA 16
/* The sharpness from which surfaces have terraces. Derived: a step that a Gaussian of half a voxel has
 * blurred has the sharpness .614, in the mean over the step's places between the voxels (equations:
 * sharpness). Sharper steps keep more than .29 of their waves that are two voxels long, the shortest waves
 * that voxels carry. */
#define TERRACED 0.614
/* Surfaces are grainy if noise moves them by this fraction of a voxel edge. Measured: noise moves the
 * surfaces of four scans in which grain is seen by .09 to .19, and the surfaces of eleven other scans by at
 * most .03. */
#define GRAINY 0.05

double hl_smoothing_for(const hl_volume *volume, const char *file, const hl_data_analysis *analysis) {
  if (!hl_volume_is_in_memory(volume) || volume->colors != NULL || hl_data_is_label_map(volume, analysis) ||
      atomic_load(&volume->smoothing_chosen))
    return 0;
  const bool stairs = analysis->cliffs >= HL_CUT_OUT && hl_is_body(volume, file, analysis);
  /* Values without any noise were computed, and not scanned. The edges of computed data are meant to be
   * sharp. */
  const bool terraces = analysis->sharpness >= TERRACED && analysis->grain > 0;
  return stairs || terraces || analysis->grain >= GRAINY ? SIGMA : 0;
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
  if (hl_data_is_named(volume, analysis))
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "a label map cannot be smoothed: its numbers are names and have no mean: show its labels, "
                   "which are smooth");
  if (volume->pages != NULL && !hl_volume_is_in_memory(volume))
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
    (*smoothed)->smoothing = hl_hypot(sigma, volume->smoothing);
    status = hl_volume_keep_unsmoothed(*smoothed, volume, error);
    /* The smoothed volume keeps the analysis of the unsmoothed one, because smoothing removes the noise by
     * which scans are told from fields. A smoothed mask has more than two values. */
    analysis.is_mask = false;
    if (status == HL_OK) status = hl_data_keep(*smoothed, &analysis, error);
    if (status != HL_OK) {
      hl_volume_release(*smoothed);
      *smoothed = NULL;
      return status;
    }
  }
  atomic_store(&(*smoothed)->smoothing_chosen, true);
  return HL_OK;
}
