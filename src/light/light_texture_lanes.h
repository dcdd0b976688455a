/* light/light_texture_lanes.h - looks up a light texture at sixteen samples. */
#ifndef HL_LIGHT_LIGHT_TEXTURE_LANES_H
#define HL_LIGHT_LIGHT_TEXTURE_LANES_H

#include "light/light_texture.h"
#include "simd/gathers.h"
#include "view/rays_lanes.h"

/* The fraction by which the screen covers a position along one axis. The fraction rises from 0 to 1 across
 * each edge of the screen, over a width of 1 / sharpness. */
LANES_INLINE lanes within_edges(lanes u, float size, lanes sharpness) {
  lanes half = lanes_set(0.5f);
  return lanes_clamp(lanes_fma(u, sharpness, half), 0, 1) *
         lanes_clamp(lanes_fma(size - u, sharpness, half), 0, 1);
}

/* A bilinear look-up along one axis: the two pixels, clamped to the image, and the fraction of the way
 * between them. */
typedef struct texture_taps {
  lanes_int first, second;
  lanes fraction;
} texture_taps;

LANES_INLINE texture_taps taps_at(lanes u, int size) {
  lanes at = lanes_clamp(u - 0.5f, 0, (float)(size - 1));
  texture_taps taps = {.first = lanes_truncate(at)};
  taps.fraction = at - lanes_from_int(taps.first);
  lanes_int next = taps.first + 1, last = lanes_set_int(size - 1);
  taps.second = lanes_select_int(next > last, last, next);
  return taps;
}

/* Reads an image of width x height pixels bilinearly. Coordinates beyond its borders are clamped. */
LANES_INLINE void read_image(const float *pixels, int width, int height, lanes u, lanes v, lanes color[3]) {
  texture_taps x = taps_at(u, width), y = taps_at(v, height);
  lanes_int top = y.first * (int32_t)width, bottom = y.second * (int32_t)width;
  lanes_int at[4] = {(top + x.first) * 3, (top + x.second) * 3, (bottom + x.first) * 3,
                     (bottom + x.second) * 3};
  for (int c = 0; c < 3; c++) {
    lanes a = lanes_gather(pixels + c, at[0]), b = lanes_gather(pixels + c, at[1]);
    lanes d = lanes_gather(pixels + c, at[2]), e = lanes_gather(pixels + c, at[3]);
    lanes upper = lanes_fma(b - a, x.fraction, a), lower = lanes_fma(e - d, x.fraction, d);
    color[c] = lanes_fma(lower - upper, y.fraction, upper);
  }
}

/* Adds the light texture's image, without blur, times a weight. The screen's edges are softened by a box. */
LANES_INLINE void sharp_pattern(const light_texture *texture, lanes blur, lanes u, lanes v, lanes weight,
                                lanes pattern[3]) {
  lanes sharp_u = lanes_set(texture->sharpness[0]), sharp_v = lanes_set(texture->sharpness[1]);
  lanes edge_u = sharp_u / lanes_max(blur * texture->edge[0] * sharp_u, lanes_set(1.0f));
  lanes edge_v = sharp_v / lanes_max(blur * texture->edge[1] * sharp_v, lanes_set(1.0f));
  lanes inside = within_edges(u, (float)texture->width, edge_u) *
                 within_edges(v, (float)texture->height, edge_v) * weight;
  if (lanes_bits(inside > 0.0f) == 0) return;
  lanes color[3];
  read_image(texture->pixels, texture->width, texture->height, u, v, color);
  for (int c = 0; c < 3; c++) pattern[c] = lanes_fma(color[c], inside, pattern[c]);
}

/* Interpolates between the two levels of a light texture whose variances enclose the variance of the sample's
 * blur; the variance of the result is linear in the weights. If the sample's variance is below the variance
 * of level 0, the result is a mean of level 0 and the image itself. The weight of level 0 is then the square
 * of the ratio of the two variances, so that the image stays sharp as long as possible. The edges of the
 * screen are blurred in the image itself, too. */
LANES_INLINE void soft_pattern(const light_texture *texture, lanes blur, lanes u, lanes v, lanes ahead,
                               lanes pattern[3]) {
  lanes variance = lanes_min(blur * blur * texture->first, lanes_set(1e30f));
  lanes_int above = variance >= 1.0f, last = lanes_set_int(texture->level_count - 1);
  lanes_int bits = (lanes_int)lanes_max(variance, lanes_set(1.0f)), level = (bits >> 23) - 127;
  lanes fraction = (lanes)((bits & 0x007fffff) | 0x3f800000) - 1.0f;
  fraction = lanes_keep(level < last, fraction);
  level = lanes_select_int(level < last, level, last);
  lanes first = variance * variance;
  sharp_pattern(texture, blur, u, v, lanes_keep(~above, 1.0f - first) * ahead, pattern);
  for (int l = 0; l < texture->level_count; l++) {
    lanes weight = lanes_keep(level == l, 1.0f - fraction) + lanes_keep(level == l - 1, fraction);
    weight = lanes_select(above, weight, l == 0 ? first : lanes_set(0)) * ahead;
    if (lanes_bits(weight > 0.0f) == 0) continue;
    const texture_level *at = &texture->level[l];
    lanes color[3];
    read_image(at->pixels, at->width, at->height, lanes_line(u, at->scale[0], at->shift[0]),
               lanes_line(v, at->scale[1], at->shift[1]), color);
    for (int c = 0; c < 3; c++) pattern[c] = lanes_fma(color[c], weight, pattern[c]);
  }
}

/* Finds the texture's colour, light_color(x) of eq. (2) of the paper, at samples in frame space. */
LANES_INLINE void texture_pattern(const light_texture *texture, lanes3 position, lanes pattern[3]) {
  lanes projected[3];
  for (int row = 0; row < 3; row++) projected[row] = row_of_point(texture->map[row], position);
  lanes_int in_front = projected[0] > 0.0f;
  lanes safe = lanes_select(in_front, projected[0], lanes_set(1.0f)), u = projected[1] / safe,
        v = projected[2] / safe;
  lanes ahead = lanes_keep(in_front, lanes_set(1.0f));
  pattern[0] = pattern[1] = pattern[2] = lanes_set(0);
  if (texture->level_count == 0) {
    sharp_pattern(texture, lanes_set(0), u, v, ahead, pattern);
    return;
  }
  lanes beyond = row_of_point(texture->beyond, position);
  lanes blur = texture->parallel ? lanes_abs(beyond)
                                 : lanes_abs(1.0f - 1.0f / lanes_max(safe, lanes_set(0.05f)));
  soft_pattern(texture, blur, u, v, ahead, pattern);
}

#endif
