/* bricks/patches.c - makes a field of an adaptive grid (patches.h).
 *
 * Each level has a table of its blocks, by a hash of their coordinates. */
#include "bricks/patches.h"

#include <math.h>
#include <string.h>

#include "bricks/corners.h"
#include "bricks/evaluate.h"
#include "core/context.h"
#include "core/memory.h"

enum { BLOCK_SHIFT = 3, BLOCK = 1 << BLOCK_SHIFT, BLOCK_CELLS = BLOCK * BLOCK * BLOCK, SHIFT = 4 };

typedef struct cell_block {
  uint32_t at[3];           /* the block's coordinates */
  float value[BLOCK_CELLS]; /* [z][y][x]; NaN where there is no value */
} cell_block;

/* The blocks of one level. */
typedef struct block_table {
  cell_block **blocks; /* owned, with all blocks; [size]; null if a place is free */
  size_t size, count;  /* size: a power of two, or 0 */
} block_table;

struct hl_patches {
  hl_context *context;
  int levels;
  size_t domain[3]; /* cells of level 0 */
  block_table table[BRICK_LEVELS_LIMIT];
};

hl_status hl_patches_create(hl_context *context, int levels, const size_t domain[3], hl_patches **patches,
                            hl_error *error) {
  hl_patches *made = hl_allocate_zeroed(context, 1, sizeof *made);
  *patches = NULL;
  if (made == NULL) return hl_fail_memory(error, sizeof *made, "the patches of an adaptive grid");
  made->context = context;
  made->levels = levels;
  memcpy(made->domain, domain, sizeof made->domain);
  *patches = made;
  return HL_OK;
}

void hl_patches_destroy(hl_patches *patches) {
  if (patches == NULL) return;
  for (int level = 0; level < BRICK_LEVELS_LIMIT; level++) {
    block_table *table = &patches->table[level];
    for (size_t n = 0; n < table->size; n++) hl_release(patches->context, table->blocks[n]);
    hl_release(patches->context, table->blocks);
  }
  hl_release(patches->context, patches);
}

/* ---- blocks ---- */

/* The place of a block in a table. If the table does not have the block, it is the place where the block
 * would be put. */
static size_t place_of(const block_table *table, const uint32_t at[3]) {
  uint64_t hash = at[0] * 0x9e3779b97f4a7c15u + at[1] * 0xbf58476d1ce4e5b9u + at[2] * 0x94d049bb133111ebu;
  hash ^= hash >> 29;
  hash *= 0xbf58476d1ce4e5b9u;
  for (size_t place = (hash >> 32) & (table->size - 1);; place = (place + 1) & (table->size - 1)) {
    const cell_block *block = table->blocks[place];
    if (block == NULL || memcmp(block->at, at, sizeof block->at) == 0) return place;
  }
}

static const cell_block *find_block(const block_table *table, const uint32_t at[3]) {
  return table->size > 0 ? table->blocks[place_of(table, at)] : NULL;
}

/* Doubles a table. */
static bool grow_table(hl_context *context, block_table *table) {
  block_table larger = {.size = table->size > 0 ? 2 * table->size : 64, .count = table->count};
  larger.blocks = hl_allocate_zeroed(context, larger.size, sizeof(cell_block *));
  if (larger.blocks == NULL) return false;
  for (size_t n = 0; n < table->size; n++)
    if (table->blocks[n] != NULL) larger.blocks[place_of(&larger, table->blocks[n]->at)] = table->blocks[n];
  hl_release(context, table->blocks);
  *table = larger;
  return true;
}

/* The block at the coordinates `at` of a level. If the table has none, the block is made. Null if memory is
 * short. */
static cell_block *make_block(hl_patches *patches, int level, const uint32_t at[3]) {
  block_table *table = &patches->table[level];
  if (2 * (table->count + 1) > table->size && !grow_table(patches->context, table)) return NULL;
  size_t place = place_of(table, at);
  if (table->blocks[place] != NULL) return table->blocks[place];
  cell_block *block = hl_allocate(patches->context, 1, sizeof *block);
  if (block == NULL) return NULL;
  memcpy(block->at, at, sizeof block->at);
  for (int n = 0; n < BLOCK_CELLS; n++) block->value[n] = NAN;
  table->blocks[place] = block;
  table->count++;
  return block;
}

