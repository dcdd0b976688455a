/* splat/shown_lanes.h - whether a block of pixels may show something on a sheet: the cells that its sixteen points lie in, looked
 * up one by one (cell_bits.h). */
#ifndef HL_SPLAT_SHOWN_LANES_H
#define HL_SPLAT_SHOWN_LANES_H

#include "splat/place_lanes.h"

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

/* cell: floors of a block's points, clamped as place_block() does. Most often all lie in the 2x2x2 bricks from the least one's on. */
LANES_INLINE int cells_show(const grid *grid, const lanes_int cell[3]) {
  int32_t low[3];
  lanes_int within[3], beyond = lanes_set_int(0);
  size_t place = 0;
  lowest_of_block(cell, low);
  for (int axis = 2; axis >= 0; axis--) {
    int32_t first = (low[axis] + 1) >> 2, last = grid->brick_count[axis] - 2;
    if (first > last) first = last;
    if (first < 0) return far_cells_show(grid, cell);
    within[axis] = cell[axis] - (first * HL_BRICK_CELLS - 1);
    beyond |= within[axis];
    place = place * (size_t)grid->brick_count[axis] + (size_t)first;
  }
  if (lanes_bits((beyond & ~7) != 0) != 0) return far_cells_show(grid, cell);
  lanes_int x = within[0], y = within[1], z = within[2];
  lanes_int word = (z >> 1 & 1) | (x & 4) >> 1 | (y & 4) | (z & 4) << 1;
  return lanes_bits((lanes_look_up(bits_near(grid, place), word) & bit_of_cell(x, y, z)) != 0) != 0;
}

#endif
