/* analytic/example_lights.c - the example scenes with projected images and beams, against closed forms. Each
 * scene is read from examples/. Only the volumes that a measurement needs are kept. The measurement sets the
 * camera and turns ambient light off. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <jansson.h>

#include <halflight/halflight.h>

#include "../asserts.h"
#include "core/vector.h"

enum { MOST_SIDE = 512 };

typedef struct example {
  hl_context *context;
  /* the scene of `loaded`, of which the tests change the camera, the size and the lights */
  hl_scene_description scene;
  hl_scene *loaded;
  hl_light lights[4];
  float pixels[MOST_SIDE * MOST_SIDE * 4];
} example;

static example shared;

/* Reads a scene and keeps only the named volumes. names: ends with a null pointer. */
static example *open_example(const char *name, const char *const *keep) {
  char path[600];
  json_error_t fault;
  hl_error error = {0};
  example *made = &shared;
  snprintf(path, sizeof path, "%s/examples/%s", HALFLIGHT_SOURCE, name);
  json_t *root = json_load_file(path, 0, &fault), *volumes = json_object_get(root, "volumes");
  if (root == NULL) fail_msg("%s:%d: %s", path, fault.line, fault.text);
  for (size_t v = json_array_size(volumes); v-- > 0;) {
    const char *own = json_string_value(json_object_get(json_array_get(volumes, v), "name"));
    bool kept = false;
    for (int k = 0; keep[k] != NULL; k++) kept = kept || strcmp(own, keep[k]) == 0;
    if (!kept) json_array_remove(volumes, v);
  }
  char *text = json_dumps(root, 0);
  snprintf(path, sizeof path, "%s/examples", HALFLIGHT_SOURCE);
  assert_int_equal(hl_context_create(NULL, &made->context, NULL), HL_OK);
  if (hl_scene_from_json(made->context, text, strlen(text), path, name, &made->loaded, &error) != HL_OK)
    fail_msg("%s", error.message);
  free(text);
  json_decref(root);
  made->scene = *hl_scene_describe(made->loaded);
  assert_true(made->scene.light_count <= 4);
  memcpy(made->lights, made->scene.lights, made->scene.light_count * sizeof *made->lights);
  made->scene.lights = made->lights;
  memset(made->scene.ambient, 0, sizeof made->scene.ambient);
  return made;
}

static void close_example(example *open) {
  hl_scene_release(open->loaded);
  hl_context_destroy(open->context);
}

/* Sets an orthographic camera that looks along a direction. target: the point in the picture's middle.
 * height: of the picture, in world units. */
static void look_along(example *open, vec3 direction, vec3 target, double height) {
  hl_camera *camera = &open->scene.camera;
  vec3 eye = vec3_subtract(target, vec3_scale(vec3_normalise(direction), 900));
  *camera = (hl_camera){.type = HL_CAMERA_ORTHOGRAPHIC,
                        .position = {eye.x, eye.y, eye.z},
                        .target = {target.x, target.y, target.z},
                        .up = {0, 0, 1},
                        .height = height,
                        .fovy_deg = 30};
  if (fabs(vec3_normalise(direction).z) > 0.9) camera->up[1] = 1, camera->up[2] = 0;
}

static void render(example *open, int side) {
  hl_error error = {0};
  hl_scene *scene = NULL;
  hl_renderer *renderer = NULL;
  open->scene.width = open->scene.height = side;
  if (hl_scene_create(open->context, &open->scene, &scene, &error) != HL_OK ||
      hl_renderer_create(open->context, &renderer, &error) != HL_OK ||
      hl_renderer_render(renderer, scene, open->pixels, 4 * (size_t)side, NULL, &error) != HL_OK)
    fail_msg("%s", error.message);
  hl_renderer_destroy(renderer);
  hl_scene_release(scene);
}

