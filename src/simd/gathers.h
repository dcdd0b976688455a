/* simd/gathers.h - loads sixteen lanes of numbers from sixteen positions in a table.
 *
 * The functions gather words, floats, rows, pairs and squares, with the least number of loads that an
 * instruction set allows. The results are the same with all instruction sets. */
#ifndef HL_SIMD_GATHERS_H
#define HL_SIMD_GATHERS_H

#include "simd/lanes.h"

/* Loads four bytes from any address as a whole number, in the processor's byte order. */
LANES_INLINE int32_t lanes_word(const unsigned char *p) {
  int32_t word;
  memcpy(&word, p, sizeof word);
  return word;
}

/* The offsets of sixteen loads. The offsets are kept in memory, because taking them out of a vector register
 * one by one would cost more than the loads. */
typedef struct lanes_offsets {
  _Alignas(64) int32_t at[LANES];
} lanes_offsets;

LANES_INLINE void lanes_store_offsets(lanes_offsets *offsets, lanes_int value) {
  memcpy(offsets->at, &value, sizeof offsets->at);
  /* keeps the compiler from holding the offsets in a register */
  __asm__ volatile("" : : "r"(offsets) : "memory");
}

/* Loads four bytes for each of sixteen lanes, at base + offset (bytes). The loads are plain loads, because
 * gather instructions were four times slower on processors with the mitigations against data sampling
 * (measured). clang 19 nevertheless generates some gather instructions for AVX-512. */
LANES_CALL lanes_int lanes_load_words(const unsigned char *base, const lanes_offsets *offsets) {
#define LANES_WORD(lane) lanes_word(base + offsets->at[lane])
  return (lanes_int){LANES_WORD(0),  LANES_WORD(1),  LANES_WORD(2),  LANES_WORD(3),
                     LANES_WORD(4),  LANES_WORD(5),  LANES_WORD(6),  LANES_WORD(7),
                     LANES_WORD(8),  LANES_WORD(9),  LANES_WORD(10), LANES_WORD(11),
                     LANES_WORD(12), LANES_WORD(13), LANES_WORD(14), LANES_WORD(15)};
#undef LANES_WORD
}

LANES_INLINE lanes_int lanes_gather_bytes(const unsigned char *base, lanes_int offset) {
  lanes_offsets offsets;
  lanes_store_offsets(&offsets, offset);
  return lanes_load_words(base, &offsets);
}

/* Returns words[index] for every lane. */
LANES_CALL lanes_int lanes_look_up(lanes_int words, lanes_int index) {
#if defined(__AVX512F__)
  return (lanes_int)_mm512_permutexvar_epi32((__m512i)index, (__m512i)words);
#elif defined(__AVX2__)
  __m256i from[2], at[2];
  memcpy(from, &words, sizeof from);
  memcpy(at, &index, sizeof at);
  for (int half = 0; half < 2; half++) {
    __m256 low = _mm256_castsi256_ps(_mm256_permutevar8x32_epi32(from[0], at[half]));
    __m256 high = _mm256_castsi256_ps(_mm256_permutevar8x32_epi32(from[1], at[half]));
    __m256 upper = _mm256_castsi256_ps(_mm256_slli_epi32(at[half], 28));
    at[half] = _mm256_castps_si256(_mm256_blendv_ps(low, high, upper));
  }
  memcpy(&index, at, sizeof index);
  return index;
#else
  unsigned char table[sizeof words];
  memcpy(table, &words, sizeof words);
  return lanes_gather_bytes(table, index * 4);
#endif
}

/* Returns table[index] for every lane, for a table of floats. */
LANES_INLINE lanes lanes_gather(const float *table, lanes_int index) {
  return (lanes)lanes_gather_bytes((const unsigned char *)table, index * 4);
}

#if defined(__AVX512F__)
/* Loads the rows index and index + 1 of two lanes, eight floats for each lane. */
LANES_INLINE __m512 two_row_pairs(const float *table, int32_t first, int32_t second) {
  __m512d low = _mm512_castpd256_pd512(_mm256_castps_pd(_mm256_loadu_ps(table + first)));
  return _mm512_castpd_ps(_mm512_insertf64x4(low, _mm256_castps_pd(_mm256_loadu_ps(table + second)), 1));
}

