/* light/sublight_shift_lanes.h - a row of tiles of one part's buffer times a slab that is only shifted: that of a parallel light, or
 * of a part as high over the sheets as the middle.
 *
 * Here the slab's rows of sixteen pixels are gone through, which are known to hold something or not, and each lies over sixteen
 * of the part's pixels wherever those begin. */
#ifndef HL_LIGHT_SUBLIGHT_SHIFT_LANES_H
#define HL_LIGHT_SUBLIGHT_SHIFT_LANES_H

#include "light/sublight_lanes.h"

/* Tiles of the slab whose pixels are fetched before the first is used. */
enum { SHIFTED_TILES = 16 };

/* Of a tile of the slab over a row of a part's tiles. */
typedef struct shifted_tile {
  uint32_t rows;              /* the part's rows that it takes light from */
  uint32_t lit[TILE / BLOCK]; /* of the sixteen columns of pixels under it, those with light left in these rows, by rows of blocks */
} shifted_tile;

/* The image of the slab that is read. */
LANES_INLINE int image_of_shift(const sublight_job *job) { return (job->half[0] & 1) + 2 * (job->half[1] & 1); }

/* The slab's rows of a tile's columns that lie over a row of the part's tiles, one bit each; the first is row `top`. */
LANES_INLINE uint32_t rows_from(const sublight_job *job, int tile_x, int top, int image) {
  const slab_rows *tile = job->rows + tile_x;
  int y = top >> 4, down = top & (TILE - 1);
  slab_rows above = y >= 0 && y < job->slab_tiles_y ? tile[(ptrdiff_t)y * job->slab_tiles_x] : 0;
  slab_rows below = y >= -1 && y < job->slab_tiles_y - 1 ? tile[(ptrdiff_t)(y + 1) * job->slab_tiles_x] : 0;
  above = above >> TILE * image & EVERY_ROW;
  below = below >> TILE * image & EVERY_ROW;
  return (uint32_t)(above >> down | below << (TILE - down)) & EVERY_ROW;
}

LANES_INLINE int is_dark_tile(const sublight_job *job, const uint16_t *lit, int tile_x) {
  return tile_x < 0 || tile_x >= job->tiles_x || lit[tile_x] == 0;
}

/* The part's pixels under a tile's first column. */
LANES_INLINE part_pixel *pixels_under(const sublight_job *job, int channel, int tile_x, int tile_y) {
  return job->left[channel] + (ptrdiff_t)(tile_y * TILE) * (ptrdiff_t)job->stride + tile_x * TILE - (job->half[0] >> 1);
}

/* What there is to do, and its pixels on their way from memory: they come many at a time, not one after another. */
LANES_INLINE shifted_tile begin_shifted(const sublight_job *job, int tile_x, int tile_y, const uint16_t *lit) {
  int top = tile_y * TILE + (job->half[1] >> 1), column = tile_x * TILE - (job->half[0] >> 1);
  shifted_tile tile = {rows_from(job, tile_x, top, image_of_shift(job)), {0}};
  if (is_dark_tile(job, lit, column >> 4) && is_dark_tile(job, lit, (column + TILE - 1) >> 4)) tile.rows = 0;
  for (int c = 0; c < job->channels; c++)
    for (uint32_t left = tile.rows; left != 0; left &= left - 1) {
      const part_pixel *at = pixels_under(job, c, tile_x, tile_y) + __builtin_ctz(left) * (ptrdiff_t)job->stride;
      __builtin_prefetch(at, 1);
      __builtin_prefetch(at + TILE - 1, 1);
    }
  return tile;
}

LANES_INLINE void composite_shifted(const sublight_job *job, int tile_x, int tile_y, shifted_tile *tile) {
  int top = tile_y * TILE + (job->half[1] >> 1);
  for (int c = 0; c < job->channels; c++) {
    const float *from = job->slab[c][image_of_shift(job)] + (ptrdiff_t)top * (ptrdiff_t)job->slab_stride + tile_x * TILE;
    part_pixel *to = pixels_under(job, c, tile_x, tile_y);
    for (uint32_t left = tile->rows; left != 0; left &= left - 1) {
      int row = __builtin_ctz(left);
      lanes passing = composite_part(job, to + row * (ptrdiff_t)job->stride, lanes_load(from + row * (ptrdiff_t)job->slab_stride));
      tile->lit[row / BLOCK] |= lanes_bits(passing >= DARK_PART);
    }
  }
}

/* Tile x of the part is complete: the slab's tile and the one before it lie over it. */
LANES_INLINE void end_shifted(const sublight_job *job, int tile_x, int tile_y, const shifted_tile *before, const shifted_tile *tile,
                              uint16_t *lit) {
  int column = tile_x * TILE - (job->half[0] >> 1), at = column >> 4, from = column & (TILE - 1);
  if ((before->rows | tile->rows) == 0 || is_dark_tile(job, lit, at)) return;
  tile_columns found;
  uint32_t of_tile = EVERY_COLUMN << from & EVERY_COLUMN; /* the columns under it; those under the one before begin the tile */
  for (int row = 0; row < TILE / BLOCK; row++) {
    uint32_t rows = 15u << BLOCK * row;
    found.worked[row] = ((tile->rows & rows) != 0 ? of_tile : 0) | ((before->rows & rows) != 0 ? EVERY_COLUMN & ~of_tile : 0);
    found.lit[row] = (tile->lit[row] << from & EVERY_COLUMN) | before->lit[row] >> (TILE - from);
  }
  lit[at] = (uint16_t)still_lit(job, (size_t)(tile_y * TILE) * job->stride + (size_t)at * TILE, lit[at], &found);
}

static void sublight_row(const sublight_job *job, int tile_y, int first, int last, uint16_t *lit) {
  shifted_tile tiles[SHIFTED_TILES + 1] = {{0, {0}}}; /* the first: the last of those before */
  for (int x = first; x <= last + 1; x += SHIFTED_TILES) {
    for (int i = 0; i < SHIFTED_TILES; i++)
      tiles[i + 1] = x + i <= last ? begin_shifted(job, x + i, tile_y, lit) : (shifted_tile){0, {0}};
    for (int i = 0; i < SHIFTED_TILES; i++) {
      composite_shifted(job, x + i, tile_y, &tiles[i + 1]);
      end_shifted(job, x + i, tile_y, &tiles[i], &tiles[i + 1], lit);
    }
    tiles[0] = tiles[SHIFTED_TILES];
  }
}

#endif
