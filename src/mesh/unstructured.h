/* mesh/unstructured.h - the cells of VTK's unstructured grids as those of PolyData: what is seen of them.
 *
 * Vertices, lines and faces stay what they are; of cells with a volume those faces are kept that no other
 * cell has, too. Of quadratic cells the corners are taken. */
#ifndef HL_MESH_UNSTRUCTURED_H
#define HL_MESH_UNSTRUCTURED_H

#include "mesh/polydata.h"

/* The cells of a grid. */
typedef struct unstructured_cells {
  double *ends, *types; /* owned; [count]: where each cell's points end, and its type */
  double *points;       /* owned; [point_count] */
  size_t count, point_count;
} unstructured_cells;

/* Fills the empty cells of `data`, whose points are known, and *sources: owned by the caller; for each of its
 * cells, kind after kind, the cell of the grid that it comes from. */
hl_status hl_unstructured_convert(const unstructured_cells *grid, polydata *data, size_t **sources,
                                  hl_error *error);

void hl_unstructured_release(hl_context *context, unstructured_cells *grid);

#endif
