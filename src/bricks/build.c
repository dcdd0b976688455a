/* bricks/build.c - hl_bricks_build(): finds the coefficients of each brick of a field.
 *
 * A brick's coefficients that are not active are subdivided from the coefficients of the next coarser level,
 * which are found by the same rule. So each brick is made by itself, from the source alone, and the order of
 * the bricks does not matter. */
#include "bricks/build.h"

#include <string.h>

#include "bricks/subdivide.h"
#include "core/context.h"
#include "core/memory.h"

enum {
  SHIFT_LEAST = 2,
  SHIFT_MOST = 8,
  ACTIVE_CELLS = 4, /* coefficient i depends on this many cells along an axis: i - 2 .. i + 1 */
  CELLS_BEFORE = 2
};

typedef struct builder {
  const hl_bricks_source *source;
  const hl_bricks_leaf *leaves;
  hl_bricks *bricks; /* the bricks, with a filled directory; the pool has room for the coefficients of each
                      * leaf */
  hl_pool *pool;
  float *scratch; /* owned; [threads][scratch_floats] */
  size_t scratch_floats;
  bool *is_constant; /* owned; [leaves] */
} builder;

/* ---- which coefficients are active ---- */

/* Returns whether a block of a level is covered by a brick that is coarser than this level. */
static bool is_coarser(const hl_bricks *bricks, int level, const ptrdiff_t block[3]) {
  size_t at[3];
  for (int axis = 0; axis < 3; axis++) {
    if (block[axis] < 0) return false;
    at[axis] = (size_t)block[axis] << level;
    if (at[axis] >= bricks->directory_size[axis]) return false;
  }
  const size_t *n = bricks->directory_size;
  return bricks->directory[(at[2] * n[1] + at[1]) * n[0] + at[0]].level > level;
}

/* The box of all cells on which the coefficients of a box depend, and which decide whether these are
 * active. */
static hl_lattice_box cells_of(const hl_lattice_box *box) {
  hl_lattice_box cells;
  for (int axis = 0; axis < 3; axis++) {
    cells.first[axis] = box->first[axis] - CELLS_BEFORE;
    cells.count[axis] = box->count[axis] + ACTIVE_CELLS - 1;
  }
  return cells;
}

/* Clears the cells of a box that lie in one block. */
static void clear_block(const hl_lattice_box *cells, const ptrdiff_t block[3], int shift,
                        unsigned char *own) {
  size_t low[3], high[3];
  for (int axis = 0; axis < 3; axis++) {
    ptrdiff_t first = block[axis] * ((ptrdiff_t)1 << shift) - cells->first[axis],
              end = first + ((ptrdiff_t)1 << shift);
    low[axis] = first > 0 ? (size_t)first : 0;
    high[axis] = (size_t)end < cells->count[axis] ? (size_t)end : cells->count[axis];
  }
  for (size_t k = low[2]; k < high[2]; k++)
    for (size_t j = low[1]; j < high[1]; j++)
      memset(own + (k * cells->count[1] + j) * cells->count[0] + low[0], 0, high[0] - low[0]);
}

/* Clears the cells of a level that bricks of coarser levels cover. */
static void clear_coarser(const hl_bricks *bricks, int level, const hl_lattice_box *cells,
                          unsigned char *own) {
  ptrdiff_t first[3], last[3], block[3];
  for (int axis = 0; axis < 3; axis++) {
    first[axis] = cells->first[axis] >> bricks->shift;
    last[axis] = (cells->first[axis] + (ptrdiff_t)cells->count[axis] - 1) >> bricks->shift;
  }
  for (block[2] = first[2]; block[2] <= last[2]; block[2]++)
    for (block[1] = first[1]; block[1] <= last[1]; block[1]++)
      for (block[0] = first[0]; block[0] <= last[0]; block[0]++)
        if (is_coarser(bricks, level, block)) clear_block(cells, block, bricks->shift, own);
}

/* Turns cells into coefficients along one axis: a coefficient is active if its four cells are set. Neighbours
 * along the axis are `step` apart, and the result overwrites the cells. */
static void combine(unsigned char *own, size_t count, size_t step) {
  for (size_t n = 0; n < count; n++) own[n] = own[n] & own[n + step] & own[n + 2 * step] & own[n + 3 * step];
}

