/* grid/make_grid.c - see make_grid.h. */
#include "grid/make_grid.h"

#include <math.h>
#include <string.h>

#include "bricks/evaluate.h"
#include "core/memory.h"
#include "grid/bounds.h"
#include "grid/prefilter.h"
#include "grid/relevant.h"
#include "grid/value_pages.h"

/* ---- copies of voxels ---- */

/* The input for making the array finite_voxels: the volume's voxels. */
typedef struct copy_job {
  const grid *grid;
  const hl_volume *volume;
  float greatest;      /* the greatest magnitude of a value, the parameter `greatest` of hl_grid_value() */
  unsigned char *rows; /* [threads][volume->row_bytes]; memory for rows of sparse pages; null if the voxels
                        * are in one array */
} copy_job;

static float stored_of(hl_storage storage, const void *row, size_t x) {
  if (storage == HL_STORAGE_U8) return ((const uint8_t *)row)[x];
  if (storage == HL_STORAGE_U16) return ((const uint16_t *)row)[x];
  return ((const float *)row)[x];
}

static void replace_slice(void *data, size_t index, int worker) {
  const copy_job *job = data;
  const grid *grid = job->grid;
  const hl_volume *volume = job->volume;
  void *copy = job->rows != NULL ? job->rows + (size_t)worker * volume->row_bytes : NULL;
  size_t count_x = (size_t)grid->dimension[0], count_y = (size_t)grid->dimension[1];
  float *to = grid->finite_voxels + index * count_x * count_y;
  for (size_t y = 0; y < count_y; y++, to += count_x) {
    const void *from = hl_volume_row_in(volume, y, index, copy);
    for (size_t x = 0; x < count_x; x++) {
      float value = stored_of(volume->storage, from, x);
      to[x] = hl_grid_value(value, job->greatest, grid->empty);
    }
  }
}

/* Sets the grid's voxels, and the distances in bytes between rows and between slices. */
static void set_voxels(grid *grid, const void *voxels, size_t row_bytes, size_t slice_bytes) {
  grid->voxels = voxels;
  grid->row_bytes = row_bytes;
  grid->slice_bytes = slice_bytes;
}

/* Copies voxels as floats, with the empty value in place of values that are not finite. For an interpolating
 * kernel, the function then turns the copies into the kernel's coefficients. */
static hl_status replace_voxels(hl_pool *pool, const hl_volume *volume, const kernel *kernel, grid *grid,
                                hl_error *error) {
  const size_t threads = (size_t)hl_pool_threads(pool);
  copy_job job = {grid, volume, hl_greatest_value(kernel), NULL};
  if (volume->voxels == NULL) {
    job.rows = hl_allocate(volume->context, threads, volume->row_bytes);
    if (job.rows == NULL) return hl_fail_memory(error, threads * volume->row_bytes, "the grid of a volume");
  }
  hl_pool_run(pool, (size_t)grid->dimension[2], replace_slice, &job);
  hl_release(volume->context, job.rows);
  if (kernel->interpolates) hl_prefilter(pool, grid);
  size_t row_bytes = (size_t)grid->dimension[0] * sizeof *grid->finite_voxels;
  set_voxels(grid, grid->finite_voxels, row_bytes, (size_t)grid->dimension[1] * row_bytes);
  return HL_OK;
}

/* Rounds the size of slices and columns up to an odd number of cache lines. If sizes were powers of two, all
 * slices would fall into a few sets of the processor's cache. */
static size_t odd_lines(size_t bytes) {
  enum { LINE = 64 };
  return ((bytes + LINE - 1) / LINE | 1) * LINE;
}

/* Lays out the memory of the columns, if the instruction set's code reads columns and the grid's slices are
 * large enough for windows of 8x8 voxels. */
static void lay_out_columns(grid *grid, const grid_functions *functions, hl_layout *layout) {
  const int32_t *dimension = grid->dimension;
  if (!functions->reads_columns || grid->storage != HL_STORAGE_U8 || dimension[0] < GRID_COLUMN ||
      dimension[1] < GRID_COLUMN)
    return;
  grid->column_slice_bytes = odd_lines((size_t)dimension[1] * GRID_COLUMN);
  grid->column_bytes = odd_lines((size_t)dimension[2] * grid->column_slice_bytes);
  grid->columns = hl_layout_take(layout, (size_t)((dimension[0] + GRID_COLUMN - 1) / GRID_COLUMN),
                                 grid->column_bytes);
}

/* Copies a slice of voxels into all columns; the values are reduced by 128. The last column is not filled
 * beyond the row's end, because no sum includes values from beyond the row. */
