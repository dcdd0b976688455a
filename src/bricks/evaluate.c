/* bricks/evaluate.c - see evaluate.h. */
#include "bricks/evaluate.h"

#include <math.h>

enum { TAPS = 4 };

static int64_t clamp_whole(int64_t at, int64_t low, int64_t high) {
  return at < low ? low : at > high ? high : at;
}

/* The block whose brick has the cell, or the coefficient, at a coordinate of level 0. */
static int64_t block_of(const hl_bricks *bricks, int axis, int64_t at) {
  return clamp_whole(at, 0, hl_bricks_cells(bricks, axis) - 1) >> bricks->shift;
}

/* Four coefficients along an axis of a brick, and their weights. They are counted from the first coefficient
 * that the brick stores. */
typedef struct taps {
  int64_t index[TAPS];
  double weight[TAPS];
} taps;

/* Places the taps before - 1 .. before + 2 of a level in the brick that holds the block. Taps that the brick
 * does not store have weights of zero. */
static void place_taps(const hl_bricks *bricks, int level, int64_t block, int64_t before, taps *found) {
  int64_t first = (block >> level << bricks->shift) - 1, last = (int64_t)hl_brick_width(bricks) - 1;
  for (int tap = 0; tap < TAPS; tap++) found->index[tap] = clamp_whole(before - 1 + tap - first, 0, last);
}

/* The weights of the coefficients of a level in the coefficient of level 0 of one point. From level to level
 * an even coefficient 2 j is (d[j-1] + 6 d[j] + d[j+1]) / 8, and an odd one 2 j + 1 is (d[j] + d[j+1]) / 2
 * (E. Catmull, J. Clark, Recursively generated B-spline surfaces, 1978). Four taps suffice at any level: half
 * of four neighbouring points, with one more on either side, are at most four points (derived). */
static void weigh_subdivided(int level, int64_t point, double weight[TAPS]) {
  double fine[TAPS] = {0, 1, 0, 0};
  for (int step = 0; step < level; step++) {
    int64_t first = (point >> step) - 1, first_coarse = (point >> (step + 1)) - 1;
    double coarse[TAPS + 2] = {0}; /* begins at coefficient first_coarse - 1 */
    for (int tap = 0; tap < TAPS; tap++) {
      int64_t at = first + tap, j = (at >> 1) - first_coarse + 1;
      if (fine[tap] == 0) continue;
      if (at & 1) {
        coarse[j] += fine[tap] / 2, coarse[j + 1] += fine[tap] / 2;
      } else {
        coarse[j - 1] += fine[tap] / 8, coarse[j] += fine[tap] * 6 / 8, coarse[j + 1] += fine[tap] / 8;
      }
    }
    for (int tap = 0; tap < TAPS; tap++) fine[tap] = coarse[tap + 1];
  }
  for (int tap = 0; tap < TAPS; tap++) weight[tap] = fine[tap];
}

/* Taps without a weight are left out, because their coefficients may be NaN. */
static double sum_taps(const hl_bricks *bricks, const float *brick, const taps at[3]) {
  size_t width = hl_brick_width(bricks);
  double sum = 0;
  for (int k = 0; k < TAPS; k++)
    for (int j = 0; j < TAPS; j++) {
      const float *row = brick + ((size_t)at[2].index[k] * width + (size_t)at[1].index[j]) * width;
      double along = 0;
      if (at[2].weight[k] * at[1].weight[j] == 0) continue;
      for (int i = 0; i < TAPS; i++)
        if (at[0].weight[i] != 0) along += at[0].weight[i] * (double)row[at[0].index[i]];
      sum += at[2].weight[k] * at[1].weight[j] * along;
    }
  return sum;
}

float hl_bricks_coefficient(const hl_bricks *bricks, const int64_t point[3]) {
  int64_t block[3], at[3];
  for (int axis = 0; axis < 3; axis++) {
    at[axis] = clamp_whole(point[axis], -1, hl_bricks_cells(bricks, axis) + 1);
    block[axis] = block_of(bricks, axis, at[axis]);
  }
  const hl_brick_entry *entry = hl_bricks_entry(bricks, block);
  if (entry->slot < 0) return entry->constant;
  const float *brick = hl_brick_pool(bricks, entry->slot);
  if (entry->level == 0) {
    size_t width = hl_brick_width(bricks), place = 0;
    for (int axis = 2; axis >= 0; axis--)
      place = place * width + (size_t)(at[axis] - (block[axis] << bricks->shift) + 1);
    return brick[place];
  }
  taps found[3];
  for (int axis = 0; axis < 3; axis++) {
    weigh_subdivided(entry->level, at[axis], found[axis].weight);
    place_taps(bricks, entry->level, block[axis], at[axis] >> entry->level, &found[axis]);
  }
  return (float)sum_taps(bricks, brick, found);
}

