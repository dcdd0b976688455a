/* shadow_sublights/sublight_shift_lanes.h - multiplies a row of tiles of one sub-light's buffer by a slab
 * that is only shifted, not scaled: for a parallel light, or a sub-light as high above the sheets as the
 * light's centre.
 *
 * It goes through the slab's tiles, whose rows that are below 1 somewhere are known; each such row multiplies
 * sixteen of the sub-light's pixels, wherever these begin. */
#ifndef HL_SHADOW_SUBLIGHTS_SUBLIGHT_SHIFT_LANES_H
#define HL_SHADOW_SUBLIGHTS_SUBLIGHT_SHIFT_LANES_H

#include "shadow_sublights/sublight_lanes.h"

/* Tiles of the slab whose pixels are fetched before the first is used. */
enum { SHIFTED_TILES = 16 };

/* The index of the copy of the slab that is read. */
LANES_INLINE int copy_of_shift(const sublight_job *job) {
  return (job->half[0] & 1) + 2 * (job->half[1] & 1);
}

/* Of the slab's sixteen rows from `top` on, in the columns of a tile: those below 1 somewhere, one bit each.
 */
LANES_INLINE uint32_t rows_from(const sublight_job *job, int tile_x, int top, int copy) {
  const slab_rows *tile = job->rows + tile_x;
  int y = top >> 4, down = top & (TILE - 1);
  slab_rows above = y >= 0 && y < job->slab_tiles_y ? tile[(ptrdiff_t)y * job->slab_tiles_x] : 0;
  slab_rows below = y >= -1 && y < job->slab_tiles_y - 1 ? tile[(ptrdiff_t)(y + 1) * job->slab_tiles_x] : 0;
  above = above >> TILE * copy & EVERY_ROW;
  below = below >> TILE * copy & EVERY_ROW;
  return (uint32_t)(above >> down | below << (TILE - down)) & EVERY_ROW;
}

LANES_INLINE int is_dark_tile(const sublight_job *job, const uint16_t *lit, int tile_x) {
  return tile_x < 0 || tile_x >= job->tiles_x || lit[tile_x] == 0;
}

/* The sub-light's pixels under a tile's first column. */
LANES_INLINE sublight_pixel *pixels_under(const sublight_job *job, int channel, int tile_x, int tile_y) {
  return job->transmittance[channel] + (ptrdiff_t)(tile_y * TILE) * (ptrdiff_t)job->stride + tile_x * TILE -
         (job->half[0] >> 1);
}

/* Finds the sub-light's rows that a tile of the slab darkens, marks the sub-light's tiles as touched and
 * prefetches their pixels, many at a time. */
LANES_INLINE uint32_t begin_shifted(const sublight_job *job, int tile_x, int tile_y, const uint16_t *lit,
                                    unsigned char *touched) {
  int top = tile_y * TILE + (job->half[1] >> 1), column = tile_x * TILE - (job->half[0] >> 1);
  uint32_t rows = rows_from(job, tile_x, top, copy_of_shift(job));
  const int ends[2] = {column >> 4, (column + TILE - 1) >> 4};
  if (rows == 0) return 0;
  int reached = 0;
  for (int i = 0; i < 2; i++) {
    if (is_dark_tile(job, lit, ends[i])) continue;
    touched[ends[i]] = 1;
    reached = 1;
  }
  if (!reached) return 0;
  for (int c = 0; c < job->channels; c++)
    for (uint32_t left = rows; left != 0; left &= left - 1) {
      const sublight_pixel *at = pixels_under(job, c, tile_x, tile_y) +
                                 __builtin_ctz(left) * (ptrdiff_t)job->stride;
      __builtin_prefetch(at, 1);
      __builtin_prefetch(at + TILE - 1, 1);
    }
  return rows;
}

LANES_INLINE void composite_shifted(const sublight_job *job, int tile_x, int tile_y, uint32_t rows) {
  int top = tile_y * TILE + (job->half[1] >> 1);
  for (int c = 0; c < job->channels; c++) {
    const float *from = job->slab[c][copy_of_shift(job)] + (ptrdiff_t)top * (ptrdiff_t)job->slab_stride +
                        tile_x * TILE;
    sublight_pixel *to = pixels_under(job, c, tile_x, tile_y);
    for (uint32_t left = rows; left != 0; left &= left - 1) {
      int row = __builtin_ctz(left);
      composite_sublight(job, to + row * (ptrdiff_t)job->stride,
                         lanes_load(from + row * (ptrdiff_t)job->slab_stride));
    }
  }
}

static void sublight_row(const sublight_job *job, int tile_y, int first, int last, const uint16_t *lit,
                         unsigned char *touched) {
  uint32_t rows[SHIFTED_TILES];
  for (int x = first; x <= last; x += SHIFTED_TILES) {
    int count = last - x + 1 < SHIFTED_TILES ? last - x + 1 : SHIFTED_TILES;
    for (int i = 0; i < count; i++) rows[i] = begin_shifted(job, x + i, tile_y, lit, touched);
    for (int i = 0; i < count; i++) composite_shifted(job, x + i, tile_y, rows[i]);
  }
}

#endif