/* The answers of find_active(): none, some or all coefficients of a box are active. own: scratch memory of
 * one byte for each cell of cells_of(box). In the case ACTIVE_SOME, own[(k * cells.count[1] + j) *
 * cells.count[0] + i] becomes 1 if coefficient (i, j, k) of the box is active, else 0. */
typedef enum active_part { ACTIVE_NONE, ACTIVE_SOME, ACTIVE_ALL } active_part;

static active_part find_active(const builder *b, int level, const hl_lattice_box *box, unsigned char *own) {
  const hl_bricks_source *source = b->source;
  const hl_lattice_box cells = cells_of(box);
  const size_t *m = cells.count, *n = box->count;
  size_t count = hl_lattice_points(&cells), row = m[0], slice = m[0] * m[1], active = 0;
  if (level + 1 == source->levels) return ACTIVE_ALL;
  if (source->cover != NULL) source->cover(source->data, level, cells.first, cells.count, own);
  else memset(own, 1, count);
  clear_coarser(b->bricks, level, &cells, own);
  if (memchr(own, 0, count) == NULL) return ACTIVE_ALL;
  combine(own, count - 3, 1);
  combine(own, count - 3 - 3 * row, row);
  combine(own, count - 3 - 3 * row - 3 * slice, slice);
  for (size_t k = 0; k < n[2]; k++)
    for (size_t j = 0; j < n[1]; j++)
      for (size_t i = 0; i < n[0]; i++) active += own[k * slice + j * row + i];
  return active == 0 ? ACTIVE_NONE : active == hl_lattice_points(box) ? ACTIVE_ALL : ACTIVE_SOME;
}

/* ---- assembling ---- */

/* The size of find_active()'s scratch memory `own`, counted in floats although it holds bytes. */
static size_t mask_floats(const hl_lattice_box *box) {
  const hl_lattice_box cells = cells_of(box);
  return hl_lattice_points(&cells) / sizeof(float) + 1;
}

/* The most floats of scratch memory that assemble() takes for a box. */
static size_t scratch_of(hl_lattice_box box, int levels) {
  size_t sum = 0;
  for (int level = 0; level < levels; level++) {
    /* A box that begins at an even point needs the most memory. */
    for (int axis = 0; axis < 3; axis++) box.first[axis] &= ~(ptrdiff_t)1;
    for (int axis = 0; axis < 3; axis++) box.count[axis] |= 1;
    hl_lattice_box coarse = hl_subdivision_source(&box);
    sum += mask_floats(&box) + hl_lattice_points(&coarse) + hl_lattice_points(&box) +
           hl_subdivision_scratch(&box);
    box = coarse;
  }
  return sum;
}

/* Fills a box of coefficients of a level. */
static void assemble(const builder *b, int level, const hl_lattice_box *box, float *scratch, float *out) {
  const hl_bricks_source *source = b->source;
  const hl_lattice_box cells = cells_of(box), coarse_box = hl_subdivision_source(box);
  unsigned char *own = (unsigned char *)scratch;
  scratch += mask_floats(box);
  active_part part = find_active(b, level, box, own);
  if (part == ACTIVE_ALL) {
    source->fill(source->data, level, box->first, box->count, out);
    return;
  }
  float *coarse = scratch, *subdivided = coarse + hl_lattice_points(&coarse_box),
        *further = subdivided + hl_lattice_points(box);
  assemble(b, level + 1, &coarse_box, further, coarse);
  hl_subdivide(box, coarse, further, part == ACTIVE_NONE ? out : subdivided);
  if (part == ACTIVE_NONE) return;
  source->fill(source->data, level, box->first, box->count, out);
  size_t n = 0;
  for (size_t k = 0; k < box->count[2]; k++)
    for (size_t j = 0; j < box->count[1]; j++)
      for (size_t i = 0; i < box->count[0]; i++, n++)
        if (!own[(k * cells.count[1] + j) * cells.count[0] + i]) out[n] = subdivided[n];
}

static hl_lattice_box box_of(const hl_bricks_leaf *leaf, int shift) {
  hl_lattice_box box;
  for (int axis = 0; axis < 3; axis++) {
    box.first[axis] = ((ptrdiff_t)leaf->brick[axis] << shift) - 1;
    box.count[axis] = ((size_t)1 << shift) + BRICK_MARGIN;
  }
  return box;
}

