/* grid/bounds.c - see bounds.h. */
#include "grid/bounds.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"

/* ---- bricks ---- */

enum {
  BEFORE = 3,
  AFTER = 5, /* along an axis, brick b depends on voxels 4b-3 .. 4b+5 */
  WINDOW = BEFORE + AFTER + 1
};

static int32_t clamp_index(int64_t i, int32_t count) {
  return (int32_t)(i < 0 ? 0 : i >= count ? count - 1 : i);
}

typedef struct brick_job {
  const grid *grid;
  bound_rows_function *bound_rows;
  float *columns; /* [threads][2][dimension 0] */
} brick_job;

/* The least and greatest values arrive as floats, which represent the values of every voxel type exactly. */
static void store_bounds(const grid *grid, size_t brick, float low, float high) {
  if (grid->storage == HL_STORAGE_U8) {
    uint8_t *bounds = (uint8_t *)grid->brick_bounds + 2 * brick;
    bounds[0] = (uint8_t)low, bounds[1] = (uint8_t)high;
  } else if (grid->storage == HL_STORAGE_U16) {
    uint16_t *bounds = (uint16_t *)grid->brick_bounds + 2 * brick;
    bounds[0] = (uint16_t)low, bounds[1] = (uint16_t)high;
  } else {
    float *bounds = (float *)grid->brick_bounds + 2 * brick;
    bounds[0] = low, bounds[1] = high;
  }
}

void hl_bounds_of_brick(const grid *grid, size_t brick, float bounds[2]) {
  for (size_t i = 0; i < 2; i++)
    bounds[i] = grid->storage == HL_STORAGE_U8    ? ((const uint8_t *)grid->brick_bounds)[2 * brick + i]
                : grid->storage == HL_STORAGE_U16 ? ((const uint16_t *)grid->brick_bounds)[2 * brick + i]
                                                  : ((const float *)grid->brick_bounds)[2 * brick + i];
}

/* Finds the bounds of a row of bricks, the first one number `brick`, from the bounds of the row's voxels at
 * each x. */
static void reduce_row(const grid *grid, const float *least, const float *greatest, size_t brick) {
  for (int32_t b = 0; b < grid->brick_count[0]; b++) {
    int32_t first = clamp_index((int64_t)b * HL_BRICK_CELLS - BEFORE, grid->dimension[0]);
    int32_t last = clamp_index((int64_t)b * HL_BRICK_CELLS + AFTER, grid->dimension[0]);
    float low = least[first], high = greatest[first];
    for (int32_t i = first + 1; i <= last; i++) {
      if (least[i] < low) low = least[i];
      if (greatest[i] > high) high = greatest[i];
    }
    store_bounds(grid, brick + (size_t)b, low, high);
  }
}

static void bound_brick_row(const brick_job *job, int32_t by, int32_t bz, float *least, float *greatest) {
  const grid *grid = job->grid;
  size_t bytes = hl_storage_bytes(grid->storage), width = (size_t)grid->dimension[0];
  const void *rows[WINDOW * WINDOW];
  int row_count = 0;
  int32_t y0 = clamp_index((int64_t)by * HL_BRICK_CELLS - BEFORE, grid->dimension[1]);
  int32_t y1 = clamp_index((int64_t)by * HL_BRICK_CELLS + AFTER, grid->dimension[1]);
  int32_t z0 = clamp_index((int64_t)bz * HL_BRICK_CELLS - BEFORE, grid->dimension[2]);
  int32_t z1 = clamp_index((int64_t)bz * HL_BRICK_CELLS + AFTER, grid->dimension[2]);
  for (int32_t z = z0; z <= z1; z++)
    for (int32_t y = y0; y <= y1; y++)
      rows[row_count++] = (const unsigned char *)grid->voxels +
                          ((size_t)z * (size_t)grid->dimension[1] + (size_t)y) * width * bytes;
  job->bound_rows(rows, row_count, width, least, greatest);
  size_t at = ((size_t)bz * (size_t)grid->brick_count[1] + (size_t)by) * (size_t)grid->brick_count[0];
  reduce_row(grid, least, greatest, at);
}

