/* light/sublight_points.c - finds the points that stand for a light as sub-lights. */
#include "light/light_extent.h"

#include "scene/light/light_kind.h"

/* Sets of points for lights with few sub-lights. The points are chosen so that every half-plane contains
 * nearly the same fraction of the points as of the light's area. scripts/light_points finds the points, and
 * explains the search. Points of disks are given as points of the unit square, which hl_light_point() maps to
 * the disk. With sixteen points on a disk, penumbrae of straight edges have a root mean square error of
 * 0.0326 of the light. The error is 0.028 to 0.036 depending on the edge's direction. With the turned grid of
 * hl_sublight_grid_point(), the error is 0.0362. */
enum { SEARCHED_SIDES = 3, MOST_SEARCHED = 16 };
typedef double square_points[MOST_SEARCHED][2];

static const square_points of_disk[SEARCHED_SIDES] = {
    {{0.1656, 0.3936}, {0.3808, 0.7391}, {0.6651, 0.1651}, {0.8361, 0.7296}},
    {{0.0899, 0.3785},
     {0.2579, 0.6495},
     {0.2871, 0.9225},
     {0.2690, 0.1387},
     {0.5308, 0.4326},
     {0.6079, 0.7393},
     {0.6960, 0.1017},
     {0.8610, 0.3611},
     {0.9143, 0.8010}},
    {{0.0848, 0.2038},
     {0.1576, 0.4860},
     {0.0827, 0.7232},
     {0.2211, 0.9150},
     {0.3004, 0.0995},
     {0.3202, 0.3419},
     {0.3492, 0.6622},
     {0.5053, 0.8904},
     {0.5675, 0.1100},
     {0.5498, 0.3799},
     {0.6411, 0.6732},
     {0.7782, 0.8864},
     {0.8094, 0.1272},
     {0.8966, 0.2963},
     {0.7765, 0.5014},
     {0.9413, 0.7115}},
};

static const square_points of_square[SEARCHED_SIDES] = {
    {{0.2017, 0.3906}, {0.3330, 0.8200}, {0.5909, 0.1396}, {0.8743, 0.6498}},
    {{0.1667, 0.1310},
     {0.1039, 0.5282},
     {0.2330, 0.9038},
     {0.4320, 0.2531},
     {0.4713, 0.6085},
     {0.6365, 0.8670},
     {0.8252, 0.0967},
     {0.7109, 0.4042},
     {0.9206, 0.7074}},
    {{0.0523, 0.2182},
     {0.2064, 0.4136},
     {0.0867, 0.6713},
     {0.1787, 0.9431},
     {0.2643, 0.1162},
     {0.3826, 0.5170},
     {0.3572, 0.7554},
     {0.5410, 0.8724},
     {0.4845, 0.1589},
     {0.5973, 0.3412},
     {0.6303, 0.6295},
     {0.8090, 0.8986},
     {0.7363, 0.0492},
     {0.9174, 0.2378},
     {0.8260, 0.4692},
     {0.9302, 0.7083}},
};

void hl_sublight_grid_point(int side, int i, int j, double square[2]) {
  square[0] = (i + (j + 0.5) / side) / side;
  square[1] = (j + 1 - (i + 0.5) / side) / side;
}

/* Polygons have no common shape, so their sub-lights stand at the points of the turned grid. */
void hl_sublight_point(const light_source *source, int side, int i, int j, double square[2]) {
  const light_kind *kind = source->shape.kind;
  if (side < 2 || side >= 2 + SEARCHED_SIDES || kind->outline) {
    hl_sublight_grid_point(side, i, j, square);
    return;
  }
  const square_points *points = kind->parallelogram ? &of_square[side - 2] : &of_disk[side - 2];
  for (int axis = 0; axis < 2; axis++) square[axis] = (*points)[i * side + j][axis];
}
