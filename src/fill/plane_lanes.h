/* fill/plane_lanes.h - evaluates a transfer function of two numbers at sixteen points. */
#ifndef HL_FILL_PLANE_LANES_H
#define HL_FILL_PLANE_LANES_H

#include "fill/gather_lanes.h"
#include "fill/gradient_lanes.h"
#include "grid/classifier_lanes.h"
#include "simd/gathers.h"

/* ---- another volume's value ---- */

/* The weighted sums of the taps (the voxels around a point) of another volume whose voxels are in memory, for
 * lanes that may belong to several blocks of pixels. The parameters are the same as for
 * slopes_in_memory(). */
LANES_INLINE lanes values_in_memory(const grid *grid, const lanes_int cell[3], uint32_t active,
                                    uint32_t starts, const lanes weight[3][4]) {
  lanes sum = lanes_set(0);
  if (fits_offsets(grid)) return sum_in_memory(grid, cell, NULL, active, weight);
  for (uint32_t left = active; left != 0;) {
    uint32_t block = left;
    for (uint32_t less = drop_last_block(left, starts); less != 0; less = drop_last_block(less, starts))
      block = less;
    sum = lanes_select(lanes_from_bits(block), sum_in_memory(grid, cell, NULL, block, weight), sum);
    left &= ~block;
  }
  return sum;
}

LANES_INLINE lanes values_of_degree(const grid *grid, const kernel *kernel, int degree, lanes3 point,
                                    uint32_t active, uint32_t starts) {
  lanes weight[3][4], at[3] = {point.x, point.y, point.z}, part[3];
  lanes_int cell[3];
  for (int a = 0; a < 3; a++) {
    at[a] = lanes_clamp(at[a], -0.5f, (float)grid->dimension[a] - 0.5f);
    cell[a] = lanes_floor(at[a]);
    part[a] = at[a] - lanes_from_int(cell[a]);
  }
  if (grid->bricks != NULL) return sum_in_bricks(grid, kernel, cell, part, active);
  for (int a = 0; a < 3; a++) tap_weights(kernel, degree, part[a], weight[a]);
  const lanes(*weights)[4] = (const lanes(*)[4])weight;
  int outside = axes_to_fold(grid, cell, active);
  if (outside != 0) {
    if (has_integer_weights(grid->storage)) round_to_weights(weight[0]);
    if (grid->dimension[0] < 4 || grid->dimension[1] < 4 || grid->dimension[2] < 4)
      return sum_in_thin_grid(grid, cell, active, weights);
    for (int a = 0; a < 3; a++)
      if (outside >> a & 1) cell[a] = fold_border(cell[a], grid->dimension[a], weight[a]);
  }
  if (grid->pages != NULL) return sum_in_pages(grid, cell, active, weights);
  return values_in_memory(grid, cell, active, starts, weights);
}

/* The values of another volume at points of that volume's index space, in stored units. Only the active lanes
 * are set. At least one lane is active. starts: the first lane of each block of pixels, one bit each. */
static __attribute__((noinline)) lanes values_at(const grid *grid, const kernel *kernel, lanes3 point,
                                                 uint32_t active, uint32_t starts) {
  return kernel->degree == HL_BSPLINE_DEGREE
             ? values_of_degree(grid, kernel, HL_BSPLINE_DEGREE, point, active, starts)
             : values_of_degree(grid, kernel, HL_KERNEL_DEGREE, point, active, starts);
}

/* ---- the row of the second number ---- */

/* Finds the row of the table of a function of two numbers that belongs to the second number at each of
 * sixteen points. slope: the volume's gradient at the points, in stored units per frame unit; `slope` is not
 * read if the second number is the value of another volume. point: frame space. */
LANES_INLINE lanes row_of_matter(const plane_table *table, const kernel *kernel, lanes3 slope, lanes3 point,
                                 uint32_t active, uint32_t starts) {
  lanes second, scale = lanes_set(table->row_scale);
  if (table->axis == HL_SECOND_GRADIENT) {
    lanes3 scaled = scale3(slope, scale);
    return lanes_clamp(lanes_sqrt(dot3(scaled, scaled)) + table->row_offset, 0, PLANE_ROWS - 1);
  }
  lanes3 at = {row_of_point(table->to_second[0], point), row_of_point(table->to_second[1], point),
               row_of_point(table->to_second[2], point)};
  second = values_at(table->second, kernel, at, active, starts) - table->second->empty;
  return lanes_clamp(lanes_fma(second, scale, lanes_set(table->row_offset)), 0, PLANE_ROWS - 1);
}

/* ---- the function along a row ---- */

/* A row of the table of a function of two numbers, and the fraction by which the second number lies between
 * this row and the next. */
typedef struct plane_row {
  lanes_int start; /* index of the row's first point in the table */
  lanes part;
} plane_row;

LANES_INLINE plane_row split_row(lanes row) {
  lanes_int whole = lanes_truncate(row);
  return (plane_row){whole * PLANE_STRIDE, row - lanes_from_int(whole)};
}

LANES_INLINE lanes column_of(const plane_table *table, lanes coordinate) {
  return lanes_line(coordinate, table->column_scale, table->column_offset);
}

/* The lanes in which the function depends on the second number for some value of a range. The range is given
 * by two coordinates in the classifier's tables. */
LANES_INLINE lanes_int depends_on_row(const plane_table *table, lanes from, lanes to) {
  return lanes_max(column_of(table, from), column_of(table, to)) >= table->even_before;
}

