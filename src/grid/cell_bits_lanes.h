/* grid/cell_bits_lanes.h - finds the bits of a brick's 64 cells from its 7x7x7 voxels. Bounds are found along
 * z, then y, then x. Two rows of eight numbers along x fill sixteen lanes. */
#ifndef HL_GRID_CELL_BITS_LANES_H
#define HL_GRID_CELL_BITS_LANES_H

#include "grid/relevant.h"
#include "simd/lanes.h"

enum { BITS_ROW = 8, BITS_ROWS = 8 };

/* ---- voxels as numbers ---- */

LANES_INLINE int32_t bits_voxel_at(int32_t i, int32_t count) {
  return i < 0 ? 0 : i >= count ? count - 1 : i;
}

/* Loads eight voxels of each of two rows that lie within the grid. */
LANES_INLINE lanes bits_two_rows(hl_storage storage, const unsigned char *const row[2]) {
  if (storage == HL_STORAGE_U8) {
    typedef uint8_t bytes __attribute__((vector_size(LANES)));
    bytes both;
    memcpy((char *)&both, row[0], BITS_ROW);
    memcpy((char *)&both + BITS_ROW, row[1], BITS_ROW);
    return __builtin_convertvector(both, lanes);
  }
  if (storage == HL_STORAGE_U16) {
    lanes_short both;
    memcpy((char *)&both, row[0], 2 * BITS_ROW);
    memcpy((char *)&both + 2 * BITS_ROW, row[1], 2 * BITS_ROW);
    return __builtin_convertvector(both, lanes);
  }
  lanes both;
  memcpy((char *)&both, row[0], 4 * BITS_ROW);
  memcpy((char *)&both + 4 * BITS_ROW, row[1], 4 * BITS_ROW);
  return both;
}

/* Loads eight voxels of each of two rows that reach beyond the grid's faces, or lie in pages. Beyond the
 * grid's faces, the values at the border continue. */
LANES_INLINE lanes bits_two_held_rows(const grid *grid, int32_t x, int32_t y, int32_t z) {
  float both[LANES];
  for (int i = 0; i < LANES; i++) both[i] = hl_stored_value(grid, x + i % BITS_ROW, y + i / BITS_ROW, z);
  return lanes_load(both);
}

/* ---- bounds of four cells along an axis ---- */

/* The two inner Bezier points of a cell along an axis, times 3. Derived: the cell between voxels b and c has
 * the inner Bezier points (2 b + c) / 3 and (b + 2 c) / 3. The cell's two outer points are the values at the
 * cell's ends. Each outer point is the mean of the inner points on its two sides: (b + 4 c + d) / 6 = ((b + 2
 * c) / 3 + (2 c + d) / 3) / 2. */
typedef struct bits_thirds {
  lanes first, second; /* the points at a third and at two thirds of the way from the voxel b to the voxel
                        * c */
} bits_thirds;

LANES_INLINE bits_thirds thirds_between(lanes b, lanes c) {
  lanes sum = b + c;
  return (bits_thirds){sum + b, sum + c};
}

LANES_INLINE lanes greatest_of_cell(bits_thirds before, bits_thirds cell, bits_thirds after) {
  lanes first = (before.second + cell.first) * 0.5f, last = (cell.second + after.first) * 0.5f;
  return lanes_max(lanes_max(first, last), lanes_max(cell.first, cell.second));
}

LANES_INLINE void greatest_of_four(const lanes v[CELL_BIT_TAPS], lanes greatest[HL_BRICK_CELLS]) {
  bits_thirds before = thirds_between(v[0], v[1]), cell = thirds_between(v[1], v[2]);
#pragma GCC unroll 4
  for (int i = 0; i < HL_BRICK_CELLS; i++) {
    bits_thirds after = thirds_between(v[i + 2], v[i + 3]);
    greatest[i] = greatest_of_cell(before, cell, after);
    before = cell;
    cell = after;
  }
}

/* ---- a brick ---- */

/* Finds bounds of a brick's cells along z. The result has the order [cell z][y][x]. A layer of the brick's
 * voxels has seven rows; an eighth row only fills the lanes. */
