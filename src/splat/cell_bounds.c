/* splat/cell_bounds.c - bounds of all cells, once a volume; which of them show something and what is near them, once a
 * transfer function. */
#include "splat/cell_bounds.h"

#include <string.h>

#include "core/memory.h"

enum { SLABS_A_TASK = 8 };

typedef struct bound_job {
  grid *grid;
  bound_along_function *along;
  bound_across_function *across;
  bool smooth;
  float *scratch;     /* [workers][scratch_floats] */
  size_t scratch_floats, plane;
} bound_job;

/* Bounds of one slice of voxels along x and y: [2][near y][near x], low and high. */
static void bound_slice(const bound_job *job, int32_t z, float *rows, float *padded, float *slice) {
  const grid *grid = job->grid;
  size_t width = (size_t)grid->level[0].count[0], bytes = hl_storage_bytes(grid->storage);
  int32_t height = grid->dimension[1];
  for (int32_t y = 0; y < height; y++) {
    const unsigned char *row = (const unsigned char *)grid->voxels +
                               ((size_t)z * (size_t)height + (size_t)y) * (size_t)grid->dimension[0] * bytes;
    job->along(grid->storage, row, grid->dimension[0], job->smooth, padded, rows + 2 * (size_t)y * width,
               rows + (2 * (size_t)y + 1) * width);
  }
  for (int32_t f = 0; f < grid->level[0].count[1]; f++) {
    const float *low[CELL_TAPS], *high[CELL_TAPS];
    for (int32_t tap = 0; tap < CELL_TAPS; tap++) {
      int32_t y = 2 * f - 2 + tap;
      y = y < 0 ? 0 : y >= height ? height - 1 : y;
      low[tap] = rows + 2 * (size_t)y * width;
      high[tap] = low[tap] + width;
    }
    job->across(low, high, width, job->smooth, slice + (size_t)f * width, slice + job->plane + (size_t)f * width);
  }
}

/* Rounded outwards to 255 steps of the volume's range; sums of floats may err by far less than the ten-thousandth
 * of a step that is forgiven, and a table's entry is sixteen times finer than a step. */
static void store_bounds(const grid *grid, const float *low, const float *high, size_t count, size_t at) {
  float inverse = 1 / grid->cell_step;
  for (size_t i = 0; i < count; i++) {
    float a = floorf((low[i] - grid->cell_base) * inverse + 1e-4f), b = ceilf((high[i] - grid->cell_base) * inverse - 1e-4f);
    grid->cell_low[at + i] = (unsigned char)(a < 0 ? 0 : a > 255 ? 255 : a);
    grid->cell_high[at + i] = (unsigned char)(b < 0 ? 0 : b > 255 ? 255 : b);
  }
}

static void bound_slabs(void *data, size_t index, int worker) {
  const bound_job *job = data;
  const grid *grid = job->grid;
  float *slices = job->scratch + (size_t)worker * job->scratch_floats, *out = slices + CELL_TAPS * 2 * job->plane;
  float *rows = out + 2 * job->plane, *padded = rows + 2 * (size_t)grid->dimension[1] * (size_t)grid->level[0].count[0];
  int32_t held[CELL_TAPS] = {-1, -1, -1, -1, -1}, end = ((int32_t)index + 1) * SLABS_A_TASK;
  if (end > grid->level[0].count[2]) end = grid->level[0].count[2];
  for (int32_t f = (int32_t)index * SLABS_A_TASK; f < end; f++) {
    const float *low[CELL_TAPS], *high[CELL_TAPS];
    for (int32_t tap = 0; tap < CELL_TAPS; tap++) {
      int32_t z = 2 * f - 2 + tap;
      z = z < 0 ? 0 : z >= grid->dimension[2] ? grid->dimension[2] - 1 : z;
      float *slice = slices + (size_t)(z % CELL_TAPS) * 2 * job->plane;
      if (held[z % CELL_TAPS] != z) bound_slice(job, z, rows, padded, slice);
      held[z % CELL_TAPS] = z;
      low[tap] = slice;
      high[tap] = slice + job->plane;
    }
    job->across(low, high, job->plane, job->smooth, out, out + job->plane);
    store_bounds(grid, out, out + job->plane, job->plane, (size_t)f * job->plane);
  }
}

