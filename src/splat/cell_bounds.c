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
  size_t width = (size_t)grid->near_count[0], bytes = hl_storage_bytes(grid->storage);
  int32_t height = grid->dimension[1];
  for (int32_t y = 0; y < height; y++) {
    const unsigned char *row = (const unsigned char *)grid->voxels +
                               ((size_t)z * (size_t)height + (size_t)y) * (size_t)grid->dimension[0] * bytes;
    job->along(grid->storage, row, grid->dimension[0], job->smooth, padded, rows + 2 * (size_t)y * width,
               rows + (2 * (size_t)y + 1) * width);
  }
  for (int32_t f = 0; f < grid->near_count[1]; f++) {
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
  float *rows = out + 2 * job->plane, *padded = rows + 2 * (size_t)grid->dimension[1] * (size_t)grid->near_count[0];
  int32_t held[CELL_TAPS] = {-1, -1, -1, -1, -1}, end = ((int32_t)index + 1) * SLABS_A_TASK;
  if (end > grid->near_count[2]) end = grid->near_count[2];
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

hl_status hl_cell_bounds_build(hl_context *context, hl_pool *pool, bound_along_function *along,
                               bound_across_function *across, bool smooth, grid *grid, hl_error *error) {
  size_t cells = 1;
  for (int axis = 0; axis < 3; axis++) {
    grid->near_count[axis] = grid->dimension[axis] / HL_NEAR_CELLS + 1;
    cells *= (size_t)grid->near_count[axis];
  }
  if (cells >= INT32_MAX) return HL_OK; /* more than 32 bits can number: bricks decide alone */
  size_t plane = (size_t)grid->near_count[0] * (size_t)grid->near_count[1];
  bound_job job = {.grid = grid, .along = along, .across = across, .smooth = smooth, .plane = plane};
  job.scratch_floats = (2 * CELL_TAPS + 2) * plane + 2 * (size_t)grid->dimension[1] * (size_t)grid->near_count[0] +
                       (size_t)grid->dimension[0] + 6;
  job.scratch = hl_allocate(context, (size_t)hl_pool_threads(pool) * job.scratch_floats, sizeof(float));
  grid->cell_low = hl_allocate(context, cells, 1);
  grid->cell_high = hl_allocate(context, cells, 1);
  grid->visible = hl_allocate(context, cells, 1);
  grid->near = hl_allocate(context, cells + 4, 1); /* read four bytes at a time */
  hl_status status = HL_OK;
  if (job.scratch == NULL || grid->cell_low == NULL || grid->cell_high == NULL || grid->visible == NULL || grid->near == NULL)
    status = hl_fail_memory(error, 4 * cells, "the bounds of a volume's cells");
  else
    hl_pool_run(pool, ((size_t)grid->near_count[2] + SLABS_A_TASK - 1) / SLABS_A_TASK, bound_slabs, &job);
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
  size_t width = (size_t)grid->near_count[0];
  for (int32_t y = 0; y < grid->near_count[1]; y++) {
    size_t at = (index * (size_t)grid->near_count[1] + (size_t)y) * width;
    const unsigned char *bricks = grid->relevant + (index / 2 * (size_t)grid->brick_count[1] + (size_t)(y / 2)) *
                                                       (size_t)grid->brick_count[0];
    memset(grid->visible + at, 0, width);
    if (memchr(bricks, 1, (size_t)grid->brick_count[0]) == NULL) continue;
    for (size_t x = 0; x < width; x++)
      grid->visible[at + x] = bricks[x / 2] && grid->cell_high[at + x] >= job->least_high[grid->cell_low[at + x]];
  }
}

/* Whether any row within some rows of (y, z) shows something at x, in merged; false where none does. */
static bool merge_rows(const grid *grid, int32_t y, int32_t z, int32_t reach, int32_t x0, int32_t x1, unsigned char *merged) {
  bool any = false;
  memset(merged, 0, (size_t)(x1 - x0));
  for (int32_t j = z - reach; j <= z + reach; j++)
    for (int32_t i = y - reach; i <= y + reach; i++) {
      if (i < 0 || j < 0 || i >= grid->near_count[1] || j >= grid->near_count[2]) continue;
      const unsigned char *row = grid->visible + ((size_t)j * (size_t)grid->near_count[1] + (size_t)i) * (size_t)grid->near_count[0];
      if (memchr(row + x0, 1, (size_t)(x1 - x0)) == NULL) continue;
      any = true;
      for (int32_t x = x0; x < x1; x++) merged[x - x0] |= row[x];
    }
  return any;
}

enum { NEAR_CHUNK = 512 };

/* One distance of one row: cells are near what lies within reach rows of them along every axis. */
static void mark_near_row(const grid *grid, int32_t y, int32_t z, int32_t reach, unsigned char bit, unsigned char *to) {
  unsigned char merged[NEAR_CHUNK + 4];
  int32_t width = grid->near_count[0];
  for (int32_t start = 0; start < width; start += NEAR_CHUNK) {
    int32_t end = start + NEAR_CHUNK < width ? start + NEAR_CHUNK : width;
    int32_t x0 = start < reach ? 0 : start - reach, x1 = end + reach > width ? width : end + reach;
    if (!merge_rows(grid, y, z, reach, x0, x1, merged)) continue;
    for (int32_t x = start; x < end; x++) {
      unsigned char any = 0;
      for (int32_t i = x - reach < x0 ? x0 : x - reach; i <= x + reach && i < x1; i++) any |= merged[i - x0];
      if (any) to[x] |= bit;
    }
  }
}

static void mark_near(void *data, size_t index, int worker) {
  (void)worker;
  const mark_job *job = data;
  const grid *grid = job->grid;
  size_t width = (size_t)grid->near_count[0];
  for (int32_t y = 0; y < grid->near_count[1]; y++) {
    unsigned char *to = grid->near + (index * (size_t)grid->near_count[1] + (size_t)y) * width;
    memset(to, 0, width);
    mark_near_row(grid, y, (int32_t)index, 1, NEAR_CLOSE, to);
    mark_near_row(grid, y, (int32_t)index, 2, NEAR_FAR, to);
  }
}

void hl_cells_mark_near(grid *grid, const classifier *classifier, hl_pool *pool) {
  if (grid->near == NULL) return;
  mark_job job = {.grid = grid};
  find_least_high(classifier, grid, job.least_high);
  hl_pool_run(pool, (size_t)grid->near_count[2], mark_visible, &job);
  hl_pool_run(pool, (size_t)grid->near_count[2], mark_near, &job);
}