static size_t cell_in_block(size_t x, size_t y, size_t z) {
  return ((z & (BLOCK - 1)) * BLOCK + (y & (BLOCK - 1))) * BLOCK + (x & (BLOCK - 1));
}

/* ---- adding patches ---- */

/* Sets the cells of a patch that lie in one block. */
static void set_cells(cell_block *block, const size_t first[3], const size_t count[3], const float *values) {
  size_t low[3], high[3], at[3];
  for (int axis = 0; axis < 3; axis++) {
    size_t begin = (size_t)block->at[axis] * BLOCK, end = first[axis] + count[axis];
    low[axis] = begin > first[axis] ? begin : first[axis];
    high[axis] = begin + BLOCK < end ? begin + BLOCK : end;
  }
  for (at[2] = low[2]; at[2] < high[2]; at[2]++)
    for (at[1] = low[1]; at[1] < high[1]; at[1]++)
      for (at[0] = low[0]; at[0] < high[0]; at[0]++) {
        float value =
            values[((at[2] - first[2]) * count[1] + at[1] - first[1]) * count[0] + at[0] - first[0]];
        if (isfinite(value)) block->value[cell_in_block(at[0], at[1], at[2])] = value;
      }
}

hl_status hl_patches_add(hl_patches *patches, int level, const size_t first[3], const size_t count[3],
                         const float *values, const char *subject, hl_error *error) {
  bool inside = level >= 0 && level < patches->levels;
  for (int axis = 0; axis < 3 && inside; axis++) {
    size_t cells = patches->domain[axis] >> level;
    inside = count[axis] > 0 && count[axis] <= cells && first[axis] <= cells - count[axis];
  }
  if (!inside)
    return hl_fail(error, HL_ERROR_INPUT, "%s: a patch of level %d of the lattice lies beyond the domain",
                   subject, level);
  uint32_t at[3], low[3], high[3];
  for (int axis = 0; axis < 3; axis++) {
    low[axis] = (uint32_t)(first[axis] >> BLOCK_SHIFT);
    high[axis] = (uint32_t)((first[axis] + count[axis] - 1) >> BLOCK_SHIFT);
  }
  for (at[2] = low[2]; at[2] <= high[2]; at[2]++)
    for (at[1] = low[1]; at[1] <= high[1]; at[1]++)
      for (at[0] = low[0]; at[0] <= high[0]; at[0]++) {
        cell_block *block = make_block(patches, level, at);
        if (block == NULL) return hl_fail_memory(error, sizeof *block, subject);
        set_cells(block, first, count, values);
      }
  return HL_OK;
}

/* ---- means of finer cells ---- */

/* Finds the mean of the eight finer cells from (x, y, z) of a block on. Returns false if one of them has no
 * value. */
static bool mean_of_eight(const cell_block *fine, size_t x, size_t y, size_t z, float *mean) {
  double sum = 0;
  for (size_t n = 0; n < 8; n++)
    sum += (double)fine->value[cell_in_block(x + (n & 1), y + (n >> 1 & 1), z + (n >> 2))];
  *mean = (float)(sum / 8);
  return sum == sum;
}

/* Writes the means of a block of the next finer level. */
static hl_status average_block(hl_patches *patches, int level, const cell_block *fine, const char *subject,
                               hl_error *error) {
  const uint32_t at[3] = {fine->at[0] / 2, fine->at[1] / 2, fine->at[2] / 2};
  cell_block *block = NULL;
  for (size_t z = 0; z < BLOCK; z += 2)
    for (size_t y = 0; y < BLOCK; y += 2)
      for (size_t x = 0; x < BLOCK; x += 2) {
        float mean;
        if (!mean_of_eight(fine, x, y, z, &mean)) continue;
        if (block == NULL) block = make_block(patches, level, at);
        if (block == NULL) return hl_fail_memory(error, sizeof *block, subject);
        size_t half = BLOCK / 2;
        block->value[cell_in_block((fine->at[0] & 1) * half + x / 2, (fine->at[1] & 1) * half + y / 2,
                                   (fine->at[2] & 1) * half + z / 2)] = mean;
      }
  return HL_OK;
}