static vec3 camera_axes(const hl_camera *camera, vec3 *right, vec3 *up) {
  vec3 forward = vec3_normalise(vec3_subtract(vec3_of(camera->target), vec3_of(camera->position)));
  *right = vec3_normalise(vec3_cross(forward, vec3_of(camera->up)));
  *up = vec3_cross(*right, forward);
  return forward;
}

/* Computes the continuous pixel coordinates of a point. Pixel i covers the range from i to i + 1. */
static void project(const example *open, vec3 point, double uv[2]) {
  const hl_camera *camera = &open->scene.camera;
  vec3 right, up, forward = camera_axes(camera, &right, &up),
                  offset = vec3_subtract(point, vec3_of(camera->position));
  double scale = open->scene.height / camera->height;
  if (camera->type == HL_CAMERA_PERSPECTIVE)
    scale = open->scene.height / (2 * tan(camera->fovy_deg * HL_PI / 360) * vec3_dot(offset, forward));
  uv[0] = open->scene.width / 2.0 + scale * vec3_dot(offset, right);
  uv[1] = open->scene.height / 2.0 - scale * vec3_dot(offset, up);
}

/* Returns the picture's brightness at continuous pixel coordinates, interpolated linearly between the middles
 * of pixels. */
static double brightness(const example *open, double u, double v, int channel) {
  int x = (int)floor(u - 0.5), y = (int)floor(v - 0.5), width = open->scene.width;
  double fx = u - 0.5 - x, fy = v - 0.5 - y;
  const float *a = &open->pixels[4 * (y * width + x) + channel], *b = a + 4 * width;
  return (1 - fy) * ((1 - fx) * (double)a[0] + fx * (double)a[4]) +
         fy * ((1 - fx) * (double)b[0] + fx * (double)b[4]);
}

static double brightness_at(const example *open, vec3 point, int channel) {
  double uv[2];
  project(open, point, uv);
  return brightness(open, uv[0], uv[1], channel);
}

/* ---- beams through boxes (figs. 12 and 13) ---- */

/* Compares the brightness at two points of a beam's axis, well inside the medium. The two brightnesses are
 * equal if the medium absorbs nothing; otherwise their ratio is exp(-sigma way). */
static void check_beam(example *open, vec3 entry, vec3 exit, int channel, double opacity) {
  double way = vec3_length(vec3_subtract(exit, entry)), sigma = -log(1 - opacity);
  for (int shadows = HL_SHADOWS_OFF; shadows <= HL_SHADOWS_HARD; shadows++) {
    open->lights[0].shadows = (hl_shadows)shadows;
    render(open, 256);
    double first = brightness_at(open, entry, channel), last = brightness_at(open, exit, channel);
    double expected = shadows == HL_SHADOWS_OFF ? 1 : exp(-sigma * way);
    assert_true(first > 0.1);
    assert_near(last / first, expected, 0.01 * expected);
    for (int c = 0; c < 3; c++)
      if (open->lights[0].texture.width == 96 && c != channel)
        assert_near(brightness_at(open, entry, c), 0, 1e-4);
  }
}

static void test_cube_beams(void **state) {
  (void)state;
  static const char *const cube[] = {"cube", NULL};
  vec3 light = {-0.8, 0, -0.6}, across = {-0.6, 0, 0.8};
  for (int beam = 0; beam < 3; beam++) {
    example *open = open_example(beam == 0 ? "fig12-cube-beams-a.json" : "fig12-cube-beams-b.json", cube);
    look_along(open, (vec3){0, 1, 0}, (vec3){0, 0, 0}, 130);
    /* The middles of the beams are 36 apart. The two outer beams go through less of the cube, so that their
     * points are nearer to each other. */
    vec3 middle = vec3_scale(across, 36.0 * (1 - beam));
    double half = 36;
    if (beam != 1) middle = vec3_add(middle, vec3_scale(light, beam == 0 ? 10 : -10)), half = 20;
    check_beam(open, vec3_add(middle, vec3_scale(light, -half)), vec3_add(middle, vec3_scale(light, half)),
               beam, 0.012);
    close_example(open);
  }
}

