/* light/cascade_lanes.h - tile operations on cascade fields, as plain loops over rows. */
#ifndef HL_LIGHT_CASCADE_LANES_H
#define HL_LIGHT_CASCADE_LANES_H

#include "light/blur_lanes.h"
#include "light/cascade_field.h"

static void blur_add_tile(const blur_add_job *job, int tile_x, int tile_y) {
  _Alignas(64) float rows[(TILE + 2 * BLUR_GREATEST_REACH) * TILE];
  int apron = job->v.reach + 1;
  const float *from = job->from + (ptrdiff_t)(tile_y * TILE - apron) * (ptrdiff_t)job->stride + tile_x * TILE;
  for (int row = 0; row < TILE + 2 * apron; row++, from += job->stride)
    lanes_store(rows + row * TILE, blur_sixteen(from, 1, &job->u));
  size_t at = (size_t)tile_y * TILE * job->stride + (size_t)tile_x * TILE;
  for (int row = 0; row < TILE; row++, at += job->stride) {
    lanes blurred = blur_sixteen(rows + (row + apron) * TILE, TILE, &job->v);
    if (job->thin != NULL) blurred = blurred * (1.0f - lanes_load(job->thin + at));
    lanes_store(job->to + at, job->a == NULL ? blurred : blurred + lanes_load(job->a + at));
  }
}

static void add_tile(const field_job *job, int tile_x, int tile_y) {
  size_t at = (size_t)tile_y * TILE * job->stride + (size_t)tile_x * TILE;
  for (int row = 0; row < TILE; row++, at += job->stride) {
    lanes b = lanes_load(job->b + at);
    if (job->thin != NULL) b = b * (1.0f - lanes_load(job->thin + at));
    lanes_store(job->to + at, lanes_load(job->a + at) + b);
  }
}

static void add_half_tile(const field_job *job, int tile_x, int tile_y) {
  for (int row = 0; row < TILE; row++) {
    size_t from = (size_t)(tile_y * TILE + row) * 2 * job->stride_in + (size_t)tile_x * TILE * 2;
    float *to = job->to + (size_t)(tile_y * TILE + row) * job->stride + (size_t)tile_x * TILE;
    float sum[2][2 * TILE];
    for (size_t half = 0; half < 2; half++) {
      const float *a = job->a + from + half * job->stride_in, *b = job->b + from + half * job->stride_in;
      const float *thin = job->thin == NULL ? NULL : job->thin + from + half * job->stride_in;
      for (int i = 0; i < 2 * TILE; i++) sum[half][i] = a[i] + (thin == NULL ? b[i] : b[i] * (1.0f - thin[i]));
    }
    for (int i = 0; i < TILE; i++)
      to[i] = 0.25f * ((sum[0][2 * i] + sum[0][2 * i + 1]) + (sum[1][2 * i] + sum[1][2 * i + 1]));
  }
}

/* Pixel 2i lies a quarter of a coarse pixel before coarse pixel i's centre, pixel 2i+1 a quarter after. */
static void add_double_tile(const field_job *job, int tile_x, int tile_y) {
  for (int row = 0; row < TILE; row++) {
    int y = tile_y * TILE + row;
    const float *near = job->b + (ptrdiff_t)(y / 2) * (ptrdiff_t)job->stride_in + tile_x * TILE / 2;
    const float *far = y & 1 ? near + job->stride_in : near - job->stride_in;
    size_t at = (size_t)y * job->stride + (size_t)tile_x * TILE;
    float coarse[TILE / 2 + 2];
    for (int i = 0; i < TILE / 2 + 2; i++) coarse[i] = 0.75f * near[i - 1] + 0.25f * far[i - 1];
    float fine[TILE];
    for (int i = 0; i < TILE / 2; i++) {
      fine[2 * i] = 0.75f * coarse[i + 1] + 0.25f * coarse[i];
      fine[2 * i + 1] = 0.75f * coarse[i + 1] + 0.25f * coarse[i + 2];
    }
    for (size_t i = 0; i < TILE; i++)
      job->to[at + i] = job->a[at + i] + (job->thin == NULL ? fine[i] : fine[i] * (1.0f - job->thin[at + i]));
  }
}

static void left_tile(const field_job *job, int tile_x, int tile_y) {
  for (int row = tile_y * TILE; row < (tile_y + 1) * TILE; row++)
    lanes_store(job->to + (size_t)row * job->stride_in + (size_t)tile_x * TILE,
                lanes_clamp(1.0f - lanes_load(job->a + (size_t)row * job->stride + (size_t)tile_x * TILE), 0, 1.0f));
}

/* Where a chunk takes less than the first part of its light it counts as thin, from the second on as solid. */
static const float THIN_MATTER = 0.25f, SOLID_MATTER = 0.75f;

static void absorbed_tile(const absorbed_job *job, int tile_x, int tile_y) {
  for (int row = tile_y * TILE; row < (tile_y + 1) * TILE; row++) {
    size_t at = (size_t)row * job->stride + (size_t)tile_x * TILE;
    lanes before = lanes_clamp(1.0f - lanes_load(job->lacking + at), 0, 1.0f);
    lanes now = lanes_load(job->now + (size_t)row * job->stride_now + (size_t)tile_x * TILE);
    lanes taken = lanes_max(before - now, lanes_set(0)), part = taken / lanes_max(before, lanes_set(1e-3f));
    lanes solid = lanes_clamp((part - THIN_MATTER) * (1.0f / (SOLID_MATTER - THIN_MATTER)), 0, 1.0f);
    lanes thin = part * (1.0f - solid);
    lanes_store(job->thin + at, thin);
    lanes_store(job->absorbed + at, taken * solid + thin);
  }
}

#endif