double hl_bricks_value(const hl_bricks *bricks, const double point[3]) {
  int64_t block[3];
  double at[3];
  for (int axis = 0; axis < 3; axis++) {
    at[axis] = fmin(fmax(point[axis], 0), (double)hl_bricks_cells(bricks, axis));
    block[axis] = block_of(bricks, axis, (int64_t)at[axis]);
  }
  const hl_brick_entry *entry = hl_bricks_entry(bricks, block);
  if (entry->slot < 0) return (double)entry->constant;
  taps found[3];
  for (int axis = 0; axis < 3; axis++) {
    double place = ldexp(at[axis], -entry->level);
    int64_t end = ((block[axis] >> entry->level) + 1) << bricks->shift, before = (int64_t)place;
    if (before >= end) before = end - 1;
    double t = place - (double)before, s = 1 - t, *weight = found[axis].weight;
    weight[0] = s * s * s / 6;
    weight[1] = (4 - 6 * t * t + 3 * t * t * t) / 6;
    weight[2] = (4 - 6 * s * s + 3 * s * s * s) / 6;
    weight[3] = t * t * t / 6;
    place_taps(bricks, entry->level, block[axis], before, &found[axis]);
  }
  return sum_taps(bricks, hl_brick_pool(bricks, entry->slot), found);
}

/* Widens a range to the coefficients of a brick on which the cells first .. last of level 0 depend. */
static void widen_to_brick(const hl_bricks *bricks, const hl_brick_entry *entry, const int64_t block[3],
                           const int64_t first[3], const int64_t last[3], float range[2]) {
  size_t width = hl_brick_width(bricks), from[3], to[3];
  for (int axis = 0; axis < 3; axis++) {
    int64_t start = block[axis] >> entry->level << bricks->shift, most = ((int64_t)1 << bricks->shift) - 1;
    from[axis] = (size_t)clamp_whole((first[axis] >> entry->level) - start, 0, most);
    to[axis] = (size_t)clamp_whole((last[axis] >> entry->level) - start, 0, most) + TAPS - 1;
  }
  const float *brick = hl_brick_pool(bricks, entry->slot);
  float low = range[0], high = range[1];
  for (size_t k = from[2]; k <= to[2]; k++)
    for (size_t j = from[1]; j <= to[1]; j++) {
      const float *row = brick + (k * width + j) * width;
      for (size_t i = from[0]; i <= to[0]; i++) {
        low = row[i] < low ? row[i] : low;
        high = row[i] > high ? row[i] : high;
      }
    }
  range[0] = low, range[1] = high;
}

void hl_bricks_range(const hl_bricks *bricks, const int64_t first[3], const int64_t last[3], float range[2]) {
  int64_t from[3], to[3], block[3];
  for (int axis = 0; axis < 3; axis++) {
    from[axis] = block_of(bricks, axis, first[axis]);
    to[axis] = block_of(bricks, axis, last[axis]);
  }
  range[0] = INFINITY, range[1] = -INFINITY;
  for (block[2] = from[2]; block[2] <= to[2]; block[2]++)
    for (block[1] = from[1]; block[1] <= to[1]; block[1]++)
      for (block[0] = from[0]; block[0] <= to[0]; block[0]++) {
        const hl_brick_entry *entry = hl_bricks_entry(bricks, block);
        if (entry->slot >= 0) {
          widen_to_brick(bricks, entry, block, first, last, range);
          continue;
        }
        range[0] = fminf(range[0], entry->constant);
        range[1] = fmaxf(range[1], entry->constant);
      }
}

bool hl_bricks_are_finite(const hl_bricks *bricks) {
  size_t entries = bricks->directory_size[0] * bricks->directory_size[1] * bricks->directory_size[2];
  size_t count = bricks->slots * hl_brick_coefficients(bricks);
  bool finite = true;
  for (size_t n = 0; n < entries; n++)
    finite = finite && (bricks->directory[n].slot >= 0 || isfinite(bricks->directory[n].constant));
  for (size_t n = 0; n < count && finite; n++) finite = isfinite(bricks->pool[n]);
  return finite;
}

void hl_bricks_fill_holes(const hl_bricks *bricks, float empty, hl_bricks *filled) {
  size_t entries = bricks->directory_size[0] * bricks->directory_size[1] * bricks->directory_size[2];
  size_t count = bricks->slots * hl_brick_coefficients(bricks);
  hl_brick_entry *directory = filled->directory;
  float *pool = filled->pool;
  *filled = *bricks;
  filled->directory = directory;
  filled->pool = pool;
  for (size_t n = 0; n < entries; n++) {
    directory[n] = bricks->directory[n];
    if (directory[n].slot < 0 && !isfinite(directory[n].constant)) directory[n].constant = empty;
  }
  for (size_t n = 0; n < count; n++) pool[n] = isfinite(bricks->pool[n]) ? bricks->pool[n] : empty;
}

size_t hl_bricks_bytes(const hl_bricks *bricks) {
  size_t entries = bricks->directory_size[0] * bricks->directory_size[1] * bricks->directory_size[2];
  return entries * sizeof *bricks->directory + bricks->slots * hl_brick_coefficients(bricks) * sizeof(float);
}
