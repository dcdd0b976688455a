/* mesh/unstructured.h - converts the visible cells of VTK's unstructured grids to cells of PolyData.
 *
 * Vertices, lines and faces keep their kind. A face of a cell with a volume is kept if no other cell has the
 * same face. Quadratic cells count by their corners alone. */
#ifndef HL_MESH_UNSTRUCTURED_H
#define HL_MESH_UNSTRUCTURED_H

#include "mesh/polydata.h"

/* The cells of a grid. */
typedef struct unstructured_cells {
  double *ends, *types; /* owned; [count]; the end of each cell's points, and each cell's type */
  double *points;       /* owned; [point_count] */
  size_t count, point_count;
} unstructured_cells;

/* Fills the cells of `data`, which must be empty and whose points must be known. Sets *sources, owned by the
 * caller: for each of the cells, kind after kind, the grid's cell from which it comes. */
hl_status hl_unstructured_convert(const unstructured_cells *grid, polydata *data, size_t **sources,
                                  hl_error *error);

void hl_unstructured_release(hl_context *context, unstructured_cells *grid);

#endif
