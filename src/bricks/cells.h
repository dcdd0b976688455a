/* bricks/cells.h - meshes of cells with a volume (tetrahedra, hexahedra and what collapses from them), as a
 * field at levels.
 *
 * Within a cell, values are interpolated between its corners: linearly in tetrahedra, trilinearly in others.
 * The field's coefficients are these values at lattice points, whose spacing is about half of a cell's edge,
 * so that small cells get finer bricks. Outside of all cells the field is NaN.
 *
 * In:  points, their values, and cells by their corners (readers of files, arrays of callers).
 * Out: hl_bricks, where they stand in the world, and how far the field is from the mesh's values. */
#ifndef HL_BRICKS_CELLS_H
#define HL_BRICKS_CELLS_H

#include "bricks/build.h"

enum { HL_CELL_CORNERS = 8 };

/* A cell. Hexahedra have eight corners in VTK's order: four around one face, and the four opposite to them.
 * Wedges and pyramids are hexahedra that name corners twice. Tetrahedra have four, and UINT32_MAX as their
 * fifth. */
typedef struct hl_cell {
  uint32_t corner[HL_CELL_CORNERS];
} hl_cell;

typedef struct hl_cells {
  const double *points; /* borrowed; [point_count][3]; world */
  const float *values;  /* borrowed; [point_count]; NaN where there is no value: cells there are left out */
  size_t point_count;
  const hl_cell *cells; /* borrowed; [cell_count] */
  size_t cell_count;
} hl_cells;

/* Where a field's lattice stands: point i of level 0 is at origin + spacing * i along each axis. */
typedef struct hl_cells_place {
  double origin[3], spacing[3];
  double error; /* the greatest difference of the field and the mesh's value at a lattice point whose
                 * neighbours all lie within cells; in the units of the values */
} hl_cells_place;

/* Makes the field. Corners must be below point_count. Voxels are the lattice points of level 0. The finest
 * spacing is made coarser where bricks would need more than a quarter of the context's memory limit, or 2^30
 * bytes, and a warning tells. *bricks is empty on failure. subject: starts error lines. */
hl_status hl_cells_build(hl_context *context, hl_pool *pool, const hl_cells *cells, const char *subject,
                         hl_bricks *bricks, hl_cells_place *place, hl_error *error);

#endif
