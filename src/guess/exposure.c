/* guess/exposure.c - estimates the brightness of a picture and the thickness of the surfaces in it by
 * marching a few thousand rays.
 *
 * Steps are as long as the shortest voxel edge. A sample is the B-spline at the nearest voxel's centre. A
 * sample is lit as by the renderer (docs/scene.md, "Brightness and colour"), but shadows are not computed:
 * the caller gives one fraction of light that stands for all shadows. */
#include "guess/exposure.h"

#include <stdlib.h>
#include <string.h>

#include "core/context.h"
#include "core/memory.h"
#include "elementary/elementary.h"
#include "guess/cut_face.h"
#include "guess/glow.h"
#include "guess/sample.h"
#include "scene/geometry/cut.h"
#include "scene/geometry/placement.h"
#include "scene/scene.h"
#include "volume/colors.h"

#define TARGET 0.871 /* linear light of the code 240 of 255, IEC 61966-2-1 */
/* The exposure brings the brightness of one pixel to TARGET. BRIGHTEST is the fraction of the pixels with
 * matter that are darker than the pixel at TARGET. */
#define BRIGHTEST 0.99
/* The least factors of an exposure. A cloud that glows inside may be four times as bright as a white surface.
 */
#define LEAST         0.5
#define LEAST_OF_GLOW 0.15
#define OPAQUE        0.98
#define FAINT         0.02 /* least opacity of a step at which a ray meets a surface */
#define THINNEST      0.15 /* fraction of the surfaces that are thinner than hl_exposure.thickness */

enum { SIDE = 64, TABLE = 1024, MOST_LIGHTS = 4 };

typedef struct exposure {
  const hl_scene_description *scene;
  const hl_scene_volume *volume;
  cut_shape *cuts;        /* owned; [volume->cut_count] */
  double low[3], high[3]; /* the volume's box in index space */
  affine3 world_to_index;
  vec3 right, up, forward; /* the camera's axes; `right` and `up` are as long as half the picture's width and
                            * height at distance 1, `forward` is a unit vector */
  vec3 towards[MOST_LIGHTS]; /* unit vectors to the lights */
  double left;               /* the light of the sky, and of lights with shadows, that reaches bright media in
                              * spite of shadows, as a fraction */
  double step;               /* world units */
  double empty;              /* a value of the invisible surroundings */
  hl_glow glow; /* the light in a medium that scatters light again and again; empty in other media */
  double flat;  /* a sample whose gradient is at most this long is no surface; values per world unit */
  double opacity[TABLE], color[TABLE][3]; /* entries over the volume's range */
} exposure;

/* The value at a voxel's centre of the uniform cubic B-spline over the voxels. Derived: at whole numbers the
 * spline's weights are 1/6, 2/3, 1/6, and the weights of its derivative are -1/2, 0, 1/2. Beyond the grid the
 * outermost voxels are repeated. *gradient: per voxel. NaN where a voxel is not finite. */
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
    double v = hl_volume_value_within(volume, place[0], place[1], place[2]);
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

/* The light that a gradient sky sends, if nothing hides it, to a surface or to a medium (normal null).
 * Derived: at the sine s of the elevation the radiance is h + a |s| + b s, with a = (zenith + ground) / 2 - h
 * and b = (zenith - ground) / 2. Its mean is h + a / 2. Weighted by the cosine of a normal with the sine c, s
 * has the mean 2/3 c, and |s| has the mean 1/2 + 5/32 P2(c), to 1 %. */
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

/* The light of a sample, which is lit as a surface or as a medium. The normal of a surface is a unit vector
 * of the world. */
typedef struct sample_light {
  bool surface;
  vec3 normal;
  double left[MOST_LIGHTS], sky; /* the fraction of each light, and of the sky, that reaches the sample */
  double glow;                   /* the light of all lights and of the sky in a medium that scatters light
                                  * again and again; it takes the place of the fractions `left` and `sky` */
} sample_light;

static sample_light light_by_gradient(const exposure *e, double value, vec3 gradient) {
  sample_light lit = {.surface = e->volume->shading == HL_SHADING_PHONG && vec3_length(gradient) > e->flat,
                      .normal = vec3_scale(vec3_normalise(gradient), value > e->empty ? -1 : 1),
                      .sky = 1};
  if (!lit.surface) lit.sky = e->left; /* surfaces are lit by the light at their outside */
  for (size_t l = 0; l < e->scene->light_count; l++)
    lit.left[l] = lit.surface || e->scene->lights[l].shadows == HL_SHADOWS_OFF ? 1 : e->left;
  return lit;
}

