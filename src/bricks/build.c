/* bricks/build.c - hl_bricks_build(): the coefficients of each brick.
 *
 * A brick's coefficients that are not active are subdivided from those of the next coarser level, which are
 * found by the same rule. So each brick is made by itself, from the source alone, and the order of the bricks
 * does not matter. */
#include "bricks/build.h"

#include <string.h>

#include "bricks/subdivide.h"
#include "core/context.h"
#include "core/memory.h"

enum { SHIFT_LEAST = 2, SHIFT_MOST = 8, BLOCKS_MOST = 6 /* blocks along an axis around a box of points */ };

typedef struct builder {
  const hl_bricks_source *source;
  const hl_bricks_leaf *leaves;
  hl_bricks *bricks; /* the directory is filled; the pool has a place for each leaf */
  hl_pool *pool;
  float *scratch; /* owned; [threads][scratch_floats] */
  size_t scratch_floats;
  bool *is_constant; /* owned; [leaves] */
} builder;

static size_t brick_points(int shift) {
  size_t side = ((size_t)1 << shift) + BRICK_MARGIN;
  return side * side * side;
}

/* ---- which coefficients are active ---- */

/* The block of a level in which a cell lies. */
static ptrdiff_t block_of(ptrdiff_t cell, int shift) { return cell >> shift; }

/* Whether a brick that is coarser than the level covers a block of that level. */
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

/* The blocks around a box of points, and which of them coarser bricks cover. */
typedef struct coarse_blocks {
  ptrdiff_t first[3];
  int count[3];
  bool is_coarser[BLOCKS_MOST][BLOCKS_MOST][BLOCKS_MOST];
  bool any, all;
} coarse_blocks;

static void find_coarse_blocks(const hl_bricks *bricks, int level, const hl_lattice_box *box,
                               coarse_blocks *blocks) {
  for (int axis = 0; axis < 3; axis++) {
    ptrdiff_t last = box->first[axis] + (ptrdiff_t)box->count[axis] - 1 + 1;
    blocks->first[axis] = block_of(box->first[axis] - 2, bricks->shift);
    blocks->count[axis] = (int)(block_of(last, bricks->shift) - blocks->first[axis]) + 1;
  }
  blocks->any = false;
  blocks->all = true;
  for (int k = 0; k < blocks->count[2]; k++)
    for (int j = 0; j < blocks->count[1]; j++)
      for (int i = 0; i < blocks->count[0]; i++) {
        bool coarser = is_coarser(
            bricks, level, (ptrdiff_t[3]){blocks->first[0] + i, blocks->first[1] + j, blocks->first[2] + k});
        blocks->is_coarser[k][j][i] = coarser;
        blocks->any = blocks->any || coarser;
        blocks->all = blocks->all && coarser;
      }
}

static bool is_active(const coarse_blocks *blocks, int shift, const ptrdiff_t point[3]) {
  int low[3], high[3];
  for (int axis = 0; axis < 3; axis++) {
    low[axis] = (int)(block_of(point[axis] - 2, shift) - blocks->first[axis]);
    high[axis] = (int)(block_of(point[axis] + 1, shift) - blocks->first[axis]);
  }
  for (int k = low[2]; k <= high[2]; k++)
    for (int j = low[1]; j <= high[1]; j++)
      for (int i = low[0]; i <= high[0]; i++)
        if (blocks->is_coarser[k][j][i]) return false;
  return true;
}

/* ---- assembling ---- */

/* The scratch floats that assemble() takes for a box, at most. */
static size_t scratch_of(hl_lattice_box box, int levels) {
  size_t sum = 0;
  for (int level = 0; level < levels; level++) {
    for (int axis = 0; axis < 3; axis++) box.first[axis] &= ~(ptrdiff_t)1; /* even: needs the most */
    for (int axis = 0; axis < 3; axis++) box.count[axis] |= 1;
    hl_lattice_box coarse = hl_subdivision_source(&box);
    sum += hl_lattice_points(&coarse) + hl_lattice_points(&box) + hl_subdivision_scratch(&box);
    box = coarse;
  }
  return sum;
}

/* Fills a box of coefficients of a level. */
static void assemble(const builder *b, int level, const hl_lattice_box *box, float *scratch, float *out) {
  const hl_bricks_source *source = b->source;
  coarse_blocks blocks = {.any = false};
  if (level + 1 < source->levels) find_coarse_blocks(b->bricks, level, box, &blocks);
  if (!blocks.any) {
    source->fill(source->data, level, box->first, box->count, out);
    return;
  }
  hl_lattice_box coarse_box = hl_subdivision_source(box);
  float *coarse = scratch, *subdivided = coarse + hl_lattice_points(&coarse_box),
        *further = subdivided + hl_lattice_points(box);
  assemble(b, level + 1, &coarse_box, further, coarse);
  hl_subdivide(box, coarse, further, blocks.all ? out : subdivided);
  if (blocks.all) return;
  source->fill(source->data, level, box->first, box->count, out);
  size_t n = 0;
  for (size_t k = 0; k < box->count[2]; k++)
    for (size_t j = 0; j < box->count[1]; j++)
      for (size_t i = 0; i < box->count[0]; i++, n++) {
        const ptrdiff_t point[3] = {box->first[0] + (ptrdiff_t)i, box->first[1] + (ptrdiff_t)j,
                                    box->first[2] + (ptrdiff_t)k};
        if (!is_active(&blocks, b->bricks->shift, point)) out[n] = subdivided[n];
      }
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
  for (size_t n = 1; n < count && same; n++) same = out[n] == out[0];
  b->is_constant[index] = same;
}

/* ---- the directory ---- */

static hl_status fail_leaf(const hl_bricks_leaf *leaf, const char *subject, const char *what,
                           hl_error *error) {
  return hl_fail(error, HL_ERROR_INPUT, "%s: the brick %zu, %zu, %zu of level %d %s", subject, leaf->brick[0],
                 leaf->brick[1], leaf->brick[2], leaf->level, what);
}

/* Calls for the directory's entries of a leaf, those within the directory. Returns false where the leaf lies
 * beyond it. */
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

/* Writes a leaf's entry. Fails if another leaf has one of its blocks. */
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

/* ---- the whole ---- */

/* Moves the bricks that are not constant together, and makes the others constants. */
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
  if (kept != NULL) bricks->pool = kept; /* without memory for a copy, the larger block stays */
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
