/* gpu/kernels/texture.h - finds the colour of the image that a light projects onto a sample. The functions
 * compute for one pixel the same numbers as light/light_texture_lanes.h for sixteen pixels. */
#ifndef HL_GPU_TEXTURE_H
#define HL_GPU_TEXTURE_H

#include "gpu/device_sweep.h"
#include "gpu/kernels/numbers.h"

#if TEXTURES

/* as within_edges() */
DEVICE float covered_by_screen(float u, float size, float sharpness) {
  return limited(fused(u, sharpness, 0.5f), 0.0f, 1.0f) *
         limited(fused(size - u, sharpness, 0.5f), 0.0f, 1.0f);
}

/* The members of texture_taps. */
typedef struct image_taps {
  int first, second;
  float fraction;
} image_taps;

DEVICE image_taps image_taps_at(float u, int size) {
  const float at = limited(u - 0.5f, 0.0f, (float)(size - 1));
  image_taps taps;
  taps.first = (int)at;
  taps.fraction = at - (float)taps.first;
  taps.second = taps.first + 1 > size - 1 ? size - 1 : taps.first + 1;
  return taps;
}

/* Reads an image bilinearly, as read_image(), and adds its colour times a weight to `pattern`. floats: the
 * pixels of all images. */
DEVICE void add_image(GLOBAL const float *floats, GLOBAL const plan_texture_level *image, float u, float v,
                      float weight, float pattern[3]) {
  const image_taps x = image_taps_at(u, image->width), y = image_taps_at(v, image->height);
  GLOBAL const float *top = floats + image->begin + (wide)y.first * (wide)image->width * 3;
  GLOBAL const float *bottom = floats + image->begin + (wide)y.second * (wide)image->width * 3;
  for (int c = 0; c < 3; c++) {
    const float a = top[x.first * 3 + c], b = top[x.second * 3 + c];
    const float d = bottom[x.first * 3 + c], e = bottom[x.second * 3 + c];
    const float upper = fused(b - a, x.fraction, a), lower = fused(e - d, x.fraction, d);
    pattern[c] = fused(fused(lower - upper, y.fraction, upper), weight, pattern[c]);
  }
}

/* as sharp_pattern() */
DEVICE void add_sharp_image(GLOBAL const float *floats, GLOBAL const plan_texture *texture, float blur,
                            float u, float v, float weight, float pattern[3]) {
  const float sharp_u = texture->sharpness[0], sharp_v = texture->sharpness[1];
  const float edge_u = divided(sharp_u, greater(blur * texture->edge[0] * sharp_u, 1.0f));
  const float edge_v = divided(sharp_v, greater(blur * texture->edge[1] * sharp_v, 1.0f));
  const float inside = covered_by_screen(u, (float)texture->image.width, edge_u) *
                       covered_by_screen(v, (float)texture->image.height, edge_v) * weight;
  if (inside > 0.0f) add_image(floats, &texture->image, u, v, inside, pattern);
}

/* Adds a blurred level of the image times a weight. */
DEVICE void add_level(GLOBAL const float *floats, GLOBAL const plan_texture_level *level, float u, float v,
                      float weight, float pattern[3]) {
  if (weight > 0.0f)
    add_image(floats, level, fused(u, level->scale[0], level->shift[0]),
              fused(v, level->scale[1], level->shift[1]), weight, pattern);
}

/* as soft_pattern() */
DEVICE void add_soft_image(GLOBAL const float *floats, GLOBAL const plan_texture *texture, float blur,
                           float u, float v, float pattern[3]) {
  const float variance = lesser(blur * blur * texture->first, 1e30f);
  if (variance >= 1.0f) {
    const int bits = bits_of(variance), last = texture->level_count - 1;
    const int found = (bits >> 23) - 127, level = found < last ? found : last;
    const float fraction = found < last ? of_bits((bits & 0x007fffff) | 0x3f800000) - 1.0f : 0.0f;
    add_level(floats, &texture->level[level], u, v, 1.0f - fraction, pattern);
    if (level < last) add_level(floats, &texture->level[level + 1], u, v, fraction, pattern);
    return;
  }
  const float first = variance * variance;
  add_sharp_image(floats, texture, blur, u, v, 1.0f - first, pattern);
  add_level(floats, &texture->level[0], u, v, first, pattern);
}

/* Finds the colour of a light's image at a position in frame space, as texture_pattern(). textures: [lights];
 * the pixels of all images follow them. Returns 0 if the light projects no image. */
DEVICE int pattern_of_texture(GLOBAL const plan_texture *textures, int lights, int number, vector position,
                              float pattern[3]) {
  GLOBAL const plan_texture *texture = &textures[number];
  GLOBAL const float *floats = (GLOBAL const float *)(textures + lights);
  if (texture->image.width == 0) return 0;
  pattern[0] = pattern[1] = pattern[2] = 0.0f;
  const float ahead = row_of_point(texture->map[0], position);
  if (!(ahead > 0.0f)) return 1;
  const float u = divided(row_of_point(texture->map[1], position), ahead),
              v = divided(row_of_point(texture->map[2], position), ahead);
  if (texture->level_count == 0) {
    add_sharp_image(floats, texture, 0.0f, u, v, 1.0f, pattern);
    return 1;
  }
  const float blur = magnitude(texture->parallel ? row_of_point(texture->beyond, position)
                                                 : 1.0f - divided(1.0f, greater(ahead, 0.05f)));
  add_soft_image(floats, texture, blur, u, v, pattern);
  return 1;
}

#endif

#endif
