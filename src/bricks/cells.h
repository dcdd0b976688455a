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

/* The lattice goes beyond the mesh's box by this number of points at each end of an axis. */
enum { HL_CELLS_MARGIN = 2 };

/* The field without the mesh's walls, and the walls. */
typedef struct hl_cells_wall {
  hl_bricks bricks; /* the field, continued from each wall outwards by the values of the cell at the wall */
  /* Owned; [z][y][x]; for each lattice point of level 0, the distance d to the nearest wall, in spacings of
   * level 0, positive inside: 65535 (d + HL_WALL_OUTSIDE) / (HL_WALL_OUTSIDE + HL_WALL_INSIDE), clamped. Null
   * if memory has no room for the walls; the field has no bricks then */
  uint16_t *depth;
} hl_cells_wall;

enum { HL_WALL_OUTSIDE = 3, HL_WALL_INSIDE = 2 };

/* Makes the field. Corners must be below point_count. Voxels are the lattice points of level 0 within the
 * mesh's box. The finest spacing is made coarser if bricks would need more than a quarter of the context's
 * memory limit, or more than 2^30 bytes. A warning then tells this. *bricks and *wall are empty on failure.
 * subject: starts error lines. */
hl_status hl_cells_build(hl_context *context, hl_pool *pool, const hl_cells *cells, const char *subject,
                         hl_bricks *bricks, hl_cells_wall *wall, hl_cells_place *place, hl_error *error);
void hl_cells_wall_release(hl_context *context, hl_cells_wall *wall);

#endif
