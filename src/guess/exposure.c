/* guess/exposure.c - estimates the brightness of a picture by marching a few thousand rays.
 *
 * Steps are as long as the shortest voxel edge. A sample is the B-spline at the nearest voxel's centre, lit
 * as by the renderer (docs/scene.md, "Brightness and colour") except for shadows, for which the caller gives
 * one fraction.
 */
#include "guess/exposure.h"

#include "core/context.h"
#include "core/memory.h"
#include "guess/sample.h"
#include "scene/placement.h"
#include "scene/scene.h"

#define TARGET    0.871 /* linear light of 240 of 255, IEC 61966-2-1 */
#define BRIGHTEST 0.99  /* fraction of the pixels that are darker */
#define OPAQUE    0.98

enum { SIDE = 64, TABLE = 1024, MOST_LIGHTS = 4 };

typedef struct exposure {
  const hl_scene_description *scene;
  const hl_scene_volume *volume;
  affine3 world_to_index;
  vec3 right, up,
      forward; /* the camera's; lengths: half the picture's width and height at distance 1, and 1 */
  vec3 towards[MOST_LIGHTS]; /* unit vectors */
  double intensity[MOST_LIGHTS];
  double step;  /* world units */
  double empty; /* a value of the invisible surroundings */
  double flat;  /* gradients up to this, in values per world unit, belong to no surface */
  double opacity[TABLE], color[TABLE][3]; /* over the volume's range */
} exposure;

/* The uniform cubic B-spline at a voxel's centre: weights 1/6, 2/3, 1/6, and -1/2, 0, 1/2 for its slope
 * (derived: the spline and its derivative at whole numbers). Beyond the grid the outermost voxels are
 * repeated. *gradient: per voxel. NaN where a voxel is not finite. */
static double smooth_value(const hl_volume *volume, const long at[3], double gradient[3]) {
  static const double weight[3] = {1.0 / 6, 2.0 / 3, 1.0 / 6}, slope[3] = {-0.5, 0, 0.5};
  double value = 0;
  gradient[0] = gradient[1] = gradient[2] = 0;
  for (int n = 0; n < 27; n++) {
    const int tap[3] = {n % 3, n / 3 % 3, n / 9};
    size_t place[3];
    for (int a = 0; a < 3; a++) {
      long p = at[a] + tap[a] - 1, last = (long)volume->dimension[a] - 1;
      place[a] = (size_t)(p < 0 ? 0 : p > last ? last : p);
    }
    double v = hl_volume_value(volume, place[0], place[1], place[2]);
    const double wx = weight[tap[0]], wy = weight[tap[1]], wz = weight[tap[2]];
    value += v * wx * wy * wz;
    gradient[0] += v * slope[tap[0]] * wy * wz;
    gradient[1] += v * wx * slope[tap[1]] * wz;
    gradient[2] += v * wx * wy * slope[tap[2]];
  }
  return value;
}

static int entry_of(const exposure *e, double value) {
  const hl_volume *volume = e->volume->volume;
  double t = (value - volume->minimum) / (volume->maximum - volume->minimum) * (TABLE - 1) + 0.5;
  return t > 0 ? t < TABLE ? (int)t : TABLE - 1 : 0;
}

/* The light that a sample sends to the eye, eqs. (3) and (4). */
static void shade(const exposure *e, int entry, double value, const double slope[3], vec3 to_eye,
                  double sent[3]) {
  const hl_material *material = &e->volume->material;
  vec3 gradient = mat3_apply(mat3_transpose(e->world_to_index.linear), vec3_of(slope));
  bool surface = e->volume->shading == HL_SHADING_PHONG && vec3_length(gradient) > e->flat;
  vec3 normal = vec3_scale(vec3_normalise(gradient), value > e->empty ? -1 : 1);
  double gloss = 0, matt[3];
  for (int c = 0; c < 3; c++) matt[c] = material->emission + material->ambient * e->scene->ambient[c];
  for (size_t l = 0; l < e->scene->light_count; l++) {
    const hl_light *light = &e->scene->lights[l];
    double cosine = vec3_dot(normal, e->towards[l]);
    vec3 reflected = vec3_subtract(vec3_scale(normal, 2 * cosine), e->towards[l]);
    for (int c = 0; c < 3; c++)
      matt[c] += e->intensity[l] * light->color[c] * (surface ? material->diffuse * fmax(cosine, 0) : 1);
    if (surface && cosine > 0)
      gloss += e->intensity[l] * material->specular *
               pow(fmax(vec3_dot(to_eye, reflected), 0), material->shininess);
  }
  for (int c = 0; c < 3; c++) sent[c] = e->color[entry][c] * matt[c] + gloss;
}

/* The parameters, from the origin on, where a ray enters and leaves the volume's box; false if it misses it.
 */
static bool cross_grid(const hl_scene_volume *volume, vec3 from, vec3 along, double part[2]) {
  double low[3], high[3];
  const double origin[3] = {from.x, from.y, from.z}, direction[3] = {along.x, along.y, along.z};
  hl_scene_volume_box(volume, low, high);
  part[0] = 0, part[1] = INFINITY;
  for (int a = 0; a < 3; a++) {
    double s = (low[a] - origin[a]) / direction[a], t = (high[a] - origin[a]) / direction[a];
    /* where a ray lies in a face's plane, s or t is NaN, which fmax and fmin ignore */
    part[0] = fmax(part[0], fmin(s, t));
    part[1] = fmin(part[1], fmax(s, t));
  }
  return part[1] > part[0] && isfinite(part[1]);
}

