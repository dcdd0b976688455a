/* volume/in_bricks.c - see in_bricks.h. */
#include "volume/in_bricks.h"

#include <math.h>
#include <string.h>

#include "bricks/evaluate.h"
#include "core/context.h"
#include "core/door.h"

enum { SHIFT_LEAST = 2, SHIFT_MOST = 8 };

/* ---- checks ---- */

static hl_status check_entries(const hl_bricks *bricks, const char *subject, hl_error *error) {
  size_t count = bricks->directory_size[0] * bricks->directory_size[1] * bricks->directory_size[2];
  for (size_t n = 0; n < count; n++) {
    const hl_brick_entry *entry = &bricks->directory[n];
    if (entry->level < 0 || entry->level >= bricks->levels ||
        (entry->slot >= 0 && (size_t)entry->slot >= bricks->slots))
      return hl_fail(error, HL_ERROR_INPUT, "%s: directory entry %zu: level %d or slot %d does not exist",
                     subject, n, (int)entry->level, (int)entry->slot);
  }
  return HL_OK;
}

hl_status hl_volume_check_bricks(const hl_bricks *bricks, const hl_volume_description *grid,
                                 const char *subject, hl_error *error) {
  if (grid->type != HL_VOXEL_F32 || grid->value_scale != 1 || grid->value_offset != 0)
    return hl_fail(error, HL_ERROR_INPUT,
                   "%s: the voxels of a field in bricks are f32 without scale or offset", subject);
  if (bricks->shift < SHIFT_LEAST || bricks->shift > SHIFT_MOST || bricks->levels < 1 ||
      bricks->levels > BRICK_LEVELS_LIMIT || bricks->directory == NULL ||
      (bricks->slots > 0 && bricks->pool == NULL))
    return hl_fail(error, HL_ERROR_INPUT,
                   "%s: bricks of 2^%d cells at %d levels: give 2^%d to 2^%d, and 1 to %d", subject,
                   bricks->shift, bricks->levels, SHIFT_LEAST, SHIFT_MOST, BRICK_LEVELS_LIMIT);
  for (int axis = 0; axis < 3; axis++) {
    double last = bricks->origin[axis] + (double)grid->dimensions[axis] - 1;
    if (!(bricks->origin[axis] >= 0 && last <= (double)hl_bricks_cells(bricks, axis)))
      return hl_fail(
          error, HL_ERROR_INPUT,
          "%s: voxels from %.9g to %.9g along axis %d leave the bricks' lattice, which ends at %.0f", subject,
          bricks->origin[axis], last, axis, (double)hl_bricks_cells(bricks, axis));
  }
  return check_entries(bricks, subject, error);
}

/* ---- voxels ---- */

/* Returns whether the centres of all voxels are points of the field's lattice. */
static bool stand_on_points(const hl_bricks *bricks) {
  bool whole = true;
  for (int axis = 0; axis < 3; axis++) whole = whole && bricks->origin[axis] == floor(bricks->origin[axis]);
  return whole;
}

float hl_volume_value_of_bricks(const hl_volume *volume, const size_t voxel[3]) {
  const hl_bricks *bricks = volume->bricks;
  int64_t point[3];
  double at[3];
  for (int axis = 0; axis < 3; axis++) {
    at[axis] = (double)voxel[axis] + bricks->origin[axis];
    point[axis] = (int64_t)at[axis];
  }
  return stand_on_points(bricks) ? hl_bricks_coefficient(bricks, point) : (float)hl_bricks_value(bricks, at);
}

void hl_volume_row_of_bricks(const hl_volume *volume, size_t j, size_t k, float *row) {
  enum { RUN = 64 };
  const hl_bricks *bricks = volume->bricks;
  const bool on_points = stand_on_points(bricks);
  const size_t n = volume->dimension[0];
  const double *origin = bricks->origin;
  double run[RUN];
  for (size_t i = 0; i < n; i += RUN) {
    const size_t count = n - i < RUN ? n - i : RUN;
    const double at[3] = {(double)i + origin[0], (double)j + origin[1], (double)k + origin[2]};
    const int64_t first[3] = {(int64_t)at[0], (int64_t)at[1], (int64_t)at[2]};
    if (on_points) hl_bricks_window(bricks, first, (const int64_t[3]){(int64_t)count, 1, 1}, run);
    else hl_bricks_values(bricks, at, count, run);
    for (size_t c = 0; c < count; c++) row[i + c] = (float)run[c];
  }
}

/* ---- statistics ---- */

typedef struct brick_walk {
  const hl_volume *volume;
  hl_coefficient_visit *visit;
  void *data;
} brick_walk;

/* Finds the lattice points of level 0 in the volume's box, along an axis: range[0] to range[1] - 1. */
static void points_in_box(const hl_volume *volume, int axis, int64_t range[2]) {
  double origin = volume->bricks->origin[axis];
  range[0] = (int64_t)ceil(origin - 0.5);
  range[1] = (int64_t)ceil(origin + (double)volume->dimension[axis] - 0.5);
}

/* The number of lattice points along an axis that lie in a cell of a level and in the volume's box. box: from
 * points_in_box(). */
