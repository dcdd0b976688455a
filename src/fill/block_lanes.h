/* fill/block_lanes.h - finds the points of a volume at which the rays of a 4x4 block of pixels meet a sheet,
 * and whether the cells around these points may show something. */
#ifndef HL_FILL_BLOCK_LANES_H
#define HL_FILL_BLOCK_LANES_H

#include "core/sheet_constants.h"
#include "fill/fill.h"
#include "grid/kernel_lanes.h"
#include "simd/gathers.h"
#include "simd/narrow.h"
#include "view/rays_lanes.h"

/* The points where the rays of a block of pixels cross a sheet. */
typedef struct block_points {
  /* the points in index space; each coordinate is clamped to [-1, n), where n is the grid's number of voxels
   * along the axis */
  lanes3 position;
  lanes_int cell[3]; /* the cells that hold the points: floor(position), from -1 to n-1 */
  int32_t low[3];    /* the least coordinates of `cell` along each axis; lowest_of_block() sets them */
  lanes_int inside;  /* lanes whose point lies in the grid, or at most GRID_MARGIN outside the grid */
} block_points;

/* Finds the lanes that may be visible. A lane may be visible if its density stands behind all densities that
 * come before the first visible density in the classifier's table. */
LANES_INLINE lanes_int may_show(const fill_source *source, lanes density) {
  const classifier *classifier = source->classifier;
  if (classifier == NULL) return lanes_set_int(-1);
  return lanes_line(density, classifier->scale, classifier->offset) > classifier->first_visible;
}

LANES_INLINE block_points find_points(const fill_source *source, int x, int y) {
  const grid *grid = source->grid;
  lanes3 p = rays_positions(&source->rays, block_u(x), block_v(y));
  block_points points;
  lanes axis[3] = {p.x, p.y, p.z};
  points.inside = lanes_set_int(-1);
  for (int a = 0; a < 3; a++) {
    float count = (float)grid->dimension[a];
    points.inside &= (axis[a] > -0.5f - GRID_MARGIN) & (axis[a] < count - 0.5f + GRID_MARGIN);
    /* outside the grid, the values at the border continue smoothly; beyond -1 or n, the density is
     * constant */
    axis[a] = lanes_clamp(axis[a], -1.0f, count * (1 - 1e-6f));
    points.cell[a] = lanes_floor(axis[a]);
  }
  points.position = (lanes3){axis[0], axis[1], axis[2]};
  return points;
}

/* Finds the least cell of a block along each axis. Along a row or a column of pixels, cells only rise or only
 * fall. So the least cell along an axis is the cell of a pixel at a corner of the block, up to rounding. */
LANES_INLINE void lowest_of_block(const lanes_int cell[3], int32_t low[3]) {
#if defined(__AVX512BW__)
  const __m512i of_two = _mm512_set_epi32(0, 0, 0, 0, 15, 12, 3, 0, 31, 28, 19, 16, 15, 12, 3, 0);
  __m512i corners = _mm512_permutex2var_epi32((__m512i)cell[0], of_two, (__m512i)cell[1]);
  corners = _mm512_mask_permutexvar_epi32(corners, 0x0f00, of_two, (__m512i)cell[2]);
  corners = _mm512_min_epi32(corners, _mm512_shuffle_epi32(corners, _MM_PERM_CDAB));
  corners = _mm512_min_epi32(corners, _mm512_shuffle_epi32(corners, _MM_PERM_BADC));
  low[0] = _mm_cvtsi128_si32(_mm512_castsi512_si128(corners));
  low[1] = _mm_cvtsi128_si32(_mm512_extracti32x4_epi32(corners, 1));
  low[2] = _mm_cvtsi128_si32(_mm512_extracti32x4_epi32(corners, 2));
#elif defined(__AVX2__)
  const lanes_int axes[4] = {cell[0], cell[1], cell[2], cell[2]};
  int32_t least[4];
  _mm_storeu_si128((__m128i *)(void *)least, lanes_least_of_each(axes));
  for (int axis = 0; axis < 3; axis++) low[axis] = least[axis];
#else
  for (int axis = 0; axis < 3; axis++) {
    low[axis] = cell[axis][0];
    for (int corner = 1; corner < 4; corner++) {
      int32_t other = cell[axis][corner % 2 * 3 + corner / 2 * 12];
      if (other < low[axis]) low[axis] = other;
    }
  }
#endif
}

