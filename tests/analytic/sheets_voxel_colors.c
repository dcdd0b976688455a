/* analytic/sheets_voxel_colors.c - volumes whose voxels have colours: the colour between voxels, in closed
 * form, and shadows. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/memory.h"
#include "reference_stage.h"
#include "volume/volume.h"

enum { SIDE = 24, PIXELS = SIDE * SIDE, N = 12 };

static unsigned next(unsigned *seed) { return (*seed = *seed * 1664525u + 1013904223u) >> 8; }

/* Gives a volume colours that are the same along z. The volume owns them. */
static void paint(stage *set, const hl_scene_volume *volume, const unsigned char colors[N][N][4]) {
  size_t slice = sizeof(unsigned char[N][N][4]), slices = volume->volume->dimension[2];
  unsigned char *all = hl_allocate(set->context, slices, slice);
  assert_non_null(all);
  for (size_t k = 0; k < slices; k++) memcpy(all + k * slice, colors, slice);
  volume->volume->colors = all;
}

static void random_colors(unsigned char colors[N][N][4], unsigned seed) {
  for (int n = 0; n < N * N * 4; n++) (&colors[0][0][0])[n] = (unsigned char)(next(&seed) % 256);
  for (int n = 0; n < N * N; n++) colors[n / N][n % N][3] |= 1;
}

static double linear_of(unsigned char code) {
  double c = code / 255.0;
  return c <= 0.04045 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4);
}

/* Returns the bilinear mean of the weighted linear colours, divided by the mean of the weights, at a point of
 * index space. */
static double expected_at(const unsigned char colors[N][N][4], double x, double y, int channel) {
  double sum = 0, weights = 0, px = fmin(fmax(x, 0), N - 1), py = fmin(fmax(y, 0), N - 1);
  for (int j = 0; j < N; j++)
    for (int i = 0; i < N; i++) {
      double weight = fmax(1 - fabs(px - i), 0) * fmax(1 - fabs(py - j), 0) * colors[j][i][3];
      weights += weight;
      sum += weight * linear_of(colors[j][i][channel]);
    }
  return sum / weights;
}

static hl_scene_volume *open_plate(stage *set) {
  stage_open(set);
  set->scene.width = set->scene.height = SIDE;
  set->scene.camera.height = N;
  hl_scene_volume *plate = stage_add_grid(set, (size_t[3]){N, N, 3}, (double[3]){1, 1, 1},
                                          (vec3){-N / 2.0, -N / 2.0, -1.5}, NULL);
  stage_set_opacity(set, plate, 0.6, 1);
  stage_look(set, (vec3){0, 0, 30}, (vec3){0, 0, 0}, (vec3){0, 1, 0});
  return plate;
}

static void render(stage *set, bool reference, float *pixels) {
  hl_reference_options options;
  hl_reference_options_defaults(&options);
  options.light_points = 16;
  if (reference) stage_render(set, &options, pixels);
  else stage_render_sheets(set, pixels);
}

/* A flat plate of random colours, seen along z. Each pixel shows the mean of linear colours at its place,
 * times the transfer function's colour. */
static void test_colors_between_voxels(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  static const double tint[3] = {1, 0.5, 0.25};
  unsigned char colors[N][N][4];
  for (int k = 0; k < 4; k++) {
    stage set;
    hl_scene_volume *plate = open_plate(&set);
    plate->shading = HL_SHADING_FLAT;
    random_colors(colors, 7 + (unsigned)k / 2);
    paint(&set, plate, (const unsigned char(*)[N][4])colors);
    stage_set_color(&set, plate, tint[0], tint[1], tint[2]);
    render(&set, k % 2 == 1, pixels);
    for (int i = 0; i < PIXELS; i++) {
      vec3 origin, direction;
      stage_eye_ray(&set, i % SIDE, i / SIDE, &origin, &direction);
      double x = origin.x + N / 2.0 - 0.5, y = origin.y + N / 2.0 - 0.5;
      assert_true(pixels[4 * i + 3] > 0.9f);
      for (int c = 0; c < 3; c++) {
        double seen = (double)(pixels[4 * i + c] / pixels[4 * i + 3]);
        double expected = tint[c] * expected_at((const unsigned char(*)[N][4])colors, x, y, c);
        if (fabs(seen - expected) > 1e-4)
          fail_msg("%d: pixel %d, channel %d: %g, not %g", k, i, c, seen, expected);
      }
    }
    stage_close(&set);
  }
}

/* Transparent voxels of another colour leave no fringe. Half way between a red voxel of the weight 255 and a
 * blue voxel of the weight 1, the fraction of blue is 1/256. */
