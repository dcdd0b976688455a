/* grid/plane_table.h - holds tables of a transfer function of two numbers, over the plane of these numbers.
 *
 * A column stands for a value, a row for a second number: the gradient's length or another volume's value.
 * Between the table's points the function is bilinear. A ray's way through a slab runs along a row, from one
 * value to another. Rows therefore keep integrals over columns, so that no box is lost between two sheets. */
#ifndef HL_GRID_PLANE_TABLE_H
#define HL_GRID_PLANE_TABLE_H

#include "core/memory.h"
#include "grid/grid.h"
#include "scene/function/function_plane.h"

enum { PLANE_COLUMNS = 512, PLANE_ROWS = 256, PLANE_STRIDE = PLANE_COLUMNS + 1 };

typedef struct plane_table {
  /* the two arrays are [PLANE_ROWS + 1][PLANE_STRIDE]; the last row and the last column are stored twice;
   * borrowed from the classifier's block; null if the transfer function has no second number */
  float (*sums)[4];  /* [0]: extinction per world unit. [1]: the integral of extinction over columns, from
                      * column 0. [2], [3]: the numbers [0] and [1] of the next row, so that one load gets
                      * everything around a position */
  float (*color)[4]; /* integrals over columns, from column 0: [0] to [2] integrate linear RGB times opacity,
                      * [3] opacity alone */
  /* a coordinate x in the classifier's tables belongs to the column x * column_scale + column_offset */
  float column_scale, column_offset;
  /* A second number s belongs to the row s * row_scale + row_offset. If s is a gradient, its unit is stored
   * units per frame unit. If s is another volume's value, it is given in stored units above that volume's
   * empty value. */
  float row_scale, row_offset;
  float even_before; /* look-ups at columns below this number give the same result in all rows */
  hl_second_axis axis;
  /* The volume whose values are the second number. Borrowed from the frame; null if the second number is the
   * gradient. */
  const hl_volume *second_volume;
  const grid *second;
  float to_second[3][4]; /* maps frame space to the second volume's index space */
} plane_table;

/* Lays out the tables if the transfer function is a function of two numbers. */
void hl_plane_table_lay_out(const hl_transfer_function *function, plane_table *table, hl_layout *layout);

/* The values that a classifier's tables cover, from their entry 0 to their last; values below `nothing` are
 * empty space (hl_transparent_below). */
typedef struct plane_values {
  double low, high, nothing;
} plane_values;

/* Fills the tables of a function of two numbers. volume: the function's volume, in frame space. second: the
 * other volume; null if the second number is the gradient. entries: the number of entries of the classifier's
 * tables, less one. greatest: [entries + 1]; element [0] of each entry receives a bound: the greatest
 * extinction that values around the entry have with any second number. The bound is 0 if no such value is
 * visible. */
void hl_plane_table_fill(const hl_scene_volume *volume, const hl_scene_volume *second, const grid *grid,
                         const plane_values *values, int entries, plane_table *table, float (*greatest)[4]);

/* Sets the volume whose values are the second number, for a frame. */
void hl_plane_table_set_second(plane_table *table, const hl_volume *volume, const grid *second);

/* The value of a function of two numbers at one point of its plane. */
typedef struct plane_point {
  float extinction, color[3];
} plane_point;

/* The value of the transfer function at a point of its plane. coordinate: the value, as a coordinate in the
 * classifier's tables. second: the second number, in the units of row_scale. */
plane_point hl_plane_table_at(const plane_table *table, float coordinate, float second);

/* The value of the volume that gives the second number, at a position in frame space: interpolated linearly
 * between the volume's voxels, in stored units above the volume's empty value. */
float hl_plane_second_at(const plane_table *table, const float point[3]);

#endif
