/* reference/lights.c - points on the lights, and how much of their light reaches a sample.
 *
 * A light is shaded as if all its light came from its centre; its extent matters to shadows alone: the
 * transmittance is the mean over a fixed set of points on the light, the same for every sample, so that
 * the picture has no noise.
 */
#include "core/memory.h"
#include "reference/reference.h"

/* Optical depth in every channel beyond which nothing is seen of a light: exp(-30) is 1e-13. */
static const double DARK_DEPTH = 30;

/* Point i of n spread evenly over the disk of radius 1: the sunflower, by the golden angle
 * (Vogel, "A better way to construct the sunflower head", 1979). */
static void sunflower(size_t i, size_t n, double *u, double *v) {
  double angle = (double)i * HL_PI * (3 - sqrt(5)), radius = sqrt(((double)i + 0.5) / (double)n);
  *u = radius * cos(angle);
  *v = radius * sin(angle);
}

static void fill_disk(vec3 centre, vec3 normal, double radius, size_t n, vec3 *points) {
  vec3 u_axis = vec3_perpendicular(normal), v_axis = vec3_cross(normal, u_axis);
  for (size_t i = 0; i < n; i++) {
    double u, v;
    sunflower(i, n, &u, &v);
    points[i] = vec3_add(centre, vec3_add(vec3_scale(u_axis, radius * u), vec3_scale(v_axis, radius * v)));
  }
}

/* Centre of the world bounds of all boxes. */
static vec3 scene_centre(const reference *all) {
  vec3 low = {INFINITY, INFINITY, INFINITY}, high = {-INFINITY, -INFINITY, -INFINITY};
  for (size_t v = 0; v < all->scene->volume_count; v++) {
    const reference_volume *volume = &all->volumes[v];
    affine3 to_world = hl_scene_volume_index_to_world(volume->described);
    for (int corner = 0; corner < 8; corner++) {
      vec3 p = affine3_apply(to_world, (vec3){corner & 1 ? volume->high[0] : volume->low[0],
                                              corner & 2 ? volume->high[1] : volume->low[1],
                                              corner & 4 ? volume->high[2] : volume->low[2]});
      low = (vec3){fmin(low.x, p.x), fmin(low.y, p.y), fmin(low.z, p.z)};
      high = (vec3){fmax(high.x, p.x), fmax(high.y, p.y), fmax(high.z, p.z)};
    }
  }
  return vec3_scale(vec3_add(low, high), 0.5);
}

/* Directional: a flat disk at unit distance, each of its points a direction. Point: a sphere is seen as a
 * disk, here as one disk for the whole scene, facing its centre. */
static void fill_points(const reference *all, reference_light *light) {
  size_t n = light->point_count;
  if (n == 1) {
    light->points[0] = light->directional ? light->towards : light->centre;
  } else if (light->directional) {
    double radius = tan(light->described->angular_diameter_deg * HL_PI / 360);
    fill_disk(light->towards, light->towards, radius, n, light->points);
    for (size_t i = 0; i < n; i++) light->points[i] = vec3_normalise(light->points[i]);
  } else {
    vec3 axis = vec3_normalise(vec3_subtract(scene_centre(all), light->centre));
    if (!(vec3_length(axis) > 0)) axis = (vec3){0, 0, 1};
    fill_disk(light->centre, axis, light->described->radius, n, light->points);
  }
}

hl_status hl_reference_light_create(const reference *all, const hl_light *light, int point_count,
                                    reference_light *made, hl_error *error) {
  if (light->type != HL_LIGHT_DIRECTIONAL && light->type != HL_LIGHT_POINT)
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "the reference renders directional and point lights only: use one of these");
  *made = (reference_light){.described = light, .directional = light->type == HL_LIGHT_DIRECTIONAL};
  for (int c = 0; c < 3; c++) made->color[c] = light->color[c] * light->intensity;
  if (made->directional)
    made->towards = vec3_scale(vec3_normalise(vec3_of(light->direction)), -1);
  else
    made->centre = vec3_of(light->position);
  hl_shadows shadows = light->shadows == HL_SHADOWS_DEFAULT ? all->scene->render.shadows : light->shadows;
  if (shadows == HL_SHADOWS_OFF) return HL_OK;
  double extent = made->directional ? light->angular_diameter_deg : light->radius;
  made->point_count = shadows == HL_SHADOWS_SOFT && extent > 0 ? (size_t)point_count : 1;
  made->points = hl_allocate(all->context, made->point_count, sizeof *made->points);
  if (made->points == NULL)
    return hl_fail_memory(error, made->point_count * sizeof *made->points, "points on a light");
  fill_points(all, made);
  return HL_OK;
}

void hl_reference_light_arrive(const reference_light *light, vec3 point, arrival *arrived) {
  *arrived = (arrival){
      .towards = light->towards, .transmittance = {1, 1, 1}, .transmittance_known = light->points == NULL};
  double factor = 1;
  if (!light->directional) {
    vec3 offset = vec3_subtract(light->centre, point);
    arrived->towards = vec3_normalise(offset);
    if (light->described->falloff == HL_FALLOFF_INVERSE_SQUARE)
      factor = 1 / fmax(vec3_dot(offset, offset), 1e-30);
  }
  for (int c = 0; c < 3; c++) arrived->incoming[c] = light->color[c] * factor;
}

/* Adds exp(-optical depth) along one ray to sum. */
static void add_transmittance(const reference *all, vec3 point, vec3 direction, double distance,
                              crossing *scratch, double sum[3]) {
  double depth[3] = {0, 0, 0};
  march walk;
  hl_reference_march_begin(all, REFERENCE_CASTS_SHADOW, point, direction, 0, distance, scratch, &walk);
  while (hl_reference_march_next(&walk)) {
    for (size_t v = 0; v < walk.count; v++) {
      const crossing *part = &walk.crossings[v];
      if (!part->occupied) continue;
      double value = hl_reference_value(part->volume, part->here);
      double extinction = hl_reference_extinction(part->volume, value);
      for (int c = 0; c < 3; c++)
        depth[c] += extinction * walk.length * part->volume->described->attenuation_color[c];
    }
    if (fmin(depth[0], fmin(depth[1], depth[2])) > DARK_DEPTH) break;
  }
  for (int c = 0; c < 3; c++) sum[c] += exp(-depth[c]);
}

void hl_reference_light_transmittance(const reference *all, const reference_light *light, vec3 point,
                                      crossing *scratch, double transmittance[3]) {
  double sum[3] = {0, 0, 0};
  for (size_t i = 0; i < light->point_count; i++) {
    vec3 direction = light->points[i];
    double distance = INFINITY;
    if (!light->directional) {
      vec3 offset = vec3_subtract(direction, point);
      distance = vec3_length(offset);
      direction = vec3_normalise(offset);
    }
    add_transmittance(all, point, direction, distance, scratch, sum);
  }
  for (int c = 0; c < 3; c++) transmittance[c] = sum[c] / (double)light->point_count;
}