/* Returns whether the taps (the voxels that a sample sums) of all pixels of a tile lie in the grid, with a
 * margin for rounding. The area of the sheet that a tile covers has straight edges. So all of the tile's
 * points lie between the points at the tile's corners, unless some points lie behind the view's origin. */
LANES_INLINE int tile_is_inside(const fill_source *source, int x, int y) {
  const sheet_rays *rays = &source->rays;
  const float spare = 1.0f / 64;
  lanes u = lanes_load(block_column) * 5.0f + (float)x, v = lanes_load(block_row) * 5.0f + (float)y;
  lanes3 p = rays_positions(rays, u, v);
  lanes axis[3] = {p.x, p.y, p.z};
  lanes_int inside = lanes_set_int(-1);
  if (rays->perspective) inside = rays_climb(rays, u, v) > 0.0f;
  for (int a = 0; a < 3; a++)
    inside &= (axis[a] > 1.0f + spare) & (axis[a] < (float)source->grid->dimension[a] - 2.0f - spare);
  return lanes_bits(inside) == 0xffff;
}

/* Finds the points of a block as find_points() does, for a tile for which tile_is_inside() holds. */
LANES_INLINE block_points find_points_inside(const fill_source *source, int x, int y) {
  block_points points;
  points.position = rays_positions(&source->rays, block_u(x), block_v(y));
  points.cell[0] = lanes_truncate(points.position.x);
  points.cell[1] = lanes_truncate(points.position.y);
  points.cell[2] = lanes_truncate(points.position.z);
  points.inside = lanes_set_int(-1);
  return points;
}

/* ---- which cells the points lie in (grid/relevant.h) ---- */

/* The bit of a cell in one of the two 32-bit words of its brick. */
LANES_INLINE lanes_int bit_of_cell(lanes_int x, lanes_int y, lanes_int z) {
  return lanes_set_int(1) << ((x & 3) | (y & 3) << 2 | (z & 1) << 4);
}

/* Returns whether any of sixteen cells may show something. The cells may lie in any bricks, so one word of
 * bits is loaded for each cell. */
static __attribute__((noinline)) int cells_visible_anywhere(const grid *grid, const lanes_int cell[3]) {
  lanes_int x = cell[0] + 1, y = cell[1] + 1, z = cell[2] + 1;
  lanes_int brick = ((z >> 2) * grid->brick_count[1] + (y >> 2)) * grid->brick_count[0] + (x >> 2);
  lanes_int words = lanes_gather_bytes((const unsigned char *)grid->cell_bits, brick * 8 + (z & 2) * 2);
  return lanes_bits((words & bit_of_cell(x, y, z)) != 0) != 0;
}

#if defined(__AVX2__) && !defined(__AVX512F__)
/* Returns whether any of sixteen cells may show something. All sixteen cells lie in the 2x2x2 bricks from
 * `first_brick` on. within: the cells' coordinates counted from the first cell of these bricks, a byte for
 * each coordinate. The bits of two neighbouring bricks along x are sixteen bytes; each byte holds the bits of
 * four cells along x and two cells along y. A byte shuffle looks up, for each cell, the byte that holds the
 * cell's bit. */
LANES_INLINE int cells_visible_in_bricks(const grid *grid, size_t first_brick, const __m128i within[3]) {
  size_t row = (size_t)grid->brick_count[0], layer = row * (size_t)grid->brick_count[1];
  const uint64_t *bits = grid->cell_bits + first_brick;
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
          behind = _mm_slli_epi16(z, 5); /* a byte's highest bit is set if its cell lies in the second brick
                                          * along y, or along z */
  __m128i word = _mm_blendv_epi8(_mm_blendv_epi8(found[0], found[1], below),
                                 _mm_blendv_epi8(found[2], found[3], below), behind);
  const __m128i bit_of = _mm_setr_epi8(1, 2, 4, 8, 16, 32, 64, (char)128, 0, 0, 0, 0, 0, 0, 0, 0);
  return !_mm_testz_si128(word, _mm_shuffle_epi8(bit_of, bit));
}