/* The light that a sample sends to the eye, eqs. (3) and (4). own: the colour of the voxel itself. */
static void shade(const exposure *e, const double color[3], const sample_light *lit, vec3 to_eye,
                  const double own[3], double sent[3]) {
  const hl_material *material = &e->volume->material;
  double gloss = 0, matt[3], sky[3];
  if (!lit->surface && e->glow.light != NULL) {
    for (int c = 0; c < 3; c++)
      sent[c] = color[c] * own[c] *
                (material->emission + material->ambient * e->scene->ambient[c] +
                 e->volume->albedo[c] * lit->glow);
    return;
  }
  sky_light(&e->scene->sky, lit->surface ? &lit->normal : NULL, sky);
  for (int c = 0; c < 3; c++)
    matt[c] = material->emission + material->ambient * e->scene->ambient[c] +
              lit->sky * sky[c] * (lit->surface ? material->diffuse : 1);
  for (size_t l = 0; l < e->scene->light_count; l++) {
    const hl_light *light = &e->scene->lights[l];
    double cosine = vec3_dot(lit->normal, e->towards[l]);
    double intensity = light->intensity * lit->left[l];
    vec3 reflected = vec3_subtract(vec3_scale(lit->normal, 2 * cosine), e->towards[l]);
    for (int c = 0; c < 3; c++)
      matt[c] += intensity * light->color[c] * (lit->surface ? material->diffuse * fmax(cosine, 0) : 1);
    if (lit->surface && cosine > 0)
      gloss += intensity * material->specular *
               hl_pow(fmax(vec3_dot(to_eye, reflected), 0), material->shininess);
  }
  for (int c = 0; c < 3; c++) sent[c] = color[c] * own[c] * matt[c] + gloss;
}

/* Finds the distances along a ray, in lengths of `along` and from 0 on, at which the ray enters and leaves
 * the volume's box. Returns false if the ray misses the box. */
static bool cross_box(const exposure *e, vec3 from, vec3 along, double part[2]) {
  const double origin[3] = {from.x, from.y, from.z}, direction[3] = {along.x, along.y, along.z};
  part[0] = 0, part[1] = INFINITY;
  for (int a = 0; a < 3; a++) {
    double s = (e->low[a] - origin[a]) / direction[a], t = (e->high[a] - origin[a]) / direction[a];
    /* where a ray lies in a face's plane, s or t is NaN, which fmax and fmin ignore */
    part[0] = fmax(part[0], fmin(s, t));
    part[1] = fmin(part[1], fmax(s, t));
  }
  return part[1] > part[0] && isfinite(part[1]);
}

/* The thickness of a surface in steps: the depth, below the place where matter begins to be visible, at which
 * the optical depth becomes 1. The estimate assumes that values go on rising as steeply as at a sample. The
 * thickness is infinite if matter of any depth stays transparent. steepness: values per step. */
static double thickness_at(const exposure *e, int entry, double value, double steepness) {
  const hl_volume *volume = e->volume->volume;
  double per_entry = (volume->maximum - volume->minimum) / (TABLE - 1), optical_depth = 0;
  int away = value > e->empty ? 1 : -1, first = entry;
  while (first - away >= 0 && first - away < TABLE && e->opacity[first - away] > 0) first -= away;
  for (int n = first; n >= 0 && n < TABLE; n += away) {
    optical_depth -= hl_log1p(-fmin(e->opacity[n], 0.9999)) * per_entry / steepness;
    if (optical_depth >= 1) return (abs(n - first) + 1) * per_entry / steepness;
  }
  return INFINITY;
}

/* The last face of a cut that a ray has crossed: the face's normal in the world, and its place on the ray. */
typedef struct ray_face {
  vec3 normal;
  double at;
} ray_face;

/* If a ray crosses a face of a cut between two points, notes the face. before, here: points of index space,
 * one step apart; t: the distance of `here` along the ray, in world units. */
static void pass_face(const exposure *e, ray_face *face, double t, vec3 before, vec3 here) {
  vec3 outward;
  if (!hl_cut_face_between(e->volume, e->cuts, before, here, &outward)) return;
  face->normal = vec3_normalise(mat3_apply(mat3_transpose(e->world_to_index.linear), outward));
  face->at = t - e->step / 2;
}

