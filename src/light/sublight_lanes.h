/* light/sublight_lanes.h - one tile of one part's buffer times the slab, a row of sixteen pixels at a time. */
#ifndef HL_LIGHT_SUBLIGHT_LANES_H
#define HL_LIGHT_SUBLIGHT_LANES_H

#include "light/attenuate_lanes.h"
#include "light/sublight_field.h"

/* Greatest integer not above x, and what is left. */
LANES_INLINE int whole_part(float x, float *rest) {
  int whole = (int)x - ((float)(int)x > x);
  *rest = x - (float)whole;
  return whole;
}

enum { SUBLIGHT_TAPS = 6 };

/* How a row of sixteen pixels reads a row of the slab: steps are nearly 1, so that each pixel lies between two of a few
 * neighbours of its own place; weight[i] is that of the i-th. Weights are those of linear interpolation. */
typedef struct row_taps {
  int first, count; /* count 0: too many */
  lanes x;          /* of the slab's pixel centres, held inside it */
  lanes weight[SUBLIGHT_TAPS];
} row_taps;

LANES_INLINE row_taps taps_of_row(const sublight_job *job, int tile_x) {
  static const float places[LANES] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
  row_taps taps;
  float start = job->scale[0] * ((float)(tile_x * TILE) + 0.5f) + job->shift[0] - 0.5f, drift = 15.0f * (job->scale[0] - 1.0f), rest;
  lanes x = lanes_load(places) * job->scale[0] + start;
  taps.x = lanes_clamp(x, -2.0f, job->slab_width + 1.0f);
  taps.first = whole_part(drift < 0 ? start + drift : start, &rest);
  taps.count = 2 + whole_part(rest + (drift < 0 ? -drift : drift), &rest);
  if (taps.count > SUBLIGHT_TAPS || taps.first < -28 || (float)taps.first > job->slab_width + 8.0f) taps.count = 0;
  for (int i = 0; i < taps.count; i++) {
    lanes distance = lanes_abs(x - lanes_load(places) - (float)(taps.first + i));
    taps.weight[i] = lanes_max(1.0f - distance, lanes_set(0));
  }
  return taps;
}

/* Sixteen pixels along a row of the slab. */
LANES_INLINE lanes slab_row(const row_taps *taps, const float *row) {
  if (taps->count == 0) {
    lanes_int column = lanes_floor(taps->x);
    lanes a, b;
    lanes_gather_pairs(row, column, &a, &b);
    return a + (b - a) * (taps->x - lanes_from_int(column));
  }
  lanes sum = lanes_load(row + taps->first) * taps->weight[0];
  for (int i = 1; i < taps->count; i++) sum = sum + lanes_load(row + taps->first + i) * taps->weight[i];
  return sum;
}

static int sublight_tile(const sublight_job *job, int tile_x, int tile_y) {
  lanes greatest = lanes_set(0);
  row_taps taps = taps_of_row(job, tile_x);
  for (int c = 0; c < job->channels; c++) {
    int known = -(1 << 30); /* the row of the slab that `next` holds */
    lanes next = greatest;
    for (int row = 0; row < TILE; row++) {
      size_t at = (size_t)(tile_y * TILE + row) * job->stride + (size_t)tile_x * TILE;
      float y = job->scale[1] * ((float)(tile_y * TILE + row) + 0.5f) + job->shift[1] - 0.5f, part;
      int line = whole_part(y < -2.0f ? -2.0f : y > job->slab_height + 1.0f ? job->slab_height + 1.0f : y, &part);
      const float *slab = job->slab[c] + (ptrdiff_t)line * (ptrdiff_t)job->slab_stride;
      lanes upper = line == known ? next : slab_row(&taps, slab);
      next = slab_row(&taps, slab + job->slab_stride);
      known = line + 1;
      lanes left = lanes_load(job->transmittance[c] + at) * (upper + (next - upper) * part);
      lanes_store(job->transmittance[c] + at, left);
      greatest = lanes_max(greatest, left);
    }
  }
  return lanes_bits(greatest >= DARK) != 0;
}

#endif
