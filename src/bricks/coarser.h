/* bricks/coarser.h - makes a field in bricks without its finest level, for pictures that cannot show this
 * level. */
#ifndef HL_BRICKS_COARSER_H
#define HL_BRICKS_COARSER_H

#include "bricks/build.h"

/* Makes a field on a lattice of twice the spacing. Level l + 1 of `bricks` becomes level l of the new field,
 * with the same coefficients. Bricks of level 0 are replaced: their new coefficients are the old field's
 * values at every second point. Point p of the new lattice stands at point 2 p of the old one. The new origin
 * puts each voxel of the new volume into the middle of 2x2x2 voxels of the old one. is_continued: whether the
 * field ends with its known coefficients beyond the places that are shown. The new field then goes as far,
 * counted in its own spacings. subject: starts error lines. *coarser is empty on failure; owned by the caller
 * (hl_bricks_release). */
hl_status hl_bricks_make_coarser(hl_context *context, hl_pool *pool, const hl_bricks *bricks,
                                 bool is_continued, const char *subject, hl_bricks *coarser, hl_error *error);

#endif
