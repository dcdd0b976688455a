/* reference/lights.c - finds points on the lights, and the part of a light that reaches a sample.
 *
 * Surfaces are shaded as if all of a light came from its centre. The light's extent matters to shadows, to
 * light textures and to media that scatter unevenly. The transmittance, the texture's colour and the phase
 * function are therefore means over a fixed set of points on the light. The set is the same for every sample,
 * so that the picture has no noise. A spherical light counts as a disk of the same radius that faces the
 * sample. */
#include <string.h>

#include "core/memory.h"
#include "elementary/elementary.h"
#include "reference/reference.h"
#include "scene/light/light_kind.h"

/* ---- the light texture, eq. (2), and the emission image ----
 *
 * The light texture is an image on a screen, a parallelogram in space. A ray from a point of the light meets
 * the screen or passes beside the screen. Images are interpolated bilinearly between the middles of their
 * pixels. Between the middles of the outermost pixels and the image's borders, images are constant. */

/* Finds where a ray crosses the plane of the texture's screen: at s times screen_right and t times screen_up
 * from the screen's centre. On the screen, s and t are from -1 to 1. Returns false if the ray does not cross
 * the screen. */
static bool meet_screen(const hl_light_texture *texture, bool far, vec3 light, vec3 point, double *s,
                        double *t) {
  vec3 right = vec3_of(texture->screen_right), up = vec3_of(texture->screen_up),
       normal = vec3_cross(right, up);
  vec3 start = far ? point : light, way = far ? light : vec3_subtract(point, light);
  vec3 offset = vec3_subtract(start, vec3_of(texture->screen_center));
  double distance = -vec3_dot(normal, offset) / vec3_dot(normal, way);
  if (!isfinite(distance) || (!far && distance <= 0)) return false;
  vec3 on_screen = vec3_add(offset, vec3_scale(way, distance));
  *s = vec3_dot(vec3_cross(on_screen, up), normal) / vec3_dot(normal, normal);
  *t = vec3_dot(vec3_cross(right, on_screen), normal) / vec3_dot(normal, normal);
  return fabs(*s) <= 1 && fabs(*t) <= 1;
}

/* Finds the two pixels nearest to a position along one axis. Returns where the position lies between the two
 * pixels' middles: 0 at the first middle, 1 at the second. */
static double neighbours(double place, int count, size_t pixel[2]) {
  double at = fmin(fmax(place - 0.5, 0), count - 1);
  pixel[0] = (size_t)at;
  pixel[1] = pixel[0] + 1 < (size_t)count ? pixel[0] + 1 : pixel[0];
  return at - (double)pixel[0];
}

/* Finds the image's colour at a place that lies s times right and t times up from the image's middle. s and t
 * are from -1 to 1. */
static void look_up(const float *pixels, int width, int height, double s, double t, double color[3]) {
  size_t column[2], row[2];
  double x = neighbours((1 + s) / 2 * width, width, column),
         y = neighbours((1 - t) / 2 * height, height, row);
  color[0] = color[1] = color[2] = 0;
  for (int corner = 0; corner < 4; corner++) {
    int right = corner & 1, below = corner >> 1;
    double weight = (right ? x : 1 - x) * (below ? y : 1 - y);
    const float *pixel = pixels + 3 * (row[below] * (size_t)width + column[right]);
    for (int c = 0; c < 3; c++) color[c] += weight * (double)pixel[c];
  }
}

static void texture_color(const hl_light_texture *texture, bool far, vec3 light, vec3 point,
                          double color[3]) {
  double s, t;
  color[0] = color[1] = color[2] = 0;
  if (meet_screen(texture, far, light, point, &s, &t))
    look_up(texture->pixels, texture->width, texture->height, s, t, color);
}

static void emission_color(const hl_light_emission *emission, const emission_plane *plane, vec3 offset,
                           double color[3]) {
  double s, t;
  hl_emission_place(plane, offset, &s, &t);
  look_up(emission->pixels, emission->width, emission->height, s, t, color);
}

/* ---- points on the lights ---- */

/* The fractional part of 1/2 + i step. With the golden section as the step, the results for i from 0 to n - 1
 * lie evenly between 0 and 1, for any n. */
static double spread(size_t i, double step) {
  double x = 0.5 + (double)i * step;
  return x - floor(x);
}

