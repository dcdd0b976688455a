/* grid/bounds.c - see bounds.h. */
#include "grid/bounds.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "bricks/evaluate.h"
#include "core/memory.h"
#include "volume/brick_bounds.h"

/* ---- bricks ---- */

enum { BEFORE = BRICK_BEFORE, AFTER = BRICK_AFTER, WINDOW = BEFORE + AFTER + 1 };
_Static_assert((int)HL_BRICK_CELLS == (int)BRICK_SIDE, "volumes and grids have the same bricks");

/* The number of bytes that must be readable after the last element of an array. Vector code reads such arrays
 * four bytes at a time. */
enum { READ_BEYOND = 4 };

static int32_t clamp_index(int64_t i, int32_t count) {
  return (int32_t)(i < 0 ? 0 : i >= count ? count - 1 : i);
}

typedef struct brick_job {
  const grid *grid;
  bound_rows_function *bound_rows;
  /* [threads][2][dimension 0]; for each x, the least and the greatest value of the voxels on which a row of
   * bricks depends */
  float *columns;
  unsigned char *copies; /* [threads][WINDOW * WINDOW][copy_bytes]; copies of rows, for grids with pages */
  size_t copy_bytes;
  /* number of the first layer of bricks that this job bounds; if several ranks share the volume, other ranks
   * bound the layers before this layer */
  size_t first;
} brick_job;

/* Stores the least and the greatest value of a brick, converted to the voxels' type. low and high are floats,
 * which represent the values of every voxel type exactly. */
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

/* Finds the bounds of a row of bricks. brick: the number of the row's first brick. least, greatest: for each
 * x, the bounds of the voxels on which the row's bricks depend. */
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

/* Bounds a row of bricks. copies: room for WINDOW * WINDOW rows, for grids with pages. */
static void bound_brick_row(const brick_job *job, int32_t by, int32_t bz, float *least, float *greatest,
                            unsigned char *copies) {
  const grid *grid = job->grid;
  size_t width = (size_t)grid->dimension[0];
  const void *rows[WINDOW * WINDOW];
  int row_count = 0;
  int32_t y0 = clamp_index((int64_t)by * HL_BRICK_CELLS - BEFORE, grid->dimension[1]);
  int32_t y1 = clamp_index((int64_t)by * HL_BRICK_CELLS + AFTER, grid->dimension[1]);
  int32_t z0 = clamp_index((int64_t)bz * HL_BRICK_CELLS - BEFORE, grid->dimension[2]);
  int32_t z1 = clamp_index((int64_t)bz * HL_BRICK_CELLS + AFTER, grid->dimension[2]);
  for (int32_t z = z0; z <= z1; z++)
    for (int32_t y = y0; y <= y1; y++, row_count++)
      if (grid->pages == NULL) {
        rows[row_count] = hl_grid_row(grid, y, z);
      } else {
        void *copy = copies + (size_t)row_count * job->copy_bytes;
        hl_pages_load_row(grid->pages, (size_t)y, (size_t)z, copy);
        rows[row_count] = copy;
      }
  job->bound_rows(rows, row_count, width, least, greatest);
  size_t at = ((size_t)bz * (size_t)grid->brick_count[1] + (size_t)by) * (size_t)grid->brick_count[0];
  reduce_row(grid, least, greatest, at);
}

static void bound_layer_of_bricks(void *data, size_t index, int worker) {
  const brick_job *job = data;
  size_t width = (size_t)job->grid->dimension[0];
  float *least = job->columns + (size_t)worker * 2 * width;
  for (int32_t by = 0; by < job->grid->brick_count[1]; by++)
    bound_brick_row(job, by, (int32_t)(job->first + index), least, least + width,
                    job->copies + (size_t)worker * WINDOW * WINDOW * job->copy_bytes);
}

/* The bounds of bricks that were found while the volume's voxels were stored; null if no bounds were stored.
 */
static void *stored_bounds(const grid *grid) {
  const hl_brick_bounds *bricks = grid->pages != NULL ? grid->pages->bricks : NULL;
  return bricks != NULL && hl_brick_bounds_whole(bricks) ? bricks->bounds : NULL;
}

void hl_bricks_lay_out(grid *grid, hl_layout *layout) {
  size_t bricks = hl_grid_bricks(grid);
  grid->brick_bounds = stored_bounds(grid);
  if (grid->brick_bounds == NULL)
    grid->brick_bounds = hl_layout_take(layout, bricks, 2 * hl_storage_bytes(grid->storage));
  grid->relevant = hl_layout_take(layout, bricks + READ_BEYOND, 1);
  grid->relevant_list = hl_layout_take(layout, bricks, sizeof *grid->relevant_list);
}

/* Finds the bounds of a layer of the grid's bricks from the coefficients of a field in bricks. The grid's
 * cells are the cells of the field's lattice. */