static double brightest(const double color[3]) { return fmax(color[0], fmax(color[1], color[2])); }

static double strength_of(const hl_light *light) { return light->intensity * brightest(light->color); }

/* The fraction of light from a direction that reaches a point of the world. The path of the light is sampled
 * in steps of three voxel edges, until it leaves the volume's box. If the point lies on a face of the box and
 * the light lies outside of this face, the path meets no matter, because the box is convex. */
static double passing(const exposure *e, vec3 point, vec3 towards) {
  enum { STEPS = 3 };
  const double *low = e->low, *high = e->high;
  vec3 at = affine3_apply(e->world_to_index, point);
  vec3 step = mat3_apply(e->world_to_index.linear, vec3_scale(towards, STEPS * e->step));
  for (double left = 1;; at = vec3_add(at, step)) {
    if (left < FAINT) return 0;
    if (!(at.x > low[0] && at.y > low[1] && at.z > low[2] && at.x < high[0] && at.y < high[1] &&
          at.z < high[2]))
      return left;
    double value = hl_volume_value_within(e->volume->volume, (size_t)lround(at.x), (size_t)lround(at.y),
                                          (size_t)lround(at.z));
    double clear = isfinite(value) ? 1 - e->opacity[entry_of(e, value)] : 1;
    if (clear < 1 && hl_cuts_leave(e->cuts, e->volume->cut_count, at)) left *= hl_pow(clear, STEPS);
  }
}

/* The fractions of the lights and of the sky that reach a face. Eight directions represent the sky, each with
 * an equal part of the sky's light on the face. Four of the directions have angles from the normal whose
 * sin^2 is 1/4, and four have angles whose sin^2 is 3/4 (derived: the integral of the cosine over a cap of
 * the hemisphere). */
static void light_reaching_face(const exposure *e, vec3 point, vec3 normal, sample_light *lit) {
  enum { DIRECTIONS = 8 };
  const hl_scene_description *scene = e->scene;
  vec3 across = fabs(normal.x) < 0.6 ? (vec3){1, 0, 0} : (vec3){0, 1, 0};
  vec3 u = vec3_normalise(vec3_cross(normal, across)), v = vec3_cross(normal, u);
  point = vec3_add(point, vec3_scale(normal, 3 * e->step));
  for (size_t l = 0; l < scene->light_count; l++)
    if (scene->lights[l].shadows != HL_SHADOWS_OFF) lit->left[l] = passing(e, point, e->towards[l]);
  lit->sky = 0;
  for (int n = 0; n < DIRECTIONS && scene->sky.type != HL_SKY_NONE; n++) {
    double aside = sqrt(n % 2 ? 0.75 : 0.25), turn = 2 * HL_PI * n / DIRECTIONS;
    vec3 flat = vec3_add(vec3_scale(u, aside * hl_cos(turn)), vec3_scale(v, aside * hl_sin(turn)));
    vec3 towards = vec3_add(flat, vec3_scale(normal, sqrt(1 - aside * aside)));
    lit->sky += passing(e, point, towards) / DIRECTIONS;
  }
}

/* Gives a sample the light of the face that the ray has crossed last, if the sample lies less than a voxel
 * and a half behind the face. At this depth, the renderer's normal is the mean of the face's normal and the
 * data's normal. */
static void light_by_face(const exposure *e, const ray_face *face, double t, vec3 point, vec3 to_eye,
                          sample_light *lit) {
  bool behind = (t - face->at) * vec3_dot(face->normal, to_eye) < 1.5 * e->step;
  if (e->volume->shading != HL_SHADING_PHONG || !behind) return;
  if (e->volume->cut_shading == HL_CUT_SHADING_FACE) lit->surface = true, lit->normal = face->normal;
  if (e->volume->cut_shading == HL_CUT_SHADING_NONE) lit->surface = false;
  light_reaching_face(e, point, face->normal, lit);
}

/* The light at a place in a medium that scatters light again and again. place: in index space; point: the
 * same place in the world. */
static double glow_at(const exposure *e, vec3 place, vec3 point) {
  const hl_scene_description *scene = e->scene;
  double light = hl_glow_at(&e->glow, place);
  for (size_t l = 0; l < scene->light_count; l++) {
    /* passing() takes the matter in the middle of each of its steps, which are three voxel edges long */
    const vec3 from = vec3_add(point, vec3_scale(e->towards[l], 1.5 * e->step));
    light += strength_of(&scene->lights[l]) *
             (scene->lights[l].shadows == HL_SHADOWS_OFF ? 1 : passing(e, from, e->towards[l]));
  }
  return light;
}

