/* shadow_sublights/sublight_lanes.h - multiplies one tile of one sub-light's buffer by the scaled and shifted
 * slab, a row of sixteen pixels at a time.
 *
 * Each pixel of the sub-light is multiplied by the slab's transmittance at the nearest half pixel. Half
 * pixels are the middles of pixels and the places half-way between two middles. Values at half pixels come
 * from cubic convolution with a = -1 (Keys, "Cubic convolution interpolation for digital image processing",
 * 1981), with weights -1/8, 5/8, 5/8, -1/8. These weights sharpen the slab by about as much as the bilinear
 * look-up of the buffer blurs it. The weights have the variance -1/4 half-way between middles, and no
 * variance at the middles. The look-up has the variance 1/6 on average. */
#ifndef HL_SHADOW_SUBLIGHTS_SUBLIGHT_LANES_H
#define HL_SHADOW_SUBLIGHTS_SUBLIGHT_LANES_H

#include "core/sheet_constants.h"
#include "shadow/attenuate_lanes.h"
#include "shadow_sublights/sublight_field.h"
#include "simd/gathers.h"

enum { EVERY_ROW = (1 << TILE) - 1 };

/* Interpolates the value half-way between b and c from four successive values a, b, c and d. The result is
 * clamped to [0, 1]. */
LANES_INLINE lanes middle_of_four(lanes a, lanes b, lanes c, lanes d) {
  return lanes_clamp(lanes_add_scaled((a + d) * -0.125f, b + c, 0.625f), 0, 1);
}

LANES_INLINE lanes middle_along(const float *at, ptrdiff_t step) {
  return middle_of_four(lanes_load(at - step), lanes_load(at), lanes_load(at + step),
                        lanes_load(at + 2 * step));
}

LANES_INLINE slab_rows any_below_one(lanes x) { return lanes_bits(x < 1.0f) != 0; }

/* Finds which rows of a tile, and of the first row below the tile, have a pixel below 1. The first pixel to
 * the right of the tile counts, too. Pixels farther away need no test: they have negative weights in values
 * between pixels of the tile, and so cannot bring such a value below 1. */
LANES_INLINE uint32_t rows_below_one(const float *corner, ptrdiff_t stride) {
  uint32_t rows = 0;
  for (int row = 0; row <= TILE; row++) {
    const float *at = corner + row * stride;
    rows |= (uint32_t)any_below_one(lanes_min(lanes_load(at), lanes_load(at + 1))) << row;
  }
  return rows;
}

static slab_rows half_pixel_tile(const half_pixel_job *job, int tile_x, int tile_y) {
  ptrdiff_t stride = (ptrdiff_t)job->slab_stride, corner = tile_y * TILE * stride + tile_x * TILE;
  uint32_t below = rows_below_one(job->slab + corner, stride);
  slab_rows rows = 0;
  for (uint32_t left = (below | below >> 1) & EVERY_ROW; left != 0; left &= left - 1) {
    int row = __builtin_ctz(left);
    ptrdiff_t at = corner + row * stride;
    const float *from = job->slab + at;
    lanes across = middle_along(from, 1), down = middle_along(from, stride);
    lanes both = middle_of_four(middle_along(from - stride, 1), across, middle_along(from + stride, 1),
                                middle_along(from + 2 * stride, 1));
    lanes_store(job->moved[1] + at, across);
    lanes_store(job->moved[2] + at, down);
    lanes_store(job->moved[3] + at, both);
    rows |= (any_below_one(lanes_load(from)) | any_below_one(across) << TILE |
             any_below_one(down) << 2 * TILE | any_below_one(both) << 3 * TILE)
            << row;
  }
  return rows;
}

static const float LANE_INDICES[LANES] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};

/* Rounds sixteen coordinates scale * i + start, with i from 0 to 15, to half pixels. The coordinates are
 * first clamped to [-2, size + 1]. The results count half pixels. */
LANES_INLINE lanes_int nearest_halves(float scale, float start, float size) {
  return lanes_floor(lanes_clamp(lanes_load(LANE_INDICES) * scale + start, -2.0f, size + 1.0f) * 2.0f + 0.5f);
}

/* The taps by which sixteen pixels in a row of a sub-light read a row of the slab's copies. If the slab's
 * pixels had the same size as the sub-light's pixels, pixel i would read the half pixel that is 2 i after the
 * half pixel of pixel 0. The slab's pixels are a little larger or smaller. So the half pixel that pixel i
 * reads differs from 2 i by `first` to first + count
 * - 1. weight[k] is 1 for pixels with the difference first + k, else 0. */
