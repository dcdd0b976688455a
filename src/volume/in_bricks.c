/* volume/in_bricks.c - see in_bricks.h. The field is evaluated to dense coefficients of level 0.
 *
 * Where voxels stand between lattice points, by half a voxel, their coefficients are found from the field's
 * values there: c = (-f[-1] + 8 f[0] - f[1]) / 6 along each axis, exact for cubic fields (derived: the
 * B-spline of f'' / 6 is what the kernel's 1/6, 2/3, 1/6 adds). */
#include "volume/in_bricks.h"

#include <string.h>

#include "bricks/build.h"
#include "core/memory.h"

enum { TAPS = 6 };

/* The weights of six lattice points around a place half-way between the third and the fourth: the values
 * there and one voxel before and behind, (1 23 23 1)/48, combined. */
static const double half_way[TAPS] = {-1.0 / 288,  -15.0 / 288, 160.0 / 288,
                                      160.0 / 288, -15.0 / 288, -1.0 / 288};

/* Moves a row of coefficients from `points` lattice points to `voxels` places, which begin at `origin`. */
static void move_row(const float *points, size_t count, size_t step, double origin, size_t voxels,
                     double *row) {
  bool is_half = origin != (double)(size_t)origin;
  for (size_t n = 0; n < voxels; n++) {
    ptrdiff_t at = (ptrdiff_t)origin + (ptrdiff_t)n;
    double sum = 0;
    for (int tap = 0; tap < TAPS; tap++) {
      ptrdiff_t place = is_half ? at - 2 + tap : at;
      place = place < 0 ? 0 : place >= (ptrdiff_t)count ? (ptrdiff_t)count - 1 : place;
      double value = (double)points[(size_t)place * step];
      if (is_half) sum += half_way[tap] * value;
      else sum = value;
    }
    row[n] = sum;
  }
}

/* Moves all rows along an axis, in place: the moved grid is not larger. */
static void move_axis(float *values, size_t size[3], int axis, double origin, size_t voxels, double *row) {
  size_t step = 1, rows = 1, moved[3] = {size[0], size[1], size[2]};
  for (int a = 0; a < axis; a++) step *= size[a];
  for (int a = axis + 1; a < 3; a++) rows *= size[a];
  moved[axis] = voxels;
  for (size_t r = 0; r < rows; r++)
    for (size_t s = 0; s < step; s++) {
      move_row(values + r * step * size[axis] + s, size[axis], step, origin, voxels, row);
      for (size_t n = 0; n < voxels; n++) values[(r * voxels + n) * step + s] = (float)row[n];
    }
  memcpy(size, moved, sizeof moved);
}

/* Evaluates the field at all lattice points, those on the far faces included. */
static hl_status evaluate(hl_context *context, const hl_bricks *bricks, const char *subject, size_t size[3],
                          float **values, hl_error *error) {
  hl_pool *pool = NULL;
  size_t count = 1;
  for (int axis = 0; axis < 3; axis++) {
    size[axis] = bricks->dimension[axis] + 1;
    if (!hl_multiply(count, size[axis], &count)) return hl_fail_memory(error, SIZE_MAX, subject);
  }
  *values = hl_allocate(context, count, sizeof **values);
  if (*values == NULL) return hl_fail_memory(error, count > SIZE_MAX / 4 ? SIZE_MAX : 4 * count, subject);
  hl_status status = hl_pool_create(context, 0, &pool, error);
  if (status == HL_OK) hl_bricks_to_dense(pool, bricks, 0, size, *values);
  if (status == HL_OK && hl_pool_cancelled(pool))
    status = hl_fail(error, HL_ERROR_CANCELLED, "%s: cancelled", subject);
  hl_pool_destroy(pool);
  return status;
}

static hl_status move_grid(hl_context *context, const hl_bricks *bricks, const hl_volume_description *grid,
                           size_t size[3], float *values, hl_error *error) {
  const size_t *n = grid->dimensions;
  size_t longest = n[0] > n[1] ? n[0] : n[1];
  if (n[2] > longest) longest = n[2];
  double *row = hl_allocate(context, longest, sizeof *row);
  if (row == NULL) return hl_fail_memory(error, longest * sizeof *row, "a row of voxels");
  for (int axis = 0; axis < 3; axis++) move_axis(values, size, axis, bricks->origin[axis], n[axis], row);
  hl_release(context, row);
  return HL_OK;
}

hl_status hl_volume_take_bricks(hl_context *context, hl_bricks *bricks, const hl_volume_description *grid,
                                const char *subject, hl_volume **volume, hl_error *error) {
  float *voxels = NULL;
  size_t size[3];
  hl_status status = hl_volume_check_grid(grid, subject, error);
  if (status == HL_OK) status = evaluate(context, bricks, subject, size, &voxels, error);
  if (status == HL_OK) status = move_grid(context, bricks, grid, size, voxels, error);
  hl_bricks_release(context, bricks);
  if (status == HL_OK) return hl_volume_adopt(context, grid, subject, voxels, volume, error);
  hl_release(context, voxels);
  return status;
}
