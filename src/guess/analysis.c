/* guess/analysis.c - what kind of data a volume is, and where its things begin.
 *
 * In: a volume. Out: its background, thresholds and kind, all of which scale and shift with the data. The
 * background is what the grid's faces mostly have. From there, along the distance to the background, the
 * threshold of least cross entropy finds where things begin and that of greatest variance between classes
 * where they surely are; smoothness and the shape of the histogram tell simulations, media and scanned things
 * apart; labels are found by scene/labels.c.
 */
#include "guess/analysis.h"

#include <math.h>
#include <string.h>

#include "core/context.h"
#include "core/memory.h"
#include "guess/sample.h"

#define BINS   32    /* of the histogram whose shape is looked at */
#define ROUGH  0.65  /* between simulations and turbulence or noise */
#define SMOOTH 0.18  /* smoother than any scanner's pictures */
#define FOG    0.4   /* least roughness of smoke on fine grids (made of 200 to 320 voxels: 0.50 to 0.58) */
#define NOISY  1.2   /* rougher than a simulation's turbulence; white noise has 1.7 */
#define TAIL   0.005 /* part of the voxels beyond a flow's ends */
#define FLOOR  0.002 /* least mean of the background, as a part of top */

typedef struct distances {
  float *values; /* owned; ascending; [count]; relative */
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
  a->filled = (double)sure / (double)d->count;
  a->mean = beyond > 0 ? sum / (double)beyond : a->top;
  a->depth = (double)beyond;
}

/* Much of the border is not the background: the grid lies within its matter. */
static bool fills_grid(const hl_sample *sample, double background, double range) {
  size_t near = 0;
  for (size_t n = 0; n < sample->border_count; n++)
    near += fabs((double)sample->border[n] - background) < 0.05 * range;
  return sample->border_count > 0 && (double)near < 0.7 * (double)sample->border_count;
}

static bool is_floating(const hl_volume *volume) {
  return volume->type == HL_VOXEL_F32 || volume->type == HL_VOXEL_F64;
}

/* What a volume's values are, relative as the sample's. */
typedef struct spread {
  double low, high;  /* hardly any voxel is beyond */
  double zero;       /* the data value 0 */
  bool fills, signs; /* no air around; clearly on both sides of the data value 0 */
} spread;

static spread spread_of(const hl_sample *sample, double background) {
  spread s = {.low = hl_quantile(sample->values, sample->count, 0.001),
              .high = hl_quantile(sample->values, sample->count, 0.999),
              .zero = -sample->low / sample->range};
  if (s.low == s.high) s.low = (double)sample->values[0], s.high = (double)sample->values[sample->count - 1];
  double above = s.high - s.zero, below = s.zero - s.low;
  s.fills = fills_grid(sample, background, s.high - s.low);
  s.signs = fmin(above, below) > 0.25 * fmax(above, below) && below > 0 && above > 0;
  return s;
}

/* A scanner's values have noise and peaks; a flow's are smooth, or rough with one peak. distance has room for
 * the sample. */
static bool is_flow(const hl_volume *volume, const hl_sample *sample, const spread *s, double mode,
                    float *distance) {
  if (!s->fills || !is_floating(volume) || !is_continuous(sample)) return false;
  double roughness = hl_roughness(volume, sample, mode, 0);
  if (roughness < ROUGH) return true;
  distances d = {distance, sample->count};
  measure(sample->values, sample->count, mode, -1, distance);
  bool one_peak = falls(&d, 0.02, fmax(mode - s->low, 0.03));
  measure(sample->values, sample->count, mode, 1, distance);
  return roughness < NOISY && one_peak && falls(&d, 0.02, fmax(s->high - mode, 0.03));
}

/* A good part of the things has the greatest value of all: the inside of a solid shape. */
static bool is_filled_up(const distances *d, const hl_data_analysis *a) {
  size_t things = 0, greatest = 0;
  for (size_t n = d->count; n > 0 && (double)d->values[n - 1] > a->solid; n--, things++)
    greatest += (double)d->values[n - 1] > 0.999 * (double)d->values[d->count - 1];
  return (double)greatest > 0.3 * (double)things;
}