static hl_status allocate_levels(hl_context *context, grid *grid, hl_error *error) {
  for (int i = 0; i < CELL_LEVELS; i++) {
    cell_level *level = &grid->level[i];
    for (int axis = 0; axis < 3 && i > 0; axis++) level->count[axis] = (grid->level[i - 1].count[axis] + 1) / 2;
    size_t cells = (size_t)level->count[0] * (size_t)level->count[1] * (size_t)level->count[2];
    level->visible = hl_allocate(context, cells, 1);
    level->near = hl_allocate(context, cells + 4, 1); /* read four bytes at a time */
    if (level->visible == NULL || level->near == NULL)
      return hl_fail_memory(error, 2 * cells, "the look-up of a volume's cells");
  }
  return HL_OK;
}

uint64_t hl_cell_bounds_bytes(const size_t dimension[3], int threads) {
  uint64_t count[3], cells = 1, bytes = 0, dimension_0 = dimension[0];
  for (int axis = 0; axis < 3; axis++) cells *= count[axis] = dimension[axis] / HL_NEAR_CELLS + 1;
  if (cells >= INT32_MAX) return 0;
  bytes = 2 * cells;
  uint64_t scratch = (2 * CELL_TAPS + 2) * count[0] * count[1] + 2 * dimension[1] * count[0] + dimension_0 + 6;
  for (int i = 0; i < CELL_LEVELS; i++) {
    bytes += 2 * count[0] * count[1] * count[2] + 4;
    for (int axis = 0; axis < 3; axis++) count[axis] = (count[axis] + 1) / 2;
  }
  return bytes + (uint64_t)threads * scratch * sizeof(float);
}

hl_status hl_cell_bounds_build(hl_context *context, hl_pool *pool, bound_along_function *along,
                               bound_across_function *across, bool smooth, grid *grid, hl_error *error) {
  size_t cells = 1;
  for (int axis = 0; axis < 3; axis++) {
    grid->level[0].count[axis] = grid->dimension[axis] / HL_NEAR_CELLS + 1;
    cells *= (size_t)grid->level[0].count[axis];
  }
  if (cells >= INT32_MAX) return HL_OK; /* more than 32 bits can number: bricks decide alone */
  size_t plane = (size_t)grid->level[0].count[0] * (size_t)grid->level[0].count[1];
  bound_job job = {.grid = grid, .along = along, .across = across, .smooth = smooth, .plane = plane};
  job.scratch_floats = (2 * CELL_TAPS + 2) * plane + 2 * (size_t)grid->dimension[1] * (size_t)grid->level[0].count[0] +
                       (size_t)grid->dimension[0] + 6;
  job.scratch = hl_allocate(context, (size_t)hl_pool_threads(pool) * job.scratch_floats, sizeof(float));
  grid->cell_low = hl_allocate(context, cells, 1);
  grid->cell_high = hl_allocate(context, cells, 1);
  hl_status status = allocate_levels(context, grid, error);
  if (job.scratch == NULL || grid->cell_low == NULL || grid->cell_high == NULL)
    status = hl_fail_memory(error, 2 * cells, "the bounds of a volume's cells");
  if (status == HL_OK)
    hl_pool_run(pool, ((size_t)grid->level[0].count[2] + SLABS_A_TASK - 1) / SLABS_A_TASK, bound_slabs, &job);
  hl_release(context, job.scratch);
  return status;
}

/* ---- which cells show something ---- */

typedef struct mark_job {
  grid *grid;
  uint16_t least_high[256]; /* of a lower bound: the least upper bound that shows something; 256: none */
} mark_job;

static void find_least_high(const classifier *classifier, const grid *grid, uint16_t least_high[256]) {
  for (int low = 255; low >= 0; low--) {
    int high = low;
    while (high < 256 && !hl_classifier_span_visible(classifier, grid, grid->cell_base + (float)low * grid->cell_step,
                                                     grid->cell_base + (float)high * grid->cell_step))
      high++;
    least_high[low] = (uint16_t)high;
  }
}

static void mark_visible(void *data, size_t index, int worker) {
  (void)worker;
  const mark_job *job = data;
  const grid *grid = job->grid;
  size_t width = (size_t)grid->level[0].count[0];
  for (int32_t y = 0; y < grid->level[0].count[1]; y++) {
    size_t at = (index * (size_t)grid->level[0].count[1] + (size_t)y) * width;
    const unsigned char *bricks = grid->relevant + (index / 2 * (size_t)grid->brick_count[1] + (size_t)(y / 2)) *
                                                       (size_t)grid->brick_count[0];
    memset(grid->level[0].visible + at, 0, width);
    if (memchr(bricks, 1, (size_t)grid->brick_count[0]) == NULL) continue;
    for (size_t x = 0; x < width; x++)
      grid->level[0].visible[at + x] = bricks[x / 2] && grid->cell_high[at + x] >= job->least_high[grid->cell_low[at + x]];
  }
}

