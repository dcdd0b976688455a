/* guess/smoothing.h - chooses which volumes are smoothed by default. */
#ifndef HL_GUESS_SMOOTHING_H
#define HL_GUESS_SMOOTHING_H

#include "guess/analysis.h"

/* The standard deviation, in voxels, of the Gaussian that smooths a bare volume of a file by default; 0 if
 * the volume is not smoothed. */
double hl_smoothing_for(const hl_volume *volume, const char *file, const hl_data_analysis *analysis);

#endif