static hl_data_kind kind_of(const hl_volume *volume, const hl_sample *sample, const distances *d,
                            const hl_data_analysis *a) {
  double roughness = hl_roughness(volume, sample, a->background, a->faint);
  bool falling = falls(d, a->faint, a->top);
  if (roughness < ROUGH && is_filled_up(d, a)) return HL_DATA_SURFACES;
  bool fog = a->zeroed > 0.4 && is_continuous(sample); /* exactly nothing around it */
  if (roughness < ROUGH && roughness > FOG && fog && falling) return HL_DATA_MEDIUM;
  if (roughness < ROUGH) return falling || roughness < SMOOTH ? HL_DATA_FIELD : HL_DATA_SURFACES;
  return fog && (falling || has_one_body(d, a->faint, a->top)) ? HL_DATA_MEDIUM : HL_DATA_SURFACES;
}

/* Lobes that thin out to both sides of the background; else the mode is a material, and air is low. Lobes
 * about the data value 0 need not thin out. */
static bool has_lobes(const hl_sample *sample, const spread *s, double background, float *distance) {
  double above = s->high - background, below = background - s->low;
  if (!(fmin(above, below) > 0.25 * fmax(above, below))) return false;
  if (s->signs && fabs(background - s->zero) < 0.01 * (s->high - s->low)) return true;
  distances d = {distance, sample->count};
  measure(sample->values, sample->count, background, -1, distance);
  bool thins = falls(&d, 0.02, below);
  measure(sample->values, sample->count, background, 1, distance);
  return thins && falls(&d, 0.02, above);
}

/* The background of data without a clear sign lies below or above all things. */
static void choose_side(const spread *s, bool lobes, hl_data_analysis *a) {
  double above = s->high - a->background, below = a->background - s->low;
  a->direction = above >= below ? 1 : -1;
  if (lobes || !(fmin(above, below) > 0.25 * fmax(above, below))) return;
  a->background = s->low;
  a->direction = 1;
}

/* Distances to both sides. */
static hl_status find_two_sided(const hl_sample *sample, distances *d, hl_data_analysis *a, hl_error *error) {
  for (size_t n = 0; n < sample->count; n++)
    d->values[n] = (float)fabs((double)sample->values[n] - a->background);
  if (!hl_sort(sample->context, d->values, d->count))
    return hl_fail_memory(error, d->count * sizeof(float), "a volume's sample");
  find_thresholds(d, NULL, 0, a);
  return HL_OK;
}

static void find_middle(const hl_sample *sample, double mode, hl_data_analysis *a) {
  a->middle = mode;
  a->lower = fmax(mode - hl_quantile(sample->values, sample->count, TAIL), 0);
  a->upper = fmax(hl_quantile(sample->values, sample->count, 1 - TAIL) - mode, 0);
  size_t common = 0;
  for (size_t n = 0; n < sample->count; n++) {
    double value = (double)sample->values[n];
    common += value > mode - 0.4 * a->lower && value < mode + 0.4 * a->upper;
  }
  a->common = (double)common / (double)sample->count;
}

/* memory: room for the sample and its border. */
static hl_status analyse_values(const hl_volume *volume, const hl_sample *sample, float *memory,
                                hl_data_analysis *a, hl_error *error) {
  distances d = {memory, sample->count};
  bool bordered = sample->border_count > 0; /* else NaNs are the air, and the commonest value has to do */
  a->background = bordered ? hl_mode(sample->border, sample->border_count)
                           : hl_mode(sample->values, sample->count);
  spread s = spread_of(sample, a->background);
  double mode = hl_mode(sample->values, sample->count);
  bool flow = is_flow(volume, sample, &s, mode, memory);
  if (flow && s.signs) a->background = s.zero;
  bool lobes = (flow && s.signs) || has_lobes(sample, &s, a->background, memory);
  hl_status status = HL_OK;
  choose_side(&s, lobes, a);
  if (lobes) {
    a->kind = HL_DATA_SIGNED;
    status = find_two_sided(sample, &d, a, error);
  } else {
    a->zeroed = exact_share(sample, a->background);
    measure(sample->values, sample->count, a->background, a->direction, d.values);
    measure(sample->border, sample->border_count, a->background, a->direction, memory + d.count);
    find_thresholds(&d, memory + d.count, sample->border_count, a);
    a->kind = kind_of(volume, sample, &d, a);
  }
  if (flow && !s.signs) a->kind = HL_DATA_FLOW;
  find_middle(sample, mode, a);
  return status;
}

