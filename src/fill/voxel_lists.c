/* fill/voxel_lists.c - sorts voxels by tile and by bucket of sheets. The sort is a counting sort in three
 * passes: count, write, order.
 *
 * Voxels are numbered in a grid that is padded by two voxels on every side; in the padding, the values at the
 * border continue. Threads write the entries of a bucket in any order. The last pass sorts each bucket by
 * index, so that the sums, and with them the picture, do not depend on the threads. */
#include "fill/voxel_lists.h"

#include <string.h>

#include "core/memory.h"
#include "core/sheet_constants.h"

typedef struct sort_job {
  const grid *grid;
  const sheet_stack *sheets;
  footprint_map map;
  double support; /* the kernel's radius in voxels */
  voxel_lists *lists;
  uint32_t *cursor; /* [tiles * buckets + 1]; in the first pass, the number of entries of each bucket; in the
                     * second pass, the index of the bucket's next entry */
  bool writing;     /* whether voxels are written (second pass); if not, they are only counted (first pass) */
} sort_job;

static int32_t clamp_brick(int32_t cell, int32_t cells) {
  return (cell < 0 ? 0 : cell > cells ? cells : cell) / HL_BRICK_CELLS;
}

/* Returns whether a voxel contributes to a cell of a relevant brick. Along each axis, voxel i contributes to
 * points p with floor(p) from i-2 to i+1, and so to the cells i-1 to i+2. */
static bool voxel_relevant(const grid *grid, const int32_t v[3]) {
  int32_t first[3], last[3];
  for (int axis = 0; axis < 3; axis++) {
    first[axis] = clamp_brick(v[axis] - 1, grid->dimension[axis]);
    last[axis] = clamp_brick(v[axis] + 2, grid->dimension[axis]);
  }
  return hl_any_brick_relevant(grid, first, last);
}

static void visit_cell(const sort_job *job, size_t cell, uint32_t voxel) {
  uint32_t entry = __atomic_fetch_add(&job->cursor[cell], 1, __ATOMIC_RELAXED);
  if (job->writing) job->lists->voxel[entry] = voxel;
}

static int clamp_tile(double pixel, int tiles) {
  return pixel < 0 ? 0 : pixel >= (double)tiles * TILE ? tiles - 1 : (int)(pixel / TILE);
}

/* Finds the box of the points to which a voxel contributes, as half the box's length along each axis. Points
 * outside the grid get the density at the border, so voxels at the border contribute to points in the margin,
 * too. */
static void footprint_half(const sort_job *job, const int32_t v[3], double half[3]) {
  for (int axis = 0; axis < 3; axis++) {
    bool border = v[axis] < job->support || v[axis] >= job->grid->dimension[axis] - job->support;
    half[axis] = job->support + (border ? GRID_MARGIN : 0);
  }
}

/* Counts or writes a voxel. A sheet reads `span` buckets. A voxel that touches more than `span` sheets is
 * therefore listed again every `span` sheets. */
static void visit_voxel(const sort_job *job, const int32_t v[3], uint32_t voxel) {
  voxel_lists *lists = job->lists;
  const double centre[3] = {v[0], v[1], v[2]};
  double half[3];
  footprint_bounds bounds;
  footprint_half(job, v, half);
  if (!hl_footprint_bounds(&job->map, centre, half, &bounds)) return;
  double width = (double)lists->tiles_x * TILE, height = (double)lists->tiles_y * TILE;
  if (bounds.high[0] < 0 || bounds.high[1] < 0 || bounds.low[0] > width || bounds.low[1] > height) return;
  double first_sheet = ceil((bounds.low_height - job->sheets->first) / job->sheets->spacing);
  double last_sheet = floor((bounds.high_height - job->sheets->first) / job->sheets->spacing);
  int x0 = clamp_tile(bounds.low[0], lists->tiles_x), x1 = clamp_tile(bounds.high[0], lists->tiles_x);
  int y0 = clamp_tile(bounds.low[1], lists->tiles_y), y1 = clamp_tile(bounds.high[1], lists->tiles_y);
  for (double sheet = first_sheet; sheet <= last_sheet; sheet += lists->span) {
    double bucket = sheet + lists->span - 1;
    if (bucket < 0 || bucket >= lists->bucket_count) continue;
    for (int y = y0; y <= y1; y++)
      for (int x = x0; x <= x1; x++)
        visit_cell(
            job,
            ((size_t)y * (size_t)lists->tiles_x + (size_t)x) * (size_t)lists->bucket_count + (size_t)bucket,
            voxel);
  }
}

