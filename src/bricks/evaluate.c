/* bricks/evaluate.c - see evaluate.h. */
#include "bricks/evaluate.h"

#include <math.h>
#include <string.h>

enum { TAPS = 4 };

static int64_t clamp_whole(int64_t at, int64_t low, int64_t high) {
  return at < low ? low : at > high ? high : at;
}

/* The index, along an axis, of the block that holds the cell or the coefficient `at` of level 0. A
 * coefficient beyond the directory's faces belongs to the block at the face. */
static int64_t block_of(const hl_bricks *bricks, int axis, int64_t at) {
  return clamp_whole(at, 0, hl_bricks_cells(bricks, axis) - 1) >> bricks->shift;
}

/* Four coefficients along an axis of a brick, and their weights. The first coefficient that the brick stores
 * has the index 0. */
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

/* Finds the weights of a level's coefficients in the sum that gives one point's coefficient of level 0.
 *
 * One step from a level to the next finer one gives the coefficients (d[j-1] + 6 d[j] + d[j+1]) / 8 at the
 * even index 2 j, and (d[j] + d[j+1]) / 2 at the odd index 2 j + 1 (E. Catmull, J. Clark, Recursively
 * generated B-spline surfaces, 1978). This is the mask (1 + z)^4 / 8. The product of the masks of all levels
 * is ((1 - z^n) / (1 - z))^4 / n^3, where n = 2^level. In this product, z^m has the coefficient sum over j of
 * (-1)^j C(4, j) C(m - j n + 3, 3) / n^3.
 *
 * Let the point lie r points of level 0 behind a coefficient of the level, and s = n - r before the next one.
 * Then the weights are the product's coefficients at m = r - 2, r + n - 2, s - 2 and s + n - 2, so four taps
 * suffice (derived). The numerators are whole numbers, so the weights are exact. */
static void weigh_subdivided(int level, int64_t point, double weight[TAPS]) {
  const int64_t n = (int64_t)1 << level, r = point & (n - 1), s = n - r;
  const double scale = ldexp(1, -3 * level);
  const int64_t far_r = (r + 1) * r * (r - 1) / 6, near_r = (r + n + 1) * (r + n) * (r + n - 1) / 6,
                far_s = (s + 1) * s * (s - 1) / 6, near_s = (s + n + 1) * (s + n) * (s + n - 1) / 6;
  weight[0] = (double)far_s * scale;
  weight[1] = (double)(near_s - 4 * far_s) * scale;
  weight[2] = (double)(near_r - 4 * far_r) * scale;
  weight[3] = (double)far_r * scale;
}

/* ---- coefficients of level 0 ---- */

/* RUN: the most points along an axis that are computed together. SPAN: the most coefficients along an axis on
 * which RUN points depend; level 1 needs the most. */
enum { RUN = 8, SPAN = RUN / 2 + TAPS };

/* A box of points of level 0 whose coefficients come from one brick. */
typedef struct piece {
  int64_t first[3], count[3]; /* count: 1 .. RUN */
  double *values;             /* the place of the first point's value */
  int64_t row, slice;         /* distances in `values` from row to row, and from slice to slice */
} piece;

static int64_t clamp_point(const hl_bricks *bricks, int axis, int64_t at) {
  return clamp_whole(at, -1, hl_bricks_cells(bricks, axis) + 1);
}

/* The number of points along an axis, from `at` on, that lie in one block; at most RUN. left: the number of
 * points that are wanted. */
static int64_t run_length(const hl_bricks *bricks, int axis, int64_t at, int64_t left) {
  const int64_t block = block_of(bricks, axis, at), end = (block + 1) << bricks->shift;
  if (left > RUN) left = RUN;
  return end < hl_bricks_cells(bricks, axis) && end - at < left ? end - at : left;
}

static void fill_constant(const piece *piece, double value) {
  for (int64_t k = 0; k < piece->count[2]; k++)
    for (int64_t j = 0; j < piece->count[1]; j++)
      for (int64_t i = 0; i < piece->count[0]; i++)
        piece->values[k * piece->slice + j * piece->row + i] = value;
}

