/* splat/bricks.c - bounds of bricks (once a volume) and their relevance (once a transfer function).
 *
 * A voxel can be dropped only if every point that it contributes to is transparent, whatever else
 * contributes there. By the convex hull of non-negative kernels, a point's density lies between the least
 * and the greatest of its 64 voxels; a partial sum lies between those and empty. So a brick matters if
 * anything between its bounds, stretched to empty, is visible (derived). One more cell on each side keeps
 * the neighbours that slabs across its faces read. */
#include "splat/bricks.h"

#include <float.h>

#include <string.h>

#include "core/memory.h"

enum {
  BEFORE = 3,
  AFTER = 5, /* brick b of an axis depends on voxels 4b-3 .. 4b+5 */
  WINDOW = BEFORE + AFTER + 1
};

static int32_t clamp_index(int64_t i, int32_t count) {
  return (int32_t)(i < 0 ? 0 : i >= count ? count - 1 : i);
}

typedef struct bound_job {
  const grid *grid;
  bound_rows_function *bound_rows;
} bound_job;

/* What every brick takes: its bounds, whether it is relevant, its place in the list of those that are. */
static size_t brick_bytes(hl_storage storage) { return 2 * hl_storage_bytes(storage) + 1 + sizeof(uint32_t); }

/* A float holds the values of every type. */
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

/* Bounds along x of a brick row that begins at a brick, from the bounds of its columns. */
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

static void bound_brick_row(const bound_job *job, int32_t by, int32_t bz, float *least, float *greatest) {
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

typedef struct bound_scratch {
  bound_job job;
  float *columns; /* [threads][2][dimension 0] */
} bound_scratch;

static void bound_slab(void *data, size_t index, int worker) {
  bound_scratch *scratch = data;
  size_t width = (size_t)scratch->job.grid->dimension[0];
  float *least = scratch->columns + (size_t)worker * 2 * width;
  for (int32_t by = 0; by < scratch->job.grid->brick_count[1]; by++)
    bound_brick_row(&scratch->job, by, (int32_t)index, least, least + width);
}

typedef struct replace_job {
  const float *from;
  float *to;
  size_t slice; /* voxels */
  float empty;
} replace_job;

static void replace_slice(void *data, size_t index, int worker) {
  (void)worker;
  const replace_job *job = data;
  for (size_t i = index * job->slice; i < (index + 1) * job->slice; i++)
    job->to[i] = isfinite(job->from[i]) ? job->from[i] : job->empty;
}

/* A copy of f32 voxels in which every non-finite one is empty. */
static hl_status replace_nonfinite(hl_context *context, hl_pool *pool, const hl_volume *volume, grid *grid,
                                   hl_error *error) {
  size_t count = hl_volume_voxel_count(volume);
  float *copy = hl_allocate(context, count, sizeof *copy);
  if (copy == NULL) return hl_fail_memory(error, count * sizeof *copy, "a copy of the voxels without NaN");
  replace_job job = {volume->voxels, copy, volume->dimension[0] * volume->dimension[1], grid->empty};
  hl_pool_run(pool, volume->dimension[2], replace_slice, &job);
  grid->voxels = grid->finite_voxels = copy;
  return HL_OK;
}

static hl_status bound_bricks(hl_context *context, hl_pool *pool, bound_rows_function *bound_rows, grid *grid,
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
    return hl_fail_memory(error, bricks * brick_bytes(grid->storage) + column_count * sizeof(float),
                          "the bricks of a volume");
  }
  bound_scratch scratch = {{grid, bound_rows}, columns};
  hl_pool_run(pool, (size_t)grid->brick_count[2], bound_slab, &scratch);
  hl_release(context, columns);
  return HL_OK;
}

