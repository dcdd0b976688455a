/* bricks/cell_shapes.h - describes a mesh of cells with values, and the shapes of its cells in the world and
 * in a lattice. */
#ifndef HL_BRICKS_CELL_SHAPES_H
#define HL_BRICKS_CELL_SHAPES_H

#include <stddef.h>
#include <stdint.h>

#include "bricks/inverse.h"

enum { HL_CELL_CORNERS = 8 };

/* A cell, as numbers of points. Hexahedra have eight corners in VTK's order: four around one face, and the
 * four opposite to them. Wedges and pyramids are hexahedra that name corners twice. Tetrahedra have four
 * corners, and corner[4] is UINT32_MAX. */
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

/* The place of a field's lattice: point i of level 0 is at origin + spacing * i along each axis. */
typedef struct hl_cells_place {
  double origin[3], spacing[3];
  double error; /* the greatest difference between the field and the mesh's values, in the units of the
                 * values. It holds where all coefficients on which the field depends lie within cells
                 * (cell_bound.h). NaN: there is no such place */
} hl_cells_place;

/* 4 of a tetrahedron, else 8. */
int hl_cell_corner_count(const hl_cell *cell);

/* A cell's shape in the world. Returns false if the cell has no volume or a corner without a value. */
bool hl_cells_shape_in_world(const hl_cells *cells, size_t n, hl_cell_shape *shape);

/* A cell's shape in lattice coordinates of level 0. Returns false as hl_cells_shape_in_world() does. */
bool hl_cells_shape(const hl_cells *cells, const hl_cells_place *place, size_t n, hl_cell_shape *shape);

#endif
