/* analytic/even_light.c - light on a floor or a ball that nothing shades is smooth. Each pixel is compared
 * with the mean of the square of pixels around it, and the difference must be small, because eyes notice
 * lines first. The light's own bend within such a square is far below the bars. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include <halflight/halflight.h>

enum { SIDE = 200, REACH = 4, INSIDE = 10 };

static float pixels[SIDE * SIDE * 4];

/* The scene is a floor that fills the middle of the picture, or a ball. */
#define FLOOR "{\"shapes\": [{\"type\": \"box\", \"size\": [420, 420, 12]}], \"voxel_size\": 2, " MATERIAL "}"
#define BALL  "{\"shapes\": [{\"type\": \"sphere\", \"radius\": 45}], \"voxel_size\": 1, " MATERIAL "}"
#define MATERIAL                                                                                   \
  "\"transfer_function\": {\"color\": [1, 1, 1]}, \"material\": {\"ambient\": 0, \"diffuse\": 1, " \
  "\"specular\": 0}"

static void render(const char *volume, const char *light, const char *camera, const char *settings) {
  char text[2000];
  snprintf(text, sizeof text,
           "{\"halflight\": 1, \"image\": {\"width\": %d, \"height\": %d}, \"ambient\": [0, 0, 0], "
           "\"camera\": {%s}, "
           "\"lights\": [{%s}], \"volumes\": [%s], \"render\": {%s}}",
           SIDE, SIDE, camera, light, volume, settings);
  hl_context *context = NULL;
  hl_scene *scene = NULL;
  hl_renderer *renderer = NULL;
  hl_error error = {0};
  if (hl_context_create(NULL, &context, &error) != HL_OK ||
      hl_scene_from_json(context, text, strlen(text), NULL, "scene", &scene, &error) != HL_OK ||
      hl_renderer_create(context, &renderer, &error) != HL_OK ||
      hl_renderer_render(renderer, scene, pixels, 4 * SIDE, NULL, &error) != HL_OK)
    fail_msg("%s", error.message);
  hl_renderer_destroy(renderer);
  hl_scene_release(scene);
  hl_context_destroy(context);
}

/* Returns whether all pixels of the square around a pixel are opaque. */
static int is_inside(int x, int y) {
  for (int v = y - INSIDE; v <= y + INSIDE; v += INSIDE)
    for (int u = x - INSIDE; u <= x + INSIDE; u += INSIDE)
      if (u < 0 || v < 0 || u >= SIDE || v >= SIDE || pixels[4 * (v * SIDE + u) + 3] < 0.99f) return 0;
  return 1;
}

static double mean_around(int x, int y) {
  double sum = 0;
  for (int v = y - REACH; v <= y + REACH; v++)
    for (int u = x - REACH; u <= x + REACH; u++) sum += pixels[4 * (v * SIDE + u)];
  return sum / ((2 * REACH + 1) * (2 * REACH + 1));
}

static int greater_first(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x < y) - (x > y);
}

/* Returns the difference that one pixel in a thousand exceeds. The difference is between a pixel and the mean
 * of the pixels around it, divided by the pixel's brightness or by half of the brightest surroundings,
 * whichever is greater. */
static double ripple(void) {
  static double differences[SIDE * SIDE], means[SIDE * SIDE];
  size_t count = 0;
  double brightest = 0;
  for (int y = 0; y < SIDE; y++)
    for (int x = 0; x < SIDE; x++) {
      if (!is_inside(x, y)) continue;
      means[count] = mean_around(x, y);
      differences[count] = fabs(pixels[4 * (y * SIDE + x)] - means[count]);
      brightest = fmax(brightest, means[count++]);
    }
  assert_true(count > SIDE * SIDE / 5);
  assert_true(brightest > 0.02);
  for (size_t i = 0; i < count; i++) differences[i] /= fmax(means[i], brightest / 2);
  qsort(differences, count, sizeof differences[0], greater_first);
  return differences[count / 1000];
}

static void assert_even(const char *what, double bar) {
  double greatest = ripple();
  if (getenv("HALFLIGHT_SHOW") != NULL) printf("# %s: %.4f\n", what, greatest);
  if (!(greatest <= bar))
    fail_msg("%s: one pixel in a thousand differs by more than %.4f of its surroundings", what, greatest);
}

/* A setting of shadows: its name, the bars for floors in far and near light and for balls, and the number of
 * steps from one direction that is tried to the next one. */
