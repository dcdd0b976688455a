/* guess/holders.h - what holds a scanned object: tables, head rests, rails, towels. */
#ifndef HL_GUESS_HOLDERS_H
#define HL_GUESS_HOLDERS_H

#include "guess/analysis.h"
#include "scene/scene.h"

enum { HL_HOLDER_PLANES = 8 };

/* Finds planes that cut off what holds a scanned object, and nothing of the object: *count of them, in the
 * world of the volume's file; 0 where there is nothing of the kind, or in doubt. A holder is a body beside
 * the one that is nearly all that is seen; it reaches the border of the grid, is long and thin, holds no
 * matter as dense as the object's, and all of it lies beyond planes that touch the object's hull.
 * volume: with its transfer function. Fails for lack of memory alone. */
hl_status hl_holders_find(const hl_scene_volume *volume, const hl_data_analysis *analysis,
                          hl_cut planes[HL_HOLDER_PLANES], size_t *count, hl_error *error);

#endif