/* Copies coefficients from a brick of level 0. */
static void copy_piece(const hl_bricks *bricks, const float *brick, const int64_t block[3],
                       const piece *piece) {
  size_t width = hl_brick_width(bricks), place[3][RUN];
  for (int axis = 0; axis < 3; axis++)
    for (int64_t n = 0; n < piece->count[axis]; n++)
      place[axis][n] = (size_t)(clamp_point(bricks, axis, piece->first[axis] + n) -
                                (block[axis] << bricks->shift) + 1);
  for (int64_t k = 0; k < piece->count[2]; k++)
    for (int64_t j = 0; j < piece->count[1]; j++) {
      const float *row = brick + (place[2][k] * width + place[1][j]) * width;
      for (int64_t i = 0; i < piece->count[0]; i++)
        piece->values[k * piece->slice + j * piece->row + i] = (double)row[place[0][i]];
    }
}

/* Sums a brick's coefficients along x. The rows have y from low[1] to high[1] and z from low[2] to high[2].
 * Each row has one sum for each point of the piece along x. */
static void sum_rows(const hl_bricks *bricks, const float *brick, const piece *piece, taps at[3][RUN],
                     const int64_t low[3], const int64_t high[3], double sums[SPAN][SPAN][RUN]) {
  size_t width = hl_brick_width(bricks);
  for (int64_t k = low[2]; k <= high[2]; k++)
    for (int64_t j = low[1]; j <= high[1]; j++) {
      const float *row = brick + ((size_t)k * width + (size_t)j) * width;
      for (int64_t n = 0; n < piece->count[0]; n++) {
        double along = 0;
        for (int i = 0; i < TAPS; i++)
          if (at[0][n].weight[i] != 0) along += at[0][n].weight[i] * (double)row[at[0][n].index[i]];
        sums[k - low[2]][j - low[1]][n] = along;
      }
    }
}

/* Computes a piece's coefficients by subdividing a brick of a coarser level. Neighbouring points use the same
 * sums of rows. Each result has the same bits as if its point were computed alone; it is rounded to a float,
 * as coefficients in bricks of level 0 are. */
static void subdivide_piece(const hl_bricks *bricks, const hl_brick_entry *entry, const int64_t block[3],
                            const piece *piece) {
  double sums[SPAN][SPAN][RUN];
  int64_t low[3], high[3];
  taps at[3][RUN];
  for (int axis = 0; axis < 3; axis++) {
    for (int64_t n = 0; n < piece->count[axis]; n++) {
      const int64_t point = clamp_point(bricks, axis, piece->first[axis] + n);
      weigh_subdivided(entry->level, point, at[axis][n].weight);
      place_taps(bricks, entry->level, block[axis], point >> entry->level, &at[axis][n]);
    }
    low[axis] = at[axis][0].index[0];
    high[axis] = at[axis][piece->count[axis] - 1].index[TAPS - 1];
  }
  sum_rows(bricks, hl_brick_pool(bricks, entry->slot), piece, at, low, high, sums);
  for (int64_t z = 0; z < piece->count[2]; z++)
    for (int64_t y = 0; y < piece->count[1]; y++) {
      double *values = piece->values + z * piece->slice + y * piece->row, total[RUN] = {0};
      for (int n = 0; n < TAPS * TAPS; n++) {
        const int k = n / TAPS, j = n % TAPS;
        const double weight = at[2][z].weight[k] * at[1][y].weight[j];
        const double *sum = sums[at[2][z].index[k] - low[2]][at[1][y].index[j] - low[1]];
        for (int64_t x = 0; x < piece->count[0] && weight != 0; x++) total[x] += weight * sum[x];
      }
      for (int64_t x = 0; x < piece->count[0]; x++) values[x] = (double)(float)total[x];
    }
}

