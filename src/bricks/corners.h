/* bricks/corners.h - finds the coefficients at the corners of cells from the means over the cells.
 *
 * A coefficient is a weighted mean of the 4^3 cells around its corner. It never leaves the range of the eight
 * cells that meet at the corner, and limiting it neither adds to the sum of all coefficients nor takes from
 * it.
 *
 * In:  cells of one level of an adaptive grid (patches.c). Out: coefficients of this level. */
#ifndef HL_BRICKS_CORNERS_H
#define HL_BRICKS_CORNERS_H

#include <stddef.h>

enum {
  CORNERS_MOST = 8,   /* the most corners along an axis of one call */
  CORNERS_BEFORE = 3, /* cells before the first corner */
  CORNERS_AROUND = 5, /* cells along an axis, minus corners */
  CORNERS_CELLS = CORNERS_MOST + CORNERS_AROUND
};

/* Finds the coefficients of count[0] x count[1] x count[2] corners, at most CORNERS_MOST along each axis.
 * cells: [z][y][x], with CORNERS_CELLS along each axis. Along an axis, CORNERS_BEFORE cells lie before the
 * first corner, and the function reads count + CORNERS_AROUND cells. A NaN is a cell without a value. Corners
 * that have such a cell among the 4^3 cells get the mean of the eight cells that have values, and NaN if none
 * has. out: [count[2]][count[1]][count[0]]. A coefficient depends on the values of the cells within three
 * cells of its corner alone, and not on where the corner lies among those of a call. */
void hl_corners_of_cells(const float *cells, const size_t count[3], float *out);

#endif