static int64_t share_of(const int64_t box[2], int64_t cell, int level) {
  int64_t first = cell << level, end = (cell + 1) << level;
  if (first < box[0]) first = box[0];
  if (end > box[1]) end = box[1];
  return end > first ? end - first : 0;
}

/* Visits the coefficients of the block's brick. A brick of several blocks is visited only with its first
 * block. A block without a brick has one coefficient, its constant. */
static void visit_block(const brick_walk *walk, const int64_t block[3]) {
  const hl_bricks *bricks = walk->volume->bricks;
  const hl_brick_entry *entry = hl_bricks_entry(bricks, block);
  int level = entry->slot >= 0 ? entry->level : 0;
  int64_t side = (int64_t)1 << bricks->shift, box[3][2], first[3];
  for (int axis = 0; axis < 3; axis++) {
    if ((block[axis] & (((int64_t)1 << level) - 1)) != 0) return;
    first[axis] = block[axis] >> level << bricks->shift;
    points_in_box(walk->volume, axis, box[axis]);
  }
  if (entry->slot < 0) {
    int64_t points = 1;
    for (int axis = 0; axis < 3; axis++) points *= share_of(box[axis], block[axis], bricks->shift);
    if (points > 0) walk->visit(walk->data, entry->constant, (uint64_t)points);
    return;
  }
  size_t width = hl_brick_width(bricks);
  const float *brick = hl_brick_pool(bricks, entry->slot);
  for (int64_t k = 0; k < side; k++)
    for (int64_t j = 0; j < side; j++) {
      const int64_t across = share_of(box[2], first[2] + k, level) * share_of(box[1], first[1] + j, level);
      const float *row = brick + ((size_t)(k + 1) * width + (size_t)(j + 1)) * width + 1;
      for (int64_t i = 0; i < side && across > 0; i++) {
        int64_t points = across * share_of(box[0], first[0] + i, level);
        if (points > 0) walk->visit(walk->data, row[i], (uint64_t)points);
      }
    }
}

bool hl_volume_visit_bricks(const hl_volume *volume, hl_coefficient_visit *visit, void *data) {
  const brick_walk walk = {volume, visit, data};
  int64_t block[3], count[3];
  for (int axis = 0; axis < 3; axis++) count[axis] = (int64_t)volume->bricks->directory_size[axis];
  for (block[2] = 0; block[2] < count[2]; block[2]++) {
    if (hl_cancelled(volume->context)) return false;
    for (block[1] = 0; block[1] < count[1]; block[1]++)
      for (block[0] = 0; block[0] < count[0]; block[0]++) visit_block(&walk, block);
  }
  return true;
}

typedef struct brick_tally {
  double low, high, sum;
  double counted;      /* cells of level 0 */
  double nonfinite;    /* the number of cells of level 0 whose coefficient is not finite */
  uint64_t *histogram; /* [HL_HISTOGRAM_BINS] */
} brick_tally;

static void add_to_range(void *data, float value, uint64_t count) {
  brick_tally *tally = data;
  if (!isfinite(value)) {
    tally->nonfinite += (double)count;
    return;
  }
  tally->low = fmin(tally->low, (double)value);
  tally->high = fmax(tally->high, (double)value);
  tally->sum += (double)value * (double)count;
  tally->counted += (double)count;
}

static void add_to_bin(void *data, float value, uint64_t count) {
  brick_tally *tally = data;
  if (!isfinite(value)) return;
  const double width = tally->high - tally->low;
  const double place = width > 0 ? ((double)value - tally->low) * (HL_HISTOGRAM_BINS / width) : 0;
  tally->histogram[place < HL_HISTOGRAM_BINS - 1 ? (int)place : HL_HISTOGRAM_BINS - 1] += count;
}

hl_status hl_volume_measure_bricks(hl_volume *volume, const char *subject, hl_error *error) {
  brick_tally tally = {.low = INFINITY, .high = -INFINITY, .histogram = volume->histogram};
  memset(volume->histogram, 0, sizeof volume->histogram);
  bool finished = hl_volume_visit_bricks(volume, add_to_range, &tally);
  volume->nonfinite_count = (uint64_t)tally.nonfinite;
  if (finished && tally.counted > 0) finished = hl_volume_visit_bricks(volume, add_to_bin, &tally);
  if (!finished) return hl_fail(error, HL_ERROR_CANCELLED, "%s: cancelled", subject);
  if (!(tally.counted > 0)) return HL_OK;
  volume->minimum = tally.low;
  volume->maximum = tally.high;
  volume->mean = tally.sum / tally.counted;
  return HL_OK;
}

/* ---- how far the field is from its source ---- */

void hl_volume_set_field_error(hl_volume *volume, double value, const char *kind, const char *source) {
  double range = volume->maximum - volume->minimum;
  volume->field_error = (hl_volume_field_error){.struct_size = sizeof volume->field_error,
                                                .value = value,
                                                .of_range = value == 0 ? 0 : value / range,
                                                .kind = kind,
                                                .source = source};
}

hl_status hl_volume_get_field_error(const hl_volume *volume, hl_volume_field_error *field_error) {
  HL_DOOR;
  if (volume == NULL || field_error == NULL || field_error->struct_size != sizeof *field_error ||
      volume->field_error.kind == NULL)
    return HL_ERROR_ARGUMENT;
  *field_error = volume->field_error;
  return HL_OK;
}
