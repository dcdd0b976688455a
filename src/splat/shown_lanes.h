/* splat/shown_lanes.h - whether a block of pixels may show something on a sheet: the cells that its sixteen
 * points lie in, looked up one by one (cell_bits.h). */
#ifndef HL_SPLAT_SHOWN_LANES_H
#define HL_SPLAT_SHOWN_LANES_H

#include "simd/narrow.h"
#include "splat/place_lanes.h"

/* The bit of a cell in its word of 32. */
LANES_INLINE lanes_int bit_of_cell(lanes_int x, lanes_int y, lanes_int z) {
  return lanes_set_int(1) << ((x & 3) | (y & 3) << 2 | (z & 1) << 4);
}

/* Points anywhere: each one's word is loaded. */
static __attribute__((noinline)) int far_cells_show(const grid *grid, const lanes_int cell[3]) {
  lanes_int x = cell[0] + 1, y = cell[1] + 1, z = cell[2] + 1;
  lanes_int brick = ((z >> 2) * grid->brick_count[1] + (y >> 2)) * grid->brick_count[0] + (x >> 2);
  lanes_int words = lanes_gather_bytes((const unsigned char *)grid->cell_bits, brick * 8 + (z & 2) * 2);
  return lanes_bits((words & bit_of_cell(x, y, z)) != 0) != 0;
}

#if defined(__AVX2__) && !defined(__AVX512F__)
/* Whether the bit of any cell is set, of the 2x2x2 bricks from `place` on. within: from the first of their
 * cells, a byte each. Two bricks side by side are sixteen bytes, in which a cell's is looked up: four cells
 * along x and two along y share one. */
LANES_INLINE int near_cells_show(const grid *grid, size_t place, const __m128i within[3]) {
  size_t row = (size_t)grid->brick_count[0], layer = row * (size_t)grid->brick_count[1];
  const uint64_t *bits = grid->cell_bits + place;
  const __m128i one = _mm_set1_epi8(1), four = _mm_set1_epi8(4);
  __m128i x = within[0], y = within[1], z = within[2], found[4];
  __m128i brick = _mm_and_si128(_mm_slli_epi16(x, 1), _mm_set1_epi8(8)),
          layer_of_four = _mm_and_si128(_mm_slli_epi16(z, 1), _mm_set1_epi8(6));
  __m128i byte = _mm_or_si128(_mm_or_si128(brick, layer_of_four), _mm_and_si128(_mm_srli_epi16(y, 1), one));
  __m128i bit = _mm_or_si128(_mm_and_si128(x, _mm_set1_epi8(3)), _mm_and_si128(_mm_slli_epi16(y, 2), four));
  const size_t bricks_on[4] = {0, row, layer, layer + row};
  for (int i = 0; i < 4; i++)
    found[i] = _mm_shuffle_epi8(_mm_loadu_si128((const __m128i *)(const void *)(bits + bricks_on[i])), byte);
  __m128i below = _mm_slli_epi16(y, 5),
          behind = _mm_slli_epi16(z, 5); /* their highest bits: the second brick along y, along z */
  __m128i word = _mm_blendv_epi8(_mm_blendv_epi8(found[0], found[1], below),
                                 _mm_blendv_epi8(found[2], found[3], below), behind);
  const __m128i bit_of = _mm_setr_epi8(1, 2, 4, 8, 16, 32, 64, (char)128, 0, 0, 0, 0, 0, 0, 0, 0);
  return !_mm_testz_si128(word, _mm_shuffle_epi8(bit_of, bit));
}

/* False where a cell is not within the bricks. */
LANES_INLINE int cells_near(const lanes_int cell[3], const int32_t first[3], __m128i within[3]) {
  for (int axis = 0; axis < 3; axis++) within[axis] = narrow_bytes(cell[axis] - first[axis]);
  __m128i all = _mm_or_si128(_mm_or_si128(within[0], within[1]), within[2]);
  return _mm_testz_si128(all, _mm_set1_epi8(~7));
}
typedef __m128i cells_within;
#else
/* Eight bricks' bits, as words of 32: those of brick (x, y, z) from 2 x + 4 y + 8 z on. */
LANES_INLINE lanes_int bits_near(const grid *grid, size_t place) {
  size_t row = (size_t)grid->brick_count[0], layer = row * (size_t)grid->brick_count[1];
  const uint64_t *bits = grid->cell_bits + place;
  lanes_int words;
  memcpy((char *)&words, bits, 16);
  memcpy((char *)&words + 16, bits + row, 16);
  memcpy((char *)&words + 32, bits + layer, 16);
  memcpy((char *)&words + 48, bits + layer + row, 16);
  return words;
}

LANES_INLINE int near_cells_show(const grid *grid, size_t place, const lanes_int within[3]) {
  lanes_int x = within[0], y = within[1], z = within[2];
  lanes_int word = (z >> 1 & 1) | (x & 4) >> 1 | (y & 4) | (z & 4) << 1;
  return lanes_bits((lanes_look_up(bits_near(grid, place), word) & bit_of_cell(x, y, z)) != 0) != 0;
}

LANES_INLINE int cells_near(const lanes_int cell[3], const int32_t first[3], lanes_int within[3]) {
  for (int axis = 0; axis < 3; axis++) within[axis] = cell[axis] - first[axis];
  return lanes_bits(((within[0] | within[1] | within[2]) & ~7) != 0) == 0;
}
typedef lanes_int cells_within;
#endif

/* cell: floors of a block's points, clamped as place_block() does; low: the least along each axis. Most often
 * all lie in the 2x2x2 bricks from the least one's on. */
LANES_INLINE int cells_show(const grid *grid, const lanes_int cell[3], const int32_t low[3]) {
  int32_t first_cell[3];
  cells_within within[3];
  size_t place = 0;
  for (int axis = 2; axis >= 0; axis--) {
    int32_t first = (low[axis] + 1) >> 2, last = grid->brick_count[axis] - 2;
    if (first > last) first = last;
    if (first < 0) return far_cells_show(grid, cell);
    first_cell[axis] = first * HL_BRICK_CELLS - 1;
    place = place * (size_t)grid->brick_count[axis] + (size_t)first;
  }
  if (!cells_near(cell, first_cell, within)) return far_cells_show(grid, cell);
  return near_cells_show(grid, place, within);
}

#endif