static void bound_layer_of_field(void *data, size_t index, int worker) {
  (void)worker;
  const grid *grid = ((const brick_job *)data)->grid;
  const size_t width = (size_t)grid->brick_count[0];
  for (size_t bx = 0; bx < width; bx += HL_BRICKS_ROW) {
    const size_t count = width - bx < HL_BRICKS_ROW ? width - bx : HL_BRICKS_ROW;
    hl_bricks_row row = {.boxes = {0}};
    for (size_t by = 0; by < (size_t)grid->brick_count[1]; by++) {
      const size_t brick[3] = {bx, by, index}, at = (index * (size_t)grid->brick_count[1] + by) * width + bx;
      int64_t first[3], last[3];
      for (int axis = 0; axis < 3; axis++) {
        first[axis] = (int64_t)brick[axis] * HL_BRICK_CELLS - 1;
        last[axis] = ((int64_t)brick[axis] + 1) * HL_BRICK_CELLS;
      }
      hl_bricks_ranges(grid->bricks, first, last, HL_BRICK_CELLS, count, &row);
      for (size_t n = 0; n < count; n++) store_bounds(grid, at + n, row.ranges[n][0], row.ranges[n][1]);
    }
  }
}

/* Lays out the scratch memory of all threads for bounds of bricks. */
static void lay_out_columns(brick_job *job, int threads, hl_layout *layout) {
  size_t width = (size_t)job->grid->dimension[0];
  job->columns = hl_layout_take(layout, (size_t)threads * 2 * width, sizeof *job->columns);
  job->copy_bytes = job->grid->pages != NULL ? width * hl_storage_bytes(job->grid->storage) : 0;
  job->copies = hl_layout_take(layout, (size_t)threads * WINDOW * WINDOW, job->copy_bytes);
}

void hl_bricks_run(hl_pool *pool, const grid *grid, void (*function)(void *data, size_t index, int worker),
                   void *data, size_t *first, void *stored, size_t layer_bytes) {
  const size_t layers = (size_t)grid->brick_count[2];
  *first = 0;
  if (grid->pages == NULL || grid->pages->blocks == NULL) {
    hl_pool_run(pool, layers, function, data);
    return;
  }
  hl_ranks *ranks = hl_blocks_ranks(grid->pages->blocks);
  *first = hl_ranks_part(ranks, layers, ranks->rank);
  hl_pool_run(pool, hl_ranks_part(ranks, layers, ranks->rank + 1) - *first, function, data);
  hl_ranks_complete(ranks, stored, layers, layer_bytes);
}

hl_status hl_bricks_bound(hl_context *context, hl_pool *pool, const grid_functions *functions, grid *grid,
                          hl_error *error) {
  memset(grid->relevant, 0, hl_grid_bricks(grid) + READ_BEYOND);
  if (stored_bounds(grid) != NULL) return HL_OK;
  brick_job job = {.grid = grid, .bound_rows = functions->rows[grid->storage]};
  if (grid->bricks != NULL) {
    hl_pool_run(pool, (size_t)grid->brick_count[2], bound_layer_of_field, &job);
    return HL_OK;
  }
  hl_layout layout = {0};
  while (hl_layout_pass(&layout, context)) lay_out_columns(&job, hl_pool_threads(pool), &layout);
  if (layout.base == NULL) return hl_fail_memory(error, layout.bytes, "the bricks of a volume");
  const size_t layer_bricks = (size_t)grid->brick_count[0] * (size_t)grid->brick_count[1];
  hl_bricks_run(pool, grid, bound_layer_of_bricks, &job, &job.first, grid->brick_bounds,
                layer_bricks * 2 * hl_storage_bytes(grid->storage));
  if (grid->pages != NULL) hl_pages_forget(grid->pages);
  hl_release(context, job.columns);
  return HL_OK;
}

/* ---- cells ---- */

/* Sets the range within which bounds of cells are kept, as numbers of steps from 0 to 255. The range holds
 * all stored values and the empty value. */
static void set_cell_range(const hl_volume *volume, grid *grid) {
  float a = (float)((volume->minimum - volume->value_offset) / volume->value_scale);
  float b = (float)((volume->maximum - volume->value_offset) / volume->value_scale);
  float low = fminf(fminf(a, b), grid->empty), high = fmaxf(fmaxf(a, b), grid->empty);
  grid->cell_base = grid->storage == HL_STORAGE_U8 ? 0 : low;
  grid->cell_step = grid->storage == HL_STORAGE_U8 ? 1 : high > low ? fmaxf((high - low) / 255, FLT_MIN) : 1;
}

/* Finds the bounds of all cells. The bounds are computed slice by slice. The grid keeps them packed for all
 * later transfer functions. Packing saves memory, because most bricks of a volume are empty or even. */
