/* grid/value_pages.h - keeps the values that a grid samples for a volume larger than memory: voxels whose
 * non-finite values are replaced, or the coefficients of the interpolating kernel.
 *
 * For a volume in memory, make_grid.c copies these values to an array. For a volume larger than memory, this
 * file stores them in further pages (volume/store/pages.h), in a scratch file or over ranks. The values in
 * the further pages have the same bits as a copy in memory would have. */
#ifndef HL_GRID_VALUE_PAGES_H
#define HL_GRID_VALUE_PAGES_H

#include "core/pool.h"
#include "grid/kernel.h"
#include "volume/store/pages.h"

/* Makes the pages. volume: must have pages. empty: replaces values that are not finite. *pages: owned by the
 * caller. If several ranks share the volume, all ranks must make this call, and all must release the pages.
 * Coefficients need ranks that hold whole slices, in the order of the ranks; else the call fails. */
hl_status hl_value_pages_create(hl_pool *pool, const hl_volume *volume, const kernel *kernel, float empty,
                                hl_pages **pages, hl_error *error);

#endif