static void test_slanted_parallelepiped(void **state) {
  (void)state;
  static const char *const box[] = {"box", NULL};
  example *open = open_example("fig13-parallelepiped-b.json", box);
  look_along(open, (vec3){0, 1, 0}, (vec3){0, 0, 0}, 150);
  /* the distance from the beam's middle at which it enters and leaves the medium */
  double faces = 40 / cos(35 * HL_PI / 180);
  for (int line = -1; line <= 1; line++) {
    double shift = 10 * line * tan(35 * HL_PI / 180);
    check_beam(open, (vec3){-faces + shift + 6, 0, 10.0 * line}, (vec3){faces + shift - 6, 0, 10.0 * line}, 0,
               0.025);
  }
  close_example(open);
}

/* ---- the grid (fig. 11) ---- */

/* The test walks on a plane through the data, half way between two lines of one family of the projected grid,
 * and counts the lines of the other family. */
static void test_grid_period(void **state) {
  (void)state;
  enum { STEPS = 4000 };
  static const char *const data[] = {"hipip", NULL};
  example *open = open_example("fig11-hipip-grid.json", data);
  hl_scene_volume plane = open->scene.volumes[0];
  hl_volume_description description;
  hl_error error = {0};
  float *ones = malloc(64 * 64 * 2 * sizeof *ones);
  for (int i = 0; i < 64 * 64 * 2; i++) ones[i] = 1;
  hl_volume_description_defaults(&description);
  description.dimensions[0] = description.dimensions[1] = 64;
  description.dimensions[2] = 2;
  description.origin[2] = 30;
  description.type = HL_VOXEL_F32;
  description.voxels = ones;
  hl_opacity_point opacity = {0, 0.9999};
  hl_color_point white = {0, {1, 1, 1}};
  plane.transfer_function = (hl_transfer_function){
      .unit_distance = 0.01, .opacity = &opacity, .opacity_count = 1, .color = &white, .color_count = 1};
  plane.shading = HL_SHADING_NONE;
  plane.casts_shadow = 0;
  if (hl_volume_create(open->context, &description, &plane.volume, &error) != HL_OK)
    fail_msg("%s", error.message);
  open->scene.volumes = &plane;
  look_along(open, (vec3){0, 0, -1}, (vec3){31.5, 31.5, 31.5}, 70);
  render(open, MOST_SIDE);
  const hl_light_texture *texture = &open->lights[0].texture;
  vec3 right = vec3_of(texture->screen_right), up = vec3_of(texture->screen_up);
  vec3 way = vec3_normalise(vec3_of(open->lights[0].direction)), normal = vec3_cross(right, up);
  for (int family = 0; family < 2; family++) {
    vec3 along = family == 0 ? right : up, other = family == 0 ? up : right;
    /* On the plane z = 31.5, the volume's upper face, the image's coordinate is a linear function of x and y;
     * these are its slopes. */
    double slope[2], other_slope[2];
    for (int axis = 0; axis < 2; axis++) {
      vec3 step = {axis == 0, axis == 1, 0};
      vec3 on_screen = vec3_subtract(step, vec3_scale(way, vec3_dot(normal, step) / vec3_dot(normal, way)));
      slope[axis] = vec3_dot(on_screen, along) / vec3_dot(along, along);
      other_slope[axis] = vec3_dot(on_screen, other) / vec3_dot(other, other);
    }
    vec3 walk = vec3_normalise((vec3){other_slope[1], -other_slope[0], 0});
    double period = 2.0 / 16 / fabs(walk.x * slope[0] + walk.y * slope[1]);
    /* The walk must start between two lines of the other family. Starts over one period of the lines are
     * tried, and the darkest walk is taken. */
    vec3 side = {-walk.y, walk.x, 0};
    double best = INFINITY, found = 0;
    for (int start = 0; start < 24; start++) {
      double other_period = 2.0 / 16 / fabs(side.x * other_slope[0] + side.y * other_slope[1]);
      double sum = 0, first = NAN, last = NAN, before = 0, level = 0.5 * 1.8;
      int lines = 0;
      for (int i = 0; i < STEPS; i++) {
        double t = -28 + 56.0 * i / STEPS, s = other_period * (start / 24.0 - 0.5);
        vec3 point = {31.5 + walk.x * t + side.x * s, 31.5 + walk.y * t + side.y * s, 31.5};
        if (fabs(point.x - 31.5) > 30 || fabs(point.y - 31.5) > 30) continue;
        double here = brightness_at(open, point, 0);
        sum += here;
        if (before > 0 && before < level && here >= level) {
          if (isnan(first)) first = t;
          else lines++;
          last = t;
        }
        before = here;
      }
      if (sum < best && lines > 2) best = sum, found = (last - first) / lines;
    }
    print_message("# grid: period %.4f, expected %.4f\n", found, period);
    assert_near(found / period, 1, 0.01);
  }
  open->scene.volumes = hl_scene_describe(open->loaded)->volumes;
  hl_volume_release(plane.volume);
  free(ones);
  close_example(open);
}

