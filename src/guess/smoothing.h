/* guess/smoothing.h - which volumes are smoothed without being asked for. */
#ifndef HL_GUESS_SMOOTHING_H
#define HL_GUESS_SMOOTHING_H

#include "guess/analysis.h"

/* The standard deviation, in voxels, by which a bare volume of a file is smoothed; 0: it is not smoothed. */
double hl_smoothing_for(const hl_volume *volume, const char *file, const hl_data_analysis *analysis);

#endif
