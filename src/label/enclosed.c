/* label/enclosed.c - see enclosed.h. */
#include "label/enclosed.h"

#include <math.h>
#include <string.h>

enum { PARTS = HL_VOXEL_PARTS, TAPS = HL_VOXEL_TAPS };

typedef struct measuring {
  label_enclosed *enclosed;
  /* weights of the coefficients on which a voxel depends along an axis, at the middle of each part of the
   * voxel */
  float weights[PARTS][TAPS];
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

/* Copies the coefficients on which a voxel's parts depend. Beyond the field's ends, the coefficients at the
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

/* Marks the voxels of a row that the surface may cross. Returns the number of other voxels whose values are
 * above the level. room: scratch memory, [voxels of the row + 2]. */
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
  measures[HL_ENCLOSED_VOLUME] += find_crossed(job->enclosed, y, z, lines, crossed);
  for (size_t x = 0; x < field->size[0]; x++) {
    if (crossed[x] == 0) continue;
    float window[TAPS][TAPS][TAPS];
    find_window(field, x, y, z, window);
    field->functions->measure_voxel(job->weights, (const float(*)[TAPS][TAPS])window, job->enclosed->level,
                                    measures);
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
  /* the greatest distance of the level from 1/2; with a level farther from 1/2, sheets would miss things that
   * are a voxel thin */
  static const double FARTHEST = 0.01;
  measuring job = {.enclosed = enclosed};
  find_weights(job.weights);
  enclosed->level = 0.5f;
  enclosed->slope = 0.25;
  for (int step = 0; step < STEPS_OF_NEWTON; step++) {
    double sum[HL_ENCLOSED_MEASURES] = {0};
    hl_pool_run(pool, enclosed->field->size[2], measure_slice, &job);
    for (size_t z = 0; z < enclosed->field->size[2]; z++)
      for (int m = 0; m < HL_ENCLOSED_MEASURES; m++) sum[m] += enclosed->measures[z][m];
    if (!(sum[HL_ENCLOSED_FALL] > 0)) return;
    enclosed->slope = sum[HL_ENCLOSED_SLOPES] / sum[HL_ENCLOSED_SURFACE_PARTS];
    const double level = (double)enclosed->level +
                         (sum[HL_ENCLOSED_VOLUME] - enclosed->wanted) / sum[HL_ENCLOSED_FALL];
    enclosed->level = (float)fmin(fmax(level, 0.5 - FARTHEST), 0.5 + FARTHEST);
  }
}
