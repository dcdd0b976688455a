/* guess/scraps.h - chooses whether a bare volume hides small bodies beside its object. */
#ifndef HL_GUESS_SCRAPS_H
#define HL_GUESS_SCRAPS_H

#include "guess/analysis.h"
#include "scene/scene.h"

/* Chooses the rule by which scraps of a scanned object are hidden (volume/scraps.h). If the volume has no
 * scraps, or if the small bodies have too much of the matter to count as scraps, `shown` does not change.
 * volume: with its transfer function. shown: the volume that gets the rule. Fails for lack of memory, or if
 * cancelled. */
hl_status hl_scraps_choose(const hl_scene_volume *volume, const hl_data_analysis *analysis,
                           hl_scene_volume *shown, hl_error *error);

#endif
