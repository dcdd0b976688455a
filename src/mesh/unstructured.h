/* mesh/unstructured.h - converts the visible cells of VTK's unstructured grids to cells of PolyData.
 *
 * Vertices, lines and faces keep their kind. If a cell encloses a volume, the faces that it shares with no
 * other cell are kept. Quadratic cells are treated as linear cells: only their corners are used. */
#ifndef HL_MESH_UNSTRUCTURED_H
#define HL_MESH_UNSTRUCTURED_H

#include "mesh/polydata.h"

/* The cells of an unstructured grid. */
typedef struct unstructured_cells {
  /* owned; [count]; ends: for each cell, the index in `points` after its last point; types: the type of each
   * cell */
  double *ends, *types;
  double *points; /* owned; [point_count]; the points of all cells, as indices, one cell after the
                   * other */
  size_t count, point_count;
} unstructured_cells;

/* Fills the cells of `data`. `data` must have no cells yet, but must have its points. *sources, owned by the
 * caller: for each cell that was made, kind after kind, the index of the grid's cell from which it was
 * made. */
hl_status hl_unstructured_convert(const unstructured_cells *grid, polydata *data, size_t **sources,
                                  hl_error *error);

void hl_unstructured_release(hl_context *context, unstructured_cells *grid);

#endif
