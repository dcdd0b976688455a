/* splat/cell_bounds.c - bounds of all cells, once a volume. They are kept until the transfer function
 * changes, packed: most of a volume is empty, or as even as a brick. */
#include "splat/cell_bounds.h"

#include <string.h>

#include "core/memory.h"

enum { CELL_LAYERS = HL_BRICK_CELLS / HL_NEAR_CELLS, LAYERS_A_TASK = 4 };

typedef struct bound_job {
  grid *grid;
  bound_along_function *along;
  bound_across_function *across;
  bool smooth;
  hl_context *context;
  float *scratch;       /* [workers][scratch_floats] */
  unsigned char *bytes; /* [workers][scratch_bytes] */
  size_t scratch_floats, scratch_bytes, plane;
  bool failed; /* for lack of memory; atomic */
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
    job->across(low, high, width, job->smooth, slice + (size_t)f * width,
                slice + job->plane + (size_t)f * width);
  }
}

/* Rounded outwards to 255 steps of the volume's range; sums of floats may err by far less than the
 * ten-thousandth of a step that is forgiven, and a table's entry is sixteen times finer than a step. */
static void round_bounds(const grid *grid, const float *low, const float *high, size_t count,
                         unsigned char *to_low, unsigned char *to_high) {
  float inverse = 1 / grid->cell_step;
  for (size_t i = 0; i < count; i++) {
    float a = floorf((low[i] - grid->cell_base) * inverse + 1e-4f),
          b = ceilf((high[i] - grid->cell_base) * inverse - 1e-4f);
    to_low[i] = (unsigned char)(a < 0 ? 0 : a > 255 ? 255 : a);
    to_high[i] = (unsigned char)(b < 0 ? 0 : b > 255 ? 255 : b);
  }
}

/* ---- packing ---- */

static size_t even_bytes(const grid *grid) { return hl_even_row_bytes(grid) * (size_t)grid->brick_count[1]; }

static size_t greatest_layer_bytes(const grid *grid) {
  return even_bytes(grid) + UNEVEN_BYTES * (size_t)grid->brick_count[0] * (size_t)grid->brick_count[1];
}

/* Two rows of cells of each of the two layers in a row of bricks. */
typedef const unsigned char *cell_rows[2 * CELL_LAYERS];

/* The eight cells of a brick, two along x at a time. */
static void gather_cells(const cell_rows rows, int32_t x, int32_t count, unsigned char cells[BRICK_CELLS]) {
  int32_t next = x + 1 < count ? x + 1 : x;
  for (int row = 0; row < 2 * CELL_LAYERS; row++) {
    cells[2 * row] = rows[row][x];
    cells[2 * row + 1] = rows[row][next];
  }
}

static bool all_alike(const unsigned char cells[BRICK_CELLS]) {
  return memcmp(cells, cells + 1, BRICK_CELLS - 1) == 0;
}

/* bounds: [CELL_LAYERS][2][plane], lower and upper; returns the bytes of the layer. */
static size_t pack_layer(const grid *grid, const unsigned char *bounds, size_t plane, unsigned char *to) {
  const int32_t *count = grid->level[0].count;
  unsigned char *next = to + even_bytes(grid);
  memset(to, 0, even_bytes(grid));
  for (int32_t by = 0; by < grid->brick_count[1]; by++) {
    cell_rows low, high;
    for (int row = 0; row < 2 * CELL_LAYERS; row++) {
      int32_t y = 2 * by + row % 2 < count[1] ? 2 * by + row % 2 : 2 * by;
      low[row] = bounds + (size_t)(row / 2) * 2 * plane + (size_t)y * (size_t)count[0];
      high[row] = low[row] + plane;
    }
    for (int32_t bx = 0; bx < grid->brick_count[0]; bx++) {
      gather_cells(low, 2 * bx, count[0], next);
      gather_cells(high, 2 * bx, count[0], next + BRICK_CELLS);
      if (!all_alike(next) || !all_alike(next + BRICK_CELLS)) {
        next += UNEVEN_BYTES;
        continue;
      }
      to[(size_t)by * hl_even_row_bytes(grid) + (size_t)bx / 8] |= (unsigned char)(1 << bx % 8);
      next[1] = next[BRICK_CELLS];
      next += EVEN_BYTES;
    }
  }
  return (size_t)(next - to);
}