static hl_status average(hl_patches *patches, const char *subject, hl_error *error) {
  hl_status status = HL_OK;
  for (int level = 1; level < patches->levels; level++) {
    const block_table *fine = &patches->table[level - 1];
    for (size_t n = 0; n < fine->size && status == HL_OK; n++)
      if (fine->blocks[n] != NULL) status = average_block(patches, level, fine->blocks[n], subject, error);
  }
  return status;
}

/* ---- the source of the field ---- */

/* Clamps a cell's coordinate along an axis to the domain. Cells beyond an end are replaced by the last cell
 * before it. */
static size_t clamp_cell(const hl_patches *patches, int level, int axis, ptrdiff_t cell) {
  size_t cells = patches->domain[axis] >> level;
  return cell < 0 ? 0 : (size_t)cell < cells ? (size_t)cell : cells - 1;
}

/* The result of the last search for a block, kept because neighbouring cells mostly lie in the same block. */
typedef struct last_block {
  uint32_t at[3];
  const cell_block *block;
  bool known;
} last_block;

static float cell_value(const hl_patches *patches, int level, const size_t cell[3], last_block *last) {
  const uint32_t at[3] = {(uint32_t)(cell[0] >> BLOCK_SHIFT), (uint32_t)(cell[1] >> BLOCK_SHIFT),
                          (uint32_t)(cell[2] >> BLOCK_SHIFT)};
  if (!last->known || memcmp(last->at, at, sizeof at) != 0) {
    memcpy(last->at, at, sizeof at);
    last->block = find_block(&patches->table[level], at);
    last->known = true;
  }
  return last->block != NULL ? last->block->value[cell_in_block(cell[0], cell[1], cell[2])] : NAN;
}

/* The value of the cell that is `step` cells from the cell `first`, or of the level's cell nearest to it; NaN
 * if no patch has this cell. */
static float value_at(const hl_patches *patches, int level, const ptrdiff_t first[3], const size_t step[3],
                      last_block *last) {
  size_t cell[3];
  for (int axis = 0; axis < 3; axis++)
    cell[axis] = clamp_cell(patches, level, axis, first[axis] + (ptrdiff_t)step[axis]);
  return cell_value(patches, level, cell, last);
}

/* Fills an array of cells, [CORNERS_CELLS][CORNERS_CELLS][CORNERS_CELLS], that begins at the cell `first`. */
static void gather_cells(const hl_patches *patches, int level, const ptrdiff_t first[3],
                         const size_t count[3], last_block *last, float *cells) {
  for (size_t k = 0; k < count[2]; k++)
    for (size_t j = 0; j < count[1]; j++)
      for (size_t i = 0; i < count[0]; i++)
        cells[(k * CORNERS_CELLS + j) * CORNERS_CELLS + i] = value_at(patches, level, first,
                                                                      (const size_t[3]){i, j, k}, last);
}

/* Finds the coefficients of the corners from..from + corners - 1 of a box that begins at the corner `first`.
 */
static void fill_part(const hl_patches *patches, int level, const ptrdiff_t first[3], const size_t count[3],
                      const size_t from[3], const size_t corners[3], last_block *last, float *out) {
  float cells[CORNERS_CELLS * CORNERS_CELLS * CORNERS_CELLS],
      found[CORNERS_MOST * CORNERS_MOST * CORNERS_MOST];
  ptrdiff_t cell[3];
  size_t read[3];
  for (int axis = 0; axis < 3; axis++) {
    cell[axis] = first[axis] + (ptrdiff_t)from[axis] - CORNERS_BEFORE;
    read[axis] = corners[axis] + CORNERS_AROUND;
  }
  gather_cells(patches, level, cell, read, last, cells);
  hl_corners_of_cells(cells, corners, found);
  for (size_t k = 0; k < corners[2]; k++)
    for (size_t j = 0; j < corners[1]; j++)
      memcpy(out + ((from[2] + k) * count[1] + from[1] + j) * count[0] + from[0],
             found + (k * corners[1] + j) * corners[0], corners[0] * sizeof *out);
}

