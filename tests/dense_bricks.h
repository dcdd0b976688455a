/* dense_bricks.h - converts a field at levels into one dense grid of coefficients, with which tests compare
 * bricks. In: bricks. Out: voxels of one level. The dense grid's blocks are independent of each other. Each
 * is made in pieces, each of which one brick covers. */
#ifndef HL_TESTS_DENSE_BRICKS_H
#define HL_TESTS_DENSE_BRICKS_H

#include <string.h>

#include "bricks/build.h"
#include "bricks/subdivide.h"
#include "core/memory.h"

/* The number of lattice points of a level along an axis with `dimension` points of level 0. */
static inline size_t hl_bricks_points(size_t dimension, int level) {
  return ((dimension - 1 + ((size_t)1 << level) - 1) >> level) + 1;
}

enum { DENSE_TILE_SHIFT = 4, DENSE_TILE = 1 << DENSE_TILE_SHIFT, DENSE_SCRATCH = 3 * 20 * 20 * 20 };

typedef struct dense_job {
  const hl_bricks *bricks;
  int level;
  size_t size[3], tiles[3];
  float *voxels;
} dense_job;

static const hl_brick_entry *entry_at(const hl_bricks *bricks, const size_t block[3]) {
  const size_t *n = bricks->directory_size;
  size_t at[3];
  for (int axis = 0; axis < 3; axis++) at[axis] = block[axis] < n[axis] ? block[axis] : n[axis] - 1;
  return &bricks->directory[(at[2] * n[1] + at[1]) * n[0] + at[0]];
}

/* The coefficients that a brick stores, and the first point of its level. */
typedef struct stored_brick {
  const float *coefficients;
  size_t side; /* coefficients along an axis */
  ptrdiff_t first[3];
} stored_brick;

/* block: the block of level 0 within the brick. */
static stored_brick brick_at(const hl_bricks *bricks, const hl_brick_entry *entry, const size_t block[3]) {
  size_t side = ((size_t)1 << bricks->shift) + BRICK_MARGIN;
  stored_brick brick = {bricks->pool + (size_t)entry->slot * side * side * side, side, {0}};
  for (int axis = 0; axis < 3; axis++)
    brick.first[axis] = (ptrdiff_t)(block[axis] >> entry->level << bricks->shift) - 1;
  return brick;
}

static void copy_box(const stored_brick *brick, const hl_lattice_box *box, float *out) {
  size_t n = 0;
  for (size_t k = 0; k < box->count[2]; k++)
    for (size_t j = 0; j < box->count[1]; j++, n += box->count[0]) {
      size_t at[3] = {0, j, k};
      for (int axis = 0; axis < 3; axis++) at[axis] += (size_t)(box->first[axis] - brick->first[axis]);
      memcpy(out + n, brick->coefficients + (at[2] * brick->side + at[1]) * brick->side + at[0],
             box->count[0] * sizeof *out);
    }
}

/* Fills a box of coefficients of a level from a brick that covers the box and is `coarser` levels coarser. */
static void subdivide(const stored_brick *brick, int coarser, const hl_lattice_box *box, float *scratch,
                      float *out) {
  if (coarser == 0) {
    copy_box(brick, box, out);
    return;
  }
  hl_lattice_box source = hl_subdivision_source(box);
  float *further = scratch + hl_lattice_points(&source);
  subdivide(brick, coarser - 1, &source, further, scratch);
  hl_subdivide(box, scratch, further, out);
}

/* The field's value at a point of the brick's lattice. */
static float value_at(const stored_brick *brick, const ptrdiff_t point[3]) {
  const size_t row = brick->side, slice = row * row;
  size_t at[3];
  for (int axis = 0; axis < 3; axis++) at[axis] = (size_t)(point[axis] - brick->first[axis] - 1);
  return (float)hl_field_at_point(brick->coefficients + at[2] * slice + at[1] * row + at[0], row, slice);
}

/* Fills a box from bricks that are finer than the box's level, point by point. */
static void sample_points(const dense_job *job, const hl_lattice_box *box, float *out) {
  const hl_bricks *bricks = job->bricks;
  size_t n = 0;
  for (size_t k = 0; k < box->count[2]; k++)
    for (size_t j = 0; j < box->count[1]; j++)
      for (size_t i = 0; i < box->count[0]; i++, n++) {
        const size_t at[3] = {i, j, k};
        size_t block[3];
        ptrdiff_t point[3];
        for (int axis = 0; axis < 3; axis++) {
          size_t place = ((size_t)box->first[axis] + at[axis]) << job->level;
          size_t last = bricks->dimension[axis] - 1;
          /* a point beyond the last one has the last one's value */
          point[axis] = (ptrdiff_t)(place < last ? place : last);
          block[axis] = (size_t)point[axis] >> bricks->shift;
        }
        const hl_brick_entry *entry = entry_at(bricks, block);
        if (entry->slot < 0) {
          out[n] = entry->constant;
          continue;
        }
        stored_brick brick = brick_at(bricks, entry, block);
        for (int axis = 0; axis < 3; axis++) point[axis] >>= entry->level;
        out[n] = value_at(&brick, point);
      }
}