/* Returns whether all cells of a block lie in the 2x2x2 bricks whose first cell is `first`. Sets `within` to
 * the cells' coordinates counted from `first`, a byte for each coordinate. */
LANES_INLINE int cells_in_bricks(const lanes_int cell[3], const int32_t first[3], __m128i within[3]) {
  for (int axis = 0; axis < 3; axis++) within[axis] = narrow_bytes(cell[axis] - first[axis]);
  __m128i all = _mm_or_si128(_mm_or_si128(within[0], within[1]), within[2]);
  return _mm_testz_si128(all, _mm_set1_epi8(~7));
}
typedef __m128i cell_offsets;
#else
/* The bits of the cells of 2x2x2 bricks as 32-bit words. The bits of brick (x, y, z) are in words 2 x + 4 y +
 * 8 z and 2 x + 4 y + 8 z + 1. */
LANES_INLINE lanes_int bits_of_bricks(const grid *grid, size_t first_brick) {
  size_t row = (size_t)grid->brick_count[0], layer = row * (size_t)grid->brick_count[1];
  const uint64_t *bits = grid->cell_bits + first_brick;
  lanes_int words;
  memcpy((char *)&words, bits, 16);
  memcpy((char *)&words + 16, bits + row, 16);
  memcpy((char *)&words + 32, bits + layer, 16);
  memcpy((char *)&words + 48, bits + layer + row, 16);
  return words;
}

LANES_INLINE int cells_visible_in_bricks(const grid *grid, size_t first_brick, const lanes_int within[3]) {
  lanes_int x = within[0], y = within[1], z = within[2];
  lanes_int word = (z >> 1 & 1) | (x & 4) >> 1 | (y & 4) | (z & 4) << 1;
  return lanes_bits((lanes_look_up(bits_of_bricks(grid, first_brick), word) & bit_of_cell(x, y, z)) != 0) !=
         0;
}

LANES_INLINE int cells_in_bricks(const lanes_int cell[3], const int32_t first[3], lanes_int within[3]) {
  for (int axis = 0; axis < 3; axis++) within[axis] = cell[axis] - first[axis];
  return lanes_bits(((within[0] | within[1] | within[2]) & ~7) != 0) == 0;
}
typedef lanes_int cell_offsets;
#endif

/* Returns whether any of a block's points lies in a cell that may show something. cell: the floors of the
 * points' coordinates, clamped as in find_points(). low: the least of these floors along each axis. Usually
 * all cells lie in 2x2x2 bricks; the first of these bricks holds the cell with the least coordinates. */
LANES_INLINE int cells_visible(const grid *grid, const lanes_int cell[3], const int32_t low[3]) {
  int32_t first_cell[3];
  cell_offsets within[3];
  size_t first_brick = 0;
  for (int axis = 2; axis >= 0; axis--) {
    int32_t first = (low[axis] + 1) >> 2, last = grid->brick_count[axis] - 2;
    if (first > last) first = last;
    if (first < 0) return cells_visible_anywhere(grid, cell);
    first_cell[axis] = first * HL_BRICK_CELLS - 1;
    first_brick = first_brick * (size_t)grid->brick_count[axis] + (size_t)first;
  }
  if (!cells_in_bricks(cell, first_cell, within)) return cells_visible_anywhere(grid, cell);
  return cells_visible_in_bricks(grid, first_brick, within);
}

/* ---- samples of several blocks in one vector ---- */

/* Removes the lanes of one block from the active lanes: the lanes of the last block that still has active
 * lanes. starts: the first lane of each block, one bit each. */
LANES_INLINE uint32_t drop_last_block(uint32_t active, uint32_t starts) {
  /* the bits up to and including the last active lane */
  uint32_t below = (2u << (31 - __builtin_clz(active))) - 1;
  return active & ((1u << (31 - __builtin_clz(starts & below))) - 1);
}

/* Copies the gradients in `some` to `slope`, in the lanes whose bits are set in `bits`. */
LANES_INLINE void join_slopes(uint32_t bits, lanes3 some, lanes3 *slope) {
  lanes_int mask = lanes_from_bits(bits);
  *slope = (lanes3){lanes_select(mask, some.x, slope->x), lanes_select(mask, some.y, slope->y),
                    lanes_select(mask, some.z, slope->z)};
}

#endif
