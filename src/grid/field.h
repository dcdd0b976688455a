/* grid/field.h - describes the field that the kernel makes of a grid's voxels: its value and gradient at any
 * point.
 *
 * Points are in index space, values in stored units. Beyond the grid's faces the values of the border's
 * voxels continue. */
#ifndef HL_GRID_FIELD_H
#define HL_GRID_FIELD_H

#include "grid/grid.h"

enum { FIELD_TAPS = 4 };

/* The four voxels along an axis on which the field at a coordinate depends, and their weights. */
typedef struct field_taps {
  int32_t first;
  double weight[FIELD_TAPS];
} field_taps;

field_taps hl_field_taps(const kernel *kernel, double at);

/* Copies a box of voxels to `values`, [size[2]][size[1]][size[0]]. */
void hl_field_window(const grid *grid, const int32_t first[3], const int32_t size[3], double *values);

/* The value of the field at a point. *slope: receives the derivatives with respect to the index
 * coordinates. */
double hl_field_value_and_slope(const grid *grid, const kernel *kernel, vec3 at, vec3 *slope);

#endif