static const char *hard[] = {"\"shadows\": \"hard\"", "hard", "0.001", "0.003", "0.007", "1"};
static const char *cascade[] = {"\"soft_method\": \"cascade\"", "cascade", "0.005", "0.005", "0.0095", "1"};

static const char *const CAMERA =
    "\"position\": [300, -420, 500], \"target\": [0, 0, 0], \"up\": [0, 0, 1], \"fovy_deg\": 22";

/* Thirty directions of light, of which a setting may skip some. Every point of the light is at least 10
 * degrees above the floor, and the light's middle is 25 to 85 degrees above the floor. */
static void test_floors_under_directional_light(void **state) {
  const char *const *method = *state;
  for (int i = 0; i < 30; i += atoi(method[5])) {
    double elevation = (25 + 2 * i) * 3.14159265358979 / 180, azimuth = 2.4 * i;
    double size = i % 3 == 0 ? 5 : i % 3 == 1 ? 15 : 30;
    char light[200], settings[200], what[100];
    snprintf(light, sizeof light,
             "\"type\": \"directional\", \"direction\": [%.6f, %.6f, %.6f], \"angular_diameter_deg\": %g",
             -cos(elevation) * cos(azimuth), -cos(elevation) * sin(azimuth), -sin(elevation), size);
    snprintf(settings, sizeof settings, "%s, \"sheet_spacing\": %g, \"threads\": 2", method[0],
             i % 2 ? 1.0 : 0.5);
    snprintf(what, sizeof what, "%s, light %d", method[1], i);
    render(FLOOR, light, CAMERA, settings);
    assert_even(what, atof(method[2]));
  }
}

static void test_floors_under_near_lights(void **state) {
  static const char *const lights[] = {
      "\"type\": \"rect\", \"position\": [0, 0, 190], \"edge1\": [80, 0, 0], \"edge2\": [0, 80, 0]",
      "\"type\": \"rect\", \"position\": [0, 0, 400], \"edge1\": [160, 0, 0], \"edge2\": [0, 160, 0]",
      "\"type\": \"disk\", \"position\": [0, 0, 190], \"normal\": [0, 0, -1], \"radius\": 45",
      "\"type\": \"point\", \"position\": [0, 0, 190], \"radius\": 45",
      "\"type\": \"point\", \"position\": [0, 60, 120], \"radius\": 20"};
  const char *const *method = *state;
  for (size_t i = 0; i < 2 * sizeof lights / sizeof lights[0]; i++) {
    char settings[200], what[100];
    snprintf(settings, sizeof settings, "%s, \"sheet_spacing\": %g, \"threads\": 2", method[0],
             i % 2 ? 1.0 : 0.5);
    snprintf(what, sizeof what, "%s, light %zu, spacing %g", method[1], i / 2, i % 2 ? 1.0 : 0.5);
    render(FLOOR, lights[i / 2], CAMERA, settings);
    assert_even(what, atof(method[3]));
  }
}

/* Returns the root mean square difference between a box on a floor under a soft light and the same scene
 * under 8 x 8 sub-lights, as a fraction of the brightest pixel. */
static double box_error(const char *light) {
  static const char volume[] =
      "{\"shapes\": [{\"type\": \"box\", \"size\": [420, 420, 12]}, {\"type\": \"box\", \"size\": [60, 60, "
      "60], "
      "\"position\": [0, 0, 36]}], \"voxel_size\": 2, " MATERIAL "}";
  static float truth[SIDE * SIDE * 4];
  render(volume, light, CAMERA,
         "\"soft_method\": \"sublights\", \"light_samples\": 8, \"sheet_spacing\": 1, \"threads\": 2");
  memcpy(truth, pixels, sizeof truth);
  render(volume, light, CAMERA, "\"soft_method\": \"cascade\", \"sheet_spacing\": 1, \"threads\": 2");
  double squares = 0, brightest = 0;
  for (size_t i = 0; i < sizeof pixels / sizeof *pixels; i += 4) {
    squares += (pixels[i] - truth[i]) * (pixels[i] - truth[i]);
    brightest = fmax(brightest, truth[i]);
  }
  return sqrt(squares / (SIDE * SIDE)) / brightest;
}

/* The penumbrae of near lights lie where sub-lights have them, and umbrae are nearly black. The first light
 * is wide, and one sweep serves it. The second light is nearer, and is cut into sectors. */