static void copy_slice(void *data, size_t index, int worker) {
  (void)worker;
  const grid *grid = data;
  size_t count_x = (size_t)grid->dimension[0], count_y = (size_t)grid->dimension[1];
  const unsigned char *rows = hl_grid_row(grid, 0, (int64_t)index);
  unsigned char *column = grid->columns + index * grid->column_slice_bytes;
  for (size_t x = 0; x < count_x; x += GRID_COLUMN, column += grid->column_bytes) {
    size_t width = count_x - x < GRID_COLUMN ? count_x - x : GRID_COLUMN;
    for (size_t y = 0; y < count_y; y++) {
      const unsigned char *from = rows + y * grid->row_bytes + x;
      uint64_t voxels = 0;
      if (width == GRID_COLUMN) memcpy(&voxels, from, GRID_COLUMN);
      else memcpy(&voxels, from, width);
      voxels ^= 0x8080808080808080u;
      memcpy(column + y * GRID_COLUMN, &voxels, GRID_COLUMN);
    }
  }
}

/* ---- the grid ---- */

/* Returns whether sampling needs values that differ from the stored values, because some stored values are
 * not finite, or because the kernel needs coefficients. */
static bool needs_other_values(const hl_volume *volume, const kernel *kernel) {
  return volume->bricks == NULL && (volume->nonfinite_count > 0 || kernel->interpolates);
}

/* The greatest number of a cell along an axis. For a grid of n voxels along the axis, the result is n. For a
 * grid of bricks, the result is the number of the cell in which the box ends, but at most the number of the
 * lattice's last cell; the lattice's first cell has the number 0. */
static int32_t greatest_cell(const hl_volume *volume, int axis) {
  if (volume->bricks == NULL) return (int32_t)volume->dimension[axis];
  double end = ceil(volume->bricks->origin[axis] + (double)volume->dimension[axis] - 1.5);
  return (int32_t)fmin(end, (double)hl_bricks_cells(volume->bricks, axis) - 1);
}

/* Returns whether a grid gets one array of values in place of the sparse pages of its volume. */
static bool leaves_sparse_pages(const hl_volume *volume, const kernel *kernel) {
  return volume->pages != NULL && hl_pages_are_sparse(volume->pages) && needs_other_values(volume, kernel);
}

static void set_size(const hl_volume *volume, const kernel *kernel, grid *grid) {
  grid->pages = leaves_sparse_pages(volume, kernel) ? NULL : volume->pages;
  grid->bricks = volume->bricks;
  grid->storage = kernel->interpolates ? HL_STORAGE_F32 : volume->storage;
  for (int axis = 0; axis < 3; axis++) {
    grid->dimension[axis] = greatest_cell(volume, axis);
    if (volume->bricks != NULL) grid->shift[axis] = volume->bricks->origin[axis] - 1;
    grid->brick_count[axis] = grid->dimension[axis] / HL_BRICK_CELLS + 1;
  }
}

/* Lays out the memory of a copy of a field in bricks, and sets the copy's arrays. */
static void lay_out_bricks(const hl_bricks *bricks, grid *grid, hl_layout *layout) {
  const size_t *n = bricks->directory_size;
  hl_bricks arrays = {0};
  grid->finite_bricks = hl_layout_take(layout, 1, sizeof *grid->finite_bricks);
  arrays.directory = hl_layout_take(layout, n[0] * n[1] * n[2], sizeof *arrays.directory);
  arrays.pool = hl_layout_take(layout, bricks->slots * hl_brick_coefficients(bricks), sizeof *arrays.pool);
  if (grid->finite_bricks != NULL) *grid->finite_bricks = arrays;
}

/* Lays out the arrays of a grid whose size is set. */
static void lay_out(grid *grid, const hl_volume *volume, const kernel *kernel,
                    const grid_functions *functions, hl_layout *layout) {
  const bool one_array = grid->pages == NULL && grid->bricks == NULL;
  if (one_array && needs_other_values(volume, kernel))
    grid->finite_voxels = hl_layout_take(layout, hl_volume_voxel_count(volume), sizeof *grid->finite_voxels);
  if (one_array) lay_out_columns(grid, functions, layout);
  if (volume->bricks != NULL && !hl_bricks_are_finite(volume->bricks))
    lay_out_bricks(volume->bricks, grid, layout);
  hl_bricks_lay_out(grid, layout);
  if (grid->bricks == NULL && kernel->degree == HL_BSPLINE_DEGREE) hl_cell_bits_lay_out(grid, layout);
  hl_cells_lay_out(grid, layout);
}

