/* analytic/random_scene.c - see random_scene.h. */
#include "random_scene.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* ---- numbers: SplitMix64 (Steele, Lea and Flood 2014) ---- */

typedef struct dice {
  uint64_t state;
} dice;

static uint64_t draw(dice *d) {
  uint64_t z = d->state += 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}
static double between(dice *d, double low, double high) {
  return low + (high - low) * (double)(draw(d) >> 11) * 0x1p-53;
}
static int below(dice *d, int count) { return (int)(draw(d) % (uint64_t)count); }
static bool chance(dice *d, double part) { return between(d, 0, 1) < part; }

static void store(double to[3], vec3 v) {
  to[0] = v.x;
  to[1] = v.y;
  to[2] = v.z;
}

static vec3 direction(dice *d) {
  for (;;) {
    vec3 v = {between(d, -1, 1), between(d, -1, 1), between(d, -1, 1)};
    double length = vec3_length(v);
    if (length > 0.1 && length < 1) return vec3_scale(v, 1 / length);
  }
}

/* ---- volumes ---- */

static void fill_voxels(dice *d, const size_t n[3], float *voxels) {
  int kind = below(d, 4);
  double frequency = between(d, 0.2, 1.5), phase = between(d, 0, 9), level = between(d, 0, 1);
  for (size_t i = 0; i < n[0] * n[1] * n[2]; i++) {
    double p[3] = {(double)(i % n[0]), (double)(i / n[0] % n[1]), (double)(i / n[0] / n[1])}, r = 0;
    for (int a = 0; a < 3; a++) {
      double half = ((double)n[a] - 1) / 2;
      r += half > 0 ? (p[a] - half) * (p[a] - half) / (half * half) : 0;
    }
    float smooth = stage_noise(frequency * p[0] + phase, frequency * p[1], frequency * p[2]);
    voxels[i] = kind == 0   ? (float)level
                : kind == 1 ? (float)between(d, 0, 1)
                : kind == 2 ? smooth
                            : (float)fmax(0, 1 - r / 2) * (0.5f + 0.5f * smooth);
  }
}

static void spoil_voxels(dice *d, size_t count, float *voxels) {
  static const float values[] = {NAN, INFINITY, -INFINITY};
  for (size_t i = 0; i < count; i++)
    if (chance(d, 0.1)) voxels[i] = values[below(d, 3)];
}

/* Draws an opacity that rises with the value; some of the opacities have steps. */
static void draw_points(dice *d, hl_transfer_function *function, hl_opacity_point *opacity,
                        hl_color_point *color) {
  double value = between(d, -0.2, 0.4), densest = chance(d, 0.3) ? 1 : between(d, 0.05, 0.9);
  int count = 1 + below(d, RANDOM_POINTS), colors = 1 + below(d, RANDOM_POINTS);
  for (int p = 0; p < count; p++) {
    bool step = p % 2 == 1 && chance(d, 0.2);
    if (p > 0 && !step) value += between(d, 0.02, 0.4);
    opacity[p] = (hl_opacity_point){value, chance(d, 0.4) ? 0 : between(d, 0, densest)};
  }
  for (int p = 0; p < colors; p++)
    color[p] = (hl_color_point){p * 0.25, {between(d, 0, 1), between(d, 0, 1), between(d, 0, 1)}};
  function->opacity = opacity;
  function->opacity_count = (size_t)count;
  function->color = color;
  function->color_count = (size_t)colors;
  function->unit_distance = between(d, 0.2, 4);
}