/* ---- the projector (fig. 10) ---- */

/* Returns the coordinate, in continuous pixels, at which the brightness passes half of the lit place's
 * brightness on the way from a dark place to the lit place. */
static double crossing(const example *open, const double dark[2], const double lit[2], int axis) {
  double full = brightness(open, lit[0], lit[1], 2), before = 0;
  for (int i = 0; i <= 200; i++) {
    double u = dark[0] + (lit[0] - dark[0]) * i / 200, v = dark[1] + (lit[1] - dark[1]) * i / 200;
    double here = brightness(open, u, v, 2);
    if (i > 0 && before < full / 2 && here >= full / 2) return axis == 0 ? u : v;
    before = here;
  }
  fail_msg("no edge between (%g, %g) and (%g, %g)", dark[0], dark[1], lit[0], lit[1]);
  return 0;
}

/* Projects the image's corners from the light onto the wall y = 80. Two edges of the picture must cross at
 * each of these points. */
static void test_logo_corners(void **state) {
  (void)state;
  static const char *const room[] = {"room", NULL};
  example *open = open_example("fig10-room-logo.json", room);
  open->scene.light_count = 1;
  render(open, MOST_SIDE);
  const hl_light *light = &open->lights[0];
  vec3 position = vec3_of(light->position), uv[4];
  double worst = 0;
  for (int corner = 0; corner < 4; corner++) {
    vec3 at = vec3_add(vec3_of(light->texture.screen_center),
                       vec3_add(vec3_scale(vec3_of(light->texture.screen_right), corner & 1 ? 1 : -1),
                                vec3_scale(vec3_of(light->texture.screen_up), corner & 2 ? 1 : -1)));
    vec3 way = vec3_subtract(at, position);
    double pixel[2];
    project(open, vec3_add(position, vec3_scale(way, (80 - position.y) / way.y)), pixel);
    uv[corner] = (vec3){pixel[0], pixel[1], 0};
  }
  for (int corner = 0; corner < 4; corner++) {
    vec3 here = uv[corner], beside = uv[corner ^ 1], above = uv[corner ^ 2];
    for (int axis = 0; axis < 2; axis++) {
      /* The way from dark to lit crosses one of the image's edges at 2 % of that edge's length from the
       * corner, where the image's corner marks lie. */
      vec3 along = axis == 0 ? above : beside, inwards = axis == 0 ? beside : above;
      vec3 edge = vec3_add(here, vec3_scale(vec3_subtract(along, here), 0.02));
      vec3 step = vec3_scale(vec3_subtract(inwards, here), 0.025);
      const double dark[2] = {edge.x - step.x, edge.y - step.y}, lit[2] = {edge.x + step.x, edge.y + step.y};
      double found = crossing(open, dark, lit, axis), expected = axis == 0 ? edge.x : edge.y;
      worst = fmax(worst, fabs(found - expected));
    }
  }
  print_message("# corners: at most %.3f pixels off\n", worst);
  assert_near(worst, 0, 1);
  close_example(open);
}