LANES_INLINE void bits_along_z(const grid *grid, hl_storage storage, const int32_t brick[3], float sign,
                               float bounds[HL_BRICK_CELLS][BITS_ROWS][BITS_ROW]) {
  const int32_t *count = grid->dimension;
  size_t bytes = hl_storage_bytes(storage);
  int32_t x = brick[0] * HL_BRICK_CELLS - 2, y = brick[1] * HL_BRICK_CELLS - 2,
          z = brick[2] * HL_BRICK_CELLS - 2;
  int within = grid->voxels != NULL && x >= 0 && x + BITS_ROW <= count[0];
  const unsigned char *voxels = (const unsigned char *)grid->voxels + (within ? (size_t)x * bytes : 0);
  for (int pair = 0; pair < BITS_ROWS / 2; pair++) {
    lanes v[CELL_BIT_TAPS], greatest[HL_BRICK_CELLS];
    size_t first = (size_t)bits_voxel_at(y + 2 * pair, count[1]) * grid->row_bytes;
    size_t second = (size_t)bits_voxel_at(y + 2 * pair + 1, count[1]) * grid->row_bytes;
    for (int tap = 0; tap < CELL_BIT_TAPS; tap++) {
      const unsigned char *slice = voxels + (size_t)bits_voxel_at(z + tap, count[2]) * grid->slice_bytes;
      const unsigned char *const rows[2] = {slice + first, slice + second};
      v[tap] = (within ? bits_two_rows(storage, rows) : bits_two_held_rows(grid, x, y + 2 * pair, z + tap)) *
               sign;
    }
    greatest_of_four(v, greatest);
    for (int i = 0; i < HL_BRICK_CELLS; i++) lanes_store(bounds[i][2 * pair], greatest[i]);
  }
}

/* Finds the bounds along y from the bounds along z, for two layers of cells at a time. The result has the
 * order [cell z][cell y][x]. */
LANES_INLINE void bits_along_y(float from[HL_BRICK_CELLS][BITS_ROWS][BITS_ROW],
                               float bounds[HL_BRICK_CELLS][HL_BRICK_CELLS][BITS_ROW]) {
  for (int layer = 0; layer < HL_BRICK_CELLS; layer += 2) {
    lanes v[CELL_BIT_TAPS], greatest[HL_BRICK_CELLS];
    for (int tap = 0; tap < CELL_BIT_TAPS; tap++) {
      memcpy((char *)&v[tap], from[layer][tap], sizeof from[layer][tap]);
      memcpy((char *)&v[tap] + sizeof from[layer][tap], from[layer + 1][tap], sizeof from[layer][tap]);
    }
    greatest_of_four(v, greatest);
    for (int i = 0; i < HL_BRICK_CELLS; i++) {
      memcpy(bounds[layer][i], (char *)&greatest[i], sizeof bounds[layer][i]);
      memcpy(bounds[layer + 1][i], (char *)&greatest[i] + sizeof bounds[layer][i], sizeof bounds[layer][i]);
    }
  }
}

LANES_INLINE uint64_t bits_of_brick(const grid *grid, hl_storage storage, const int32_t brick[3], float sign,
                                    float threshold) {
  _Alignas(64) float along_z[HL_BRICK_CELLS][BITS_ROWS][BITS_ROW],
      along_y[HL_BRICK_CELLS][HL_BRICK_CELLS][BITS_ROW];
  bits_along_z(grid, storage, brick, sign, along_z);
  bits_along_y(along_z, along_y);
  uint64_t bits = 0;
  for (int layer = 0; layer < HL_BRICK_CELLS; layer++) {
    lanes v[4];
    for (int tap = 0; tap < 4; tap++) v[tap] = lanes_load_block(&along_y[layer][0][tap], BITS_ROW);
    lanes greatest = greatest_of_cell(thirds_between(v[0], v[1]), thirds_between(v[1], v[2]),
                                      thirds_between(v[2], v[3]));
    /* `greatest` is 27 times too large, because it was multiplied by 3 along each of the three axes */
    bits |= (uint64_t)lanes_bits(greatest > lanes_set(27 * threshold)) << (16 * layer);
  }
  return bits;
}

static uint64_t brick_bits(const grid *grid, const int32_t brick[3], float sign, float threshold) {
  if (grid->storage == HL_STORAGE_U8) return bits_of_brick(grid, HL_STORAGE_U8, brick, sign, threshold);
  if (grid->storage == HL_STORAGE_U16) return bits_of_brick(grid, HL_STORAGE_U16, brick, sign, threshold);
  return bits_of_brick(grid, HL_STORAGE_F32, brick, sign, threshold);
}

#endif
