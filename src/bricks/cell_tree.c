/* bricks/cell_tree.c - see cell_tree.h. */
#include "bricks/cell_tree.h"

#include <math.h>

#include "core/context.h"
#include "core/memory.h"

enum { CELLS_OF_A_LEAF = 6, DEPTH_MOST = 30 };

static float middle(const hl_cell_box *box, int axis) { return box->low[axis] + box->high[axis]; }

/* The cells of node `n` of a level are order[begin .. end). */
static size_t range_begin(const hl_cell_tree *tree, int level, size_t n) {
  /* the product n count does not overflow, because counts are below 2^32 */
  return (size_t)(((uint64_t)n * (uint64_t)tree->count) >> level);
}

/* Orders cells so that no cell before `nth` has a greater middle than the cell at `nth`, and no cell after it
 * has a smaller one (Hoare's selection). */
static void select_nth(const hl_cell_tree *tree, size_t begin, size_t end, size_t nth, int axis) {
  uint32_t *order = tree->order;
  while (end - begin > 1) {
    float pivot = middle(&tree->boxes[order[begin + (end - 1 - begin) / 2]], axis);
    size_t i = begin, j = end - 1;
    for (;;) {
      while (middle(&tree->boxes[order[i]], axis) < pivot) i++;
      while (middle(&tree->boxes[order[j]], axis) > pivot) j--;
      if (i >= j) break;
      uint32_t other = order[i];
      order[i++] = order[j];
      order[j--] = other;
    }
    if (nth <= j) end = j + 1;
    else begin = j + 1;
  }
}

static void grow(hl_cell_box *box, const hl_cell_box *by) {
  for (int axis = 0; axis < 3; axis++) {
    if (by->low[axis] < box->low[axis]) box->low[axis] = by->low[axis];
    if (by->high[axis] > box->high[axis]) box->high[axis] = by->high[axis];
  }
}

static const hl_cell_box nothing = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};

/* Splits the cells of every node of a level at the middle of their widest axis. */
static void split_level(const hl_cell_tree *tree, int level) {
  for (size_t n = 0; n < (size_t)1 << level; n++) {
    size_t begin = range_begin(tree, level, n), end = range_begin(tree, level, n + 1);
    hl_cell_box middles = nothing;
    int widest = 0;
    for (size_t c = begin; c < end; c++) {
      const hl_cell_box *box = &tree->boxes[tree->order[c]];
      hl_cell_box point;
      for (int axis = 0; axis < 3; axis++) point.low[axis] = point.high[axis] = middle(box, axis);
      grow(&middles, &point);
    }
    for (int axis = 1; axis < 3; axis++)
      if (middles.high[axis] - middles.low[axis] > middles.high[widest] - middles.low[widest]) widest = axis;
    if (end - begin > 1) select_nth(tree, begin, end, range_begin(tree, level + 1, 2 * n + 1), widest);
  }
}

static void bound_nodes(const hl_cell_tree *tree) {
  size_t last = (size_t)1 << tree->depth;
  for (size_t n = 0; n < last; n++) {
    hl_cell_box *node = &tree->nodes[last + n];
    *node = nothing;
    for (size_t c = range_begin(tree, tree->depth, n); c < range_begin(tree, tree->depth, n + 1); c++)
      grow(node, &tree->boxes[tree->order[c]]);
  }
  for (size_t n = last - 1; n >= 1; n--) {
    tree->nodes[n] = tree->nodes[2 * n];
    grow(&tree->nodes[n], &tree->nodes[2 * n + 1]);
  }
}

hl_status hl_cell_tree_make(hl_context *context, hl_cell_box *boxes, size_t count, const char *subject,
                            hl_cell_tree *tree, hl_error *error) {
  *tree = (hl_cell_tree){.boxes = boxes, .count = count};
  while (tree->depth < DEPTH_MOST && count >> tree->depth > CELLS_OF_A_LEAF) tree->depth++;
  tree->nodes = hl_allocate(context, (size_t)2 << tree->depth, sizeof *tree->nodes);
  tree->order = hl_allocate(context, count, sizeof *tree->order);
  if (tree->nodes == NULL || tree->order == NULL) {
    hl_cell_tree_release(context, tree);
    return hl_fail_memory(error, (sizeof *tree->nodes << tree->depth) + count * sizeof *tree->order, subject);
  }
  for (size_t n = 0; n < count; n++) tree->order[n] = (uint32_t)n;
  for (int level = 0; level < tree->depth; level++) {
    if (hl_cancelled(context)) {
      hl_cell_tree_release(context, tree);
      return hl_fail(error, HL_ERROR_CANCELLED, "%s: cancelled", subject);
    }
    split_level(tree, level);
  }
  bound_nodes(tree);
  return HL_OK;
}

void hl_cell_tree_release(hl_context *context, hl_cell_tree *tree) {
  hl_release(context, tree->nodes);
  hl_release(context, tree->order);
  hl_release(context, tree->boxes);
  *tree = (hl_cell_tree){.count = 0};
}

static bool meets(const hl_cell_box *box, const double low[3], const double high[3]) {
  for (int axis = 0; axis < 3; axis++)
    if ((double)box->low[axis] > high[axis] || (double)box->high[axis] < low[axis]) return false;
  return true;
}

void hl_cell_tree_visit(const hl_cell_tree *tree, const double low[3], const double high[3],
                        bool (*visit)(void *data, uint32_t cell), void *data) {
  size_t stack[DEPTH_MOST + 2], last = (size_t)1 << tree->depth;
  int waiting = 0;
  stack[waiting++] = 1;
  while (waiting > 0) {
    size_t n = stack[--waiting];
    if (!meets(&tree->nodes[n], low, high)) continue;
    if (n < last) {
      stack[waiting++] = 2 * n + 1;
      stack[waiting++] = 2 * n;
      continue;
    }
    for (size_t c = range_begin(tree, tree->depth, n - last);
         c < range_begin(tree, tree->depth, n - last + 1); c++)
      if (meets(&tree->boxes[tree->order[c]], low, high) && !visit(data, tree->order[c])) return;
  }
}
