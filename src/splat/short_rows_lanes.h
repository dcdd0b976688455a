/* splat/short_rows_lanes.h - u16 voxels where there is AVX2 alone: each lane's rows of four taps are one
 * load, eight bytes, from the volume, and are weighed as they lie (rows_of_two_lanes.h). */
#ifndef HL_SPLAT_SHORT_ROWS_LANES_H
#define HL_SPLAT_SHORT_ROWS_LANES_H

#include "splat/rows_of_two_lanes.h"

/* voxels, offsets: bytes to every lane's first tap. */
LANES_INLINE pair_of_taps short_taps_of_pair(const unsigned char *voxels, const lanes_offsets *offsets,
                                             int half, int k) {
  const int32_t *at = offsets->at + 8 * half + k;
  return (pair_of_taps){voxels + at[0], voxels + at[4]};
}

/* Two rows of a lane's taps. */
LANES_INLINE __m128i two_short_rows(const unsigned char *first, size_t row_bytes) {
  double row[2];
  memcpy(&row[0], first, sizeof row[0]);
  memcpy(&row[1], first + row_bytes, sizeof row[1]);
  return _mm_castpd_si128(_mm_set_pd(row[1], row[0]));
}
/* Those of two lanes, less 32768. */
LANES_INLINE __m256i short_rows_of_two(const pair_of_taps *taps, size_t at, size_t row_bytes) {
  __m256i rows = _mm256_castsi128_si256(two_short_rows(taps->first + at, row_bytes));
  rows = _mm256_inserti128_si256(rows, two_short_rows(taps->second + at, row_bytes), 1);
  return _mm256_xor_si256(rows, _mm256_set1_epi32(VOXEL_SIGN));
}

/* A slice of two lanes' taps. */
typedef struct short_slice {
  __m256i upper, lower;
} short_slice;

LANES_INLINE short_slice short_slice_of_two(const pair_of_taps *taps, size_t at, size_t row_bytes) {
  return (short_slice){short_rows_of_two(taps, at, row_bytes),
                       short_rows_of_two(taps, at + 2 * row_bytes, row_bytes)};
}

/* Two lanes' weights or slopes, each lane's four in half a register, twice: once for each row. */
LANES_INLINE __m256i short_weights_of_pair(const short_weights *weights, int half, int k) {
  __m256i low = _mm256_loadu_si256((const __m256i *)(const void *)&weights->pair[0] + half);
  __m256i high = _mm256_loadu_si256((const __m256i *)(const void *)&weights->pair[1] + half);
  __m256i both = k < 2 ? _mm256_unpacklo_epi32(low, high) : _mm256_unpackhi_epi32(low, high);
  return k % 2 == 0 ? _mm256_unpacklo_epi64(both, both) : _mm256_unpackhi_epi64(both, both);
}

/* Each row's sum. */
LANES_INLINE __m256i slope_short_slice(const short_slice *slice, __m256i weights) {
  return _mm256_hadd_epi32(_mm256_madd_epi16(slice->upper, weights),
                           _mm256_madd_epi16(slice->lower, weights));
}
LANES_INLINE __m256i weigh_short_slice(const short_slice *slice, __m256i weights) {
  return _mm256_add_epi32(slope_short_slice(slice, weights), _mm256_set1_epi32(LESS_BY));
}

/* Of every lane; its place in the volume as above. */
LANES_INLINE lanes sum_short_rows(const grid *grid, const unsigned char *voxels, const lanes_offsets *offsets,
                                  const lanes weight[3][4]) {
  size_t row_bytes = (size_t)grid->dimension[0] * 2, slice_bytes = row_bytes * (size_t)grid->dimension[1];
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
  size_t row_bytes = (size_t)grid->dimension[0] * 2, slice_bytes = row_bytes * (size_t)grid->dimension[1];
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
