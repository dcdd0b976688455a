/* grid/plane_table.c - see plane_table.h.
 *
 * A point of the table holds the function's mean over a part of the plane. The part is nearer to this point
 * than to other points, and lies within the range of the data. So a box of the function that ends at the end
 * of the data's range has its full weight at the last point. */
#include "grid/plane_table.h"

#include <math.h>
#include <string.h>

#include "elementary/elementary.h"
#include "grid/field.h"
#include "scene/geometry/placement.h"

void hl_plane_table_lay_out(const hl_transfer_function *function, plane_table *table, hl_layout *layout) {
  if (!hl_has_plane(function)) return;
  size_t count = (size_t)(PLANE_ROWS + 1) * PLANE_STRIDE;
  table->sums = hl_layout_take(layout, count, sizeof *table->sums);
  table->color = hl_layout_take(layout, count, sizeof *table->color);
}

/* ---- the part of the plane that the table covers ---- */

/* The greatest possible length of a gradient. Along each axis, the values of neighbouring voxels differ by at
 * most the whole range of values. */
static double longest_gradient(const hl_scene_volume *volume, double range) {
  mat3 placed = hl_scene_volume_index_to_world(volume).linear;
  double sum = 0;
  for (int axis = 0; axis < 3; axis++) {
    double edge = vec3_length(mat3_column(placed, axis));
    sum += 1 / (edge * edge);
  }
  return range * sqrt(sum);
}

/* The rectangle of the plane in which the data's pairs of numbers lie. Second numbers are in the function's
 * units. */
static plane_box reach_of_data(const hl_scene_volume *volume, const hl_scene_volume *second,
                               const plane_values *values) {
  double scale = hl_plane_second_scale(&volume->transfer_function.plane), low = 0,
         high = longest_gradient(volume, values->high - values->low);
  if (second != NULL) {
    double empty = hl_scene_volume_empty_value(second);
    low = fmin(second->volume->minimum, empty);
    high = fmax(second->volume->maximum, empty);
  }
  low *= scale, high *= scale;
  return (plane_box){{values->low, fmin(low, high)}, {values->high, fmax(low, high)}};
}

/* An axis of the table. Point n of the axis stands for the number start + n * step. */
typedef struct table_axis {
  double start, step;
  double low, high; /* the range that the data can reach along the axis */
  double nothing;   /* the value below which matter does not exist */
} table_axis;

/* Makes an axis that covers the function's shapes and two steps more, but no more than the range of the
 * data. */
static table_axis axis_of(const plane_box *bounds, const plane_box *reach, int axis, int count) {
  double low = fmax(bounds->low[axis], reach->low[axis]), high = fmin(bounds->high[axis], reach->high[axis]);
  if (!(high > low))
    low = reach->low[axis], high = fmax(reach->high[axis], low + fmax(1e-12 * fabs(low), 1e-30));
  double step = (high - low) / (count - 5);
  return (table_axis){low - 2 * step, step, reach->low[axis], reach->high[axis], -INFINITY};
}

/* Finds the part of an axis for which point n of the table stands: the values that are nearer to this point
 * than to other points, within the range of the data. */
static void part_of_axis(const table_axis *axis, int n, double *low, double *high) {
  double middle = axis->start + n * axis->step;
  *low = fmin(fmax(middle - axis->step / 2, axis->low), axis->high);
  *high = fmin(fmax(middle + axis->step / 2, axis->low), axis->high);
}

/* ---- filling ---- */

static size_t place_of(int row, int column) { return (size_t)row * PLANE_STRIDE + (size_t)column; }

/* Fills one row of the table. Extinction is linear between columns, so that its integral over one column is
 * the mean of the column's two ends. */
