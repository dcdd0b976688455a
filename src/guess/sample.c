/* guess/sample.c - takes a sorted sample of a volume's voxels, and finds the thresholds and modes of the
 * sample. */
#include "guess/sample.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "core/memory.h"
#include "elementary/elementary.h"

/* An unsigned integer whose order among such integers is the order of the floats. The bits of a negative
 * float are inverted; other floats get the highest bit set. */
static uint32_t key_of(float value) {
  uint32_t bits;
  memcpy(&bits, &value, sizeof bits);
  return bits & 0x80000000u ? ~bits : bits | 0x80000000u;
}

/* One pass of a radix sort by 8 bits. */
static void sort_pass(const float *from, float *to, size_t count, int shift) {
  size_t places[257] = {0};
  for (size_t n = 0; n < count; n++) places[(key_of(from[n]) >> shift & 255) + 1]++;
  for (int digit = 0; digit < 256; digit++) places[digit + 1] += places[digit];
  for (size_t n = 0; n < count; n++) to[places[key_of(from[n]) >> shift & 255]++] = from[n];
}

bool hl_sort(hl_context *context, float *values, size_t count) {
  float *other = hl_allocate(context, count, sizeof *other);
  if (other == NULL) return false;
  for (int shift = 0; shift < 32; shift += 16) {
    sort_pass(values, other, count, shift);
    sort_pass(other, values, count, shift + 8);
  }
  hl_release(context, other);
  return true;
}

/* Collects the finite voxels at every `step`-th place of the allowed range. The first place is half a step
 * inside the grid. */
static size_t collect(const hl_sample *sample, const hl_volume *volume, const size_t low[3],
                      const size_t high[3], size_t step, float *values) {
  size_t count = 0, start[3];
  for (int a = 0; a < 3; a++) start[a] = low[a] + ((high[a] - low[a] > step / 2) ? step / 2 : 0);
  for (size_t k = start[2]; k < high[2]; k += step)
    for (size_t j = start[1]; j < high[1]; j += step)
      for (size_t i = start[0]; i < high[0]; i += step) {
        double value = hl_volume_value_within(volume, i, j, k);
        if (isfinite(value)) values[count++] = (float)((value - sample->low) / sample->range);
      }
  return count;
}

static size_t steps_in(size_t extent, size_t step) { return extent / step + 1; }

static hl_status make_border(const hl_volume *volume, hl_sample *sample, hl_error *error) {
  const size_t *n = volume->dimension;
  size_t step = hl_border_step(n), capacity = 0;
  for (int a = 0; a < 3; a++) capacity += 2 * steps_in(n[(a + 1) % 3], step) * steps_in(n[(a + 2) % 3], step);
  sample->border = hl_allocate(volume->context, capacity, sizeof(float));
  if (sample->border == NULL)
    return hl_fail_memory(error, capacity * sizeof(float), "a volume's border sample");
  for (int a = 0; a < 3; a++)
    for (int side = 0; side < 2; side++) {
      size_t low[3] = {0, 0, 0}, high[3] = {n[0], n[1], n[2]};
      low[a] = side ? n[a] - 1 : 0;
      high[a] = low[a] + 1;
      sample->border_count += collect(sample, volume, low, high, step, sample->border + sample->border_count);
    }
  if (!hl_sort(volume->context, sample->border, sample->border_count))
    return hl_fail_memory(error, sample->border_count * sizeof(float), "a volume's border sample");
  return HL_OK;
}

hl_status hl_sample_make(const hl_volume *volume, hl_sample *sample, hl_error *error) {
  const size_t *n = volume->dimension, low[3] = {0, 0, 0};
  double range = volume->maximum - volume->minimum;
  *sample = (hl_sample){.context = volume->context, .low = volume->minimum, .range = range > 0 ? range : 1};
  sample->step = hl_lattice_step(n, HL_LATTICE_PLACES);
  size_t capacity = steps_in(n[0], sample->step) * steps_in(n[1], sample->step) *
                    steps_in(n[2], sample->step);
  sample->values = hl_allocate(volume->context, capacity, sizeof(float));
  if (sample->values == NULL) return hl_fail_memory(error, capacity * sizeof(float), "a volume's sample");
  sample->count = collect(sample, volume, low, n, sample->step, sample->values);
  hl_status status = hl_sort(volume->context, sample->values, sample->count)
                         ? make_border(volume, sample, error)
                         : hl_fail_memory(error, sample->count * sizeof(float), "a volume's sample");
  if (status != HL_OK) hl_sample_release(sample);
  return status;
}

void hl_sample_release(hl_sample *sample) {
  hl_release(sample->context, sample->values);
  hl_release(sample->context, sample->border);
  *sample = (hl_sample){0};
}

double hl_quantile(const float *ascending, size_t count, double fraction) {
  double place = fraction * (double)(count - 1);
  size_t index = (size_t)place;
  if (index + 1 >= count) return (double)ascending[count - 1];
  double a = (double)ascending[index], b = (double)ascending[index + 1];
  return a + (place - (double)index) * (b - a);
}

