/* cli/bench/scene.c - makes the scenes of `halflight bench`. There is one scene for each setting and moment
 * of the motion. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bench.h"
#include "elementary/elementary.h"

static const double turn = 2 * 3.14159265358979323846;

enum { SUBLIGHTS_SIDE = 4 };

/* Returns the vector v turned about a unit axis (Rodrigues' formula). */
static void rotate(double v[3], const double axis[3], double angle_rad) {
  double c = hl_cos(angle_rad), s = hl_sin(angle_rad), dot = v[0] * axis[0] + v[1] * axis[1] + v[2] * axis[2],
         turned[3];
  for (int i = 0; i < 3; i++) {
    int j = (i + 1) % 3, k = (i + 2) % 3;
    turned[i] = v[i] * c + (axis[j] * v[k] - axis[k] * v[j]) * s + axis[i] * dot * (1 - c);
  }
  memcpy(v, turned, sizeof turned);
}

static void turn_camera(hl_camera *camera, const double axis[3], double angle_rad) {
  for (int i = 0; i < 3; i++) camera->position[i] -= camera->target[i];
  rotate(camera->position, axis, angle_rad);
  rotate(camera->up, axis, angle_rad);
  for (int i = 0; i < 3; i++) camera->position[i] += camera->target[i];
}

/* Turns a light about the camera's target and up vector. A light that moves with the camera is described in
 * axes of its own, in which the target is the origin and up is the second axis. */
static void turn_light(hl_light *light, const double target_in_world[3], const double axis_in_world[3],
                       double angle_rad) {
  static const double origin[3] = {0, 0, 0}, up[3] = {0, 1, 0};
  const bool beside = light->frame == HL_LIGHT_FRAME_CAMERA;
  const double *target = beside ? origin : target_in_world, *axis = beside ? up : axis_in_world;
  rotate(light->direction, axis, angle_rad);
  for (int i = 0; i < 3; i++) light->position[i] -= target[i];
  rotate(light->position, axis, angle_rad);
  for (int i = 0; i < 3; i++) light->position[i] += target[i];
}

/* Lights swing 30 degrees to either side, so that each light stays on its side of the volume, as seen from
 * the camera. */
static double light_angle(double at) { return turn / 12 * hl_sin(turn * at); }

static void set_shadows(hl_scene_description *description, hl_light *lights, enum bench_setting setting) {
  static const hl_soft_method methods[SETTING_COUNT] = {[SETTING_PAPER] = HL_SOFT_PAPER,
                                                        [SETTING_CASCADE] = HL_SOFT_CASCADE,
                                                        [SETTING_SUBLIGHTS] = HL_SOFT_SUBLIGHTS};
  hl_render_settings *render = &description->render;
  render->shadows = setting == SETTING_OFF    ? HL_SHADOWS_OFF
                    : setting == SETTING_HARD ? HL_SHADOWS_HARD
                                              : HL_SHADOWS_SOFT;
  render->soft_method = methods[setting];
  if (setting == SETTING_SUBLIGHTS && render->light_samples < 2) render->light_samples = SUBLIGHTS_SIDE;
  for (size_t i = 0; i < description->light_count; i++)
    if (lights[i].shadows != HL_SHADOWS_OFF) lights[i].shadows = HL_SHADOWS_DEFAULT;
}

static void move_scene(hl_scene_description *description, hl_light *lights, enum bench_move move, double at) {
  hl_camera *camera = &description->camera;
  double axis[3], length = sqrt(camera->up[0] * camera->up[0] + camera->up[1] * camera->up[1] +
                                camera->up[2] * camera->up[2]);
  for (int i = 0; i < 3; i++) axis[i] = camera->up[i] / length;
  if (move == MOVE_CAMERA) turn_camera(camera, axis, turn * at);
  for (size_t i = 0; move == MOVE_LIGHT && i < description->light_count; i++)
    turn_light(&lights[i], camera->target, axis, light_angle(at));
}

/* A copy of the opacity points, scaled by a factor between 3/4 and 1; owned by the caller (free). */
static hl_opacity_point *fade(const hl_transfer_function *function, double at) {
  hl_opacity_point *points = malloc((function->opacity_count + 1) * sizeof *points);
  for (size_t i = 0; points != NULL && i < function->opacity_count; i++)
    points[i] = (hl_opacity_point){function->opacity[i].value,
                                   function->opacity[i].opacity * (0.875 + 0.125 * hl_cos(turn * at))};
  return points;
}

