/* guess/analysis.c - finds the kind of data in a volume, and the values that divide objects from their
 * background.
 *
 * The analysis does not depend on the data's scale and offset. The background is the commonest value on the
 * grid's faces. Two thresholds of a value's distance from the background find the objects. Voxels beyond the
 * threshold of least cross entropy may belong to objects. Voxels beyond the threshold of greatest variance
 * between classes surely belong to objects. Smoothness and the shape of the histogram distinguish
 * simulations, media and scanned objects. */
#include "guess/analysis.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/context.h"
#include "core/door.h"
#include "core/memory.h"
#include "elementary/elementary.h"
#include "guess/sample.h"

#define BINS 32 /* bins of the histogram whose shape tells the kind of data */
/* The roughness (hl_roughness) below which data are simulations; turbulence and noise are rougher. */
#define ROUGH  0.65
#define SMOOTH 0.18 /* a roughness that every scanner's data exceed */
/* The least roughness of smoke on fine grids; 0.50 to 0.58 was measured on grids of 200 to 320 voxels. */
#define FOG   0.4
#define NOISY 1.2 /* a roughness that no simulated turbulence exceeds; white noise has 1.7 */
/* The fraction of the voxels whose values lie below the middle by more than the distance `lower`, and the
 * fraction of the voxels whose values lie above the middle by more than the distance `upper`. */
#define TAIL 0.005
/* A noise that every scanner's data exceed, as a fraction of top. Rounding gives 8-bit values half of this
 * noise. */
#define CALM 0.003
#define PEAK 1.2 /* least ratio of a histogram's peak to the valley before it */
/* Least ratio for peaks of materials in data without noise; saddles of fields have the ratio 1.5, materials
 * have the ratio 2.1 (measured). */
#define HUMP  1.75
#define LOBES 0.08  /* the greatest fraction of the voxels that the lobes of a signed quantity show */
#define FLOOR 0.002 /* least mean of the background, as a fraction of top */

typedef struct distances {
  float *values; /* owned; ascending; [count]; relative */
  size_t count;
} distances;

/* Measures the distances of a sample's values from the background, in ascending order. Values on the side of
 * the background that `direction` does not point to get the distance 0. */
static void measure(const float *values, size_t count, double background, double direction, float *distance) {
  for (size_t n = 0; n < count; n++) {
    size_t from = direction > 0 ? n : count - 1 - n;
    distance[n] = (float)fmax(0, direction * ((double)values[from] - background));
  }
}

/* Counts the distances between low and high in bins of equal width. */
static void shape_of(const distances *d, double low, double high, double counts[BINS]) {
  memset(counts, 0, BINS * sizeof *counts);
  for (size_t n = 0; n < d->count; n++) {
    double t = ((double)d->values[n] - low) / (high - low);
    if (t > 0 && t < 1) counts[(int)(t * BINS)]++;
  }
}

/* Returns true if the histogram falls from `low` to `high`, as for the density of a simulation. Returns false
 * if it has peaks, as for materials; a peak rises at least by the factor `peak` above the valley before it.
 * Sums of two bins bridge the gaps of quantised data. The last two bins, which may hold saturated values, and
 * bins of very few voxels are ignored. */
static bool falls(const distances *d, double low, double high, double peak) {
  double counts[BINS], least = INFINITY;
  shape_of(d, low, high, counts);
  for (int bin = 0; bin + 3 < BINS; bin++) {
    double count = counts[bin] + counts[bin + 1];
    if (count > peak * least + 4 * sqrt(least) && count > 1e-4 * (double)d->count) return false;
    least = fmin(least, count);
  }
  return true;
}

/* The fraction of the sample that has exactly the background's value. */
static double exact_share(const hl_sample *sample, double background) {
  size_t equal = 0;
  for (size_t n = 0; n < sample->count; n++) equal += (double)sample->values[n] == background;
  return (double)equal / (double)sample->count;
}