/* ---- which cells are near those ---- */

typedef struct near_job {
  const cell_level *fine; /* null for the finest level */
  cell_level *level;
} near_job;

/* A cell of a coarser level shows something where one of the eight that it is made of does. */
static void merge_cells(const cell_level *fine, const cell_level *level, int32_t z) {
  unsigned char *to = level->visible + (size_t)z * (size_t)level->count[1] * (size_t)level->count[0];
  memset(to, 0, (size_t)level->count[1] * (size_t)level->count[0]);
  for (int32_t k = 2 * z; k < 2 * z + 2 && k < fine->count[2]; k++)
    for (int32_t j = 0; j < fine->count[1]; j++) {
      const unsigned char *from = fine->visible + ((size_t)k * (size_t)fine->count[1] + (size_t)j) * (size_t)fine->count[0];
      unsigned char *row = to + (size_t)(j / 2) * (size_t)level->count[0];
      for (int32_t i = 0; i < fine->count[0]; i++) row[i / 2] |= from[i];
    }
}

/* The bits of boxes three cells long along x, y, z (cell_level). */
enum { THREE_ALONG_X = 0xaa, THREE_ALONG_Y = 0xcc, THREE_ALONG_Z = 0xf0 };

/* A row's look-ups along x. */
static void mark_row(const unsigned char *restrict visible, size_t width, unsigned char *restrict near) {
  for (size_t x = 0; x + 2 < width; x++)
    near[x] = (unsigned char)(-(visible[x] | visible[x + 1]) | (-visible[x + 2] & THREE_ALONG_X));
  for (size_t x = width < 2 ? 0 : width - 2; x < width; x++)
    near[x] = (unsigned char)-(visible[x] | visible[width - 1]);
}

/* The look-ups along y or z, in place, from the first cell on. step: from a cell to the next along the axis; there are
 * `width` cells side by side. three: the bits of boxes three cells long along it. */
static void join_axis(unsigned char *cells, size_t step, int32_t count, size_t width, unsigned char three) {
  for (int32_t i = 0; i + 2 < count; i++) {
    unsigned char *cell = cells + (size_t)i * step;
    for (size_t x = 0; x < width; x++)
      cell[x] |= (unsigned char)(cell[x + step] | (cell[x + 2 * step] & three));
  }
  if (count < 2) return;
  unsigned char *cell = cells + (size_t)(count - 2) * step;
  for (size_t x = 0; x < width; x++) cell[x] |= cell[x + step];
}

/* A slice's look-ups along x and y. */
static void mark_slice(void *data, size_t index, int worker) {
  (void)worker;
  const near_job *job = data;
  const cell_level *level = job->level;
  size_t width = (size_t)level->count[0], plane = width * (size_t)level->count[1];
  if (job->fine != NULL) merge_cells(job->fine, level, (int32_t)index);
  const unsigned char *visible = level->visible + index * plane;
  unsigned char *near = level->near + index * plane;
  for (int32_t y = 0; y < level->count[1]; y++) mark_row(visible + (size_t)y * width, width, near + (size_t)y * width);
  join_axis(near, width, level->count[1], width, THREE_ALONG_Y);
}

/* A row's look-ups along z, in all slices. */
static void mark_across(void *data, size_t index, int worker) {
  (void)worker;
  const cell_level *level = ((const near_job *)data)->level;
  size_t width = (size_t)level->count[0];
  join_axis(level->near + index * width, width * (size_t)level->count[1], level->count[2], width, THREE_ALONG_Z);
}

void hl_cells_mark_near(grid *grid, const classifier *classifier, hl_pool *pool) {
  if (grid->level[0].near == NULL) return;
  mark_job job = {.grid = grid};
  find_least_high(classifier, grid, job.least_high);
  hl_pool_run(pool, (size_t)grid->level[0].count[2], mark_visible, &job);
  for (int i = 0; i < CELL_LEVELS; i++) {
    near_job near = {.fine = i > 0 ? &grid->level[i - 1] : NULL, .level = &grid->level[i]};
    hl_pool_run(pool, (size_t)near.level->count[2], mark_slice, &near);
    hl_pool_run(pool, (size_t)near.level->count[1], mark_across, &near);
  }
}
