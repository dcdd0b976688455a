/* light/light_extent.c - maps the unit square onto each shape of light; moments of the light as seen from the
 * sheets. */
#include "light/light_extent.h"

#include "scene/light_shape.h"
#include "scene/limits.h"

/* ---- points on lights ---- */

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
  *x = radius * cos(angle);
  *y = radius * sin(angle);
}

static vec3 point_of_disk(vec3 normal, double radius, double a, double b) {
  vec3 u = vec3_perpendicular(normal), v = vec3_cross(normal, u);
  double x, y;
  square_to_disk(a, b, &x, &y);
  return vec3_add(vec3_scale(u, radius * x), vec3_scale(v, radius * y));
}

/* A polygon in its plane: x along its longest edge. */
typedef struct flat_polygon {
  const hl_light *light;
  vec3 centre, u, v;
} flat_polygon;

static void vertex_at(const flat_polygon *polygon, size_t index, double *x, double *y) {
  vec3 offset = vec3_subtract(vec3_of(polygon->light->vertices[index % polygon->light->vertex_count]),
                              polygon->centre);
  *x = vec3_dot(offset, polygon->u);
  *y = vec3_dot(offset, polygon->v);
}

static flat_polygon flatten(const hl_light *light) {
  polygon_shape shape = hl_polygon_shape(light->vertices, light->vertex_count);
  flat_polygon polygon = {.light = light, .centre = shape.centre};
  for (size_t i = 0; i < light->vertex_count; i++) {
    vec3 edge = vec3_subtract(vec3_of(light->vertices[(i + 1) % light->vertex_count]),
                              vec3_of(light->vertices[i]));
    edge = vec3_subtract(edge, vec3_scale(shape.normal, vec3_dot(edge, shape.normal)));
    if (vec3_length(edge) > vec3_length(polygon.u)) polygon.u = edge;
  }
  polygon.u = vec3_normalise(polygon.u);
  polygon.v = vec3_cross(shape.normal, polygon.u);
  return polygon;
}

/* The polygon's area left of x: the integral of y dx along the part of the outline left of x (derived:
 * Green's theorem; the cut runs along y and adds nothing). The outline runs counterclockwise about the
 * normal, so the sign is reversed. */
static double area_left_of(const flat_polygon *polygon, double x) {
  double area = 0;
  for (size_t i = 0; i < polygon->light->vertex_count; i++) {
    double ax, ay, bx, by;
    vertex_at(polygon, i, &ax, &ay);
    vertex_at(polygon, i + 1, &bx, &by);
    if (ax == bx) continue;
    double from = fmin(ax, x), to = fmin(bx, x), slope = (by - ay) / (bx - ax);
    area -= (to - from) * (ay + slope * ((from + to) / 2 - ax));
  }
  return area;
}

/* The y below which the fraction b of the vertical line at x lies, as far as the line runs inside the
 * polygon. */