static void make_brick(void *data, size_t index, int worker) {
  const builder *b = data;
  const hl_bricks_leaf *leaf = &b->leaves[index];
  hl_lattice_box box = box_of(leaf, b->bricks->shift);
  size_t count = hl_lattice_points(&box);
  float *out = b->bricks->pool + index * count;
  assemble(b, leaf->level, &box, b->scratch + (size_t)worker * b->scratch_floats, out);
  bool same = true;
  for (size_t n = 1; n < count && same; n++)
    same = out[n] == out[0] || (out[n] != out[n] && out[0] != out[0]);
  b->is_constant[index] = same;
}

/* ---- the directory ---- */

static hl_status fail_leaf(const hl_bricks_leaf *leaf, const char *subject, const char *what,
                           hl_error *error) {
  return hl_fail(error, HL_ERROR_INPUT, "%s: the brick %zu, %zu, %zu of level %d %s", subject, leaf->brick[0],
                 leaf->brick[1], leaf->brick[2], leaf->level, what);
}

/* The blocks of the directory that a leaf covers. blocks_of() returns false if the leaf lies outside of the
 * directory. */
typedef struct leaf_blocks {
  size_t low[3], high[3]; /* blocks low .. high - 1 */
} leaf_blocks;

static bool blocks_of(const hl_bricks *bricks, const hl_bricks_leaf *leaf, leaf_blocks *blocks) {
  for (int axis = 0; axis < 3; axis++) {
    size_t n = bricks->directory_size[axis];
    if (leaf->brick[axis] > (n - 1) >> leaf->level) return false;
    blocks->low[axis] = leaf->brick[axis] << leaf->level;
    size_t high = blocks->low[axis] + ((size_t)1 << leaf->level);
    blocks->high[axis] = high < n ? high : n;
  }
  return true;
}

/* Writes a leaf's entry into its blocks. first: fails if another leaf has one of them. */
static bool set_entries(hl_bricks *bricks, const leaf_blocks *blocks, hl_brick_entry entry, bool first) {
  const size_t *n = bricks->directory_size;
  for (size_t k = blocks->low[2]; k < blocks->high[2]; k++)
    for (size_t j = blocks->low[1]; j < blocks->high[1]; j++)
      for (size_t i = blocks->low[0]; i < blocks->high[0]; i++) {
        hl_brick_entry *at = &bricks->directory[(k * n[1] + j) * n[0] + i];
        if (first && at->slot >= 0) return false;
        *at = entry;
      }
  return true;
}

static hl_status fill_directory(const builder *b, size_t count, const char *subject, hl_error *error) {
  for (size_t n = 0; n < count; n++) {
    leaf_blocks blocks;
    const hl_bricks_leaf *leaf = &b->leaves[n];
    if (leaf->level < 0 || leaf->level >= b->bricks->levels || !blocks_of(b->bricks, leaf, &blocks))
      return fail_leaf(leaf, subject, "lies outside the field", error);
    if (!set_entries(b->bricks, &blocks, (hl_brick_entry){(int32_t)n, leaf->level, 0}, true))
      return fail_leaf(leaf, subject, "lies where another brick is", error);
  }
  return HL_OK;
}

static hl_status make_directory(hl_context *context, const hl_bricks_source *source, const char *subject,
                                hl_bricks *bricks, hl_error *error) {
  bool sound = source->shift >= SHIFT_LEAST && source->shift <= SHIFT_MOST && source->levels >= 1 &&
               source->levels <= BRICK_LEVELS_LIMIT;
  size_t blocks = 1;
  *bricks = (hl_bricks){.shift = source->shift, .levels = source->levels};
  for (int axis = 0; axis < 3 && sound; axis++) {
    sound = source->dimension[axis] >= 1 && source->dimension[axis] <= INT32_MAX;
    if (!sound) break;
    bricks->dimension[axis] = source->dimension[axis];
    bricks->directory_size[axis] = ((source->dimension[axis] - 1) >> source->shift) + 1;
    sound = hl_multiply(blocks, bricks->directory_size[axis], &blocks);
  }
  if (!sound)
    return hl_fail(error, HL_ERROR_INPUT,
                   "%s: the field has %zu x %zu x %zu points in %d levels of bricks: "
                   "levels are 1 to %d",
                   subject, source->dimension[0], source->dimension[1], source->dimension[2], source->levels,
                   BRICK_LEVELS_LIMIT);
  bricks->directory = hl_allocate(context, blocks, sizeof *bricks->directory);
  if (bricks->directory == NULL)
    return hl_fail_memory(
        error, blocks > SIZE_MAX / sizeof *bricks->directory ? SIZE_MAX : blocks * sizeof *bricks->directory,
        subject);
  for (size_t n = 0; n < blocks; n++) bricks->directory[n] = (hl_brick_entry){-1, 0, source->outside};
  return HL_OK;
}