static void fill(void *data, int level, const ptrdiff_t first[3], const size_t count[3], float *out) {
  last_block last = {.known = false};
  size_t from[3], corners[3];
  for (from[2] = 0; from[2] < count[2]; from[2] += CORNERS_MOST)
    for (from[1] = 0; from[1] < count[1]; from[1] += CORNERS_MOST)
      for (from[0] = 0; from[0] < count[0]; from[0] += CORNERS_MOST) {
        for (int axis = 0; axis < 3; axis++) {
          size_t left = count[axis] - from[axis];
          corners[axis] = left < CORNERS_MOST ? left : CORNERS_MOST;
        }
        fill_part(data, level, first, count, from, corners, &last, out);
      }
}

static void cover(void *data, int level, const ptrdiff_t first[3], const size_t count[3],
                  unsigned char *covered) {
  const hl_patches *patches = data;
  last_block last = {.known = false};
  size_t n = 0;
  for (size_t k = 0; k < count[2]; k++)
    for (size_t j = 0; j < count[1]; j++)
      for (size_t i = 0; i < count[0]; i++) {
        float value = value_at(patches, level, first, (const size_t[3]){i, j, k}, &last);
        covered[n++] = value == value;
      }
}

/* ---- which bricks ---- */

/* Splits a brick where the next finer level has a block within it. */
static hl_bricks_choice choose(void *data, int level, const size_t brick[3]) {
  enum {
    FINER = 1 << (SHIFT + 1 - BLOCK_SHIFT)
  }; /* number of blocks of the finer level along a brick's
      * edge */
  const hl_patches *patches = data;
  for (int axis = 0; axis < 3; axis++)
    if (brick[axis] << SHIFT >= patches->domain[axis] >> level) return HL_BRICKS_NOTHING;
  for (uint32_t n = 0; n < FINER * FINER * FINER && level > 0; n++) {
    const uint32_t at[3] = {FINER * (uint32_t)brick[0] + n % FINER,
                            FINER * (uint32_t)brick[1] + n / FINER % FINER,
                            FINER * (uint32_t)brick[2] + n / FINER / FINER};
    if (find_block(&patches->table[level - 1], at) != NULL) return HL_BRICKS_SPLIT;
  }
  return HL_BRICKS_LEAF;
}

/* ---- how far the field is from the cells ---- */

typedef struct difference_job {
  const hl_patches *patches;
  const hl_bricks *bricks;
  int level;
  double *differences; /* owned; [size of the level's table]; the greatest difference in each block; NaN:
                        * nothing was compared */
} difference_job;

/* The mean of the field over a cell of a level. The bricks that cover the cell must be of this level or
 * finer. The result is NaN if a coefficient is NaN. Derived: the integrals of the four pieces of the cubic
 * B-spline are 1/24, 11/24, 11/24 and 1/24. */
static double mean_over_cell(const hl_bricks *bricks, int level, const size_t cell[3]) {
  static const double integral[4] = {1.0 / 24, 11.0 / 24, 11.0 / 24, 1.0 / 24};
  const size_t width = hl_brick_width(bricks), side = (size_t)1 << bricks->shift;
  int64_t block[3];
  double sum = 0;
  for (int axis = 0; axis < 3; axis++) block[axis] = (int64_t)(cell[axis] >> bricks->shift << level);
  const hl_brick_entry *entry = hl_bricks_entry(bricks, block);
  if (entry->slot < 0) return (double)entry->constant;
  if (entry->level < level) {
    for (size_t n = 0; n < 8; n++) {
      const size_t finer[3] = {2 * cell[0] + (n & 1), 2 * cell[1] + (n >> 1 & 1), 2 * cell[2] + (n >> 2)};
      sum += mean_over_cell(bricks, level - 1, finer);
    }
    return sum / 8;
  }
  const float *first = hl_brick_pool(bricks, entry->slot) +
                       ((cell[2] % side) * width + cell[1] % side) * width + cell[0] % side;
  for (size_t k = 0; k < 4; k++)
    for (size_t j = 0; j < 4; j++)
      for (size_t i = 0; i < 4; i++)
        sum += integral[i] * integral[j] * integral[k] * (double)first[(k * width + j) * width + i];
  return sum;
}

