/* volume/formats/particles/particles.c - volumes of particles: the check of the caller's arrays, and the
 * volume of their density.
 *
 * In: a description of particles, from a caller or from the reader of a file. Out: a volume of its density,
 * the logarithm of it, or the mean of a value. particles/particles.h spreads them. */
#include "volume/formats/particles/particles.h"

#include <float.h>
#include <math.h>

#include "core/context.h"
#include "core/door.h"
#include "core/memory.h"
#include "particles/particles.h"

enum {
  SIDE = 512,            /* voxels along an axis at most, by default */
  POINTS_A_PARTICLE = 64 /* kernels of 48 neighbours with h = 2 voxels cover 6 voxels for each particle,
                          * and more where particles cluster */
};
#define LEAST_POINTS ((size_t)1 << 21)
#define MOST_POINTS  ((size_t)1 << 31)
#define PI           3.14159265358979323846

void hl_particles_description_defaults(hl_particles_description *description) {
  if (description == NULL) return;
  *description = (hl_particles_description){
      .struct_size = sizeof *description, .position_type = HL_VOXEL_F64, .side = SIDE};
}

/* ---- checks ---- */

static hl_status check_numbers(const float *numbers, size_t count, const char *what, bool negative,
                               const char *subject, hl_error *error) {
  for (size_t n = 0; numbers != NULL && n < count; n++)
    if (!isfinite(numbers[n]) || (!negative && numbers[n] < 0))
      return hl_fail(error, HL_ERROR_INPUT, "%s: the %s of particle %zu is %g: give a finite number%s",
                     subject, what, n, (double)numbers[n], negative ? "" : " from 0 on");
  return HL_OK;
}

static hl_status check_period(const hl_particles_description *d, const char *subject, hl_error *error) {
  for (int a = 0; a < 3; a++)
    if (!isfinite(d->period_low[a]) || !(d->period[a] >= 0) || d->period[a] > 1e30)
      return hl_fail(error, HL_ERROR_INPUT,
                     "%s: along axis %d the period is %g from %g on: give finite numbers, 0 for no period",
                     subject, a, d->period[a], d->period_low[a]);
  return HL_OK;
}

static hl_status check(const hl_particles_description *d, const char *subject, hl_error *error) {
  if (d->struct_size != sizeof *d)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "%s: struct_size is %zu, expected %zu: call hl_particles_description_defaults first",
                   subject, d->struct_size, sizeof *d);
  if (d->positions == NULL || d->count == 0)
    return hl_fail(error, HL_ERROR_INPUT, "%s: there are no particles: give at least one", subject);
  if (d->position_type != HL_VOXEL_F32 && d->position_type != HL_VOXEL_F64)
    return hl_fail(error, HL_ERROR_ARGUMENT, "%s: positions are HL_VOXEL_F32 or HL_VOXEL_F64, not %d",
                   subject, (int)d->position_type);
  if (d->quantity < HL_PARTICLES_LOG_DENSITY || d->quantity > HL_PARTICLES_MEAN)
    return hl_fail(error, HL_ERROR_ARGUMENT, "%s: there is no quantity %d", subject, (int)d->quantity);
  if (d->quantity == HL_PARTICLES_MEAN && d->values == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "%s: values is null: HL_PARTICLES_MEAN is the mean of values",
                   subject);
  if (!(d->spacing >= 0) || !isfinite(d->spacing))
    return hl_fail(error, HL_ERROR_ARGUMENT, "%s: the spacing is %g: give a finite number from 0 on", subject,
                   d->spacing);
  hl_status status = check_period(d, subject, error);
  if (status == HL_OK) status = check_numbers(d->masses, d->count, "mass", false, subject, error);
  if (status == HL_OK && d->quantity == HL_PARTICLES_MEAN)
    status = check_numbers(d->values, d->count, "value", true, subject, error);
  return status;
}

/* ---- from particles to voxels ---- */

static hl_particle_input input_of(const hl_particles_description *d) {
  hl_particle_input input = {.count = d->count,
                             .positions = d->positions,
                             .is_double = d->position_type == HL_VOXEL_F64,
                             .lengths = d->lengths};
  for (int a = 0; a < 3; a++) input.period_low[a] = d->period_low[a], input.period[a] = d->period[a];
  return input;
}

/* The greatest number of voxels of the volume. Half of the memory limit is for these voxels, and for what
 * is made beside them. */
