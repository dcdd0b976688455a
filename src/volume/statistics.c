/* volume/statistics.c - finds range, mean, histogram, non-finite count and percentiles of a volume.
 *
 * Of u8 and u16 voxels, the occurrences of each stored value are counted, from which all statistics follow
 * exactly. f32 voxels take one pass for range, sum and finiteness, and one for the histogram. Percentiles are
 * exact, too. They need the value at a given rank in ascending order. For floats this value is found by
 * counting first the upper halves of the values' bits and then the lower halves. For the file's own numbers
 * (exact.h) there are four such steps of 16 bits. Coefficients of a field in bricks are counted brick by
 * brick, so that a field takes no longer than its bricks, however many voxels it has. */
#include "volume/statistics.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "core/context.h"
#include "core/door.h"
#include "core/memory.h"
#include "volume/counts.h"
#include "volume/exact.h"
#include "volume/in_bricks.h"
#include "volume/store/pages.h"

enum { LANES = 8 };
/* PIECE: number of voxels between two checks for cancellation, which take a few milliseconds to process.
 * COPIED_PIECE: number of voxels that are copied at a time if rows are not adjacent. Both numbers are
 * multiples of LANES. */
enum { PIECE = 1 << 22, COPIED_PIECE = 1 << 16 };

/* Range, sum and number of the finite stored values. If there are none, low is greater than high. */
typedef struct tally {
  double low, high, sum;
  uint64_t finite;
} tally;

/* Maps stored values to bins of equal width over their range. Bins are in the order of the data values: if
 * value_scale is negative, the first bin has the greatest stored values. */
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
  /* the caller may have changed a voxel since the range was found; the voxel may then lie outside the
   * range */
  double place = (stored - bins.anchor) * bins.factor;
  return !(place > 0) ? 0 : place < HL_HISTOGRAM_BINS - 1 ? (int)place : HL_HISTOGRAM_BINS - 1;
}

/* This rank's voxels of a volume over ranks; null for other volumes. Each rank counts its own voxels. Then
 * the counts of all ranks are added up. */
static const hl_own_voxels *own_voxels(const hl_volume *volume) {
  return volume->pages != NULL ? volume->pages->own : NULL;
}

static void sum_counts(const hl_volume *volume, uint64_t *counts, size_t count) {
  if (own_voxels(volume) != NULL) hl_ranks_sum_counts(hl_blocks_ranks(volume->pages->blocks), counts, count);
}

static size_t counted_voxels(const hl_volume *volume) {
  return own_voxels(volume) != NULL ? hl_own_voxels_count(own_voxels(volume)) : hl_volume_voxel_count(volume);
}

/* The state of a loop over all voxels, piece by piece. */
typedef struct walk {
  const hl_volume *volume;
  void *buffer; /* owned by hl_volume_measure(); room for COPIED_PIECE stored values and a row of them; null
                 * if the volume is packed */
  size_t count, first, piece; /* number of all voxels; number of the current piece's first voxel; number of
                               * voxels in this piece */
  const void *voxels;         /* the voxels of the walk's current piece */
  bool has_one_value;         /* whether all voxels of the piece have one value */
  bool cancelled;
} walk;

/* The stored values of `count` voxels from number `first` on ([k][j][i]). Of a packed volume they are its own
 * memory. Otherwise they are copied into buffer, which has room for them and for one more row. */
static const void *piece_of(const hl_volume *volume, size_t first, size_t count, unsigned char *buffer) {
  size_t bytes = hl_storage_bytes(volume->storage), width = volume->dimension[0];
  if (own_voxels(volume) != NULL) {
    hl_own_voxels_run(own_voxels(volume), first, count, buffer);
    return buffer;
  }
  if (hl_volume_is_packed(volume)) return (const unsigned char *)volume->voxels + first * bytes;
  for (size_t done = 0; done < count;) {
    size_t row = (first + done) / width, i = (first + done) % width;
    size_t taken = width - i < count - done ? width - i : count - done;
    const unsigned char *from = hl_volume_row_in(volume, row % volume->dimension[1],
                                                 row / volume->dimension[1], buffer + COPIED_PIECE * bytes);
    memcpy(buffer + done * bytes, from + i * bytes, taken * bytes);
    done += taken;
  }
  return buffer;
}