/* Finds two numbers of a row of the table at a column: sums[0] is the extinction, and sums[1] is the
 * extinction's integral over the columns before. Extinction is linear between columns. After the fraction f
 * of a column, the integral has therefore grown by f e0 + f^2 (e1 - e0) / 2 (derived). */
LANES_INLINE void sums_at_column(const plane_table *table, plane_row row, lanes column, lanes sums[2]) {
  lanes_int whole = lanes_truncate(column);
  lanes part = column - lanes_from_int(whole), of_row[2][2];
  /* four numbers at the column (`here`) and at the next column (`next`): the extinction and its integral in
   * the row, and the extinction and its integral in the next row */
  lanes here[4], next[4];
  lanes_gather_quad_pairs(&table->sums[0][0], row.start + whole, here, next);
  for (int r = 0; r < 2; r++) {
    lanes rise = next[2 * r] - here[2 * r];
    of_row[r][0] = lanes_fma(rise, part, here[2 * r]);
    of_row[r][1] = lanes_fma(lanes_fma(rise * 0.5f, part, here[2 * r]), part, here[2 * r + 1]);
  }
  for (int i = 0; i < 2; i++) sums[i] = lanes_fma(of_row[1][i] - of_row[0][i], row.part, of_row[0][i]);
}

/* If two coordinates are closer than this number of columns, the mean of the extinctions at the two
 * coordinates stands for the mean extinction between them. A difference of integrals would lose digits, and
 * this mean is as accurate. */
static const float CLOSE_COLUMNS = 2;

/* The mean extinction in a row between two coordinates in the classifier's tables. */
LANES_INLINE lanes extinction_in_row(const plane_table *table, lanes row, lanes from, lanes to) {
  plane_row at = split_row(row);
  lanes a = column_of(table, from), b = column_of(table, to), at_a[2], at_b[2];
  sums_at_column(table, at, lanes_clamp(a, 0, PLANE_COLUMNS - 1), at_a);
  sums_at_column(table, at, lanes_clamp(b, 0, PLANE_COLUMNS - 1), at_b);
  lanes distance = b - a;
  lanes_int far = lanes_abs(distance) > CLOSE_COLUMNS;
  lanes mean = (at_b[1] - at_a[1]) / lanes_select(far, distance, lanes_set(1.0f));
  return lanes_select(far, lanes_max(mean, lanes_set(0)), (at_a[0] + at_b[0]) * 0.5f);
}

/* Finds two sums over the columns of a row, from the row's start to a column: the sum of colour times
 * opacity, and the sum of opacity. */
LANES_INLINE void colors_at_column(const plane_table *table, plane_row row, lanes column, lanes sums[4]) {
  lanes_int whole = lanes_truncate(column);
  lanes part = column - lanes_from_int(whole), of_row[2][4];
  for (int r = 0; r < 2; r++) {
    lanes a[4], b[4];
    lanes_int place = (row.start + whole + r * PLANE_STRIDE) * 4;
    lanes_gather_quads(&table->color[0][0], place, a);
    lanes_gather_quads(&table->color[0][0], place + 4, b);
    for (int i = 0; i < 4; i++) of_row[r][i] = lanes_fma(b[i] - a[i], part, a[i]);
  }
  for (int i = 0; i < 4; i++) sums[i] = lanes_fma(of_row[1][i] - of_row[0][i], row.part, of_row[0][i]);
}

/* Finds the sums of colors_at_column() over the columns from a to b and one further column on either side. */
LANES_INLINE void colors_between(const plane_table *table, plane_row row, lanes a, lanes b, lanes sums[4]) {
  lanes low[4], high[4];
  lanes from = lanes_clamp(lanes_min(a, b) - 1.0f, 0, PLANE_COLUMNS - 1),
        to = lanes_clamp(lanes_max(a, b) + 1.0f, 0, PLANE_COLUMNS - 1);
  colors_at_column(table, row, from, low);
  colors_at_column(table, row, to, high);
  for (int i = 0; i < 4; i++) sums[i] = high[i] - low[i];
}

/* The visible part of a way gets a colour of its own if the sum of opacities over its columns is at least
 * this number. Otherwise the colour of the visible part is the mean over the whole way. */
static const float SOME_OPACITY = 1e-4f;

/* The colour in a row where matter is visible, in linear RGB: the mean over the visible part of a way and one
 * column on either side. If the function shows nothing in these columns, the colour is the mean over the
 * whole way. The way runs from one coordinate in the classifier's tables to another. Only active lanes get a
 * result. */
static __attribute__((noinline, unused)) void color_in_row(const plane_table *table, lanes row,
                                                           const lanes shown[2], const lanes whole[2],
                                                           uint32_t active, lanes color[3]) {
  plane_row at = split_row(row);
  lanes sums[4];
  colors_between(table, at, column_of(table, shown[0]), column_of(table, shown[1]), sums);
  lanes_int none = sums[3] < SOME_OPACITY;
  if ((lanes_bits(none) & active) != 0) {
    lanes all[4];
    colors_between(table, at, column_of(table, whole[0]), column_of(table, whole[1]), all);
    for (int i = 0; i < 4; i++) sums[i] = lanes_select(none, all[i], sums[i]);
  }
  lanes inverse = 1.0f / lanes_max(sums[3], lanes_set(1e-20f));
  for (int c = 0; c < 3; c++) color[c] = lanes_clamp(sums[c] * inverse, 0, 1);
}

#endif
