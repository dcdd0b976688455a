/* grid/prefilter.c - see prefilter.h. */
#include "grid/prefilter.h"

/* Along an axis, a voxel's value is (c[i-1] + 4 c[i] + c[i+1]) / 6 of the coefficients c. Beyond the grid the
 * last coefficient continues, as voxels do: at both ends the value is (5 c[i] + c[i+-1]) / 6. Elimination
 * (Thomas) gives d[i] = (6 value - d[i-1]) r[i], r[i] = 1 / (4 - r[i-1]), and back c[i] = d[i] - r[i] c[i+1]
 * (derived). r tends to Unser's pole, 2 - sqrt(3), and to a float is there after RATIOS steps. */
enum { RATIOS = 12 };
typedef struct ratios {
  float inner[RATIOS], last; /* r[0], r[1], ...; r of the axis's last voxel */
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

/* Filters `width` neighbouring lines of `count` voxels each, in place; stride: from voxel to voxel. */
static void filter_lines(float *lines, size_t width, int32_t count, size_t stride) {
  if (count < 2) return;
  const ratios r = ratios_of_axis(count);
  for (size_t x = 0; x < width; x++) lines[x] = 6 * lines[x] * r.inner[0];
  for (int32_t i = 1; i < count; i++) {
    float *here = lines + (size_t)i * stride, ratio = ratio_at(&r, i, count);
    const float *before = here - stride;
    for (size_t x = 0; x < width; x++) here[x] = (6 * here[x] - before[x]) * ratio;
  }
  for (int32_t i = count - 2; i >= 0; i--) {
    float *here = lines + (size_t)i * stride, ratio = ratio_at(&r, i, count);
    const float *after = here + stride;
    for (size_t x = 0; x < width; x++) here[x] = here[x] - ratio * after[x];
  }
}

static void filter_slice(void *data, size_t index, int worker) {
  (void)worker;
  const grid *grid = data;
  size_t row = (size_t)grid->dimension[0], rows = (size_t)grid->dimension[1];
  float *slice = grid->finite_voxels + index * row * rows;
  for (size_t y = 0; y < rows; y++) filter_lines(slice + y * row, 1, grid->dimension[0], 1);
  filter_lines(slice, row, grid->dimension[1], row);
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
