/* splat/shown_lanes.h - which blocks of a tile may show something on a sheet: the cells that their sixteen points lie in,
 * looked up one by one (cell_bits.h). */
#ifndef HL_SPLAT_SHOWN_LANES_H
#define HL_SPLAT_SHOWN_LANES_H

#include "splat/fill.h"
#include "splat/rays_lanes.h"

typedef struct lanes_box { lanes low[3], high[3]; } lanes_box; /* index space */

/* The 2x2x2 bricks that hold all points of a block, one block a lane. */
typedef struct near_bricks {
  int32_t place[LANES];    /* of the first in cell_bits */
  int32_t first[3][LANES]; /* its first cell, as floors of points */
  uint32_t fit;            /* the blocks that lie in so few, one bit each */
  float greatest[3];       /* of points, as place_block() clamps them */
} near_bricks;

LANES_INLINE float greatest_point(const grid *grid, int axis) { return (float)grid->dimension[axis] * (1 - 1e-6f); }

LANES_INLINE lanes_int brick_at(lanes point, float greatest) {
  return (lanes_floor(lanes_clamp(point, -1.0f, greatest)) + 1) >> 2;
}

LANES_INLINE near_bricks bricks_near(const grid *grid, const lanes_box *box) {
  const float spare = 1.0f / 64; /* for rounding */
  near_bricks near;
  lanes_int fit = lanes_set_int(-1), place = lanes_set_int(0);
  for (int axis = 2; axis >= 0; axis--) {
    int32_t last = grid->brick_count[axis] - 2;
    float greatest = near.greatest[axis] = greatest_point(grid, axis);
    lanes_int first = brick_at(box->low[axis] - spare, greatest), end = brick_at(box->high[axis] + spare, greatest);
    first = lanes_select_int(first > last, lanes_set_int(last), first);
    fit &= (end - first <= 1) & (lanes_set_int(last) >= 0);
    place = place * grid->brick_count[axis] + first;
    first = first * HL_BRICK_CELLS - 1;
    memcpy(near.first[axis], &first, sizeof first);
  }
  memcpy(near.place, &place, sizeof place);
  near.fit = lanes_bits(fit);
  return near;
}

/* Eight bricks' bits, as words of 32: those of brick (x, y, z) from 2 x + 4 y + 8 z on. */
LANES_INLINE lanes_int bits_near(const grid *grid, int32_t place) {
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

/* floor() of a block's points, clamped as place_block() does. */
typedef struct block_cells { lanes_int x, y, z; } block_cells;

LANES_INLINE block_cells cells_of_block(const float greatest[3], const sheet_rays *rays, int x, int y) {
  lanes3 p = rays_positions(rays, block_u(x), block_v(y));
  return (block_cells){lanes_floor(lanes_clamp(p.x, -1.0f, greatest[0])), lanes_floor(lanes_clamp(p.y, -1.0f, greatest[1])),
                       lanes_floor(lanes_clamp(p.z, -1.0f, greatest[2]))};
}

/* Points anywhere: each one's word is loaded. */
static __attribute__((noinline)) int far_block_shows(const grid *grid, const float greatest[3], const sheet_rays *rays, int x,
                                                  int y) {
  block_cells cells = cells_of_block(greatest, rays, x, y);
  lanes_int cx = cells.x + 1, cy = cells.y + 1, cz = cells.z + 1;
  lanes_int brick = ((cz >> 2) * grid->brick_count[1] + (cy >> 2)) * grid->brick_count[0] + (cx >> 2);
  lanes_int words = lanes_gather_bytes((const unsigned char *)grid->cell_bits, brick * 8 + (cz & 2) * 2);
  return lanes_bits((words & bit_of_cell(cx, cy, cz)) != 0) != 0;
}

LANES_INLINE int block_shows(const grid *grid, const sheet_rays *rays, const near_bricks *near, int block, int x, int y) {
  if (!(near->fit >> block & 1)) return far_block_shows(grid, near->greatest, rays, x, y);
  lanes_int words = bits_near(grid, near->place[block]);
  if (lanes_bits(words != 0) == 0) return 0;
  if (lanes_bits(words == -1) == 0xffff) return 1;
  block_cells cells = cells_of_block(near->greatest, rays, x, y);
  lanes_int cx = cells.x - near->first[0][block], cy = cells.y - near->first[1][block], cz = cells.z - near->first[2][block];
  /* a box says little of points near a perspective view's horizon */
  if (lanes_bits(((cx | cy | cz) & ~7) != 0) != 0) return far_block_shows(grid, near->greatest, rays, x, y);
  lanes_int word = (cz >> 1 & 1) | (cx & 4) >> 1 | (cy & 4) | (cz & 4) << 1;
  return lanes_bits((lanes_look_up(words, word) & bit_of_cell(cx, cy, cz)) != 0) != 0;
}

/* Of a tile's blocks, those that may show something on a sheet. box: around each one's points. */
static uint32_t shown_on_sheet(const grid *grid, const sheet_rays *rays, const lanes_box *box, int tile_x, int tile_y,
                               uint32_t blocks) {
  if (blocks == 0) return 0;
  near_bricks near = bricks_near(grid, box);
  uint32_t shown = 0;
  for (uint32_t left = blocks; left != 0; left &= left - 1) {
    int block = __builtin_ctz(left), x = tile_x * TILE + block % 4 * BLOCK, y = tile_y * TILE + block / 4 * BLOCK;
    shown |= (uint32_t)block_shows(grid, rays, &near, block, x, y) << block;
  }
  return shown;
}

/* Leaves of slabs' blocks those that may show something on one of the two sheets. Two sheets between slabs come first: what
 * shows there is not asked of the others. */
static void keep_shown(const slab_run *run, const lanes_box box[RUN_SLABS + 1], int tile_x, int tile_y, uint32_t blocks[RUN_SLABS]) {
  const grid *grid = run->grid;
  uint32_t shown[RUN_SLABS] = {0};
  for (int sheet = 1; sheet < RUN_SLABS; sheet += 2) {
    uint32_t on = shown_on_sheet(grid, &run->rays[sheet], &box[sheet], tile_x, tile_y, blocks[sheet - 1] | blocks[sheet]);
    shown[sheet - 1] = blocks[sheet - 1] & on;
    shown[sheet] = blocks[sheet] & on;
  }
  for (int sheet = 0; sheet <= RUN_SLABS; sheet += 2) {
    uint32_t before = sheet > 0 ? blocks[sheet - 1] & ~shown[sheet - 1] : 0;
    uint32_t after = sheet < RUN_SLABS ? blocks[sheet] & ~shown[sheet] : 0;
    uint32_t on = shown_on_sheet(grid, &run->rays[sheet], &box[sheet], tile_x, tile_y, before | after);
    if (sheet > 0) shown[sheet - 1] |= before & on;
    if (sheet < RUN_SLABS) shown[sheet] |= after & on;
  }
  memcpy(blocks, shown, sizeof shown);
}

#endif
