/* bricks/cell_shapes.c - see cell_shapes.h. */
#include "bricks/cell_shapes.h"

#include <math.h>

int hl_cell_corner_count(const hl_cell *cell) { return cell->corner[4] == UINT32_MAX ? 4 : 8; }

bool hl_cells_shape_in_world(const hl_cells *cells, size_t n, hl_cell_shape *shape) {
  const hl_cell *cell = &cells->cells[n];
  shape->is_tetrahedron = hl_cell_corner_count(cell) == 4;
  for (int c = 0; c < hl_cell_corner_count(cell); c++) {
    if (!isfinite(cells->values[cell->corner[c]])) return false;
    for (int axis = 0; axis < 3; axis++) {
      shape->corner[c][axis] = cells->points[3 * (size_t)cell->corner[c] + (size_t)axis];
      if (!isfinite(shape->corner[c][axis])) return false;
    }
  }
  return hl_cell_shape_ready(shape);
}

bool hl_cells_shape(const hl_cells *cells, const hl_cells_place *place, size_t n, hl_cell_shape *shape) {
  if (!hl_cells_shape_in_world(cells, n, shape)) return false;
  for (int c = 0; c < (shape->is_tetrahedron ? 4 : 8); c++)
    for (int axis = 0; axis < 3; axis++)
      shape->corner[c][axis] = (shape->corner[c][axis] - place->origin[axis]) / place->spacing[axis];
  return hl_cell_shape_ready(shape);
}
