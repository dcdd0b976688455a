/* splat/columns.c - see columns.h. */
#include "splat/columns.h"

#include "core/memory.h"

/* Slices and columns are an odd number of the cache's lines apart: at powers of two, all would share few of
 * its sets. */
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

bool hl_columns_wanted(column_slice_function *slice, const int32_t dimension[3], hl_storage storage) {
  return slice != NULL && storage == HL_STORAGE_U8 && dimension[0] >= GRID_COLUMN &&
         dimension[1] >= GRID_COLUMN;
}

uint64_t hl_columns_bytes(const int32_t dimension[3]) {
  return (uint64_t)((dimension[0] + GRID_COLUMN - 1) / GRID_COLUMN) * column_bytes(dimension);
}

typedef struct columns_job {
  const grid *grid;
  column_slice_function *slice;
} columns_job;

static void copy_slice(void *data, size_t index, int worker) {
  (void)worker;
  const columns_job *job = data;
  const grid *grid = job->grid;
  size_t slice = (size_t)grid->dimension[0] * (size_t)grid->dimension[1];
  job->slice((const unsigned char *)grid->voxels + index * slice, grid->dimension[0], grid->dimension[1],
             grid->columns + index * grid->column_slice_bytes, grid->column_bytes);
}

hl_status hl_columns_build(hl_context *context, hl_pool *pool, column_slice_function *slice, grid *grid,
                           hl_error *error) {
  grid->column_slice_bytes = slice_bytes(grid->dimension);
  grid->column_bytes = column_bytes(grid->dimension);
  grid->columns = hl_allocate(context, (size_t)hl_columns_bytes(grid->dimension), 1);
  if (grid->columns == NULL)
    return hl_fail_memory(error, (size_t)hl_columns_bytes(grid->dimension), "the columns of a volume");
  hl_pool_run(pool, (size_t)grid->dimension[2], copy_slice, &(columns_job){grid, slice});
  return HL_OK;
}
