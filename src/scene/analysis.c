/* scene/analysis.c - what kind of data a volume is, and where its things begin.
 *
 * In: a volume. Out: its background, thresholds and kind, all of which scale and shift with the data. The
 * background is what the grid's faces mostly have. From there, along the distance to the background, the
 * threshold of least cross entropy finds where things begin and that of greatest variance between classes
 * where they surely are; smoothness and the shape of the histogram tell simulations, media and scanned things
 * apart.
 */
#include "scene/automatic.h"

#include <math.h>
#include <string.h>

#include "core/context.h"
#include "core/memory.h"
#include "scene/sample.h"

#define BINS 32             /* of the histogram whose shape is looked at */
#define ROUGH 0.65          /* between simulations and turbulence or noise */
#define SMOOTH 0.18         /* smoother than any scanner's pictures */
#define FLOOR 0.002         /* least mean of the background, as a part of top */

typedef struct distances {
  float *values;   /* owned; ascending; [count]; relative */
  size_t count;
} distances;

/* The distances of a sorted sample's values from background, those on the other side as 0. */
static void measure(const float *values, size_t count, double background, double direction, float *distance) {
  for (size_t n = 0; n < count; n++) {
    size_t from = direction > 0 ? n : count - 1 - n;
    distance[n] = (float)fmax(0, direction * ((double)values[from] - background));
  }
}

/* Counts in equal bins over (low, high]; what lies outside is left out. */
static void shape_of(const distances *d, double low, double high, double counts[BINS]) {
  memset(counts, 0, BINS * sizeof *counts);
  for (size_t n = 0; n < d->count; n++) {
    double t = ((double)d->values[n] - low) / (high - low);
    if (t > 0 && t < 1) counts[(int)(t * BINS)]++;
  }
}

/* Does the histogram fall all the way (of pure density) or have peaks (of materials)? Averages of two bins
 * bridge the gaps of quantised data; the last bins hold saturated values, and very few voxels say nothing. */
static bool falls(const distances *d, double low, double high) {
  double counts[BINS], least = INFINITY;
  shape_of(d, low, high, counts);
  for (int bin = 0; bin + 3 < BINS; bin++) {
    double count = counts[bin] + counts[bin + 1];
    if (count > 1.2 * least + 4 * sqrt(least) && count > 1e-4 * (double)d->count) return false;
    least = fmin(least, count);
  }
  return true;
}

/* The part of the sample that has exactly one value, the commonest. */
static double exact_share(const hl_sample *sample, double background) {
  size_t equal = 0;
  for (size_t n = 0; n < sample->count; n++) equal += (double)sample->values[n] == background;
  return (double)equal / (double)sample->count;
}

/* True if the values are finer than steps of an integer: more levels than a byte has. */
static bool is_continuous(const hl_sample *sample) {
  size_t levels = 1;
  for (size_t n = 1; n < sample->count; n++) levels += sample->values[n] != sample->values[n - 1];
  return levels > 256;
}

/* Much of the things has about one value: the body of a cloud. */
static bool has_one_body(const distances *d, double low, double high) {
  double counts[BINS], sum = 0, most = 0;
  shape_of(d, low, high, counts);
  for (int bin = 0; bin < BINS; bin++) {
    sum += counts[bin];
    most = fmax(most, counts[bin]);
  }
  return most > 0.4 * sum;
}

/* Thresholds of one side of the background, relative. */
static void find_thresholds(const distances *d, const float *border, size_t border_count,
                            hl_data_analysis *a) {
  a->top = fmax(hl_quantile(d->values, d->count, 0.9999), 1e-9);
  a->solid = hl_threshold_otsu(d->values, d->count, -1);
  a->faint = fmin(hl_threshold_cross_entropy(d->values, d->count, FLOOR * a->top), a->solid);
  a->dense = hl_threshold_otsu(d->values, d->count, a->solid);
  /* Most of the border is background: things begin above its noise. */
  if (border_count > 0) {
    double middle = hl_quantile(border, border_count, 0.5), upper = hl_quantile(border, border_count, 0.75);
    a->faint = fmax(a->faint, middle + 6 * (upper - middle)); /* 3.5 sigma of one-sided Gaussian noise */
  }
  a->faint = fmin(fmax(a->faint, 0.3 * a->solid), 0.8 * a->solid);
  size_t sure = 0, dense = 0;
  for (size_t n = d->count; n > 0 && (double)d->values[n - 1] > a->solid; n--, sure++)
    dense += (double)d->values[n - 1] > a->dense;
  a->dense_share = sure > 0 ? (double)dense / (double)sure : 1;
  double sum = 0;
  size_t beyond = 0;
  for (size_t n = d->count; n > 0 && (double)d->values[n - 1] > a->faint; n--, beyond++)
    sum += (double)d->values[n - 1];
  a->mean = beyond > 0 ? sum / (double)beyond : a->top;
  a->depth = (double)beyond;
}