static void bound_layer_of_bricks(void *data, size_t index, int worker) {
  const brick_job *job = data;
  size_t width = (size_t)job->grid->dimension[0];
  float *least = job->columns + (size_t)worker * 2 * width;
  for (int32_t by = 0; by < job->grid->brick_count[1]; by++)
    bound_brick_row(job, by, (int32_t)index, least, least + width);
}

hl_status hl_bricks_bound(hl_context *context, hl_pool *pool, const grid_functions *functions, grid *grid,
                          hl_error *error) {
  size_t bricks = hl_grid_bricks(grid), width = (size_t)grid->dimension[0];
  size_t column_count = (size_t)hl_pool_threads(pool) * 2 * width;
  grid->brick_bounds = hl_allocate(context, bricks, 2 * hl_storage_bytes(grid->storage));
  grid->relevant = hl_allocate_zeroed(context, bricks + 4, 1); /* read four bytes at a time */
  grid->relevant_list = hl_allocate(context, bricks, sizeof(uint32_t));
  float *columns = hl_allocate(context, column_count, sizeof(float));
  if (grid->brick_bounds == NULL || grid->relevant == NULL || grid->relevant_list == NULL ||
      columns == NULL) {
    hl_release(context, columns);
    return hl_fail_memory(error, bricks * hl_brick_bytes(grid->storage) + column_count * sizeof(float),
                          "the bricks of a volume");
  }
  brick_job job = {grid, functions->rows[grid->storage], columns};
  hl_pool_run(pool, (size_t)grid->brick_count[2], bound_layer_of_bricks, &job);
  hl_release(context, columns);
  return HL_OK;
}

/* ---- cells ---- */

/* Bounds of cells are kept as 0 to 255 steps within the range of all stored values, empty included. */
static void set_cell_range(const hl_volume *volume, grid *grid) {
  float a = (float)((volume->minimum - volume->value_offset) / volume->value_scale);
  float b = (float)((volume->maximum - volume->value_offset) / volume->value_scale);
  float low = fminf(fminf(a, b), grid->empty), high = fmaxf(fmaxf(a, b), grid->empty);
  grid->cell_base = grid->storage == HL_STORAGE_U8 ? 0 : low;
  grid->cell_step = grid->storage == HL_STORAGE_U8 ? 1 : high > low ? fmaxf((high - low) / 255, FLT_MIN) : 1;
}

/* They are computed slice by slice and kept packed, for all later transfer functions. Packing helps because
 * most bricks of a volume are empty or even. */
enum { CELL_LAYERS = HL_BRICK_CELLS / HL_LOOKUP_CELLS, LAYERS_A_TASK = 4 };

typedef struct cell_job {
  grid *grid;
  const grid_functions *functions;
  bool smooth; /* the kernel is the B-spline */
  hl_context *context;
  float *scratch;       /* [workers][scratch_floats] */
  unsigned char *bytes; /* [workers][scratch_bytes] */
  size_t scratch_floats, scratch_bytes;
  size_t plane; /* 2x2x2 cells in a slice */
  bool failed;  /* an allocation failed; atomic */
} cell_job;

