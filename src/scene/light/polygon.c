/* scene/light/polygon.c - implements a light that is a flat polygon, given by its vertices in order around
 * it. */
#include <stdio.h>

#include "scene/light/light_kind.h"

/* ---- checks ---- */

/* Limits of a polygon's shape, as fractions of its diameter. FLAT: the greatest allowed distance of its
 * vertices from its plane. THIN: the least allowed width. */
static const double FLAT = 1e-3, THIN = 1e-6;

static hl_status check_outline(const hl_checker *check, const hl_light *light) {
  hl_status status = hl_check_count(check, "vertices", light->vertices, light->vertex_count,
                                    HL_LIMIT_VERTICES);
  if (status != HL_OK) return status;
  if (light->vertex_count < 3)
    return hl_fail(check->error, HL_ERROR_INPUT, "%s/vertices: has %zu entries: give three points or more",
                   check->place, light->vertex_count);
  for (size_t v = 0; v < light->vertex_count; v++) {
    char element[32];
    snprintf(element, sizeof element, "vertices/%zu", v);
    if ((status = hl_check_point(check, element, light->vertices[v])) != HL_OK) return status;
  }
  polygon_shape shape = hl_polygon_shape(light->vertices, light->vertex_count);
  if (!(shape.area > THIN * shape.diameter * shape.diameter))
    return hl_check_refuse(
        check, "vertices",
        "span no area: move one off the line, or use a rect light with an edge of no length");
  if (hl_polygon_unevenness(&shape, light->vertices, light->vertex_count) > FLAT * shape.diameter)
    return hl_check_refuse(check, "vertices", "do not lie in one plane: move them, or use several lights");
  if (hl_polygon_crosses_itself(&shape, light->vertices, light->vertex_count))
    return hl_check_refuse(check, "vertices",
                           "go around an outline that crosses itself: give them in order around it");
  return HL_OK;
}

static hl_status reaches(const hl_checker *check, const hl_light *light, const hl_frame_space *space) {
  hl_status status = hl_check_reach(check, "radius", light->radius, space);
  for (size_t v = 0; status == HL_OK && v < light->vertex_count; v++)
    status = hl_check_distance(check, "vertices", light->vertices[v], space);
  return status;
}

/* ---- points ---- */

/* A polygon in its own plane, with the x axis along its longest edge. */
typedef struct flat_polygon {
  const light_shape *shape;
  vec3 centre, u, v;
} flat_polygon;

static void vertex_at(const flat_polygon *polygon, size_t index, double *x, double *y) {
  vec3 offset = vec3_subtract(vec3_of(polygon->shape->vertices[index % polygon->shape->vertex_count]),
                              polygon->centre);
  *x = vec3_dot(offset, polygon->u);
  *y = vec3_dot(offset, polygon->v);
}

static flat_polygon flatten(const light_shape *shape) {
  vec3 normal = hl_polygon_shape(shape->vertices, shape->vertex_count).normal;
  flat_polygon polygon = {.shape = shape, .centre = shape->centre};
  for (size_t i = 0; i < shape->vertex_count; i++) {
    vec3 edge = vec3_subtract(vec3_of(shape->vertices[(i + 1) % shape->vertex_count]),
                              vec3_of(shape->vertices[i]));
    edge = vec3_subtract(edge, vec3_scale(normal, vec3_dot(edge, normal)));
    if (vec3_length(edge) > vec3_length(polygon.u)) polygon.u = edge;
  }
  polygon.u = vec3_normalise(polygon.u);
  polygon.v = vec3_cross(normal, polygon.u);
  return polygon;
}

/* The area of the part of the polygon left of x. Derived by Green's theorem: the area is the integral of y dx
 * along the part of the outline left of x. The cut at x runs along y and adds nothing. The sign of the
 * integral is reversed, because the outline runs counter-clockwise about the normal. */
static double area_left_of(const flat_polygon *polygon, double x) {
  double area = 0;
  for (size_t i = 0; i < polygon->shape->vertex_count; i++) {
    double ax, ay, bx, by;
    vertex_at(polygon, i, &ax, &ay);
    vertex_at(polygon, i + 1, &bx, &by);
    if (ax == bx) continue;
    double from = fmin(ax, x), to = fmin(bx, x), slope = (by - ay) / (bx - ax);
    area -= (to - from) * (ay + slope * ((from + to) / 2 - ax));
  }
  return area;
}