/* The size of a walk's buffer in bytes. It is also great enough for a row of the file's own numbers. */
static size_t room_of(const hl_volume *volume) {
  size_t stored = (COPIED_PIECE + volume->dimension[0]) * hl_storage_bytes(volume->storage),
         row = hl_volume_row_room(volume);
  return stored > row ? stored : row;
}

/* Moves to the next piece. Returns false at the end and after cancellation. */
static bool next_piece(walk *w) {
  size_t most = w->buffer == NULL ? PIECE : COPIED_PIECE;
  w->first += w->piece;
  w->piece = w->count - w->first < most ? w->count - w->first : most;
  w->cancelled = w->piece > 0 && hl_cancelled(w->volume->context);
  if (w->piece == 0 || w->cancelled) return false;
  /* the buffer holds the piece before this piece. Both pieces have the same content if both have the one
   * value of sparse pages */
  const hl_pages *pages = w->volume->pages;
  const bool had = w->has_one_value;
  w->has_one_value = pages != NULL && hl_pages_have_one_value(pages, w->first, w->piece);
  if (!had || !w->has_one_value) w->voxels = piece_of(w->volume, w->first, w->piece, w->buffer);
  return true;
}

/* Counts how often each stored value occurs. counts: must be zeros before the call. Returns false if the user
 * has cancelled. */
