/* bricks/inverse.h - finds where a point lies within a cell, by the inverse of the map from a unit cell to
 * the cell. */
#ifndef HL_BRICKS_INVERSE_H
#define HL_BRICKS_INVERSE_H

#include <stdbool.h>

/* A cell's corners, in any coordinates. Corner n of a hexahedron is at VTK's place in the unit cube: (0,0,0),
 * (1,0,0), (1,1,0), (0,1,0), and the same with z = 1. Only the first four of a tetrahedron are used. */
typedef struct hl_cell_shape {
  bool is_tetrahedron;
  double corner[8][3];
  double inverse[3][3]; /* for a tetrahedron: maps the vector from the first corner to a point to the point's
                         * weights */
} hl_cell_shape;

/* Completes a shape whose corners are set. Returns false if the cell has no volume. */
bool hl_cell_shape_ready(hl_cell_shape *shape);

/* Finds the corners' weights at a point: [8], or [4] for a tetrahedron. Their sum is 1. Returns false if the
 * point lies outside. */
bool hl_cell_weights(const hl_cell_shape *shape, const double point[3], double weights[8]);

/* Affine functions of the coordinates that describe a cell. One function approximates the values that the
 * cell interpolates; in a tetrahedron it equals them. The other three give the cell's unit coordinates, whose
 * ranges bound the cell. */
typedef struct hl_cell_affine {
  double middle[3];   /* the mean of the corners */
  double value;       /* the function's, at `middle` */
  double slope[3];    /* the slopes of the function along x, y, z */
  double place[3][3]; /* slopes, along x, y, z, of the cell's three unit coordinates; in a hexahedron, the
                       * slopes in its middle */
} hl_cell_affine;

/* Fits the affine functions of hl_cell_affine to a cell. The shape must have been completed by
 * hl_cell_shape_ready(). values: the values at the cell's corners. */
void hl_cell_affine_of(const hl_cell_shape *shape, const double values[8], hl_cell_affine *affine);

/* The volume of a cell. For a hexahedron it is estimated by the determinant of the map's derivative in its
 * middle. */
double hl_cell_volume(const hl_cell_shape *shape);

#endif