/* ---- all steps together ---- */

/* Turns bricks of equal coefficients into constants of the directory, and closes the gaps that they leave in
 * the pool. */
static void keep_bricks(const builder *b, size_t count) {
  hl_bricks *bricks = b->bricks;
  size_t points = brick_points(bricks->shift);
  bricks->slots = 0;
  for (size_t n = 0; n < count; n++) {
    leaf_blocks blocks = {.low = {0}};
    hl_brick_entry entry = {-1, b->leaves[n].level, bricks->pool[n * points]};
    if (!b->is_constant[n]) {
      entry = (hl_brick_entry){(int32_t)bricks->slots, b->leaves[n].level, 0};
      if (bricks->slots != n)
        memcpy(bricks->pool + bricks->slots * points, bricks->pool + n * points,
               points * sizeof *bricks->pool);
      bricks->slots++;
    }
    blocks_of(bricks, &b->leaves[n], &blocks);
    set_entries(bricks, &blocks, entry, false);
  }
}

static hl_status make_bricks(hl_context *context, builder *b, size_t count, const char *subject,
                             hl_error *error) {
  hl_bricks *bricks = b->bricks;
  hl_bricks_leaf any = {.level = 0};
  size_t points = brick_points(bricks->shift), threads = (size_t)hl_pool_threads(b->pool), floats;
  b->scratch_floats = scratch_of(box_of(&any, bricks->shift), bricks->levels);
  if (count > INT32_MAX || !hl_multiply(count, points, &floats))
    return hl_fail_memory(error, SIZE_MAX, subject);
  bricks->pool = hl_allocate(context, floats, sizeof *bricks->pool);
  if (bricks->pool == NULL) return hl_fail_memory(error, floats * sizeof *bricks->pool, subject);
  b->scratch = hl_allocate(context, threads * b->scratch_floats, sizeof *b->scratch);
  b->is_constant = hl_allocate_zeroed(context, count, sizeof *b->is_constant);
  if (b->scratch == NULL || b->is_constant == NULL)
    return hl_fail_memory(error, threads * b->scratch_floats * sizeof *b->scratch, subject);
  hl_pool_run(b->pool, count, make_brick, b);
  if (hl_pool_cancelled(b->pool)) return hl_fail(error, HL_ERROR_CANCELLED, "%s: cancelled", subject);
  keep_bricks(b, count);
  if (bricks->slots == count) return HL_OK;
  float *kept = hl_reallocate(context, bricks->pool, bricks->slots * points, sizeof *kept);
  if (kept != NULL) bricks->pool = kept; /* without memory for a smaller copy, the pool keeps its size */
  return HL_OK;
}

hl_status hl_bricks_build(hl_context *context, hl_pool *pool, const hl_bricks_source *source,
                          const hl_bricks_leaf *leaves, size_t count, const char *subject, hl_bricks *bricks,
                          hl_error *error) {
  builder b = {.source = source, .leaves = leaves, .bricks = bricks, .pool = pool};
  hl_status status = make_directory(context, source, subject, bricks, error);
  if (status == HL_OK) status = fill_directory(&b, count, subject, error);
  if (status == HL_OK) status = make_bricks(context, &b, count, subject, error);
  hl_release(context, b.scratch);
  hl_release(context, b.is_constant);
  if (status != HL_OK) hl_bricks_release(context, bricks);
  return status;
}

void hl_bricks_release(hl_context *context, hl_bricks *bricks) {
  hl_release(context, bricks->directory);
  hl_release(context, bricks->pool);
  *bricks = (hl_bricks){.shift = 0};
}