/* Finds point i of n points that lie evenly in the disk of radius 1. The points form a sunflower with the
 * golden angle (Vogel, "A better way to construct the sunflower head", 1979). */
static void sunflower(size_t i, size_t n, double *u, double *v) {
  double angle = (double)i * HL_PI * (3 - sqrt(5)), radius = sqrt(((double)i + 0.5) / (double)n);
  *u = radius * hl_cos(angle);
  *v = radius * hl_sin(angle);
}

static vec3 point_of_disk(vec3 centre, vec3 normal, double radius, size_t i, size_t n) {
  vec3 u_axis = vec3_perpendicular(normal), v_axis = vec3_cross(normal, u_axis);
  double u, v;
  sunflower(i, n, &u, &v);
  return vec3_add(centre, vec3_add(vec3_scale(u_axis, radius * u), vec3_scale(v_axis, radius * v)));
}

/* Fills the points of a rectangle. The first edge is cut into n strips of equal width, each of which has one
 * point. Along the second edge, consecutive points are a golden section of the edge apart (modulo the edge's
 * length). */
static void fill_rect(const hl_light *light, vec3 centre, size_t n, vec3 *points) {
  vec3 edge1 = vec3_of(light->edge1), edge2 = vec3_of(light->edge2);
  for (size_t i = 0; i < n; i++) {
    double a = ((double)i + 0.5) / (double)n - 0.5, b = spread(i, (sqrt(5) - 1) / 2) - 0.5;
    points[i] = vec3_add(centre, vec3_add(vec3_scale(edge1, a), vec3_scale(edge2, b)));
  }
}

/* Returns whether a point in the polygon's plane is inside the polygon. A point is inside if the ray from the
 * point along u crosses an odd number of the polygon's edges. */
static bool inside_polygon(const hl_light *light, vec3 point, vec3 u_axis, vec3 v_axis) {
  bool inside = false;
  for (size_t i = 0; i < light->vertex_count; i++) {
    vec3 a = vec3_subtract(vec3_of(light->vertices[i]), point);
    vec3 b = vec3_subtract(vec3_of(light->vertices[(i + 1) % light->vertex_count]), point);
    double av = vec3_dot(a, v_axis), bv = vec3_dot(b, v_axis);
    if ((av > 0) == (bv > 0)) continue;
    double au = vec3_dot(a, u_axis), bu = vec3_dot(b, u_axis);
    if (au + (bu - au) * av / (av - bv) > 0) inside = !inside;
  }
  return inside;
}

/* Fills the points of a polygon. Roberts's sequence (powers of the plastic number) spreads points evenly over
 * a rectangle around the polygon. One side of the rectangle is parallel to the polygon's longest edge. Only
 * the points inside the polygon are used. */
static void fill_polygon(const hl_light *light, size_t n, vec3 *points) {
  const double plastic = 1.32471795724474602596;
  polygon_shape shape = hl_polygon_shape(light->vertices, light->vertex_count);
  vec3 u_axis = {0, 0, 0};
  for (size_t i = 0; i < light->vertex_count; i++) {
    vec3 edge = vec3_subtract(vec3_of(light->vertices[(i + 1) % light->vertex_count]),
                              vec3_of(light->vertices[i]));
    edge = vec3_subtract(edge, vec3_scale(shape.normal, vec3_dot(edge, shape.normal)));
    if (vec3_length(edge) > vec3_length(u_axis)) u_axis = edge;
  }
  u_axis = vec3_normalise(u_axis);
  vec3 v_axis = vec3_cross(shape.normal, u_axis);
  double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
  for (size_t i = 0; i < light->vertex_count; i++) {
    vec3 vertex = vec3_subtract(vec3_of(light->vertices[i]), shape.centre);
    const double at[2] = {vec3_dot(vertex, u_axis), vec3_dot(vertex, v_axis)};
    for (int axis = 0; axis < 2; axis++) {
      low[axis] = fmin(low[axis], at[axis]);
      high[axis] = fmax(high[axis], at[axis]);
    }
  }
  for (size_t i = 0, found = 0; found < n; i++) {
    double u = low[0] + (high[0] - low[0]) * spread(i, 1 / plastic);
    double v = low[1] + (high[1] - low[1]) * spread(i, 1 / (plastic * plastic));
    vec3 point = vec3_add(shape.centre, vec3_add(vec3_scale(u_axis, u), vec3_scale(v_axis, v)));
    if (inside_polygon(light, point, u_axis, v_axis)) points[found++] = point;
  }
}