/* Transposes, in each quarter of the registers, four rows of four floats to four columns. */
LANES_INLINE void columns_of_quads(const __m512 rows[4], __m512 columns[4]) {
  __m512d a = _mm512_castps_pd(_mm512_unpacklo_ps(rows[0], rows[1])),
          b = _mm512_castps_pd(_mm512_unpacklo_ps(rows[2], rows[3]));
  __m512d c = _mm512_castps_pd(_mm512_unpackhi_ps(rows[0], rows[1])),
          d = _mm512_castps_pd(_mm512_unpackhi_ps(rows[2], rows[3]));
  columns[0] = _mm512_castpd_ps(_mm512_unpacklo_pd(a, b));
  columns[1] = _mm512_castpd_ps(_mm512_unpackhi_pd(a, b));
  columns[2] = _mm512_castpd_ps(_mm512_unpacklo_pd(c, d));
  columns[3] = _mm512_castpd_ps(_mm512_unpackhi_pd(c, d));
}
#endif

/* Gathers table[index] to table[index + 3] as quad[0] to quad[3], by one load for each lane. */
LANES_CALL void lanes_gather_quads(const float *table, lanes_int index, lanes quad[4]) {
#if defined(__AVX512F__)
  lanes_offsets offsets;
  lanes_store_offsets(&offsets, index);
  __m512 of_lanes[4], columns[4]; /* of_lanes[k]: the values of lanes k, 4 + k, ... */
  for (int k = 0; k < 4; k++) {
    __m512 four = _mm512_castps128_ps512(_mm_loadu_ps(table + offsets.at[k]));
    four = _mm512_insertf32x4(four, _mm_loadu_ps(table + offsets.at[4 + k]), 1);
    four = _mm512_insertf32x4(four, _mm_loadu_ps(table + offsets.at[8 + k]), 2);
    of_lanes[k] = _mm512_insertf32x4(four, _mm_loadu_ps(table + offsets.at[12 + k]), 3);
  }
  columns_of_quads(of_lanes, columns);
  for (int i = 0; i < 4; i++) quad[i] = (lanes)columns[i];
#elif defined(__AVX2__)
  lanes_offsets offsets;
  lanes_store_offsets(&offsets, index);
  for (int half = 0; half < 2; half++) {
    const int32_t *at = offsets.at + 8 * half;
    __m256 of_lanes[4]; /* of_lanes[k]: the values that lanes k and 4 + k hold */
    for (int k = 0; k < 4; k++)
      of_lanes[k] = _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(table + at[k])),
                                         _mm_loadu_ps(table + at[4 + k]), 1);
    __m256d a = _mm256_castps_pd(_mm256_unpacklo_ps(of_lanes[0], of_lanes[1])),
            b = _mm256_castps_pd(_mm256_unpacklo_ps(of_lanes[2], of_lanes[3]));
    __m256d c = _mm256_castps_pd(_mm256_unpackhi_ps(of_lanes[0], of_lanes[1])),
            d = _mm256_castps_pd(_mm256_unpackhi_ps(of_lanes[2], of_lanes[3]));
    const __m256d column[4] = {_mm256_unpacklo_pd(a, b), _mm256_unpackhi_pd(a, b), _mm256_unpacklo_pd(c, d),
                               _mm256_unpackhi_pd(c, d)};
    for (int i = 0; i < 4; i++) memcpy((float *)&quad[i] + 8 * half, &column[i], sizeof column[i]);
  }
#else
  for (int i = 0; i < 4; i++) quad[i] = lanes_gather(table + i, index);
#endif
}

/* Gathers table[4 index + c] as first[c] and table[4 (index + 1) + c] as second[c], for c from 0 to columns
 * - 1. The function takes one or two loads for each lane, while separate columns would take two loads each.
 */
