/* grid/bounds_lanes.h - finds the bounds of bricks and of cells by plain loops that compilers vectorise. */
#ifndef HL_GRID_BOUNDS_LANES_H
#define HL_GRID_BOUNDS_LANES_H

#include "grid/grid.h"
#include "simd/lanes.h"

/* ---- bricks: elementwise bounds of many rows ---- */

enum { BOUND_CHUNK = 256 };

static void bound_rows_u8(const void *const *rows, int row_count, size_t count, float *least,
                          float *greatest) {
  for (size_t start = 0; start < count; start += BOUND_CHUNK) {
    uint8_t low[BOUND_CHUNK], high[BOUND_CHUNK];
    size_t length = count - start < BOUND_CHUNK ? count - start : BOUND_CHUNK;
    for (size_t i = 0; i < length; i++) low[i] = high[i] = ((const uint8_t *)rows[0])[start + i];
    for (int r = 1; r < row_count; r++) {
      const uint8_t *row = (const uint8_t *)rows[r] + start;
      for (size_t i = 0; i < length; i++) low[i] = row[i] < low[i] ? row[i] : low[i];
      for (size_t i = 0; i < length; i++) high[i] = row[i] > high[i] ? row[i] : high[i];
    }
    for (size_t i = 0; i < length; i++) least[start + i] = low[i], greatest[start + i] = high[i];
  }
}

static void bound_rows_u16(const void *const *rows, int row_count, size_t count, float *least,
                           float *greatest) {
  for (size_t start = 0; start < count; start += BOUND_CHUNK) {
    uint16_t low[BOUND_CHUNK], high[BOUND_CHUNK];
    size_t length = count - start < BOUND_CHUNK ? count - start : BOUND_CHUNK;
    for (size_t i = 0; i < length; i++) low[i] = high[i] = ((const uint16_t *)rows[0])[start + i];
    for (int r = 1; r < row_count; r++) {
      const uint16_t *row = (const uint16_t *)rows[r] + start;
      for (size_t i = 0; i < length; i++) low[i] = row[i] < low[i] ? row[i] : low[i];
      for (size_t i = 0; i < length; i++) high[i] = row[i] > high[i] ? row[i] : high[i];
    }
    for (size_t i = 0; i < length; i++) least[start + i] = low[i], greatest[start + i] = high[i];
  }
}

static void bound_rows_f32(const void *const *rows, int row_count, size_t count, float *least,
                           float *greatest) {
  for (size_t i = 0; i < count; i++) least[i] = greatest[i] = ((const float *)rows[0])[i];
  for (int r = 1; r < row_count; r++) {
    const float *row = rows[r];
    for (size_t i = 0; i < count; i++) least[i] = row[i] < least[i] ? row[i] : least[i];
    for (size_t i = 0; i < count; i++) greatest[i] = row[i] > greatest[i] ? row[i] : greatest[i];
  }
}

/* ---- cells: along a row and across rows ---- */

LANES_INLINE float greater(float a, float b) { return a > b ? a : b; }
LANES_INLINE float lesser(float a, float b) { return a < b ? a : b; }

/* knot() and third() give Bezier points of the B-spline (bounds.h): knot() gives the point at the middle
 * voxel of three neighbouring voxels, third() gives the point a third of the way from a voxel to its
 * neighbour. */
LANES_INLINE float knot(float a, float b, float c) { return (a + 4.0f * b + c) * (1.0f / 6); }
LANES_INLINE float third(float closer, float farther) { return (2.0f * closer + farther) * (1.0f / 3); }

LANES_INLINE float greatest_of_cells(int smooth, float a, float b, float c, float d, float e) {
  if (!smooth) return greater(greater(greater(a, b), greater(c, d)), e);
  float knots = greater(greater(knot(a, b, c), knot(b, c, d)), knot(c, d, e));
  return greater(knots, greater(greater(third(b, c), third(c, b)), greater(third(c, d), third(d, c))));
}
LANES_INLINE float least_of_cells(int smooth, float a, float b, float c, float d, float e) {
  if (!smooth) return lesser(lesser(lesser(a, b), lesser(c, d)), e);
  float knots = lesser(lesser(knot(a, b, c), knot(b, c, d)), knot(c, d, e));
  return lesser(knots, lesser(lesser(third(b, c), third(c, b)), lesser(third(c, d), third(d, c))));
}

LANES_INLINE void pad_row(hl_storage storage, const void *row, int32_t count, float *padded) {
  float *to = padded + 2;
  if (storage == HL_STORAGE_U8)
    for (int32_t i = 0; i < count; i++) to[i] = ((const uint8_t *)row)[i];
  else if (storage == HL_STORAGE_U16)
    for (int32_t i = 0; i < count; i++) to[i] = ((const uint16_t *)row)[i];
  else
    for (int32_t i = 0; i < count; i++) to[i] = ((const float *)row)[i];
  padded[0] = padded[1] = to[0];
  for (int32_t i = count; i < count + 4; i++) to[i] = to[count - 1];
}

LANES_INLINE void pairs_of_row(const float *restrict padded, int32_t count, int smooth, float *restrict low,
                               float *restrict high) {
  for (int32_t f = 0; f < count; f++) {
    const float *p = padded + 2 * f;
    low[f] = least_of_cells(smooth, p[0], p[1], p[2], p[3], p[4]);
    high[f] = greatest_of_cells(smooth, p[0], p[1], p[2], p[3], p[4]);
  }
}

static void bound_along(hl_storage storage, const void *row, int32_t count, bool smooth, float *padded,
                        float *low, float *high) {
  pad_row(storage, row, count, padded);
  if (smooth) pairs_of_row(padded, count / 2 + 1, 1, low, high);
  else pairs_of_row(padded, count / 2 + 1, 0, low, high);
}

LANES_INLINE void bound_five(const float *const l[CELL_TAPS], const float *const h[CELL_TAPS], size_t count,
                             int smooth, float *restrict low, float *restrict high) {
  for (size_t i = 0; i < count; i++)
    low[i] = least_of_cells(smooth, l[0][i], l[1][i], l[2][i], l[3][i], l[4][i]);
  for (size_t i = 0; i < count; i++)
    high[i] = greatest_of_cells(smooth, h[0][i], h[1][i], h[2][i], h[3][i], h[4][i]);
}

static void bound_across(const float *const low_rows[CELL_TAPS], const float *const high_rows[CELL_TAPS],
                         size_t count, bool smooth, float *low, float *high) {
  if (smooth) bound_five(low_rows, high_rows, count, 1, low, high);
  else bound_five(low_rows, high_rows, count, 0, low, high);
}

#endif
