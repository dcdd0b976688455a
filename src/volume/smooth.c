/* volume/smooth.c - convolves a volume with a Gaussian (smooth.h) in three passes over a block of floats, one
 * pass along each axis. */
#include "volume/smooth.h"

#include <math.h>
#include <string.h>

#include "core/context.h"
#include "core/memory.h"
#include "elementary/elementary.h"

/* The weights of a Gaussian, exp(-d^2 / (2 sigma^2)), at whole distances d up to three standard deviations.
 * The weights of all distances, on both sides, add up to 1. */
enum { LONGEST = 64 };
typedef struct gaussian {
  int radius;
  float weight[LONGEST + 1]; /* weight at each distance in voxels */
} gaussian;

static gaussian make_gaussian(double sigma) {
  gaussian made = {.radius = (int)fmin(ceil(3 * sigma), LONGEST)};
  double weight[LONGEST + 1], sum = 0;
  for (int d = 0; d <= made.radius; d++) {
    weight[d] = hl_exp(-0.5 * d * d / (sigma * sigma));
    sum += d == 0 ? weight[d] : 2 * weight[d];
  }
  for (int d = 0; d <= made.radius; d++) made.weight[d] = (float)(weight[d] / sum);
  return made;
}

/* Convolves `count` lines at once. A line has `length` numbers, and number n of all lines is a block of
 * `count` adjacent numbers; these blocks are `step` apart. Numbers beyond a line's ends equal the line's
 * first or last number. line: scratch memory, [length][count]. */
static void convolve_lines(const gaussian *kernel, float *numbers, size_t length, size_t step, size_t count,
                           float *line) {
  for (size_t n = 0; n < length; n++) memcpy(line + n * count, numbers + n * step, count * sizeof *line);
  for (size_t n = 0; n < length; n++) {
    float *out = numbers + n * step;
    for (size_t c = 0; c < count; c++) out[c] = kernel->weight[0] * line[n * count + c];
    for (int d = 1; d <= kernel->radius; d++) {
      const float *before = line + (n < (size_t)d ? 0 : n - (size_t)d) * count,
                  *after = line + (n + (size_t)d < length ? n + (size_t)d : length - 1) * count;
      for (size_t c = 0; c < count; c++) out[c] += kernel->weight[d] * (before[c] + after[c]);
    }
  }
}

/* Convolves a row of numbers along x. line: scratch memory, [length + 2 LONGEST]. */
static void convolve_row(const gaussian *kernel, float *numbers, size_t length, float *line) {
  float *middle = line + LONGEST;
  memcpy(middle, numbers, length * sizeof *line);
  for (int d = 1; d <= kernel->radius; d++) {
    middle[-d] = numbers[0];
    middle[length + (size_t)d - 1] = numbers[length - 1];
  }
  for (size_t n = 0; n < length; n++) numbers[n] = kernel->weight[0] * middle[n];
  for (int d = 1; d <= kernel->radius; d++) {
    const float *before = middle - d, *after = middle + d;
    for (size_t n = 0; n < length; n++) numbers[n] += kernel->weight[d] * (before[n] + after[n]);
  }
}

/* Convolves a block of numbers along i, j and k. Returns false if the user has cancelled. */
static bool convolve(hl_context *context, const gaussian *kernel, const size_t dimension[3], float *numbers,
                     float *line) {
  const size_t row = dimension[0], slice = row * dimension[1];
  for (size_t k = 0; k < dimension[2]; k++) {
    if (hl_cancelled(context)) return false;
    for (size_t j = 0; j < dimension[1]; j++) convolve_row(kernel, numbers + k * slice + j * row, row, line);
    convolve_lines(kernel, numbers + k * slice, dimension[1], row, row, line);
  }
  for (size_t j = 0; j < dimension[1]; j++) {
    if (hl_cancelled(context)) return false;
    convolve_lines(kernel, numbers + j * row, dimension[2], slice, row, line);
  }
  return true;
}

/* Copies the volume's data values as floats, with 0 in place of values that are not finite. finite: set to 0
 * for these values and to 1 for all others. line: scratch memory for a row of voxels. */
static void take_values(const hl_volume *volume, float *line, float *values, float *finite) {
  const size_t row = volume->dimension[0];
  for (size_t k = 0, n = 0; k < volume->dimension[2]; k++)
    for (size_t j = 0; j < volume->dimension[1]; j++, n += row) {
      const void *stored = hl_volume_row_in(volume, j, k, line);
      for (size_t i = 0; i < row; i++) {
        double value = volume->value_scale * hl_stored_number(volume->storage, stored, i) +
                       volume->value_offset;
        bool good = isfinite(value);
        values[n + i] = good ? (float)value : 0;
        if (finite != NULL) finite[n + i] = good;
      }
    }
}

/* Corrects smoothed values for voxels that are not finite: divides each value by the sum of the weights of
 * the finite voxels in it. Voxels that are not finite become NAN. share: for each voxel, the sum of the
 * weights of finite voxels. */
