/* bricks/cell_walls.h - finds the walls of a mesh of cells: the faces of cells behind which there is no other
 * cell. It also finds how far lattice points are from the walls.
 *
 * In:  the mesh and the tree of its cells. Out: the walls as triangles, and for lattice points the nearest
 * triangle and the signed distance to it. All coordinates are lattice coordinates of level 0. */
#ifndef HL_BRICKS_CELL_WALLS_H
#define HL_BRICKS_CELL_WALLS_H

#include "bricks/cell_shapes.h"
#include "bricks/cell_tree.h"

/* A triangle of a wall. */
typedef struct hl_cell_wall {
  double corner[3][3];
  double normal[3]; /* unit length; away from the cell */
  uint32_t cell;    /* the cell whose face the triangle is a part of */
} hl_cell_wall;

typedef struct hl_cell_walls {
  hl_cell_wall *walls; /* owned; [count] */
  size_t count;
  hl_cell_tree tree; /* owned; of the triangles' boxes */
} hl_cell_walls;

/* The wall nearest to a lattice point. */
typedef struct hl_wall_near {
  uint32_t wall;  /* index of the triangle; UINT32_MAX: no wall is within reach */
  double squared; /* square of the distance to the triangle */
  double above;   /* signed distance to the triangle's plane, positive outside of the cell. Where several
                   * triangles meet in the nearest point, it is the greatest in magnitude: its sign tells
                   * whether the lattice point lies inside the mesh */
} hl_wall_near;

/* Returns whether a cell of the mesh holds a point. tree: of the mesh's cells. besides: a cell that does not
 * count; UINT32_MAX: all count. */
bool hl_cells_hold(const hl_cells *cells, const hl_cell_tree *tree, const hl_cells_place *place,
                   const double point[3], uint32_t besides);

/* Finds the walls. tree: of the mesh's cells. A face counts as a wall if no cell lies at a small distance in
 * front of its middle. So the seams between pieces that repeat points, and faces that meet several smaller
 * ones, are no walls. Release the walls after a failure, too. */
hl_status hl_cell_walls_find(hl_context *context, const hl_cells *cells, const hl_cell_tree *tree,
                             const hl_cells_place *place, const char *subject, hl_cell_walls *found,
                             hl_error *error);
void hl_cell_walls_release(hl_context *context, hl_cell_walls *walls);

/* Finds the wall nearest to each of the points first .. first + count - 1 of a level, [z][y][x], if it is
 * nearer than `squared` was before. reach: the greatest root of a `squared` before. */
void hl_cell_walls_near(const hl_cell_walls *walls, int level, const ptrdiff_t first[3],
                        const size_t count[3], double reach, hl_wall_near *near);

#endif