/* Bounds of one slice of voxels along x and y. slice: [2][cells y][cells x], low and high. */
static void bound_slice(const cell_job *job, int32_t z, float *rows, float *padded, float *slice) {
  const grid *grid = job->grid;
  size_t width = (size_t)grid->lookup[0].count[0], bytes = hl_storage_bytes(grid->storage);
  int32_t height = grid->dimension[1];
  for (int32_t y = 0; y < height; y++) {
    const unsigned char *row = (const unsigned char *)grid->voxels +
                               ((size_t)z * (size_t)height + (size_t)y) * (size_t)grid->dimension[0] * bytes;
    job->functions->along(grid->storage, row, grid->dimension[0], job->smooth, padded,
                          rows + 2 * (size_t)y * width, rows + (2 * (size_t)y + 1) * width);
  }
  for (int32_t f = 0; f < grid->lookup[0].count[1]; f++) {
    const float *low[CELL_TAPS], *high[CELL_TAPS];
    for (int32_t tap = 0; tap < CELL_TAPS; tap++) {
      int32_t y = 2 * f - 2 + tap;
      y = y < 0 ? 0 : y >= height ? height - 1 : y;
      low[tap] = rows + 2 * (size_t)y * width;
      high[tap] = low[tap] + width;
    }
    job->functions->across(low, high, width, job->smooth, slice + (size_t)f * width,
                           slice + job->plane + (size_t)f * width);
  }
}

/* Rounds outwards to 255 steps of the volume's range, with a tolerance of a ten-thousandth of a step: the
 * errors of float sums are far smaller, and an entry of the transfer function's table is sixteen times finer
 * than a step. */
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

/* A row of bricks has four rows of 2x2x2 cells: two in each of two layers. */
typedef const unsigned char *cell_rows[2 * CELL_LAYERS];

/* Copies the eight cells of a brick, two along x at a time. */
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

/* Packs a layer of bricks (bounds.h); returns its bytes. bounds: [CELL_LAYERS][2][plane], lower and upper. */
static size_t pack_layer(const grid *grid, const unsigned char *bounds, size_t plane, unsigned char *to) {
  const int32_t *count = grid->lookup[0].count;
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
        int number = same ? 0 : cell[0] % 2 + 2 * (cell[1] % 2) + 4 * (cell[2] % 2);
        *low = grid->cell_base + grid->cell_step * next[number];
        *high = grid->cell_base + grid->cell_step * next[number + (same ? 1 : BRICK_CELLS)];
        return;
      }
      next += same ? EVEN_BYTES : UNEVEN_BYTES;
    }
}

/* ---- building ---- */

/* One worker's slices of voxels, with bounds along x and y. */
typedef struct bound_slices {
  float *slices;           /* [CELL_TAPS][2][plane]; slice z is number z % CELL_TAPS */
  float *out;              /* [2][plane] */
  float *rows, *padded;    /* scratch of bound_slice() */
  int32_t held[CELL_TAPS]; /* which slice of voxels each of `slices` holds; -1: none */
} bound_slices;

/* Bounds of a slice of cells. */
static void bound_cells(const cell_job *job, bound_slices *s, int32_t f, unsigned char *bounds) {
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
  job->functions->across(low, high, job->plane, job->smooth, s->out, s->out + job->plane);
  round_bounds(grid, s->out, s->out + job->plane, job->plane, bounds, bounds + job->plane);
}

static void bound_layers(void *data, size_t index, int worker) {
  cell_job *job = data;
  const grid *grid = job->grid;
  size_t plane = job->plane;
  bound_slices s = {.slices = job->scratch + (size_t)worker * job->scratch_floats,
                    .held = {-1, -1, -1, -1, -1}};
  s.out = s.slices + CELL_TAPS * 2 * plane;
  s.rows = s.out + 2 * plane;
  s.padded = s.rows + 2 * (size_t)grid->dimension[1] * (size_t)grid->lookup[0].count[0];
  unsigned char *bounds = job->bytes + (size_t)worker * job->scratch_bytes,
                *packed = bounds + CELL_LAYERS * 2 * plane;
  int32_t end = ((int32_t)index + 1) * LAYERS_A_TASK;
  for (int32_t layer = (int32_t)index * LAYERS_A_TASK; layer < end && layer < grid->brick_count[2]; layer++) {
    for (int32_t k = 0; k < CELL_LAYERS; k++) {
      int32_t f = CELL_LAYERS * layer + k;
      if (f < grid->lookup[0].count[2]) bound_cells(job, &s, f, bounds + (size_t)k * 2 * plane);
      else memcpy(bounds + (size_t)k * 2 * plane, bounds, 2 * plane);
    }
    size_t bytes = pack_layer(grid, bounds, plane, packed);
    grid->cell_bounds[layer] = hl_allocate(job->context, bytes, 1);
    if (grid->cell_bounds[layer] != NULL) memcpy(grid->cell_bounds[layer], packed, bytes);
    else __atomic_store_n(&job->failed, true, __ATOMIC_RELAXED);
  }
}