enum { CELL_LAYERS = HL_BRICK_CELLS / HL_LOOKUP_CELLS, LAYERS_A_TASK = 4 };

typedef struct cell_job {
  const grid *grid;
  const grid_functions *functions;
  bool smooth; /* whether the kernel is the B-spline */
  hl_context *context;
  size_t plane;                /* number of 2x2x2 cells in a slice */
  struct bound_slices *slices; /* [workers]; the scratch memory of each worker */
  bool failed;                 /* whether memory was short; read and written atomically */
} cell_job;

/* Finds the bounds of 2x2 cells in one slice of voxels, along x and y. slice: [2][cells y][cells x]; receives
 * the lower and the upper bounds. */
static void bound_slice(const cell_job *job, int32_t z, float *rows, float *padded, float *slice) {
  const grid *grid = job->grid;
  size_t width = (size_t)grid->lookup[0].count[0];
  int32_t height = grid->dimension[1];
  for (int32_t y = 0; y < height; y++) {
    job->functions->along(grid->storage, hl_grid_row(grid, y, z), grid->dimension[0], job->smooth, padded,
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

/* Rounds bounds outwards to 255 steps of the volume's range. A bound that lies beyond a step by less than a
 * ten-thousandth of a step is rounded to this step. The errors of float sums are far smaller than this
 * tolerance, and an entry of the transfer function's table is sixteen times finer than a step. */
static void round_bounds(const grid *grid, const float *low, const float *high, size_t count,
                         unsigned char *to_low, unsigned char *to_high) {
  float inverse = 1 / grid->cell_step;
  for (size_t i = 0; i < count; i++) {
    float a = floorf((low[i] - grid->cell_base) * inverse + 1e-4f),
          b = ceilf((high[i] - grid->cell_base) * inverse - 1e-4f);
    /* the bound `a` is NaN if the caller, who owns borrowed voxels, has changed some of them to NaN */
    to_low[i] = (unsigned char)(a > 255 ? 255 : a > 0 ? a : 0);
    to_high[i] = (unsigned char)(b < 0 ? 0 : b < 255 ? b : 255);
  }
}

/* ---- packing ---- */

static size_t even_bytes(const grid *grid) { return hl_even_row_bytes(grid) * (size_t)grid->brick_count[1]; }

static size_t greatest_layer_bytes(const grid *grid) {
  return even_bytes(grid) + UNEVEN_BYTES * (size_t)grid->brick_count[0] * (size_t)grid->brick_count[1];
}

/* The four rows of groups of 2x2x2 cells in a row of bricks: two rows in each of two layers. */
typedef const unsigned char *cell_rows[2 * CELL_LAYERS];

/* Copies the bounds of the eight groups of cells of a brick. A row gives two groups, which are neighbours
 * along x. */
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

/* Packs the bounds of a layer of bricks (bounds.h). Returns the number of bytes of the packed bounds. bounds:
 * [CELL_LAYERS][2][plane]; lower, then upper bounds. */
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

/* One worker's scratch memory: bounds of slices of voxels along x and y, and bounds of cells that are made
 * from the slices' bounds. */
typedef struct bound_slices {
  float *slices;           /* [CELL_TAPS][2][plane]; bounds along x and y; slice z of the volume is element
                            * z % CELL_TAPS */
  float *out;              /* [2][plane]; bounds of cells along all axes */
  float *rows, *padded;    /* scratch memory of bound_slice() */
  unsigned char *bounds;   /* [CELL_LAYERS][2][plane]; bounds of a layer of bricks */
  unsigned char *packed;   /* the packed numbers of `bounds` */
  int32_t held[CELL_TAPS]; /* for each element of `slices`, the number of the volume's slice that the element
                            * holds; -1 if the element holds no slice */
} bound_slices;

/* Computes the bounds of the cells in a slice from the bounds of slices of voxels. */
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
  bound_slices *s = &job->slices[worker];
  for (int tap = 0; tap < CELL_TAPS; tap++) s->held[tap] = -1;
  int32_t end = ((int32_t)index + 1) * LAYERS_A_TASK;
  for (int32_t layer = (int32_t)index * LAYERS_A_TASK; layer < end && layer < grid->brick_count[2]; layer++) {
    for (int32_t k = 0; k < CELL_LAYERS; k++) {
      int32_t f = CELL_LAYERS * layer + k;
      if (f < grid->lookup[0].count[2]) bound_cells(job, s, f, s->bounds + (size_t)k * 2 * plane);
      else memcpy(s->bounds + (size_t)k * 2 * plane, s->bounds, 2 * plane);
    }
    size_t bytes = pack_layer(grid, s->bounds, plane, s->packed);
    grid->cell_bounds[layer] = hl_allocate(job->context, bytes, 1);
    if (grid->cell_bounds[layer] != NULL) memcpy(grid->cell_bounds[layer], s->packed, bytes);
    else __atomic_store_n(&job->failed, true, __ATOMIC_RELAXED);
  }
}

/* ---- memory ---- */

static size_t cells_of(const cell_lookup *lookup) {
  return (size_t)lookup->count[0] * (size_t)lookup->count[1] * (size_t)lookup->count[2];
}

/* Returns whether groups of 2x2x2 cells have bounds of their own. Groups have bounds if 32 bits can number
 * the groups and the voxels are in memory. The counts of the look-ups must be set before. */
static bool cells_have_bounds(const grid *grid) {
  return grid->pages == NULL && grid->bricks == NULL && cells_of(&grid->lookup[0]) < INT32_MAX;
}

void hl_cells_lay_out(grid *grid, hl_layout *layout) {
  for (int axis = 0; axis < 3; axis++)
    grid->lookup[0].count[axis] = grid->dimension[axis] / HL_LOOKUP_CELLS + 1;
  memcpy(grid->lookup[1].count, grid->brick_count, sizeof grid->brick_count);
  if (!cells_have_bounds(grid)) return;
  for (int i = 0; i < LOOKUP_SIZES; i++)
    grid->lookup[i].visible = hl_layout_take(layout, cells_of(&grid->lookup[i]) + READ_BEYOND, 1);
  grid->cell_bounds = hl_layout_take(layout, (size_t)grid->brick_count[2], sizeof *grid->cell_bounds);
}

/* Lays out the scratch memory of all threads for bounds of cells. A pass that only counts bytes sets no
 * member of *job but `plane`. */
static void lay_out_slices(cell_job *job, int threads, hl_layout *layout) {
  const grid *grid = job->grid;
  size_t width = (size_t)grid->lookup[0].count[0], plane = width * (size_t)grid->lookup[0].count[1];
  job->plane = plane;
  job->slices = hl_layout_take(layout, (size_t)threads, sizeof *job->slices);
  for (int i = 0; i < threads; i++) {
    bound_slices made = {0};
    made.slices = hl_layout_take(layout, CELL_TAPS * 2 * plane, sizeof *made.slices);
    made.out = hl_layout_take(layout, 2 * plane, sizeof *made.out);
    made.rows = hl_layout_take(layout, 2 * (size_t)grid->dimension[1] * width, sizeof *made.rows);
    made.padded = hl_layout_take(layout, (size_t)grid->dimension[0] + 6, sizeof *made.padded);
    made.bounds = hl_layout_take(layout, CELL_LAYERS * 2, plane);
    made.packed = hl_layout_take(layout, greatest_layer_bytes(grid), 1);
    if (job->slices != NULL) job->slices[i] = made;
  }
}

void hl_bounds_count(const grid *grid, int threads, hl_layout *layout) {
  const size_t kept = layout->bytes;
  if (stored_bounds(grid) == NULL && grid->bricks == NULL)
    lay_out_columns(&(brick_job){.grid = grid}, threads, layout);
  hl_layout_give_back(layout, kept);
  if (!cells_have_bounds(grid)) return;
  /* room for the packed bounds of all layers */
  hl_layout_take(layout, (size_t)grid->brick_count[2], greatest_layer_bytes(grid));
  const size_t packed = layout->bytes;
  lay_out_slices(&(cell_job){.grid = grid}, threads, layout);
  hl_layout_give_back(layout, packed);
}

hl_status hl_cells_bound(hl_context *context, hl_pool *pool, const grid_functions *functions, bool smooth,
                         const hl_volume *volume, grid *grid, hl_error *error) {
  cell_job job = {.grid = grid, .functions = functions, .smooth = smooth, .context = context};
  size_t layers = (size_t)grid->brick_count[2];
  set_cell_range(volume, grid);
  /* Without bounds of cells, only the bricks tell where something is visible. */
  if (!cells_have_bounds(grid)) return HL_OK;
  hl_layout layout = {0};
  while (hl_layout_pass(&layout, context)) lay_out_slices(&job, hl_pool_threads(pool), &layout);
  if (layout.base == NULL) return hl_fail_memory(error, layout.bytes, "the bounds of a volume's cells");
  hl_pool_run(pool, (layers + LAYERS_A_TASK - 1) / LAYERS_A_TASK, bound_layers, &job);
  hl_release(context, job.slices);
  if (!job.failed) return HL_OK;
  return hl_fail_memory(error, layers * greatest_layer_bytes(grid), "the bounds of a volume's cells");
}

void hl_cell_bounds_release(hl_context *context, grid *grid) {
  for (int32_t layer = 0; grid->cell_bounds != NULL && layer < grid->brick_count[2]; layer++)
    hl_release(context, grid->cell_bounds[layer]);
}