typedef struct pixel {
  double brightness; /* the value of the brightest channel; -1 if the pixel is mostly background */
  double thickness;  /* thickness of the first surface that the ray meets, in steps; infinite if the ray meets
                      * no surface */
} pixel;

/* The light and opacity that a ray has gathered. */
typedef struct gathered {
  double alpha, seen[3];
} gathered;

static void gather(const double sent[3], double opacity, gathered *all) {
  const double share = (1 - all->alpha) * opacity;
  for (int c = 0; c < 3; c++) all->seen[c] += share * sent[c];
  all->alpha += share;
}

/* Adds the isosurfaces that a ray crosses between two voxels. before, value: the values at the first and the
 * second voxel; at: the second voxel. */
static void gather_isosurfaces(const exposure *e, double before, double value, const long at[3], vec3 to_eye,
                               gathered *all) {
  const hl_scene_volume *volume = e->volume;
  for (size_t i = 0; i < volume->iso_count; i++) {
    const hl_isosurface *surface = &volume->iso[i];
    double slope[3], own[3] = {1, 1, 1}, sent[3];
    if ((before < surface->value) == (value < surface->value)) continue;
    if (!isfinite(smooth_value(volume->volume, at, slope))) continue;
    vec3 gradient = mat3_apply(mat3_transpose(e->world_to_index.linear), vec3_of(slope));
    sample_light lit = {.surface = true, .normal = vec3_normalise(gradient), .sky = 1};
    if (vec3_dot(lit.normal, to_eye) < 0) lit.normal = vec3_scale(lit.normal, -1);
    for (size_t l = 0; l < e->scene->light_count; l++) lit.left[l] = 1;
    shade(e, surface->color, &lit, to_eye, own, sent);
    gather(sent, surface->opacity, all);
  }
}

static pixel look_along(const exposure *e, vec3 origin, vec3 direction) {
  const hl_volume *volume = e->volume->volume;
  vec3 from = affine3_apply(e->world_to_index, origin),
       along = mat3_apply(e->world_to_index.linear, direction);
  vec3 to_eye = vec3_scale(direction, -1);
  double part[2], before = e->empty;
  gathered all = {0, {0, 0, 0}};
  pixel p = {-1, INFINITY};
  ray_face face = {.normal = to_eye, .at = -INFINITY};
  if (!cross_box(e, from, along, part)) return p;
  for (double t = part[0] + 0.5 * e->step; t < part[1] && all.alpha < OPAQUE; t += e->step) {
    vec3 place = vec3_add(from, vec3_scale(along, t));
    const long at[3] = {lround(place.x), lround(place.y), lround(place.z)};
    double near = hl_volume_value_within(volume, (size_t)at[0], (size_t)at[1], (size_t)at[2]), slope[3],
           own[3], sent[3];
    if (!hl_cuts_leave(e->cuts, e->volume->cut_count, place)) continue;
    pass_face(e, &face, t, vec3_subtract(place, vec3_scale(along, e->step)), place);
    if (!isfinite(near)) continue;
    gather_isosurfaces(e, before, near, at, to_eye, &all);
    before = near;
    if (!(e->opacity[entry_of(e, near)] > 0)) continue;
    double value = smooth_value(volume, at, slope);
    if (!isfinite(value)) continue;
    int entry = entry_of(e, value);
    vec3 gradient = mat3_apply(mat3_transpose(e->world_to_index.linear), vec3_of(slope));
    if (all.alpha < FAINT && e->opacity[entry] > FAINT && vec3_length(gradient) > e->flat)
      p.thickness = thickness_at(e, entry, value, vec3_length(gradient) * e->step);
    hl_volume_color(volume, (size_t)at[0], (size_t)at[1], (size_t)at[2], own);
    sample_light lit = light_by_gradient(e, value, gradient);
    light_by_face(e, &face, t, vec3_add(origin, vec3_scale(direction, t)), to_eye, &lit);
    if (e->glow.light != NULL && !lit.surface)
      lit.glow = glow_at(e, place, vec3_add(origin, vec3_scale(direction, t)));
    shade(e, e->color[entry], &lit, to_eye, own, sent);
    gather(sent, e->opacity[entry], &all);
  }
  if (all.alpha > 0.5) p.brightness = fmax(all.seen[0], fmax(all.seen[1], all.seen[2]));
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
  hl_scene_volume_box(volume, e->low, e->high);
  double half = hl_tan(camera->fovy_deg * HL_PI / 360);
  e->right = vec3_scale(e->right, half * scene->width / scene->height);
  e->up = vec3_scale(e->up, half);
  for (size_t l = 0; l < scene->light_count; l++) {
    e->towards[l] = vec3_scale(vec3_normalise(hl_light_way(camera, &scene->lights[l])), -1);
  }
  e->left = left;
  e->step = mat3_shortest_column(index_to_world.linear);
  e->flat = 1e-3 * range / e->step;
  for (int n = 0; n < TABLE; n++) {
    double value = volume->volume->minimum + range * n / (TABLE - 1);
    e->opacity[n] = 1 - hl_pow(1 - hl_transfer_function_opacity(function, value),
                               e->step / function->unit_distance);
    hl_transfer_function_color(function, value, e->color[n]);
  }
  return true;
}