static void fill_box(const dense_job *job, const hl_lattice_box *box, float *scratch, float *out) {
  const hl_bricks *bricks = job->bricks;
  size_t block[3];
  for (int axis = 0; axis < 3; axis++)
    block[axis] = ((size_t)box->first[axis] << job->level) >> bricks->shift;
  const hl_brick_entry *entry = entry_at(bricks, block);
  if (entry->level < job->level) sample_points(job, box, out);
  else if (entry->slot < 0)
    for (size_t n = 0; n < hl_lattice_points(box); n++) out[n] = entry->constant;
  else {
    for (int axis = 0; axis < 3; axis++)
      if (block[axis] >= bricks->directory_size[axis]) block[axis] = bricks->directory_size[axis] - 1;
    stored_brick brick = brick_at(bricks, entry, block);
    subdivide(&brick, entry->level - job->level, box, scratch, out);
  }
}

/* The side of the boxes. Each box lies in one brick, or in bricks that are finer than the level. */
static int box_shift(const dense_job *job) {
  return job->bricks->shift < DENSE_TILE_SHIFT ? job->bricks->shift : DENSE_TILE_SHIFT;
}

static void make_tile(void *data, size_t index, int worker) {
  (void)worker;
  const dense_job *job = data;
  float values[DENSE_TILE * DENSE_TILE * DENSE_TILE], scratch[DENSE_SCRATCH];
  const size_t tile[3] = {index % job->tiles[0], index / job->tiles[0] % job->tiles[1],
                          index / job->tiles[0] / job->tiles[1]};
  hl_lattice_box box;
  for (int axis = 0; axis < 3; axis++) {
    size_t first = tile[axis] << box_shift(job), left = job->size[axis] - first,
           side = (size_t)1 << box_shift(job);
    box.first[axis] = (ptrdiff_t)first;
    box.count[axis] = left < side ? left : side;
  }
  fill_box(job, &box, scratch, values);
  for (size_t k = 0; k < box.count[2]; k++)
    for (size_t j = 0; j < box.count[1]; j++)
      memcpy(job->voxels +
                 (((size_t)box.first[2] + k) * job->size[1] + (size_t)box.first[1] + j) * job->size[0] +
                 (size_t)box.first[0],
             values + (k * box.count[1] + j) * box.count[0], box.count[0] * sizeof *values);
}

/* Makes a dense grid of the field's coefficients of a level. Coarser bricks' coefficients are subdivided, and
 * the dense grid's field is the bricks' field exactly. Where bricks are finer, a coefficient is the field's
 * value at its point. size: hl_bricks_points() of each axis. voxels: [size[2]][size[1]][size[0]], memory of
 * the caller. Stops early if the pool is cancelled. */
static inline void hl_bricks_to_dense(hl_pool *pool, const hl_bricks *bricks, int level, const size_t size[3],
                                      float *voxels) {
  dense_job job = {.bricks = bricks, .level = level, .voxels = voxels};
  for (int axis = 0; axis < 3; axis++) {
    job.size[axis] = size[axis];
    job.tiles[axis] = ((size[axis] - 1) >> box_shift(&job)) + 1;
  }
  hl_pool_run(pool, job.tiles[0] * job.tiles[1] * job.tiles[2], make_tile, &job);
}

/* Allocates *voxels and calls hl_bricks_to_dense(). *voxels is owned by the caller (hl_release). subject:
 * starts error lines. */
static inline hl_status hl_bricks_evaluate_dense(hl_context *context, hl_pool *pool, const hl_bricks *bricks,
                                                 int level, const char *subject, size_t size[3],
                                                 float **voxels, hl_error *error) {
  size_t count = 1;
  *voxels = NULL;
  for (int axis = 0; axis < 3; axis++) {
    size[axis] = hl_bricks_points(bricks->dimension[axis], level);
    if (!hl_multiply(count, size[axis], &count)) return hl_fail_memory(error, SIZE_MAX, subject);
  }
  *voxels = hl_allocate(context, count, sizeof **voxels);
  if (*voxels == NULL)
    return hl_fail_memory(error, count > SIZE_MAX / sizeof **voxels ? SIZE_MAX : count * sizeof **voxels,
                          subject);
  hl_bricks_to_dense(pool, bricks, level, size, *voxels);
  if (!hl_pool_cancelled(pool)) return HL_OK;
  hl_release(context, *voxels);
  *voxels = NULL;
  return hl_fail(error, HL_ERROR_CANCELLED, "%s: cancelled", subject);
}

#endif
