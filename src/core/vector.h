/* core/vector.h - defines vectors and matrices of three dimensions in double precision, for computations that
 * are made once per frame. */
#ifndef HL_CORE_VECTOR_H
#define HL_CORE_VECTOR_H

#include <math.h>
#include <stdbool.h>

#include "elementary/elementary.h"

typedef struct vec3 {
  double x, y, z;
} vec3;

/* A matrix of three rows. The product with a vector is m * v = (dot(row0, v), dot(row1, v), dot(row2, v)). */
typedef struct mat3 {
  vec3 row[3];
} mat3;

/* A map of points p: p -> linear * p + offset. */
typedef struct affine3 {
  mat3 linear;
  vec3 offset;
} affine3;

static inline vec3 vec3_of(const double v[3]) { return (vec3){v[0], v[1], v[2]}; }
static inline void vec3_store(float out[3], vec3 v) {
  out[0] = (float)v.x;
  out[1] = (float)v.y;
  out[2] = (float)v.z;
}
static inline vec3 vec3_add(vec3 a, vec3 b) { return (vec3){a.x + b.x, a.y + b.y, a.z + b.z}; }
static inline vec3 vec3_subtract(vec3 a, vec3 b) { return (vec3){a.x - b.x, a.y - b.y, a.z - b.z}; }
static inline vec3 vec3_scale(vec3 a, double s) { return (vec3){a.x * s, a.y * s, a.z * s}; }
static inline double vec3_dot(vec3 a, vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
/* axis: 0, 1 or 2 */
static inline double vec3_component(vec3 a, int axis) { return axis == 0 ? a.x : axis == 1 ? a.y : a.z; }
static inline double vec3_length(vec3 a) { return sqrt(vec3_dot(a, a)); }
static inline vec3 vec3_cross(vec3 a, vec3 b) {
  return (vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
static inline vec3 vec3_normalise(vec3 a) {
  double length = vec3_length(a);
  return length > 0 ? vec3_scale(a, 1 / length) : a;
}
/* Returns a unit vector perpendicular to the unit vector a. */
static inline vec3 vec3_perpendicular(vec3 a) {
  vec3 other = fabs(a.x) < 0.6 ? (vec3){1, 0, 0} : (vec3){0, 1, 0};
  return vec3_normalise(vec3_cross(a, other));
}

static inline vec3 mat3_apply(mat3 m, vec3 v) {
  return (vec3){vec3_dot(m.row[0], v), vec3_dot(m.row[1], v), vec3_dot(m.row[2], v)};
}
static inline mat3 mat3_from_columns(vec3 a, vec3 b, vec3 c) {
  return (mat3){{{a.x, b.x, c.x}, {a.y, b.y, c.y}, {a.z, b.z, c.z}}};
}
static inline vec3 mat3_column(mat3 m, int column) {
  const double *r0 = &m.row[0].x, *r1 = &m.row[1].x, *r2 = &m.row[2].x;
  return (vec3){r0[column], r1[column], r2[column]};
}
static inline mat3 mat3_multiply(mat3 a, mat3 b) {
  return mat3_from_columns(mat3_apply(a, mat3_column(b, 0)), mat3_apply(a, mat3_column(b, 1)),
                           mat3_apply(a, mat3_column(b, 2)));
}
static inline mat3 mat3_transpose(mat3 m) { return mat3_from_columns(m.row[0], m.row[1], m.row[2]); }
/* The product of the lengths of the rows: the greatest determinant that rows of these lengths can have. */
static inline double mat3_row_sizes(mat3 m) {
  return vec3_length(m.row[0]) * vec3_length(m.row[1]) * vec3_length(m.row[2]);
}
/* Inverts a matrix. Returns false if m is singular to working precision; the test does not depend on the
 * scales of the rows and columns. */
static inline bool mat3_invert(mat3 m, mat3 *inverse) {
  vec3 c0 = vec3_cross(m.row[1], m.row[2]), c1 = vec3_cross(m.row[2], m.row[0]),
       c2 = vec3_cross(m.row[0], m.row[1]);
  double determinant = vec3_dot(m.row[0], c0);
  double size = fmin(mat3_row_sizes(m), mat3_row_sizes(mat3_transpose(m)));
  if (!(fabs(determinant) > 1e-12 * size) || !isfinite(determinant)) return false;
  *inverse = mat3_from_columns(vec3_scale(c0, 1 / determinant), vec3_scale(c1, 1 / determinant),
                               vec3_scale(c2, 1 / determinant));
  return true;
}
/* The matrix of a right-handed rotation by angle_rad about the unit vector `axis` (Rodrigues). */
static inline mat3 mat3_rotation(vec3 axis, double angle_rad) {
  double c = hl_cos(angle_rad), s = hl_sin(angle_rad), t = 1 - c;
  return (mat3){
      {{t * axis.x * axis.x + c, t * axis.x * axis.y - s * axis.z, t * axis.x * axis.z + s * axis.y},
       {t * axis.x * axis.y + s * axis.z, t * axis.y * axis.y + c, t * axis.y * axis.z - s * axis.x},
       {t * axis.x * axis.z - s * axis.y, t * axis.y * axis.z + s * axis.x, t * axis.z * axis.z + c}}};
}

static inline double mat3_shortest_column(mat3 m) {
  return fmin(vec3_length(mat3_column(m, 0)),
              fmin(vec3_length(mat3_column(m, 1)), vec3_length(mat3_column(m, 2))));
}

/* Grows a box so that it holds a point. */
static inline void vec3_bound(vec3 p, double low[3], double high[3]) {
  const double at[3] = {p.x, p.y, p.z};
  for (int a = 0; a < 3; a++) low[a] = fmin(low[a], at[a]), high[a] = fmax(high[a], at[a]);
}

/* Grows a box so that it holds a ball. */
static inline void vec3_bound_ball(vec3 middle, double radius, double low[3], double high[3]) {
  const double at[3] = {middle.x, middle.y, middle.z};
  for (int a = 0; a < 3; a++) {
    low[a] = at[a] - radius < low[a] ? at[a] - radius : low[a];
    high[a] = at[a] + radius > high[a] ? at[a] + radius : high[a];
  }
}

static inline affine3 affine3_identity(void) {
  return (affine3){{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, {0, 0, 0}};
}
/* Stores the three rows of a map, [linear | offset], as floats. */
static inline void affine3_store(float rows[3][4], const affine3 *map) {
  const double offset[3] = {map->offset.x, map->offset.y, map->offset.z};
  for (int r = 0; r < 3; r++) {
    vec3_store(rows[r], map->linear.row[r]);
    rows[r][3] = (float)offset[r];
  }
}
static inline vec3 affine3_apply(affine3 a, vec3 p) { return vec3_add(mat3_apply(a.linear, p), a.offset); }
/* The map p -> a(b(p)), which applies first b and then a. */
static inline affine3 affine3_multiply(affine3 a, affine3 b) {
  return (affine3){mat3_multiply(a.linear, b.linear), affine3_apply(a, b.offset)};
}
static inline bool affine3_invert(affine3 a, affine3 *inverse) {
  if (!mat3_invert(a.linear, &inverse->linear)) return false;
  inverse->offset = vec3_scale(mat3_apply(inverse->linear, a.offset), -1);
  return true;
}

#endif
