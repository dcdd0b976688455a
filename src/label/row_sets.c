/* label/row_sets.c - see row_functions.h; HL_LABEL_ROWS names the table of an instruction set. */
#include "label/row_functions.h"

#include <math.h>
#include <string.h>

enum { PARTS = HL_VOXEL_PARTS, TAPS = HL_VOXEL_TAPS, ALL_PARTS = PARTS * PARTS * PARTS };

/* This function is inlined once for each reach of a filter, so that the compiler knows the reach. */
static inline __attribute__((always_inline)) void add_rows(const float *taps, int reach,
                                                           const float *const rows[HL_FILTER_ROWS],
                                                           size_t count, float *restrict out) {
  for (size_t i = 0; i < count; i++) {
    float sum = taps[0] * rows[HL_FILTER_REACH][i];
    for (int t = 1; t <= reach; t++)
      sum += taps[t] * (rows[HL_FILTER_REACH - t][i] + rows[HL_FILTER_REACH + t][i]);
    out[i] = sum;
  }
}

static void weigh(const float *taps, int reach, const float *const rows[HL_FILTER_ROWS], size_t count,
                  float *out) {
  if (reach == 2) add_rows(taps, 2, rows, count, out);
  else if (reach == 4) add_rows(taps, 4, rows, count, out);
  else add_rows(taps, HL_FILTER_REACH, rows, count, out);
}

/* Finds which voxels of a row the surface may cross. Derived: a voxel's corner lies 0.87 voxels from its
 * middle. `over` is the field's value above the level. If |over| is more than the length of the gradient g
 * times this distance, the surface does not cross the voxel. At an extremum of the field, the gradient in the
 * voxel's middle may be far smaller than beside it, so the gradient's length counts as at least a fifth.
 * `square` is the square of 2 g. */
static int32_t find_crossed(const row_neighbours *rows, size_t count, float level, float *restrict crossed) {
  const float least = 4 * 0.2f * 0.2f, reach = 0.25f;
  int32_t whole = 0;
  for (size_t i = 0; i < count; i++) {
    float over = rows->x[1][i] - level, dx = rows->x[2][i] - rows->x[0][i],
          dy = rows->y[1][i] - rows->y[0][i], dz = rows->z[1][i] - rows->z[0][i];
    float square = dx * dx + dy * dy + dz * dz, counted = square > least ? square : least;
    int32_t far = (over * over > reach * counted) | (over > 1) | (over < -1);
    whole += far & (over > 0);
    crossed[i] = (float)(1 - far);
  }
  return whole;
}

/* ---- voxels that the surface may cross ---- */

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

/* Finds the differences between neighbouring parts along a line of PARTS rows of `width` values. The
 * differences are central, but one-sided at the line's ends. The function is inlined, so that the compiler
 * knows the width. */
static inline __attribute__((always_inline)) void find_differences(const float *rows, int width,
                                                                   float *restrict differences) {
  for (int n = 0; n < width; n++) {
    differences[n] = rows[width + n] - rows[n];
    differences[(PARTS - 1) * width + n] = rows[(PARTS - 1) * width + n] - rows[(PARTS - 2) * width + n];
  }
  for (int at = 1; at < PARTS - 1; at++)
    for (int n = 0; n < width; n++)
      differences[at * width + n] = 0.5f * (rows[(at + 1) * width + n] - rows[(at - 1) * width + n]);
}

/* The least length of a gradient, per part of a voxel. A shorter gradient counts as having this length. */
static const float LEAST_GRADIENT = 0.05f / PARTS;

/* Finds the lengths of the gradients at the parts, and the fraction of each part above the level. Derived: if
 * the surface is a plane and the gradient has the length g per part, the fraction above the level t is (f -
 * t) / g + 1/2, where f is the field in the part's middle. The fraction is clamped to [0, 1] later, when
 * fractions are summed. */
static void find_shares(const float *parts, float level, float *restrict gradients, float *restrict shares) {
  float dx[ALL_PARTS], dy[ALL_PARTS], dz[ALL_PARTS];
  for (int row = 0; row < ALL_PARTS; row += PARTS) find_differences(parts + row, 1, dx + row);
  for (int plane = 0; plane < ALL_PARTS; plane += PARTS * PARTS)
    find_differences(parts + plane, PARTS, dy + plane);
  find_differences(parts, PARTS * PARTS, dz);
  for (int n = 0; n < ALL_PARTS; n++) {
    const float gradient = sqrtf(dx[n] * dx[n] + dy[n] * dy[n] + dz[n] * dz[n]);
    gradients[n] = gradient < LEAST_GRADIENT ? LEAST_GRADIENT : gradient;
    shares[n] = (parts[n] - level) / gradients[n] + 0.5f;
  }
}

/* The measures of the parts are added one after the other, so that the sums are the same with all instruction
 * sets. */
static void measure_voxel(const float weights[PARTS][TAPS], const float window[TAPS][TAPS][TAPS], float level,
                          double *measures) {
  static const double SHARE = 1.0 / ALL_PARTS;
  float parts[PARTS][PARTS][PARTS], gradients[ALL_PARTS], shares[ALL_PARTS];
  find_parts(weights, window, parts);
  find_shares(&parts[0][0][0], level, gradients, shares);
  for (int n = 0; n < ALL_PARTS; n++) {
    const float share = shares[n];
    measures[HL_ENCLOSED_VOLUME] += share <= 0 ? 0 : share >= 1 ? SHARE : SHARE * (double)share;
    if (!(share > 0 && share < 1)) continue;
    measures[HL_ENCLOSED_FALL] += SHARE / (double)gradients[n];
    measures[HL_ENCLOSED_SLOPES] += PARTS * (double)gradients[n];
    measures[HL_ENCLOSED_SURFACE_PARTS]++;
  }
}

extern const label_row_functions HL_LABEL_ROWS;
const label_row_functions HL_LABEL_ROWS = {weigh, find_crossed, measure_voxel};