static void fill_piece(const hl_bricks *bricks, const piece *piece) {
  int64_t block[3];
  for (int axis = 0; axis < 3; axis++) block[axis] = block_of(bricks, axis, piece->first[axis]);
  const hl_brick_entry *entry = hl_bricks_entry(bricks, block);
  if (entry->slot < 0) fill_constant(piece, (double)entry->constant);
  else if (entry->level == 0) copy_piece(bricks, hl_brick_pool(bricks, entry->slot), block, piece);
  else subdivide_piece(bricks, entry, block, piece);
}

void hl_bricks_window(const hl_bricks *bricks, const int64_t first[3], const int64_t count[3],
                      double *values) {
  piece p = {.row = count[0], .slice = count[0] * count[1]};
  for (int64_t z = 0; z < count[2]; z += p.count[2]) {
    p.first[2] = first[2] + z;
    p.count[2] = run_length(bricks, 2, p.first[2], count[2] - z);
    for (int64_t y = 0; y < count[1]; y += p.count[1]) {
      p.first[1] = first[1] + y;
      p.count[1] = run_length(bricks, 1, p.first[1], count[1] - y);
      for (int64_t x = 0; x < count[0]; x += p.count[0]) {
        p.first[0] = first[0] + x;
        p.count[0] = run_length(bricks, 0, p.first[0], count[0] - x);
        p.values = values + z * p.slice + y * p.row + x;
        fill_piece(bricks, &p);
      }
    }
  }
}

float hl_bricks_coefficient(const hl_bricks *bricks, const int64_t point[3]) {
  double value;
  hl_bricks_window(bricks, point, (const int64_t[3]){1, 1, 1}, &value);
  return (float)value;
}

/* ---- values ---- */

/* Sums of a brick's coefficients over y and z, with the weights there, for the taps along x. */
typedef struct tap_columns {
  int32_t slot; /* the brick; -1: none yet */
  taps at[3];
  int64_t index[TAPS]; /* the coefficients' indices along x; -1: no sum yet */
  double sum[TAPS];
} tap_columns;

/* Taps of weight 0 are left out of the sum, because their coefficients may be NaN. */
static double sum_column(const hl_bricks *bricks, const taps at[3], const float *column) {
  size_t width = hl_brick_width(bricks);
  double sum = 0;
  for (int k = 0; k < TAPS; k++)
    for (int j = 0; j < TAPS; j++) {
      const double weight = at[2].weight[k] * at[1].weight[j];
      if (weight != 0)
        sum += weight * (double)column[((size_t)at[2].index[k] * width + (size_t)at[1].index[j]) * width];
    }
  return sum;
}

/* Finds the sums for the taps along x. Those that are known are kept. */
static void move_columns(const hl_bricks *bricks, tap_columns *columns) {
  const int64_t *wanted = columns->at[0].index;
  const float *brick = hl_brick_pool(bricks, columns->slot);
  int64_t index[TAPS];
  double sum[TAPS];
  if (memcmp(columns->index, wanted, sizeof index) == 0) return;
  memcpy(index, columns->index, sizeof index);
  memcpy(sum, columns->sum, sizeof sum);
  memcpy(columns->index, wanted, sizeof index);
  for (int i = 0; i < TAPS; i++) {
    int known = 0;
    while (known < TAPS && index[known] != wanted[i]) known++;
    columns->sum[i] = known < TAPS ? sum[known] : sum_column(bricks, columns->at, brick + wanted[i]);
  }
}

/* Places the taps along an axis for a point within the directory. */
static void place_point(const hl_bricks *bricks, int level, int64_t block, double point, taps *found) {
  const double place = point * (1.0 / (double)((int64_t)1 << level));
  const int64_t end = ((block >> level) + 1) << bricks->shift;
  int64_t before = (int64_t)place;
  if (before >= end) before = end - 1;
  hl_bspline_weights(place - (double)before, found->weight);
  place_taps(bricks, level, block, before, found);
}

