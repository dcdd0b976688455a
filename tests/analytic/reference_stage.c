/* analytic/reference_stage.c - see reference_stage.h. */
#include "reference_stage.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "volume/convert.h"
#include "volume/volume.h"

static void require(hl_status status, const hl_error *error) {
  if (status != HL_OK) fail_msg("%s: %s", hl_status_name(status), error->message);
}

static void copy_vector(double to[3], vec3 from) {
  to[0] = from.x;
  to[1] = from.y;
  to[2] = from.z;
}

void stage_open(stage *set) { stage_open_with(set, NULL); }

void stage_open_with(stage *set, const hl_context_options *options) {
  memset(set, 0, sizeof *set);
  hl_error error = {0};
  require(hl_context_create(options, &set->context, &error), &error);
  hl_scene_description_defaults(&set->scene);
  set->scene.width = set->scene.height = 16;
  set->type = HL_VOXEL_F32;
  set->scene.lights = set->lights;
  set->scene.volumes = set->volumes;
  memset(set->scene.ambient, 0, sizeof set->scene.ambient);
  set->scene.render.shadows = HL_SHADOWS_HARD;
  set->scene.camera.type = HL_CAMERA_ORTHOGRAPHIC;
  set->scene.camera.height = 16;
  stage_look(set, (vec3){0, 0, 100}, (vec3){0, 0, 0}, (vec3){0, 1, 0});
}

void stage_close(stage *set) {
  for (size_t v = 0; v < set->scene.volume_count; v++) hl_volume_release(set->volumes[v].volume);
  assert_true(hl_context_memory_held(set->context) == 0);
  hl_context_destroy(set->context);
}

/* Converts voxels to the stage's type. The caller frees the converted voxels. */
static void *store_voxels(const stage *set, const float *voxels, size_t count, double *value_scale) {
  float *stored = malloc(count * sizeof *stored);
  assert_non_null(stored);
  *value_scale = set->type == HL_VOXEL_U8 ? 1.0 / 255 : set->type == HL_VOXEL_U16 ? 1.0 / 65535 : 1;
  for (size_t i = 0; i < count; i++) {
    float value = voxels == NULL ? 1 : voxels[i];
    if (set->type == HL_VOXEL_U8) ((uint8_t *)stored)[i] = (uint8_t)lround(value / *value_scale);
    else if (set->type == HL_VOXEL_U16) ((uint16_t *)stored)[i] = (uint16_t)lround(value / *value_scale);
    else stored[i] = value;
  }
  return stored;
}

hl_scene_volume *stage_add_grid(stage *set, const size_t dimensions[3], const double spacing[3], vec3 corner,
                                const float *voxels) {
  assert_true(set->scene.volume_count < STAGE_VOLUMES);
  hl_volume_description description;
  hl_volume_description_defaults(&description);
  const double low[3] = {corner.x, corner.y, corner.z};
  for (int a = 0; a < 3; a++) {
    description.dimensions[a] = dimensions[a];
    description.axis[a][0] = description.axis[a][1] = description.axis[a][2] = 0;
    description.axis[a][a] = spacing[a];
    description.origin[a] = low[a] + spacing[a] / 2;
  }
  void *stored = store_voxels(set, voxels, dimensions[0] * dimensions[1] * dimensions[2],
                              &description.value_scale);
  description.type = set->type;
  description.voxels = stored;
  hl_scene_volume *volume = &set->volumes[set->scene.volume_count++];
  hl_scene_volume_defaults(volume);
  hl_error error = {0};
  require(hl_volume_create(set->context, &description, &volume->volume, &error), &error);
  free(stored);
  volume->shading = HL_SHADING_NONE;
  stage_set_opacity(set, volume, 0.5, 1);
  stage_set_color(set, volume, 1, 1, 1);
  return volume;
}