static hl_status allocate_lookups(hl_context *context, grid *grid, hl_error *error) {
  memcpy(grid->lookup[1].count, grid->brick_count, sizeof grid->brick_count);
  for (int i = 0; i < LOOKUP_SIZES; i++) {
    cell_lookup *lookup = &grid->lookup[i];
    size_t cells = (size_t)lookup->count[0] * (size_t)lookup->count[1] * (size_t)lookup->count[2];
    lookup->visible = hl_allocate(context, cells + 4, 1); /* read four bytes at a time */
    if (lookup->visible == NULL) return hl_fail_memory(error, cells, "the look-up of a volume's cells");
  }
  return HL_OK;
}

/* Sets the sizes of the look-up by cells and of scratch memory, from the grid's dimension and brick_count;
 * false where 32 bits cannot number the cells. */
static bool size_scratch(grid *grid, cell_job *job) {
  size_t cells = 1;
  for (int axis = 0; axis < 3; axis++) {
    grid->lookup[0].count[axis] = grid->dimension[axis] / HL_LOOKUP_CELLS + 1;
    cells *= (size_t)grid->lookup[0].count[axis];
  }
  job->plane = (size_t)grid->lookup[0].count[0] * (size_t)grid->lookup[0].count[1];
  job->scratch_floats = (2 * CELL_TAPS + 2) * job->plane +
                        2 * (size_t)grid->dimension[1] * (size_t)grid->lookup[0].count[0] +
                        (size_t)grid->dimension[0] + 6;
  job->scratch_bytes = CELL_LAYERS * 2 * job->plane + greatest_layer_bytes(grid);
  return cells < INT32_MAX;
}

uint64_t hl_cell_bounds_bytes(const size_t dimension[3], int threads) {
  grid sized = {0};
  cell_job job = {0};
  for (int axis = 0; axis < 3; axis++) {
    sized.dimension[axis] = (int32_t)dimension[axis];
    sized.brick_count[axis] = sized.dimension[axis] / HL_BRICK_CELLS + 1;
  }
  if (!size_scratch(&sized, &job)) return 0;
  uint64_t lookups = (uint64_t)job.plane * (uint64_t)sized.lookup[0].count[2] + hl_grid_bricks(&sized) + 8;
  uint64_t kept = (uint64_t)sized.brick_count[2] * (sizeof *sized.cell_bounds + greatest_layer_bytes(&sized));
  return lookups + kept + (uint64_t)threads * (job.scratch_floats * sizeof(float) + job.scratch_bytes);
}

hl_status hl_cells_bound(hl_context *context, hl_pool *pool, const grid_functions *functions, bool smooth,
                         const hl_volume *volume, grid *grid, hl_error *error) {
  cell_job job = {.grid = grid, .functions = functions, .smooth = smooth, .context = context};
  set_cell_range(volume, grid);
  size_t threads = (size_t)hl_pool_threads(pool), layers = (size_t)grid->brick_count[2];
  if (!size_scratch(grid, &job))
    return HL_OK; /* the grid goes without bounds of cells: bricks alone tell where something is visible */
  job.scratch = hl_allocate(context, threads * job.scratch_floats, sizeof(float));
  job.bytes = hl_allocate(context, threads, job.scratch_bytes);
  grid->cell_bounds = hl_allocate_zeroed(context, layers, sizeof *grid->cell_bounds);
  hl_status status = allocate_lookups(context, grid, error);
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
  for (int i = 0; i < LOOKUP_SIZES; i++) hl_release(context, grid->lookup[i].visible);
}