double hl_mode(const float *ascending, size_t count) {
  while (count > 2) {
    size_t half = (count + 1) / 2, best = 0;
    float width = INFINITY;
    for (size_t s = 0; s + half <= count; s++)
      if (ascending[s + half - 1] - ascending[s] < width)
        width = ascending[s + half - 1] - ascending[s], best = s;
    ascending += best;
    count = half;
    if (width == 0) break;
  }
  return 0.5 * ((double)ascending[0] + (double)ascending[count - 1]);
}

double hl_threshold_otsu(const float *ascending, size_t count, double above) {
  size_t first = 0;
  while (first < count && (double)ascending[first] <= above) first++;
  double total = 0, sum = 0, best = -1, threshold = above, n = (double)(count - first);
  for (size_t s = first; s < count; s++) total += (double)ascending[s];
  for (size_t s = first; s + 1 < count; s++) {
    sum += (double)ascending[s];
    if (ascending[s] == ascending[s + 1]) continue; /* equal values have no threshold between them */
    double w = (double)(s - first + 1), difference = total * w / n - sum;
    double between = difference * difference / (w * (n - w));
    if (between > best) {
      best = between;
      threshold = 0.5 * ((double)ascending[s] + (double)ascending[s + 1]);
    }
  }
  return threshold;
}

double hl_threshold_cross_entropy(const float *ascending, size_t count, double floor) {
  double total = 0;
  for (size_t s = 0; s < count; s++) total += (double)ascending[s];
  double threshold = total / (double)count;
  for (int round = 0; round < 200; round++) {
    double sum = 0;
    size_t below = 0;
    while (below < count && (double)ascending[below] <= threshold) sum += (double)ascending[below++];
    if (below == 0 || below == count) break;
    double low = fmax(sum / (double)below, floor), high = (total - sum) / (double)(count - below);
    if (!(high > low)) break;
    double next = (high - low) / (hl_ln(high) - hl_ln(low));
    bool settled = fabs(next - threshold) <= 1e-4 * threshold;
    threshold = next;
    if (settled) break;
  }
  return threshold;
}

double hl_roughness(const hl_volume *volume, const hl_sample *sample, double background, double distance) {
  const size_t *n = volume->dimension;
  double second = 0, first = 0, middle = sample->low + background * sample->range,
         far = distance * sample->range;
  for (size_t k = 1; k + 1 < n[2]; k += sample->step)
    for (size_t j = 1; j + 1 < n[1]; j += sample->step)
      for (size_t i = 1; i + 1 < n[0]; i += sample->step) {
        double centre = hl_volume_value_within(volume, i, j, k);
        if (!(fabs(centre - middle) > far)) continue;
        for (int a = 0; a < 3; a++) {
          double before = hl_volume_value_within(volume, i - (a == 0), j - (a == 1), k - (a == 2));
          double after = hl_volume_value_within(volume, i + (a == 0), j + (a == 1), k + (a == 2));
          if (!isfinite(before) || !isfinite(after)) continue;
          second += fabs(before - 2 * centre + after);
          first += fabs(after - before);
        }
      }
  return first > 0 ? second / first : 0;
}

/* The second differences along x of the second differences along y of the second differences along z. NaN if
 * a neighbour is missing. */
static double mixed_difference(const hl_volume *volume, size_t i, size_t j, size_t k) {
  static const double weight[3] = {1, -2, 1};
  double sum = 0;
  for (size_t z = 0; z < 3; z++)
    for (size_t y = 0; y < 3; y++)
      for (size_t x = 0; x < 3; x++)
        sum += weight[x] * weight[y] * weight[z] *
               hl_volume_value_within(volume, i + x - 1, j + y - 1, k + z - 1);
  return sum;
}

hl_status hl_noise(const hl_volume *volume, const hl_sample *sample, double from, double direction,
                   double *noise, hl_error *error) {
  /* Derived: the second difference along all three axes has the weights 1, -2, 1 along each axis. In white
   * noise of standard deviation 1, its standard deviation is therefore sqrt((1 + 4 + 1)^3). The median of its
   * absolute value is 0.6745 times this deviation. */
  static const double scale = 14.6969 * 0.6745, places = 20000;
  const size_t *n = volume->dimension, step = hl_lattice_step(n, places);
  size_t count = 0, capacity = steps_in(n[0], step) * steps_in(n[1], step) * steps_in(n[2], step);
  float *differences = hl_allocate(sample->context, capacity, sizeof *differences);
  if (differences == NULL) return hl_fail_memory(error, capacity * sizeof(float), "a volume's noise");
  for (size_t k = 1; k + 1 < n[2]; k += step)
    for (size_t j = 1; j + 1 < n[1]; j += step)
      for (size_t i = 1; i + 1 < n[0]; i += step) {
        double value = (hl_volume_value_within(volume, i, j, k) - sample->low) / sample->range;
        if (!(direction * (value - from) > 0)) continue;
        double difference = fabs(mixed_difference(volume, i, j, k)) / sample->range;
        if (isfinite(difference)) differences[count++] = (float)difference;
      }
  bool sorted = hl_sort(sample->context, differences, count);
  *noise = sorted && count > 0 ? hl_quantile(differences, count, 0.5) / scale : INFINITY;
  hl_release(sample->context, differences);
  return sorted ? HL_OK : hl_fail_memory(error, capacity * sizeof(float), "a volume's noise");
}
