/* grid/kernel_lanes.h - computes a kernel's weights and their derivatives at sixteen points. */
#ifndef HL_GRID_KERNEL_LANES_H
#define HL_GRID_KERNEL_LANES_H

#include "grid/kernel.h"
#include "simd/lanes.h"

/* Evaluates one polynomial piece of the kernel (kernel.h) at `a`. */
LANES_INLINE lanes kernel_piece(const float *piece, int degree, lanes a) {
  lanes sum = lanes_set(piece[degree]);
  for (int power = degree - 1; power >= 0; power--) sum = lanes_fma(sum, a, lanes_set(piece[power]));
  return sum;
}

/* bspline_inner() and bspline_outer() give the cubic B-spline in fewer operations than kernel_piece() needs.
 * bspline_inner() gives the value at a distance of up to 1, bspline_outer() gives the value at the distance 2
 * - rest, with `rest` up to 1. */
LANES_INLINE lanes bspline_inner(lanes distance) {
  return lanes_fma(distance * distance, lanes_line(distance, 0.5f, -1.0f), lanes_set(2.0f / 3));
}
LANES_INLINE lanes bspline_outer(lanes rest) { return rest * rest * (rest * (1.0f / 6)); }

/* The value of a kernel at any distance. */
LANES_INLINE lanes kernel_at(const kernel *kernel, int degree, lanes distance) {
  lanes a = lanes_abs(distance);
  if (degree == HL_BSPLINE_DEGREE)
    return lanes_select(a < 1.0f, bspline_inner(a), bspline_outer(lanes_max(2.0f - a, lanes_set(0))));
  lanes inner = kernel_piece(kernel->inner, degree, a), outer = kernel_piece(kernel->outer, degree, a - 1.0f);
  return lanes_keep(a < kernel->support, lanes_select(a < 1.0f, inner, outer));
}

/* Finds the kernel's weights for the four voxels floor-1 .. floor+2 around a point, where t is the fractional
 * part of the point's coordinate. The sum of the weights is 1. */
LANES_INLINE void tap_weights(const kernel *kernel, int degree, lanes t, lanes weight[4]) {
  lanes s = 1.0f - t;
  int bspline = degree == HL_BSPLINE_DEGREE;
  weight[0] = bspline ? bspline_outer(s) : kernel_piece(kernel->outer, degree, t);
  weight[1] = bspline ? bspline_inner(t) : kernel_piece(kernel->inner, degree, t);
  weight[3] = bspline ? bspline_outer(t) : kernel_piece(kernel->outer, degree, s);
  weight[2] = 1.0f - (weight[0] + weight[1] + weight[3]);
}

/* The derivative at `a` of one of a kernel's polynomial pieces. */
LANES_INLINE lanes kernel_piece_slope(const float *piece, int degree, lanes a) {
  lanes sum = lanes_set(piece[degree] * (float)degree);
  for (int power = degree - 1; power >= 1; power--)
    sum = lanes_fma(sum, a, lanes_set(piece[power] * (float)power));
  return sum;
}

/* The derivatives of the weights of the four voxels around a point with respect to t, the fractional part of
 * the point's coordinate. The derivatives add up to 0. As t grows, the distance to the taps 2 and 3 shrinks.
 */
LANES_INLINE void tap_slopes(const kernel *kernel, int degree, lanes t, lanes slope[4]) {
  lanes s = 1.0f - t;
  int bspline = degree == HL_BSPLINE_DEGREE;
  slope[0] = bspline ? s * (s * -0.5f) : kernel_piece_slope(kernel->outer, degree, t);
  slope[1] = bspline ? t * lanes_line(t, 1.5f, -2.0f) : kernel_piece_slope(kernel->inner, degree, t);
  slope[3] = bspline ? t * (t * 0.5f) : -kernel_piece_slope(kernel->outer, degree, s);
  slope[2] = -(slope[0] + slope[1] + slope[3]);
}

#endif
