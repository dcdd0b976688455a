/* bricks/cells.h - meshes of cells with a volume (tetrahedra, hexahedra, and wedges and pyramids as collapsed
 * hexahedra), sampled to bricks of coefficients at several spacings.
 *
 * Within a cell, values are interpolated between its corners: linearly in tetrahedra, trilinearly in other
 * cells. The field's coefficients are these values at lattice points, whose spacing is about half of a cell's
 * edge, so that small cells get finer bricks. Outside of all cells the field is NaN.
 *
 * In:  points, their values, and cells by their corners (readers of files, arrays of callers). Out:
 * hl_bricks, the map from their lattice to the world, and the greatest difference between the field and the
 * mesh's values. */
#ifndef HL_BRICKS_CELLS_H
#define HL_BRICKS_CELLS_H

#include "bricks/build.h"
#include "bricks/cell_shapes.h"

/* Makes the field. Corners must be below point_count. Voxels are the lattice points of level 0. The finest
 * spacing is made coarser if bricks would need more than a quarter of the context's memory limit, or more
 * than 2^30 bytes. A warning then tells this. *bricks is empty on failure. subject: starts error lines. */
hl_status hl_cells_build(hl_context *context, hl_pool *pool, const hl_cells *cells, const char *subject,
                         hl_bricks *bricks, hl_cells_place *place, hl_error *error);

#endif
