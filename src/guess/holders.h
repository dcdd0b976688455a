/* guess/holders.h - finds the holders of a scanned object: tables, head rests, rails, towels. */
#ifndef HL_GUESS_HOLDERS_H
#define HL_GUESS_HOLDERS_H

#include "guess/analysis.h"
#include "scene/scene.h"

enum { HL_HOLDER_PLANES = 24 };

/* Finds planes that cut off the holders of a scanned object, and nothing of the object: *count planes, in the
 * world of the volume's file; 0 if the volume has no holders, or in doubt. The object is nearly everything
 * that is seen, and a holder is a body beside it. A holder reaches the border of the grid, is long and thin,
 * has no matter as dense as the object's, and lies wholly beyond planes that touch the object's hull. volume:
 * with its transfer function. Fails only for lack of memory. */
hl_status hl_holders_find(const hl_scene_volume *volume, const hl_data_analysis *analysis,
                          hl_cut planes[HL_HOLDER_PLANES], size_t *count, hl_error *error);

#endif
