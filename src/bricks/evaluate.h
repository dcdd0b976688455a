/* bricks/evaluate.h - evaluates a field in bricks at single places: finds coefficients of level 0, values and
 * ranges.
 *
 * The whole field is one B-spline of level 0, because the B-splines of each level are sums of B-splines of
 * the next finer level. Its coefficients are the coefficients of the bricks of level 0, and subdivided
 * coefficients of coarser bricks. All functions continue the field beyond the directory's faces by the value
 * at the faces. */
#ifndef HL_BRICKS_EVALUATE_H
#define HL_BRICKS_EVALUATE_H

#include "bricks/bricks.h"

/* The weights of the four coefficients on which a cubic B-spline depends at t, 0 to 1, between the second and
 * the third of them. */
static inline void hl_bspline_weights(double t, double weight[4]) {
  const double s = 1 - t;
  weight[0] = s * s * s / 6;
  weight[1] = (4 - 6 * t * t + 3 * t * t * t) / 6;
  weight[2] = (4 - 6 * s * s + 3 * s * s * s) / 6;
  weight[3] = t * t * t / 6;
}

/* Number of coefficients along an axis that a brick stores. */
static inline size_t hl_brick_width(const hl_bricks *bricks) {
  return ((size_t)1 << bricks->shift) + BRICK_MARGIN;
}
static inline size_t hl_brick_coefficients(const hl_bricks *bricks) {
  return hl_brick_width(bricks) * hl_brick_width(bricks) * hl_brick_width(bricks);
}
/* The number of cells of level 0 along an axis. The field is defined from 0 to this coordinate. */
static inline int64_t hl_bricks_cells(const hl_bricks *bricks, int axis) {
  return (int64_t)bricks->directory_size[axis] << bricks->shift;
}
/* The entry of a block of level 0, which must lie in the directory. */
static inline const hl_brick_entry *hl_bricks_entry(const hl_bricks *bricks, const int64_t block[3]) {
  const size_t *n = bricks->directory_size;
  return &bricks->directory[((size_t)block[2] * n[1] + (size_t)block[1]) * n[0] + (size_t)block[0]];
}
static inline const float *hl_brick_pool(const hl_bricks *bricks, int32_t slot) {
  return bricks->pool + (size_t)slot * hl_brick_coefficients(bricks);
}

/* The coefficients of level 0 of the lattice points first .. first + count - 1: values,
 * [count[2]][count[1]][count[0]], each of them a number of 32 bits. */
void hl_bricks_window(const hl_bricks *bricks, const int64_t first[3], const int64_t count[3],
                      double *values);

/* The coefficient of level 0 of one lattice point. */
float hl_bricks_coefficient(const hl_bricks *bricks, const int64_t point[3]);

/* The field's value at a point of the lattice. */
double hl_bricks_value(const hl_bricks *bricks, const double point[3]);
/* The values at a point and at the points 1, 2, ... count - 1 behind it along x, with the bits of
 * hl_bricks_value(). Neighbours share sums of coefficients. */
void hl_bricks_values(const hl_bricks *bricks, const double point[3], size_t count, double *values);

/* Finds the least and the greatest of the coefficients on which the cells first .. last of level 0 depend.
 * The field's values in these cells lie between these two numbers. */
void hl_bricks_range(const hl_bricks *bricks, const int64_t first[3], const int64_t last[3], float range[2]);

/* The ranges of a row of boxes, and how far they hold. A row starts as {0}. */
enum { HL_BRICKS_ROW = 64 };
typedef struct hl_bricks_row {
  float ranges[HL_BRICKS_ROW][2];
  size_t boxes[HL_BRICKS_ROW];  /* the number of boxes, from this one on, that have one range; 0: this box
                                 * belongs to those before it */
  int64_t until[HL_BRICKS_ROW]; /* where `boxes` is set: these boxes' range holds as long as their last cell
                                 * along y is not above this cell */
} hl_bricks_row;

/* Finds the ranges of a row of boxes. The first box has the cells first .. last, and each further box begins
 * `step` cells behind the box before it, along x. Where boxes depend on the same coefficients, as in coarse
 * bricks, their range is found once, also for several rows. row: the result for a row of as many boxes, with
 * smaller coordinates along y and else the same ones, or {0}; it becomes the result. count: at most
 * HL_BRICKS_ROW. */
void hl_bricks_ranges(const hl_bricks *bricks, const int64_t first[3], const int64_t last[3], int64_t step,
                      size_t count, hl_bricks_row *row);

/* Whether all coefficients and constants are finite. Numbers that are not finite stand for places without
 * data. */
bool hl_bricks_are_finite(const hl_bricks *bricks);
/* Copies bricks, and replaces numbers that are not finite by `empty`. filled: must have a directory and a
 * pool of the same sizes as in `bricks`; the function sets all other members. */
void hl_bricks_fill_holes(const hl_bricks *bricks, float empty, hl_bricks *filled);

/* The number of bytes that the directory and the pool of `bricks` take together. */
size_t hl_bricks_bytes(const hl_bricks *bricks);

#endif
