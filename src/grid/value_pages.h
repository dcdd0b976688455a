/* grid/value_pages.h - what a grid makes of the voxels of a volume larger than memory: with every non-finite
 * one replaced, or as the coefficients of the interpolating kernel.
 *
 * In memory these are a copy (make_grid.c). Here they are pages of their own (volume/pages.h): in a scratch
 * file, or of a volume over ranks. Their values are those of the copy, to the bit. */
#ifndef HL_GRID_VALUE_PAGES_H
#define HL_GRID_VALUE_PAGES_H

#include "core/pool.h"
#include "grid/kernel.h"
#include "volume/pages.h"

/* volume: with pages. empty: takes the place of what is not finite. *pages: owned by the caller. Over ranks
 * collective, as is the release; coefficients are refused there unless each rank holds whole slices, in the
 * order of the ranks. */
hl_status hl_value_pages_create(hl_pool *pool, const hl_volume *volume, const kernel *kernel, float empty,
                                hl_pages **pages, hl_error *error);

#endif