/* Finds the y on the vertical line at x below which the fraction b of the line's length in the polygon lies.
 * The line may enter and leave the polygon several times. */
static double height_of_part(const flat_polygon *polygon, double x, double b) {
  double crossing[HL_LIMIT_VERTICES], length = 0;
  size_t count = 0;
  for (size_t i = 0; i < polygon->shape->vertex_count; i++) {
    double ax, ay, bx, by;
    vertex_at(polygon, i, &ax, &ay);
    vertex_at(polygon, i + 1, &bx, &by);
    if ((ax > x) == (bx > x)) continue;
    double y = ay + (by - ay) * (x - ax) / (bx - ax);
    size_t at = count++;
    for (; at > 0 && crossing[at - 1] > y; at--) crossing[at] = crossing[at - 1];
    crossing[at] = y;
  }
  for (size_t i = 0; i + 1 < count; i += 2) length += crossing[i + 1] - crossing[i];
  double left = b * length;
  for (size_t i = 0; i + 1 < count; i += 2) {
    double piece = crossing[i + 1] - crossing[i];
    if (left <= piece) return crossing[i] + left;
    left -= piece;
  }
  return count > 0 ? crossing[count - 1] : 0;
}

/* The point of the polygon that belongs to the point (a, b) of the unit square. The fraction a of the
 * polygon's area lies left of the point's x. On the vertical line at x, the fraction b of the line's length
 * in the polygon lies below the point's y. */
static vec3 point(const light_shape *shape, vec3 facing, double a, double b) {
  (void)facing;
  flat_polygon polygon = flatten(shape);
  double low = INFINITY, high = -INFINITY;
  for (size_t i = 0; i < shape->vertex_count; i++) {
    double x, y;
    vertex_at(&polygon, i, &x, &y);
    low = fmin(low, x);
    high = fmax(high, x);
  }
  double wanted = a * area_left_of(&polygon, high);
  for (int i = 0; i < 40; i++) {
    double middle = (low + high) / 2;
    if (area_left_of(&polygon, middle) < wanted) low = middle;
    else high = middle;
  }
  double y = height_of_part(&polygon, low, b);
  return vec3_add(vec3_scale(polygon.u, low), vec3_scale(polygon.v, y));
}

/* ---- all steps together ---- */

static light_shape shape_of(const hl_light *light) {
  return (light_shape){.centre = hl_polygon_shape(light->vertices, light->vertex_count).centre,
                       .vertices = light->vertices,
                       .vertex_count = light->vertex_count,
                       .is_wide = true,
                       .has_surface = true};
}

static mat3 spread(const light_shape *shape, vec3 facing) {
  (void)facing;
  return hl_polygon_shape(shape->vertices, shape->vertex_count).spread;
}

/* The plane of an emission image that fills the rectangle around the vertices of a polygon. */
static emission_plane plane(const light_shape *shape, vec3 facing) {
  (void)facing;
  vec3 normal = hl_polygon_shape(shape->vertices, shape->vertex_count).normal;
  double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
  vec3 axis[2];
  hl_upright(normal, shape->image_up, &axis[0], &axis[1]);
  for (size_t i = 0; i < shape->vertex_count; i++)
    for (int a = 0; a < 2; a++) {
      double at = vec3_dot(axis[a], vec3_subtract(vec3_of(shape->vertices[i]), shape->centre));
      low[a] = fmin(low[a], at);
      high[a] = fmax(high[a], at);
    }
  return (emission_plane){
      vec3_add(vec3_scale(axis[0], (low[0] + high[0]) / 2), vec3_scale(axis[1], (low[1] + high[1]) / 2)),
      vec3_scale(axis[0], (high[0] - low[0]) / 2), vec3_scale(axis[1], (high[1] - low[1]) / 2)};
}

static void apparent_lengths(const light_shape *shape, vec3 along, double length[2]) {
  (void)shape, (void)along;
  length[0] = length[1] = INFINITY;
}

/* The table of polygons. For its extent, a polygon counts as a box, which is sqrt(12) standard deviations
 * wide. */
const light_kind hl_light_kind_polygon = {.outline = true,
                                          .deviations = 3.4641016151377544,
                                          .check = check_outline,
                                          .check_reach = reaches,
                                          .shape = shape_of,
                                          .spread = spread,
                                          .point = point,
                                          .plane = plane,
                                          .apparent_lengths = apparent_lengths};