static void weigh(const hl_volume *volume, float *line, float *values, const float *share) {
  const size_t row = volume->dimension[0];
  for (size_t k = 0, n = 0; k < volume->dimension[2]; k++)
    for (size_t j = 0; j < volume->dimension[1]; j++, n += row) {
      const void *stored = hl_volume_row_in(volume, j, k, line);
      for (size_t i = 0; i < row; i++)
        values[n + i] = isfinite(hl_stored_number(volume->storage, stored, i)) ? values[n + i] / share[n + i]
                                                                               : NAN;
    }
}

/* Converts values in place to whole numbers of 16 bits, and sets type, scale and offset in the description,
 * so that value = scale * number + offset. If all values are equal, values and description are not
 * changed. */
static void store_in_16_bits(float *values, size_t count, hl_volume_description *description) {
  float low = values[0], high = values[0];
  uint16_t *numbers = (uint16_t *)(void *)values;
  for (size_t n = 0; n < count; n++) {
    low = values[n] < low ? values[n] : low;
    high = values[n] > high ? values[n] : high;
  }
  if (!(high > low)) return;
  const float scale = UINT16_MAX / (high - low);
  for (size_t n = 0; n < count; n++) {
    const float number = (values[n] - low) * scale + 0.5f;
    numbers[n] = (uint16_t)(number < UINT16_MAX ? number : UINT16_MAX);
  }
  description->type = HL_VOXEL_U16;
  description->value_scale = ((double)high - (double)low) / UINT16_MAX;
  description->value_offset = low;
}

/* Makes a volume of the smoothed values, with the grid of the original volume. If the original voxels are
 * stored as integers, the smoothed values are stored in 16 bits, which are exact enough and save memory and
 * time.
 */
static hl_status adopt(const hl_volume *volume, float *values, hl_volume **smoothed, hl_error *error) {
  const size_t count = hl_volume_voxel_count(volume);
  hl_volume_description d = hl_volume_own_grid(volume);
  d.type = HL_VOXEL_F32;
  if (volume->storage != HL_STORAGE_F32) store_in_16_bits(values, count, &d);
  if (d.type == HL_VOXEL_U16) {
    void *shorter = hl_reallocate(volume->context, values, count, sizeof(uint16_t));
    if (shorter == NULL) {
      hl_release(volume->context, values);
      return hl_fail_memory(error, count * sizeof(uint16_t), "smoothed voxels");
    }
    values = shorter;
  }
  hl_status status = hl_volume_adopt(volume->context, &d, "smoothed voxels", values, smoothed, error);
  if (status == HL_OK) status = hl_volume_take_about(*smoothed, volume, error);
  if (status != HL_OK) {
    hl_volume_release(*smoothed);
    *smoothed = NULL;
  }
  return status;
}

/* The number of floats of scratch memory for the longest lines that are convolved at once. */
static size_t line_length(const hl_volume *volume) {
  const size_t *n = volume->dimension;
  return n[0] * (n[1] > n[2] ? n[1] : n[2]) + 2 * LONGEST;
}

uint64_t hl_volume_convolve_bytes(const hl_volume *volume) {
  const uint64_t count = hl_volume_voxel_count(volume), values = count * sizeof(float),
                 finite = volume->nonfinite_count > 0 ? values : 0,
                 line = (uint64_t)line_length(volume) * sizeof(float),
                 shorter = volume->storage != HL_STORAGE_F32 ? count * sizeof(uint16_t) : 0;
  return values + (finite + line > shorter ? finite + line : shorter);
}

hl_status hl_volume_convolve(const hl_volume *volume, double sigma, hl_volume **smoothed, hl_error *error) {
  hl_context *context = volume->context;
  const gaussian kernel = make_gaussian(sigma);
  const size_t count = hl_volume_voxel_count(volume);
  const bool holes = volume->nonfinite_count > 0;
  float *values = hl_allocate(context, count, sizeof *values);
  float *finite = holes ? hl_allocate(context, count, sizeof *finite) : NULL;
  float *line = hl_allocate(context, line_length(volume), sizeof *line);
  bool whole = values != NULL && line != NULL && (!holes || finite != NULL);
  hl_status status = whole ? HL_OK : hl_fail_memory(error, count * sizeof *values, "smoothed voxels");
  if (whole) {
    take_values(volume, line, values, finite);
    if (!convolve(context, &kernel, volume->dimension, values, line) ||
        (holes && !convolve(context, &kernel, volume->dimension, finite, line)))
      status = hl_fail(error, HL_ERROR_CANCELLED, "cancelled while voxels were smoothed");
  }
  if (status == HL_OK && holes) weigh(volume, line, values, finite);
  hl_release(context, finite);
  hl_release(context, line);
  if (status == HL_OK) return adopt(volume, values, smoothed, error);
  hl_release(context, values);
  return status;
}
