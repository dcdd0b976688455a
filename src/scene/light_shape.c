/* scene/light_shape.c - polygons, and the first and second moments of lights. */
#include "scene/light_shape.h"

/* a b' */
static mat3 outer(vec3 a, vec3 b) {
  return (mat3){{vec3_scale(b, a.x), vec3_scale(b, a.y), vec3_scale(b, a.z)}};
}

static mat3 add(mat3 a, mat3 b, double scale) {
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

/* A fan of triangles from the first vertex, each with a signed area: what lies outside the polygon cancels.
 * Over a triangle a, b, c the mean of x is s / 3 and that of x x' is (a a' + b b' + c c' + s s') / 12, s = a
 * + b + c, since barycentric coordinates have the mean products 1/6 (squares) and 1/12 (derived). */
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
    squares = add(squares, add(add(outer(b, b), outer(c, c), 1), outer(s, s), 1), area / 12);
  }
  vec3 centre = vec3_scale(sum, 1 / shape.area);
  shape.spread = add((mat3){{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}}, squares, 1 / shape.area);
  shape.spread = add(shape.spread, outer(centre, centre), -1);
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

/* Twice the signed area of the triangle a, b, c as seen along the normal. */
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

vec3 hl_light_centre(const hl_light *light) {
  if (light->type == HL_LIGHT_POLYGON) return hl_polygon_shape(light->vertices, light->vertex_count).centre;
  return vec3_of(light->position);
}

/* Derived: the mean of t^2 over t in [-1/2, 1/2] is 1/12; the mean of x^2 over a disk of radius r is
 * r^2/4. */
mat3 hl_light_spread(const hl_light *light, vec3 facing) {
  mat3 spread = {{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}}, unit = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  if (light->type == HL_LIGHT_POLYGON) return hl_polygon_shape(light->vertices, light->vertex_count).spread;
  if (light->type == HL_LIGHT_RECT) {
    vec3 edge1 = vec3_of(light->edge1), edge2 = vec3_of(light->edge2);
    return add(add(spread, outer(edge1, edge1), 1.0 / 12), outer(edge2, edge2), 1.0 / 12);
  }
  bool parallel = light->type == HL_LIGHT_DIRECTIONAL;
  vec3 normal = light->type == HL_LIGHT_DISK ? vec3_normalise(vec3_of(light->normal)) : facing;
  double radius = parallel ? tan(light->angular_diameter_deg * HL_PI / 360) : light->radius;
  return add(spread, add(unit, outer(normal, normal), -1), radius * radius / 4);
}

/* Unit vectors to the right and upwards, as seen by someone who looks against the normal. */
static void upright(vec3 normal, vec3 wanted_up, vec3 *right, vec3 *up) {
  *right = vec3_cross(vec3_normalise(wanted_up), normal);
  if (!(vec3_length(*right) > 1e-3)) *right = vec3_cross((vec3){0, 1, 0}, normal);
  if (!(vec3_length(*right) > 1e-3)) *right = vec3_cross((vec3){0, 0, 1}, normal);
  *right = vec3_normalise(*right);
  *up = vec3_cross(normal, *right);
}

/* The rectangle around the vertices. */
static emission_plane plane_of_polygon(const hl_light *light) {
  polygon_shape shape = hl_polygon_shape(light->vertices, light->vertex_count);
  double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
  vec3 axis[2];
  upright(shape.normal, vec3_of(light->emission.up), &axis[0], &axis[1]);
  for (size_t i = 0; i < light->vertex_count; i++)
    for (int a = 0; a < 2; a++) {
      double at = vec3_dot(axis[a], vec3_subtract(vec3_of(light->vertices[i]), shape.centre));
      low[a] = fmin(low[a], at);
      high[a] = fmax(high[a], at);
    }
  return (emission_plane){
      vec3_add(vec3_scale(axis[0], (low[0] + high[0]) / 2), vec3_scale(axis[1], (low[1] + high[1]) / 2)),
      vec3_scale(axis[0], (high[0] - low[0]) / 2), vec3_scale(axis[1], (high[1] - low[1]) / 2)};
}

emission_plane hl_emission_plane(const hl_light *light, vec3 facing) {
  emission_plane plane = {.middle = {0, 0, 0}};
  if (light->type == HL_LIGHT_POLYGON) return plane_of_polygon(light);
  if (light->type == HL_LIGHT_RECT) {
    plane.right = vec3_scale(vec3_of(light->edge1), 0.5);
    plane.up = vec3_scale(vec3_of(light->edge2), 0.5);
    return plane;
  }
  double radius = light->type == HL_LIGHT_DIRECTIONAL ? tan(light->angular_diameter_deg * HL_PI / 360)
                                                      : light->radius;
  vec3 normal = light->type == HL_LIGHT_DISK ? vec3_normalise(vec3_of(light->normal)) : facing;
  upright(normal, vec3_of(light->emission.up), &plane.right, &plane.up);
  plane.right = vec3_scale(plane.right, radius);
  plane.up = vec3_scale(plane.up, radius);
  return plane;
}

/* offset = middle + s right + t up: right and up need not be perpendicular (derived, by their cross
 * products). */
void hl_emission_place(const emission_plane *plane, vec3 offset, double *s, double *t) {
  vec3 on_plane = vec3_subtract(offset, plane->middle), normal = vec3_cross(plane->right, plane->up);
  double area = vec3_dot(normal, normal);
  *s = vec3_dot(vec3_cross(on_plane, plane->up), normal) / area;
  *t = vec3_dot(vec3_cross(plane->right, on_plane), normal) / area;
}
