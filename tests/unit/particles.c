/* tests/unit/particles.c - volumes of particles, against closed forms: mass, the column density of a kernel,
 * even matter, periodic boxes, and neighbours that are found by trying all. The bytes are the same with any
 * number of threads, and numbers that cannot be right are refused. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include <halflight/halflight.h>

#include "bricks/evaluate.h"
#include "core/memory.h"
#include "core/pool.h"
#include "particles/probes.h"

enum { MOST = 20000 };

static hl_context *context;
static double positions[MOST][3];
static float masses[MOST], lengths[MOST], values[MOST];

/* Numbers from 0 to 1 that are the same on every machine. */
static uint64_t seed;
static double next(void) {
  seed = seed * 6364136223846793005u + 1442695040888963407u;
  return (double)(seed >> 11) / 9007199254740992.0;
}

static hl_particles_description describe(size_t count) {
  hl_particles_description d;
  hl_particles_description_defaults(&d);
  d.count = count;
  d.positions = positions;
  d.masses = masses;
  d.lengths = lengths;
  d.quantity = HL_PARTICLES_DENSITY;
  return d;
}

/* Clusters of very different sizes, with smoothing lengths that differ as much. */
static hl_particles_description clusters(size_t count) {
  seed = 7;
  for (size_t n = 0; n < count; n++) {
    double size = pow(10, -2 * (double)(n % 5) / 4), middle = 0.5 + 0.1 * (double)(n % 5);
    for (int a = 0; a < 3; a++) positions[n][a] = middle + size * (next() - 0.5);
    masses[n] = (float)(1 + next());
    lengths[n] = (float)(size * 0.15 * (1 + next()));
    values[n] = (float)(n % 5);
  }
  hl_particles_description d = describe(count);
  d.side = 160; /* the tests look at each voxel */
  return d;
}

static hl_volume *make(const hl_particles_description *d) {
  hl_volume *volume = NULL;
  hl_error error = {0};
  hl_status status = hl_volume_from_particles(context, d, &volume, &error);
  if (status != HL_OK) print_error("%s\n", error.message);
  assert_int_equal(status, HL_OK);
  return volume;
}

static hl_volume_info info_of(const hl_volume *volume) {
  hl_volume_info info = {.struct_size = sizeof info};
  assert_int_equal(hl_volume_get_info(volume, &info), HL_OK);
  return info;
}

/* The mass of a volume. periodic: whether the last voxels along the axes are the first ones again. */
static double mass_of(const hl_volume *volume, const int periodic[3]) {
  hl_volume_info info = info_of(volume);
  double sum = 0;
  for (size_t k = 0; k < info.dimensions[2] - (size_t)periodic[2]; k++)
    for (size_t j = 0; j < info.dimensions[1] - (size_t)periodic[1]; j++)
      for (size_t i = 0; i < info.dimensions[0] - (size_t)periodic[0]; i++)
        sum += hl_volume_value(volume, i, j, k);
  return sum * info.spacing[0] * info.spacing[1] * info.spacing[2];
}

static double total_mass(size_t count) {
  double sum = 0;
  for (size_t n = 0; n < count; n++) sum += (double)masses[n];
  return sum;
}

static void mass_is_kept(void **state) {
  (void)state;
  static const int open[3] = {0, 0, 0}, slab[3] = {1, 0, 1};
  hl_particles_description d = clusters(MOST);
  hl_volume *volume = make(&d);
  assert_true(fabs(mass_of(volume, open) / total_mass(MOST) - 1) < 2e-6);
  hl_volume_release(volume);
  d.spacing = 0.07; /* wider than most of the kernels */
  volume = make(&d);
  assert_true(fabs(info_of(volume).spacing[1] / 0.07 - 1) < 1e-12);
  assert_true(fabs(mass_of(volume, open) / total_mass(MOST) - 1) < 2e-6);
  hl_volume_release(volume);
  d.spacing = 0;
  d.period[0] = 0.8, d.period[2] = 1.3;
  volume = make(&d);
  assert_true(fabs(mass_of(volume, slab) / total_mass(MOST) - 1) < 2e-6);
  hl_volume_release(volume);
}

/* The cubic B-spline at a distance, in voxels. */
static double spline(double x) {
  x = fabs(x);
  return x < 1 ? 2.0 / 3 - x * x + x * x * x / 2 : x < 2 ? (2 - x) * (2 - x) * (2 - x) / 6 : 0;
}

