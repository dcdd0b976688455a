/* isosurface/lattice.c - see lattice.h. */
#include "isosurface/lattice.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "grid/bounds.h"

static size_t brick_index(const lattice *lattice, const int32_t at[3]) {
  return ((size_t)at[2] * (size_t)lattice->brick_count[1] + (size_t)at[1]) * (size_t)lattice->brick_count[0] +
         (size_t)at[0];
}

const lattice_brick *hl_lattice_brick(const lattice *lattice, const int32_t at[3]) {
  for (int axis = 0; axis < 3; axis++)
    if (at[axis] >= lattice->brick_count[axis]) return NULL;
  uint32_t slot = lattice->slot[brick_index(lattice, at)];
  return slot != LATTICE_NONE ? &lattice->bricks[slot] : NULL;
}

/* ---- which bricks are kept ---- */

enum { CROSSED = 1, KEPT = 2 };

/* Returns whether the surface's value may occur in the cells of a lattice's brick. These are the cells of the
 * grid's brick at the same place. With an interpolating kernel the voxels are coefficients. The field is a
 * weighted mean of coefficients, so the bounds of the coefficients are bounds of the field. */
static bool brick_crossed(const lattice *lattice, const int32_t at[3]) {
  const grid *grid = lattice->grid;
  float bounds[2];
  for (int axis = 0; axis < 3; axis++)
    if (at[axis] >= grid->brick_count[axis]) return false;
  hl_bounds_of_brick(grid, hl_brick_index(grid, at), bounds);
  return bounds[0] <= lattice->value && bounds[1] >= lattice->value;
}

/* Marks the bricks that the lattice keeps: a brick that the surface crosses, and the bricks beside it that
 * hold points of its cells. */
static void keep_around(const lattice *lattice, const int32_t at[3], unsigned char *marks) {
  for (int corner = 0; corner < 8; corner++) {
    const int32_t beside[3] = {at[0] + (corner & 1), at[1] + (corner >> 1 & 1), at[2] + (corner >> 2)};
    bool there = true;
    for (int axis = 0; axis < 3; axis++) there = there && beside[axis] < lattice->brick_count[axis];
    if (there) marks[brick_index(lattice, beside)] |= corner == 0 ? KEPT | CROSSED : KEPT;
  }
}

static size_t mark_bricks(const lattice *lattice, unsigned char *marks) {
  int32_t at[3];
  size_t kept = 0, total = 1;
  for (int axis = 0; axis < 3; axis++) total *= (size_t)lattice->brick_count[axis];
  memset(marks, 0, total);
  for (at[2] = 0; at[2] < lattice->brick_count[2]; at[2]++)
    for (at[1] = 0; at[1] < lattice->brick_count[1]; at[1]++)
      for (at[0] = 0; at[0] < lattice->brick_count[0]; at[0]++)
        if (brick_crossed(lattice, at)) keep_around(lattice, at, marks);
  for (size_t b = 0; b < total; b++) kept += marks[b] != 0;
  return kept;
}

static void list_bricks(lattice *lattice, const unsigned char *marks) {
  int32_t at[3];
  size_t index = 0;
  lattice->count = 0;
  for (at[2] = 0; at[2] < lattice->brick_count[2]; at[2]++)
    for (at[1] = 0; at[1] < lattice->brick_count[1]; at[1]++)
      for (at[0] = 0; at[0] < lattice->brick_count[0]; at[0]++, index++) {
        lattice->slot[index] = marks[index] != 0 ? (uint32_t)lattice->count : LATTICE_NONE;
        if (marks[index] == 0) continue;
        lattice->bricks[lattice->count++] = (lattice_brick){.at = {at[0], at[1], at[2]},
                                                            .crossed = (marks[index] & CROSSED) != 0};
      }
}

/* ---- inside and outside ---- */

enum { SIDE = HL_BRICK_CELLS, WINDOW = SIDE + 4 };

/* Weighs the voxels of a window along one axis: replaces them by the weighted sums at a brick's points. from:
 * [outer][WINDOW][inner]; to: [outer][SIDE][inner]. */
static void weigh_axis(const double weight[SIDE][WINDOW], const double *from, int outer, int inner,
                       double *to) {
  for (int o = 0; o < outer; o++)
    for (int p = 0; p < SIDE; p++)
      for (int i = 0; i < inner; i++) {
        double sum = 0;
        for (int w = 0; w < WINDOW; w++) sum += weight[p][w] * from[(o * WINDOW + w) * inner + i];
        to[(o * SIDE + p) * inner + i] = sum;
      }
}

/* Finds the weights of the window's voxels for the brick's points along an axis. *first: receives the
 * coordinate of the window's first voxel. */
static void weights_of_axis(const lattice *lattice, int axis, int32_t brick, int32_t *first,
                            double weight[SIDE][WINDOW]) {
  int32_t last = lattice->points[axis] - 1;
  *first = SIDE * brick - 3;
  memset(weight, 0, sizeof(double[SIDE][WINDOW]));
  for (int p = 0; p < SIDE; p++) {
    int32_t point = SIDE * brick + p < last ? SIDE * brick + p : last;
    field_taps taps = hl_field_taps(lattice->kernel, hl_lattice_position(lattice, axis, point));
    for (int tap = 0; tap < 4; tap++) {
      int32_t at = taps.first + tap - *first;
      if (at >= 0 && at < WINDOW) weight[p][at] += taps.weight[tap];
    }
  }
}