static void draw_grid(dice *d, hl_volume_description *grid, double size) {
  vec3 u = direction(d), v = vec3_perpendicular(u), w = vec3_cross(u, v), axes[3] = {u, v, w};
  if (chance(d, 0.3)) axes[0] = (vec3){1, 0, 0}, axes[1] = (vec3){0, 1, 0}, axes[2] = (vec3){0, 0, 1};
  if (chance(d, 0.3)) axes[2] = vec3_scale(axes[2], -1);
  if (chance(d, 0.3)) axes[1] = vec3_normalise(vec3_add(axes[1], vec3_scale(axes[0], between(d, -0.6, 0.6))));
  vec3 middle = {0, 0, 0};
  double spacing = size / 5, unequal = chance(d, 0.5) ? 1 : 2.5;
  for (int a = 0; a < 3; a++) {
    grid->dimensions[a] = chance(d, 0.1) ? 1 : 1 + (size_t)below(d, 10);
    vec3 axis = vec3_scale(axes[a], spacing * between(d, 1 / unequal, unequal));
    store(grid->axis[a], axis);
    middle = vec3_add(middle, vec3_scale(axis, ((double)grid->dimensions[a] - 1) / 2));
  }
  store(grid->origin, vec3_subtract(vec3_scale(direction(d), between(d, 0, size)), middle));
}

static hl_volume *make_volume(dice *d, hl_context *context, const hl_volume_description *grid,
                              float *voxels) {
  hl_volume_description description = *grid;
  size_t count = grid->dimensions[0] * grid->dimensions[1] * grid->dimensions[2];
  static const hl_voxel_type types[] = {HL_VOXEL_U8, HL_VOXEL_U16, HL_VOXEL_F32};
  description.type = types[below(d, 3)];
  if (description.type == HL_VOXEL_F32 && chance(d, 0.3)) spoil_voxels(d, count, voxels);
  if (description.type == HL_VOXEL_U8) {
    description.value_scale = 1.0 / 255;
    /* the bytes are converted in place: a byte is never written over a float that is still to be read */
    for (size_t i = 0; i < count; i++) ((uint8_t *)voxels)[i] = (uint8_t)lrintf(voxels[i] * 255);
  } else if (description.type == HL_VOXEL_U16) {
    description.value_scale = 1.0 / 65535;
    for (size_t i = 0; i < count; i++) ((uint16_t *)voxels)[i] = (uint16_t)lrintf(voxels[i] * 65535);
  }
  description.voxels = voxels;
  hl_volume *volume = NULL;
  hl_error error = {0};
  if (hl_volume_create(context, &description, &volume, &error) != HL_OK) fail_msg("%s", error.message);
  return volume;
}

static void draw_clip(dice *d, const hl_volume_description *grid, hl_scene_volume *volume) {
  double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
  for (int corner = 0; corner < 8; corner++)
    for (int a = 0; a < 3; a++) {
      double at = grid->origin[a];
      for (int axis = 0; axis < 3; axis++)
        at += grid->axis[axis][a] * (corner >> axis & 1 ? (double)grid->dimensions[axis] - 0.5 : -0.5);
      low[a] = fmin(low[a], at);
      high[a] = fmax(high[a], at);
    }
  volume->clipped = 1;
  for (int a = 0; a < 3; a++) {
    volume->clip_min[a] = low[a] + (high[a] - low[a]) * between(d, -0.2, 0.4);
    volume->clip_max[a] = low[a] + (high[a] - low[a]) * between(d, 0.6, 1.2);
  }
}

static void draw_volume(dice *d, random_scene *scene, double size) {
  stage *set = &scene->set;
  size_t index = set->scene.volume_count++;
  hl_scene_volume *volume = &set->volumes[index];
  hl_volume_description grid;
  hl_scene_volume_defaults(volume);
  hl_volume_description_defaults(&grid);
  draw_grid(d, &grid, size);
  float *voxels = malloc(grid.dimensions[0] * grid.dimensions[1] * grid.dimensions[2] * sizeof *voxels);
  assert_non_null(voxels);
  fill_voxels(d, grid.dimensions, voxels);
  volume->volume = make_volume(d, set->context, &grid, voxels);
  free(voxels);
  draw_points(d, &volume->transfer_function, scene->opacity[index], scene->color[index]);
  volume->shading = chance(d, 0.5) ? HL_SHADING_PHONG : HL_SHADING_NONE;
  volume->material = (hl_material){between(d, 0, 1), between(d, 0, 1), between(d, 0, 1), between(d, 0, 80),
                                   0};
  if (chance(d, 0.5)) volume->anisotropy = between(d, -0.8, 0.8);
  for (int c = 0; c < 3 && chance(d, 0.4); c++) volume->attenuation_color[c] = between(d, 0, 2);
  volume->visible = !chance(d, 0.1);
  volume->casts_shadow = !chance(d, 0.1);
  volume->receives_shadow = !chance(d, 0.1);
  if (chance(d, 0.3)) {
    volume->scale = between(d, 0.5, 1.5);
    store(volume->rotate_axis, direction(d));
    volume->rotate_angle_deg = between(d, -180, 180);
    store(volume->translate, vec3_scale(direction(d), between(d, 0, size / 2)));
  }
  if (chance(d, 0.3)) draw_clip(d, &grid, volume);
}