static bool count_values(const hl_volume *volume, void *buffer, uint64_t *counts) {
  walk w = {.volume = volume, .buffer = buffer, .count = counted_voxels(volume)};
  while (next_piece(&w))
    if (w.has_one_value) counts[(size_t)hl_stored_number(volume->storage, w.voxels, 0)] += w.piece;
    else hl_values_count(volume->storage, w.voxels, w.piece, counts);
  if (!w.cancelled) sum_counts(volume, counts, hl_values_of(volume->storage));
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

/* Partial results in lanes. Lane n has the results of voxels n, n + LANES, n + 2 LANES and so on. The sums of
 * different lanes do not depend on each other, so that compilers vectorise them. */
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

/* Joins the tallies of all ranks to one. */
static void join_tallies(const hl_volume *volume, tally *total) {
  if (own_voxels(volume) == NULL) return;
  hl_ranks *ranks = hl_blocks_ranks(volume->pages->blocks);
  tally own = *total, other;
  *total = (tally){INFINITY, -INFINITY, 0, 0};
  for (int rank = 0; rank < ranks->size; rank++) {
    other = own;
    hl_ranks_tell(ranks, &other, sizeof other, rank);
    total->low = fmin(total->low, other.low);
    total->high = fmax(total->high, other.high);
    total->sum += other.sum;
    total->finite += other.finite;
  }
}

static bool tally_f32(const hl_volume *volume, void *buffer, tally *total) {
  lanes_f32 lanes = {.sum = {0}};
  float rest[LANES];
  for (int lane = 0; lane < LANES; lane++) {
    lanes.low[lane] = INFINITY;
    lanes.high[lane] = -INFINITY;
    rest[lane] = NAN;
  }
  walk w = {.volume = volume, .buffer = buffer, .count = counted_voxels(volume)};
  while (next_piece(&w)) {
    const float *voxels = w.voxels;
    size_t whole = w.piece - w.piece % LANES;
    for (size_t start = 0; start < whole; start += LANES) tally_group(voxels + start, &lanes);
    memcpy(rest, voxels + whole, (w.piece - whole) * sizeof *rest); /* only the last piece has a remainder of
                                                                     * voxels */
  }
  tally_group(rest, &lanes);
  *total = (tally){INFINITY, -INFINITY, 0, 0};
  for (int lane = 0; lane < LANES; lane++) {
    total->low = fmin(total->low, (double)lanes.low[lane]);
    total->high = fmax(total->high, (double)lanes.high[lane]);
    total->sum += lanes.sum[lane];
    total->finite += lanes.finite[lane];
  }
  if (!w.cancelled) join_tallies(volume, total);
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
  const double mean = volume->value_scale * (total.sum / (double)total.finite) + volume->value_offset;
  volume->mean = fmin(fmax(mean, volume->minimum), volume->maximum); /* a sum of large numbers was rounded */
  if (!isfinite(volume->maximum - volume->minimum))
    return hl_fail(error, HL_ERROR_INPUT,
                   "%s: values scaled by %g and shifted by %g leave the range of numbers", subject,
                   volume->value_scale, volume->value_offset);
  return HL_OK;
}

/* Returns whether one number of 64 bits is less than another. type: I64 or U64. */
static bool is_less(hl_voxel_type type, uint64_t a, uint64_t b) {
  return type == HL_VOXEL_I64 ? (int64_t)a < (int64_t)b : a < b;
}

/* Widens a range of 64-bit integers so that it holds the numbers of a row. */
static void widen_whole(hl_number_row row, size_t count, uint64_t range[2]) {
  const uint64_t *numbers = row.numbers;
  for (size_t i = 0; i < count; i++) {
    if (is_less(row.type, numbers[i], range[0])) range[0] = numbers[i];
    if (is_less(row.type, range[1], numbers[i])) range[1] = numbers[i];
  }
}

/* Finds range and sum of the file's own numbers, if floats round any of them. Numbers that are infinite as
 * floats do not count. */
static void tally_exact(hl_volume *volume, void *buffer, tally *total) {
  if (!hl_volume_is_exact(volume) || total->finite == 0) return;
  total->low = INFINITY;
  total->high = -INFINITY;
  total->sum = 0;
  for (size_t k = 0; k < volume->dimension[2]; k++)
    for (size_t j = 0; j < volume->dimension[1]; j++) {
      const hl_number_row row = hl_volume_numbers(volume, j, k, buffer);
      if (row.type == HL_VOXEL_I64 || row.type == HL_VOXEL_U64) {
        const uint64_t *numbers = row.numbers;
        if (j == 0 && k == 0) volume->whole_range[0] = volume->whole_range[1] = numbers[0];
        widen_whole(row, volume->dimension[0], volume->whole_range);
      }
      for (size_t i = 0; i < volume->dimension[0]; i++) {
        double number = hl_row_number(row, i);
        if (!isfinite((float)number)) continue;
        total->sum += number;
        if (number < total->low) total->low = number;
        if (number > total->high) total->high = number;
      }
    }
}

static bool measure_f32(hl_volume *volume, void *buffer, tally *total) {
  if (!tally_f32(volume, buffer, total)) return false;
  if (total->finite == 0) return true;
  binning bins = make_binning(*total, volume->value_scale);
  walk w = {.volume = volume, .buffer = buffer, .count = counted_voxels(volume)};
  while (next_piece(&w)) bin_f32(w.voxels, w.piece, bins, volume->histogram);
  if (!w.cancelled) sum_counts(volume, volume->histogram, HL_HISTOGRAM_BINS);
  tally_exact(volume, buffer, total);
  return !w.cancelled;
}

static bool measure_integers(hl_volume *volume, void *buffer, uint64_t *counts, tally *total) {
  int values = (int)hl_values_of(volume->storage);
  bool counted = volume->pages != NULL && hl_pages_take_counts(volume->pages, counts);
  if (!counted && !count_values(volume, buffer, counts)) return false;
  *total = tally_counts(counts, values);
  bin_counts(counts, values, make_binning(*total, volume->value_scale), volume->histogram);
  return true;
}

hl_status hl_volume_measure(hl_volume *volume, const char *subject, hl_error *error) {
  hl_context *context = volume->context;
  bool packed = hl_volume_is_packed(volume), integers = volume->storage != HL_STORAGE_F32;
  size_t values = integers ? hl_values_of(volume->storage) : 1;
  size_t piece = packed ? 0 : room_of(volume);
  uint64_t *counts = hl_allocate_zeroed(context, values, sizeof *counts);
  void *buffer = packed ? NULL : hl_allocate(context, piece, 1);
  if (counts == NULL || (buffer == NULL && !packed)) {
    hl_release(context, counts);
    hl_release(context, buffer);
    return hl_fail_memory(error, values * sizeof *counts + piece, subject);
  }
  memset(volume->histogram, 0, sizeof volume->histogram);
  tally total;
  bool finished = integers ? measure_integers(volume, buffer, counts, &total)
                           : measure_f32(volume, buffer, &total);
  hl_release(context, counts);
  hl_release(context, buffer);
  if (volume->pages != NULL) hl_pages_forget(volume->pages);
  if (!finished) return hl_fail(error, HL_ERROR_CANCELLED, "%s: cancelled", subject);
  return record(volume, total, subject, error);
}

/* ---- percentiles ---- */

enum { HALVES = 65536 };

/* The state of a search for the value at a rank, in ascending order. Each value has a key, an unsigned
 * integer; keys have the same order as the values. Keys are counted by 16 of their bits at a time. */
typedef struct ranking {
  const hl_volume *volume;
  void *buffer;                   /* the buffer of `walk` */
  uint64_t upper[HALVES], finite; /* number of keys for each upper half; number of all keys, one for each
                                   * finite voxel */
  uint64_t lower[HALVES];         /* number of keys for each lower half, of the keys whose upper half is
                                   * `opened` */
  uint32_t opened;                /* the upper half whose lower halves were counted; HALVES if none was
                                   * counted yet */
} ranking;

/* The key of a float. If the float is negative, all of its bits are inverted, else its highest bit is set. */
static uint32_t key_of_f32(float value) {
  uint32_t bits;
  memcpy(&bits, &value, sizeof bits);
  return bits & 0x80000000u ? ~bits : bits | 0x80000000u;
}

static double stored_of_key(const ranking *r, uint32_t key) {
  if (r->volume->storage != HL_STORAGE_F32) return key;
  uint32_t bits = key & 0x80000000u ? key & 0x7fffffffu : ~key;
  float value;
  memcpy(&value, &bits, sizeof value);
  return (double)value;
}

static void count_upper_half(void *data, float value, uint64_t count) {
  ranking *r = data;
  if (fabsf(value) <= FLT_MAX) r->upper[key_of_f32(value) >> 16] += count;
}

static void count_lower_half(void *data, float value, uint64_t count) {
  ranking *r = data;
  const uint32_t key = key_of_f32(value);
  if (key >> 16 == r->opened && fabsf(value) <= FLT_MAX) r->lower[key & 0xffffu] += count;
}

/* Counts the upper halves of the keys of floats. */
static bool count_upper_f32(ranking *r) {
  if (r->volume->bricks != NULL) return hl_volume_visit_bricks(r->volume, count_upper_half, r);
  walk w = {.volume = r->volume, .buffer = r->buffer, .count = counted_voxels(r->volume)};
  while (next_piece(&w))
    for (size_t n = 0; n < w.piece; n++) count_upper_half(r, ((const float *)w.voxels)[n], 1);
  if (!w.cancelled) sum_counts(r->volume, r->upper, HALVES);
  return !w.cancelled;
}

/* Counts the lower halves of the keys of floats whose upper half is `upper`. */
static bool open_upper(ranking *r, uint32_t upper) {
  if (r->opened == upper) return true;
  memset(r->lower, 0, sizeof r->lower);
  r->opened = upper;
  if (r->volume->bricks != NULL) return hl_volume_visit_bricks(r->volume, count_lower_half, r);
  walk w = {.volume = r->volume, .buffer = r->buffer, .count = counted_voxels(r->volume)};
  while (next_piece(&w))
    for (size_t n = 0; n < w.piece; n++) count_lower_half(r, ((const float *)w.voxels)[n], 1);
  if (!w.cancelled) sum_counts(r->volume, r->lower, HALVES);
  return !w.cancelled;
}

/* Finds the entry of `counts` that holds the value at a rank. *rank becomes the rank within this entry. */
static uint32_t place_of(const uint64_t *counts, uint64_t *rank) {
  uint32_t place = 0;
  while (place + 1 < HALVES && *rank >= counts[place]) *rank -= counts[place++];
  return place;
}

/* The key of a double, which is used for the file's own numbers. */
static uint64_t key_of_f64(double value) {
  const uint64_t highest = (uint64_t)1 << 63;
  uint64_t bits;
  memcpy(&bits, &value, sizeof bits);
  return bits & highest ? ~bits : bits | highest;
}

static double number_of_key(uint64_t key) {
  const uint64_t highest = (uint64_t)1 << 63;
  uint64_t bits = key & highest ? key & ~highest : ~key;
  double value;
  memcpy(&value, &bits, sizeof value);
  return value;
}

/* Counts the file's own numbers by 16 bits of their keys. Only keys whose first `known` bits equal `prefix`
 * are counted, by the 16 bits that follow. Numbers that are infinite as floats do not count. */
static bool count_digits(ranking *r, uint64_t prefix, int known) {
  const hl_volume *volume = r->volume;
  memset(r->lower, 0, sizeof r->lower);
  for (size_t k = 0; k < volume->dimension[2]; k++) {
    if (hl_cancelled(volume->context)) return false;
    for (size_t j = 0; j < volume->dimension[1]; j++) {
      const hl_number_row row = hl_volume_numbers(volume, j, k, r->buffer);
      for (size_t i = 0; i < volume->dimension[0]; i++) {
        double number = hl_row_number(row, i);
        uint64_t key = key_of_f64(number);
        if (isfinite((float)number) && (known == 0 || key >> (64 - known) == prefix))
          r->lower[key >> (48 - known) & 0xffffu]++;
      }
    }
  }
  return true;
}

/* Finds the file's own number at a rank, as a double. The rank is the number of finite voxels before it in
 * ascending order. */
static bool number_at(ranking *r, uint64_t rank, double *number) {
  uint64_t key = 0;
  for (int known = 0; known < 64; known += 16) {
    if (!count_digits(r, key, known)) return false;
    key = key << 16 | place_of(r->lower, &rank);
  }
  *number = number_of_key(key);
  return true;
}

/* Finds the number at a rank, which is the number of finite voxels before it in ascending order. The result
 * is the file's own number if the volume keeps these, else the stored value. Returns false if cancelled. */
static bool stored_at(ranking *r, uint64_t rank, double *stored) {
  if (hl_volume_is_exact(r->volume)) return number_at(r, rank, stored);
  uint32_t key = place_of(r->upper, &rank);
  if (r->volume->storage == HL_STORAGE_F32) {
    if (!open_upper(r, key)) return false;
    key = key << 16 | place_of(r->lower, &rank);
  }
  *stored = stored_of_key(r, key);
  return true;
}

/* Finds a percentile: the data value that `percent` of the finite voxels do not exceed, interpolated between
 * the two voxels nearest in order. */
static bool percentile(ranking *r, double percent, double *value) {
  const hl_volume *volume = r->volume;
  *value = 0;
  if (r->finite == 0) return true;
  double fraction = volume->value_scale > 0 ? percent / 100 : 1 - percent / 100, first, next;
  double place = fraction * (double)(r->finite - 1);
  uint64_t rank = (uint64_t)place, after = rank + 1 < r->finite ? rank + 1 : rank;
  if (!stored_at(r, rank, &first) || !stored_at(r, after, &next)) return false;
  double stored = first + (place - (double)rank) * (next - first);
  *value = volume->value_scale * stored + volume->value_offset;
  return true;
}

static bool count_upper(ranking *r) {
  bool finished = r->volume->storage == HL_STORAGE_F32 ? count_upper_f32(r)
                                                       : count_values(r->volume, r->buffer, r->upper);
  for (size_t n = 0; n < HALVES; n++) r->finite += r->upper[n];
  return finished;
}

hl_status hl_volume_percentiles(const hl_volume *volume, const double *percents, size_t count, double *values,
                                hl_error *error) {
  HL_DOOR;
  if (volume == NULL || percents == NULL || values == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_volume_percentiles: null volume, percents or values");
  for (size_t n = 0; n < count; n++)
    if (!(percents[n] >= 0 && percents[n] <= 100))
      return hl_fail(error, HL_ERROR_INPUT, "percentile %.9g is out of range: give 0 to 100", percents[n]);
  hl_context *context = volume->context;
  bool packed = hl_volume_is_packed(volume);
  size_t piece = packed ? 0 : room_of(volume);
  ranking *r = hl_allocate_zeroed(context, 1, sizeof *r);
  void *buffer = packed ? NULL : hl_allocate(context, piece, 1);
  hl_status status = r == NULL || (buffer == NULL && !packed)
                         ? hl_fail_memory(error, sizeof *r + piece, "percentiles of a volume")
                         : HL_OK;
  if (status == HL_OK) {
    r->volume = volume;
    r->buffer = buffer;
    r->opened = HALVES;
    bool finished = count_upper(r);
    for (size_t n = 0; finished && n < count; n++) finished = percentile(r, percents[n], &values[n]);
    if (!finished) status = hl_fail(error, HL_ERROR_CANCELLED, "percentiles: cancelled");
  }
  hl_release(context, buffer);
  hl_release(context, r);
  return status;
}
