/* bricks/inverse.c - finds a point's place within a cell (inverse.h). For hexahedra it is found by Newton's
 * method. */
#include "bricks/inverse.h"

#include <math.h>
#include <string.h>

/* The distance from a cell, as a fraction of the cell, up to which a point counts as inside. Without this
 * margin, rounding could place a point on a border into neither of the two cells. */
static const double MARGIN = 1e-7;
static const double CONVERGED = 1e-10;
enum { STEPS_MOST = 20 };

static double determinant(const double m[3][3]) {
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
         m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

static bool invert(const double m[3][3], double inverse[3][3]) {
  double d = determinant(m);
  if (!(fabs(d) > 0)) return false;
  for (int row = 0; row < 3; row++)
    for (int column = 0; column < 3; column++) {
      int a = (column + 1) % 3, b = (column + 2) % 3, c = (row + 1) % 3, e = (row + 2) % 3;
      inverse[row][column] = (m[a][c] * m[b][e] - m[a][e] * m[b][c]) / d;
    }
  return true;
}

/* The weights of a hexahedron's corners, and their derivatives along the unit cube's axes. */
static void weights_at(const double at[3], double weights[8], double slopes[8][3]) {
  static const int place[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                  {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  for (int n = 0; n < 8; n++) {
    double part[3], slope[3];
    for (int axis = 0; axis < 3; axis++) {
      part[axis] = place[n][axis] ? at[axis] : 1 - at[axis];
      slope[axis] = place[n][axis] ? 1 : -1;
    }
    weights[n] = part[0] * part[1] * part[2];
    slopes[n][0] = slope[0] * part[1] * part[2];
    slopes[n][1] = part[0] * slope[1] * part[2];
    slopes[n][2] = part[0] * part[1] * slope[2];
  }
}

/* The map's value at a place of the unit cube, and its derivatives: jacobian[row][axis]. */
static void map_at(const hl_cell_shape *shape, const double at[3], double weights[8], double value[3],
                   double jacobian[3][3]) {
  double slopes[8][3];
  weights_at(at, weights, slopes);
  for (int row = 0; row < 3; row++) {
    value[row] = jacobian[row][0] = jacobian[row][1] = jacobian[row][2] = 0;
    for (int n = 0; n < 8; n++) {
      value[row] += weights[n] * shape->corner[n][row];
      for (int axis = 0; axis < 3; axis++) jacobian[row][axis] += slopes[n][axis] * shape->corner[n][row];
    }
  }
}

/* A tetrahedron's edges from its first corner, as columns. */
static void edges_of(const hl_cell_shape *shape, double edges[3][3]) {
  for (int row = 0; row < 3; row++)
    for (int n = 0; n < 3; n++) edges[row][n] = shape->corner[n + 1][row] - shape->corner[0][row];
}

bool hl_cell_shape_ready(hl_cell_shape *shape) {
  double edges[3][3];
  if (!shape->is_tetrahedron) return hl_cell_volume(shape) > 0;
  edges_of(shape, edges);
  return invert(edges, shape->inverse);
}

double hl_cell_volume(const hl_cell_shape *shape) {
  static const double middle[3] = {0.5, 0.5, 0.5};
  double matrix[3][3], value[3], weights[8];
  if (shape->is_tetrahedron) {
    edges_of(shape, matrix);
    return fabs(determinant(matrix)) / 6;
  }
  map_at(shape, middle, weights, value, matrix);
  return fabs(determinant(matrix));
}

/* The slopes of the values along the axes of the unit cell. In a hexahedron, where slopes vary, they are the
 * slopes in the middle. */
static void unit_slopes(const hl_cell_shape *shape, const double values[8], double slopes[3]) {
  static const double middle[3] = {0.5, 0.5, 0.5};
  double weights[8], corner_slopes[8][3];
  weights_at(middle, weights, corner_slopes);
  for (int n = 0; n < 3; n++) {
    slopes[n] = shape->is_tetrahedron ? values[n + 1] - values[0] : 0;
    for (int c = 0; c < 8 && !shape->is_tetrahedron; c++) slopes[n] += corner_slopes[c][n] * values[c];
  }
}

void hl_cell_affine_of(const hl_cell_shape *shape, const double values[8], hl_cell_affine *affine) {
  static const double middle[3] = {0.5, 0.5, 0.5};
  const int corners = shape->is_tetrahedron ? 4 : 8;
  double slopes[3], weights[8], place[3], jacobian[3][3];
  unit_slopes(shape, values, slopes);
  if (shape->is_tetrahedron) memcpy(affine->place, shape->inverse, sizeof affine->place);
  else {
    map_at(shape, middle, weights, place, jacobian);
    invert(jacobian, affine->place);
  }
  affine->value = 0;
  for (int c = 0; c < corners; c++) affine->value += values[c] / corners;
  for (int axis = 0; axis < 3; axis++) {
    affine->middle[axis] = affine->slope[axis] = 0;
    for (int c = 0; c < corners; c++) affine->middle[axis] += shape->corner[c][axis] / corners;
    for (int n = 0; n < 3; n++) affine->slope[axis] += slopes[n] * affine->place[n][axis];
  }
}

static bool tetrahedron_weights(const hl_cell_shape *shape, const double point[3], double weights[8]) {
  weights[0] = 1;
  for (int n = 0; n < 3; n++) {
    weights[n + 1] = 0;
    for (int axis = 0; axis < 3; axis++)
      weights[n + 1] += shape->inverse[n][axis] * (point[axis] - shape->corner[0][axis]);
    weights[0] -= weights[n + 1];
  }
  for (int n = 0; n < 4; n++)
    if (!(weights[n] >= -MARGIN)) return false;
  return true;
}

bool hl_cell_weights(const hl_cell_shape *shape, const double point[3], double weights[8]) {
  double at[3] = {0.5, 0.5, 0.5}, value[3], jacobian[3][3], inverse[3][3], step = INFINITY;
  if (shape->is_tetrahedron) return tetrahedron_weights(shape, point, weights);
  for (int n = 0; n < STEPS_MOST && step > CONVERGED; n++) {
    map_at(shape, at, weights, value, jacobian);
    if (!invert(jacobian, inverse)) return false;
    step = 0;
    for (int axis = 0; axis < 3; axis++) {
      double change = 0;
      for (int row = 0; row < 3; row++) change += inverse[axis][row] * (point[row] - value[row]);
      at[axis] = fmin(fmax(at[axis] + change, -1), 2); /* keeps the iteration near the cell; a point that
                                                        * needs a greater step lies outside of the cell */
      step = fmax(step, fabs(change));
    }
  }
  if (!(step <= 1e-6)) return false;
  for (int axis = 0; axis < 3; axis++)
    if (!(at[axis] >= -MARGIN && at[axis] <= 1 + MARGIN)) return false;
  map_at(shape, at, weights, value, jacobian);
  return true;
}