typedef struct row_taps {
  /* count: the number of different differences, counted from `first`; 0 if the number is too great for the
   * weights */
  int first, count;
  lanes_int half; /* for each pixel, the half pixel that it reads, limited to the slab and its margin */
  lanes weight[SUBLIGHT_TAPS];
} row_taps;

LANES_INLINE row_taps taps_of_row(const sublight_job *job, int tile_x) {
  row_taps taps;
  const float width = (float)(job->slab_tiles_x * TILE);
  float scale = job->place.scale[0],
        start = scale * ((float)(tile_x * TILE) + 0.5f) + job->place.shift[0] - 0.5f;
  taps.half = nearest_halves(scale, start, width);
  lanes_int apart = lanes_floor((lanes_load(LANE_INDICES) * (scale - 1.0f) + start) * 2.0f + 0.5f);
  int ends[2] = {apart[0], apart[LANES - 1]};
  taps.first = ends[0] < ends[1] ? ends[0] : ends[1];
  taps.count = (ends[0] < ends[1] ? ends[1] : ends[0]) - taps.first + 1;
  if (taps.count > SUBLIGHT_TAPS || taps.first < -56 || (float)taps.first > 2.0f * width + 16.0f)
    taps.count = 0;
  for (int i = 0; i < taps.count; i++) taps.weight[i] = lanes_keep(apart == taps.first + i, lanes_set(1.0f));
  return taps;
}

/* Reads sixteen pixels along a row of the slab. copies: the row in two copies; the second copy is shifted by
 * half a pixel along the row. */
LANES_INLINE lanes slab_row(const row_taps *taps, const float *const copies[2]) {
  if (taps->count == 0) {
    lanes_int column = taps->half >> 1;
    return lanes_select((taps->half & 1) == 0, lanes_gather(copies[0], column),
                        lanes_gather(copies[1], column));
  }
  if (taps->count == 1) return lanes_load(copies[taps->first & 1] + (taps->first >> 1));
  lanes sum = lanes_set(0);
  for (int i = 0; i < taps->count; i++) {
    int half = taps->first + i;
    sum = lanes_fma(lanes_load(copies[half & 1] + (half >> 1)), taps->weight[i], sum);
  }
  return sum;
}

/* Finds the tiles of the slab that lie under a row of a sub-light's pixels. */
LANES_INLINE void tiles_of_row(const sublight_job *job, const row_taps *taps, int *first, int *last) {
  *first = taps->half[0] >> 5;
  *last = taps->half[LANES - 1] >> 5;
  if (*first < 0) *first = 0;
  if (*last >= job->slab_tiles_x) *last = job->slab_tiles_x - 1;
}

/* Finds the rows that have a pixel below 1 in either of two copies of the slab. between: 1 for the two copies
 * that are shifted along v, 0 for the other two copies. */
LANES_INLINE uint32_t rows_of_either(slab_rows rows, int between) {
  rows >>= 2 * TILE * between;
  return (uint32_t)(rows | rows >> TILE) & EVERY_ROW;
}

/* The rows of a sub-light's tile, one bit each, that read some pixel of the slab below 1. half: the position
 * of each row in the slab, in half pixels. first, last: the first and the last column of the slab's tiles
 * that the rows read. */
LANES_INLINE uint32_t present_rows(const sublight_job *job, const int32_t half[TILE], int first, int last) {
  int y0 = half[0] < 0 ? 0 : half[0] / (2 * TILE), y1 = half[TILE - 1] < 0 ? -1 : half[TILE - 1] / (2 * TILE);
  uint32_t present = 0;
  slab_rows of_tiles[4] = {0, 0, 0, 0};
  if (y1 >= job->slab_tiles_y) y1 = job->slab_tiles_y - 1;
  if (y1 > y0 + 3) return EVERY_ROW;
  for (int y = y0; y <= y1; y++)
    for (int x = first; x <= last; x++) of_tiles[y - y0] |= job->rows[(ptrdiff_t)y * job->slab_tiles_x + x];
  if ((of_tiles[0] | of_tiles[1] | of_tiles[2] | of_tiles[3]) == 0) return 0;
  for (int row = 0; row < TILE; row++) {
    int line = half[row] >> 1, y = line / TILE - y0;
    if (line >= 0 && y <= y1 - y0)
      present |= (rows_of_either(of_tiles[y], half[row] & 1) >> line % TILE & 1) << row;
  }
  return present;
}

static const float DARK_SUBLIGHT = DARK * SUBLIGHT_ONE;