static void test_no_fringe(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  unsigned char colors[N][N][4];
  float voxels[3][N][N];
  for (int n = 0; n < N * N; n++) {
    bool inside = n % N < N / 2;
    memcpy(colors[n / N][n % N], inside ? "\xff\0\0\xff" : "\0\0\xff\1", 4);
    for (int k = 0; k < 3; k++) voxels[k][n / N][n % N] = inside ? 1 : 0;
  }
  static const hl_opacity_point ramp[] = {{0, 0}, {1, 0.9}};
  stage set;
  open_plate(&set);
  hl_volume_release(set.volumes[0].volume);
  set.scene.volume_count = 0;
  hl_scene_volume *plate = stage_add_grid(&set, (size_t[3]){N, N, 3}, (double[3]){1, 1, 1},
                                          (vec3){-N / 2.0, -N / 2.0, -1.5}, &voxels[0][0][0]);
  plate->transfer_function.opacity = ramp;
  plate->transfer_function.opacity_count = 2;
  plate->shading = HL_SHADING_FLAT;
  paint(&set, plate, (const unsigned char(*)[N][4])colors);
  render(&set, false, pixels);
  int edge = 0;
  for (int i = 0; i < PIXELS; i++) {
    double alpha = (double)pixels[4 * i + 3], x = (i % SIDE + 0.5) / SIDE * N - 0.5;
    if (x > N / 2 - 0.5 + 0.01 || alpha < 1e-3)
      continue; /* these pixels lie in the half beside the visible voxels */
    edge += alpha < 0.5;
    assert_true((double)pixels[4 * i] >= 255.0 / 256 * alpha - 1e-4);
    assert_true((double)pixels[4 * i + 2] <= alpha / 256 + 1e-4);
  }
  (void)edge;
  stage_close(&set);
}

/* Opens a scene of a ball whose voxels have colours, with lights. */
static hl_scene_volume *open_ball(stage *set, int method, bool soft) {
  static float voxels[N * N * N];
  static const hl_opacity_point ramp[] = {{0, 0}, {0.4, 0}, {0.6, 0.7}};
  for (int i = 0; i < N * N * N; i++) {
    double x = i % N - 5.5, y = i / N % N - 5.5, z = i / N / N - 5.5;
    voxels[i] = (float)(1 / (1 + exp(1.5 * (sqrt(x * x + y * y + z * z) - 4))));
  }
  stage_open(set);
  set->scene.width = set->scene.height = SIDE;
  set->scene.camera.height = N;
  set->scene.ambient[0] = set->scene.ambient[1] = set->scene.ambient[2] = 0.2;
  hl_scene_volume *ball = stage_add_grid(set, (size_t[3]){N, N, N}, (double[3]){1, 1, 1}, (vec3){-6, -6, -6},
                                         voxels);
  ball->transfer_function.opacity = ramp;
  ball->transfer_function.opacity_count = 3;
  ball->shading = HL_SHADING_PHONG;
  stage_look(set, (vec3){10, 14, 30}, (vec3){0, 0, 0}, (vec3){0, 1, 0});
  hl_light *light = stage_add_directional(set, (vec3){-0.7, -0.6, -0.4});
  light->angular_diameter_deg = soft ? 12 : 0;
  set->scene.render.shadows = soft ? HL_SHADOWS_SOFT : HL_SHADOWS_HARD;
  set->scene.render.soft_method = (hl_soft_method)method;
  set->scene.render.sheet_spacing = 0.5;
  return ball;
}

/* Red voxels with a white transfer function and white voxels with a red transfer function give the same
 * bytes, with hard and soft shadows. */
static void test_one_color_is_the_functions(void **state) {
  (void)state;
  static float pixels[2][PIXELS * 4];
  for (int kind = 0; kind < 4; kind++) {
    for (int painted = 0; painted < 2; painted++) {
      stage set;
      hl_scene_volume *ball = open_ball(&set, kind % 3, kind != 3);
      unsigned char colors[N][N][4];
      for (int n = 0; n < N * N; n++) memcpy(colors[n / N][n % N], "\xff\0\0\x7f", 4);
      if (painted) paint(&set, ball, (const unsigned char(*)[N][4])colors);
      else stage_set_color(&set, ball, 1, 0, 0);
      render(&set, false, pixels[painted]);
      stage_close(&set);
    }
    assert_memory_equal(pixels[0], pixels[1], sizeof pixels[0]);
  }
}

/* Pictures of coloured voxels are near the reference's pictures, with hard and soft shadows. */
static void test_against_the_reference(void **state) {
  (void)state;
  static float pixels[2][PIXELS * 4];
  for (int soft = 0; soft < 2; soft++) {
    double square = 0;
    for (int reference = 0; reference < 2; reference++) {
      stage set;
      hl_scene_volume *ball = open_ball(&set, HL_SOFT_CASCADE, soft == 1);
      unsigned char colors[N][N][4];
      random_colors(colors, 3);
      paint(&set, ball, (const unsigned char(*)[N][4])colors);
      render(&set, reference == 1, pixels[reference]);
      stage_close(&set);
    }
    for (int i = 0; i < PIXELS * 4; i++) square += pow((double)(pixels[0][i] - pixels[1][i]), 2);
    double rmse = sqrt(square / (PIXELS * 4));
    if (!(rmse < 0.008)) fail_msg("%s shadows: rmse %g", soft ? "soft" : "hard", rmse);
    print_message("# %s shadows: rmse %.5f\n", soft ? "soft" : "hard", rmse);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_colors_between_voxels),
      cmocka_unit_test(test_no_fringe),
      cmocka_unit_test(test_one_color_is_the_functions),
      cmocka_unit_test(test_against_the_reference),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