/* The fraction of the distances that are greater than `distance`. */
static double share_beyond(const distances *d, double distance) {
  size_t beyond = 0;
  while (beyond < d->count && (double)d->values[d->count - 1 - beyond] > distance) beyond++;
  return d->count > 0 ? (double)beyond / (double)d->count : 0;
}

/* Returns true if the sample has more different values than a byte has. */
static bool is_continuous(const hl_sample *sample) {
  size_t levels = 1;
  for (size_t n = 1; n < sample->count; n++) levels += sample->values[n] != sample->values[n - 1];
  return levels > 256;
}

/* Returns true if more than two fifths of the objects' voxels have about the same value, as the body of a
 * cloud has. */
static bool has_one_body(const distances *d, double low, double high) {
  double counts[BINS], sum = 0, most = 0;
  shape_of(d, low, high, counts);
  for (int bin = 0; bin < BINS; bin++) {
    sum += counts[bin];
    most = fmax(most, counts[bin]);
  }
  return most > 0.4 * sum;
}

/* A distance from the background that the noise at the grid's border hardly reaches. Most of the border's
 * voxels must be background. */
static double border_noise(const float *border, size_t count) {
  if (count == 0) return 0;
  double middle = hl_quantile(border, count, 0.5), upper = hl_quantile(border, count, 0.75);
  return middle + 6 * (upper - middle); /* 3.5 sigma of one-sided Gaussian noise */
}

/* Finds the threshold dense, and measures the objects beyond the thresholds solid and faint. */
static void measure_objects(const distances *d, hl_data_analysis *a) {
  a->dense = hl_threshold_otsu(d->values, d->count, a->solid);
  size_t sure = 0, dense = 0;
  double sums[2] = {0, 0}; /* of the solid matter up to dense, and beyond it */
  for (size_t n = d->count; n > 0 && (double)d->values[n - 1] > a->solid; n--, sure++) {
    const bool beyond_dense = (double)d->values[n - 1] > a->dense;
    dense += beyond_dense;
    sums[beyond_dense] += (double)d->values[n - 1];
  }
  a->dense_share = sure > 0 ? (double)dense / (double)sure : 1;
  a->light_mean = dense < sure ? sums[0] / (double)(sure - dense) : a->dense;
  a->dense_mean = dense > 0 ? sums[1] / (double)dense : a->dense;
  double sum = 0;
  size_t beyond = 0;
  for (size_t n = d->count; n > 0 && (double)d->values[n - 1] > a->faint; n--, beyond++)
    sum += (double)d->values[n - 1];
  a->filled = (double)sure / (double)d->count;
  a->mean = beyond > 0 ? sum / (double)beyond : a->top;
  a->depth = (double)beyond;
}

/* Limits all distances to `most`. A few voxels that are a hundred times as bright as the objects, such as hot
 * pixels and dust, would otherwise have most of the variance between classes, and objects would count as
 * background. */
static void limit_to(const distances *d, double most) {
  for (size_t n = d->count; n > 0 && (double)d->values[n - 1] > most; n--) d->values[n - 1] = (float)most;
}

/* Finds the thresholds, and measures of the objects, relative to the sample's range. d: the distances to one
 * side of the background. noise: a distance that the noise at the border hardly reaches. */
static void find_thresholds(const distances *d, double noise, hl_data_analysis *a) {
  a->top = fmax(hl_quantile(d->values, d->count, 0.9999), 1e-9);
  limit_to(d, a->top);
  a->solid = hl_threshold_otsu(d->values, d->count, -1);
  a->faint = fmin(hl_threshold_cross_entropy(d->values, d->count, FLOOR * a->top), a->solid);
  a->faint = fmin(fmax(fmax(a->faint, noise), 0.3 * a->solid), 0.8 * a->solid);
  measure_objects(d, a);
}

/* Returns true if more than three tenths of the grid's border are not background: the matter then goes on
 * beyond the grid. */