/* The blocks, in a row of four blocks, that contain any of the given columns of pixels; one bit each. */
LANES_INLINE uint32_t blocks_of_columns(uint32_t columns) {
  uint32_t any = columns | columns >> 1;
  any |= any >> 2;
  return (any & 1) | (any >> 3 & 2) | (any >> 6 & 4) | (any >> 9 & 8);
}

/* Finds the columns of pixels that have light in a row of four blocks; one bit each. at: the offset of the
 * row's first pixel. */
LANES_INLINE uint32_t lit_columns(const sublight_job *job, size_t at) {
  uint32_t columns = 0;
  for (int row = 0; row < BLOCK; row++)
    for (int c = 0; c < job->channels; c++)
      columns |= lanes_bits(
          lanes_load_short((job->outside[c] != NULL ? job->outside : job->transmittance)[c] + at +
                           (size_t)row * job->stride) >= DARK_SUBLIGHT);
  return columns;
}

/* Fills a block of a sub-light's plane with zeros. at: the offset of the block's first pixel. */
LANES_INLINE void darken_block(const sublight_job *job, sublight_pixel *plane, size_t at) {
  for (int i = 0; i < BLOCK_PIXELS; i++)
    plane[at + (size_t)(i / BLOCK) * job->stride + (size_t)(i % BLOCK)] = 0;
}

/* Blocks that have become dark lose the rest of their light, because afterwards a part of a shared picture
 * may skip the slab's blocks over dark blocks, and the light that the dark blocks kept would differ between
 * the parts. */
static uint32_t sublight_lit(const sublight_job *job, int tile_x, int tile_y, uint32_t lit) {
  size_t corner = (size_t)(tile_y * TILE) * job->stride + (size_t)tile_x * TILE;
  uint32_t left = 0;
  for (int row = 0; row < TILE / BLOCK; row++)
    if ((lit >> 4 * row & 15) != 0)
      left |= blocks_of_columns(lit_columns(job, corner + (size_t)(row * BLOCK) * job->stride)) << 4 * row;
  for (uint32_t dark = lit & ~left; dark != 0; dark &= dark - 1) {
    const int block = __builtin_ctz(dark);
    const size_t at = corner + (size_t)(block / 4 * BLOCK) * job->stride + (size_t)(block % 4 * BLOCK);
    for (int c = 0; c < job->channels; c++) {
      darken_block(job, job->transmittance[c], at);
      if (job->outside[c] != NULL) darken_block(job, job->outside[c], at);
    }
  }
  return lit & left;
}

/* Multiplies sixteen pixels of a sub-light by the slab's pixels. offset: distance from the sub-light's first
 * pixel to the sixteen pixels. */
LANES_INLINE lanes composite_sublight(const sublight_job *job, int channel, ptrdiff_t offset,
                                      lanes slab_transmittance) {
  sublight_pixel *at = job->transmittance[channel] + offset;
  lanes light = lanes_load_short(at);
  lanes_store_short_int(at, lanes_truncate(light * slab_transmittance + job->carry));
  return light;
}

/* Composites the slab into the light at the outside of surfaces. light: the sub-light's transmittance before
 * the slab. Derived: with T, Y, t and k = k' of attenuate.h, Y becomes T t + k (Y - T t). If full light comes
 * to the slab, Y becomes t + k (1 - t). This number is stored as slab_outside, from which k follows. */
LANES_INLINE void composite_outside(const sublight_job *job, int channel, ptrdiff_t offset, lanes light,
                                    lanes slab_transmittance, lanes slab_outside) {
  sublight_pixel *at = job->outside[channel] + offset;
  lanes taken = 1.0f - slab_transmittance, left = light * slab_transmittance;
  lanes kept = lanes_clamp((slab_outside - slab_transmittance) / lanes_max(taken, lanes_set(LEAST_ABSORBED)),
                           0, 1);
  kept = lanes_select(taken > LEAST_ABSORBED, kept, lanes_set(1.0f));
  lanes outside = lanes_fma(lanes_max(lanes_load_short(at) - left, lanes_set(0)), kept, left);
  lanes_store_short_int(at, lanes_truncate(outside + job->carry));
}

