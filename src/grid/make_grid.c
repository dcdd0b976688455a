/* grid/make_grid.c - see make_grid.h. */
#include "grid/make_grid.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "grid/bounds.h"
#include "grid/relevant.h"

/* ---- copies of voxels ---- */

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

/* Copies f32 voxels and replaces non-finite values by the empty value. */
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

/* Slices and columns lie an odd number of cache lines apart: at powers of two, all would share few of the
 * cache's sets. */
static size_t odd_lines(size_t bytes) {
  enum { LINE = 64 };
  return ((bytes + LINE - 1) / LINE | 1) * LINE;
}

static size_t slice_bytes(const int32_t dimension[3]) {
  return odd_lines((size_t)dimension[1] * GRID_COLUMN);
}
static size_t column_bytes(const int32_t dimension[3]) {
  return odd_lines((size_t)dimension[2] * slice_bytes(dimension));
}
static uint64_t columns_bytes(const int32_t dimension[3]) {
  return (uint64_t)((dimension[0] + GRID_COLUMN - 1) / GRID_COLUMN) * column_bytes(dimension);
}

/* Whether some function reads the grid's columns, and the grid's slices are large enough for windows of 8x8
 * voxels. */
static bool wants_columns(const grid_functions *functions, const int32_t dimension[3], hl_storage storage) {
  return functions->reads_columns && storage == HL_STORAGE_U8 && dimension[0] >= GRID_COLUMN &&
         dimension[1] >= GRID_COLUMN;
}

/* Copies a slice into all columns, values reduced by 128. The last column is not filled past the row's end:
 * no sum includes these values. */
static void copy_slice(void *data, size_t index, int worker) {
  (void)worker;
  const grid *grid = data;
  size_t count_x = (size_t)grid->dimension[0], count_y = (size_t)grid->dimension[1];
  const unsigned char *rows = (const unsigned char *)grid->voxels + index * count_x * count_y;
  unsigned char *column = grid->columns + index * grid->column_slice_bytes;
  for (size_t x = 0; x < count_x; x += GRID_COLUMN, column += grid->column_bytes) {
    size_t width = count_x - x < GRID_COLUMN ? count_x - x : GRID_COLUMN;
    for (size_t y = 0; y < count_y; y++) {
      const unsigned char *from = rows + y * count_x + x;
      uint64_t voxels = 0;
      if (width == GRID_COLUMN) memcpy(&voxels, from, GRID_COLUMN);
      else memcpy(&voxels, from, width);
      voxels ^= 0x8080808080808080u;
      memcpy(column + y * GRID_COLUMN, &voxels, GRID_COLUMN);
    }
  }
}

static hl_status build_columns(hl_context *context, hl_pool *pool, grid *grid, hl_error *error) {
  grid->column_slice_bytes = slice_bytes(grid->dimension);
  grid->column_bytes = column_bytes(grid->dimension);
  grid->columns = hl_allocate(context, (size_t)columns_bytes(grid->dimension), 1);
  if (grid->columns == NULL)
    return hl_fail_memory(error, (size_t)columns_bytes(grid->dimension), "the columns of a volume");
  hl_pool_run(pool, (size_t)grid->dimension[2], copy_slice, grid);
  return HL_OK;
}

/* ---- the grid ---- */

static hl_status allocate_bits(hl_context *context, grid *grid, hl_error *error) {
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
  if (wants_columns(functions, dimension, volume->storage)) copied += columns_bytes(dimension);
  return copied + bricks * hl_brick_bytes(volume->storage) + hl_cell_bits_bytes(bricks) +
         hl_cell_bounds_bytes(volume->dimension, threads);
}

hl_status hl_grid_create(hl_context *context, hl_pool *pool, const grid_functions *functions,
                         const grid_source *source, grid *grid, hl_error *error) {
  const hl_volume *volume = source->volume->volume;
  *grid = (struct grid){0};
  grid->voxels = volume->voxels;
  grid->storage = volume->storage;
  grid->value_scale = volume->value_scale;
  grid->value_offset = volume->value_offset;
  grid->empty = (float)((source->empty - volume->value_offset) / volume->value_scale);
  grid->index_to_frame = source->index_to_frame;
  if (!affine3_invert(source->index_to_frame, &grid->frame_to_index))
    return hl_fail(error, HL_ERROR_INPUT, "a volume's axes are singular: the three must span space");
  hl_scene_volume_box(source->volume, grid->box_low, grid->box_high);
  for (int axis = 0; axis < 3; axis++) {
    grid->dimension[axis] = (int32_t)volume->dimension[axis];
    grid->brick_count[axis] = grid->dimension[axis] / HL_BRICK_CELLS + 1;
  }
  hl_status status = HL_OK;
  if (volume->nonfinite_count > 0) status = replace_nonfinite(context, pool, volume, grid, error);
  if (status == HL_OK && wants_columns(functions, grid->dimension, grid->storage))
    status = build_columns(context, pool, grid, error);
  if (status == HL_OK) status = hl_bricks_bound(context, pool, functions, grid, error);
  bool smooth = source->kernel->degree == HL_BSPLINE_DEGREE;
  if (status == HL_OK && smooth && hl_cell_bits_bytes(hl_grid_bricks(grid)) > 0)
    status = allocate_bits(context, grid, error);
  if (status == HL_OK) status = hl_cells_bound(context, pool, functions, smooth, volume, grid, error);
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