LANES_INLINE void gather_rows_of_four(const float *table, lanes_int index, int columns, lanes *first,
                                      lanes *second) {
#if defined(__AVX512F__)
  lanes_offsets offsets;
  lanes_store_offsets(&offsets, index * 4);
  __m512 of_half[2][4]; /* of_half[h][c]: column c for the eight lanes of half h, in quarters of the register:
                         * the first rows of four lanes, the second rows of these lanes, then the same for the
                         * next four lanes */
  for (int half = 0; half < 2; half++) {
    const int32_t *at = offsets.at + 8 * half;
    __m512 pairs[4];
    for (int j = 0; j < 4; j++) pairs[j] = two_row_pairs(table, at[j], at[4 + j]);
    columns_of_quads(pairs, of_half[half]);
  }
  for (int c = 0; c < columns; c++) {
    first[c] = (lanes)_mm512_shuffle_f32x4(of_half[0][c], of_half[1][c], 0x88);
    second[c] = (lanes)_mm512_shuffle_f32x4(of_half[0][c], of_half[1][c], 0xdd);
  }
#elif defined(__AVX2__)
  lanes quad[2][4];
  lanes_gather_quads(table, index * 4, quad[0]);
  lanes_gather_quads(table + 4, index * 4, quad[1]);
  for (int c = 0; c < columns; c++) {
    first[c] = quad[0][c];
    second[c] = quad[1][c];
  }
#else
  for (int c = 0; c < columns; c++) {
    first[c] = lanes_gather(table + c, index * 4);
    second[c] = lanes_gather(table + 4 + c, index * 4);
  }
#endif
}
LANES_CALL void lanes_gather_row_pairs(const float *table, lanes_int index, lanes first[3], lanes second[3]) {
  gather_rows_of_four(table, index, 3, first, second);
}
LANES_CALL void lanes_gather_quad_pairs(const float *table, lanes_int index, lanes first[4],
                                        lanes second[4]) {
  gather_rows_of_four(table, index, 4, first, second);
}

#if defined(__AVX2__)
/* Loads two pairs of floats from any addresses. The pairs are loaded by memcpy(), because loading a double
 * would require alignment to eight bytes. */
LANES_INLINE __m128 two_pairs(const float *table, int32_t first, int32_t second) {
  double pair[2];
  memcpy(&pair[0], table + first, sizeof(double));
  memcpy(&pair[1], table + second, sizeof(double));
  return _mm_castpd_ps(_mm_set_pd(pair[1], pair[0]));
}
#endif

/* Gathers table[index] and table[index + 1] by a single load for the two numbers. */
LANES_CALL void lanes_gather_pairs(const float *table, lanes_int index, lanes *first, lanes *second) {
#if defined(__AVX512F__)
  lanes_offsets offsets;
  lanes_store_offsets(&offsets, index);
  __m512 pairs[2];
  for (int j = 0; j < 2; j++) {
    __m128 part[4];
    for (int q = 0; q < 4; q++)
      part[q] = two_pairs(table, offsets.at[4 * q + 2 * j], offsets.at[4 * q + 2 * j + 1]);
    __m512 pair = _mm512_insertf32x4(_mm512_castps128_ps512(part[0]), part[1], 1);
    pairs[j] = _mm512_insertf32x4(_mm512_insertf32x4(pair, part[2], 2), part[3], 3);
  }
  *first = (lanes)_mm512_shuffle_ps(pairs[0], pairs[1], 0x88);
  *second = (lanes)_mm512_shuffle_ps(pairs[0], pairs[1], 0xdd);
#elif defined(__AVX2__)
  lanes_offsets offsets;
  lanes_store_offsets(&offsets, index);
  __m256 columns[2][2];
  for (int half = 0; half < 2; half++) {
    const int32_t *at = offsets.at + 8 * half;
    __m256 pairs[2];
    for (int j = 0; j < 2; j++)
      pairs[j] = _mm256_set_m128(two_pairs(table, at[4 + 2 * j], at[5 + 2 * j]),
                                 two_pairs(table, at[2 * j], at[1 + 2 * j]));
    columns[0][half] = _mm256_shuffle_ps(pairs[0], pairs[1], 0x88);
    columns[1][half] = _mm256_shuffle_ps(pairs[0], pairs[1], 0xdd);
  }
  memcpy(first, columns[0], sizeof *first);
  memcpy(second, columns[1], sizeof *second);
#else
  *first = lanes_gather(table, index);
  *second = lanes_gather(table + 1, index);
#endif
}

/* Gathers table[index] and table[index + 1] of a table of 16-bit numbers, by one load of four bytes for
 * each lane. */
LANES_INLINE void lanes_gather_short_pairs(const uint16_t *table, lanes_int index, lanes_int *first,
                                           lanes_int *second) {
  lanes_int pair = lanes_gather_bytes((const unsigned char *)table, index * 2);
  *first = pair & 0xffff;
  *second = pair >> 16 & 0xffff;
}

/* Sixteen squares of two by two numbers in a table: the column and the row where each square begins. */
typedef struct lanes_squares {
  lanes_int column, row;
} lanes_squares;

