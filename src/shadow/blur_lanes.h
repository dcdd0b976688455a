/* shadow/blur_lanes.h - computes box blurs of one tile, a row of sixteen pixels at a time. */
#ifndef HL_SHADOW_BLUR_LANES_H
#define HL_SHADOW_BLUR_LANES_H

#include "shadow/blur.h"
#include "simd/lanes.h"

/* Blurs sixteen neighbouring pixels along one direction. step: the number of floats from a pixel to the next
 * pixel in this direction. */
LANES_INLINE lanes blur_sixteen(const float *from, ptrdiff_t step, const blur_box *box) {
  lanes ends = lanes_load(from - (box->reach + 1) * step) + lanes_load(from + (box->reach + 1) * step);
  lanes sum = lanes_add_scaled(lanes_load(from), ends, box->edge);
  for (int i = 1; i <= box->reach; i++)
    sum = sum + (lanes_load(from - i * step) + lanes_load(from + i * step));
  return sum * box->scale;
}

LANES_INLINE void blur_tile(const blur_job *job, int tile_x, int tile_y, ptrdiff_t step) {
  const blur_box *box = &job->box;
  const float *from = job->from + (size_t)tile_y * TILE * job->stride + (size_t)tile_x * TILE;
  float *to = job->to + (size_t)tile_y * TILE * job->stride_to + (size_t)tile_x * TILE;
  for (int row = 0; row < TILE; row++, from += job->stride, to += job->stride_to)
    lanes_store(to, blur_sixteen(from, step, box));
}

static void blur_rows_tile(const blur_job *job, int tile_x, int tile_y) { blur_tile(job, tile_x, tile_y, 1); }
static void blur_columns_tile(const blur_job *job, int tile_x, int tile_y) {
  blur_tile(job, tile_x, tile_y, (ptrdiff_t)job->stride);
}

#endif
