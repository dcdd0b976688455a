/* grid/prefilter.c - see prefilter.h. */
#include "grid/prefilter.h"

/* The filter that turns voxels into coefficients, along an axis. A voxel's value is (c[i-1] + 4 c[i] +
 * c[i+1]) / 6 with the coefficients c. Beyond the grid the last coefficient repeats, like voxels: at both
 * ends the value is (5 c[i] + c[i+-1]) / 6. Elimination (the algorithm of Thomas) gives d[i] = (6 value -
 * d[i-1]) r[i] with r[i] = 1 / (4 - r[i-1]) on the way forwards, and c[i] = d[i] - r[i] c[i+1] on the way
 * back (derived). The ratio r tends to Unser's pole, 2 - sqrt(3), and reaches the pole in float precision
 * after RATIOS steps. */
enum { RATIOS = 12 };
typedef struct ratios {
  float inner[RATIOS], last; /* the numbers r[i] of the filter. inner: r[0], r[1], ...; last: r at the
                              * axis's last voxel */
} ratios;

static ratios ratios_of_axis(int32_t count) {
  ratios r;
  r.inner[0] = 1.0f / 5;
  for (int i = 1; i < RATIOS; i++) r.inner[i] = 1 / (4 - r.inner[i - 1]);
  r.last = 1 / (5 - r.inner[count - 2 < RATIOS ? count - 2 : RATIOS - 1]);
  return r;
}

static float ratio_at(const ratios *r, int32_t at, int32_t count) {
  return at == count - 1 ? r->last : r->inner[at < RATIOS ? at : RATIOS - 1];
}

static void filter_forward(float *here, const float *before, size_t width, float ratio) {
  if (before == NULL)
    for (size_t x = 0; x < width; x++) here[x] = 6 * here[x] * ratio;
  else
    for (size_t x = 0; x < width; x++) here[x] = (6 * here[x] - before[x]) * ratio;
}

static void filter_back(float *here, const float *after, size_t width, float ratio) {
  for (size_t x = 0; x < width; x++) here[x] = here[x] - ratio * after[x];
}

void hl_prefilter_forward(float *here, const float *before, size_t width, size_t at, size_t count) {
  const ratios r = ratios_of_axis((int32_t)count);
  filter_forward(here, before, width, ratio_at(&r, (int32_t)at, (int32_t)count));
}

void hl_prefilter_back(float *here, const float *after, size_t width, size_t at, size_t count) {
  const ratios r = ratios_of_axis((int32_t)count);
  filter_back(here, after, width, ratio_at(&r, (int32_t)at, (int32_t)count));
}

/* Filters `width` neighbouring lines of `count` voxels each, in place. stride: number of floats from a voxel
 * to the next voxel of its line. */
static void filter_lines(float *lines, size_t width, int32_t count, size_t stride) {
  if (count < 2) return;
  const ratios r = ratios_of_axis(count);
  for (int32_t i = 0; i < count; i++) {
    float *here = lines + (size_t)i * stride;
    filter_forward(here, i > 0 ? here - stride : NULL, width, ratio_at(&r, i, count));
  }
  for (int32_t i = count - 2; i >= 0; i--) {
    float *here = lines + (size_t)i * stride;
    filter_back(here, here + stride, width, ratio_at(&r, i, count));
  }
}

void hl_prefilter_slice(float *slice, size_t width, size_t height) {
  for (size_t y = 0; y < height; y++) filter_lines(slice + y * width, 1, (int32_t)width, 1);
  filter_lines(slice, width, (int32_t)height, width);
}

static void filter_slice(void *data, size_t index, int worker) {
  (void)worker;
  const grid *grid = data;
  size_t width = (size_t)grid->dimension[0], height = (size_t)grid->dimension[1];
  hl_prefilter_slice(grid->finite_voxels + index * width * height, width, height);
}

static void filter_across(void *data, size_t index, int worker) {
  (void)worker;
  const grid *grid = data;
  size_t row = (size_t)grid->dimension[0], rows = (size_t)grid->dimension[1];
  filter_lines(grid->finite_voxels + index * row, row, grid->dimension[2], row * rows);
}

void hl_prefilter(hl_pool *pool, grid *grid) {
  hl_pool_run(pool, (size_t)grid->dimension[2], filter_slice, grid);
  hl_pool_run(pool, (size_t)grid->dimension[1], filter_across, grid);
}