hl_scene_volume *stage_add_box(stage *set, vec3 low, vec3 high) {
  vec3 size = vec3_subtract(high, low);
  return stage_add_grid(set, (size_t[3]){1, 1, 1}, (double[3]){size.x, size.y, size.z}, low, NULL);
}

hl_scene_volume *stage_add_ball_and_plate(stage *set, const hl_opacity_point opacity[2]) {
  enum { GRID = 24 };
  static float voxels[GRID * GRID * GRID];
  for (int i = 0; i < GRID * GRID * GRID; i++) {
    double x = i % GRID - 11.5, y = i / GRID % GRID - 11.5, z = i / GRID / GRID - 13;
    double ball = 6 - sqrt(x * x + y * y + z * z), plate = 4 - (z + 13);
    double inside = fmax(ball, fabs(x) < 10 && fabs(y) < 10 ? plate : -1);
    voxels[i] = (float)fmin(fmax(0.5 + inside / 2, 0), 1);
  }
  hl_scene_volume *volume = stage_add_grid(set, (size_t[3]){GRID, GRID, GRID}, (double[3]){1, 1, 1},
                                           (vec3){-12, -12, -12}, voxels);
  volume->transfer_function.opacity = opacity;
  volume->transfer_function.opacity_count = 2;
  return volume;
}

hl_volume_description stage_describe_volume(const hl_volume *volume) {
  hl_volume_info info = {.struct_size = sizeof info};
  assert_int_equal(hl_volume_get_info(volume, &info), HL_OK);
  hl_volume_description description;
  hl_volume_description_defaults(&description);
  description.type = volume->type;
  description.value_scale = volume->value_scale;
  description.value_offset = volume->value_offset + volume->value_scale * hl_voxel_type_bias(volume->type);
  for (size_t a = 0; a < 3; a++) {
    description.dimensions[a] = volume->dimension[a];
    description.origin[a] = info.origin[a];
    for (size_t b = 0; b < 3; b++) description.axis[a][b] = info.direction[b][a] * info.spacing[a];
  }
  return description;
}

void stage_spoil(stage *set) {
  hl_volume *old = set->volumes[0].volume, *made = NULL;
  float *voxels = old->owned_voxels;
  size_t count = hl_volume_voxel_count(old);
  for (size_t v = 0; v < count; v += 7) voxels[v] = v % 2 == 0 ? NAN : v % 3 == 0 ? INFINITY : -INFINITY;
  voxels[count - 1] = NAN;
  hl_volume_description description = stage_describe_volume(old);
  description.voxels = voxels;
  assert_int_equal(hl_volume_create(set->context, &description, &made, NULL), HL_OK);
  set->volumes[0].volume = made;
  hl_volume_release(old);
}

void stage_set_opacity(stage *set, hl_scene_volume *volume, double opacity, double unit_distance) {
  hl_opacity_point *point = &set->constant_opacity[volume - set->volumes];
  *point = (hl_opacity_point){0, opacity};
  volume->transfer_function.opacity = point;
  volume->transfer_function.opacity_count = 1;
  volume->transfer_function.unit_distance = unit_distance;
}

void stage_set_color(stage *set, hl_scene_volume *volume, double r, double g, double b) {
  hl_color_point *point = &set->constant_color[volume - set->volumes];
  *point = (hl_color_point){0, {r, g, b}};
  volume->transfer_function.color = point;
  volume->transfer_function.color_count = 1;
}

static hl_light *add_light(stage *set, hl_light_type type) {
  assert_true(set->scene.light_count < STAGE_LIGHTS);
  hl_light *light = &set->lights[set->scene.light_count++];
  hl_light_defaults(light);
  light->type = type;
  return light;
}

hl_light *stage_add_directional(stage *set, vec3 direction) {
  hl_light *light = add_light(set, HL_LIGHT_DIRECTIONAL);
  copy_vector(light->direction, direction);
  return light;
}

hl_light *stage_add_point(stage *set, vec3 position) {
  hl_light *light = add_light(set, HL_LIGHT_POINT);
  copy_vector(light->position, position);
  return light;
}