static void fill_points(reference_light *light) {
  const hl_light *described = light->described;
  size_t n = light->point_count;
  if (n == 1) {
    light->points[0] = light->directional ? light->towards : light->centre;
    /* A directional light's points are directions: unit vectors to the points of a disk at the distance 1. */
  } else if (light->directional) {
    double radius = hl_tan(described->angular_diameter_deg * HL_PI / 360);
    for (size_t i = 0; i < n; i++)
      light->points[i] = vec3_normalise(point_of_disk(light->towards, light->towards, radius, i, n));
  } else if (described->type == HL_LIGHT_RECT) {
    fill_rect(described, light->centre, n, light->points);
  } else if (described->type == HL_LIGHT_POLYGON) {
    fill_polygon(described, n, light->points);
  } else if (described->type == HL_LIGHT_DISK) {
    vec3 normal = vec3_normalise(vec3_of(described->normal));
    for (size_t i = 0; i < n; i++)
      light->points[i] = point_of_disk(light->centre, normal, described->radius, i, n);
  }
}

static bool has_extent(const hl_light *light) {
  switch (light->type) {
    case HL_LIGHT_DIRECTIONAL: return light->angular_diameter_deg > 0;
    case HL_LIGHT_RECT: return vec3_length(vec3_of(light->edge1)) + vec3_length(vec3_of(light->edge2)) > 0;
    case HL_LIGHT_POLYGON: return true;
    case HL_LIGHT_POINT:
    case HL_LIGHT_DISK:
    case HL_LIGHT_SPOT:
    default: return light->radius > 0;
  }
}

/* The vector from the light's centre to a point of the light. A directional light's centre and points lie at
 * the distance 1 in their directions. */
static vec3 offset_of(const reference_light *light, vec3 light_point) {
  if (!light->directional) return vec3_subtract(light_point, light->centre);
  vec3 at_distance_1 = vec3_scale(light_point, 1 / vec3_dot(light_point, light->towards));
  return vec3_subtract(at_distance_1, light->towards);
}

enum { MEAN_POINTS = 1 << 14 };

/* Finds the emission image's mean colour over the light's points. A light that counts as a single point has
 * the mean colour. */
static hl_status find_mean(hl_context *context, reference_light *light, hl_error *error) {
  reference_light dense = *light;
  vec3 facing = light->directional ? vec3_scale(light->towards, -1) : (vec3){0, 0, 1};
  dense.point_count = MEAN_POINTS;
  dense.points = hl_allocate(context, MEAN_POINTS, sizeof *dense.points);
  if (dense.points == NULL)
    return hl_fail_memory(error, MEAN_POINTS * sizeof *dense.points, "points on a light");
  fill_points(&dense);
  if (light->described->type == HL_LIGHT_POINT || light->described->type == HL_LIGHT_SPOT)
    for (size_t i = 0; i < MEAN_POINTS; i++)
      dense.points[i] = point_of_disk(light->centre, facing, light->described->radius, i, MEAN_POINTS);
  const light_shape shape = hl_light_shape(light->described);
  emission_plane plane = shape.kind->plane(&shape, facing);
  for (size_t i = 0; i < MEAN_POINTS; i++) {
    double color[3];
    emission_color(light->emission, &plane, offset_of(light, dense.points[i]), color);
    for (int c = 0; c < 3; c++) light->mean[c] += color[c] / MEAN_POINTS;
  }
  hl_release(context, dense.points);
  return HL_OK;
}

/* Fills the points of a light over which the phase function is averaged. The points of a sphere depend on the
 * sample, and are computed later. */
static hl_status fill_extent(hl_context *context, reference_light *light, hl_error *error) {
  if (light->directional || !has_extent(light->described)) return HL_OK;
  reference_light dense = *light;
  dense.point_count = EXTENT_POINTS;
  dense.points = light->extent = hl_allocate(context, EXTENT_POINTS, sizeof *light->extent);
  if (dense.points == NULL)
    return hl_fail_memory(error, EXTENT_POINTS * sizeof *dense.points, "points on a light");
  fill_points(&dense);
  return HL_OK;
}