void hl_grid_count(const hl_volume *volume, const kernel *kernel, const grid_functions *functions,
                   int threads, hl_layout *layout) {
  grid grid = {0};
  set_size(volume, kernel, &grid);
  lay_out(&grid, volume, kernel, functions, layout);
  hl_bounds_count(&grid, threads, layout);
}

static hl_status check_bricks(const hl_volume *volume, hl_error *error) {
  double bricks = 1;
  for (int axis = 0; axis < 3; axis++) bricks *= (double)greatest_cell(volume, axis) / HL_BRICK_CELLS + 1;
  if (bricks <= (double)UINT32_MAX) return HL_OK;
  return hl_fail(
      error, HL_ERROR_UNSUPPORTED,
      "a volume of %zu x %zu x %zu voxels has %.3g bricks of 4 x 4 x 4 cells, and %u can be numbered",
      volume->dimension[0], volume->dimension[1], volume->dimension[2], bricks, UINT32_MAX);
}

/* Gives a grid with pages new pages that hold the values that sampling needs, if these values differ from the
 * stored values. */
static hl_status make_value_pages(hl_pool *pool, const grid_source *source, grid *grid, hl_error *error) {
  const hl_volume *volume = source->volume->volume;
  if (grid->pages == NULL || !needs_other_values(volume, source->kernel)) return HL_OK;
  hl_status status = hl_value_pages_create(pool, volume, source->kernel, grid->empty, &grid->value_pages,
                                           error);
  if (status == HL_OK) grid->pages = grid->value_pages;
  return status;
}

static hl_status allocate(hl_context *context, const grid_functions *functions, const grid_source *source,
                          grid *grid, hl_error *error) {
  const hl_volume *volume = source->volume->volume;
  hl_layout layout = {0};
  while (hl_layout_pass(&layout, context)) lay_out(grid, volume, source->kernel, functions, &layout);
  if (layout.base == NULL) return hl_fail_memory(error, layout.bytes, "the grid of a volume");
  grid->memory = layout.base;
  for (int32_t layer = 0; grid->cell_bounds != NULL && layer < grid->brick_count[2]; layer++)
    grid->cell_bounds[layer] = NULL; /* the packed bounds of this layer have not been made yet */
  return HL_OK;
}

hl_status hl_grid_create(hl_context *context, hl_pool *pool, const grid_functions *functions,
                         const grid_source *source, grid *grid, hl_error *error) {
  const hl_volume *volume = source->volume->volume;
  hl_status status = check_bricks(volume, error);
  *grid = (struct grid){0};
  if (status != HL_OK) return status;
  set_voxels(grid, volume->voxels, volume->row_bytes, volume->slice_bytes);
  grid->value_scale = volume->value_scale;
  grid->value_offset = volume->value_offset;
  grid->empty = (float)((source->empty - volume->value_offset) / volume->value_scale);
  set_size(volume, source->kernel, grid);
  if (!hl_grid_place(grid, source->index_to_frame))
    return hl_fail(error, HL_ERROR_INPUT, "a volume's axes are singular: the three must span space");
  hl_scene_volume_box(source->volume, grid->box_low, grid->box_high);
  for (int axis = 0; axis < 3; axis++)
    grid->box_low[axis] += grid->shift[axis], grid->box_high[axis] += grid->shift[axis];
  status = make_value_pages(pool, source, grid, error);
  if (status == HL_OK) status = allocate(context, functions, source, grid, error);
  if (status != HL_OK) {
    hl_pages_release(grid->value_pages);
    return status;
  }
  if (grid->finite_voxels != NULL) status = replace_voxels(pool, volume, source->kernel, grid, error);
  if (status != HL_OK) {
    hl_grid_release(context, grid);
    return status;
  }
  if (grid->finite_bricks != NULL) {
    hl_bricks_fill_holes(volume->bricks, grid->empty, grid->finite_bricks);
    grid->bricks = grid->finite_bricks;
  }
  if (grid->columns != NULL) hl_pool_run(pool, (size_t)grid->dimension[2], copy_slice, grid);
  status = hl_bricks_bound(context, pool, functions, grid, error);
  bool smooth = source->kernel->degree == HL_BSPLINE_DEGREE;
  if (status == HL_OK) status = hl_cells_bound(context, pool, functions, smooth, volume, grid, error);
  if (status != HL_OK) hl_grid_release(context, grid);
  return status;
}

void hl_grid_release(hl_context *context, grid *grid) {
  hl_cell_bounds_release(context, grid);
  hl_release(context, grid->memory);
  hl_pages_release(grid->value_pages);
  *grid = (struct grid){0};
}
