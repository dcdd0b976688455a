/* shape/distance.c - computes the signed distances of shapes and groups, and bounds of these distances over a
 * ball.
 *
 * The distances of single shapes are exact (after I. Quilez, "Distance functions"), so that within a ball of
 * radius r the distance differs by at most r from the distance at the ball's centre. Joints are monotone in
 * both distances. So the bounds of a joint are the joint of the two lower bounds and the joint of the two
 * upper bounds. */
#include <math.h>

#include "shape/shape.h"

static double length2(double a, double b) { return sqrt(a * a + b * b); }
static double length3(double a, double b, double c) { return sqrt(a * a + b * b + c * c); }
static double clamp(double x, double low, double high) { return x < low ? low : x > high ? high : x; }
static double above(double x) { return x > 0 ? x : 0; }

static double box_distance(vec3 p, const double half[3], double rounding) {
  double x = fabs(p.x) - half[0] + rounding, y = fabs(p.y) - half[1] + rounding,
         z = fabs(p.z) - half[2] + rounding;
  return length3(above(x), above(y), above(z)) + fmin(fmax(x, fmax(y, z)), 0) - rounding;
}

/* A point relative to an axis: its coordinate along the axis, from the axis's middle, and its distance from
 * the axis. */
typedef struct axial {
  double along, away, half;
} axial;

static axial about_axis(const hl_shape *shape, vec3 p) {
  vec3 from = vec3_of(shape->from), axis = vec3_subtract(vec3_of(shape->to), from);
  double length = vec3_length(axis);
  vec3 q = vec3_subtract(p, from);
  double t = vec3_dot(q, axis) / length;
  vec3 off = vec3_subtract(q, vec3_scale(axis, t / length));
  return (axial){t - length / 2, vec3_length(off), length / 2};
}

static double cylinder_distance(const hl_shape *shape, axial q) {
  double x = q.away - shape->radius + shape->rounding, y = fabs(q.along) - q.half + shape->rounding;
  return fmin(fmax(x, y), 0) + length2(above(x), above(y)) - shape->rounding;
}

static double capsule_distance(const hl_shape *shape, axial q) {
  return length2(above(fabs(q.along) - q.half), q.away) - shape->radius;
}

/* The distance of a point from a cone: the least of its distances from the two flat ends and from the slanted
 * side. */
static double cone_distance(const hl_shape *shape, axial q) {
  double r1 = shape->radius, r2 = shape->end_radius;
  double end_x = q.away - fmin(q.away, q.along < 0 ? r1 : r2), end_y = fabs(q.along) - q.half;
  double slope_x = r2 - r1, slope_y = 2 * q.half;
  double t = ((r2 - q.away) * slope_x + (q.half - q.along) * slope_y) /
             (slope_x * slope_x + slope_y * slope_y);
  t = clamp(t, 0, 1);
  double side_x = q.away - r2 + slope_x * t, side_y = q.along - q.half + slope_y * t;
  double distance = fmin(length2(end_x, end_y), length2(side_x, side_y));
  return side_x < 0 && end_y < 0 ? -distance : distance;
}

static double solid_distance(const hl_shape *shape, vec3 p) {
  const double half[3] = {shape->size[0] / 2, shape->size[1] / 2, shape->size[2] / 2};
  switch (shape->type) {
    case HL_SHAPE_BOX: return box_distance(p, half, shape->rounding);
    case HL_SHAPE_PLANE: return box_distance((vec3){p.x, p.y, p.z + half[2]}, half, shape->rounding);
    case HL_SHAPE_SPHERE: return vec3_length(p) - shape->radius;
    case HL_SHAPE_CYLINDER: return cylinder_distance(shape, about_axis(shape, p));
    case HL_SHAPE_CAPSULE: return capsule_distance(shape, about_axis(shape, p));
    case HL_SHAPE_CONE: return cone_distance(shape, about_axis(shape, p));
    case HL_SHAPE_TORUS: return length2(length2(p.x, p.y) - shape->radius, p.z) - shape->tube_radius;
    case HL_SHAPE_ORBITAL:
    case HL_SHAPE_GROUP: break;
  }
  return INFINITY;
}

/* The smaller of two distances. The result is rounded if the two differ by less than k (Quilez, "Smooth
 * minimum", quadratic). */
static double smooth_minimum(double a, double b, double k) {
  double h = k > 0 ? above(k - fabs(a - b)) / k : 0;
  return fmin(a, b) - h * h * k / 4;
}
static double smooth_maximum(double a, double b, double k) { return -smooth_minimum(-a, -b, k); }

static double join(const hl_shape *shape, double before, double distance) {
  switch (shape->operation) {
    case HL_SHAPE_ADD: return smooth_minimum(before, distance, shape->blend);
    case HL_SHAPE_SUBTRACT: return smooth_maximum(before, -distance, shape->blend);
    case HL_SHAPE_INTERSECT: return smooth_maximum(before, distance, shape->blend);
  }
  return before;
}

static double shape_distance(const hl_shape_list *list, size_t index, const unsigned char *live, vec3 parent);

/* The distance of a point from all shapes with the numbers in [first, end) of one list, which are joined one
 * after the other. p: a point in the list's frame. */