void hl_bricks_values(const hl_bricks *bricks, const double point[3], size_t count, double *values) {
  tap_columns columns = {.slot = -1};
  for (size_t n = 0; n < count; n++) {
    int64_t block[3];
    double at[3];
    for (int axis = 0; axis < 3; axis++) {
      const double most = (double)hl_bricks_cells(bricks, axis),
                   wanted = point[axis] + (axis == 0 ? (double)n : 0);
      at[axis] = !(wanted > 0) ? 0 : wanted < most ? wanted : most;
      block[axis] = block_of(bricks, axis, (int64_t)at[axis]);
    }
    const hl_brick_entry *entry = hl_bricks_entry(bricks, block);
    values[n] = (double)entry->constant;
    if (entry->slot < 0) continue;
    if (columns.slot != entry->slot) {
      columns = (tap_columns){.slot = entry->slot, .index = {-1, -1, -1, -1}};
      for (int axis = 1; axis < 3; axis++)
        place_point(bricks, entry->level, block[axis], at[axis], &columns.at[axis]);
    }
    place_point(bricks, entry->level, block[0], at[0], &columns.at[0]);
    move_columns(bricks, &columns);
    values[n] = 0;
    for (int i = 0; i < TAPS; i++)
      if (columns.at[0].weight[i] != 0) values[n] += columns.at[0].weight[i] * columns.sum[i];
  }
}

double hl_bricks_value(const hl_bricks *bricks, const double point[3]) {
  double value;
  hl_bricks_values(bricks, point, 1, &value);
  return value;
}

/* Widens a range so that it holds the coefficients of a brick on which the cells first .. last of level 0
 * depend. */
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

/* ---- ranges of a row of boxes ---- */

/* Finds the level of the finest brick that a box touches. The first and the last cell of the box may move
 * within their cells of this level without a change of the box's range, because each cell of this level lies
 * in one brick. Constants may end with each block. */
static int level_of_box(const hl_bricks *bricks, const int64_t first[3], const int64_t last[3]) {
  int64_t from[3], to[3], block[3];
  int level = BRICK_LEVELS_LIMIT;
  for (int axis = 0; axis < 3; axis++) {
    from[axis] = block_of(bricks, axis, first[axis]);
    to[axis] = block_of(bricks, axis, last[axis]);
  }
  for (block[2] = from[2]; block[2] <= to[2]; block[2]++)
    for (block[1] = from[1]; block[1] <= to[1]; block[1]++)
      for (block[0] = from[0]; block[0] <= to[0]; block[0]++) {
        const hl_brick_entry *entry = hl_bricks_entry(bricks, block);
        const int own = entry->slot >= 0 ? entry->level : bricks->shift;
        level = own < level ? own : level;
      }
  return level;
}

/* Finds how far a box may grow along an axis: the last cell of the greatest box whose first and last cell lie
 * in the same cells of a level as those of the given box. */
static int64_t farthest_last(int64_t first, int64_t last, int level) {
  const int64_t size = (int64_t)1 << level, left = size - 1 - (first & (size - 1)),
                further = size - 1 - (last & (size - 1));
  return last + (left < further ? left : further);
}

void hl_bricks_ranges(const hl_bricks *bricks, const int64_t first[3], const int64_t last[3], int64_t step,
                      size_t count, hl_bricks_row *row) {
  for (size_t n = 0; n < count; n += row->boxes[n]) {
    if (row->boxes[n] > 0 && last[1] <= row->until[n]) continue;
    const int64_t along = (int64_t)n * step, low[3] = {first[0] + along, first[1], first[2]},
                  high[3] = {last[0] + along, last[1], last[2]};
    const int level = level_of_box(bricks, low, high);
    size_t boxes = 1 + (size_t)((farthest_last(low[0], high[0], level) - high[0]) / step);
    if (boxes > count - n) boxes = count - n;
    hl_bricks_range(bricks, low, high, row->ranges[n]);
    for (size_t m = n + 1; m < n + boxes; m++) {
      memcpy(row->ranges[m], row->ranges[n], sizeof row->ranges[m]);
      row->boxes[m] = 0;
    }
    row->boxes[n] = boxes;
    row->until[n] = farthest_last(low[1], high[1], level);
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