static void find_inside(void *data, size_t index, int worker) {
  (void)worker;
  const lattice *lattice = data;
  lattice_brick *brick = &lattice->bricks[index];
  double weight[3][SIDE][WINDOW], voxels[WINDOW * WINDOW * WINDOW], z[SIDE * WINDOW * WINDOW],
      y[SIDE * SIDE * WINDOW], x[SIDE * SIDE * SIDE];
  int32_t first[3];
  for (int axis = 0; axis < 3; axis++)
    weights_of_axis(lattice, axis, brick->at[axis], &first[axis], weight[axis]);
  hl_field_window(lattice->grid, first, (const int32_t[3]){WINDOW, WINDOW, WINDOW}, voxels);
  weigh_axis(weight[2], voxels, 1, WINDOW * WINDOW, z);
  weigh_axis(weight[1], z, SIDE, WINDOW, y);
  weigh_axis(weight[0], y, SIDE * SIDE, 1, x);
  for (int point = 0; point < SIDE * SIDE * SIDE; point++)
    if ((x[point] - lattice->value) * lattice->sign > 0) brick->inside |= (uint64_t)1 << point;
}

/* ---- edges ---- */

/* For each axis, the points of a brick whose coordinate along the axis is the greatest; one bit each. */
static const uint64_t last_points[3] = {0x8888888888888888u, 0xf000f000f000f000u, 0xffff000000000000u};

/* The points of a brick at which edges along an axis begin, one bit each. An edge begins at each point of the
 * lattice that is not the last one along the axis. */
static uint64_t edge_points(const lattice *lattice, const lattice_brick *brick, int axis) {
  uint64_t points = 0;
  for (int p = 0; p < SIDE * SIDE * SIDE; p++) {
    const int32_t at[3] = {p % SIDE, p / SIDE % SIDE, p / SIDE / SIDE};
    bool there = true;
    for (int a = 0; a < 3; a++)
      there = there && SIDE * brick->at[a] + at[a] < lattice->points[a] - (a == axis ? 1 : 0);
    if (there) points |= (uint64_t)1 << p;
  }
  return points;
}

static void find_crossings(void *data, size_t index, int worker) {
  (void)worker;
  const lattice *lattice = data;
  lattice_brick *brick = &lattice->bricks[index];
  for (int axis = 0; axis < 3; axis++) {
    int shift = 1 << 2 * axis;
    uint64_t ahead = brick->inside >> shift & ~last_points[axis], known = ~last_points[axis];
    int32_t beside[3] = {brick->at[0], brick->at[1], brick->at[2]};
    beside[axis]++;
    const lattice_brick *next = hl_lattice_brick(lattice, beside);
    if (next != NULL) {
      ahead |= next->inside << shift * (SIDE - 1) & last_points[axis];
      known = ~(uint64_t)0;
    }
    brick->cross[axis] = (brick->inside ^ ahead) & known & edge_points(lattice, brick, axis);
  }
}

/* ---- the lattice ---- */

void hl_lattice_release(lattice *made) {
  hl_release(made->context, made->slot);
  hl_release(made->context, made->bricks);
}

hl_status hl_lattice_run(hl_pool *pool, size_t count, void (*function)(void *, size_t, int), void *data,
                         hl_error *error) {
  hl_pool_run(pool, count, function, data);
  return hl_pool_check(pool, "preparing", error);
}

hl_status hl_lattice_create(hl_context *context, hl_pool *pool, const grid *grid, const kernel *kernel,
                            double value, lattice *made, hl_error *error) {
  *made = (lattice){.context = context, .grid = grid, .kernel = kernel};
  made->value = (value - grid->value_offset) / grid->value_scale;
  made->sign = grid->value_scale < 0 ? -1 : 1;
  size_t total = 1;
  for (int axis = 0; axis < 3; axis++) {
    /* the outermost points lie on the faces of the box, which are half a voxel or a whole voxel away from
     * the outermost voxels */
    made->outside[axis] = fmin(fmax(0.5 - grid->shift[axis], 0.5), 1);
    made->points[axis] = grid->dimension[axis] + 2;
    made->brick_count[axis] = (made->points[axis] + SIDE - 1) / SIDE;
    total *= (size_t)made->brick_count[axis];
  }
  unsigned char *marks = hl_allocate(context, total, 1);
  made->slot = hl_allocate(context, total, sizeof *made->slot);
  if (marks != NULL && made->slot != NULL && total < LATTICE_NONE)
    made->bricks = hl_allocate(context, mark_bricks(made, marks), sizeof *made->bricks);
  if (made->bricks != NULL) list_bricks(made, marks);
  hl_release(context, marks);
  if (made->bricks == NULL) return hl_fail_memory(error, total * sizeof *made->slot, "an isosurface");
  hl_status status = hl_lattice_run(pool, made->count, find_inside, made, error);
  if (status == HL_OK) status = hl_lattice_run(pool, made->count, find_crossings, made, error);
  return status;
}