/* The integral of the kernel with h = 1 along a line at the distance b from its middle. */
static double column_of_kernel(double b) {
  enum { STEPS = 400 };
  double sum = 0, end = b < 2 ? sqrt(4 - b * b) : 0;
  for (int n = 0; n < STEPS; n++) {
    double z = (n + 0.5) / STEPS * end, q = sqrt(b * b + z * z);
    sum += (pow(2 - q, 3) / 4 - (q < 1 ? pow(1 - q, 3) : 0)) / 3.14159265358979;
  }
  return 2 * sum * end / STEPS;
}

/* The column density of the field at a point of the volume's lattice. The integral of a B-spline is 1. */
static double column_of_field(const hl_volume *volume, double x, double y) {
  hl_volume_info info = info_of(volume);
  double sum = 0;
  for (size_t j = 0; j < info.dimensions[1]; j++)
    for (size_t i = 0; i < info.dimensions[0]; i++) {
      if (fabs((y - info.origin[1]) / info.spacing[1] - (double)j) >= 2) break;
      double weight = spline((x - info.origin[0]) / info.spacing[0] - (double)i) *
                      spline((y - info.origin[1]) / info.spacing[1] - (double)j);
      for (size_t k = 0; weight > 0 && k < info.dimensions[2]; k++)
        sum += weight * hl_volume_value(volume, i, j, k) * info.spacing[2];
    }
  return sum;
}

/* The greatest and the root mean square error of a particle's column densities, as fractions of the greatest
 * density. */
static void column_errors(double spacing, double place, double *most, double *rms) {
  enum { RAYS = 12 };
  positions[0][0] = positions[0][1] = positions[0][2] = place;
  /* the h is so large that the lattice has more than one level */
  positions[1][0] = positions[1][1] = positions[1][2] = 40;
  masses[0] = 1, masses[1] = 0;
  lengths[0] = 1, lengths[1] = 4;
  hl_particles_description d = describe(2);
  d.spacing = spacing;
  hl_volume *volume = make(&d);
  *most = *rms = 0;
  for (int r = 0; r < RAYS; r++) {
    double b = 2.1 * r / RAYS, angle = 0.7 * r;
    double is = column_of_field(volume, place + b * cos(angle), place + b * sin(angle));
    double error = fabs(is - column_of_kernel(b)) / column_of_kernel(0);
    *most = fmax(*most, error);
    *rms += error * error / RAYS;
  }
  *rms = sqrt(*rms);
  hl_volume_release(volume);
}

/* If h is two voxels, the mass and the width are the kernel's, but the shape is not: 5 % are missing in the
 * middle. If h is nearly four voxels, the shape is right. */
static void a_particle_has_the_kernels_column(void **state) {
  (void)state;
  for (int n = 0; n < 4; n++) {
    double most, rms, place = 20.123 + 0.117 * n;
    column_errors(0.5, place, &most, &rms);
    assert_true(most < 0.055 && rms < 0.022);
    column_errors(0.25, place, &most, &rms); /* the level 1 has voxels of 0.5 */
    assert_true(most < 0.055 && rms < 0.022);
    column_errors(0.26, place, &most, &rms);
    print_message("# nearly four voxels: %.4f %.4f\n", most, rms);
    assert_true(most < 0.015 && rms < 0.007);
  }
}

/* Where many particles overlap, 57 in a kernel, the errors of single ones mostly cancel. */
static void matter_has_the_kernels_columns(void **state) {
  (void)state;
  enum { RAYS = 100 };
  double h = cbrt(57.0 / MOST * 3 / 4 / 3.14159265358979) / 2, square = 0, mean = 0;
  seed = 3;
  for (int n = 0; n < MOST; n++) {
    for (int a = 0; a < 3; a++) positions[n][a] = next();
    masses[n] = 1.0f / MOST;
    lengths[n] = (float)h;
  }
  hl_particles_description d = describe(MOST);
  d.spacing = h / 2;
  hl_volume *volume = make(&d);
  for (int r = 0; r < RAYS; r++) {
    double x = 0.2 + 0.6 * next(), y = 0.2 + 0.6 * next(), truth = 0;
    for (int n = 0; n < MOST; n++) {
      double b = hypot(positions[n][0] - x, positions[n][1] - y) / h;
      if (b < 2) truth += (double)masses[n] * column_of_kernel(b) / (h * h);
    }
    double error = column_of_field(volume, x, y) - truth;
    assert_true(fabs(error) < 0.01 * truth);
    square += error * error / RAYS, mean += truth / RAYS;
  }
  print_message("# columns of matter: rms %.5f\n", sqrt(square) / mean);
  assert_true(sqrt(square) < 0.003 * mean);
  hl_volume_release(volume);
}

