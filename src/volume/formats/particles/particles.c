/* volume/formats/particles/particles.c - makes volumes of particles. The functions check the caller's arrays,
 * and make the volume from the particles' field.
 *
 * In: a description of particles, from a caller or from the reader of a file. Out: a volume of the particles'
 * density, of its logarithm, or of the mean of a value. particles/particles.h computes the field. */
#include "volume/formats/particles/particles.h"

#include <float.h>
#include <math.h>

#include "core/context.h"
#include "core/door.h"
#include "core/memory.h"
#include "core/vector.h"
#include "elementary/elementary.h"
#include "particles/particles.h"
#include "volume/formats/particles/difference.h"
#include "volume/in_bricks.h"

enum {
  SIDE = 512,            /* the default of the greatest number of voxels along an axis */
  POINTS_A_PARTICLE = 64 /* the default of the greatest number of voxels for each particle. Kernels of 48
                          * neighbours need 6 voxels for each particle if h = 2 voxels, and more if particles
                          * cluster */
};
#define LEAST_POINTS ((size_t)1 << 21)
#define MOST_POINTS  ((size_t)1 << 31)

void hl_particles_description_defaults(hl_particles_description *description) {
  if (description == NULL) return;
  *description = (hl_particles_description){
      .struct_size = sizeof *description, .position_type = HL_VOXEL_F64, .outside = NAN, .side = SIDE};
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

/* ---- from particles to a field ---- */

/* The state of one call of hl_particles_to_volume(). */
typedef struct making {
  hl_context *context;
  hl_pool *pool;
  const hl_particles_description *d;
  hl_particle_set set;
  const char *subject;
  hl_error *error;
} making;

static hl_particle_input input_of(const hl_particles_description *d) {
  hl_particle_input input = {.count = d->count,
                             .positions = d->positions,
                             .is_double = d->position_type == HL_VOXEL_F64,
                             .lengths = d->lengths};
  for (int a = 0; a < 3; a++) input.period_low[a] = d->period_low[a], input.period[a] = d->period[a];
  return input;
}

/* The greatest number of voxels of the volume. The voxels, and the fields that are made beside them, may take
 * half of the memory limit. */
static size_t most_points(const hl_context *context, const hl_particles_description *d, size_t count) {
  size_t fields = d->quantity == HL_PARTICLES_MEAN ? 3 : 2, most = MOST_POINTS;
  if (d->spacing == 0) {
    most = count < MOST_POINTS / POINTS_A_PARTICLE ? count * POINTS_A_PARTICLE : MOST_POINTS;
    if (most < LEAST_POINTS) most = LEAST_POINTS;
  }
  uint64_t limit = context->options.memory_limit, room = limit / 2 / sizeof(float) / fields;
  return limit > 0 && room < most ? (size_t)room : most;
}

/* The weights of the particles' kernels, in the order of the set: masses, or masses times values. */
static float *weights_of(hl_context *context, const hl_particles_description *d, const hl_particle_set *set,
                         bool with_values) {
  float *weights = hl_allocate(context, set->count, sizeof *weights);
  for (size_t n = 0; weights != NULL && n < set->count; n++) {
    size_t from = set->order[n];
    weights[n] = (d->masses != NULL ? d->masses[from] : 1) * (with_values ? d->values[from] : 1);
  }
  return weights;
}

/* Adds the particles' kernels to the field, and sums the kernels at the probes' positions. sums:
 * [truth->probes.count]. */
static hl_status spread(const making *m, const hl_particle_plan *plan, const hl_particle_truth *truth,
                        bool with_values, hl_particle_field *field, double *sums) {
  float *weights = NULL; /* null if each weight is 1 */
  if (m->d->masses != NULL || with_values) {
    weights = weights_of(m->context, m->d, &m->set, with_values);
    if (weights == NULL) return hl_fail_memory(m->error, m->set.count * sizeof *weights, m->subject);
  }
  hl_status status = hl_particle_probes_sum(m->context, m->pool, &m->set, weights, plan, &truth->probes,
                                            m->subject, sums, m->error);
  if (status == HL_OK)
    status = hl_particles_spread(m->context, m->pool, &m->set, weights, plan, m->subject, field, m->error);
  hl_release(m->context, weights);
  return status;
}

/* The density below which a voxel counts as empty. An isolated particle has the density m W(0) = m / (pi h^3)
 * at its own position. The result is a tenth of the least density of an isolated particle. */
static float empty_density(const hl_particles_description *d, const hl_particle_set *set) {
  double least = INFINITY;
  for (size_t n = 0; n < set->count; n++) {
    double mass = d->masses != NULL ? (double)d->masses[set->order[n]] : 1, h = (double)set->length[n];
    if (mass > 0) least = fmin(least, mass / (HL_PI * h * h * h));
  }
  return isfinite(least) ? (float)(0.1 * least) : 1;
}

static float least_density(const making *m) { return fmaxf(empty_density(m->d, &m->set), FLT_MIN); }

/* The numbers of a field, and the conversion that is applied to them. */
typedef struct conversion {
  float *field;
  const float *by; /* the density, for means */
  size_t count;
  float least;   /* for logarithms: lower densities are raised to this density */
  float outside; /* for means */
} conversion;

enum { NUMBERS_AT_ONCE = 1 << 16 };

/* Replaces densities by their logarithms. Logarithms are computed in double precision and then rounded to
 * floats, so that nearly all results are the same on all machines. */
static void take_logarithms(void *data, size_t index, int worker) {
  const conversion *c = data;
  (void)worker;
  for (size_t n = index * NUMBERS_AT_ONCE; n < (index + 1) * NUMBERS_AT_ONCE && n < c->count; n++)
    c->field[n] = (float)hl_log10((double)(c->field[n] > c->least ? c->field[n] : c->least));
}

static void divide(void *data, size_t index, int worker) {
  const conversion *c = data;
  (void)worker;
  for (size_t n = index * NUMBERS_AT_ONCE; n < (index + 1) * NUMBERS_AT_ONCE && n < c->count; n++)
    c->field[n] = c->by[n] > 0 ? c->field[n] / c->by[n] : c->outside;
}

/* Converts the field from densities to the wanted quantity, on all levels that become part of the volume.
 * density: the field of the density if the quantity is a mean; else null. */
static void convert(const making *m, hl_particle_field *field, const hl_particle_field *density) {
  bool in_bricks = field->plan->leaves != NULL;
  if (m->d->quantity == HL_PARTICLES_DENSITY) return;
  conversion c = {.least = least_density(m), .outside = m->d->outside};
  for (int level = 0; level < (in_bricks ? field->plan->lattice.levels : 1); level++) {
    c.field = field->points[level];
    c.by = density != NULL ? density->points[level] : NULL;
    c.count = hl_particle_field_floats(field, level);
    hl_pool_run(m->pool, c.count / NUMBERS_AT_ONCE + 1, density != NULL ? divide : take_logarithms, &c);
  }
  field->outside = density != NULL ? c.outside : (float)hl_log10((double)c.least);
}

/* Converts the sums of kernels at the probes' positions in the same way as convert() converts the field.
 * densities: for a mean, the sums of the masses; else null. */
static void convert_truth(const making *m, const double *densities, hl_particle_truth *truth) {
  const double least = (double)least_density(m);
  for (size_t q = 0; q < truth->probes.count; q++) {
    double *value = &truth->values[q];
    if (densities != NULL) *value /= densities[q];
    if (m->d->quantity == HL_PARTICLES_LOG_DENSITY) *value = hl_log10(fmax(*value, least));
  }
}

/* Makes the field of the wanted quantity, and its exact values at a few positions. */
static hl_status make_field(const making *m, const hl_particle_plan *plan, hl_particle_field *field,
                            hl_particle_truth *truth) {
  hl_particle_field density = {.plan = NULL};
  const bool mean = m->d->quantity == HL_PARTICLES_MEAN;
  hl_status status = hl_particle_probes_choose(m->context, &m->set, &plan->lattice, m->subject,
                                               &truth->probes, m->error);
  if (status != HL_OK) return status;
  const size_t count = truth->probes.count;
  double *densities = NULL;
  truth->values = hl_allocate(m->context, count, sizeof(double));
  if (mean) densities = hl_allocate(m->context, count, sizeof(double));
  if (truth->values == NULL || (mean && densities == NULL))
    status = hl_fail_memory(m->error, count * sizeof(double), m->subject);
  if (status == HL_OK) status = spread(m, plan, truth, mean, field, truth->values);
  if (status == HL_OK && mean) status = spread(m, plan, truth, false, &density, densities);
  if (status == HL_OK) {
    convert(m, field, mean ? &density : NULL);
    convert_truth(m, densities, truth);
  }
  hl_release(m->context, densities);
  hl_particle_field_release(m->context, &density);
  return status;
}

/* ---- the lattice, and whether the field becomes bricks ---- */

/* The field becomes bricks if the bricks take less memory than this fraction of an array of all voxels. The
 * fraction is chosen, not measured. Bricks must save much memory, because they are sampled more slowly than
 * voxels. */
#define BRICKS_PART 0.6
/* The greatest number of bytes of bricks and of the fields from which they are made, if the context has no
 * memory limit. */
#define BRICK_BYTES 1073741824.0

static size_t fields_of(const hl_particles_description *d) {
  return d->quantity == HL_PARTICLES_MEAN ? 2 : 1;
}

static double voxel_bytes(const hl_particle_lattice *lattice) {
  double bytes = sizeof(float);
  for (int a = 0; a < 3; a++) bytes *= (double)lattice->cells[a] + 1;
  return bytes;
}

/* Plans a field in bricks. If the bricks take too much memory, the spacing is increased, unless the caller
 * wants a certain spacing. *plan has no leaves if an array of voxels is better, or if bricks of the wanted
 * spacing take too much memory. */
static hl_status plan_bricks(const making *m, hl_particle_plan *plan) {
  const uint64_t limit = m->context->options.memory_limit;
  const double most = limit > 0 ? (double)limit / 2 : BRICK_BYTES;
  hl_particle_limits limits = {m->d->spacing, SIZE_MAX, m->d->side};
  hl_particle_lattice lattice;
  for (;;) {
    if (hl_particles_lattice(&m->set, &limits, m->subject, &lattice, m->error) != HL_OK) return HL_OK;
    hl_status status = hl_particles_plan(m->context, &m->set, &lattice, true, m->subject, plan, m->error);
    if (status != HL_OK) return status;
    double bricks = hl_particle_plan_brick_bytes(plan),
           bytes = bricks + (double)fields_of(m->d) * hl_particle_plan_field_bytes(plan);
    bool sparse = plan->leaves != NULL && bricks < BRICKS_PART * voxel_bytes(&lattice);
    if (sparse && bytes <= most) return HL_OK;
    hl_particle_plan_release(m->context, plan);
    if (!sparse || m->d->spacing > 0) return HL_OK;
    limits.spacing = fmax(fmax(lattice.spacing[0], lattice.spacing[1]), lattice.spacing[2]) *
                     fmax(hl_cbrt(bytes / most), 1.05);
  }
}

static hl_status choose_plan(const making *m, hl_particle_plan *plan) {
  hl_particle_limits limits = {m->d->spacing, most_points(m->context, m->d, m->set.count), m->d->side};
  hl_particle_lattice lattice;
  hl_status status = plan_bricks(m, plan);
  if (status != HL_OK || plan->leaves != NULL) return status;
  status = hl_particles_lattice(&m->set, &limits, m->subject, &lattice, m->error);
  if (status == HL_OK)
    status = hl_particles_plan(m->context, &m->set, &lattice, false, m->subject, plan, m->error);
  return status;
}

/* ---- the volume ---- */

static hl_status take_bricks(const making *m, const hl_volume_description *grid, hl_particle_field *field,
                             hl_volume **volume) {
  hl_bricks bricks;
  hl_status status = hl_particle_field_bricks(m->context, m->pool, field, m->subject, &bricks, m->error);
  hl_particle_field_release(m->context, field);
  return status == HL_OK ? hl_volume_take_bricks(m->context, &bricks, grid, m->subject, volume, m->error)
                         : status;
}

static hl_status take_voxels(const making *m, const hl_volume_description *grid, hl_particle_field *field,
                             hl_volume **volume) {
  size_t count = grid->dimensions[0] * grid->dimensions[1] * grid->dimensions[2];
  float *voxels = hl_allocate(m->context, count, sizeof *voxels);
  if (voxels == NULL) return hl_fail_memory(m->error, count * sizeof *voxels, m->subject);
  hl_particle_field_copy(field, m->pool, voxels);
  hl_particle_field_release(m->context, field);
  if (!hl_pool_cancelled(m->pool))
    return hl_volume_adopt(m->context, grid, m->subject, voxels, volume, m->error);
  hl_release(m->context, voxels);
  return hl_fail(m->error, HL_ERROR_CANCELLED, "%s: stopped", m->subject);
}

static hl_status take_field(const making *m, hl_particle_field *field, hl_volume **volume) {
  const hl_particle_lattice *lattice = &field->plan->lattice;
  hl_volume_description grid;
  hl_volume_description_defaults(&grid);
  grid.type = HL_VOXEL_F32;
  for (int a = 0; a < 3; a++) {
    grid.dimensions[a] = lattice->cells[a] + 1;
    grid.origin[a] = lattice->low[a];
    grid.axis[a][a] = lattice->spacing[a];
  }
  hl_status status = field->plan->leaves != NULL ? take_bricks(m, &grid, field, volume)
                                                 : take_voxels(m, &grid, field, volume);
  if (status == HL_OK) (*volume)->is_log_density = m->d->quantity == HL_PARTICLES_LOG_DENSITY;
  return status;
}

static hl_status make_volume(making *m, hl_volume **volume) {
  hl_particle_input input = input_of(m->d);
  hl_particle_plan plan = {.leaves = NULL};
  hl_particle_field field = {.plan = NULL};
  hl_particle_truth truth = {.values = NULL};
  hl_status status = hl_particles_order(m->context, m->pool, &input, m->subject, &m->set, m->error);
  if (status == HL_OK) status = choose_plan(m, &plan);
  if (status == HL_OK) status = make_field(m, &plan, &field, &truth);
  if (status == HL_OK && m->set.count < m->d->count)
    hl_log(m->context, HL_LOG_WARNING, "%s: %zu particles without a finite place are left out", m->subject,
           m->d->count - m->set.count);
  hl_particles_release(m->context, &m->set);
  if (status == HL_OK) status = take_field(m, &field, volume);
  if (status == HL_OK) hl_particle_truth_compare(&truth, *volume);
  hl_particle_truth_release(m->context, &truth);
  hl_particle_field_release(m->context, &field);
  hl_particle_plan_release(m->context, &plan);
  return status;
}

hl_status hl_particles_to_volume(hl_context *context, const hl_particles_description *description,
                                 const char *subject, hl_volume **volume, hl_error *error) {
  hl_pool *pool = NULL;
  hl_status status = check(description, subject, error);
  if (status == HL_OK) status = hl_pool_create(context, description->threads, &pool, error);
  if (status != HL_OK) return status;
  making m = {.context = context, .pool = pool, .d = description, .subject = subject, .error = error};
  status = make_volume(&m, volume);
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
