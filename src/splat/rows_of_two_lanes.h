/* splat/rows_of_two_lanes.h - sums along y and z where there is AVX2 alone: two lanes share a register of 256
 * bits, k and k + 4 of eight. What weighing their taps along x leaves, a row of taps in each number, is
 * turned so that lanes lie side by side. */
#ifndef HL_SPLAT_ROWS_OF_TWO_LANES_H
#define HL_SPLAT_ROWS_OF_TWO_LANES_H

#include "splat/row_lanes.h"

/* The taps of lanes k and k + 4 of a half. */
typedef struct pair_of_taps {
  const unsigned char *first, *second;
} pair_of_taps;

/* Eight lanes' rows, weighed along x: slice by slice, of lanes k and k + 4 four rows each. In units of
 * weights. */
typedef struct sums_of_rows {
  __m256i of_two[4][4];
} sums_of_rows;

/* From four rows of two lanes in each of four, to eight lanes in each row, as floats. */
LANES_INLINE void turn_rows(const __m256i of_two[4], __m256 row[4]) {
  __m256i a = _mm256_unpacklo_epi32(of_two[0], of_two[1]), b = _mm256_unpacklo_epi32(of_two[2], of_two[3]);
  __m256i c = _mm256_unpackhi_epi32(of_two[0], of_two[1]), d = _mm256_unpackhi_epi32(of_two[2], of_two[3]);
  row[0] = _mm256_cvtepi32_ps(_mm256_unpacklo_epi64(a, b));
  row[1] = _mm256_cvtepi32_ps(_mm256_unpackhi_epi64(a, b));
  row[2] = _mm256_cvtepi32_ps(_mm256_unpacklo_epi64(c, d));
  row[3] = _mm256_cvtepi32_ps(_mm256_unpackhi_epi64(c, d));
}

/* Eight of sixteen lanes. */
LANES_INLINE __m256 half_of(const lanes *x, int half) { return _mm256_loadu_ps((const float *)x + 8 * half); }

/* Rows weighed along y and added to nothing, in their order. */
LANES_INLINE __m256 add_rows(const __m256 row[4], const lanes weight[4], int half) {
  __m256 plane = _mm256_setzero_ps();
  for (int y = 0; y < 4; y++) plane = _mm256_fmadd_ps(row[y], half_of(&weight[y], half), plane);
  return plane;
}

/* Eight lanes' sums. */
LANES_INLINE __m256 add_slices(const sums_of_rows *rows, const lanes weight[3][4], int half) {
  __m256 sum = _mm256_setzero_ps();
  for (int z = 0; z < 4; z++) {
    __m256 row[4];
    turn_rows(rows->of_two[z], row);
    sum = _mm256_fmadd_ps(add_rows(row, weight[1], half), half_of(&weight[2][z], half), sum);
  }
  return _mm256_mul_ps(sum, _mm256_set1_ps(WEIGHT_INVERSE));
}

/* Eight lanes' gradients. sloped: rows weighed by slopes, and in their units. */
typedef struct half_slope {
  __m256 x, y, z;
} half_slope;

LANES_INLINE half_slope add_slopes(const sums_of_rows *rows, const sums_of_rows *sloped_rows,
                                   const tap_slope_weights *w, int half) {
  __m256 x = _mm256_setzero_ps(), y = x, z = x;
  for (int slice = 0; slice < 4; slice++) {
    __m256 plain[4], sloped[4], weight = half_of(&w->weight[2][slice], half);
    turn_rows(rows->of_two[slice], plain);
    turn_rows(sloped_rows->of_two[slice], sloped);
    x = _mm256_fmadd_ps(add_rows(sloped, w->weight[1], half), weight, x);
    y = _mm256_fmadd_ps(add_rows(plain, w->slope[1], half), weight, y);
    z = _mm256_fmadd_ps(add_rows(plain, w->weight[1], half), half_of(&w->slope[2][slice], half), z);
  }
  const __m256 units = _mm256_set1_ps(WEIGHT_INVERSE);
  return (half_slope){_mm256_mul_ps(x, _mm256_set1_ps(SLOPE_INVERSE)), _mm256_mul_ps(y, units),
                      _mm256_mul_ps(z, units)};
}

LANES_INLINE void store_half(half_slope of, int half, lanes3 *slope) {
  _mm256_storeu_ps((float *)&slope->x + 8 * half, of.x);
  _mm256_storeu_ps((float *)&slope->y + 8 * half, of.y);
  _mm256_storeu_ps((float *)&slope->z + 8 * half, of.z);
}

#endif