hl_light *stage_add_spot(stage *set, vec3 position, vec3 direction, double opening_deg, double falloff_deg) {
  hl_light *light = add_light(set, HL_LIGHT_SPOT);
  copy_vector(light->position, position);
  copy_vector(light->direction, direction);
  light->opening_angle_deg = opening_deg;
  light->falloff_angle_deg = falloff_deg;
  return light;
}

hl_mesh *stage_make_quad(stage *set, vec3 centre, vec3 u, vec3 v) {
  static const uint32_t triangles[2][3] = {{0, 1, 2}, {0, 2, 3}};
  float positions[4][3];
  hl_mesh_description d;
  hl_mesh *mesh = NULL;
  hl_error error = {0};
  for (int i = 0; i < 4; i++) {
    double a = i == 1 || i == 2 ? 1 : -1, b = i >= 2 ? 1 : -1;
    vec3_store(positions[i], vec3_add(centre, vec3_add(vec3_scale(u, a), vec3_scale(v, b))));
  }
  hl_mesh_description_defaults(&d);
  d.positions = (const float(*)[3])positions, d.vertex_count = 4;
  d.triangles = triangles, d.triangle_count = 2;
  require(hl_mesh_create(set->context, &d, &mesh, &error), &error);
  return mesh;
}

void stage_set_texture(hl_light *light, int width, int height, const float *pixels, vec3 center, vec3 right,
                       vec3 up) {
  light->texture.pixels = pixels;
  light->texture.width = width;
  light->texture.height = height;
  copy_vector(light->texture.screen_center, center);
  copy_vector(light->texture.screen_right, right);
  copy_vector(light->texture.screen_up, up);
}

void stage_look(stage *set, vec3 position, vec3 target, vec3 up) {
  copy_vector(set->scene.camera.position, position);
  copy_vector(set->scene.camera.target, target);
  copy_vector(set->scene.camera.up, up);
}

/* The ray is computed from angles and the distance of pixels, independently of the reference's own code. */
void stage_eye_ray(const stage *set, int x, int y, vec3 *origin, vec3 *direction) {
  const hl_camera *camera = &set->scene.camera;
  vec3 eye = vec3_of(camera->position), back = vec3_normalise(vec3_subtract(eye, vec3_of(camera->target)));
  vec3 right = vec3_normalise(vec3_cross(vec3_of(camera->up), back)), up = vec3_cross(back, right);
  bool perspective = camera->type == HL_CAMERA_PERSPECTIVE;
  double height = perspective ? 2 * tan(camera->fovy_deg / 2 * HL_PI / 180) : camera->height;
  double pitch = height / set->scene.height;
  double u = (x + 0.5 - set->scene.width / 2.0) * pitch, v = (set->scene.height / 2.0 - y - 0.5) * pitch;
  vec3 offset = vec3_add(vec3_scale(right, u), vec3_scale(up, v));
  *origin = perspective ? eye : vec3_add(eye, offset);
  *direction = vec3_scale(back, -1);
  if (perspective) *direction = vec3_normalise(vec3_add(*direction, offset));
}

double stage_chord(vec3 low, vec3 high, vec3 origin, vec3 direction) {
  double enter = 0, leave = INFINITY;
  const double l[3] = {low.x, low.y, low.z}, h[3] = {high.x, high.y, high.z};
  const double o[3] = {origin.x, origin.y, origin.z}, d[3] = {direction.x, direction.y, direction.z};
  for (int a = 0; a < 3; a++) {
    if (fabs(d[a]) < 1e-12) {
      if (o[a] < l[a] || o[a] > h[a]) return 0;
      continue;
    }
    double near = (d[a] > 0 ? l[a] : h[a]) - o[a], far = (d[a] > 0 ? h[a] : l[a]) - o[a];
    enter = fmax(enter, near / d[a]);
    leave = fmin(leave, far / d[a]);
  }
  return fmax(leave - enter, 0);
}