/* The brightest channel of a pixel; -1 where the pixel is mostly background. */
static double brightness_along(const exposure *e, vec3 origin, vec3 direction) {
  const hl_volume *volume = e->volume->volume;
  vec3 from = affine3_apply(e->world_to_index, origin),
       along = mat3_apply(e->world_to_index.linear, direction);
  vec3 to_eye = vec3_scale(direction, -1);
  double part[2], alpha = 0, seen[3] = {0, 0, 0};
  if (!cross_grid(e->volume, from, along, part)) return -1;
  for (double t = part[0] + 0.5 * e->step; t < part[1] && alpha < OPAQUE; t += e->step) {
    vec3 p = vec3_add(from, vec3_scale(along, t));
    const long at[3] = {lround(p.x), lround(p.y), lround(p.z)};
    double near = hl_volume_value(volume, (size_t)at[0], (size_t)at[1], (size_t)at[2]), slope[3], sent[3];
    if (!isfinite(near) || !(e->opacity[entry_of(e, near)] > 0)) continue;
    double value = smooth_value(volume, at, slope);
    if (!isfinite(value)) continue;
    int entry = entry_of(e, value);
    double share = (1 - alpha) * e->opacity[entry];
    shade(e, entry, value, slope, to_eye, sent);
    for (int c = 0; c < 3; c++) seen[c] += share * sent[c];
    alpha += share;
  }
  return alpha > 0.5 ? fmax(seen[0], fmax(seen[1], seen[2])) : -1;
}

static bool begin(const hl_scene_description *scene, double empty, double left, exposure *e) {
  const hl_camera *camera = &scene->camera;
  const hl_scene_volume *volume = &scene->volumes[0];
  const hl_transfer_function *function = &volume->transfer_function;
  *e = (exposure){.scene = scene, .volume = volume, .empty = empty};
  double range = volume->volume->maximum - volume->volume->minimum;
  affine3 index_to_world = hl_scene_volume_index_to_world(volume);
  if (!(range > 0) || scene->light_count > MOST_LIGHTS || camera->type != HL_CAMERA_PERSPECTIVE ||
      !affine3_invert(index_to_world, &e->world_to_index) ||
      !hl_camera_basis(camera, &e->right, &e->up, &e->forward))
    return false;
  double half = tan(camera->fovy_deg * HL_PI / 360);
  e->right = vec3_scale(e->right, half * scene->width / scene->height);
  e->up = vec3_scale(e->up, half);
  for (size_t l = 0; l < scene->light_count; l++) {
    e->towards[l] = vec3_scale(vec3_normalise(hl_light_way(camera, &scene->lights[l])), -1);
    e->intensity[l] = scene->lights[l].intensity * (scene->lights[l].shadows == HL_SHADOWS_OFF ? 1 : left);
  }
  e->step = mat3_shortest_column(index_to_world.linear);
  e->flat = 1e-3 * range / e->step;
  for (int n = 0; n < TABLE; n++) {
    double value = volume->volume->minimum + range * n / (TABLE - 1);
    e->opacity[n] = 1 -
                    pow(1 - hl_transfer_function_opacity(function, value), e->step / function->unit_distance);
    hl_transfer_function_color(function, value, e->color[n]);
  }
  return true;
}

static size_t look(const exposure *e, float *brightness) {
  size_t count = 0;
  for (int y = 0; y < SIDE; y++)
    for (int x = 0; x < SIDE; x++) {
      vec3 aside = vec3_add(vec3_scale(e->right, (2 * x + 1.0) / SIDE - 1),
                            vec3_scale(e->up, 1 - (2 * y + 1.0) / SIDE));
      double b = brightness_along(e, vec3_of(e->scene->camera.position),
                                  vec3_normalise(vec3_add(e->forward, aside)));
      if (b >= 0) brightness[count++] = (float)b;
    }
  return count;
}

hl_status hl_scene_exposure(const hl_scene_description *scene, double empty, double left, double *factor,
                            hl_error *error) {
  hl_context *context = scene->volumes[0].volume->context;
  exposure *e = hl_allocate(context, 1, sizeof *e);
  float *brightness = hl_allocate(context, SIDE * SIDE, sizeof *brightness);
  hl_status status = e != NULL && brightness != NULL ? HL_OK
                                                     : hl_fail_memory(error, sizeof *e, "an exposure");
  *factor = 1;
  size_t count = status == HL_OK && begin(scene, empty, left, e) ? look(e, brightness) : 0;
  if (count > 0 && !hl_sort(context, brightness, count))
    status = hl_fail_memory(error, count * sizeof *brightness, "an exposure");
  else if (count > 0)
    *factor =
        round(100 * fmin(fmax(TARGET / fmax(hl_quantile(brightness, count, BRIGHTEST), 1e-9), 0.5), 2)) / 100;
  hl_release(context, brightness);
  hl_release(context, e);
  return status;
}