static void fill_row(const hl_transfer_function *function, const table_axis axes[2], int row,
                     plane_table *table) {
  double integral = 0, before = 0, sums[4] = {0, 0, 0, 0}, opacity_before[4] = {0, 0, 0, 0};
  plane_box part;
  part_of_axis(&axes[1], row, &part.low[1], &part.high[1]);
  for (int column = 0; column < PLANE_COLUMNS; column++) {
    part_of_axis(&axes[0], column, &part.low[0], &part.high[0]);
    bool some = axes[0].start + column * axes[0].step >= axes[0].nothing;
    plane_sum mean = some ? hl_plane_mean(function, &part) : (plane_sum){0, {0, 0, 0}};
    double opacity = -hl_expm1(-mean.extinction * function->unit_distance), shown[4] = {0, 0, 0, opacity};
    for (int c = 0; c < 3 && mean.extinction > 0; c++) shown[c] = opacity * mean.color[c] / mean.extinction;
    float *sum = table->sums[place_of(row, column)], *color = table->color[place_of(row, column)];
    integral += column == 0 ? 0 : (before + mean.extinction) / 2;
    sum[0] = (float)mean.extinction;
    sum[1] = (float)integral;
    for (int c = 0; c < 4; c++) {
      sums[c] += column == 0 ? 0 : (opacity_before[c] + shown[c]) / 2;
      color[c] = (float)sums[c];
      opacity_before[c] = shown[c];
    }
    before = mean.extinction;
  }
}

/* Repeats the last column and the last row of the table, because a look-up reads a point and the next one.
 * width: number of floats of a point. */
static void repeat_last(float *table, size_t width) {
  for (int row = 0; row < PLANE_ROWS; row++)
    memcpy(table + width * place_of(row, PLANE_COLUMNS), table + width * place_of(row, PLANE_COLUMNS - 1),
           width * sizeof *table);
  memcpy(table + width * place_of(PLANE_ROWS, 0), table + width * place_of(PLANE_ROWS - 1, 0),
         width * PLANE_STRIDE * sizeof *table);
}

/* Stores, beside the sums of each point of the table, the sums of the point in the next row. */
static void join_rows(const plane_table *table) {
  for (int row = 0; row <= PLANE_ROWS; row++) {
    int next = row < PLANE_ROWS ? row + 1 : row;
    for (int column = 0; column < PLANE_STRIDE; column++)
      memcpy(table->sums[place_of(row, column)] + 2, table->sums[place_of(next, column)], 2 * sizeof(float));
  }
}

static int clamp_column(double column) { return (int)fmin(fmax(column, 0), PLANE_COLUMNS - 1); }

static void find_greatest(const plane_table *table, int entries, float (*greatest)[4]) {
  float of_column[PLANE_COLUMNS] = {0};
  for (int row = 0; row < PLANE_ROWS; row++)
    for (int column = 0; column < PLANE_COLUMNS; column++)
      of_column[column] = fmaxf(of_column[column], table->sums[place_of(row, column)][0]);
  for (int entry = 0; entry <= entries; entry++) {
    double scale = (double)table->column_scale, offset = (double)table->column_offset;
    int first = clamp_column(floor((entry - 1) * scale + offset)),
        last = clamp_column(ceil((entry + 1) * scale + offset));
    greatest[entry][0] = 0;
    for (int column = first; column <= last; column++)
      greatest[entry][0] = fmaxf(greatest[entry][0], of_column[column]);
  }
}

/* The number of columns that a look-up reads beyond its position. */
enum { BEYOND = 3 };

/* The first column that differs between rows, less the columns that a look-up reads beyond its position. In
 * the columns before, all rows hold the same numbers, so look-ups do not depend on the second number. */
static float even_columns(const plane_table *table) {
  int even = PLANE_STRIDE;
  for (int row = 1; row < PLANE_ROWS; row++)
    for (int column = 0; column < even; column++) {
      size_t here = place_of(row, column), first = place_of(0, column);
      if (memcmp(table->sums[here], table->sums[first], 2 * sizeof(float)) != 0 ||
          memcmp(table->color[here], table->color[first], sizeof *table->color) != 0)
        even = column;
    }
  return even == PLANE_STRIDE ? INFINITY : (float)(even - BEYOND);
}