hl_scene *bench_scene_at(cli_host *host, const hl_scene *scene, enum bench_setting setting,
                         enum bench_move move, double at, int *exit_code) {
  hl_scene_description description = *hl_scene_describe(scene);
  hl_light *lights = calloc(description.light_count + 1, sizeof *lights);
  hl_scene_volume *volumes = calloc(description.volume_count + 1, sizeof *volumes);
  hl_opacity_point *faded = NULL;
  hl_scene *made = NULL;
  hl_error error = {0};
  hl_status status = lights == NULL || volumes == NULL ? HL_ERROR_MEMORY : HL_OK;
  if (status == HL_OK) {
    if (description.light_count > 0)
      memcpy(lights, description.lights, description.light_count * sizeof *lights);
    if (description.volume_count > 0)
      memcpy(volumes, description.volumes, description.volume_count * sizeof *volumes);
    description.lights = lights;
    description.volumes = volumes;
    set_shadows(&description, lights, setting);
    move_scene(&description, lights, move, at);
    if (move == MOVE_TF && description.volume_count > 0) {
      faded = fade(&volumes[0].transfer_function, at);
      if (faded != NULL) volumes[0].transfer_function.opacity = faded;
    }
    status = hl_scene_create(host->context, &description, &made, &error);
    if (status != HL_OK) *exit_code = host_fail(host, PHASE_CHANGE, status, &error);
  } else {
    *exit_code = fail(EXIT_CODE_FAILURE, "out of memory for a frame's scene");
  }
  free(faded);
  free(volumes);
  free(lights);
  return made;
}

/* ---- a scene without files ---- */

enum { BUILT_IN_SIDE = 128, BALLS = 24 };

/* The value that a ball gives the voxel at p: 255 inside, falling to 0 over three voxels. */
static double ball(const double p[3], const double centre[3], double radius) {
  double d[3] = {p[0] - centre[0], p[1] - centre[1], p[2] - centre[2]};
  double inside = radius - sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  return fmax(0, fmin(255, 127.5 + 85 * inside));
}

/* Balls along a knotted line. */
static void fill_built_in(unsigned char *voxels) {
  double centre[BALLS][3], radius[BALLS];
  for (int i = 0; i < BALLS; i++) {
    double t = turn * i / BALLS;
    centre[i][0] = BUILT_IN_SIDE * (0.5 + 0.13 * (hl_sin(t) + 2 * hl_sin(2 * t)));
    centre[i][1] = BUILT_IN_SIDE * (0.5 + 0.13 * (hl_cos(t) - 2 * hl_cos(2 * t)));
    centre[i][2] = BUILT_IN_SIDE * (0.5 - 0.3 * hl_sin(3 * t));
    radius[i] = BUILT_IN_SIDE * (0.05 + 0.02 * hl_sin(5 * t));
  }
  for (size_t at = 0; at < (size_t)BUILT_IN_SIDE * BUILT_IN_SIDE * BUILT_IN_SIDE; at++) {
    double p[3] = {(double)(at % BUILT_IN_SIDE), (double)(at / BUILT_IN_SIDE % BUILT_IN_SIDE),
                   (double)(at / BUILT_IN_SIDE / BUILT_IN_SIDE)};
    double value = 0;
    for (int i = 0; i < BALLS; i++) value = fmax(value, ball(p, centre[i], radius[i]));
    voxels[at] = (unsigned char)value;
  }
}

hl_status bench_scene_built_in(hl_context *context, hl_scene **scene, hl_error *error) {
  hl_volume_description description;
  hl_volume_description_defaults(&description);
  unsigned char *voxels = malloc((size_t)BUILT_IN_SIDE * BUILT_IN_SIDE * BUILT_IN_SIDE);
  if (voxels == NULL) return HL_ERROR_MEMORY;
  fill_built_in(voxels);
  for (int a = 0; a < 3; a++) description.dimensions[a] = BUILT_IN_SIDE;
  description.type = HL_VOXEL_U8;
  description.voxels = voxels;
  hl_volume *volume = NULL;
  hl_status status = hl_volume_create(context, &description, &volume, error);
  if (status == HL_OK) status = hl_scene_for_volume(context, volume, NULL, scene, error);
  hl_volume_release(volume);
  free(voxels);
  return status;
}
