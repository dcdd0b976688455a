/* shadow/blur.h - applies a centred box blur to a shadow buffer, tile by tile: along rows, then along
 * columns. */
#ifndef HL_SHADOW_BLUR_H
#define HL_SHADOW_BLUR_H

#include <math.h>
#include <stddef.h>

#include "shadow/attenuate.h"

/* A box blur whose width is 2 reach + 1 + 2 edge pixels. Pixels up to `reach` pixels away have the weight 1;
 * the pixels at the distance reach + 1 have the weight `edge`, from 0 to 1. */
typedef struct blur_box {
  int reach;
  float edge;
  float scale; /* 1 / the width of the box */
} blur_box;

typedef struct blur_job {
  const float *from; /* pixel (0,0); rows are `stride` apart; readable up to reach + 1 pixels beyond the
                      * tiles */
  float *to;         /* pixel (0,0) of the result; rows are stride_to floats apart */
  size_t stride, stride_to;
  blur_box box;
} blur_job;

typedef void blur_tile_function(const blur_job *job, int tile_x, int tile_y);

enum { BLUR_GREATEST_REACH = 46 };

/* A blur with the taps of a penumbra of an emission image (light_emission.h). Each pixel becomes the weighted
 * sum of the pixels at its taps. */
typedef struct emission_job {
  const float *from; /* pixel (0,0) of the image that is blurred; rows are `stride` floats apart */
  float *to;
  size_t stride;
  int count;
  const ptrdiff_t *offset; /* [count]; offsets from a pixel to each of its taps, in floats */
  const float *weight;     /* [count]; the weight of each tap */
} emission_job;
typedef void emission_tile_function(const emission_job *job, int tile_x, int tile_y);

/* The blurs that are compiled for each instruction set. */
typedef struct blur_functions {
  blur_tile_function *rows, *columns;
  lit_blocks_function *lit_blocks;
  emission_tile_function *emission; /* writes the weighted sums of the pixels of `from` to `to` */
} blur_functions;

/* The box of a given width in pixels, at least 1. If the width is an even number, the pixels at both ends
 * have half weights, so that the box is centred. */
static inline blur_box hl_blur_box(float width) {
  int reach = (int)((width - 1) / 2);
  return (blur_box){reach, (width - 1) / 2 - (float)reach, 1 / width};
}

/* The box whose weights have a given variance v, in squared pixels, or the widest box if BLUR_GREATEST_REACH
 * does not allow this variance. Derived: weights of 1 up to r pixels away have the variance r (r + 1) / 3.
 * The weight e is added at the distance r + 1 on both sides. With n = 2 r + 1, the variance v then satisfies
 * v (n + 2 e) = n r (r + 1) / 3 + 2 e (r + 1)^2. This equation gives e. */
static inline blur_box hl_blur_box_of_variance(double variance) {
  int most = BLUR_GREATEST_REACH - 2, reach = (int)fmin(sqrt(3 * variance + 0.25) - 0.5, most);
  double whole = reach * (reach + 1) / 3.0, width = 2 * reach + 1;
  double edge = 0.5 * width * (variance - whole) / ((reach + 1.0) * (reach + 1) - variance);
  if (reach == most || !(edge < 1)) edge = reach == most ? 0 : 1;
  return (blur_box){reach, (float)edge, (float)(1 / (width + 2 * edge))};
}

#endif