/* Particles on a cubic lattice of `side`^3 points in the unit box. h: in distances of the points. */
static hl_particles_description even(int side, double h) {
  size_t n = 0;
  for (int k = 0; k < side; k++)
    for (int j = 0; j < side; j++)
      for (int i = 0; i < side; i++, n++) {
        positions[n][0] = (i + 0.3) / side, positions[n][1] = (j + 0.1) / side,
        positions[n][2] = (k + 0.9) / side;
        masses[n] = (float)(1.0 / side / side / side);
        lengths[n] = (float)(h / side);
        values[n] = 5;
      }
  hl_particles_description d = describe(n);
  for (int a = 0; a < 3; a++) d.period[a] = 1;
  return d;
}

static void even_matter_is_even(void **state) {
  (void)state;
  hl_particles_description d = even(20, 1.2);
  hl_volume *volume = make(&d);
  hl_volume_info info = info_of(volume);
  print_message("# even: %zu voxels, %.5f to %.5f\n", info.dimensions[0], info.range[0], info.range[1]);
  assert_true(info.range[0] > 0.98 && info.range[1] < 1.02);
  assert_true(info.origin[0] == 0 && fabs(info.spacing[0] * (double)(info.dimensions[0] - 1) - 1) < 1e-12);
  hl_volume_release(volume);
  d.quantity = HL_PARTICLES_LOG_DENSITY;
  volume = make(&d);
  info = info_of(volume);
  assert_true(fabs(info.range[0]) < 0.01 && fabs(info.range[1]) < 0.01);
  hl_volume_release(volume);
  d.quantity = HL_PARTICLES_MEAN;
  d.values = values;
  volume = make(&d);
  info = info_of(volume);
  assert_true(fabs(info.range[0] - 5) < 1e-5 && fabs(info.range[1] - 5) < 1e-5);
  hl_volume_release(volume);
}

static void a_period_has_no_border(void **state) {
  (void)state;
  hl_particles_description d = clusters(500);
  for (int a = 0; a < 3; a++) d.period[a] = 1;
  d.spacing = 1.0 / 64;
  hl_volume *here = make(&d);
  for (int n = 0; n < 500; n++) positions[n][0] += 24.0 / 64 + 3, positions[n][2] -= 0.5;
  hl_volume *there = make(&d);
  double most = info_of(here).range[1];
  assert_true(info_of(here).dimensions[0] == 65);
  for (size_t k = 0; k < 65; k++)
    for (size_t i = 0; i < 65; i++)
      assert_true(fabs(hl_volume_value(here, i, 40, k) -
                       hl_volume_value(there, (i + 24) % 64, 40, (k + 32) % 64)) < 1e-5 * most);
  hl_volume_release(here);
  hl_volume_release(there);
}

