/* label/enclosed.c - see enclosed.h.
 *
 * Voxels that the surface may cross are cut into small parts. A part's share of the volume is computed as if
 * the surface were a plane within the part. The parts are small enough for this even where the surface is a
 * ball of three voxels. */
#include "label/enclosed.h"

#include <math.h>
#include <string.h>

enum { PARTS = 4 }; /* parts of a voxel along each axis */
enum { TAPS = 5 };  /* number of coefficients along an axis on which the parts of a voxel depend */

/* Sums over a slice: VOLUME, in voxels; FALL, the rate at which the volume falls as the level rises; SLOPES,
 * the gradients' lengths at the surface; SURFACE_PARTS, the number of parts in SLOPES. */
enum { VOLUME, FALL, SLOPES, SURFACE_PARTS };

/* Gradients, per part of a voxel, count as at least this length. */
static const float LEAST_GRADIENT = 0.05f / PARTS;

typedef struct measuring {
  label_enclosed *enclosed;
  float weights[PARTS][TAPS]; /* weights of the coefficients at the parts' middles */
} measuring;

/* The cubic B-spline's value at a distance. */
static double spline(double at) {
  const double a = fabs(at);
  if (a >= 2) return 0;
  return a < 1 ? 2.0 / 3 + a * a * (a / 2 - 1) : (2 - a) * (2 - a) * (2 - a) / 6;
}

static void find_weights(float weights[PARTS][TAPS]) {
  for (int part = 0; part < PARTS; part++)
    for (int tap = 0; tap < TAPS; tap++)
      weights[part][tap] = (float)spline((part + 0.5) / PARTS - 0.5 - (tap - TAPS / 2));
}

/* Collects the coefficients on which a voxel's parts depend. Beyond the field's ends the coefficients at the
 * border repeat. */
static void find_window(const label_field *field, size_t x, size_t y, size_t z,
                        float window[TAPS][TAPS][TAPS]) {
  size_t at[3][TAPS];
  const size_t middle[3] = {x, y, z};
  for (int a = 0; a < 3; a++)
    for (size_t tap = 0; tap < TAPS; tap++) {
      size_t place = middle[a] + tap < TAPS / 2 ? 0 : middle[a] + tap - TAPS / 2;
      at[a][tap] = place < field->size[a] ? place : field->size[a] - 1;
    }
  for (int k = 0; k < TAPS; k++)
    for (int j = 0; j < TAPS; j++) {
      const float *row = field->values + (at[2][k] * field->size[1] + at[1][j]) * field->size[0];
      for (int i = 0; i < TAPS; i++) window[k][j][i] = row[at[0][i]];
    }
}

/* Computes the field at the middles of a voxel's parts. */
static void find_parts(const float weights[PARTS][TAPS], const float window[TAPS][TAPS][TAPS],
                       float parts[PARTS][PARTS][PARTS]) {
  float rows[TAPS][TAPS][PARTS], planes[TAPS][PARTS][PARTS];
  memset(rows, 0, sizeof rows);
  memset(planes, 0, sizeof planes);
  memset(parts, 0, sizeof(float[PARTS][PARTS][PARTS]));
  for (int k = 0; k < TAPS; k++)
    for (int j = 0; j < TAPS; j++)
      for (int tap = 0; tap < TAPS; tap++)
        for (int i = 0; i < PARTS; i++) rows[k][j][i] += weights[i][tap] * window[k][j][tap];
  for (int k = 0; k < TAPS; k++)
    for (int j = 0; j < PARTS; j++)
      for (int tap = 0; tap < TAPS; tap++)
        for (int i = 0; i < PARTS; i++) planes[k][j][i] += weights[j][tap] * rows[k][tap][i];
  for (int k = 0; k < PARTS; k++)
    for (int tap = 0; tap < TAPS; tap++)
      for (int j = 0; j < PARTS; j++)
        for (int i = 0; i < PARTS; i++) parts[k][j][i] += weights[k][tap] * planes[tap][j][i];
}

/* The difference of neighbouring parts at `at` in a line of parts that lie `step` apart. At the line's ends
 * it is one-sided. */
static float difference(const float *parts, int at, int step) {
  const float *here = parts + at * step;
  if (at == 0) return here[step] - here[0];
  if (at == PARTS - 1) return here[0] - here[-step];
  return 0.5f * (here[step] - here[-step]);
}

/* Adds up the measures of the parts of a voxel. Derived: near a plane with the gradient g, per part, the
 * part's share above the level t is (f - t) / g + 1/2, clamped to [0, 1]. */