/* Returns whether a finer level has a value in a cell. */
static bool is_refined(const hl_patches *patches, int level, const size_t cell[3], last_block *last) {
  bool refined = false;
  for (size_t n = 0; n < 8 && level > 0 && !refined; n++) {
    const size_t finer[3] = {2 * cell[0] + (n & 1), 2 * cell[1] + (n >> 1 & 1), 2 * cell[2] + (n >> 2)};
    float value = cell_value(patches, level - 1, finer, last);
    refined = value == value;
  }
  return refined;
}

static void compare_block(void *data, size_t index, int worker) {
  (void)worker;
  difference_job *job = data;
  const cell_block *block = job->patches->table[job->level].blocks[index];
  last_block last = {.known = false};
  double greatest = NAN;
  for (size_t n = 0; n < BLOCK_CELLS && block != NULL; n++) {
    const size_t cell[3] = {(size_t)block->at[0] * BLOCK + n % BLOCK,
                            (size_t)block->at[1] * BLOCK + n / BLOCK % BLOCK,
                            (size_t)block->at[2] * BLOCK + n / BLOCK / BLOCK};
    if (isnan(block->value[n]) || is_refined(job->patches, job->level, cell, &last)) continue;
    double mean = mean_over_cell(job->bricks, job->level, cell);
    greatest = fmax(greatest, fabs(mean - (double)block->value[n])); /* a NaN counts as absent */
  }
  job->differences[index] = greatest;
}

static hl_status find_difference(const hl_patches *patches, hl_pool *pool, const char *subject,
                                 const hl_bricks *bricks, double *difference, hl_error *error) {
  hl_status status = HL_OK;
  *difference = NAN;
  for (int level = 0; level < patches->levels && status == HL_OK; level++) {
    size_t size = patches->table[level].size;
    if (size == 0) continue;
    difference_job job = {patches, bricks, level,
                          hl_allocate(patches->context, size, sizeof *job.differences)};
    if (job.differences == NULL) return hl_fail_memory(error, size * sizeof *job.differences, subject);
    hl_pool_run(pool, size, compare_block, &job);
    if (hl_pool_cancelled(pool)) status = hl_fail(error, HL_ERROR_CANCELLED, "%s: cancelled", subject);
    for (size_t n = 0; n < size && status == HL_OK; n++) *difference = fmax(*difference, job.differences[n]);
    hl_release(patches->context, job.differences);
  }
  return status;
}

/* ---- all steps together ---- */

hl_status hl_patches_build(hl_patches *patches, hl_pool *pool, const char *subject, hl_bricks *bricks,
                           double *difference, hl_error *error) {
  hl_bricks_source source = {.shift = SHIFT,
                             .levels = patches->levels,
                             .outside = NAN,
                             .fill = fill,
                             .cover = cover,
                             .data = patches};
  hl_bricks_leaf *leaves = NULL;
  size_t count = 0;
  for (int axis = 0; axis < 3; axis++) source.dimension[axis] = patches->domain[axis];
  *bricks = (hl_bricks){.shift = 0};
  hl_status status = average(patches, subject, error);
  if (status == HL_OK)
    status = hl_bricks_choose(patches->context, &source, choose, patches, subject, &leaves, &count, error);
  if (status == HL_OK)
    status = hl_bricks_build(patches->context, pool, &source, leaves, count, subject, bricks, error);
  for (int axis = 0; axis < 3; axis++) bricks->origin[axis] = 0.5;
  hl_release(patches->context, leaves);
  if (status != HL_OK) return status;
  status = find_difference(patches, pool, subject, bricks, difference, error);
  if (status != HL_OK) hl_bricks_release(patches->context, bricks);
  return status;
}

void hl_patches_copy(const hl_patches *patches, float *values) {
  const size_t *n = patches->domain;
  last_block last = {.known = false};
  size_t at[3];
  for (at[2] = 0; at[2] < n[2]; at[2]++)
    for (at[1] = 0; at[1] < n[1]; at[1]++)
      for (at[0] = 0; at[0] < n[0]; at[0]++) *values++ = cell_value(patches, 0, at, &last);
}