/* The range that cells' bounds are steps of: of all stored values, empty included. */
static void set_cell_range(const hl_volume *volume, grid *grid) {
  float a = (float)((volume->minimum - volume->value_offset) / volume->value_scale);
  float b = (float)((volume->maximum - volume->value_offset) / volume->value_scale);
  float low = fminf(fminf(a, b), grid->empty), high = fmaxf(fmaxf(a, b), grid->empty);
  grid->cell_base = grid->storage == HL_STORAGE_U8 ? 0 : low;
  grid->cell_step = grid->storage == HL_STORAGE_U8 ? 1 : high > low ? fmaxf((high - low) / 255, FLT_MIN) : 1;
}

static hl_status make_room_for_bits(hl_context *context, grid *grid, hl_error *error) {
  size_t bricks = hl_grid_bricks(grid);
  grid->cell_bits = hl_allocate(context, bricks, sizeof *grid->cell_bits);
  return grid->cell_bits != NULL
             ? HL_OK
             : hl_fail_memory(error, bricks * sizeof *grid->cell_bits, "the bits of a volume's cells");
}

uint64_t hl_grid_bytes(const hl_volume *volume, const grid_functions *functions, int threads) {
  uint64_t bricks = 1;
  for (int axis = 0; axis < 3; axis++) bricks *= volume->dimension[axis] / HL_BRICK_CELLS + 1;
  uint64_t copied = volume->nonfinite_count > 0 ? hl_volume_voxel_count(volume) * sizeof(float) : 0;
  int32_t dimension[3] = {(int32_t)volume->dimension[0], (int32_t)volume->dimension[1],
                          (int32_t)volume->dimension[2]};
  if (hl_columns_wanted(functions->column_slice, dimension, volume->storage))
    copied += hl_columns_bytes(dimension);
  return copied + bricks * brick_bytes(volume->storage) + hl_cell_bits_bytes(bricks) +
         hl_cell_bounds_bytes(volume->dimension, threads);
}

hl_status hl_grid_create(hl_context *context, hl_pool *pool, const grid_functions *functions,
                         const kernel *kernel, const hl_scene_volume *scene_volume, affine3 index_to_frame,
                         double empty, grid *grid, hl_error *error) {
  const hl_volume *volume = scene_volume->volume;
  *grid = (struct grid){0};
  grid->voxels = volume->voxels;
  grid->storage = volume->storage;
  grid->value_scale = volume->value_scale;
  grid->value_offset = volume->value_offset;
  grid->empty = (float)((empty - volume->value_offset) / volume->value_scale);
  grid->index_to_frame = index_to_frame;
  if (!affine3_invert(index_to_frame, &grid->frame_to_index))
    return hl_fail(error, HL_ERROR_INPUT, "a volume's axes are singular: the three must span space");
  hl_scene_volume_box(scene_volume, grid->box_low, grid->box_high);
  for (int axis = 0; axis < 3; axis++) {
    grid->dimension[axis] = (int32_t)volume->dimension[axis];
    grid->brick_count[axis] = grid->dimension[axis] / HL_BRICK_CELLS + 1;
  }
  hl_status status = HL_OK;
  if (volume->nonfinite_count > 0) status = replace_nonfinite(context, pool, volume, grid, error);
  if (status == HL_OK && hl_columns_wanted(functions->column_slice, grid->dimension, grid->storage))
    status = hl_columns_build(context, pool, functions->column_slice, grid, error);
  if (status == HL_OK) status = bound_bricks(context, pool, functions->rows[grid->storage], grid, error);
  if (status == HL_OK && hl_cell_bits_wanted(grid, kernel)) status = make_room_for_bits(context, grid, error);
  set_cell_range(volume, grid);
  if (status == HL_OK)
    status = hl_cell_bounds_build(context, pool, functions->along, functions->across,
                                  kernel->degree == HL_BSPLINE_DEGREE, grid, error);
  if (status != HL_OK) hl_grid_release(context, grid);
  return status;
}