static double list_distance(const hl_shape_list *list, size_t first, size_t end, const unsigned char *live,
                            vec3 p) {
  double distance = INFINITY;
  for (size_t index = first; index < end; index = list->shapes[index].end)
    if (live == NULL || live[index])
      distance = join(&list->shapes[index], distance, shape_distance(list, index, live, p));
  return distance;
}

static double bare_distance(const hl_shape_list *list, size_t index, const unsigned char *live, vec3 p) {
  const hl_shape *shape = &list->shapes[index];
  return shape->type == HL_SHAPE_GROUP ? list_distance(list, index + 1, shape->end, live, p)
                                       : solid_distance(shape, p);
}

/* The point of the surface that is nearest to a point. It lies at the end of one step from the given point:
 * opposite to the gradient of the distance, and as long as the distance. */
static vec3 foot_point(const hl_shape_list *list, size_t index, const unsigned char *live, vec3 p,
                       double distance) {
  double h = list->shapes[index].edge / 64;
  vec3 x = {h, 0, 0}, y = {0, h, 0}, z = {0, 0, h};
  vec3 slope = {bare_distance(list, index, live, vec3_add(p, x)) -
                    bare_distance(list, index, live, vec3_subtract(p, x)),
                bare_distance(list, index, live, vec3_add(p, y)) -
                    bare_distance(list, index, live, vec3_subtract(p, y)),
                bare_distance(list, index, live, vec3_add(p, z)) -
                    bare_distance(list, index, live, vec3_subtract(p, z))};
  return vec3_subtract(p, vec3_scale(vec3_normalise(slope), distance));
}

static double shape_distance(const hl_shape_list *list, size_t index, const unsigned char *live,
                             vec3 parent) {
  const hl_shape *shape = &list->shapes[index];
  vec3 p = affine3_apply(shape->to_local, parent);
  double distance = bare_distance(list, index, live, p);
  if (shape->texture.pattern != HL_PATTERN_NONE) {
    bool strands = shape->texture.strands && hl_hypertexture_matters(shape, distance);
    vec3 foot = strands ? foot_point(list, index, live, p, distance) : p;
    distance = hl_hypertexture_distance(shape, distance, p, foot);
  }
  return distance * shape->scale;
}

double hl_shapes_distance(const hl_shape_list *list, const unsigned char *live, vec3 p) {
  return list_distance(list, 0, list->count, live, p);
}

static void mark(size_t first, size_t end, unsigned char *live, unsigned char value) {
  for (size_t index = first; index < end; index++) live[index] = value;
}

/* Returns whether a shape whose distances lie within the bounds `own` can change the distances of the shapes
 * before it, which lie within the bounds `before`. */
static bool has_say(const hl_shape *shape, hl_interval before, hl_interval own) {
  switch (shape->operation) {
    case HL_SHAPE_ADD: return own.low < before.high + shape->blend;
    case HL_SHAPE_SUBTRACT: return -own.low > before.low - shape->blend;
    case HL_SHAPE_INTERSECT: return own.high > before.low - shape->blend;
  }
  return true;
}

static hl_interval shape_bounds(const hl_shape_list *list, size_t index, vec3 parent, double radius,
                                unsigned char *live);

static hl_interval list_bounds(const hl_shape_list *list, size_t first, size_t end, vec3 p, double radius,
                               unsigned char *live) {
  hl_interval all = {INFINITY, INFINITY};
  for (size_t index = first; index < end; index = list->shapes[index].end) {
    const hl_shape *shape = &list->shapes[index];
    hl_interval own = shape_bounds(list, index, p, radius, live);
    if (!has_say(shape, all, own)) {
      live[index] = 0;
      continue;
    }
    live[index] = 1;
    if (shape->operation == HL_SHAPE_ADD && all.low >= own.high + shape->blend)
      mark(first, index, live, 0); /* all shapes before the present shape are farther away, so that they do
                                    * not count */
    bool turned = shape->operation == HL_SHAPE_SUBTRACT;
    all = (hl_interval){join(shape, all.low, turned ? own.high : own.low),
                        join(shape, all.high, turned ? own.low : own.high)};
  }
  return all;
}

static hl_interval shape_bounds(const hl_shape_list *list, size_t index, vec3 parent, double radius,
                                unsigned char *live) {
  const hl_shape *shape = &list->shapes[index];
  vec3 p = affine3_apply(shape->to_local, parent);
  hl_interval bounds;
  radius /= shape->scale;
  if (shape->type == HL_SHAPE_GROUP) {
    bounds = list_bounds(list, index + 1, shape->end, p, radius, live);
  } else {
    double distance = solid_distance(shape, p);
    bounds = (hl_interval){distance - radius, distance + radius};
  }
  if (shape->texture.pattern != HL_PATTERN_NONE) bounds = hl_hypertexture_bounds(shape, bounds);
  return (hl_interval){bounds.low * shape->scale, bounds.high * shape->scale};
}

hl_interval hl_shapes_bounds(const hl_shape_list *list, vec3 p, double radius, unsigned char *live) {
  return list_bounds(list, 0, list->count, p, radius, live);
}