/* ---- window light (fig. 8) ---- */

/* Returns whether the sun reaches a point through the light's screen. If there is a wall, the light must also
 * pass one of the wall's four panes, which are 34 wide and reach from 105 to 115. */
static bool lit_by_window(vec3 point, vec3 way, bool walled) {
  double t = (point.y - 110) / way.y;
  if (fabs(point.x - way.x * t - 30) > 46 || fabs(point.z - way.z * t - 105) > 46) return false;
  for (int face = 0; face < 2 && walled; face++) {
    t = (point.y - (face == 0 ? 105 : 115)) / way.y;
    double x = fabs(fabs(point.x - way.x * t - 30) - 20), z = fabs(fabs(point.z - way.z * t - 105) - 20);
    if (x > 17 || z > 17) return false;
  }
  return true;
}

/* The light that the haze scatters once towards the eye: the integral of sigma exp(-sigma s) I exp(-sigma d)
 * over the part of a ray within the beam. s: the distance along the ray. d: the length of the sunlight's path
 * in the haze. */
static double beam_towards_eye(const example *open, vec3 start, vec3 direction, bool walled) {
  vec3 way = vec3_normalise(vec3_of(open->lights[0].direction));
  double sigma = -log(1 - 0.0016), sum = 0, step = 0.1, haze = fmax((-210 - start.y) / direction.y, 0);
  for (double s = haze; start.y + s * direction.y < 105; s += step) {
    vec3 point = vec3_add(start, vec3_scale(direction, s));
    if (!lit_by_window(point, way, walled)) continue;
    double in_haze = (110 - point.y) / -way.y;
    sum += sigma * exp(-sigma * (s - haze)) * exp(-sigma * in_haze) * step;
  }
  return sum * open->lights[0].intensity * open->lights[0].color[0];
}

/* Compares the pixels whose rays cross the beam and end on the wall beside the window, where the wall is
 * dark. */
static double haze_column(const char *const *kept, bool walled, double *worst) {
  enum { SIDE = 192 };
  example *open = open_example("fig08-room.json", kept);
  render(open, SIDE);
  double sum = 0, expected_sum = 0;
  vec3 right, up, forward = camera_axes(&open->scene.camera, &right, &up),
                  eye = vec3_of(open->scene.camera.position);
  int count = 0;
  *worst = 0;
  for (int y = 70; y < 150; y += 4)
    for (int x = 30; x < 120; x += 4) {
      double half = tan(open->scene.camera.fovy_deg * HL_PI / 360), u = 2 * (x + 0.5) / SIDE - 1,
             v = 1 - 2 * (y + 0.5) / SIDE;
      vec3 direction = vec3_normalise(
          vec3_add(forward, vec3_add(vec3_scale(right, u * half), vec3_scale(up, v * half))));
      vec3 wall = vec3_add(eye, vec3_scale(direction, (105 - eye.y) / direction.y));
      if (fabs(wall.x - 30) < 45 && fabs(wall.z - 105) < 45) continue;
      double expected = beam_towards_eye(open, eye, direction, walled),
             found = (double)open->pixels[4 * (y * SIDE + x)];
      if (expected < 0.05) continue; /* the ray passes beside the beam */
      sum += found;
      expected_sum += expected;
      *worst = fmax(*worst, fabs(found - expected));
      count++;
    }
  print_message("# haze column, %s: %d rays, sum %.4f of the closed form's, mean %.4f, worst ray %.4f off\n",
                walled ? "through the window" : "through the light screen", count, sum / expected_sum,
                expected_sum / count, *worst);
  assert_in_range(count, 200, 10000);
  close_example(open);
  return sum / expected_sum;
}