static void visit_slice(void *data, size_t index, int worker) {
  (void)worker;
  const sort_job *job = data;
  const grid *grid = job->grid;
  int32_t v[3] = {0, 0, (int32_t)index - 2};
  for (v[1] = -2; v[1] < grid->dimension[1] + 2; v[1]++) {
    uint32_t row = ((uint32_t)index * (uint32_t)(grid->dimension[1] + 4) + (uint32_t)(v[1] + 2)) *
                   (uint32_t)(grid->dimension[0] + 4);
    for (v[0] = -2; v[0] < grid->dimension[0] + 2; v[0]++)
      if (voxel_relevant(grid, v)) visit_voxel(job, v, row + (uint32_t)(v[0] + 2));
  }
}

/* Sorts the buckets of one tile by index. Buckets are short, so insertion sort is fast enough. */
static void order_tile(void *data, size_t index, int worker) {
  (void)worker;
  const sort_job *job = data;
  const voxel_lists *lists = job->lists;
  for (size_t cell = index * (size_t)lists->bucket_count; cell < (index + 1) * (size_t)lists->bucket_count;
       cell++)
    for (uint32_t i = lists->start[cell] + 1; i < lists->start[cell + 1]; i++) {
      uint32_t voxel = lists->voxel[i], j = i;
      for (; j > lists->start[cell] && lists->voxel[j - 1] > voxel; j--)
        lists->voxel[j] = lists->voxel[j - 1];
      lists->voxel[j] = voxel;
    }
}

static hl_status prepare(const voxel_sort *sort, voxel_lists *lists, sort_job *job, hl_error *error) {
  const grid *grid = sort->grid;
  uint64_t padded = (uint64_t)(grid->dimension[0] + 4) * (uint64_t)(grid->dimension[1] + 4) *
                    (uint64_t)(grid->dimension[2] + 4);
  if (padded > UINT32_MAX)
    return hl_fail(
        error, HL_ERROR_UNSUPPORTED,
        "/render/reconstruction: splat sorts at most 4294967295 voxels, this volume has more: use gather");
  hl_footprint_map(sort->view, sort->sheets->normal, grid->index_to_frame, &job->map);
  double reach = 0;
  job->support = sort->kernel->support;
  for (int axis = 0; axis < 3; axis++) reach += fabs(job->map.height[axis]) * job->support;
  lists->tiles_x = hl_tiles(sort->view->width);
  lists->tiles_y = hl_tiles(sort->view->height);
  lists->span = (int)floor(2 * reach / sort->sheets->spacing) + 1;
  lists->bucket_count = sort->sheets->count + lists->span;
  return HL_OK;
}

/* Turns the numbers of entries of the buckets into the indices at which the buckets start: start[c] is the
 * sum of the counts before bucket c. Returns the sum of all counts. */
static uint64_t accumulate(const uint32_t *count, size_t cells, uint32_t *start) {
  uint64_t sum = 0;
  for (size_t cell = 0; cell < cells; cell++) {
    start[cell] = (uint32_t)sum;
    sum += count[cell];
  }
  start[cells] = (uint32_t)sum;
  return sum;
}

hl_status hl_voxel_lists_build(hl_context *context, hl_pool *pool, const voxel_sort *sort, voxel_lists *lists,
                               hl_error *error) {
  *lists = (voxel_lists){0};
  sort_job job = {.grid = sort->grid, .sheets = sort->sheets, .lists = lists};
  hl_status status = prepare(sort, lists, &job, error);
  if (status != HL_OK) return status;
  size_t tiles = (size_t)lists->tiles_x * (size_t)lists->tiles_y, cells = tiles * (size_t)lists->bucket_count;
  job.cursor = hl_allocate_zeroed(context, cells + 1, sizeof(uint32_t));
  lists->start = hl_allocate(context, cells + 1, sizeof(uint32_t));
  if (job.cursor == NULL || lists->start == NULL) goto no_memory;
  size_t slices = (size_t)sort->grid->dimension[2] + 4;
  hl_pool_run(pool, slices, visit_slice, &job);
  uint64_t entries = accumulate(job.cursor, cells, lists->start);
  if (entries > UINT32_MAX) goto no_memory;
  lists->voxel = hl_allocate(context, (size_t)entries, sizeof(uint32_t));
  if (lists->voxel == NULL) goto no_memory;
  memcpy(job.cursor, lists->start, cells * sizeof(uint32_t));
  job.writing = true;
  hl_pool_run(pool, slices, visit_slice, &job);
  hl_pool_run(pool, tiles, order_tile, &job);
  hl_release(context, job.cursor);
  return HL_OK;
no_memory:
  hl_release(context, job.cursor);
  hl_voxel_lists_release(context, lists);
  return hl_fail_memory(error, cells * 8, "the sorted voxels");
}

void hl_voxel_lists_release(hl_context *context, voxel_lists *lists) {
  hl_release(context, lists->start);
  hl_release(context, lists->voxel);
  *lists = (voxel_lists){0};
}
