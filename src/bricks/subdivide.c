/* bricks/subdivide.c - subdivides coefficients (subdivide.h), along one axis after the other. */
#include "bricks/subdivide.h"

/* i / 2, rounded down. */
static ptrdiff_t half(ptrdiff_t i) { return (i - (i & 1)) / 2; }

hl_lattice_box hl_subdivision_source(const hl_lattice_box *box) {
  hl_lattice_box coarse;
  for (int axis = 0; axis < 3; axis++) {
    ptrdiff_t first = box->first[axis], last = first + (ptrdiff_t)box->count[axis] - 1;
    coarse.first[axis] = first & 1 ? half(first) : half(first) - 1;
    coarse.count[axis] = (size_t)(half(last) + 1 - coarse.first[axis] + 1);
  }
  return coarse;
}

size_t hl_subdivision_scratch(const hl_lattice_box *box) {
  hl_lattice_box coarse = hl_subdivision_source(box);
  return box->count[0] * coarse.count[2] * (coarse.count[1] + box->count[1]);
}

/* The difference other - d, or 0 if `other` is not a number. */
static inline float difference(float other, float d) {
  float change = other - d;
  return change == change || d != d ? change : 0;
}

/* Coefficient i along an axis. from: the coarse coefficients; their first one has the index `first`. step:
 * distance from one coefficient to the next. The sums are written with differences, so that equal
 * coefficients give exactly the same number. */
static inline float along(const float *from, ptrdiff_t first, size_t step, ptrdiff_t i) {
  const float *d = from + (size_t)(half(i) - first) * step;
  if (i & 1) return d[0] == d[0] ? d[0] + 0.5f * difference(d[step], d[0]) : d[step];
  const float *before = d - step;
  return d[0] + 0.125f * (difference(before[0], d[0]) + difference(d[step], d[0]));
}

void hl_subdivide(const hl_lattice_box *box, const float *coarse, float *scratch, float *fine) {
  hl_lattice_box from = hl_subdivision_source(box);
  const size_t *n = box->count, *m = from.count;
  float *by_x = scratch, *by_y = scratch + n[0] * m[1] * m[2]; /* [m2][m1][n0], [m2][n1][n0] */
  for (size_t row = 0; row < m[1] * m[2]; row++)
    for (size_t i = 0; i < n[0]; i++)
      by_x[row * n[0] + i] = along(coarse + row * m[0], from.first[0], 1, box->first[0] + (ptrdiff_t)i);
  for (size_t k = 0; k < m[2]; k++)
    for (size_t j = 0; j < n[1]; j++)
      for (size_t i = 0; i < n[0]; i++)
        by_y[(k * n[1] + j) * n[0] + i] = along(by_x + k * m[1] * n[0] + i, from.first[1], n[0],
                                                box->first[1] + (ptrdiff_t)j);
  size_t slice = n[0] * n[1];
  for (size_t k = 0; k < n[2]; k++)
    for (size_t at = 0; at < slice; at++)
      fine[k * slice + at] = along(by_y + at, from.first[2], slice, box->first[2] + (ptrdiff_t)k);
}

double hl_field_at_point(const float *first, size_t row, size_t slice) {
  static const double weight[3] = {1.0 / 6, 2.0 / 3, 1.0 / 6};
  double sum = 0;
  for (size_t k = 0; k < 3; k++)
    for (size_t j = 0; j < 3; j++)
      for (size_t i = 0; i < 3; i++)
        sum += weight[i] * weight[j] * weight[k] * (double)first[k * slice + j * row + i];
  return sum;
}
