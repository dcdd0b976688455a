/* fill/rows_avx2_lanes.h - sums along y and z with AVX2, and sums over u16 voxels that are read directly from
 * the volume.
 *
 * A tap is one of the 64 voxels that a lane sums. A register of 256 bits holds the taps of two lanes: lanes k
 * and k + 4 of eight. The taps are weighted and summed along x, which leaves one number for each row of taps.
 * These numbers are transposed, so that lanes lie side by side, and are then weighted and summed along y and
 * z. */
#ifndef HL_FILL_ROWS_AVX2_LANES_H
#define HL_FILL_ROWS_AVX2_LANES_H

#include "fill/row_lanes.h"
#include "simd/gathers.h"
#include "view/rays_lanes.h"

/* The addresses of the taps of two lanes: lane k and lane k + 4 of eight lanes. */
typedef struct pair_of_taps {
  const unsigned char *first, *second;
} pair_of_taps;

/* Sums along x of the tap rows of eight lanes, in units of weights. Element [slice][k] holds the sums of four
 * rows of lane k and of four rows of lane k + 4. */
typedef struct sums_of_rows {
  __m256i of_two[4][4];
} sums_of_rows;

/* Transposes four registers, which hold four rows of two lanes each, to four rows of eight lanes, and
 * converts the numbers to floats. */
LANES_INLINE void turn_rows(const __m256i of_two[4], __m256 row[4]) {
  __m256i a = _mm256_unpacklo_epi32(of_two[0], of_two[1]), b = _mm256_unpacklo_epi32(of_two[2], of_two[3]);
  __m256i c = _mm256_unpackhi_epi32(of_two[0], of_two[1]), d = _mm256_unpackhi_epi32(of_two[2], of_two[3]);
  row[0] = _mm256_cvtepi32_ps(_mm256_unpacklo_epi64(a, b));
  row[1] = _mm256_cvtepi32_ps(_mm256_unpackhi_epi64(a, b));
  row[2] = _mm256_cvtepi32_ps(_mm256_unpacklo_epi64(c, d));
  row[3] = _mm256_cvtepi32_ps(_mm256_unpackhi_epi64(c, d));
}

/* Eight of the sixteen lanes: the lower half (`half` is 0) or the upper half (1). */
LANES_INLINE __m256 half_of(const lanes *x, int half) { return _mm256_loadu_ps((const float *)x + 8 * half); }

/* The sum of four rows of taps, weighted along y, for eight lanes. */
LANES_INLINE __m256 add_rows(const __m256 row[4], const lanes weight[4], int half) {
  __m256 plane = _mm256_setzero_ps();
  for (int y = 0; y < 4; y++) plane = _mm256_fmadd_ps(row[y], half_of(&weight[y], half), plane);
  return plane;
}

/* The weighted sums of all 64 taps, for eight lanes. */
LANES_INLINE __m256 add_slices(const sums_of_rows *rows, const lanes weight[3][4], int half) {
  __m256 sum = _mm256_setzero_ps();
  for (int z = 0; z < 4; z++) {
    __m256 row[4];
    turn_rows(rows->of_two[z], row);
    sum = _mm256_fmadd_ps(add_rows(row, weight[1], half), half_of(&weight[2][z], half), sum);
  }
  return _mm256_mul_ps(sum, _mm256_set1_ps(WEIGHT_INVERSE));
}

/* The gradients of eight lanes: three components. */
typedef struct half_slope {
  __m256 x, y, z;
} half_slope;

/* Adds up the gradients of eight lanes. sloped_rows: the sums along x with slopes in place of weights, in
 * units of slopes. */
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

/* ---- u16 voxels, straight from the volume ---- */

/* Finds the addresses of the taps of lanes k and k + 4. voxels: address of the volume's voxels. offsets:
 * number of bytes from this address to each lane's first tap. */
LANES_INLINE pair_of_taps short_taps_of_pair(const unsigned char *voxels, const lanes_offsets *offsets,
                                             int half, int k) {
  const int32_t *at = offsets->at + 8 * half + k;
  return (pair_of_taps){voxels + at[0], voxels + at[4]};
}

/* Loads two rows of a lane's taps, of four u16 voxels each. */
LANES_INLINE __m128i two_short_rows(const unsigned char *first, size_t row_bytes) {
  double row[2];
  memcpy(&row[0], first, sizeof row[0]);
  memcpy(&row[1], first + row_bytes, sizeof row[1]);
  return _mm_castpd_si128(_mm_set_pd(row[1], row[0]));
}
/* Loads two rows of taps for each of two lanes, and subtracts 32768 from the voxels. */
LANES_INLINE __m256i short_rows_of_two(const pair_of_taps *taps, size_t at, size_t row_bytes) {
  __m256i rows = _mm256_castsi128_si256(two_short_rows(taps->first + at, row_bytes));
  rows = _mm256_inserti128_si256(rows, two_short_rows(taps->second + at, row_bytes), 1);
  return _mm256_xor_si256(rows, _mm256_set1_epi32(VOXEL_SIGN));
}