static size_t most_points(const hl_context *context, const hl_particles_description *d, size_t count) {
  size_t fields = d->quantity == HL_PARTICLES_MEAN ? 3 : 2, most = MOST_POINTS;
  if (d->spacing == 0) {
    most = count < MOST_POINTS / POINTS_A_PARTICLE ? count * POINTS_A_PARTICLE : MOST_POINTS;
    if (most < LEAST_POINTS) most = LEAST_POINTS;
  }
  uint64_t limit = context->options.memory_limit, room = limit / 2 / sizeof(float) / fields;
  return limit > 0 && room < most ? (size_t)room : most;
}

/* Weights in the set's order: masses, or masses times values. */
static float *weights_of(hl_context *context, const hl_particles_description *d, const hl_particle_set *set,
                         bool with_values) {
  float *weights = hl_allocate(context, set->count, sizeof *weights);
  for (size_t n = 0; weights != NULL && n < set->count; n++) {
    size_t from = set->order[n];
    weights[n] = (d->masses != NULL ? d->masses[from] : 1) * (with_values ? d->values[from] : 1);
  }
  return weights;
}

static hl_status spread(hl_context *context, hl_pool *pool, const hl_particles_description *d,
                        const hl_particle_set *set, const hl_particle_lattice *lattice, bool with_values,
                        const char *subject, float **field, hl_error *error) {
  float *weights = NULL;
  if (d->masses != NULL || with_values) {
    weights = weights_of(context, d, set, with_values);
    if (weights == NULL) return hl_fail_memory(error, set->count * sizeof *weights, subject);
  }
  hl_status status = hl_particles_spread(context, pool, set, weights, lattice, subject, field, error);
  hl_release(context, weights);
  return status;
}

static size_t point_count(const hl_particle_lattice *lattice) {
  size_t count = 1;
  for (int a = 0; a < 3; a++) count *= hl_lattice_points(lattice, 0, a);
  return count;
}

/* The density below which a voxel counts as empty: a tenth of the least density that any particle alone has
 * at its own place, m W(0) = m / (pi h^3). */
static float empty_density(const hl_particles_description *d, const hl_particle_set *set) {
  double least = INFINITY;
  for (size_t n = 0; n < set->count; n++) {
    double mass = d->masses != NULL ? (double)d->masses[set->order[n]] : 1, h = (double)set->length[n];
    if (mass > 0) least = fmin(least, mass / (PI * h * h * h));
  }
  return isfinite(least) ? (float)(0.1 * least) : 1;
}

typedef struct logarithms {
  float *field;
  size_t count;
  float least;
} logarithms;

enum { LOGARITHMS_AT_ONCE = 1 << 16 };

/* Turns densities into logarithms. The logarithm of a double, rounded to a float, is nearly everywhere the
 * same on all machines. */
static void take_logarithms(void *data, size_t index, int worker) {
  const logarithms *l = data;
  (void)worker;
  for (size_t n = index * LOGARITHMS_AT_ONCE; n < (index + 1) * LOGARITHMS_AT_ONCE && n < l->count; n++)
    l->field[n] = (float)log10((double)(l->field[n] > l->least ? l->field[n] : l->least));
}

static void divide(float *field, const float *by, size_t count) {
  for (size_t n = 0; n < count; n++) field[n] = by[n] > 0 ? field[n] / by[n] : NAN;
}

/* Appends to the field the points at the ends of periodic axes. *field is replaced. */
static hl_status close_periods(hl_context *context, const hl_particle_lattice *lattice, const char *subject,
                               float **field, hl_error *error) {
  size_t from[3], to[3];
  for (int a = 0; a < 3; a++) from[a] = hl_lattice_points(lattice, 0, a), to[a] = lattice->cells[a] + 1;
  if (from[0] == to[0] && from[1] == to[1] && from[2] == to[2]) return HL_OK;
  float *closed = hl_allocate(context, to[0] * to[1] * to[2], sizeof *closed), *at = closed;
  if (closed == NULL) return hl_fail_memory(error, to[0] * to[1] * to[2] * sizeof *closed, subject);
  for (size_t z = 0; z < to[2]; z++)
    for (size_t y = 0; y < to[1]; y++)
      for (size_t x = 0; x < to[0]; x++)
        *at++ = (*field)[((z % from[2]) * from[1] + y % from[1]) * from[0] + x % from[0]];
  hl_release(context, *field);
  *field = closed;
  return HL_OK;
}

