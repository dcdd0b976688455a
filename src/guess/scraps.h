/* guess/scraps.h - chooses whether a bare volume hides small bodies beside its object. */
#ifndef HL_GUESS_SCRAPS_H
#define HL_GUESS_SCRAPS_H

#include "guess/analysis.h"
#include "scene/scene.h"

/* Chooses the rule by which scraps of a scanned object are hidden (volume/scraps.h). If there are no scraps,
 * or if they are too much matter to be called so, `shown` stays as it is. volume: with its transfer
 * function. shown: the volume that gets the rule. Fails for lack of memory, or if cancelled. */
hl_status hl_scraps_choose(const hl_scene_volume *volume, const hl_data_analysis *analysis,
                           hl_scene_volume *shown, hl_error *error);

#endif
