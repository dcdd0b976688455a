/* guess/exposure.c - estimates the brightness of a picture and the thickness of the surfaces in it by
 * marching a few thousand rays.
 *
 * Steps are as long as the shortest voxel edge. A sample is the B-spline at the nearest voxel's centre, lit
 * as by the renderer (docs/scene.md, "Brightness and colour") except for shadows, for which the caller gives
 * one fraction.
 */
#include "guess/exposure.h"

#include <stdlib.h>

#include "core/context.h"
#include "core/memory.h"
#include "guess/sample.h"
#include "scene/cut.h"
#include "scene/placement.h"
#include "scene/scene.h"
#include "volume/colors.h"

#define TARGET    0.871 /* linear light of 240 of 255, IEC 61966-2-1 */
#define BRIGHTEST 0.99  /* fraction of the pixels that are darker */
#define OPAQUE    0.98
#define FAINT     0.02 /* least opacity of a step at which a ray meets a surface */
#define THINNEST  0.15 /* fraction of the surfaces that are thinner than hl_exposure.thickness */

enum { SIDE = 64, TABLE = 1024, MOST_LIGHTS = 4 };

typedef struct exposure {
  const hl_scene_description *scene;
  const hl_scene_volume *volume;
  affine3 world_to_index;
  vec3 right, up,
      forward; /* the camera's; lengths: half the picture's width and height at distance 1, and 1 */
  vec3 towards[MOST_LIGHTS]; /* unit vectors */
  double intensity[MOST_LIGHTS];
  double left;  /* fraction of the sky, and of lights with shadows, that reaches bright surfaces */
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

/* The light of a sky in a gradient that nothing hides, at a surface or in a medium (normal: null). Derived:
 * at the sine s of the elevation the radiance is h + a |s| + b s, with a = (zenith + ground) / 2 - h and b =
 * (zenith - ground) / 2. Its mean is h + a / 2; weighted by a normal's cosine, s has the mean 2/3 c, c being
 * the normal's own sine, and |s| 1/2 + 5/32 P2(c), to 1 %. */
static void sky_light(const hl_sky *sky, const vec3 *normal, double light[3]) {
  double c = normal != NULL ? vec3_dot(*normal, vec3_normalise(vec3_of(sky->up))) : 0;
  double even = normal != NULL ? 0.5 + 5.0 / 64 * (3 * c * c - 1) : 0.5;
  for (int n = 0; n < 3; n++) {
    double a = 0.5 * (sky->zenith[n] + sky->ground[n]) - sky->horizon[n],
           b = 0.5 * (sky->zenith[n] - sky->ground[n]);
    light[n] = sky->type == HL_SKY_GRADIENT ? sky->strength * (sky->horizon[n] + a * even + b * 2 / 3 * c)
                                            : 0;
  }
}

/* The light that a sample sends to the eye, eqs. (3) and (4). own: the voxel's colour. */
static void shade(const exposure *e, int entry, double value, vec3 gradient, vec3 to_eye, const double own[3],
                  double sent[3]) {
  const hl_material *material = &e->volume->material;
  bool surface = e->volume->shading == HL_SHADING_PHONG && vec3_length(gradient) > e->flat;
  vec3 normal = vec3_scale(vec3_normalise(gradient), value > e->empty ? -1 : 1);
  double gloss = 0, matt[3], sky[3];
  sky_light(&e->scene->sky, surface ? &normal : NULL, sky);
  for (int c = 0; c < 3; c++)
    matt[c] = material->emission + material->ambient * e->scene->ambient[c] +
              e->left * sky[c] * (surface ? material->diffuse : 1);
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
  for (int c = 0; c < 3; c++) sent[c] = e->color[entry][c] * own[c] * matt[c] + gloss;
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

/* How thick a surface is, in steps: the depth at which the optical depth becomes 1, from the place on where
 * matter begins to be visible, if values rise there as steeply as at a sample. Infinite where no depth hides
 * anything. steepness: values per step. */
static double thickness_at(const exposure *e, int entry, double value, double steepness) {
  const hl_volume *volume = e->volume->volume;
  double per_entry = (volume->maximum - volume->minimum) / (TABLE - 1), optical_depth = 0;
  int away = value > e->empty ? 1 : -1, first = entry;
  while (first - away >= 0 && first - away < TABLE && e->opacity[first - away] > 0) first -= away;
  for (int n = first; n >= 0 && n < TABLE; n += away) {
    optical_depth -= log1p(-fmin(e->opacity[n], 0.9999)) * per_entry / steepness;
    if (optical_depth >= 1) return (abs(n - first) + 1) * per_entry / steepness;
  }
  return INFINITY;
}

typedef struct pixel {
  double brightness; /* of the brightest channel; -1 where the pixel is mostly background */
  double thickness;  /* of the first surface that the ray meets, in steps; infinite where it meets none */
} pixel;

static pixel look_along(const exposure *e, vec3 origin, vec3 direction) {
  const hl_volume *volume = e->volume->volume;
  vec3 from = affine3_apply(e->world_to_index, origin),
       along = mat3_apply(e->world_to_index.linear, direction);
  vec3 to_eye = vec3_scale(direction, -1);
  double part[2], alpha = 0, seen[3] = {0, 0, 0};
  pixel p = {-1, INFINITY};
  if (!cross_grid(e->volume, from, along, part)) return p;
  for (double t = part[0] + 0.5 * e->step; t < part[1] && alpha < OPAQUE; t += e->step) {
    vec3 place = vec3_add(from, vec3_scale(along, t));
    const long at[3] = {lround(place.x), lround(place.y), lround(place.z)};
    double near = hl_volume_value(volume, (size_t)at[0], (size_t)at[1], (size_t)at[2]), slope[3], own[3],
           sent[3];
    if (!hl_scene_volume_left(e->volume, place)) continue;
    if (!isfinite(near) || !(e->opacity[entry_of(e, near)] > 0)) continue;
    double value = smooth_value(volume, at, slope);
    if (!isfinite(value)) continue;
    int entry = entry_of(e, value);
    double share = (1 - alpha) * e->opacity[entry];
    vec3 gradient = mat3_apply(mat3_transpose(e->world_to_index.linear), vec3_of(slope));
    if (alpha < FAINT && e->opacity[entry] > FAINT && vec3_length(gradient) > e->flat)
      p.thickness = thickness_at(e, entry, value, vec3_length(gradient) * e->step);
    hl_volume_color(volume, (size_t)at[0], (size_t)at[1], (size_t)at[2], own);
    shade(e, entry, value, gradient, to_eye, own, sent);
    for (int c = 0; c < 3; c++) seen[c] += share * sent[c];
    alpha += share;
  }
  if (alpha > 0.5) p.brightness = fmax(seen[0], fmax(seen[1], seen[2]));
  return p;
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
  e->left = left;
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

/* The brightness of all pixels that show anything, and the thickness of all surfaces that they show. */
typedef struct pixels {
  float brightness[SIDE * SIDE], thickness[SIDE * SIDE];
  size_t bright_count, surface_count;
} pixels;

static void look(const exposure *e, pixels *seen) {
  for (int y = 0; y < SIDE; y++)
    for (int x = 0; x < SIDE; x++) {
      vec3 aside = vec3_add(vec3_scale(e->right, (2 * x + 1.0) / SIDE - 1),
                            vec3_scale(e->up, 1 - (2 * y + 1.0) / SIDE));
      pixel p = look_along(e, vec3_of(e->scene->camera.position),
                           vec3_normalise(vec3_add(e->forward, aside)));
      if (p.brightness >= 0) seen->brightness[seen->bright_count++] = (float)p.brightness;
      if (p.brightness >= 0 && isfinite(p.thickness))
        seen->thickness[seen->surface_count++] = (float)p.thickness;
    }
}

static hl_status judge(hl_context *context, pixels *seen, hl_exposure *exposure, hl_error *error) {
  if (!hl_sort(context, seen->brightness, seen->bright_count) ||
      !hl_sort(context, seen->thickness, seen->surface_count))
    return hl_fail_memory(error, sizeof seen->brightness, "an exposure");
  if (seen->bright_count > 0) {
    double bright = fmax(hl_quantile(seen->brightness, seen->bright_count, BRIGHTEST), 1e-9);
    exposure->factor = round(100 * fmin(fmax(TARGET / bright, 0.5), 2)) / 100;
  }
  if (seen->surface_count > 0)
    exposure->thickness = hl_quantile(seen->thickness, seen->surface_count, THINNEST);
  return HL_OK;
}

hl_status hl_scene_exposure(const hl_scene_description *scene, double empty, double left, hl_exposure *result,
                            hl_error *error) {
  hl_context *context = scene->volumes[0].volume->context;
  exposure *e = hl_allocate(context, 1, sizeof *e);
  pixels *seen = hl_allocate(context, 1, sizeof *seen);
  hl_status status = HL_OK;
  *result = (hl_exposure){1, INFINITY};
  if (e == NULL || seen == NULL) status = hl_fail_memory(error, sizeof *seen, "an exposure");
  else if (begin(scene, empty, left, e)) {
    seen->bright_count = seen->surface_count = 0;
    look(e, seen);
    status = judge(context, seen, result, error);
  }
  hl_release(context, seen);
  hl_release(context, e);
  return status;
}