void hl_grid_release(hl_context *context, grid *grid) {
  hl_release(context, grid->brick_bounds);
  hl_release(context, grid->relevant);
  hl_cell_bounds_release(context, grid);
  hl_release(context, grid->relevant_list);
  hl_release(context, grid->cell_bits);
  hl_release(context, grid->finite_voxels);
  hl_release(context, grid->columns);
  *grid = (struct grid){0};
}

typedef struct mark_job {
  grid *grid;
  const classifier *classifier;
} mark_job;

/* Overlap of brick b's own cells with the clipped box. */
static bool brick_in_box(const grid *grid, const int32_t b[3]) {
  for (int axis = 0; axis < 3; axis++) {
    double low = (double)b[axis] * HL_BRICK_CELLS - 1, high = low + HL_BRICK_CELLS;
    if (high + 1 < grid->box_low[axis] || low - 1 > grid->box_high[axis]) return false;
  }
  return true;
}

static void mark_slab(void *data, size_t index, int worker) {
  (void)worker;
  mark_job *job = data;
  grid *grid = job->grid;
  int32_t b[3] = {0, 0, (int32_t)index};
  size_t at = index * (size_t)grid->brick_count[1] * (size_t)grid->brick_count[0];
  for (b[1] = 0; b[1] < grid->brick_count[1]; b[1]++)
    for (b[0] = 0; b[0] < grid->brick_count[0]; b[0]++, at++) {
      float bounds[2];
      hl_bounds_of_brick(grid, at, bounds);
      grid->relevant[at] = brick_in_box(grid, b) &&
                           hl_classifier_range_visible(job->classifier, grid, bounds[0], bounds[1]);
    }
}

/* Voxels of the volume that brick b owns along one axis, so that every voxel has one owner. */
static int voxels_along(int32_t b, int32_t count) {
  int32_t first = b * HL_BRICK_CELLS, last = first + HL_BRICK_CELLS;
  if (last > count) last = count;
  return last > first ? last - first : 0;
}

/* Within a voxel of the box's faces. */
static bool brick_reaches_faces(const grid *grid, const int32_t b[3]) {
  for (int axis = 0; axis < 3; axis++) {
    double low = (double)b[axis] * HL_BRICK_CELLS - 1, high = low + HL_BRICK_CELLS;
    if (low - 1 < grid->box_low[axis] || high + 1 > grid->box_high[axis]) return true;
  }
  return false;
}

void hl_grid_mark_relevant(grid *grid, const grid_functions *functions, const classifier *classifier,
                           hl_pool *pool) {
  mark_job job = {grid, classifier};
  hl_pool_run(pool, (size_t)grid->brick_count[2], mark_slab, &job);
  hl_cells_mark_visible(grid, classifier, pool);
  grid->kept_voxels = 0;
  grid->relevant_count = 0;
  grid->cut = false;
  bool first = true;
  for (size_t at = 0; at < hl_grid_bricks(grid); at++) {
    if (!grid->relevant[at]) continue;
    int32_t b[3];
    hl_grid_brick_place(grid, (uint32_t)at, b);
    for (int axis = 0; axis < 3; axis++) {
      if (first || b[axis] < grid->relevant_low[axis]) grid->relevant_low[axis] = b[axis];
      if (first || b[axis] > grid->relevant_high[axis]) grid->relevant_high[axis] = b[axis];
    }
    first = false;
    if (hl_brick_is_visible(grid, at)) grid->relevant_list[grid->relevant_count++] = (uint32_t)at;
    grid->cut = grid->cut || brick_reaches_faces(grid, b);
    grid->kept_voxels += (uint64_t)voxels_along(b[0], grid->dimension[0]) *
                         (uint64_t)voxels_along(b[1], grid->dimension[1]) *
                         (uint64_t)voxels_along(b[2], grid->dimension[2]);
  }
  hl_cell_bits_find(grid, classifier, functions->brick_bits, pool);
  hl_cells_mark_near(grid, pool);
}