#if defined(__AVX512BW__)
/* Finds the least column and the least row of the squares of the active lanes, in 16 bits each. Every lane of
 * the result holds both numbers. Columns and rows must be below 65535. */
LANES_INLINE __m512i least_corner(__m512i corners, __mmask16 active) {
  __m512i held = _mm512_mask_mov_epi32(_mm512_set1_epi32(-1), active, corners);
  __m256i of_eight = _mm256_min_epu16(_mm512_castsi512_si256(held), _mm512_extracti64x4_epi64(held, 1));
  __m128i least = _mm_min_epu16(_mm256_castsi256_si128(of_eight), _mm256_extracti128_si256(of_eight, 1));
  least = _mm_min_epu16(least, _mm_shuffle_epi32(least, 0x4e));
  return _mm512_broadcastd_epi32(_mm_min_epu16(least, _mm_shuffle_epi32(least, 0xb1)));
}

/* Loads four rows of eight numbers of 16 bits. */
LANES_INLINE __m512i four_rows(const uint16_t *from, size_t stride) {
  __m512i rows = _mm512_castsi128_si512(_mm_loadu_si128((const __m128i *)(const void *)from));
  rows = _mm512_inserti32x4(rows, _mm_loadu_si128((const __m128i *)(const void *)(from + stride)), 1);
  rows = _mm512_inserti32x4(rows, _mm_loadu_si128((const __m128i *)(const void *)(from + 2 * stride)), 2);
  return _mm512_inserti32x4(rows, _mm_loadu_si128((const __m128i *)(const void *)(from + 3 * stride)), 3);
}

/* Takes the squares of all active lanes from one window of eight rows of eight numbers. Returns false if the
 * squares are too far apart for one window. At least one lane must be active. */
LANES_INLINE int squares_in_window(const uint16_t *table, size_t stride, lanes_squares squares,
                                   uint32_t active, __m512i pair[2]) {
  __m512i corners = _mm512_or_si512((__m512i)squares.column, _mm512_slli_epi32((__m512i)squares.row, 16));
  __m512i least = least_corner(corners, (__mmask16)active), apart = _mm512_sub_epi16(corners, least);
  __m512i ends = _mm512_add_epi16(apart, _mm512_set1_epi16(1));
  if (_mm512_mask_test_epi32_mask((__mmask16)active, ends, _mm512_set1_epi16(-8)) != 0) return 0;
  uint32_t corner = (uint32_t)_mm_cvtsi128_si32(_mm512_castsi512_si128(least));
  const uint16_t *first = table + (corner >> 16) * stride + (corner & 0xffff);
  __m512i upper = four_rows(first, stride), lower = four_rows(first + 4 * stride, stride);
  __m512i index = _mm512_or_si512(_mm512_srli_epi32(apart, 13),
                                  _mm512_and_si512(apart, _mm512_set1_epi32(7)));
  index = _mm512_add_epi16(_mm512_or_si512(index, _mm512_slli_epi32(index, 16)), _mm512_set1_epi32(0x10000));
  pair[0] = _mm512_permutex2var_epi16(upper, index, lower);
  pair[1] = _mm512_permutex2var_epi16(upper, _mm512_add_epi16(index, _mm512_set1_epi16(8)), lower);
  return 1;
}
#endif

/* Gathers a square of numbers for each active lane: table[stride * row + column] as square[0], the next
 * number in the row as square[1], and the two numbers below them in the next row as square[2] and square[3].
 * Columns and rows must be below 65535; up to six further columns and rows may be read. */
LANES_CALL void lanes_gather_short_squares(const uint16_t *table, size_t stride, lanes_squares squares,
                                           uint32_t active, lanes_int square[4]) {
#if defined(__AVX512BW__)
  __m512i pair[2];
  if (squares_in_window(table, stride, squares, active, pair)) {
    for (int i = 0; i < 2; i++) {
      square[2 * i] = (lanes_int)_mm512_and_si512(pair[i], _mm512_set1_epi32(0xffff));
      square[2 * i + 1] = (lanes_int)_mm512_srli_epi32(pair[i], 16);
    }
    return;
  }
#else
  (void)active;
#endif
  lanes_int at = squares.row * (int32_t)stride + squares.column;
  lanes_gather_short_pairs(table, at, &square[0], &square[1]);
  lanes_gather_short_pairs(table + stride, at, &square[2], &square[3]);
}

#endif