void hl_cell_bounds_at(const grid *grid, const int32_t cell[3], float *low, float *high) {
  const unsigned char *even = grid->cell_bounds[cell[2] / CELL_LAYERS], *next = even + even_bytes(grid);
  for (int32_t y = 0;; y++, even += hl_even_row_bytes(grid))
    for (int32_t x = 0; x < grid->brick_count[0]; x++) {
      bool same = hl_brick_is_even(even, x);
      if (x == cell[0] / 2 && y == cell[1] / 2) {
        int place = same ? 0 : cell[0] % 2 + 2 * (cell[1] % 2) + 4 * (cell[2] % 2);
        *low = grid->cell_base + grid->cell_step * next[place];
        *high = grid->cell_base + grid->cell_step * next[place + (same ? 1 : BRICK_CELLS)];
        return;
      }
      next += same ? EVEN_BYTES : UNEVEN_BYTES;
    }
}

/* ---- building ---- */

/* One worker's slices of voxels, bounded along x and y. */
typedef struct bound_slices {
  float *slices, *out, *rows, *padded; /* [CELL_TAPS][2][plane], [2][plane], of bound_slice */
  int32_t held[CELL_TAPS];
} bound_slices;

/* Bounds of a slice of cells. */
static void bound_cells(const bound_job *job, bound_slices *s, int32_t f, unsigned char *bounds) {
  const grid *grid = job->grid;
  const float *low[CELL_TAPS], *high[CELL_TAPS];
  for (int32_t tap = 0; tap < CELL_TAPS; tap++) {
    int32_t z = 2 * f - 2 + tap;
    z = z < 0 ? 0 : z >= grid->dimension[2] ? grid->dimension[2] - 1 : z;
    float *slice = s->slices + (size_t)(z % CELL_TAPS) * 2 * job->plane;
    if (s->held[z % CELL_TAPS] != z) bound_slice(job, z, s->rows, s->padded, slice);
    s->held[z % CELL_TAPS] = z;
    low[tap] = slice;
    high[tap] = slice + job->plane;
  }
  job->across(low, high, job->plane, job->smooth, s->out, s->out + job->plane);
  round_bounds(grid, s->out, s->out + job->plane, job->plane, bounds, bounds + job->plane);
}

static void bound_layers(void *data, size_t index, int worker) {
  bound_job *job = data;
  const grid *grid = job->grid;
  size_t plane = job->plane;
  bound_slices s = {.slices = job->scratch + (size_t)worker * job->scratch_floats,
                    .held = {-1, -1, -1, -1, -1}};
  s.out = s.slices + CELL_TAPS * 2 * plane;
  s.rows = s.out + 2 * plane;
  s.padded = s.rows + 2 * (size_t)grid->dimension[1] * (size_t)grid->level[0].count[0];
  unsigned char *bounds = job->bytes + (size_t)worker * job->scratch_bytes,
                *packed = bounds + CELL_LAYERS * 2 * plane;
  int32_t end = ((int32_t)index + 1) * LAYERS_A_TASK;
  for (int32_t layer = (int32_t)index * LAYERS_A_TASK; layer < end && layer < grid->brick_count[2]; layer++) {
    for (int32_t k = 0; k < CELL_LAYERS; k++) {
      int32_t f = CELL_LAYERS * layer + k;
      if (f < grid->level[0].count[2]) bound_cells(job, &s, f, bounds + (size_t)k * 2 * plane);
      else memcpy(bounds + (size_t)k * 2 * plane, bounds, 2 * plane);
    }
    size_t bytes = pack_layer(grid, bounds, plane, packed);
    grid->cell_bounds[layer] = hl_allocate(job->context, bytes, 1);
    if (grid->cell_bounds[layer] != NULL) memcpy(grid->cell_bounds[layer], packed, bytes);
    else __atomic_store_n(&job->failed, true, __ATOMIC_RELAXED);
  }
}