static void test_box_under_near_lights(void **state) {
  (void)state;
  double wide = box_error(
             "\"type\": \"rect\", \"position\": [-60, 0, 190], \"edge1\": [80, 0, 0], \"edge2\": [0, 80, 0]"),
         in_sectors = box_error("\"type\": \"point\", \"position\": [0, 90, 120], \"radius\": 20");
  if (getenv("HALFLIGHT_SHOW") != NULL) printf("# box under near lights: %.4f, %.4f\n", wide, in_sectors);
  assert_true(wide < 0.015);
  assert_true(in_sectors < 0.009);
}

/* If a light comes nearer by small steps, the picture changes by small steps. At 228.197 above the floor, the
 * sheets of the half-way vector cease to serve all of the light's rays; the picture must not jump there. */
static void test_near_light_moves_evenly(void **state) {
  static float before[SIDE * SIDE * 4];
  double change[3] = {0, 0, 0};
  (void)state;
  for (int step = 0; step < 3; step++) {
    char light[200];
    snprintf(light, sizeof light,
             "\"type\": \"rect\", \"position\": [0, 0, %.3f], \"edge1\": [40, 0, 0], \"edge2\": [0, 40, 0]",
             228.2045 - 0.015 * step);
    render(FLOOR, light, CAMERA, "\"soft_method\": \"cascade\", \"sheet_spacing\": 1, \"threads\": 2");
    for (size_t i = 0; i < sizeof pixels / sizeof *pixels && step > 0; i++)
      change[step] = fmax(change[step], fabs(pixels[i] - before[i]));
    memcpy(before, pixels, sizeof before);
  }
  if (getenv("HALFLIGHT_SHOW") != NULL) printf("# moved light: %.5f, %.5f\n", change[1], change[2]);
  assert_true(change[1] < 2 * change[2] + 0.001);
}

static void assert_even_ball(const char *const *method, double size, double spacing, double bar) {
  char light[200], settings[200], what[100];
  snprintf(light, sizeof light,
           "\"type\": \"directional\", \"direction\": [-0.5, 0.55, -0.5], \"angular_diameter_deg\": %g",
           size);
  snprintf(settings, sizeof settings, "%s, \"sheet_spacing\": %g, \"threads\": 2", method[0], spacing);
  snprintf(what, sizeof what, "%s, a ball under %g degrees, spacing %g", method[1], size, spacing);
  render(BALL, light,
         "\"position\": [90, -160, 90], \"target\": [0, 0, 0], \"up\": [0, 0, 1], \"fovy_deg\": 20",
         settings);
  assert_even(what, bar);
}

/* Light on a ball has no rings. */
static void test_balls(void **state) {
  static const double sizes[] = {5, 20, 40};
  const char *const *method = *state;
  for (size_t i = 0; i < 2 * sizeof sizes / sizeof sizes[0]; i++)
    assert_even_ball(method, sizes[i / 2], i % 2 ? 1.0 : 0.5, atof(method[4]));
}

/* Under light from half of the sky, the cascade's rings are faint. */
static void test_balls_under_wide_lights(void **state) {
  static const double sizes[] = {60, 90, 120};
  (void)state;
  for (size_t i = 0; i < 2 * sizeof sizes / sizeof sizes[0]; i++)
    assert_even_ball(cascade, sizes[i / 2], i % 2 ? 1.0 : 0.5, 0.013);
}

static const char *coarse[] = {"\"soft_method\": \"cascade\", \"shadow_resolution\": 300",
                               "cascade, coarse",
                               "0.005",
                               "0.007",
                               "0.0095",
                               "3"};
static const char *sublights[] = {
    "\"soft_method\": \"sublights\"", "sub-lights", "0.015", "0.008", "0.014", "3"};

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test_prestate(test_floors_under_directional_light, hard),
      cmocka_unit_test_prestate(test_floors_under_near_lights, hard),
      cmocka_unit_test_prestate(test_balls, hard),
      cmocka_unit_test(test_box_under_near_lights),
      cmocka_unit_test(test_near_light_moves_evenly),
      cmocka_unit_test_prestate(test_floors_under_directional_light, cascade),
      cmocka_unit_test_prestate(test_floors_under_near_lights, cascade),
      cmocka_unit_test_prestate(test_balls, cascade),
      cmocka_unit_test(test_balls_under_wide_lights),
      cmocka_unit_test_prestate(test_floors_under_directional_light, coarse),
      cmocka_unit_test_prestate(test_balls, coarse),
      cmocka_unit_test_prestate(test_floors_under_directional_light, sublights),
      cmocka_unit_test_prestate(test_floors_under_near_lights, sublights),
      cmocka_unit_test_prestate(test_balls, sublights),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
