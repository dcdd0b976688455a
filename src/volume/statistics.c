/* volume/statistics.c - range, mean, histogram and non-finite count of a volume.
 *
 * u8 and u16 voxels are counted per stored value; all statistics follow from the counts exactly. f32 voxels
 * take one pass for range, sum and finiteness, and one for the histogram. */
#include "volume/statistics.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "core/context.h"
#include "core/memory.h"

enum { LANES = 8 };
enum {
  PIECE = 1 << 22
}; /* voxels between two checks for cancellation: a few milliseconds; a multiple of LANES */

/* The range of stored values; low > high if no voxel is finite. */
typedef struct tally {
  double low, high, sum;
  uint64_t finite;
} tally;

/* Equal bins over [low, high] in data order: a negative value_scale runs them from high to low. */
typedef struct binning {
  double anchor, factor;
} binning;

static binning make_binning(tally total, double value_scale) {
  double width = total.high - total.low;
  if (!(width > 0)) return (binning){total.low, 0};
  return value_scale > 0 ? (binning){total.low, HL_HISTOGRAM_BINS / width}
                         : (binning){total.high, -HL_HISTOGRAM_BINS / width};
}

static int bin_of(binning bins, double stored) {
  int bin = (int)((stored - bins.anchor) * bins.factor);
  return bin < HL_HISTOGRAM_BINS - 1 ? bin : HL_HISTOGRAM_BINS - 1;
}

/* An iteration over the voxels, piece by piece; begins with piece 0. */
typedef struct walk {
  hl_context *context;
  size_t count, first, piece; /* voxels; the current piece is [first, first + piece) */
  bool cancelled;
} walk;

/* Moves to the next piece; false at the end and after cancellation. */
static bool next_piece(walk *w) {
  w->first += w->piece;
  w->piece = w->count - w->first < PIECE ? w->count - w->first : PIECE;
  w->cancelled = w->piece > 0 && hl_cancelled(w->context);
  return w->piece > 0 && !w->cancelled;
}

static void count_u8(const uint8_t *voxels, size_t count, uint64_t *counts) {
  uint64_t lanes[4][256] = {{0}}; /* four tables, so that runs of equal values do not wait for each other */
  size_t n = 0;
  for (; n + 4 <= count; n += 4)
    for (int lane = 0; lane < 4; lane++) lanes[lane][voxels[n + (size_t)lane]]++;
  for (; n < count; n++) lanes[0][voxels[n]]++;
  for (int value = 0; value < 256; value++)
    counts[value] += lanes[0][value] + lanes[1][value] + lanes[2][value] + lanes[3][value];
}

static void count_u16(const uint16_t *voxels, size_t count, uint64_t *counts) {
  for (size_t n = 0; n < count; n++) counts[voxels[n]]++;
}

/* Counts how often each stored value occurs; counts must be zeros before. False: cancelled. */
static bool count_values(const hl_volume *volume, size_t count, uint64_t *counts) {
  walk w = {.context = volume->context, .count = count};
  while (next_piece(&w)) {
    if (volume->storage == HL_STORAGE_U8)
      count_u8((const uint8_t *)volume->voxels + w.first, w.piece, counts);
    else count_u16((const uint16_t *)volume->voxels + w.first, w.piece, counts);
  }
  return !w.cancelled;
}

static tally tally_counts(const uint64_t *counts, int values) {
  tally total = {INFINITY, -INFINITY, 0, 0};
  for (int value = 0; value < values; value++) {
    if (counts[value] == 0) continue;
    if (total.finite == 0) total.low = value;
    total.high = value;
    total.sum += (double)value * (double)counts[value];
    total.finite += counts[value];
  }
  return total;
}

static void bin_counts(const uint64_t *counts, int values, binning bins, uint64_t *histogram) {
  for (int value = 0; value < values; value++)
    if (counts[value] != 0) histogram[bin_of(bins, value)] += counts[value];
}

/* Partial results, one for each remainder of the voxel's index modulo LANES: sums do not wait for one
 * another, and compilers turn them into vectors. */
typedef struct lanes_f32 {
  float low[LANES], high[LANES];
  double sum[LANES];
  uint64_t finite[LANES];
} lanes_f32;

