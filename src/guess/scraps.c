/* guess/scraps.c - see scraps.h. */
#include "guess/scraps.h"

#include <math.h>

#include "volume/scraps.h"

/* A body is a scrap if it has fewer voxels than this fraction of the largest body's voxels. */
#define LEAST (1.0 / 500)
/* The greatest fraction of all bodies' voxels that may be scraps. If small bodies have more of the voxels,
 * the small bodies are the scanned object itself: gravel, foam, cells. */
#define SHARE 0.05
/* Matter is firm beyond this fraction of the way from the value of the faintest visible matter to the value
 * of solid matter. */
#define RIM 0.35

/* The value at which the function begins to show matter; NAN if it has no such value. */
static double find_faint(const hl_transfer_function *function, double direction) {
  const size_t count = function->opacity_count;
  for (size_t p = 0; p + 1 < count; p++) {
    const size_t at = direction > 0 ? p : count - 1 - p, next = direction > 0 ? at + 1 : at - 1;
    if (function->opacity[at].opacity > 0) return NAN;
    if (function->opacity[next].opacity > 0) return function->opacity[at].value;
  }
  return NAN;
}

/* The value from which on matter is firm. Vessels thin out until only faint matter is left, so that all
 * visible matter of vessels counts as firm. */
static double find_firm(const hl_data_analysis *analysis, double faint) {
  const double solid = analysis->background + analysis->direction * analysis->solid;
  return analysis->vessels > 0 ? faint : faint + RIM * (solid - faint);
}

hl_status hl_scraps_choose(const hl_scene_volume *volume, const hl_data_analysis *analysis,
                           hl_scene_volume *shown, hl_error *error) {
  /* values without any noise were computed, not scanned, so that every body is there on purpose */
  if (analysis->kind != HL_DATA_SURFACES || !(analysis->grain > 0) || !hl_scraps_apply(volume->volume))
    return HL_OK;
  hl_scraps_rule chosen = {.least = LEAST};
  chosen.faint = find_faint(&volume->transfer_function, analysis->direction);
  chosen.firm = find_firm(analysis, chosen.faint);
  if (!isfinite(chosen.faint) || analysis->direction * (chosen.firm - chosen.faint) < 0) return HL_OK;
  hl_scraps scraps;
  hl_status status = hl_scraps_hide(volume->volume, &chosen, &scraps, error);
  if (status != HL_OK) return status;
  hl_volume_release(scraps.volume);
  if (scraps.bodies == 0 || scraps.share > SHARE) return HL_OK;
  shown->scraps_faint = chosen.faint;
  shown->scraps_firm = chosen.firm;
  shown->scraps_least = chosen.least;
  return HL_OK;
}
