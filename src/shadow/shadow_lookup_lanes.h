/* shadow/shadow_lookup_lanes.h - looks up a shadow buffer at sixteen samples at once: bilinearly, by cubic
 * convolution or at the nearest pixel. */
#ifndef HL_SHADOW_SHADOW_LOOKUP_LANES_H
#define HL_SHADOW_SHADOW_LOOKUP_LANES_H

#include "core/sheet_constants.h"
#include "shadow/shadow_buffer.h"
#include "simd/gathers.h"

/* The samples' positions in a shadow buffer. Each position is surrounded by two by two pixels, of which
 * `first` is the first. fx and fy are the distances, in pixels, of the position from the middle of the first
 * pixel. */
typedef struct shadow_taps {
  lanes_int inside;
  lanes_squares first;
  lanes fx, fy;
} shadow_taps;

/* Finds which pixels of a shadow buffer surround each sample (shadow_taps). The samples' positions are given
 * in pixels, with fractions. nearest: whether each position is moved to the middle of the nearest pixel. */
LANES_INLINE shadow_taps taps_at_position(const shadow_map *map, int nearest, lanes u, lanes v) {
  shadow_taps taps;
  taps.inside = (u > 0.0f) & (v > 0.0f) & (u < (float)map->width) & (v < (float)map->height);
  lanes x = lanes_clamp(u - 0.5f, 0, (float)(map->width - 1)),
        y = lanes_clamp(v - 0.5f, 0, (float)(map->height - 1));
  if (nearest) {
    x = lanes_from_int(lanes_truncate(x + 0.5f));
    y = lanes_from_int(lanes_truncate(y + 0.5f));
  }
  taps.first = (lanes_squares){lanes_truncate(x), lanes_truncate(y)};
  taps.fx = x - lanes_from_int(taps.first.column);
  taps.fy = y - lanes_from_int(taps.first.row);
  return taps;
}

/* Interpolates bilinearly between four pixels: a and b are neighbours in one row, c and d are the pixels
 * below a and b in the next row. Lanes whose position lies outside the buffer get `beyond`. */
LANES_INLINE lanes between_taps(const shadow_taps *taps, lanes a, lanes b, lanes c, lanes d, float beyond) {
  lanes top = lanes_fma(b - a, taps->fx, a), bottom = lanes_fma(d - c, taps->fx, c);
  return lanes_select(taps->inside, lanes_fma(bottom - top, taps->fy, top), lanes_set(beyond));
}

LANES_INLINE lanes look_up(const shadow_map *map, const shadow_taps *taps, const float *buffer) {
  lanes a, b, c, d;
  lanes_int at = taps->first.row * (int32_t)map->stride + taps->first.column;
  lanes_gather_pairs(buffer, at, &a, &b);
  lanes_gather_pairs(buffer + map->stride, at, &c, &d);
  return between_taps(taps, a, b, c, d, 1);
}

/* The greatest of the four pixels around each position. */
LANES_INLINE lanes greatest_tap(const shadow_map *map, const shadow_taps *taps, const float *buffer) {
  lanes a, b, c, d;
  lanes_int at = taps->first.row * (int32_t)map->stride + taps->first.column;
  lanes_gather_pairs(buffer, at, &a, &b);
  lanes_gather_pairs(buffer + map->stride, at, &c, &d);
  return lanes_select(taps->inside, lanes_max(lanes_max(a, b), lanes_max(c, d)), lanes_set(1.0f));
}

/* The weights of cubic convolution with a = -1/2 (Keys, "Cubic convolution interpolation for digital image
 * processing", 1981, eq. 15) for four pixels in a row. way: the distance of the look-up's position from the
 * second pixel's middle, 0 to 1. The weights have no variance, so the convolution does not blur. */
LANES_INLINE void cubic_weights(lanes way, lanes weight[4]) {
  lanes rest = 1.0f - way, both = way * rest * -0.5f;
  weight[0] = both * rest;
  weight[1] = lanes_fma(way * way, lanes_line(way, 1.5f, -2.5f), lanes_set(1.0f));
  weight[2] = lanes_fma(rest * rest, lanes_line(rest, 1.5f, -2.5f), lanes_set(1.0f));
  weight[3] = both * way;
}

/* Interpolates the transmittance between four by four pixels of a shadow buffer by cubic convolution. The
 * result is clamped to the range of the nearest four pixels. Without the clamp, the result would overshoot
 * beside an edge, and would be too dark just inside a box's face. The function is not inlined, so that the
 * bilinear look-up can use all registers. */
static __attribute__((noinline, unused)) lanes look_up_cubic(const shadow_map *map, const shadow_taps *taps,
                                                             const float *buffer) {
  lanes across[4], down[4], pixel[4], sum = lanes_set(0);
  lanes_int at = taps->first.row * (int32_t)map->stride + taps->first.column;
  cubic_weights(taps->fx, across);
  cubic_weights(taps->fy, down);
  lanes least = lanes_set(1.0f), greatest = lanes_set(0);
  const float *row = buffer - map->stride - 1;
  for (int y = 0; y < 4; y++, row += map->stride) {
    lanes_gather_quads(row, at, pixel);
    lanes along = pixel[0] * across[0];
    for (int x = 1; x < 4; x++) along = lanes_fma(pixel[x], across[x], along);
    sum = lanes_fma(along, down[y], sum);
    if (y == 0 || y == 3) continue;
    least = lanes_min(least, lanes_min(pixel[1], pixel[2]));
    greatest = lanes_max(greatest, lanes_max(pixel[1], pixel[2]));
  }
  return lanes_select(taps->inside, lanes_min(lanes_max(sum, least), greatest), lanes_set(1.0f));
}

LANES_INLINE lanes look_up_sublight(const shadow_map *map, const shadow_taps *taps,
                                    const sublight_pixel *buffer, uint32_t active) {
  lanes_int square[4];
  lanes_gather_short_squares(buffer, map->stride, taps->first, active, square);
  return between_taps(taps, lanes_from_int(square[0]), lanes_from_int(square[1]), lanes_from_int(square[2]),
                      lanes_from_int(square[3]), SUBLIGHT_ONE);
}

#endif