static hl_status analyse_sample(const hl_volume *volume, const hl_sample *sample, hl_data_analysis *a,
                                hl_error *error) {
  size_t count = sample->count + sample->border_count;
  float *memory = hl_allocate(volume->context, count, sizeof *memory);
  if (memory == NULL) return hl_fail_memory(error, count * sizeof *memory, "a volume's sample");
  hl_status status = analyse_values(volume, sample, memory, a, error);
  hl_release(volume->context, memory);
  a->depth = cbrt(a->depth / (double)sample->count * (double)hl_volume_voxel_count(volume));
  return status;
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
  analysis->middle = sample.low + sample.range * analysis->middle;
  double *distance[] = {&analysis->faint, &analysis->solid, &analysis->dense, &analysis->top,
                        &analysis->mean,  &analysis->lower, &analysis->upper};
  for (size_t n = 0; n < sizeof distance / sizeof *distance; n++) *distance[n] *= sample.range;
  hl_sample_release(&sample);
  return status == HL_OK ? hl_data_find_labels(volume, analysis, error) : status;
}

/* ---- tells label maps from amounts: few whole numbers, each in blocks.
 *
 * In: a volume and its background. Out: the labels. Edges of smooth shapes and noise have numbers too, but no
 * two voxels side by side share them.
 */

#define PLACES    5e5   /* looked at, about */
#define IN_BLOCKS 0.5   /* least part of a label's neighbours that share it */
#define WIDEST    65535 /* between the least label and the greatest */

typedef struct tally {
  unsigned int seen, shared; /* neighbours looked at of voxels with this value; those that have it too */
} tally;

/* False at a value that is no whole number. tallies: one for each whole number from least on. */
static bool count_neighbours(const hl_volume *volume, double least, tally *tallies) {
  const size_t *n = volume->dimension;
  size_t step = hl_lattice_step(n, PLACES);
  for (size_t k = step / 2; k < n[2]; k += step)
    for (size_t j = step / 2; j < n[1]; j += step)
      for (size_t i = step / 2; i < n[0]; i += step) {
        double value = hl_volume_value(volume, i, j, k);
        if (!isfinite(value)) continue;
        if (value != floor(value)) return false;
        const double next[3] = {hl_volume_value(volume, i + 1, j, k), hl_volume_value(volume, i, j + 1, k),
                                hl_volume_value(volume, i, j, k + 1)}; /* NaN outside */
        tally *own = &tallies[(size_t)(value - least)];
        for (int a = 0; a < 3; a++) {
          own->seen += isfinite(next[a]);
          own->shared += next[a] == value;
        }
      }
  return true;
}

/* More than half of the values, the background apart, lie in blocks. 0 is no label. */
static bool list(const tally *tallies, size_t count, double least, hl_data_analysis *a) {
  size_t found = 0, in_blocks = 0;
  double background = least <= 0 ? 0 : a->background;
  for (size_t t = 0; t < count; t++) {
    if (tallies[t].seen == 0 || least + (double)t == background) continue;
    if (found == HL_MOST_LABELS) return false;
    a->labels[found++] = least + (double)t;
    in_blocks += (double)tallies[t].shared > IN_BLOCKS * (double)tallies[t].seen;
  }
  a->label_count = found;
  return found > 1 && 2 * in_blocks > found;
}

hl_status hl_data_find_labels(const hl_volume *volume, hl_data_analysis *analysis, hl_error *error) {
  double least = volume->minimum, range = volume->maximum - volume->minimum;
  if (analysis->kind == HL_DATA_CONSTANT || least != floor(least) || !(range <= WIDEST)) return HL_OK;
  size_t count = (size_t)range + 1;
  tally *tallies = hl_allocate_zeroed(volume->context, count, sizeof *tallies);
  if (tallies == NULL) return hl_fail_memory(error, count * sizeof *tallies, "a count of labels");
  if (count_neighbours(volume, least, tallies) && list(tallies, count, least, analysis))
    analysis->kind = HL_DATA_LABELS;
  else analysis->label_count = 0;
  hl_release(volume->context, tallies);
  return HL_OK;
}