static void measure_parts(const float *parts, float level, double *measures) {
  enum { ROW = PARTS, PLANE = PARTS * PARTS };
  static const double SHARE = 1.0 / (PARTS * PARTS * PARTS);
  for (int n = 0; n < PARTS * PARTS * PARTS; n++) {
    const int i = n % PARTS, j = n / PARTS % PARTS, k = n / PLANE;
    const float dx = difference(parts + n - i, i, 1), dy = difference(parts + n - j * ROW, j, ROW),
                dz = difference(parts + n - k * PLANE, k, PLANE);
    float gradient = sqrtf(dx * dx + dy * dy + dz * dz);
    if (gradient < LEAST_GRADIENT) gradient = LEAST_GRADIENT;
    const float share = (parts[n] - level) / gradient + 0.5f;
    measures[VOLUME] += share <= 0 ? 0 : share >= 1 ? SHARE : SHARE * (double)share;
    if (!(share > 0 && share < 1)) continue;
    measures[FALL] += SHARE / (double)gradient;
    measures[SLOPES] += PARTS * (double)gradient;
    measures[SURFACE_PARTS]++;
  }
}

/* Marks the voxels of a row that the surface may cross. room: space for a row and two values. Returns how
 * many of the unmarked voxels are above the level. */
static int32_t find_crossed(const label_enclosed *enclosed, size_t y, size_t z, float *room, float *crossed) {
  const label_field *field = enclosed->field;
  const size_t nx = field->size[0], ny = field->size[1], nz = field->size[2], slice = nx * ny;
  const float *row = field->values + z * slice + y * nx;
  memcpy(room + 1, row, nx * sizeof *row);
  room[0] = row[0], room[nx + 1] = row[nx - 1];
  const row_neighbours rows = {{room, room + 1, room + 2},
                               {y > 0 ? row - nx : row, y + 1 < ny ? row + nx : row},
                               {z > 0 ? row - slice : row, z + 1 < nz ? row + slice : row}};
  return field->functions->find_crossed(&rows, nx, enclosed->level, crossed);
}

static void measure_row(const measuring *job, size_t y, size_t z, float *lines, double *measures) {
  const label_field *field = job->enclosed->field;
  float *crossed = lines + field->size[0] + 2;
  measures[VOLUME] += find_crossed(job->enclosed, y, z, lines, crossed);
  for (size_t x = 0; x < field->size[0]; x++) {
    if (crossed[x] == 0) continue;
    float window[TAPS][TAPS][TAPS], parts[PARTS][PARTS][PARTS];
    find_window(field, x, y, z, window);
    find_parts(job->weights, (const float(*)[TAPS][TAPS])window, parts);
    measure_parts(&parts[0][0][0], job->enclosed->level, measures);
  }
}

static void measure_slice(void *data, size_t z, int worker) {
  const measuring *job = data;
  const label_field *field = job->enclosed->field;
  float *lines = field->lines + (size_t)worker * field->line_floats;
  double *measures = job->enclosed->measures[z];
  memset(measures, 0, sizeof job->enclosed->measures[z]);
  for (size_t y = 0; y < field->size[1]; y++) measure_row(job, y, z, lines, measures);
}

void hl_label_enclose(hl_pool *pool, label_enclosed *enclosed) {
  enum { STEPS_OF_NEWTON = 2 };
  static const double FARTHEST = 0.01; /* a level farther from 1/2 would make things a voxel thin thinner than
                                        * sheets can show */
  measuring job = {.enclosed = enclosed};
  find_weights(job.weights);
  enclosed->level = 0.5f;
  enclosed->slope = 0.25;
  for (int step = 0; step < STEPS_OF_NEWTON; step++) {
    double sum[HL_ENCLOSED_MEASURES] = {0};
    hl_pool_run(pool, enclosed->field->size[2], measure_slice, &job);
    for (size_t z = 0; z < enclosed->field->size[2]; z++)
      for (int m = 0; m < HL_ENCLOSED_MEASURES; m++) sum[m] += enclosed->measures[z][m];
    if (!(sum[FALL] > 0)) return;
    enclosed->slope = sum[SLOPES] / sum[SURFACE_PARTS];
    const double level = (double)enclosed->level + (sum[VOLUME] - enclosed->wanted) / sum[FALL];
    enclosed->level = (float)fmin(fmax(level, 0.5 - FARTHEST), 0.5 + FARTHEST);
  }
}
