/* light/light_extent.c - finds points on a light, and the light's mean position and variances as seen from
 * the sheets. */
#include "light/light_extent.h"

#include "elementary/elementary.h"

vec3 hl_light_point(const light_source *source, double a, double b) {
  return source->shape.kind->point(&source->shape, source->direction, a, b);
}

/* ---- the light as seen from the sheets ---- */

/* A symmetric 2x2 matrix of variances and covariance along the axes u and v. */
typedef struct covariance {
  double uu, uv, vv;
} covariance;

/* Turns u and v by the angle at which the covariance uv vanishes, tan(2 angle) = 2 uv / (uu - vv)
 * (derived). */
static covariance turn_to_axes(covariance c, vec3 *u, vec3 *v) {
  double angle = 0.5 * hl_atan2(2 * c.uv, c.uu - c.vv);
  double cosine = hl_cos(angle), sine = hl_sin(angle);
  vec3 turned = vec3_add(vec3_scale(*u, cosine), vec3_scale(*v, sine));
  *v = vec3_add(vec3_scale(*v, cosine), vec3_scale(*u, -sine));
  *u = turned;
  double mean = (c.uu + c.vv) / 2, half = sqrt((c.uu - c.vv) * (c.uu - c.vv) / 4 + c.uv * c.uv);
  return (covariance){mean + half, 0, fmax(mean - half, 0)};
}

static vec3 onto_plane(vec3 x, vec3 normal) {
  return vec3_subtract(x, vec3_scale(normal, vec3_dot(x, normal)));
}

/* Chooses a first axis u within the sheets: the projection of the light's direction, or of an edge if the
 * light is a parallelogram. turn_to_axes() turns this axis to the principal axis later. */
static vec3 first_axis(const light_source *source, vec3 normal) {
  vec3 along = source->shape.kind->parallelogram ? source->shape.edge1 : source->direction;
  vec3 axis = onto_plane(along, normal);
  return vec3_length(axis) > 1e-3 * vec3_length(along) ? vec3_normalise(axis) : vec3_perpendicular(normal);
}

/* Projects a point of the light onto a plane that is parallel to the sheets, along the ray from the content's
 * middle to the point. A point that is nearly as low as the content would be moved far away; so a point's
 * distance from the content is multiplied by at most four. If the light lies beside or below the content's
 * middle, the point is projected along the sheets' normal. */
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
  /* For parallel light, the plane goes through the end of the direction vector l. So its height is l.h, where
   * h is the sheets' normal. Widths divided by this height are the widths at the height 1. */
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

/* Finds a light's squared width for receivers at a slope. Derived: seen from a receiver at slope s, a point
 * of the light at x + z h lies at x - s z on the plane through the light's centre. A box of width w has the
 * variance w^2 / 12, so w^2 is 12 times the mean square of x - s z. */
double hl_sheet_light_squared_width(const sheet_light *light, int axis, double slope) {
  double width = axis == 0 ? light->width_u : light->width_v;
  if (light->parallel) return width * width;
  double xx = axis == 0 ? light->spread.row[0].x : light->spread.row[1].y;
  double xz = axis == 0 ? light->spread.row[0].z : light->spread.row[1].z, zz = light->spread.row[2].z;
  return 12 * fmax(xx - 2 * slope * xz + slope * slope * zz, 0);
}

/* The average size is the mean of the extents of the light's projection along the projection's two principal
 * axes. */
double hl_light_average_size(const light_source *source, vec3 normal) {
  vec3 u = vec3_perpendicular(normal), v = vec3_cross(normal, u);
  vec3 su = mat3_apply(source->spread, u), sv = mat3_apply(source->spread, v);
  covariance c = turn_to_axes((covariance){vec3_dot(u, su), vec3_dot(u, sv), vec3_dot(v, sv)}, &u, &v);
  return source->shape.kind->deviations * (sqrt(c.uu) + sqrt(c.vv)) / 2;
}
