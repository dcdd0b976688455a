/* render/maximum.c - makes maximum projections: keeps the greatest values of the picture, and colours them
 * (maximum.h). */
#include "render/maximum.h"

#include <string.h>

#include "core/memory.h"
#include "scene/function/transfer_function.h"

static size_t visible_count(const plan_volumes *volumes) {
  size_t count = 0;
  for (int i = 0; i < volumes->count; i++) count += volumes->list[i].visible;
  return count;
}

static size_t floats_of_tile(const maximum_values *maximum) {
  return maximum->volume_count * MAXIMUM_ROWS * TILE_PIXELS;
}

static maximum_values plan_values(const frame_plan *plan) {
  return (maximum_values){.volume_count = visible_count(&plan->volumes), .tiles = plan->picture.tiles};
}

static void lay_out(maximum_values *maximum, hl_layout *layout) {
  maximum->values = hl_layout_take(layout, maximum->tiles, floats_of_tile(maximum) * sizeof *maximum->values);
}

void hl_maximum_count(const frame_plan *plan, hl_layout *layout) {
  maximum_values maximum = plan_values(plan);
  if (hl_is_maximum(&plan->settings)) lay_out(&maximum, layout);
}

static void clear_tile(void *data, size_t tile, int worker) {
  (void)worker;
  const maximum_values *maximum = data;
  float *values = maximum->values + tile * floats_of_tile(maximum);
  for (size_t i = 0; i < floats_of_tile(maximum); i++) values[i] = -1;
}

hl_status hl_maximum_create(hl_context *context, hl_pool *pool, const frame_plan *of, maximum_values *maximum,
                            hl_error *error) {
  *maximum = plan_values(of);
  if (!hl_is_maximum(&of->settings)) return HL_OK;
  hl_layout layout = {0};
  while (hl_layout_pass(&layout, context)) lay_out(maximum, &layout);
  if (layout.base == NULL) return hl_fail_memory(error, layout.bytes, "a maximum projection");
  hl_pool_run(pool, of->picture.tiles, clear_tile, maximum);
  return HL_OK;
}

void hl_maximum_release(hl_context *context, maximum_values *maximum) {
  hl_release(context, maximum->values);
}

/* ---- values of a device ---- */

typedef struct take_job {
  const maximum_values *maximum;
  float *pixels;
} take_job;

static void take_tile(void *data, size_t tile, int worker) {
  (void)worker;
  const take_job *job = data;
  float *values = job->maximum->values + tile * floats_of_tile(job->maximum),
        *pixels = job->pixels + tile * 4 * TILE_PIXELS;
  for (int block = 0; block < TILE_BLOCKS; block++)
    memcpy(values + block * BLOCK_PIXELS, pixels + 4 * block * BLOCK_PIXELS, BLOCK_PIXELS * sizeof *pixels);
  memset(pixels, 0, (size_t)4 * TILE_PIXELS * sizeof *pixels);
}

void hl_maximum_take(const maximum_values *maximum, hl_pool *pool, float *pixels) {
  take_job job = {maximum, pixels};
  hl_pool_run(pool, maximum->tiles, take_tile, &job);
}

/* ---- colours ---- */

typedef struct color_job {
  const maximum_values *maximum;
  const plan_volumes *volumes;
  bool darkens; /* whether the colours of volumes darken each other */
  float *pixels;
} color_job;

/* Returns whether the colours of all visible volumes begin bright, as in projections on white paper. The
 * colours then darken each other; else they brighten each other, as light does. */
static bool all_begin_bright(const plan_volumes *volumes) {
  bool bright = true;
  for (int i = 0; i < volumes->count; i++) {
    const float *first = volumes->list[i].classifier->color[0];
    const double color[3] = {(double)first[0], (double)first[1], (double)first[2]};
    if (volumes->list[i].visible) bright = bright && hl_color_is_bright(color);
  }
  return bright;
}

/* Looks up the colours of sixteen pixels of one volume. Where volumes shine, a pixel's component is the
 * greatest one of their colours; where they darken each other, it is the least one. */
static void color_block(float (*table)[4], const float *greatest, bool darkens, float *pixels) {
  for (int lane = 0; lane < BLOCK_PIXELS; lane++) {
    if (!(greatest[lane] >= 0)) continue;
    int entry = (int)greatest[lane];
    float fraction = greatest[lane] - (float)entry;
    for (int c = 0; c < 3; c++) {
      float color = table[entry][c] + (table[entry + 1][c] - table[entry][c]) * fraction;
      float *at = &pixels[c * BLOCK_PIXELS + lane];
      const bool first = pixels[3 * BLOCK_PIXELS + lane] == 0;
      if (first || (darkens ? color < *at : color > *at)) *at = color;
    }
    pixels[3 * BLOCK_PIXELS + lane] = 1;
  }
}

static void color_tile(void *data, size_t tile, int worker) {
  (void)worker;
  const color_job *job = data;
  const float *values = job->maximum->values + tile * floats_of_tile(job->maximum);
  for (int i = 0; i < job->volumes->count; i++) {
    if (!job->volumes->list[i].visible) continue;
    for (int block = 0; block < TILE_BLOCKS; block++)
      color_block(job->volumes->list[i].classifier->color, values + block * BLOCK_PIXELS, job->darkens,
                  job->pixels + (tile * TILE_BLOCKS + (size_t)block) * 4 * BLOCK_PIXELS);
    values += MAXIMUM_ROWS * TILE_PIXELS;
  }
}

void hl_maximum_color(const maximum_values *maximum, const frame_plan *of, hl_pool *pool, float *pixels) {
  color_job job = {maximum, &of->volumes, all_begin_bright(&of->volumes), pixels};
  hl_pool_run(pool, maximum->tiles, color_tile, &job);
}

uint32_t hl_maximum_tile(const sweep *sweep, const tile_slab *slab) {
  const maximum_values *maximum = sweep->target.maximum;
  float *values = maximum->values + slab->tile * maximum->volume_count * MAXIMUM_ROWS * TILE_PIXELS;
  return sweep->content.hot->render->maximum(slab->job, slab, values,
                                             &sweep->arrays.counts[slab->worker].samples);
}