static void tally_group(const float group[LANES], lanes_f32 *lanes) {
  for (int lane = 0; lane < LANES; lane++) {
    float value = group[lane];
    bool is_finite = fabsf(value) <= FLT_MAX;
    float least = is_finite ? value : INFINITY, greatest = is_finite ? value : -INFINITY;
    lanes->low[lane] = least < lanes->low[lane] ? least : lanes->low[lane];
    lanes->high[lane] = greatest > lanes->high[lane] ? greatest : lanes->high[lane];
    lanes->sum[lane] += is_finite ? (double)value : 0.0;
    lanes->finite[lane] += is_finite;
  }
}

static bool tally_f32(const hl_volume *volume, size_t count, tally *total) {
  const float *voxels = volume->voxels;
  lanes_f32 lanes = {.sum = {0}};
  float rest[LANES];
  for (int lane = 0; lane < LANES; lane++) {
    lanes.low[lane] = INFINITY;
    lanes.high[lane] = -INFINITY;
    rest[lane] = NAN;
  }
  size_t whole = count - count % LANES;
  walk w = {.context = volume->context, .count = whole};
  while (next_piece(&w))
    for (size_t start = w.first; start < w.first + w.piece; start += LANES)
      tally_group(voxels + start, &lanes);
  memcpy(rest, voxels + whole, (count - whole) * sizeof *rest);
  tally_group(rest, &lanes);
  *total = (tally){INFINITY, -INFINITY, 0, 0};
  for (int lane = 0; lane < LANES; lane++) {
    total->low = fmin(total->low, (double)lanes.low[lane]);
    total->high = fmax(total->high, (double)lanes.high[lane]);
    total->sum += lanes.sum[lane];
    total->finite += lanes.finite[lane];
  }
  return !w.cancelled;
}

static void bin_f32(const float *voxels, size_t count, binning bins, uint64_t *histogram) {
  uint64_t lanes[4][HL_HISTOGRAM_BINS] = {{0}};
  for (size_t n = 0; n < count; n++)
    if (fabsf(voxels[n]) <= FLT_MAX) lanes[n & 3][bin_of(bins, (double)voxels[n])]++;
  for (int bin = 0; bin < HL_HISTOGRAM_BINS; bin++)
    histogram[bin] += lanes[0][bin] + lanes[1][bin] + lanes[2][bin] + lanes[3][bin];
}

static hl_status record(hl_volume *volume, tally total, const char *subject, hl_error *error) {
  volume->nonfinite_count = hl_volume_voxel_count(volume) - total.finite;
  volume->minimum = volume->maximum = volume->mean = 0;
  if (total.finite == 0) return HL_OK;
  double first = volume->value_scale * total.low + volume->value_offset;
  double last = volume->value_scale * total.high + volume->value_offset;
  volume->minimum = fmin(first, last);
  volume->maximum = fmax(first, last);
  volume->mean = volume->value_scale * (total.sum / (double)total.finite) + volume->value_offset;
  if (!isfinite(volume->maximum - volume->minimum))
    return hl_fail(error, HL_ERROR_INPUT,
                   "%s: values scaled by %g and shifted by %g leave the range of numbers", subject,
                   volume->value_scale, volume->value_offset);
  return HL_OK;
}

static bool measure_f32(hl_volume *volume, size_t count, tally *total) {
  if (!tally_f32(volume, count, total)) return false;
  if (total->finite == 0) return true;
  binning bins = make_binning(*total, volume->value_scale);
  walk w = {.context = volume->context, .count = count};
  while (next_piece(&w)) bin_f32((const float *)volume->voxels + w.first, w.piece, bins, volume->histogram);
  return !w.cancelled;
}

hl_status hl_volume_measure(hl_volume *volume, const char *subject, hl_error *error) {
  size_t count = hl_volume_voxel_count(volume);
  tally total;
  bool finished;
  memset(volume->histogram, 0, sizeof volume->histogram);
  if (volume->storage == HL_STORAGE_F32) {
    finished = measure_f32(volume, count, &total);
  } else {
    int values = volume->storage == HL_STORAGE_U8 ? 256 : 65536;
    uint64_t *counts = hl_allocate_zeroed(volume->context, (size_t)values, sizeof *counts);
    if (counts == NULL) return hl_fail_memory(error, (size_t)values * sizeof *counts, subject);
    finished = count_values(volume, count, counts);
    total = tally_counts(counts, values);
    bin_counts(counts, values, make_binning(total, volume->value_scale), volume->histogram);
    hl_release(volume->context, counts);
  }
  if (!finished) return hl_fail(error, HL_ERROR_CANCELLED, "%s: cancelled", subject);
  return record(volume, total, subject, error);
}
