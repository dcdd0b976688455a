/* reference/bricks.c - where a volume has nothing to see.
 *
 * Index space is cut into bricks of 4 cells a side; cell c of an axis holds the points p with
 * floor(p) = c - 1, so that bricks start at p = -1 and cover the half cell before the first voxel.
 * A kernel with weights of one sign never leaves the range of its taps: where the transfer function is
 * transparent over the range of all taps of a brick, every sample in the brick is transparent.
 */
#include <string.h>

#include "core/memory.h"
#include "reference/reference.h"

enum { BRICK_CELLS = 4, FARTHEST = 255 };

static size_t least(size_t a, size_t b) { return a < b ? a : b; }

/* Voxels that samples in brick `brick` of an axis with n voxels touch: cells 4b-1 .. 4b+2 (as floor(p)),
 * with taps from one before to two after. */
static void brick_voxels(size_t brick, size_t n, size_t *first, size_t *last) {
  size_t corner = BRICK_CELLS * brick;
  *first = least(corner < 2 ? 0 : corner - 2, n - 1);
  *last = least(corner + BRICK_CELLS, n - 1);
}

static bool brick_visible(const reference_volume *volume, size_t i, size_t j, size_t k) {
  size_t first[3], last[3], voxel[3];
  const size_t brick[3] = {i, j, k};
  for (int axis = 0; axis < 3; axis++)
    brick_voxels(brick[axis], volume->grid->dimension[axis], &first[axis], &last[axis]);
  double low = INFINITY, high = -INFINITY;
  for (voxel[2] = first[2]; voxel[2] <= last[2]; voxel[2]++)
    for (voxel[1] = first[1]; voxel[1] <= last[1]; voxel[1]++)
      for (voxel[0] = first[0]; voxel[0] <= last[0]; voxel[0]++) {
        double stored = hl_reference_stored_value(volume, voxel);
        low = fmin(low, stored);
        high = fmax(high, stored);
      }
  double a = volume->grid->value_scale * low + volume->grid->value_offset;
  double b = volume->grid->value_scale * high + volume->grid->value_offset;
  return hl_transfer_function_visible(&volume->described->transfer_function, fmin(a, b), fmax(a, b));
}

/* One slab of bricks per call. */
static void mark_visible(void *data, size_t k, int worker) {
  (void)worker;
  const reference_volume *volume = data;
  unsigned char *out = volume->clearance + k * volume->bricks[1] * volume->bricks[0];
  for (size_t j = 0; j < volume->bricks[1]; j++)
    for (size_t i = 0; i < volume->bricks[0]; i++) *out++ = brick_visible(volume, i, j, k) ? 0 : FARTHEST;
}

/* Lowers brick (i, j, k) to one more than the least of its neighbours on one side: those that come before
 * it in memory order (side -1) or after it (+1). Two such sweeps, one each way, give the exact chessboard
 * distance (Rosenfeld and Pfaltz, "Distance functions on digital pictures", 1968). */
static void relax_brick(const reference_volume *volume, ptrdiff_t i, ptrdiff_t j, ptrdiff_t k, int side) {
  const ptrdiff_t n[3] = {(ptrdiff_t)volume->bricks[0], (ptrdiff_t)volume->bricks[1],
                          (ptrdiff_t)volume->bricks[2]};
  unsigned char *here = &volume->clearance[(k * n[1] + j) * n[0] + i];
  for (ptrdiff_t dk = -1; dk <= 1; dk++)
    for (ptrdiff_t dj = -1; dj <= 1; dj++)
      for (ptrdiff_t di = -1; di <= 1; di++) {
        if ((dk * 9 + dj * 3 + di) * side <= 0) continue;
        ptrdiff_t x = i + di, y = j + dj, z = k + dk;
        if (x < 0 || y < 0 || z < 0 || x >= n[0] || y >= n[1] || z >= n[2]) continue;
        int through = volume->clearance[(z * n[1] + y) * n[0] + x] + 1;
        if (through < *here) *here = (unsigned char)through;
      }
}

static void measure_clearance(const reference_volume *volume, hl_pool *pool) {
  const ptrdiff_t n[3] = {(ptrdiff_t)volume->bricks[0], (ptrdiff_t)volume->bricks[1],
                          (ptrdiff_t)volume->bricks[2]};
  for (ptrdiff_t k = 0; k < n[2] && !hl_pool_stops(pool, 0); k++)
    for (ptrdiff_t j = 0; j < n[1]; j++)
      for (ptrdiff_t i = 0; i < n[0]; i++) relax_brick(volume, i, j, k, -1);
  for (ptrdiff_t k = n[2]; k-- > 0 && !hl_pool_stops(pool, 0);)
    for (ptrdiff_t j = n[1]; j-- > 0;)
      for (ptrdiff_t i = n[0]; i-- > 0;) relax_brick(volume, i, j, k, 1);
}

hl_status hl_reference_bricks_create(hl_context *context, reference_volume *volume, hl_pool *pool,
                                     hl_error *error) {
  size_t count = 1;
  for (int axis = 0; axis < 3; axis++) {
    /* cells 0 .. n: floor(p) from -1 to n-1 */
    volume->bricks[axis] = volume->grid->dimension[axis] / BRICK_CELLS + 1;
    count *= volume->bricks[axis];
  }
  volume->clearance = hl_allocate(context, count, 1);
  if (volume->clearance == NULL) return hl_fail_memory(error, count, "the bricks of a volume");
  hl_pool_run(pool, volume->bricks[2], mark_visible, volume);
  measure_clearance(volume, pool);
  return hl_pool_cancelled(pool) ? hl_fail(error, HL_ERROR_CANCELLED, "cancelled while preparing") : HL_OK;
}

double hl_reference_clearance(const reference_volume *volume, vec3 point, vec3 direction) {
  const double p[3] = {point.x, point.y, point.z}, d[3] = {direction.x, direction.y, direction.z};
  size_t brick[3];
  for (int axis = 0; axis < 3; axis++) {
    double coordinate = fmax(floor((p[axis] + 1) / BRICK_CELLS), 0);
    brick[axis] = least((size_t)coordinate, volume->bricks[axis] - 1);
  }
  size_t offset = (brick[2] * volume->bricks[1] + brick[1]) * volume->bricks[0] + brick[0];
  int clear = volume->clearance[offset];
  if (clear == 0) return 0;
  double distance = INFINITY;
  for (int axis = 0; axis < 3; axis++) {
    double low = BRICK_CELLS * ((double)brick[axis] - clear + 1) - 1;
    double high = BRICK_CELLS * ((double)brick[axis] + clear) - 1;
    if (d[axis] != 0) distance = fmin(distance, ((d[axis] > 0 ? high : low) - p[axis]) / d[axis]);
  }
  return fmax(distance, 0);
}