static int sublight_tile(const sublight_job *job, int tile_x, int tile_y) {
  int touched = 0;
  row_taps taps = taps_of_row(job, tile_x);
  size_t corner = (size_t)(tile_y * TILE) * job->stride + (size_t)tile_x * TILE;
  int first, last;
  int32_t halves[TILE];
  lanes_int half_of_rows = nearest_halves(
      job->place.scale[1], job->place.scale[1] * ((float)(tile_y * TILE) + 0.5f) + job->place.shift[1] - 0.5f,
      (float)(job->slab_tiles_y * TILE));
  memcpy(halves, &half_of_rows, sizeof halves);
  tiles_of_row(job, &taps, &first, &last);
  for (uint32_t left = present_rows(job, halves, first, last); left != 0; left &= left - 1) {
    int row = __builtin_ctz(left);
    ptrdiff_t line = (halves[row] >> 1) * (ptrdiff_t)job->slab_stride;
    for (int c = 0; c < job->channels; c++) {
      const int copy = 2 * (halves[row] & 1);
      const float *const rows[2] = {job->slab[c][copy] + line, job->slab[c][copy + 1] + line};
      ptrdiff_t at = (ptrdiff_t)(corner + (size_t)row * job->stride);
      lanes slab_transmittance = slab_row(&taps, rows);
      if (lanes_bits(slab_transmittance < 1.0f) == 0)
        continue; /* all factors are 1, so the sub-light's pixels do not change */
      lanes light = composite_sublight(job, c, at, slab_transmittance);
      touched = 1;
      if (job->outside[c] == NULL) continue;
      const float *const outside[2] = {job->slab_outside[c][copy] + line,
                                       job->slab_outside[c][copy + 1] + line};
      composite_outside(job, c, at, light, slab_transmittance, slab_row(&taps, outside));
    }
  }
  return touched;
}

/* ---- a slab that is only shifted ----
 *
 * Multiplies a row of tiles of one sub-light's buffer by a slab that is only shifted, not scaled: for a
 * parallel light, or a sub-light as high above the sheets as the light's centre. The function goes through
 * the slab's tiles. In each tile, the rows with pixels below 1 are known. Each row with pixels below 1
 * multiplies the sixteen pixels of the sub-light that lie under the row. */

/* The number of tiles of the slab by which memory is prefetched ahead of the current tile. */
enum { SHIFTED_TILES = 16 };

/* The index of the copy of the slab from which a job reads if the slab is only shifted. */
LANES_INLINE int copy_of_shift(const sublight_job *job) {
  return (job->place.half[0] & 1) + 2 * (job->place.half[1] & 1);
}

/* Finds which of sixteen rows of the slab have a pixel below 1 in the columns of the tile with the number
 * tile_x; one bit each. top: the first of the rows. copy: the copy of the slab that is read. */
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

/* The offset, from the sub-light's first pixel, of the sub-light's pixel that lies under a corner of the
 * slab's tile: in the first row of the sub-light's row of tiles tile_y, under the first column of the tile
 * tile_x. */
LANES_INLINE ptrdiff_t pixels_under(const sublight_job *job, int tile_x, int tile_y) {
  return (ptrdiff_t)(tile_y * TILE) * (ptrdiff_t)job->stride + tile_x * TILE - (job->place.half[0] >> 1);
}

/* Finds the sub-light's rows that a tile of the slab darkens. Marks the sub-light's tiles as touched, and
 * prefetches the pixels of all these rows. */
LANES_INLINE uint32_t begin_shifted(const sublight_job *job, int tile_x, int tile_y, const uint16_t *lit,
                                    unsigned char *touched) {
  int top = tile_y * TILE + (job->place.half[1] >> 1), column = tile_x * TILE - (job->place.half[0] >> 1);
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
      const sublight_pixel *at = job->transmittance[c] + pixels_under(job, tile_x, tile_y) +
                                 __builtin_ctz(left) * (ptrdiff_t)job->stride;
      __builtin_prefetch(at, 1);
      __builtin_prefetch(at + TILE - 1, 1);
    }
  return rows;
}

LANES_INLINE void composite_shifted(const sublight_job *job, int tile_x, int tile_y, uint32_t rows) {
  int top = tile_y * TILE + (job->place.half[1] >> 1);
  for (int c = 0; c < job->channels; c++) {
    const int copy = copy_of_shift(job);
    const ptrdiff_t from = (ptrdiff_t)top * (ptrdiff_t)job->slab_stride + tile_x * TILE,
                    to = pixels_under(job, tile_x, tile_y);
    for (uint32_t left = rows; left != 0; left &= left - 1) {
      const ptrdiff_t row = __builtin_ctz(left), at = from + row * (ptrdiff_t)job->slab_stride,
                      pixel = to + row * (ptrdiff_t)job->stride;
      lanes slab_transmittance = lanes_load(job->slab[c][copy] + at);
      lanes light = composite_sublight(job, c, pixel, slab_transmittance);
      if (job->outside[c] != NULL)
        composite_outside(job, c, pixel, light, slab_transmittance,
                          lanes_load(job->slab_outside[c][copy] + at));
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
