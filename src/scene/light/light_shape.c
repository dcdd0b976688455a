/* scene/light/light_shape.c - finds the points of polygons and disks, and the first and second moments of
 * these points. */
#include "scene/light/light_shape.h"

#include "elementary/elementary.h"

/* the outer product a b' of two vectors, a matrix */
mat3 hl_outer(vec3 a, vec3 b) { return (mat3){{vec3_scale(b, a.x), vec3_scale(b, a.y), vec3_scale(b, a.z)}}; }

mat3 hl_add_scaled(mat3 a, mat3 b, double scale) {
  for (int row = 0; row < 3; row++) a.row[row] = vec3_add(a.row[row], vec3_scale(b.row[row], scale));
  return a;
}

static double greatest_side(const double (*vertices)[3], size_t count) {
  double side = 0;
  for (int axis = 0; axis < 3; axis++) {
    double low = INFINITY, high = -INFINITY;
    for (size_t i = 0; i < count; i++) {
      low = fmin(low, vertices[i][axis]);
      high = fmax(high, vertices[i][axis]);
    }
    side = fmax(side, high - low);
  }
  return side;
}

/* Finds the moments of a polygon. The polygon is treated as a fan of triangles around the first vertex, with
 * signed areas, so that parts outside the polygon cancel. Derived: let a, b, c be the corners of a triangle,
 * and s = a + b + c. Over the triangle the mean of x is s / 3, and the mean of x x' is (a a' + b b' + c c' +
 * s s') / 12. These means follow because the mean of the square of a barycentric coordinate is 1/6, and the
 * mean of the product of two barycentric coordinates is 1/12. */
polygon_shape hl_polygon_shape(const double (*vertices)[3], size_t count) {
  polygon_shape shape = {.diameter = greatest_side(vertices, count)};
  vec3 first = vec3_of(vertices[0]), twice_area = {0, 0, 0}, sum = {0, 0, 0};
  for (size_t i = 1; i + 1 < count; i++) {
    vec3 b = vec3_subtract(vec3_of(vertices[i]), first), c = vec3_subtract(vec3_of(vertices[i + 1]), first);
    twice_area = vec3_add(twice_area, vec3_cross(b, c));
  }
  shape.normal = vec3_normalise(twice_area);
  shape.area = vec3_length(twice_area) / 2;
  shape.centre = first;
  if (!(shape.area > 0)) return shape;
  mat3 squares = {{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}};
  for (size_t i = 1; i + 1 < count; i++) {
    vec3 b = vec3_subtract(vec3_of(vertices[i]), first), c = vec3_subtract(vec3_of(vertices[i + 1]), first);
    vec3 s = vec3_add(b, c);
    double area = vec3_dot(vec3_cross(b, c), shape.normal) / 2;
    sum = vec3_add(sum, vec3_scale(s, area / 3));
    squares = hl_add_scaled(
        squares, hl_add_scaled(hl_add_scaled(hl_outer(b, b), hl_outer(c, c), 1), hl_outer(s, s), 1),
        area / 12);
  }
  vec3 centre = vec3_scale(sum, 1 / shape.area);
  shape.spread = hl_add_scaled((mat3){{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}}, squares, 1 / shape.area);
  shape.spread = hl_add_scaled(shape.spread, hl_outer(centre, centre), -1);
  shape.centre = vec3_add(first, centre);
  return shape;
}

double hl_polygon_unevenness(const polygon_shape *shape, const double (*vertices)[3], size_t count) {
  double greatest = 0;
  for (size_t i = 0; i < count; i++)
    greatest = fmax(greatest,
                    fabs(vec3_dot(shape->normal, vec3_subtract(vec3_of(vertices[i]), shape->centre))));
  return greatest;
}

/* Twice the area of the triangle a, b, c, as seen along the normal. The area is negative if the corners run
 * clockwise about the normal. */
static double side_of(vec3 normal, vec3 a, vec3 b, vec3 c) {
  return vec3_dot(normal, vec3_cross(vec3_subtract(b, a), vec3_subtract(c, a)));
}

bool hl_polygon_crosses_itself(const polygon_shape *shape, const double (*vertices)[3], size_t count) {
  for (size_t i = 0; i < count; i++)
    for (size_t j = i + 1; j < count; j++) {
      vec3 a = vec3_of(vertices[i]), b = vec3_of(vertices[(i + 1) % count]);
      vec3 c = vec3_of(vertices[j]), d = vec3_of(vertices[(j + 1) % count]);
      if (side_of(shape->normal, a, b, c) * side_of(shape->normal, a, b, d) < 0 &&
          side_of(shape->normal, c, d, a) * side_of(shape->normal, c, d, b) < 0)
        return true;
    }
  return false;
}

/* ---- disks ---- */

/* Maps the unit square onto the disk of radius 1, squares around the middle onto circles (Shirley and Chiu,
 * "A low distortion map between disk and square", 1997). */
static void square_to_disk(double a, double b, double *x, double *y) {
  a = 2 * a - 1;
  b = 2 * b - 1;
  if (a == 0 && b == 0) {
    *x = *y = 0;
    return;
  }
  bool wide = fabs(a) > fabs(b);
  double radius = wide ? a : b, angle = wide ? HL_PI / 4 * b / a : HL_PI / 2 - HL_PI / 4 * a / b;
  *x = radius * hl_cos(angle);
  *y = radius * hl_sin(angle);
}

vec3 hl_disk_point(vec3 normal, double radius, double a, double b) {
  vec3 u = vec3_perpendicular(normal), v = vec3_cross(normal, u);
  double x, y;
  square_to_disk(a, b, &x, &y);
  return vec3_add(vec3_scale(u, radius * x), vec3_scale(v, radius * y));
}

/* The mean of the matrix x x' over the points x of a disk, relative to its centre. Derived: the mean of x^2
 * over a disk of radius r is r^2/4. */
mat3 hl_disk_spread(vec3 normal, double radius) {
  mat3 spread = {{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}}, unit = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  return hl_add_scaled(spread, hl_add_scaled(unit, hl_outer(normal, normal), -1), radius * radius / 4);
}

emission_plane hl_disk_plane(vec3 normal, double radius, vec3 wanted_up) {
  emission_plane plane = {.middle = {0, 0, 0}};
  hl_upright(normal, wanted_up, &plane.right, &plane.up);
  plane.right = vec3_scale(plane.right, radius);
  plane.up = vec3_scale(plane.up, radius);
  return plane;
}

/* ---- images on lights ---- */

void hl_upright(vec3 normal, vec3 wanted_up, vec3 *right, vec3 *up) {
  *right = vec3_cross(vec3_normalise(wanted_up), normal);
  if (!(vec3_length(*right) > 1e-3)) *right = vec3_cross((vec3){0, 1, 0}, normal);
  if (!(vec3_length(*right) > 1e-3)) *right = vec3_cross((vec3){0, 0, 1}, normal);
  *right = vec3_normalise(*right);
  *up = vec3_cross(normal, *right);
}

/* Finds the image coordinates of a point on a light: solves offset = middle + s right + t up for s and t. The
 * solution (derived by cross products) also holds if right and up are not perpendicular. */
void hl_emission_place(const emission_plane *plane, vec3 offset, double *s, double *t) {
  vec3 on_plane = vec3_subtract(offset, plane->middle), normal = vec3_cross(plane->right, plane->up);
  double area = vec3_dot(normal, normal);
  *s = vec3_dot(vec3_cross(on_plane, plane->up), normal) / area;
  *t = vec3_dot(vec3_cross(plane->right, on_plane), normal) / area;
}
