/* bricks/cell_tree.h - describes a tree of bounding boxes that finds the cells of a mesh which may meet a
 * box. */
#ifndef HL_BRICKS_CELL_TREE_H
#define HL_BRICKS_CELL_TREE_H

#include <stdbool.h>
#include <stdint.h>

#include "core/error.h"

typedef struct hl_cell_box {
  float low[3], high[3]; /* lattice coordinates of level 0, rounded outwards */
} hl_cell_box;

/* A balanced tree. Node 1 is the root, and the children of node n are 2 n and 2 n + 1. A node of the last
 * level holds the cells of its range of `order`. */
typedef struct hl_cell_tree {
  hl_cell_box *nodes; /* owned; [2^(depth + 1)] */
  uint32_t *order;    /* owned; [count]; cells, node after node */
  hl_cell_box *boxes; /* owned; [count]; box of each cell */
  size_t count;
  int depth;
} hl_cell_tree;

/* Makes the tree of `boxes`. It takes the array over, also on failure. */
hl_status hl_cell_tree_make(hl_context *context, hl_cell_box *boxes, size_t count, const char *subject,
                            hl_cell_tree *tree, hl_error *error);
void hl_cell_tree_release(hl_context *context, hl_cell_tree *tree);

/* Calls visit(data, cell) for each cell whose box meets the box low .. high, until visit returns false. The
 * cells always come in the same order. */
void hl_cell_tree_visit(const hl_cell_tree *tree, const double low[3], const double high[3],
                        bool (*visit)(void *data, uint32_t cell), void *data);

#endif