/* ---- lights ---- */

static void draw_texture(dice *d, float *pixels, double size, hl_light *light) {
  vec3 way = light->type == HL_LIGHT_DIRECTIONAL ? vec3_of(light->direction)
                                                 : vec3_scale(vec3_of(light->position), -1);
  vec3 along = vec3_normalise(way), u = vec3_perpendicular(along), v = vec3_cross(along, u);
  for (int i = 0; i < RANDOM_TEXTURE * RANDOM_TEXTURE * 3; i++) pixels[i] = (float)between(d, 0, 1.5);
  light->texture = (hl_light_texture){
      .pixels = pixels, .width = 1 + below(d, RANDOM_TEXTURE), .height = 1 + below(d, RANDOM_TEXTURE)};
  store(
      light->texture.screen_center,
      vec3_scale(along, light->type == HL_LIGHT_DIRECTIONAL ? 0 : -vec3_length(way) * between(d, 0.2, 0.7)));
  store(light->texture.screen_right,
        vec3_scale(vec3_add(u, vec3_scale(along, between(d, -0.4, 0.4))), between(d, 0.3, 1.5) * size));
  store(light->texture.screen_up,
        vec3_scale(vec3_add(v, vec3_scale(u, between(d, -0.4, 0.4))), between(d, 0.3, 1.5) * size));
}

/* Draws a polygon around a centre, in a plane. */
static void draw_vertices(dice *d, double size, double (*vertices)[3], hl_light *light) {
  vec3 n = direction(d), u = vec3_perpendicular(n), v = vec3_cross(n, u), middle = vec3_of(light->position);
  int count = 3 + below(d, RANDOM_VERTICES - 2);
  for (int i = 0; i < count; i++) {
    double angle = 2 * HL_PI * i / count, radius = size * between(d, 0.3, 1);
    store(vertices[i],
          vec3_add(middle, vec3_add(vec3_scale(u, radius * cos(angle)), vec3_scale(v, radius * sin(angle)))));
  }
  light->vertices = (const double(*)[3])vertices;
  light->vertex_count = (size_t)count;
}

static void draw_light(dice *d, random_scene *scene, double size) {
  stage *set = &scene->set;
  size_t index = set->scene.light_count++;
  hl_light *light = &set->lights[index];
  double extent = chance(d, 0.25) ? 0 : size * between(d, 0.05, 1.5),
         distance = chance(d, 0.2) ? between(d, 0, 2) : between(d, 2, 8);
  hl_light_defaults(light);
  light->type = (hl_light_type)below(d, 6);
  store(light->direction, direction(d));
  store(light->position, vec3_scale(direction(d), distance * size));
  store(light->normal, direction(d));
  store(light->edge1, vec3_scale(direction(d), extent));
  store(light->edge2, vec3_scale(direction(d), extent * between(d, 0, 1)));
  light->radius = extent / 2;
  light->angular_diameter_deg = chance(d, 0.3) ? 0 : between(d, 0, 40);
  if (light->type == HL_LIGHT_POLYGON)
    draw_vertices(d, size * between(d, 0.1, 1), scene->vertices[index], light);
  if (light->type == HL_LIGHT_SPOT) {
    store(light->direction, vec3_subtract(vec3_scale(direction(d), size / 2), vec3_of(light->position)));
    light->opening_angle_deg = between(d, 5, 150);
    light->falloff_angle_deg = between(d, 0, 0.5) * light->opening_angle_deg;
  }
  store(light->color, (vec3){between(d, 0, 1), between(d, 0, 1), between(d, 0, 1)});
  light->intensity = between(d, 0, 2);
  if (light->type != HL_LIGHT_DIRECTIONAL && chance(d, 0.2)) {
    light->falloff = HL_FALLOFF_INVERSE_SQUARE;
    light->intensity *= distance * size * distance * size;
  }
  light->shadows = (hl_shadows)below(d, 4);
  if (light->type != HL_LIGHT_POLYGON && distance > 0.5 && chance(d, 0.2))
    draw_texture(d, scene->texture[index], size, light);
}