static hl_status make_field(hl_context *context, hl_pool *pool, const hl_particles_description *d,
                            const hl_particle_set *set, const hl_particle_lattice *lattice,
                            const char *subject, float **field, hl_error *error) {
  float *density = NULL;
  bool mean = d->quantity == HL_PARTICLES_MEAN;
  hl_status status = spread(context, pool, d, set, lattice, mean, subject, field, error);
  if (status == HL_OK && mean)
    status = spread(context, pool, d, set, lattice, false, subject, &density, error);
  if (status == HL_OK && mean) divide(*field, density, point_count(lattice));
  hl_release(context, density);
  logarithms l = {*field, point_count(lattice), fmaxf(empty_density(d, set), FLT_MIN)};
  if (status == HL_OK && d->quantity == HL_PARTICLES_LOG_DENSITY)
    hl_pool_run(pool, l.count / LOGARITHMS_AT_ONCE + 1, take_logarithms, &l);
  if (status == HL_OK) status = close_periods(context, lattice, subject, field, error);
  return status;
}

static hl_status make_volume(hl_context *context, hl_pool *pool, const hl_particles_description *d,
                             const char *subject, hl_volume **volume, hl_error *error) {
  hl_particle_set set;
  hl_particle_input input = input_of(d);
  hl_particle_lattice lattice;
  float *field = NULL;
  hl_status status = hl_particles_order(context, pool, &input, subject, &set, error);
  hl_particle_limits limits = {d->spacing, most_points(context, d, set.count), d->side};
  if (status == HL_OK) status = hl_particles_lattice(&set, &limits, subject, &lattice, error);
  if (status == HL_OK) status = make_field(context, pool, d, &set, &lattice, subject, &field, error);
  if (status == HL_OK && set.count < d->count)
    hl_log(context, HL_LOG_WARNING, "%s: %zu particles without a finite place are left out", subject,
           d->count - set.count);
  hl_particles_release(context, &set);
  if (status != HL_OK) {
    hl_release(context, field);
    return status;
  }
  hl_volume_description grid;
  hl_volume_description_defaults(&grid);
  grid.type = HL_VOXEL_F32;
  for (int a = 0; a < 3; a++) {
    grid.dimensions[a] = lattice.cells[a] + 1;
    grid.origin[a] = lattice.low[a];
    grid.axis[a][a] = lattice.spacing[a];
  }
  status = hl_volume_adopt(context, &grid, subject, field, volume, error);
  if (status == HL_OK) (*volume)->is_log_density = d->quantity == HL_PARTICLES_LOG_DENSITY;
  return status;
}

hl_status hl_particles_to_volume(hl_context *context, const hl_particles_description *description,
                                 const char *subject, hl_volume **volume, hl_error *error) {
  hl_pool *pool = NULL;
  hl_status status = check(description, subject, error);
  if (status == HL_OK) status = hl_pool_create(context, description->threads, &pool, error);
  if (status != HL_OK) return status;
  status = make_volume(context, pool, description, subject, volume, error);
  hl_pool_destroy(pool);
  return status;
}

hl_status hl_volume_from_particles(hl_context *context, const hl_particles_description *description,
                                   hl_volume **volume, hl_error *error) {
  HL_DOOR;
  static const char subject[] = "particles";
  if (volume != NULL) *volume = NULL;
  if (context == NULL || description == NULL || volume == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_volume_from_particles: null context, description or volume");
  return hl_particles_to_volume(context, description, subject, volume, error);
}

hl_status hl_particles_find_smoothing(hl_context *context, const hl_particles_description *description,
                                      float *lengths, hl_error *error) {
  HL_DOOR;
  static const char subject[] = "particles";
  if (context == NULL || description == NULL || lengths == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "hl_particles_find_smoothing: null context, description or lengths");
  hl_pool *pool = NULL;
  hl_particle_set set;
  hl_status status = check(description, subject, error);
  if (status == HL_OK) status = hl_pool_create(context, description->threads, &pool, error);
  if (status != HL_OK) return status;
  hl_particle_input input = input_of(description);
  input.lengths = NULL;
  status = hl_particles_order(context, pool, &input, subject, &set, error);
  for (size_t n = 0; status == HL_OK && n < description->count; n++) lengths[n] = 0;
  for (size_t n = 0; status == HL_OK && n < set.count; n++) lengths[set.order[n]] = set.length[n];
  hl_particles_release(context, &set);
  hl_pool_destroy(pool);
  return status;
}
