/* label/row_sets.c - see row_functions.h; HL_LABEL_ROWS names the table of an instruction set. */
#include "label/row_functions.h"

/* Inlined once for each reach, so that the compiler knows the reach. */
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

/* Derived: a voxel's corner lies 0.87 voxels from its middle. Where |over| is more than the length of the
 * gradient g times this distance, the surface does not cross the voxel. Where a field turns round, the
 * gradient in the middle tells little; its length therefore counts as at least a fifth. `squares` are squares
 * of 2 g. */
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

extern const label_row_functions HL_LABEL_ROWS;
const label_row_functions HL_LABEL_ROWS = {weigh, find_crossed};
