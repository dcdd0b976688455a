/* bricks/subdivide.h - finds the coefficients of a level from the coefficients of the next coarser level.
 * They describe the same field on a lattice twice as fine.
 *
 * Along each axis, with the coarse coefficients d: coefficient 2j is (d[j-1] + 6 d[j] + d[j+1]) / 8, and
 * coefficient 2j + 1 is (d[j] + d[j+1]) / 2 (J. Lane, R. Riesenfeld, A theoretical development for the
 * computer generation and display of piecewise polynomial surfaces, 1980). A coefficient that is NaN stands
 * for a place without data. It is left out of the sums. If all coefficients of a sum are left out, the result
 * is NaN. */
#ifndef HL_BRICKS_SUBDIVIDE_H
#define HL_BRICKS_SUBDIVIDE_H

#include <stddef.h>

/* A box of lattice points of one level: first .. first + count - 1 along x, y, z. */
typedef struct hl_lattice_box {
  ptrdiff_t first[3];
  size_t count[3];
} hl_lattice_box;

static inline size_t hl_lattice_points(const hl_lattice_box *box) {
  return box->count[0] * box->count[1] * box->count[2];
}

/* The points of the next coarser level on which a box depends. */
hl_lattice_box hl_subdivision_source(const hl_lattice_box *box);

/* The number of floats of scratch memory that hl_subdivide() needs for a box. */
size_t hl_subdivision_scratch(const hl_lattice_box *box);

/* Fills a box, [z][y][x], with subdivided coefficients. coarse: the coefficients of the box
 * hl_subdivision_source(box), [z][y][x]. If all coefficients are the same number, the result is exactly this
 * number. */
void hl_subdivide(const hl_lattice_box *box, const float *coarse, float *scratch, float *fine);

/* The field's value at a lattice point, where the weights of the cubic B-spline are 1/6, 2/3 and 1/6 along
 * each axis. first: the first of the 27 coefficients, which is one before the point along each axis. row,
 * slice: number of floats from one row, and from one slice, to the next. The result is NaN if one of the
 * coefficients is NaN. */
double hl_field_at_point(const float *first, size_t row, size_t slice);

#endif