static hl_status allocate_levels(hl_context *context, grid *grid, hl_error *error) {
  memcpy(grid->level[1].count, grid->brick_count, sizeof grid->brick_count);
  for (int i = 0; i < CELL_LEVELS; i++) {
    cell_level *level = &grid->level[i];
    size_t cells = (size_t)level->count[0] * (size_t)level->count[1] * (size_t)level->count[2];
    level->near = hl_allocate(context, cells + 4, 1); /* read four bytes at a time */
    if (level->near == NULL) return hl_fail_memory(error, cells, "the look-up of a volume's cells");
  }
  return HL_OK;
}

/* Sizes of a grid whose brick_count is known; false where there are more cells than 32 bits can number. */
static bool size_scratch(grid *grid, bound_job *job) {
  size_t cells = 1;
  for (int axis = 0; axis < 3; axis++) {
    grid->level[0].count[axis] = grid->dimension[axis] / HL_NEAR_CELLS + 1;
    cells *= (size_t)grid->level[0].count[axis];
  }
  job->plane = (size_t)grid->level[0].count[0] * (size_t)grid->level[0].count[1];
  job->scratch_floats = (2 * CELL_TAPS + 2) * job->plane +
                        2 * (size_t)grid->dimension[1] * (size_t)grid->level[0].count[0] +
                        (size_t)grid->dimension[0] + 6;
  job->scratch_bytes = CELL_LAYERS * 2 * job->plane + greatest_layer_bytes(grid);
  return cells < INT32_MAX;
}

uint64_t hl_cell_bounds_bytes(const size_t dimension[3], int threads) {
  grid sized = {0};
  bound_job job = {0};
  for (int axis = 0; axis < 3; axis++) {
    sized.dimension[axis] = (int32_t)dimension[axis];
    sized.brick_count[axis] = sized.dimension[axis] / HL_BRICK_CELLS + 1;
  }
  if (!size_scratch(&sized, &job)) return 0;
  uint64_t near = (uint64_t)job.plane * (uint64_t)sized.level[0].count[2] + hl_grid_bricks(&sized) + 8;
  uint64_t kept = (uint64_t)sized.brick_count[2] * (sizeof *sized.cell_bounds + greatest_layer_bytes(&sized));
  return near + kept + (uint64_t)threads * (job.scratch_floats * sizeof(float) + job.scratch_bytes);
}

hl_status hl_cell_bounds_build(hl_context *context, hl_pool *pool, bound_along_function *along,
                               bound_across_function *across, bool smooth, grid *grid, hl_error *error) {
  bound_job job = {.grid = grid, .along = along, .across = across, .smooth = smooth, .context = context};
  size_t threads = (size_t)hl_pool_threads(pool), layers = (size_t)grid->brick_count[2];
  if (!size_scratch(grid, &job)) return HL_OK; /* bricks decide alone */
  job.scratch = hl_allocate(context, threads * job.scratch_floats, sizeof(float));
  job.bytes = hl_allocate(context, threads, job.scratch_bytes);
  grid->cell_bounds = hl_allocate_zeroed(context, layers, sizeof *grid->cell_bounds);
  hl_status status = allocate_levels(context, grid, error);
  job.failed = job.scratch == NULL || job.bytes == NULL || grid->cell_bounds == NULL;
  if (status == HL_OK && !job.failed)
    hl_pool_run(pool, (layers + LAYERS_A_TASK - 1) / LAYERS_A_TASK, bound_layers, &job);
  if (status == HL_OK && job.failed)
    status = hl_fail_memory(error, layers * greatest_layer_bytes(grid), "the bounds of a volume's cells");
  hl_release(context, job.scratch);
  hl_release(context, job.bytes);
  return status;
}

void hl_cell_bounds_release(hl_context *context, grid *grid) {
  for (int32_t layer = 0; grid->cell_bounds != NULL && layer < grid->brick_count[2]; layer++)
    hl_release(context, grid->cell_bounds[layer]);
  hl_release(context, grid->cell_bounds);
  for (int i = 0; i < CELL_LEVELS; i++) hl_release(context, grid->level[i].near);
}