hl_status hl_reference_light_create(const reference *all, const hl_light *light, int point_count,
                                    reference_light *made, hl_error *error) {
  *made = (reference_light){.described = light, .directional = light->type == HL_LIGHT_DIRECTIONAL};
  for (int c = 0; c < 3; c++) made->color[c] = light->color[c] * light->intensity;
  made->least_distance = HL_LEAST_LIGHT_DISTANCE * hl_scene_frame_space(all->scene).unit;
  if (light->texture.pixels != NULL) made->texture = &light->texture;
  made->cap = made->directional ? hl_cos(light->angular_diameter_deg * HL_PI / 360) : 1;
  if (made->directional) made->towards = vec3_scale(vec3_normalise(vec3_of(light->direction)), -1);
  else made->centre = hl_light_shape(light).centre;
  if (light->emission.pixels != NULL) {
    made->emission = &light->emission;
    hl_status status = find_mean(all->context, made, error);
    if (status != HL_OK) return status;
  }
  hl_status extended = fill_extent(all->context, made, error);
  if (extended != HL_OK) return extended;
  hl_shadows shadows = light->shadows == HL_SHADOWS_DEFAULT ? all->scene->render.shadows : light->shadows;
  if (shadows == HL_SHADOWS_OFF) return HL_OK;
  made->point_count = shadows == HL_SHADOWS_SOFT && has_extent(light) ? (size_t)point_count : 1;
  made->points = hl_allocate(all->context, made->point_count, sizeof *made->points);
  if (made->points == NULL)
    return hl_fail_memory(error, made->point_count * sizeof *made->points, "points on a light");
  made->sphere = (light->type == HL_LIGHT_POINT || light->type == HL_LIGHT_SPOT) && made->point_count > 1;
  fill_points(made);
  return HL_OK;
}

/* ---- the phase function ---- */

/* The mean of the phase function p over a cap of directions. c: the cosine of the cap's half angle. cosine:
 * the cosine of the angle between the cap's middle and the direction from which light reaches the eye without
 * being turned. Derived: the mean is the sum over n of (2 n + 1) g^n k_n P_n(cosine). The factor k_n is the
 * mean of the Legendre polynomial P_n over the cap, (P_(n-1)(c) - P_(n+1)(c)) / ((2 n + 1) (1 - c)). By the
 * addition theorem, only the harmonics that are symmetric about the cap's middle remain. */
static double phase_of_cap(double g, double c, double cosine) {
  double before = 1, here = cosine, cap_before = 1, cap_here = c, power = 1, sum = 1;
  for (int n = 1; fabs(power) > 1e-9; n++) {
    double next = ((2 * n + 1) * cosine * here - n * before) / (n + 1),
           cap_next = ((2 * n + 1) * c * cap_here - n * cap_before) / (n + 1);
    power *= g;
    sum += power * (cap_before - cap_next) / (1 - c) * here;
    before = here, here = next;
    cap_before = cap_here, cap_here = cap_next;
  }
  return sum;
}

double hl_reference_light_phase(const reference_light *light, double g, vec3 to_eye, vec3 point) {
  if (g == 0) return 1;
  if (light->directional)
    return light->cap < 1 ? phase_of_cap(g, light->cap, -vec3_dot(to_eye, light->towards))
                          : hl_reference_phase(g, to_eye, light->towards);
  vec3 facing = vec3_normalise(vec3_subtract(light->centre, point));
  if (!(vec3_length(facing) > 0)) facing = (vec3){0, 0, 1};
  bool sphere = light->described->type == HL_LIGHT_POINT || light->described->type == HL_LIGHT_SPOT;
  double sum = 0;
  for (size_t i = 0; i < EXTENT_POINTS && light->extent != NULL; i++) {
    vec3 from = light->extent[i];
    if (sphere) from = point_of_disk(light->centre, facing, light->described->radius, i, EXTENT_POINTS);
    sum += hl_reference_phase(g, to_eye, vec3_normalise(vec3_subtract(from, point))) / EXTENT_POINTS;
  }
  return light->extent != NULL ? sum : hl_reference_phase(g, to_eye, facing);
}

/* The fraction of a spot light's brightness in a direction. The fraction is a smooth step of the cosine of
 * the angle to the light's axis. The fraction is 0 from half the opening angle on, and 1 up to half the
 * opening angle less the falloff angle. */