/* The corners of the window's frame are as sharp as voxels of 1.5 units allow. Their outlines are rounded by
 * a third of a voxel, and the slanting sunlight passes two corners. */
static void test_haze_column(void **state) {
  (void)state;
  static const char *const haze[] = {"haze", NULL}, *const room[] = {"haze", "walls", NULL};
  double worst;
  assert_near(haze_column(haze, false, &worst), 1, 0.01);
  assert_near(worst, 0, 0.02);
  assert_near(haze_column(room, true, &worst), 1, 0.08);
}

/* ---- the hole (fig. 23) ---- */

/* Measures the sum and the variance, in world units, of a row of the picture that crosses the beam at a
 * height. */
static void measure_row(const example *open, double height, double *sum, double *variance) {
  double mean = 0, square = 0, pitch = open->scene.camera.height / open->scene.height;
  int side = open->scene.width, y = (int)(side / 2 - height / pitch);
  *sum = 0;
  for (int x = side / 10; x < side - side / 10; x++) { /* this part of the row lies between the box's sides */
    double at = (x + 0.5) * pitch, here = (double)open->pixels[4 * (y * side + x)];
    *sum += here;
    mean += here * at;
    square += here * at * at;
  }
  *variance = square / *sum - mean / *sum * (mean / *sum);
}

/* Along the beam, the sum of a row falls by exp(-sigma way). The variance of its profile grows by the
 * variance of the light's disk: D^2 / 16, where D = 2 tan(angle / 2) times the distance from the hole, longer
 * by the light's tilt. The sum and the variance are tested in a box that absorbs light, and in a box of
 * matter so thin that the box absorbs nothing. */
static void test_beam_through_a_hole(void **state) {
  (void)state;
  static const char *const kept[] = {"occluder", "box", NULL};
  const double height[2] = {60, -55};
  example *open = open_example("fig23-hole.json", kept);
  look_along(open, (vec3){0, 1, 0}, (vec3){0, 0, 0}, 150);
  hl_scene_volume volumes[2] = {open->scene.volumes[0], open->scene.volumes[1]};
  open->scene.volumes = volumes;
  double sum[2], variance[2], distance[2], grown[2];
  vec3 way = vec3_normalise(vec3_of(open->lights[0].direction));
  double sigma = -log(1 - 0.01), spread = 2 * tan(open->lights[0].angular_diameter_deg * HL_PI / 360);
  for (int thin = 0; thin < 2; thin++) {
    if (thin) volumes[1].transfer_function.unit_distance = 1e4;
    render(open, 300);
    for (int i = 0; i < 2; i++) {
      measure_row(open, height[i], &sum[i], &variance[i]);
      distance[i] = (125 - height[i]) / -way.z;
    }
    grown[thin] = variance[1] - variance[0];
    double passed = thin ? 1 : exp(-sigma * (distance[1] - distance[0]));
    print_message("# hole, %s: light %.4f of %.4f\n", thin ? "thin box" : "box", sum[1] / sum[0], passed);
    assert_near(sum[1] / sum[0] / passed, 1, 0.05);
  }
  double expected = spread * spread / 16 * (distance[1] * distance[1] - distance[0] * distance[0]) /
                    (way.z * way.z);
  print_message("# hole: variance grows by %.2f (in the box %.2f) of %.2f\n", grown[1], grown[0], expected);
  for (int thin = 0; thin < 2; thin++) assert_near(sqrt(grown[thin] / expected), 1, 0.05);
  close_example(open);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_cube_beams),  cmocka_unit_test(test_slanted_parallelepiped),
      cmocka_unit_test(test_grid_period), cmocka_unit_test(test_logo_corners),
      cmocka_unit_test(test_haze_column), cmocka_unit_test(test_beam_through_a_hole),
  };
  return cmocka_run_group_tests_name("example_lights", tests, NULL, NULL);
}