void stage_render(stage *set, const hl_reference_options *options, float *pixels) {
  hl_error error = {0};
  hl_scene *scene = NULL;
  require(hl_scene_create(set->context, &set->scene, &scene, &error), &error);
  require(hl_reference_render(set->context, scene, options, pixels, 4 * (size_t)set->scene.width, &error),
          &error);
  hl_scene_release(scene);
}

static hl_render_statistics render_with(stage *set, hl_renderer *renderer, float *pixels) {
  hl_error error = {0};
  hl_scene *scene = NULL;
  hl_render_statistics statistics = {.struct_size = sizeof statistics};
  require(hl_scene_create(set->context, &set->scene, &scene, &error), &error);
  require(hl_renderer_render(renderer, scene, pixels, 4 * (size_t)set->scene.width, &statistics, &error),
          &error);
  hl_scene_release(scene);
  return statistics;
}

void stage_render_with(stage *set, hl_renderer *renderer, float *pixels) {
  (void)render_with(set, renderer, pixels);
}

void stage_render_by(stage *set, bool reference, float *pixels) {
  hl_reference_options options;
  hl_reference_options_defaults(&options);
  options.light_points = 4;
  if (reference) stage_render(set, &options, pixels);
  else stage_render_sheets(set, pixels);
}

hl_render_statistics stage_render_counted(stage *set, float *pixels) {
  hl_error error = {0};
  hl_renderer *renderer = NULL;
  require(hl_renderer_create(set->context, &renderer, &error), &error);
  hl_render_statistics statistics = render_with(set, renderer, pixels);
  hl_renderer_destroy(renderer);
  return statistics;
}

void stage_render_sheets(stage *set, float *pixels) { (void)stage_render_counted(set, pixels); }

void stage_render_layers(stage *set, const hl_reference_options *options, float *pixels,
                         const hl_layers *wanted) {
  hl_error error = {0};
  hl_scene *scene = NULL;
  hl_renderer *renderer = NULL;
  size_t row = 4 * (size_t)set->scene.width;
  require(hl_scene_create(set->context, &set->scene, &scene, &error), &error);
  if (options != NULL) {
    require(hl_reference_render_layers(set->context, scene, options, pixels, row, wanted, &error), &error);
  } else {
    require(hl_renderer_create(set->context, &renderer, &error), &error);
    require(hl_renderer_render_layers(renderer, scene, pixels, row, wanted, NULL, &error), &error);
  }
  hl_renderer_destroy(renderer);
  hl_scene_release(scene);
}

void stage_refused(stage *set, const char *message) {
  hl_scene *scene = NULL;
  hl_error error = {0};
  assert_int_equal(hl_scene_create(set->context, &set->scene, &scene, &error), HL_ERROR_INPUT);
  assert_null(scene);
  assert_string_equal(error.message, message);
}

float stage_noise(double x, double y, double z) {
  double sum = 0, frequency = 1, size = 0.25;
  for (int octave = 0; octave < 3; octave++, frequency *= 1.9, size *= 0.6) {
    double a = frequency * (x + 0.31 * y), b = frequency * (y - 0.27 * z), c = frequency * (z + 0.43 * x);
    sum += size * sin(a + 1.3 * sin(b)) * cos(c + 0.7 * sin(a));
  }
  return (float)fmin(fmax(0.5 + sum, 0), 1);
}

double stage_random(uint32_t *seed) {
  return (double)(*seed = *seed * 1664525u + 1013904223u) / 4294967296.0;
}

vec3 stage_random_direction(uint32_t *seed) {
  for (;;) {
    vec3 v = {2 * stage_random(seed) - 1, 2 * stage_random(seed) - 1, 2 * stage_random(seed) - 1};
    double length = vec3_length(v);
    if (length > 0.1 && length < 1) return vec3_scale(v, 1 / length);
  }
}
