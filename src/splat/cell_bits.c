/* splat/cell_bits.c - see cell_bits.h. */
#include "splat/cell_bits.h"

#include "splat/cell_bounds.h"

/* Larger volumes go without: an eighth of a byte a voxel would be much beside what else they take. */
static const uint64_t GREATEST_BYTES = 8 << 20;
/* Bits that leave out less than this share of visible bricks' cells are not worth asking for. */
static const double LEAST_LEFT_OUT = 1.0 / 8;

uint64_t hl_cell_bits_bytes(uint64_t bricks) {
  return bricks * sizeof(uint64_t) <= GREATEST_BYTES ? bricks * sizeof(uint64_t) : 0;
}

bool hl_cell_bits_wanted(const grid *grid, const kernel *kernel) {
  return kernel->degree == HL_BSPLINE_DEGREE && hl_cell_bits_bytes(hl_grid_bricks(grid)) > 0;
}

typedef struct bits_job {
  grid *grid;
  brick_bits_function *brick_bits;
  float sign, level;       /* what shows: sign * stored value > level */
  uint64_t visible, shown; /* visible bricks, and their cells with a bit; atomic */
} bits_job;

/* The level, lowered by what sums of floats and the rounded weights of u8 voxels may err by: 6e-6 of the
 * greatest number, and 1e-3 of a table's entry. False where floats cannot tell. */
static bool find_level(const grid *grid, const classifier *classifier, bits_job *job) {
  double high = (double)grid->cell_base + 255.0 * (double)grid->cell_step;
  double greatest = fmax(fmax(fabs((double)grid->cell_base), fabs(high)), fabs((double)grid->empty));
  double scale = (double)classifier->scale;
  if (scale == 0 || !isfinite(scale) || !(greatest > 1e-30) || !(greatest < 1e30)) return false;
  double value = ((double)classifier->first_visible - (double)classifier->offset) / scale +
                 (double)grid->empty;
  job->sign = scale > 0 ? 1 : -1;
  job->level = (float)(value * (double)job->sign - 8e-6 * greatest - 2e-3 / fabs(scale));
  /* sums of zeros are zero without an error */
  float at_zero = -grid->empty * classifier->scale + classifier->offset;
  if (scale > 0 && grid->cell_base >= 0 && at_zero <= classifier->first_visible)
    job->level = fmaxf(job->level, 0);
  return isfinite(job->level);
}

/* Of all bricks: what is not visible by itself may show on the way to other values. */
static uint64_t find_bits(const bits_job *job, size_t at, const int32_t brick[3]) {
  const grid *grid = job->grid;
  float bounds[2];
  hl_bounds_of_brick(grid, at, bounds);
  float low = job->sign > 0 ? bounds[0] : -bounds[1], high = job->sign > 0 ? bounds[1] : -bounds[0];
  if (high <= job->level) return 0;
  return low > job->level ? UINT64_MAX : job->brick_bits(grid, brick, job->sign, job->level);
}

static void find_layer(void *data, size_t layer, int worker) {
  (void)worker;
  bits_job *job = data;
  const grid *grid = job->grid;
  size_t at = layer * (size_t)grid->brick_count[1] * (size_t)grid->brick_count[0];
  uint64_t visible = 0, shown = 0;
  for (int32_t y = 0; y < grid->brick_count[1]; y++)
    for (int32_t x = 0; x < grid->brick_count[0]; x++, at++) {
      uint64_t bits = find_bits(job, at, (const int32_t[3]){x, y, (int32_t)layer});
      grid->cell_bits[at] = bits;
      if (!grid->relevant[at] || !hl_brick_is_visible(grid, at)) continue;
      visible++;
      shown += (uint64_t)__builtin_popcountll(bits);
    }
  __atomic_fetch_add(&job->visible, visible, __ATOMIC_RELAXED);
  __atomic_fetch_add(&job->shown, shown, __ATOMIC_RELAXED);
}

void hl_cell_bits_find(grid *grid, const classifier *classifier, brick_bits_function *brick_bits,
                       hl_pool *pool) {
  bits_job job = {.grid = grid, .brick_bits = brick_bits};
  grid->cell_bits_tell = grid->cell_bits != NULL && find_level(grid, classifier, &job);
  if (!grid->cell_bits_tell) return;
  hl_pool_run(pool, (size_t)grid->brick_count[2], find_layer, &job);
  double cells = 64 * (double)job.visible;
  grid->cell_bits_tell = cells - (double)job.shown >= LEAST_LEFT_OUT * cells;
}