static hl_data_kind kind_of(const hl_volume *volume, const hl_sample *sample, const distances *d,
                            const hl_data_analysis *a) {
  double background = a->background;
  double roughness = hl_roughness(volume, sample, background, a->faint);
  bool falling = falls(d, a->faint, a->top);
  if (roughness < ROUGH) return falling || roughness < SMOOTH ? HL_DATA_FIELD : HL_DATA_SURFACES;
  bool fog = exact_share(sample, background) > 0.4 && is_continuous(sample);
  return fog && (falling || has_one_body(d, a->faint, a->top)) ? HL_DATA_MEDIUM : HL_DATA_SURFACES;
}

static hl_status analyse_sample(const hl_volume *volume, const hl_sample *sample, hl_data_analysis *a,
                                hl_error *error) {
  double low = hl_quantile(sample->values, sample->count, 0.001),
         high = hl_quantile(sample->values, sample->count, 0.999);
  bool bordered = sample->border_count > 0; /* else NaNs are the air, and the commonest value has to do */
  a->background =
      bordered ? hl_mode(sample->border, sample->border_count) : hl_mode(sample->values, sample->count);
  if (low == high) low = (double)sample->values[0], high = (double)sample->values[sample->count - 1];
  double below = a->background - low, above = high - a->background;
  a->direction = above >= below ? 1 : -1;
  bool two_sided = fmin(above, below) > 0.25 * fmax(above, below) && fmax(above, below) > 0;
  size_t count = sample->count + sample->border_count;
  float *memory = hl_allocate(volume->context, count, sizeof *memory);
  if (memory == NULL) return hl_fail_memory(error, count * sizeof *memory, "a volume's sample");
  distances d = {memory, sample->count};
  if (two_sided) { /* lobes thin out to both sides; else the mode is a material, and air is low */
    measure(sample->values, sample->count, a->background, -1, d.values);
    bool lobe = falls(&d, 0.02, below);
    measure(sample->values, sample->count, a->background, 1, d.values);
    if (lobe && falls(&d, 0.02, above)) a->kind = HL_DATA_SIGNED;
    else a->background = low, a->direction = 1, two_sided = false;
  }
  if (two_sided) {
    for (size_t n = 0; n < sample->count; n++)
      d.values[n] = (float)fabs((double)sample->values[n] - a->background);
    if (!hl_sort(volume->context, d.values, d.count)) {
      hl_release(volume->context, memory);
      return hl_fail_memory(error, d.count * sizeof(float), "a volume's sample");
    }
    find_thresholds(&d, NULL, 0, a);
  } else {
    measure(sample->values, sample->count, a->background, a->direction, d.values);
    measure(sample->border, sample->border_count, a->background, a->direction, memory + d.count);
    find_thresholds(&d, memory + d.count, sample->border_count, a);
    a->kind = kind_of(volume, sample, &d, a);
  }
  hl_release(volume->context, memory);
  a->depth = cbrt(a->depth / (double)sample->count * (double)hl_volume_voxel_count(volume));
  return HL_OK;
}

hl_status hl_data_analyse(const hl_volume *volume, hl_data_analysis *analysis, hl_error *error) {
  *analysis = (hl_data_analysis){.kind = HL_DATA_CONSTANT, .background = volume->minimum, .direction = 1};
  if (!(volume->maximum > volume->minimum)) return HL_OK;
  hl_sample sample;
  hl_status status = hl_sample_make(volume, &sample, error);
  if (status != HL_OK) return status;
  if (hl_cancelled(volume->context)) {
    hl_sample_release(&sample);
    return hl_fail(error, HL_ERROR_CANCELLED, "cancelled while looking at a volume");
  }
  if (sample.count == 0 || sample.values[0] == sample.values[sample.count - 1]) {
    /* Nothing differs where the lattice is: shown like a constant. */
    hl_sample_release(&sample);
    return HL_OK;
  }
  status = analyse_sample(volume, &sample, analysis, error);
  analysis->background = sample.low + sample.range * analysis->background;
  double *distance[] = {&analysis->faint, &analysis->solid, &analysis->dense, &analysis->top,
                        &analysis->mean};
  for (size_t n = 0; n < sizeof distance / sizeof *distance; n++) *distance[n] *= sample.range;
  hl_sample_release(&sample);
  return status;
}