void hl_plane_table_fill(const hl_scene_volume *volume, const hl_scene_volume *second, const grid *grid,
                         const plane_values *values, int entries, plane_table *table, float (*greatest)[4]) {
  const hl_transfer_function *function = &volume->transfer_function;
  plane_box bounds = {{0, 0}, {0, 0}}, reach = reach_of_data(volume, second, values);
  (void)hl_plane_bounds(&function->plane, &bounds);
  table_axis axes[2] = {axis_of(&bounds, &reach, 0, PLANE_COLUMNS), axis_of(&bounds, &reach, 1, PLANE_ROWS)};
  axes[0].nothing = values->nothing;
  double scale = hl_plane_second_scale(&function->plane), zero = 0;
  double units = fabs(grid->value_scale);
  if (second != NULL) {
    units = second->volume->value_scale;
    zero = hl_scene_volume_empty_value(second);
  }
  table->axis = function->plane.second;
  table->column_scale = (float)((values->high - values->low) / entries / axes[0].step);
  table->column_offset = (float)((values->low - axes[0].start) / axes[0].step);
  table->row_scale = (float)fmin(fmax(units * scale / axes[1].step, -1e30), 1e30);
  table->row_offset = (float)((zero * scale - axes[1].start) / axes[1].step);
  for (int row = 0; row < PLANE_ROWS; row++) fill_row(function, axes, row, table);
  repeat_last(&table->sums[0][0], 4);
  join_rows(table);
  repeat_last(&table->color[0][0], 4);
  find_greatest(table, entries, greatest);
  table->even_before = even_columns(table);
}

void hl_plane_table_set_second(plane_table *table, const hl_volume *volume, const grid *second) {
  table->second_volume = volume;
  table->second = second;
  affine3_store(table->to_second, &second->frame_to_index);
}

/* ---- looking up one point ---- */

/* A position along an axis of a table: the table's point before the position, and the distance from this
 * point to the position. */
typedef struct table_place {
  int at;
  float part;
} table_place;

static table_place place_between(float x, int count) {
  float most = (float)(count - 1);
  if (!(x > 0)) x = 0;
  if (x > most) x = most;
  return (table_place){(int)x, x - (float)(int)x};
}

/* A channel of the function's colour, as a mean over the column of the table that holds a position. The mean
 * is interpolated between two rows. In a row, the mean is the difference of the channel's integrals at the
 * column's two ends. */
static float color_between(const plane_table *table, table_place column, table_place row, int c) {
  float of_row[2];
  for (int r = 0; r < 2; r++) {
    size_t place = place_of(row.at + r, column.at);
    of_row[r] = table->color[place + 1][c] - table->color[place][c];
  }
  return of_row[0] + (of_row[1] - of_row[0]) * row.part;
}

plane_point hl_plane_table_at(const plane_table *table, float coordinate, float second) {
  table_place column = place_between(coordinate * table->column_scale + table->column_offset, PLANE_COLUMNS),
              row = place_between(second * table->row_scale + table->row_offset, PLANE_ROWS);
  float of_row[2];
  for (int r = 0; r < 2; r++) {
    size_t place = place_of(row.at + r, column.at);
    float a = table->sums[place][0], b = table->sums[place + 1][0];
    of_row[r] = a + (b - a) * column.part;
  }
  plane_point point = {of_row[0] + (of_row[1] - of_row[0]) * row.part, {0, 0, 0}};
  float opacity = color_between(table, column, row, 3);
  for (int c = 0; c < 3 && opacity > 0; c++) point.color[c] = color_between(table, column, row, c) / opacity;
  return point;
}

float hl_plane_second_at(const plane_table *table, const float point[3]) {
  const grid *grid = table->second;
  int32_t first[3];
  double voxels[8];
  float part[3], sum = 0;
  for (int a = 0; a < 3; a++) {
    const float *row = table->to_second[a];
    float at = row[0] * point[0] + row[1] * point[1] + row[2] * point[2] + row[3];
    float last = (float)(grid->dimension[a] - 1);
    at = at > 0 ? at < last ? at : last : 0;
    first[a] = (int32_t)at;
    part[a] = at - (float)first[a];
  }
  hl_field_window(grid, first, (const int32_t[3]){2, 2, 2}, voxels);
  for (int corner = 0; corner < 8; corner++) {
    float weight = 1;
    for (int a = 0; a < 3; a++) weight *= corner >> a & 1 ? part[a] : 1 - part[a];
    if (weight > 0) sum += weight * (float)voxels[corner];
  }
  return sum - grid->empty;
}
