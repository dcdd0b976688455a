/* bricks/cell_bound.h - finds a bound of the difference between a field in bricks and the mesh of cells from
 * which it was sampled.
 *
 * In:  the mesh, and the field that cells.c made of it. Out: a number that the difference exceeds nowhere. */
#ifndef HL_BRICKS_CELL_BOUND_H
#define HL_BRICKS_CELL_BOUND_H

#include "bricks/build.h"
#include "bricks/cell_shapes.h"
#include "bricks/cell_tree.h"

/* A field and its source. All arrays are borrowed. */
typedef struct hl_cell_mesh_field {
  const hl_cells *cells;
  const hl_cell_tree *tree;
  const hl_cells_place *place;
  const hl_bricks_leaf *leaves; /* [leaf_count] */
  size_t leaf_count;
  const hl_bricks *bricks;
} hl_cell_mesh_field;

/* Finds the bound. It holds at all places in cells of the tree, except in lattice cells that have a NaN among
 * their coefficients: the field ends there, because a coefficient is NaN where its point lies outside of the
 * mesh. *bound is NaN if all lattice cells have such a coefficient. The bound is the same for any number of
 * threads. subject: starts error lines. */
hl_status hl_cell_mesh_bound(hl_context *context, hl_pool *pool, const hl_cell_mesh_field *field,
                             const char *subject, double *bound, hl_error *error);

#endif