static double height_of_part(const flat_polygon *polygon, double x, double b) {
  double crossing[HL_LIMIT_VERTICES], length = 0;
  size_t count = 0;
  for (size_t i = 0; i < polygon->light->vertex_count; i++) {
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

/* The point for (a, b): the fraction a of the area lies left of its x, and the fraction b of the polygon's
 * line at x lies below its y. */
static vec3 point_of_polygon(const hl_light *light, double a, double b) {
  flat_polygon polygon = flatten(light);
  double low = INFINITY, high = -INFINITY;
  for (size_t i = 0; i < light->vertex_count; i++) {
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

vec3 hl_light_point(const light_source *source, double a, double b) {
  const hl_light *light = source->light;
  switch (light->type) {
    case HL_LIGHT_DIRECTIONAL:
      return point_of_disk(source->direction, tan(light->angular_diameter_deg * HL_PI / 360), a, b);
    case HL_LIGHT_RECT:
      return vec3_add(vec3_scale(vec3_of(light->edge1), a - 0.5), vec3_scale(vec3_of(light->edge2), b - 0.5));
    case HL_LIGHT_DISK: return point_of_disk(vec3_normalise(vec3_of(light->normal)), light->radius, a, b);
    case HL_LIGHT_POLYGON: return point_of_polygon(light, a, b);
    case HL_LIGHT_POINT:
    case HL_LIGHT_SPOT: break;
  }
  return point_of_disk(source->direction, light->radius, a, b);
}

/* ---- the light as seen from the sheets ---- */

/* A symmetric 2x2 matrix along u and v. */
typedef struct covariance {
  double uu, uv, vv;
} covariance;

/* Turns u and v by the angle at which uv vanishes, tan(2 angle) = 2 uv / (uu - vv) (derived). */
static covariance turn_to_axes(covariance c, vec3 *u, vec3 *v) {
  double angle = 0.5 * atan2(2 * c.uv, c.uu - c.vv);
  double cosine = cos(angle), sine = sin(angle);
  vec3 turned = vec3_add(vec3_scale(*u, cosine), vec3_scale(*v, sine));
  *v = vec3_add(vec3_scale(*v, cosine), vec3_scale(*u, -sine));
  *u = turned;
  double mean = (c.uu + c.vv) / 2, half = sqrt((c.uu - c.vv) * (c.uu - c.vv) / 4 + c.uv * c.uv);
  return (covariance){mean + half, 0, fmax(mean - half, 0)};
}

static vec3 onto_plane(vec3 x, vec3 normal) {
  return vec3_subtract(x, vec3_scale(normal, vec3_dot(x, normal)));
}

/* The u axis in the sheets before it is turned to the principal axis: a rect's edge, else the light's tilt.
 */
static vec3 first_axis(const light_source *source, vec3 normal) {
  vec3 axis = onto_plane(source->direction, normal);
  if (source->light->type == HL_LIGHT_RECT) axis = onto_plane(vec3_of(source->light->edge1), normal);
  return vec3_length(axis) > 1e-3 * vec3_length(source->light->type == HL_LIGHT_RECT
                                                    ? vec3_of(source->light->edge1)
                                                    : source->direction)
             ? vec3_normalise(axis)
             : vec3_perpendicular(normal);
}

/* Projects a point of the light onto the plane, along its ray to the content's middle. Points nearly as low
 * as the content are moved by at most a factor of four; a light beside or below the content's middle is
 * projected along the sheets' normal. */
static vec3 seen_on_plane(const light_source *source, vec3 normal, vec3 offset) {
  if (source->parallel) {
    vec3 way = vec3_add(source->direction, offset);
    return vec3_scale(way, vec3_dot(source->direction, normal) / fmax(vec3_dot(way, normal), 0.05));
  }
  vec3 way = vec3_subtract(vec3_add(source->position, offset), source->content);
  double whole = vec3_dot(normal, vec3_subtract(source->position, source->content)),
         part = vec3_dot(normal, way);
  if (whole >= 0)
    return vec3_subtract(vec3_add(source->position, offset), vec3_scale(normal, vec3_dot(offset, normal)));
  double scale = part < whole / 4 ? whole / part : 4;
  return vec3_add(source->content, vec3_scale(way, scale));
}

enum { MOMENT_SIDE = 16 };

sheet_light hl_light_on_sheets(const light_source *source, vec3 normal) {
  sheet_light seen;
  vec3 sum = {0, 0, 0}, centre = source->parallel ? source->direction : source->position;
  covariance c = {0, 0, 0};
  seen.u = first_axis(source, normal);
  seen.v = vec3_cross(normal, seen.u);
  for (int i = 0; i < MOMENT_SIDE; i++)
    for (int j = 0; j < MOMENT_SIDE; j++) {
      double square[2];
      hl_sublight_grid_point(MOMENT_SIDE, i, j, square);
      vec3 point = vec3_subtract(seen_on_plane(source, normal, hl_light_point(source, square[0], square[1])),
                                 centre);
      double u = vec3_dot(point, seen.u), v = vec3_dot(point, seen.v);
      sum = vec3_add(sum, point);
      c = (covariance){c.uu + u * u, c.uv + u * v, c.vv + v * v};
    }
  double n = MOMENT_SIDE * MOMENT_SIDE;
  vec3 mean = vec3_scale(sum, 1 / n);
  double u = vec3_dot(mean, seen.u), v = vec3_dot(mean, seen.v);
  c = turn_to_axes((covariance){c.uu / n - u * u, c.uv / n - u * v, c.vv / n - v * v}, &seen.u, &seen.v);
  /* parallel: the plane that the direction ends on is at height l.h, the widths are those at height 1 */
  double height = source->parallel ? fmax(vec3_dot(source->direction, normal), 0.1) : 1;
  seen.middle = vec3_add(centre, mean);
  seen.width_u = sqrt(12 * fmax(c.uu, 0)) / height;
  seen.width_v = sqrt(12 * fmax(c.vv, 0)) / height;
  const vec3 axes[3] = {seen.u, seen.v, normal};
  for (int row = 0; row < 3; row++) {
    vec3 s = mat3_apply(source->spread, axes[row]);
    seen.spread.row[row] = (vec3){vec3_dot(s, seen.u), vec3_dot(s, seen.v), vec3_dot(s, normal)};
  }
  seen.parallel = source->parallel;
  return seen;
}

void hl_sheet_light_position(const sheet_light *seen, const light_source *source, vec3 normal, vec3 offset,
                             double position[3]) {
  vec3 point = source->parallel ? seen_on_plane(source, normal, offset) : vec3_add(source->position, offset);
  vec3 from_middle = vec3_subtract(point, seen->middle);
  double height = source->parallel ? fmax(vec3_dot(source->direction, normal), 0.1) : 1;
  position[0] = vec3_dot(from_middle, seen->u) / height;
  position[1] = vec3_dot(from_middle, seen->v) / height;
  position[2] = source->parallel ? 0 : vec3_dot(from_middle, normal);
}

/* Derived: seen from a receiver at slope s, a point of the light at x + z h lies at x - s z on the plane
 * through the light's centre. A box of width w has the variance w^2 / 12, so w^2 is 12 times the mean square
 * of x - s z. */
double hl_sheet_light_squared_width(const sheet_light *light, int axis, double slope) {
  double width = axis == 0 ? light->width_u : light->width_v;
  if (light->parallel) return width * width;
  double xx = axis == 0 ? light->spread.row[0].x : light->spread.row[1].y;
  double xz = axis == 0 ? light->spread.row[0].z : light->spread.row[1].z, zz = light->spread.row[2].z;
  return 12 * fmax(xx - 2 * slope * xz + slope * slope * zz, 0);
}

/* The mean of both extents. An extent is 4 standard deviations for disks, sqrt(12) for rects and polygons. */
double hl_light_average_size(const light_source *source, vec3 normal) {
  bool square = source->light->type == HL_LIGHT_RECT || source->light->type == HL_LIGHT_POLYGON;
  vec3 u = vec3_perpendicular(normal), v = vec3_cross(normal, u);
  vec3 su = mat3_apply(source->spread, u), sv = mat3_apply(source->spread, v);
  covariance c = turn_to_axes((covariance){vec3_dot(u, su), vec3_dot(u, sv), vec3_dot(v, sv)}, &u, &v);
  return (square ? sqrt(12) : 4) * (sqrt(c.uu) + sqrt(c.vv)) / 2;
}