static int compare(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* Half of the distance to the 48th neighbour, found by looking at all particles. */
static double length_of(size_t count, size_t n, double period) {
  static double distance[MOST];
  for (size_t m = 0; m < count; m++) {
    distance[m] = 0;
    for (int a = 0; a < 3; a++) {
      double d = fabs(positions[m][a] - positions[n][a]);
      if (period > 0) d = fmod(d, period), d = fmin(d, period - d);
      distance[m] = hypot(distance[m], d);
    }
  }
  qsort(distance, count, sizeof *distance, compare);
  return distance[48 < count ? 48 : count - 1] / 2;
}

static void neighbours_are_the_nearest(void **state) {
  (void)state;
  static float found[MOST];
  for (int periodic = 0; periodic < 2; periodic++) {
    hl_particles_description d = clusters(3000);
    for (int a = 0; a < 3 && periodic; a++) d.period[a] = 0.9;
    for (int n = 100; n < 200; n++) memcpy(positions[n], positions[0], sizeof *positions); /* at one place */
    positions[700][1] = 9;
    assert_int_equal(hl_particles_find_smoothing(context, &d, found, NULL), HL_OK);
    for (size_t n = 0; n < 3000; n += 7) {
      double want = length_of(3000, n, d.period[0]);
      if (want > 0) assert_true(fabs((double)found[n] / want - 1) < 1e-4);
      else assert_true(found[n] > 0);
    }
  }
  hl_particles_description few = clusters(3);
  assert_int_equal(hl_particles_find_smoothing(context, &few, found, NULL), HL_OK);
  assert_true(fabs((double)found[1] / length_of(3, 1, 0) - 1) < 1e-5);
}

/* Makes voxels. The volume itself finds h. */
static void threads_do_not_matter(void **state) {
  (void)state;
  static const int threads[] = {1, 2, 7};
  hl_volume *volume[3];
  for (int t = 0; t < 3; t++) {
    hl_particles_description d = clusters(MOST);
    d.lengths = NULL;
    d.period[1] = 2;
    d.threads = threads[t];
    volume[t] = make(&d);
  }
  hl_volume_info info = info_of(volume[0]);
  for (int t = 1; t < 3; t++)
    for (size_t k = 0; k < info.dimensions[2]; k++)
      for (size_t j = 0; j < info.dimensions[1]; j++)
        for (size_t i = 0; i < info.dimensions[0]; i++)
          if (hl_volume_value(volume[0], i, j, k) != hl_volume_value(volume[t], i, j, k)) fail();
  for (int t = 0; t < 3; t++) hl_volume_release(volume[t]);
}

static void a_mean_is_of_mass(void **state) {
  (void)state;
  hl_particles_description d = describe(2);
  memset(positions, 0, sizeof positions[0] * 2);
  masses[0] = 1, masses[1] = 3;
  lengths[0] = lengths[1] = 1;
  values[0] = 100, values[1] = 200;
  d.quantity = HL_PARTICLES_MEAN;
  d.values = values;
  hl_volume *volume = make(&d);
  hl_volume_info info = info_of(volume);
  assert_true(fabs(info.range[0] - 175) < 1e-3 && fabs(info.range[1] - 175) < 1e-3);
  assert_true(info.nonfinite_count > 0);
  hl_volume_release(volume);
}

/* ---- bricks ---- */

static hl_particle_field spread_over(hl_pool *pool, const hl_particle_set *set, const float *weights,
                                     const hl_particle_lattice *lattice, bool in_bricks,
                                     hl_particle_plan *plan) {
  hl_particle_field field;
  assert_int_equal(hl_particles_plan(context, set, lattice, in_bricks, "test", plan, NULL), HL_OK);
  assert_int_equal(hl_particles_spread(context, pool, set, weights, plan, "test", &field, NULL), HL_OK);
  return field;
}

/* The greatest difference between the coefficients of bricks and those of an array, as a fraction of the
 * array's greatest. */
static double differ(const hl_bricks *bricks, const float *voxels, const size_t points[3]) {
  double most = 0;
  const float *voxel = voxels;
  int64_t at[3];
  for (at[2] = 0; at[2] < (int64_t)points[2]; at[2]++)
    for (at[1] = 0; at[1] < (int64_t)points[1]; at[1]++)
      for (at[0] = 0; at[0] < (int64_t)points[0]; at[0]++, voxel++) {
        double in_bricks = (double)hl_bricks_coefficient(bricks, at);
        if (*voxel == 0) assert_true(in_bricks == 0);
        else most = fmax(most, fabs(in_bricks / (double)*voxel - 1));
      }
  return most;
}

static void compare_bricks(hl_pool *pool, const double period[3], size_t side) {
  hl_particles_description d = clusters(2000);
  hl_particle_input input = {.count = d.count, .positions = positions, .is_double = true, .lengths = lengths};
  for (int a = 0; a < 3; a++) input.period[a] = period[a];
  hl_particle_set set;
  hl_particle_lattice lattice;
  hl_particle_plan in_bricks, all;
  const hl_particle_limits limits = {0, SIZE_MAX, side};
  assert_int_equal(hl_particles_order(context, pool, &input, "test", &set, NULL), HL_OK);
  assert_int_equal(hl_particles_lattice(&set, &limits, "test", &lattice, NULL), HL_OK);
  hl_particle_field field = spread_over(pool, &set, masses, &lattice, true, &in_bricks),
                    dense = spread_over(pool, &set, masses, &lattice, false, &all);
  const size_t points[3] = {lattice.cells[0] + 1, lattice.cells[1] + 1, lattice.cells[2] + 1};
  float *voxels = hl_allocate(context, points[0] * points[1] * points[2], sizeof *voxels);
  hl_bricks bricks;
  assert_non_null(voxels);
  hl_particle_field_copy(&dense, pool, voxels);
  assert_int_equal(hl_particle_field_bricks(context, pool, &field, "test", &bricks, NULL), HL_OK);
  double difference = differ(&bricks, voxels, points),
         part = hl_particle_plan_brick_bytes(&in_bricks) /
                (4.0 * (double)(points[0] * points[1] * points[2]));
  print_message(
      "# %zu x %zu x %zu points, %d levels: %zu bricks, %.3f of the voxels' bytes, difference %.2g\n",
      points[0], points[1], points[2], lattice.levels, in_bricks.leaf_count, part, difference);
  assert_true(lattice.levels >= 3 && part < 0.6);
  assert_true(difference < 1e-5);
  hl_bricks_release(context, &bricks);
  hl_release(context, voxels);
  hl_particle_field_release(context, &field);
  hl_particle_field_release(context, &dense);
  hl_particle_plan_release(context, &in_bricks);
  hl_particle_plan_release(context, &all);
  hl_particles_release(context, &set);
}

/* The field in bricks has the coefficients of the field of all points, and so the same mass. */
static void bricks_have_all_coefficients(void **state) {
  (void)state;
  hl_pool *pool = NULL;
  assert_int_equal(hl_pool_create(context, 2, &pool, NULL), HL_OK);
  compare_bricks(pool, (const double[3]){0, 0, 0}, 240);
  compare_bricks(pool, (const double[3]){1.2, 1.3, 1.7}, 250);
  compare_bricks(pool, (const double[3]){0, 1.1, 0}, 200);
  hl_pool_destroy(pool);
}

/* ---- how far a field is from the kernels ---- */

/* The sum of W(r / h) / (pi h^3) over all particles, one by one. */
static double sum_of_all(const hl_particle_set *set, const double period[3], const uint32_t place[3]) {
  double sum = 0;
  for (size_t n = 0; n < set->count; n++) {
    double squared = 0, h = (double)set->length[n];
    for (int a = 0; a < 3; a++) {
      double away = fabs(((double)set->place[n][a] - (double)place[a]) * set->unit[a]);
      if (period[a] > 0) away = fmin(away, period[a] - away);
      squared += away * away;
    }
    const double q = sqrt(squared) / h, outer = fmax(2 - q, 0), inner = fmax(1 - q, 0);
    sum += (double)masses[set->order[n]] * (outer * outer * outer / 4 - inner * inner * inner) /
           (3.14159265358979 * h * h * h);
  }
  return sum;
}

static void compare_sums(const double period[3], int threads) {
  enum { COUNT = 2000 };
  hl_particles_description d = clusters(COUNT);
  hl_particle_input input = {.count = d.count, .positions = positions, .is_double = true, .lengths = lengths};
  for (int a = 0; a < 3; a++) input.period[a] = period[a];
  hl_pool *pool = NULL;
  hl_particle_set set;
  hl_particle_lattice lattice;
  hl_particle_plan plan;
  hl_particle_probes probes;
  static double sums[HL_PARTICLE_PROBES];
  static float weights[COUNT];
  const hl_particle_limits limits = {0, SIZE_MAX, 240};
  assert_int_equal(hl_pool_create(context, threads, &pool, NULL), HL_OK);
  assert_int_equal(hl_particles_order(context, pool, &input, "test", &set, NULL), HL_OK);
  assert_int_equal(hl_particles_lattice(&set, &limits, "test", &lattice, NULL), HL_OK);
  assert_int_equal(hl_particles_plan(context, &set, &lattice, true, "test", &plan, NULL), HL_OK);
  assert_int_equal(hl_particle_probes_choose(context, &set, &lattice, "test", &probes, NULL), HL_OK);
  assert_int_equal(probes.count, COUNT);
  for (size_t n = 0; n < COUNT; n++) weights[n] = masses[set.order[n]];
  assert_int_equal(hl_particle_probes_sum(context, pool, &set, weights, &plan, &probes, "test", sums, NULL),
                   HL_OK);
  for (size_t q = 0; q < COUNT; q += 7)
    assert_true(fabs(sums[q] / sum_of_all(&set, period, probes.place[q]) - 1) < 1e-4);
  hl_particle_probes_release(context, &probes);
  hl_particle_plan_release(context, &plan);
  hl_particles_release(context, &set);
  hl_pool_destroy(pool);
}

static void probes_are_sums_of_all_kernels(void **state) {
  (void)state;
  compare_sums((const double[3]){0, 0, 0}, 1);
  compare_sums((const double[3]){1.2, 1.3, 1.7}, 2);
}

/* The field of a single particle differs from its kernel most in the middle, where the kernel is 1 / (pi
 * h^3). The particle is put into a level whose voxels are at most h / 2. A lattice that does not resolve the
 * kernel keeps little of its height. */
static void the_difference_is_told(void **state) {
  (void)state;
  static const double spacings[2] = {0.5, 4};
  double told[2];
  for (int n = 0; n < 2; n++) {
    hl_particles_description d = describe(1);
    for (int a = 0; a < 3; a++) positions[0][a] = 0;
    masses[0] = lengths[0] = 1;
    d.spacing = spacings[n];
    hl_volume *volume = make(&d);
    hl_volume_field_error e = {.struct_size = sizeof e};
    assert_int_equal(hl_volume_get_field_error(volume, &e), HL_OK);
    assert_string_equal(e.kind, "sampled");
    told[n] = e.value * 3.14159265358979;
    print_message("# spacing %g h: %.2g of the kernel's height\n", spacings[n], told[n]);
    hl_volume_release(volume);
  }
  assert_true(told[0] > 0.01 && told[0] < 0.12 && told[1] > 0.8 && told[1] < 1);
}

static void expect(const hl_particles_description *d, hl_status code, const char *part) {
  hl_volume *volume = NULL;
  hl_error error = {0};
  assert_int_equal(hl_volume_from_particles(context, d, &volume, &error), code);
  assert_null(volume);
  assert_non_null(strstr(error.message, part));
}

static void wrong_numbers_are_refused(void **state) {
  (void)state;
  hl_particles_description d = clusters(100);
  masses[5] = -1;
  expect(&d, HL_ERROR_INPUT, "mass of particle 5");
  masses[5] = 1, lengths[7] = 0;
  expect(&d, HL_ERROR_INPUT, "smoothing length of particle 7");
  lengths[7] = 1, d.period[1] = NAN;
  expect(&d, HL_ERROR_INPUT, "period");
  d.period[1] = 0, d.quantity = HL_PARTICLES_MEAN;
  expect(&d, HL_ERROR_ARGUMENT, "values is null");
  d.quantity = HL_PARTICLES_DENSITY, d.spacing = 1e-9;
  expect(&d, HL_ERROR_MEMORY, "spacing");
  d.spacing = 0, d.lengths = NULL;
  for (int n = 0; n < 100; n++) positions[n][0] = positions[n][1] = positions[n][2] = 3;
  expect(&d, HL_ERROR_INPUT, "at one place");
  for (int n = 0; n < 100; n++) positions[n][0] = NAN;
  expect(&d, HL_ERROR_INPUT, "finite place");
  d.count = 0;
  expect(&d, HL_ERROR_INPUT, "no particles");
}

/* Smoothing lengths from nearly 0 to far more than the box, places far away, and some that are not finite. */
static void wild_numbers_make_volumes(void **state) {
  (void)state;
  hl_particles_description d = clusters(1000);
  for (int n = 0; n < 1000; n++) lengths[n] = (float)pow(10, 60 * next() - 30);
  for (int n = 0; n < 10; n++) positions[n][n % 3] = n % 2 ? NAN : 1e12;
  hl_volume_release(make(&d));
  for (int n = 0; n < 1000; n++) lengths[n] = 1e30f;
  hl_volume_release(make(&d));
  for (int n = 0; n < 1000; n++) lengths[n] = 1e-30f;
  hl_volume_release(make(&d));
  for (int a = 0; a < 3; a++) d.period[a] = pow(10, 3 * a - 3);
  hl_volume_release(make(&d));
  d.lengths = NULL;
  hl_volume_release(make(&d));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(mass_is_kept),
      cmocka_unit_test(a_particle_has_the_kernels_column),
      cmocka_unit_test(matter_has_the_kernels_columns),
      cmocka_unit_test(even_matter_is_even),
      cmocka_unit_test(a_period_has_no_border),
      cmocka_unit_test(neighbours_are_the_nearest),
      cmocka_unit_test(threads_do_not_matter),
      cmocka_unit_test(a_mean_is_of_mass),
      cmocka_unit_test(bricks_have_all_coefficients),
      cmocka_unit_test(probes_are_sums_of_all_kernels),
      cmocka_unit_test(the_difference_is_told),
      cmocka_unit_test(wrong_numbers_are_refused),
      cmocka_unit_test(wild_numbers_make_volumes),
  };
  hl_context_options options;
  hl_context_options_defaults(&options);
  options.memory_limit = (uint64_t)1 << 30;
  if (hl_context_create(&options, &context, NULL) != HL_OK) return 1;
  int failed = cmocka_run_group_tests(tests, NULL, NULL);
  hl_context_destroy(context);
  return failed;
}