/* ---- the rest ---- */

/* Draws emission, flat shading and maximum projections. These are drawn last, so that the scene of a seed
 * keeps all that older versions of this program drew. */
static void draw_shine(dice *d, stage *set) {
  for (size_t v = 0; v < set->scene.volume_count; v++) {
    if (chance(d, 0.2)) set->volumes[v].material.emission = between(d, 0, 2);
    if (chance(d, 0.15)) set->volumes[v].shading = HL_SHADING_FLAT;
  }
  if (chance(d, 0.1)) set->scene.render.compositing = HL_COMPOSITING_MAXIMUM;
}

static void draw_camera(dice *d, hl_camera *camera, double size) {
  bool inside = chance(d, 0.15);
  vec3 back = direction(d), target = vec3_scale(direction(d), between(d, 0, 0.5) * size);
  camera->type = chance(d, 0.35) ? HL_CAMERA_ORTHOGRAPHIC : HL_CAMERA_PERSPECTIVE;
  camera->fovy_deg = between(d, 10, 100);
  camera->height = between(d, 1, 5) * size;
  double fitting = between(d, 0.8, 2) * size / tan(camera->fovy_deg * HL_PI / 360);
  store(camera->target, target);
  store(camera->position, vec3_add(target, vec3_scale(back, inside ? between(d, 0.1, 1) * size : fitting)));
  store(camera->up, direction(d));
}

void random_scene_open(random_scene *scene, uint64_t seed) {
  dice d = {seed};
  memset(scene, 0, sizeof *scene);
  stage *set = &scene->set;
  double size = between(&d, 2, 8);
  stage_open(set);
  set->scene.width = 16 + below(&d, 17);
  set->scene.height = 16 + below(&d, 17);
  for (int c = 0; c < 3 && chance(&d, 0.6); c++) set->scene.ambient[c] = between(&d, 0, 0.5);
  hl_render_settings *render = &set->scene.render;
  render->shadows = (hl_shadows)(HL_SHADOWS_OFF + below(&d, 3));
  render->soft_method = (hl_soft_method)below(&d, 3);
  render->light_samples = 1 + below(&d, 4);
  render->sheet_spacing = between(&d, 0.3, 1.2);
  render->kernel = (hl_kernel)below(&d, 3);
  render->reconstruction = (hl_reconstruction)below(&d, 3);
  render->slicing = chance(&d, 0.1) ? HL_SLICING_IMAGE_ALIGNED : HL_SLICING_HALF_VECTOR;
  const hl_shadow_lookup lookups[] = {HL_LOOKUP_BILINEAR, HL_LOOKUP_CUBIC, HL_LOOKUP_AUTO};
  render->shadow_lookup = chance(&d, 0.1) ? HL_LOOKUP_NEAREST : lookups[below(&d, 3)];
  render->shadow_resolution = chance(&d, 0.2) ? 1 + below(&d, 64) : 0;
  draw_camera(&d, &set->scene.camera, size);
  for (int count = 1 + below(&d, 3); count > 0; count--) draw_volume(&d, scene, size);
  for (int count = below(&d, STAGE_LIGHTS + 1); count > 0; count--) draw_light(&d, scene, size);
  draw_shine(&d, set);
}
