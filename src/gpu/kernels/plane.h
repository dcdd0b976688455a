/* gpu/kernels/plane.h - evaluates a transfer function of value and gradient along a row of its tables. The
 * functions compute for one pixel the same numbers as fill/plane_lanes.h for sixteen. */
#ifndef HL_GPU_PLANE_H
#define HL_GPU_PLANE_H

#include "gpu/device_sweep.h"
#include "gpu/kernels/numbers.h"

/* The tables, [PLAN_PLANE_FLOATS] each. column = coordinate in the volume's other tables * column_scale +
 * column_offset. */
typedef struct plane_data {
  GLOBAL const float *sums, *color;
  float column_scale, column_offset;
} plane_data;

/* The row of the tables for a gradient. slope: the gradient, in stored units per frame unit. */
DEVICE float row_of_slope(vector slope, float scale, float offset) {
  const vector steps = scaled(slope, scale);
  return limited(root(dot3(steps, steps)) + offset, 0.0f, PLAN_PLANE_ROWS - 1);
}

DEVICE float column_of_plane(const plane_data *plane, float coordinate) {
  return fused(coordinate, plane->column_scale, plane->column_offset);
}

DEVICE float limited_column(float column) { return limited(column, 0.0f, PLAN_PLANE_COLUMNS - 1); }

/* Extinction at a column, and its integral over columns up to that column. */
DEVICE void sums_at_column(const plane_data *plane, float row, float column, float sums[2]) {
  const int whole_row = (int)row, whole = (int)column;
  const float of_rows = row - (float)whole_row, part = column - (float)whole;
  GLOBAL const float *here = plane->sums + (whole_row * PLAN_PLANE_STRIDE + whole) * 4, *next = here + 4;
  float of_row[2][2];
  for (int r = 0; r < 2; r++) {
    const float rise = next[2 * r] - here[2 * r];
    of_row[r][0] = fused(rise, part, here[2 * r]);
    of_row[r][1] = fused(fused(rise * 0.5f, part, here[2 * r]), part, here[2 * r + 1]);
  }
  for (int i = 0; i < 2; i++) sums[i] = fused(of_row[1][i] - of_row[0][i], of_rows, of_row[0][i]);
}

/* The mean extinction in a row between two coordinates. */
DEVICE float extinction_in_row(const plane_data *plane, float row, float from, float to) {
  const float a = column_of_plane(plane, from), b = column_of_plane(plane, to), distance = b - a;
  float at_a[2], at_b[2];
  sums_at_column(plane, row, limited_column(a), at_a);
  sums_at_column(plane, row, limited_column(b), at_b);
  if (magnitude(distance) > 2.0f) return greater(divided(at_b[1] - at_a[1], distance), 0.0f);
  return (at_a[0] + at_b[0]) * 0.5f;
}

/* The sums of colour times opacity, and of opacity, over columns from the row's start to a column. */
DEVICE void colors_at_column(const plane_data *plane, float row, float column, float sums[4]) {
  const int whole_row = (int)row, whole = (int)column;
  const float of_rows = row - (float)whole_row, part = column - (float)whole;
  GLOBAL const float *here = plane->color + (whole_row * PLAN_PLANE_STRIDE + whole) * 4,
                     *below = here + PLAN_PLANE_STRIDE * 4;
  for (int i = 0; i < 4; i++) {
    const float first = fused(here[4 + i] - here[i], part, here[i]),
                second = fused(below[4 + i] - below[i], part, below[i]);
    sums[i] = fused(second - first, of_rows, first);
  }
}

/* The sums over the columns between two columns and one further column on either side. */
DEVICE void colors_between(const plane_data *plane, float row, float a, float b, float sums[4]) {
  float low[4], high[4];
  colors_at_column(plane, row, limited_column(lesser(a, b) - 1.0f), low);
  colors_at_column(plane, row, limited_column(greater(a, b) + 1.0f), high);
  for (int i = 0; i < 4; i++) sums[i] = high[i] - low[i];
}

/* The colour in a row where matter is visible, between the coordinates from and to; if the function shows
 * nothing there, it is the mean colour between the coordinates before and after. */
DEVICE vector color_in_row(const plane_data *plane, float row, float from, float to, float before,
                           float after) {
  float sums[4];
  colors_between(plane, row, column_of_plane(plane, from), column_of_plane(plane, to), sums);
  if (sums[3] < 1e-4f)
    colors_between(plane, row, column_of_plane(plane, before), column_of_plane(plane, after), sums);
  const float inverse = divided(1.0f, greater(sums[3], 1e-20f));
  return vector_of(limited(sums[0] * inverse, 0.0f, 1.0f), limited(sums[1] * inverse, 0.0f, 1.0f),
                   limited(sums[2] * inverse, 0.0f, 1.0f));
}

#endif