static double spot_brightness(const hl_light *light, vec3 towards) {
  double cosine = -vec3_dot(towards, vec3_normalise(vec3_of(light->direction)));
  double outer = hl_cos(light->opening_angle_deg * HL_PI / 360);
  double full = hl_cos((light->opening_angle_deg / 2 - light->falloff_angle_deg) * HL_PI / 180);
  if (cosine <= outer) return 0;
  if (cosine >= full) return 1;
  double x = (cosine - outer) / (full - outer);
  return x * x * (3 - 2 * x);
}

void hl_reference_light_arrive(const reference_light *light, vec3 point, arrival *arrived) {
  *arrived = (arrival){.towards = light->towards};
  double factor = 1;
  if (!light->directional) {
    vec3 offset = vec3_subtract(light->centre, point);
    arrived->towards = vec3_normalise(offset);
    if (light->described->falloff == HL_FALLOFF_INVERSE_SQUARE)
      factor = 1 / fmax(vec3_dot(offset, offset), light->least_distance * light->least_distance);
    if (light->described->type == HL_LIGHT_SPOT)
      factor *= spot_brightness(light->described, arrived->towards);
  }
  for (int c = 0; c < 3; c++) arrived->incoming[c] = light->color[c] * factor;
}

/* Finds the colour that the light's images give to the ray from a point of the light to `point`. The light's
 * images are the texture that the light projects and the emission image on its surface. Returns false if the
 * colour is black. light_point: the point of the light; for a directional light, a direction. plane: the
 * plane of the emission image; if null, each point of the light has the image's mean colour. */
static bool find_pattern(const reference_light *light, const emission_plane *plane, vec3 light_point,
                         vec3 point, double pattern[3]) {
  pattern[0] = pattern[1] = pattern[2] = 1;
  if (plane != NULL) emission_color(light->emission, plane, offset_of(light, light_point), pattern);
  else if (light->emission != NULL) memcpy(pattern, light->mean, 3 * sizeof *pattern);
  if (light->texture != NULL) texture_color(light->texture, light->directional, light_point, point, pattern);
  return pattern[0] > 0 || pattern[1] > 0 || pattern[2] > 0;
}

/* Finds the fraction of light, in each channel, that passes from a point of the light to the receiver
 * `at`. */
static void find_passing(const reference *all, const reference_light *light, vec3 light_point,
                         const reference_receiver *at, crossing *scratch, double passing[3]) {
  vec3 offset = vec3_subtract(light_point, at->point);
  reference_ray ray = {.origin = at->point, .direction = light_point, .farthest = INFINITY};
  if (!light->directional) {
    ray.farthest = vec3_length(offset);
    ray.direction = vec3_normalise(offset);
  }
  if (at->surface_of != NULL) hl_reference_outside(all, &ray, at, scratch, passing);
  else hl_reference_transmittance(all, &ray, scratch, passing);
}

void hl_reference_light_reach(const reference *all, const reference_light *light,
                              const reference_receiver *at, bool attenuated, reference_worker *worker,
                              double reach[3]) {
  double sum[3] = {0, 0, 0};
  const vec3 point = at->point;
  vec3 centre = light->directional ? light->towards : light->centre;
  vec3 facing = vec3_normalise(vec3_subtract(point, light->centre));
  if (!(vec3_length(facing) > 0)) facing = (vec3){0, 0, 1};
  bool casts = light->points != NULL;
  size_t count = casts ? light->point_count : 1;
  bool extended = light->emission != NULL && count > 1;
  emission_plane plane = {.middle = {0, 0, 0}};
  if (extended) {
    const light_shape shape = hl_light_shape(light->described);
    plane = shape.kind->plane(&shape, light->directional ? vec3_scale(light->towards, -1) : facing);
  }
  for (size_t i = 0; i < count && !hl_pool_stops(all->pool, worker->number); i++) {
    vec3 light_point = casts ? light->points[i] : centre;
    if (light->sphere) /* a sphere counts as the disk that faces `point` */
      light_point = point_of_disk(light->centre, facing, light->described->radius, i, count);
    double pattern[3], passing[3] = {1, 1, 1};
    if (!find_pattern(light, extended ? &plane : NULL, light_point, point, pattern)) continue;
    if (casts && attenuated) find_passing(all, light, light_point, at, worker->shadow, passing);
    for (int c = 0; c < 3; c++) sum[c] += pattern[c] * passing[c];
  }
  for (int c = 0; c < 3; c++) reach[c] = sum[c] / (double)count;
}