/* Two lists: the brightness of each pixel that shows anything, and the thickness of each surface that a pixel
 * shows. */
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

/* least: the least factor that is chosen. */
static hl_status judge(hl_context *context, pixels *seen, double least, hl_exposure *exposure,
                       hl_error *error) {
  if (!hl_sort(context, seen->brightness, seen->bright_count) ||
      !hl_sort(context, seen->thickness, seen->surface_count))
    return hl_fail_memory(error, sizeof seen->brightness, "an exposure");
  if (seen->bright_count > 0) {
    double bright = fmax(hl_quantile(seen->brightness, seen->bright_count, BRIGHTEST), 1e-9);
    exposure->factor = round(100 * fmin(fmax(TARGET / bright, least), 2)) / 100;
  }
  if (seen->surface_count > 0)
    exposure->thickness = hl_quantile(seen->thickness, seen->surface_count, THINNEST);
  return HL_OK;
}

static hl_glow_matter matter_at(const void *data, vec3 place) {
  const exposure *e = data;
  const hl_volume *volume = e->volume->volume;
  size_t at[3];
  const double index[3] = {place.x, place.y, place.z};
  for (int a = 0; a < 3; a++)
    at[a] = (size_t)fmin(fmax(round(index[a]), 0), (double)volume->dimension[a] - 1);
  const double value = hl_volume_value_within(volume, at[0], at[1], at[2]);
  if (!isfinite(value) || !hl_cuts_leave(e->cuts, e->volume->cut_count, place)) return (hl_glow_matter){0, 0};
  const int entry = entry_of(e, value);
  const double extinction = -hl_log1p(-fmin(e->opacity[entry], 0.9999)) / e->step;
  double scattered = 0;
  for (int c = 0; c < 3; c++) scattered = fmax(scattered, e->volume->albedo[c] * e->color[entry][c]);
  return (hl_glow_matter){extinction, extinction * fmin(scattered, 1)};
}

/* Estimates the light within a medium that scatters it again and again. */
static hl_status make_glow(hl_context *context, exposure *e, hl_error *error) {
  const hl_scene_description *scene = e->scene;
  double sky[3];
  hl_glow_request request = {.matter = matter_at,
                             .data = e,
                             .anisotropy = e->volume->anisotropy,
                             .light_count = scene->light_count,
                             .index_to_world = hl_scene_volume_index_to_world(e->volume)};
  if (!e->volume->multiple_scattering) return HL_OK;
  sky_light(&scene->sky, NULL, sky);
  request.sky = brightest(sky);
  memcpy(request.low, e->low, sizeof request.low);
  memcpy(request.high, e->high, sizeof request.high);
  for (size_t l = 0; l < scene->light_count; l++) {
    request.towards[l] = e->towards[l];
    request.strength[l] = strength_of(&scene->lights[l]);
  }
  return hl_glow_make(context, &request, &e->glow, error);
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
    status = hl_cut_shapes(context, e->volume, &e->cuts, error);
    if (status == HL_OK) status = make_glow(context, e, error);
    if (status == HL_OK) look(e, seen);
    if (status == HL_OK)
      status = judge(context, seen, e->glow.light != NULL ? LEAST_OF_GLOW : LEAST, result, error);
    hl_glow_release(context, &e->glow);
    hl_release(context, e->cuts);
  }
  hl_release(context, seen);
  hl_release(context, e);
  return status;
}