static bool fills_grid(const hl_sample *sample, double background, double range) {
  size_t near = 0;
  for (size_t n = 0; n < sample->border_count; n++)
    near += fabs((double)sample->border[n] - background) < 0.05 * range;
  return sample->border_count > 0 && (double)near < 0.7 * (double)sample->border_count;
}

static bool is_floating(const hl_volume *volume) {
  return volume->type == HL_VOXEL_F32 || volume->type == HL_VOXEL_F64;
}

/* The distribution of a volume's values, relative to the sample's range. */
typedef struct spread {
  double low, high;  /* nearly all voxels have values from `low` to `high` */
  double zero;       /* the data value 0 */
  bool fills, signs; /* fills: whether the matter has no air around it; signs: whether many voxels have values
                      * on both sides of the data value 0 */
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

/* Returns true if the volume is a flow: its values fill the grid, and they are smooth, or rough with a single
 * peak in their histogram. (Scanned data are rough, too, but their histogram has several peaks.) distance:
 * scratch, [sample->count]. */
static bool is_flow(const hl_volume *volume, const hl_sample *sample, const spread *s, double mode,
                    float *distance) {
  if (!s->fills || !is_floating(volume) || !is_continuous(sample)) return false;
  double roughness = hl_roughness(volume, sample, mode, 0);
  if (roughness < ROUGH) return true;
  distances d = {distance, sample->count};
  measure(sample->values, sample->count, mode, -1, distance);
  bool one_peak = falls(&d, 0.02, fmax(mode - s->low, 0.03), PEAK);
  measure(sample->values, sample->count, mode, 1, distance);
  return roughness < NOISY && one_peak && falls(&d, 0.02, fmax(s->high - mode, 0.03), PEAK);
}

/* Returns true if enough of the objects' voxels have the greatest value to be the inside of a solid shape. In
 * smooth data with more levels than bytes have, a tenth of the objects' voxels is enough; in other data three
 * tenths are needed, because bytes may clip the maxima of a field. */
static bool is_filled_up(const hl_sample *sample, const distances *d, const hl_data_analysis *a,
                         double roughness) {
  const double least = roughness < SMOOTH && is_continuous(sample) ? 0.1 : 0.3;
  size_t things = 0, greatest = 0;
  for (size_t n = d->count; n > 0 && (double)d->values[n - 1] > a->solid; n--, things++)
    greatest += (double)d->values[n - 1] > 0.999 * (double)d->values[d->count - 1];
  return (double)greatest > least * (double)things;
}

/* Returns true if the objects are a smooth quantity that falls off from its maxima. If the histogram has low
 * bumps, noise decides: in data with a scanner's noise, the bumps are materials; in data without noise, the
 * bumps are saddles between the maxima of a field. */
static hl_status falls_off(const hl_volume *volume, const hl_sample *sample, const distances *d,
                           const hl_data_analysis *a, bool *falling, hl_error *error) {
  double noise = 0;
  *falling = falls(d, a->faint, a->top, PEAK);
  if (*falling || !falls(d, a->faint, a->top, HUMP)) return HL_OK;
  hl_status status = hl_noise(volume, sample, a->background + a->direction * a->faint, a->direction, &noise,
                              error);
  *falling = status == HL_OK && noise < CALM * a->top;
  return status;
}

/* Returns whether the file says that the data are the density of a fog, and no value contradicts the file: no
 * value is below 0, which is empty, and objects have values above the background. kind_of() believes the file
 * only about data that are smooth, solid, or fall off from their maxima; a scan's materials remain surfaces.
 */
static bool is_fog(const hl_volume *volume, const hl_data_analysis *a) {
  return volume->says_fog && volume->minimum >= 0 && a->direction > 0;
}

static hl_data_kind kind_of(const hl_volume *volume, const hl_sample *sample, const distances *d,
                            bool falling, const hl_data_analysis *a) {
  double roughness = hl_roughness(volume, sample, a->background, a->faint);
  const bool said = is_fog(volume, a);
  if (roughness < ROUGH && is_filled_up(sample, d, a, roughness))
    return said ? HL_DATA_MEDIUM : HL_DATA_SURFACES;
  if (said && (falling || roughness < SMOOTH)) return HL_DATA_MEDIUM;
  bool fog = a->zeroed > 0.4 && is_continuous(sample); /* the air around the matter is exactly empty */
  if (roughness < ROUGH && roughness > FOG && fog && falling) return HL_DATA_MEDIUM;
  if (roughness < ROUGH) return falling || roughness < SMOOTH ? HL_DATA_FIELD : HL_DATA_SURFACES;
  return fog && (falling || has_one_body(d, a->faint, a->top)) ? HL_DATA_MEDIUM : HL_DATA_SURFACES;
}

/* Returns true if objects have values on both sides of the background (lobes), these values become rarer with
 * the distance, and they are not a scanner's noise. Values on both sides of the data value 0 alone do not
 * make lobes: the commonest value may be a material, around which air has low values. */
static bool has_lobes(const hl_volume *volume, const hl_sample *sample, const spread *s, double background,
                      float *distance) {
  double above = s->high - background, below = background - s->low;
  if (!(fmin(above, below) > 0.25 * fmax(above, below))) return false;
  if (s->signs && fabs(background - s->zero) < 0.01 * (s->high - s->low)) return true;
  distances d = {distance, sample->count};
  measure(sample->values, sample->count, background, -1, distance);
  bool thins = falls(&d, 0.02, below, PEAK);
  measure(sample->values, sample->count, background, 1, distance);
  return thins && falls(&d, 0.02, above, PEAK) && hl_roughness(volume, sample, background, 0) < NOISY;
}

/* Chooses the side of the background on which the objects lie. If many values lie on both sides of the
 * background but the values are no lobes, the lowest value becomes the background. */
static void choose_side(const spread *s, bool lobes, hl_data_analysis *a) {
  double above = s->high - a->background, below = a->background - s->low;
  a->direction = above >= below ? 1 : -1;
  if (lobes || !(fmin(above, below) > 0.25 * fmax(above, below))) return;
  a->background = s->low;
  a->direction = 1;
}

/* Finds the thresholds for objects on both sides of the background. Lobes that fill the grid, as in a
 * turbulent flow, would hide each other, so only the strongest ones are shown. */
static hl_status find_two_sided(const hl_sample *sample, distances *d, hl_data_analysis *a, hl_error *error) {
  for (size_t n = 0; n < sample->count; n++)
    d->values[n] = (float)fabs((double)sample->values[n] - a->background);
  if (!hl_sort(sample->context, d->values, d->count))
    return hl_fail_memory(error, d->count * sizeof(float), "a volume's sample");
  find_thresholds(d, 0, a);
  double strong = hl_quantile(d->values, d->count, 1 - LOBES);
  if (!(strong > a->solid)) return HL_OK;
  a->faint *= strong / a->solid;
  a->solid = strong;
  a->dense = hl_threshold_otsu(d->values, d->count, strong);
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

/* Analyses the values of a sample. memory: scratch, [sample->count + sample->border_count]. */
static hl_status analyse_values(const hl_volume *volume, const hl_sample *sample, float *memory,
                                hl_data_analysis *a, hl_error *error) {
  distances d = {memory, sample->count};
  bool bordered = sample->border_count > 0; /* a volume without a border has no commonest value of the border,
                                             * so that the commonest value of all voxels is taken */
  a->background = bordered ? hl_mode(sample->border, sample->border_count)
                           : hl_mode(sample->values, sample->count);
  spread s = spread_of(sample, a->background);
  double mode = hl_mode(sample->values, sample->count);
  bool logarithms = volume->is_log_density, flow = !logarithms && is_flow(volume, sample, &s, mode, memory);
  if (flow && s.signs) a->background = s.zero;
  bool lobes = !logarithms && ((flow && s.signs) || has_lobes(volume, sample, &s, a->background, memory));
  hl_status status = HL_OK;
  if (logarithms) a->background = s.low, a->direction = 1;
  else choose_side(&s, lobes, a);
  if (lobes) {
    a->kind = HL_DATA_SIGNED;
    status = find_two_sided(sample, &d, a, error);
  } else {
    a->zeroed = exact_share(sample, a->background);
    measure(sample->values, sample->count, a->background, a->direction, d.values);
    measure(sample->border, sample->border_count, a->background, a->direction, memory + d.count);
    const distances border = {memory + d.count, sample->border_count};
    const double noise = border_noise(border.values, border.count);
    find_thresholds(&d, noise, a);
    bool falling = false;
    status = falls_off(volume, sample, &d, a, &falling, error);
    a->kind = kind_of(volume, sample, &d, falling, a);
    if (a->kind == HL_DATA_SURFACES && !(flow && !s.signs))
      a->vessels = hl_data_find_vessels(volume, sample, d.values, a);
    if (a->kind == HL_DATA_SURFACES && a->vessels == 0 && hl_data_find_rim(volume, sample, noise, a))
      measure_objects(&d, a);
    a->cut_off = share_beyond(&border, a->solid);
    if (a->kind == HL_DATA_SURFACES && status == HL_OK)
      status = hl_data_find_boundary(volume, sample, a, error);
    if (a->grain > 0 && hl_roughness(volume, sample, a->background, a->faint) > NOISY)
      a->sharpness = a->grain = 0; /* data that are noise throughout have no surface */
  }
  if (flow && !s.signs) a->kind = HL_DATA_FLOW;
  if (logarithms) a->kind = HL_DATA_PARTICLES;
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
  a->depth = hl_cbrt(a->depth / (double)sample->count * (double)hl_volume_voxel_count(volume));
  return status;
}

static hl_status analyse(const hl_volume *volume, hl_data_analysis *analysis, hl_error *error) {
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
    /* All sampled voxels have the same value, so the volume counts as constant. */
    hl_sample_release(&sample);
    return HL_OK;
  }
  status = analyse_sample(volume, &sample, analysis, error);
  analysis->background = sample.low + sample.range * analysis->background;
  analysis->middle = sample.low + sample.range * analysis->middle;
  double *distance[] = {&analysis->faint,      &analysis->solid,      &analysis->dense, &analysis->top,
                        &analysis->light_mean, &analysis->dense_mean, &analysis->mean,  &analysis->lower,
                        &analysis->upper,      &analysis->vessels};
  for (size_t n = 0; n < sizeof distance / sizeof *distance; n++) *distance[n] *= sample.range;
  hl_sample_release(&sample);
  if (status == HL_OK && analysis->kind == HL_DATA_SURFACES) hl_data_find_materials(volume, analysis);
  bool may_be_labels = status == HL_OK && analysis->kind != HL_DATA_PARTICLES;
  return may_be_labels ? hl_data_find_labels(volume, analysis, error) : status;
}

/* Keeps a copy of the analysis with the volume. The analysis may be added once to a volume that is otherwise
 * constant. */
hl_status hl_data_keep(const hl_volume *volume, const hl_data_analysis *analysis, hl_error *error) {
  hl_data_analysis *kept = hl_allocate(volume->context, 1, sizeof *kept), *before = NULL;
  if (kept == NULL) return hl_fail_memory(error, sizeof *kept, "the analysis of a volume");
  *kept = *analysis;
  if (!atomic_compare_exchange_strong(&((hl_volume *)volume)->analysis, &before, kept))
    hl_release(volume->context, kept); /* another thread kept its analysis first */
  return HL_OK;
}

hl_status hl_data_analyse(const hl_volume *volume, hl_data_analysis *analysis, hl_error *error) {
  const hl_data_analysis *kept = atomic_load(&((hl_volume *)volume)->analysis);
  if (kept != NULL) {
    *analysis = *kept;
    return HL_OK;
  }
  hl_status status = analyse(volume, analysis, error);
  return status == HL_OK ? hl_data_keep(volume, analysis, error) : status;
}

/* ---- label maps: few whole numbers, each in blocks, or whole numbers that the file says are labels.
 *
 * * Noise and the edges of smooth shapes may be whole numbers too, but few neighbouring voxels of noise and
 * edges have equal values. */

/* A label lies in blocks if more than this fraction of its voxels' neighbours has the same label. */
#define IN_BLOCKS 0.5

typedef struct tally {
  int64_t value;
  unsigned int seen, shared; /* seen: number of neighbours of voxels with this value; shared: number of these
                              * neighbours that have the value, too */
} tally;

enum { TALLIES = 4 * HL_FEW_LABELS, NO_ROOM = -1 };

/* A hash table of the values that were met. If another value has taken a value's place, the value gets the
 * next free place. */
typedef struct value_table {
  tally tallies[TALLIES]; /* a place is free if `seen` is 0 */
  size_t count;
} value_table;

/* The place of a value, which is added if it is new; NO_ROOM if the table already has the greatest number of
 * values that a label map may have. */
static int place_of(value_table *table, int64_t value) {
  size_t place = (size_t)(((uint64_t)value * 0x9e3779b97f4a7c15u) >> 32) % TALLIES;
  while (table->tallies[place].seen != 0 && table->tallies[place].value != value)
    place = (place + 1) % TALLIES;
  if (table->tallies[place].seen == 0 && table->count++ > HL_FEW_LABELS) return NO_ROOM;
  table->tallies[place].value = value;
  return (int)place;
}

/* MOST_REPEATED: the greatest number of repetitions that is looked for. LEAST_REPEATED: the least number of
 * voxels, without repetitions, along an axis that is examined. Along an axis with fewer voxels, as in a map
 * of a few plates, repetitions would be found by chance. */
enum { MOST_REPEATED = 8, LEAST_REPEATED = 8 };

/* Returns whether each voxel is repeated `count` times along an axis, as in a volume that was enlarged by
 * repeating its voxels. Only the voxels at the points of a coarse lattice are examined. count: a power of
 * two. */
static bool is_repeated(const hl_volume *volume, int axis, size_t count) {
  const size_t *n = volume->dimension, step = hl_lattice_step(n, HL_LATTICE_PLACES);
  if (n[axis] < LEAST_REPEATED * count || n[axis] % count != 0) return false;
  for (size_t k = step / 2; k < n[2]; k += step)
    for (size_t j = step / 2; j < n[1]; j += step)
      for (size_t i = step / 2; i < n[0]; i += step) {
        size_t first[3] = {i, j, k}, last[3] = {i, j, k};
        int64_t value, other;
        first[axis] -= first[axis] % count;
        last[axis] = first[axis] + count - 1;
        const hl_whole found = hl_volume_whole(volume, first[0], first[1], first[2], &value);
        if (found != hl_volume_whole(volume, last[0], last[1], last[2], &other)) return false;
        if (found == HL_WHOLE_FOUND && value != other) return false;
      }
  return true;
}

/* Counts, for each value, the neighbours of its voxels, and the neighbours that also have this value. Returns
 * false if a value is no whole number, or if there are too many values. If the volume was enlarged by
 * repeating voxels, the neighbours are the neighbours in the smaller volume. */
static bool count_neighbours(const hl_volume *volume, value_table *table) {
  const size_t *n = volume->dimension;
  size_t step = hl_lattice_step(n, HL_LATTICE_PLACES), apart[3] = {1, 1, 1};
  for (int a = 0; a < 3; a++)
    while (apart[a] < MOST_REPEATED && is_repeated(volume, a, 2 * apart[a])) apart[a] *= 2;
  for (size_t k = step / 2; k < n[2]; k += step)
    for (size_t j = step / 2; j < n[1]; j += step)
      for (size_t i = step / 2; i < n[0]; i += step) {
        int64_t value, next;
        hl_whole found = hl_volume_whole(volume, i, j, k, &value);
        if (found == HL_WHOLE_ABSENT) continue;
        if (found == HL_WHOLE_FRACTION) return false;
        const int place = place_of(table, value);
        if (place == NO_ROOM) return false;
        tally *own = &table->tallies[place];
        for (int a = 0; a < 3; a++) {
          found = hl_volume_whole(volume, i + (a == 0) * apart[0], j + (a == 1) * apart[1],
                                  k + (a == 2) * apart[2], &next);
          own->seen += found != HL_WHOLE_ABSENT;
          own->shared += found == HL_WHOLE_FOUND && next == value;
        }
      }
  return true;
}

static int compare_values(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return x < y ? -1 : x > y;
}

/* Lists the labels in rising order: all values but the background. Of more labels than HL_FEW_LABELS, only
 * some are listed. Returns whether the map has labels, most of which lie in blocks. */
static bool list(const value_table *table, double background, hl_data_analysis *a) {
  size_t found = 0, in_blocks = 0;
  for (size_t t = 0; t < TALLIES && found < HL_FEW_LABELS; t++) {
    const tally *own = &table->tallies[t];
    if (own->seen == 0 || (double)own->value == background) continue;
    a->labels[found++] = (double)own->value;
    in_blocks += (double)own->shared > IN_BLOCKS * (double)own->seen;
  }
  qsort(a->labels, found, sizeof *a->labels, compare_values);
  a->label_count = 0;
  for (size_t n = 0; n < found; n++) /* doubles round large labels */
    if (n == 0 || a->labels[n] > a->labels[n - 1]) a->labels[a->label_count++] = a->labels[n];
  return found > 0 && 2 * in_blocks > found;
}

/* Returns whether two values are the least and the greatest of the volume. Voxels between the places of the
 * lattice may have other values. */
static bool has_ends(const hl_volume *volume, double a, double b) {
  return fmin(a, b) == volume->minimum && fmax(a, b) == volume->maximum;
}

hl_status hl_data_find_labels(const hl_volume *volume, hl_data_analysis *analysis, hl_error *error) {
  if (analysis->kind == HL_DATA_CONSTANT || volume->minimum != floor(volume->minimum)) return HL_OK;
  value_table *table = hl_allocate_zeroed(volume->context, 1, sizeof *table);
  if (table == NULL) return hl_fail_memory(error, sizeof *table, "a count of labels");
  bool are_few = count_neighbours(volume, table), are_many = table->count > HL_FEW_LABELS,
       in_blocks = list(table, hl_data_no_label(volume, analysis), analysis),
       some_named = volume->says_labels && (are_few || are_many) && analysis->label_count > 0;
  analysis->is_mask = !some_named && are_few && in_blocks && analysis->label_count == 1 &&
                      has_ends(volume, analysis->labels[0], hl_data_no_label(volume, analysis));
  if (some_named || (are_few && in_blocks && !analysis->is_mask)) analysis->kind = HL_DATA_LABELS;
  else analysis->label_count = 0;
  hl_release(volume->context, table);
  return HL_OK;
}

hl_status hl_volume_is_label_map(hl_context *context, const hl_volume *volume, int *labels, hl_error *error) {
  HL_DOOR;
  if (context == NULL || volume == NULL || labels == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_volume_is_label_map: null context, volume or result");
  hl_data_analysis analysis = {0};
  hl_status status = volume->segment_count > 0 ? HL_OK : hl_data_analyse(volume, &analysis, error);
  *labels = status == HL_OK && hl_data_is_label_map(volume, &analysis);
  return status;
}
