/* grid/field.c - see field.h. */
#include "grid/field.h"

#include "bricks/evaluate.h"

/* Finds the kernel's value at a distance, and the derivative of this value with respect to the coordinate. */
static void kernel_at(const kernel *kernel, double distance, double *value, double *slope) {
  double a = fabs(distance), sum = 0, rise = 0;
  *value = *slope = 0;
  if (a >= (double)kernel->support) return;
  const float *piece = a < 1 ? kernel->inner : kernel->outer;
  if (a >= 1) a -= 1;
  for (int power = kernel->degree; power >= 0; power--) {
    rise = rise * a + sum; /* Horner's scheme gives the derivative */
    sum = sum * a + (double)piece[power];
  }
  *value = sum;
  *slope = distance < 0 ? -rise : rise;
}

static field_taps taps_and_slopes(const kernel *kernel, double at, double slope[FIELD_TAPS]) {
  field_taps taps = {.first = (int32_t)floor(at) - 1};
  for (int tap = 0; tap < FIELD_TAPS; tap++)
    kernel_at(kernel, at - (taps.first + tap), &taps.weight[tap], &slope[tap]);
  return taps;
}

field_taps hl_field_taps(const kernel *kernel, double at) {
  double slope[FIELD_TAPS];
  return taps_and_slopes(kernel, at, slope);
}

/* ---- voxels ---- */

float hl_value_outside_memory(const grid *grid, int64_t x, int64_t y, int64_t z) {
  const int64_t wanted[3] = {x, y, z};
  size_t at[3];
  if (grid->bricks != NULL)
    return hl_bricks_coefficient(grid->bricks, (const int64_t[3]){x + 1, y + 1, z + 1});
  for (int axis = 0; axis < 3; axis++) {
    int64_t last = grid->dimension[axis] - 1;
    at[axis] = (size_t)(wanted[axis] < 0 ? 0 : wanted[axis] > last ? last : wanted[axis]);
  }
  return (float)hl_page_number(grid->pages, at[0], at[1], at[2]);
}

static void copy_row(const grid *grid, const unsigned char *row, int32_t count, double *values) {
  switch (grid->storage) {
    case HL_STORAGE_U8:
      for (int32_t i = 0; i < count; i++) values[i] = row[i];
      break;
    case HL_STORAGE_U16:
      for (int32_t i = 0; i < count; i++) values[i] = ((const uint16_t *)row)[i];
      break;
    default:
      for (int32_t i = 0; i < count; i++) values[i] = (double)((const float *)row)[i];
      break;
  }
}

static size_t voxel_bytes(const grid *grid) {
  return grid->storage == HL_STORAGE_U8 ? 1 : grid->storage == HL_STORAGE_U16 ? 2 : 4;
}

void hl_field_window(const grid *grid, const int32_t first[3], const int32_t size[3], double *values) {
  if (grid->bricks != NULL) {
    const int64_t point[3] = {(int64_t)first[0] + 1, (int64_t)first[1] + 1, (int64_t)first[2] + 1};
    hl_bricks_window(grid->bricks, point, (const int64_t[3]){size[0], size[1], size[2]}, values);
    return;
  }
  bool within = grid->voxels != NULL;
  for (int axis = 0; axis < 3; axis++)
    within = within && first[axis] >= 0 && first[axis] + size[axis] <= grid->dimension[axis];
  for (int32_t k = 0; k < size[2]; k++)
    for (int32_t j = 0; j < size[1]; j++, values += size[0]) {
      if (within) {
        copy_row(grid, hl_grid_row(grid, first[1] + j, first[2] + k) + (size_t)first[0] * voxel_bytes(grid),
                 size[0], values);
        continue;
      }
      for (int32_t i = 0; i < size[0]; i++)
        values[i] = (double)hl_stored_value(grid, first[0] + i, first[1] + j, first[2] + k);
    }
}

/* ---- sums ---- */

double hl_field_value_and_slope(const grid *grid, const kernel *kernel, vec3 at, vec3 *slope) {
  static const int32_t size[3] = {FIELD_TAPS, FIELD_TAPS, FIELD_TAPS};
  double rise[3][FIELD_TAPS], voxels[FIELD_TAPS * FIELD_TAPS * FIELD_TAPS], value = 0;
  const field_taps x = taps_and_slopes(kernel, at.x, rise[0]), y = taps_and_slopes(kernel, at.y, rise[1]),
                   z = taps_and_slopes(kernel, at.z, rise[2]);
  hl_field_window(grid, (int32_t[3]){x.first, y.first, z.first}, size, voxels);
  *slope = (vec3){0, 0, 0};
  for (int k = 0; k < FIELD_TAPS; k++) {
    double slice = 0, slice_x = 0, slice_y = 0;
    for (int j = 0; j < FIELD_TAPS; j++) {
      const double *row = voxels + (k * FIELD_TAPS + j) * FIELD_TAPS;
      double sum = 0, sum_x = 0;
      for (int i = 0; i < FIELD_TAPS; i++) sum += x.weight[i] * row[i], sum_x += rise[0][i] * row[i];
      slice += y.weight[j] * sum;
      slice_x += y.weight[j] * sum_x;
      slice_y += rise[1][j] * sum;
    }
    value += z.weight[k] * slice;
    slope->x += z.weight[k] * slice_x;
    slope->y += z.weight[k] * slice_y;
    slope->z += rise[2][k] * slice;
  }
  return value;
}