/* A slice of two lanes' taps: four rows of four taps. upper: the first two rows; lower: the other two. */
typedef struct short_slice {
  __m256i upper, lower;
} short_slice;

LANES_INLINE short_slice short_slice_of_two(const pair_of_taps *taps, size_t at, size_t row_bytes) {
  return (short_slice){short_rows_of_two(taps, at, row_bytes),
                       short_rows_of_two(taps, at + 2 * row_bytes, row_bytes)};
}

/* The weights along x, or the slopes, of two lanes for two rows of taps. The register holds each lane's four
 * numbers twice, once for each row. */
LANES_INLINE __m256i short_weights_of_pair(const short_weights *weights, int half, int k) {
  __m256i low = _mm256_loadu_si256((const __m256i *)(const void *)&weights->pair[0] + half);
  __m256i high = _mm256_loadu_si256((const __m256i *)(const void *)&weights->pair[1] + half);
  __m256i both = k < 2 ? _mm256_unpacklo_epi32(low, high) : _mm256_unpackhi_epi32(low, high);
  return k % 2 == 0 ? _mm256_unpacklo_epi64(both, both) : _mm256_unpackhi_epi64(both, both);
}

/* Sums the rows of a slice of taps, weighted by slopes. */
LANES_INLINE __m256i slope_short_slice(const short_slice *slice, __m256i weights) {
  return _mm256_hadd_epi32(_mm256_madd_epi16(slice->upper, weights),
                           _mm256_madd_epi16(slice->lower, weights));
}
LANES_INLINE __m256i weigh_short_slice(const short_slice *slice, __m256i weights) {
  return _mm256_add_epi32(slope_short_slice(slice, weights), _mm256_set1_epi32(LESS_BY));
}

/* The weighted sum of each lane's 64 taps. voxels: address of the volume's voxels. offsets: number of bytes
 * from this address to each lane's first tap. */
LANES_INLINE lanes sum_short_rows(const grid *grid, const unsigned char *voxels, const lanes_offsets *offsets,
                                  const lanes weight[3][4]) {
  size_t row_bytes = grid->row_bytes, slice_bytes = grid->slice_bytes;
  row_weights weights = weights_of_row(HL_STORAGE_U16, weight[0]);
  __m256 sums[2];
#pragma GCC unroll 1
  for (int half = 0; half < 2; half++) {
    sums_of_rows rows;
    for (int k = 0; k < 4; k++) {
      pair_of_taps taps = short_taps_of_pair(voxels, offsets, half, k);
      __m256i along = short_weights_of_pair(&weights.shorts, half, k);
      for (size_t z = 0; z < 4; z++) {
        short_slice slice = short_slice_of_two(&taps, z * slice_bytes, row_bytes);
        rows.of_two[z][k] = weigh_short_slice(&slice, along);
      }
    }
    sums[half] = add_slices(&rows, weight, half);
  }
  lanes sum;
  memcpy(&sum, sums, sizeof sum);
  return sum;
}

LANES_INLINE lanes3 slopes_of_short_rows(const grid *grid, const unsigned char *voxels,
                                         const lanes_offsets *offsets, const tap_slope_weights *w) {
  size_t row_bytes = grid->row_bytes, slice_bytes = grid->slice_bytes;
  row_weights weights = weights_of_row(HL_STORAGE_U16, w->weight[0]);
  row_slopes slopes = slopes_of_row(HL_STORAGE_U16, w->slope[0]);
  lanes3 sum;
#pragma GCC unroll 1
  for (int half = 0; half < 2; half++) {
    sums_of_rows plain, sloped;
    for (int k = 0; k < 4; k++) {
      pair_of_taps taps = short_taps_of_pair(voxels, offsets, half, k);
      __m256i along = short_weights_of_pair(&weights.shorts, half, k),
              slope = short_weights_of_pair(&slopes.shorts, half, k);
      for (size_t z = 0; z < 4; z++) {
        short_slice slice = short_slice_of_two(&taps, z * slice_bytes, row_bytes);
        plain.of_two[z][k] = weigh_short_slice(&slice, along);
        sloped.of_two[z][k] = slope_short_slice(&slice, slope);
      }
    }
    store_half(add_slopes(&plain, &sloped, w, half), half, &sum);
  }
  return sum;
}

#endif
