/* analytic/sheets_gradient.c - gradient opacity. The gradient's length in a ramp and in a paraboloid is known
 * everywhere, so that the picture and the light that passes are known. Each closed form is tested on the
 * sheets and on the reference. */
#include <stdlib.h>
#include <string.h>

#include "../asserts.h"
#include "reference_stage.h"

enum { SIDE = 24, PIXELS = SIDE * SIDE, N = 24 };

typedef double field_function(double x, double y, double z);

/* Adds a cube of N^3 voxels around the origin. field: the value at a position in the world. edge: a voxel's
 * edge, in world units. */
static hl_scene_volume *add_cube(stage *set, field_function *field, double edge) {
  static float voxels[N * N * N];
  float *out = voxels;
  for (int k = 0; k < N; k++)
    for (int j = 0; j < N; j++)
      for (int i = 0; i < N; i++)
        *out++ = (float)field((i + 0.5 - N / 2.0) * edge, (j + 0.5 - N / 2.0) * edge,
                              (k + 0.5 - N / 2.0) * edge);
  const double spacing[3] = {edge, edge, edge}, low = -N / 2.0 * edge;
  return stage_add_grid(set, (size_t[3]){N, N, N}, spacing, (vec3){low, low, low}, voxels);
}

static void set_gradient(hl_scene_volume *volume, const hl_opacity_point *points, size_t count) {
  volume->transfer_function.gradient_opacity = points;
  volume->transfer_function.gradient_opacity_count = count;
}

static const float *middle(const float *pixels) { return &pixels[4 * (SIDE / 2 * SIDE + SIDE / 2)]; }

/* ---- a ramp: its gradient has the length 3, whatever its voxels and units ---- */

static double ramp(double x, double y, double z) {
  (void)y, (void)z;
  return 3 * x;
}

static const hl_opacity_point HALF_AT_THREE[] = {
    {1, 0}, {4, 0.75}}; /* the factor is 1/2 at a gradient of the length 3 */

/* The opacity is 0.1 per unit over the 12 units of the cube, and half of the extinction counts: alpha = 1 -
 * 0.9^(12 / 2). */
static void test_ramp(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  static const double edges[] = {0.5, 0.25, 2};
  for (int k = 0; k < 18; k++) {
    stage set;
    stage_open(&set);
    set.scene.width = set.scene.height = SIDE;
    double edge = edges[k % 3];
    set.scene.camera.height = N * edge;
    stage_look(&set, (vec3){0, 0, 100}, (vec3){0, 0, 0}, (vec3){0, 1, 0});
    if (k % 2) set.scene.camera.type = HL_CAMERA_PERSPECTIVE, set.scene.camera.fovy_deg = 5;
    hl_scene_volume *cube = add_cube(&set, ramp, edge);
    stage_set_opacity(&set, cube, 0.1, 2 * edge);
    set_gradient(cube, HALF_AT_THREE, 2);
    if (k % 4 > 1) cube->shading = HL_SHADING_PHONG;
    set.scene.render.kernel = (hl_kernel)(k % 3 == 2 ? HL_KERNEL_LINEAR : HL_KERNEL_BSPLINE);
    stage_render_by(&set, k >= 12, pixels);
    assert_near((double)middle(pixels)[3], 1 - pow(0.9, N / 2 / 2), k % 2 ? 2e-3 : 2e-5);
    stage_close(&set);
  }
}

/* ---- a paraboloid: its gradient's length is twice the distance from the middle, which the kernel keeps ----
 */

static double paraboloid(double x, double y, double z) { return x * x + y * y + z * z; }

enum { SHELL_POINTS = 4 };
static const hl_opacity_point SHELL[SHELL_POINTS] = {{0, 0}, {10, 0}, {13, 1}, {16, 0}};

/* Returns the factor that the gradient opacity SHELL has at a distance from the middle. */
static double factor_at(double distance) {
  double gradient = 2 * distance;
  return fmax(0, fmin((gradient - 10) / 3, (16 - gradient) / 3));
}

/* Returns the integral of the factor along a ray parallel to z that passes the middle at the distance
 * `beside`. */
static double way_through_shell(double beside) {
  enum { STEPS = 4000 };
  double sum = 0;
  for (int i = 0; i < STEPS; i++) {
    double z = ((i + 0.5) / STEPS - 0.5) * N;
    sum += factor_at(sqrt(beside * beside + z * z)) * N / STEPS;
  }
  return sum;
}

static void test_ball(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  for (int k = 0; k < 4; k++) {
    stage set;
    stage_open(&set);
    set.scene.width = set.scene.height = SIDE;
    set.scene.camera.height = N;
    stage_look(&set, (vec3){0, 0, 100}, (vec3){0, 0, 0}, (vec3){0, 1, 0});
    hl_scene_volume *cube = add_cube(&set, paraboloid, 1);
    stage_set_opacity(&set, cube, 0.3, 1);
    set_gradient(cube, SHELL, SHELL_POINTS);
    cube->clipped = 1; /* at the cube's faces gradients are shorter, so that a clip box leaves them out */
    for (int a = 0; a < 3; a++) cube->clip_min[a] = -9, cube->clip_max[a] = 9;
    set.scene.render.sheet_spacing = k % 2 ? 0.5 : 0.25;
    stage_render_by(&set, k >= 2, pixels);
    for (int y = 4; y < SIDE - 4; y++)
      for (int x = 4; x < SIDE - 4; x++) {
        double way = way_through_shell(hypot(x + 0.5 - SIDE / 2.0, y + 0.5 - SIDE / 2.0));
        assert_near((double)pixels[4 * (y * SIDE + x) + 3], 1 - pow(0.7, way),
                    k >= 2  ? 1e-3
                    : k % 2 ? 6e-3
                            : 2.5e-3);
      }
    stage_close(&set);
  }
}

/* ---- shadows: light loses to the ramp what the factor leaves of its extinction ---- */

/* Returns the light on a plate under the ramp, seen from below. The eye sees the plate alone, and the ramp
 * casts its shadow on the plate. */
static double light_below_ramp(bool reference, int method, const hl_opacity_point *points, double intensity) {
  static float pixels[PIXELS * 4];
  stage set;
  stage_open(&set);
  set.scene.width = set.scene.height = SIDE;
  set.scene.camera.height = 10;
  stage_look(&set, (vec3){0, 30, -50}, (vec3){0, 0, -16}, (vec3){0, 1, 0});
  hl_scene_volume *cube = add_cube(&set, ramp, 1);
  stage_set_opacity(&set, cube, 0.1, 2);
  set_gradient(cube, points, 2);
  cube->visible = 0;
  hl_scene_volume *plate = stage_add_grid(&set, (size_t[3]){30, 30, 2}, (double[3]){1, 1, 1},
                                          (vec3){-15, -15, -17}, NULL);
  stage_set_opacity(&set, plate, 0.2, 1);
  hl_light *light = stage_add_directional(&set, (vec3){0, 0, -1});
  light->intensity = intensity;
  if (method > 0) light->angular_diameter_deg = 6;
  set.scene.render.shadows = method > 0 ? HL_SHADOWS_SOFT : HL_SHADOWS_HARD;
  set.scene.render.soft_method = method == 3   ? HL_SOFT_SUBLIGHTS
                                 : method == 2 ? HL_SOFT_PAPER
                                               : HL_SOFT_CASCADE;
  set.scene.render.light_samples = 4;
  stage_render_by(&set, reference, pixels);
  double lit = (double)middle(pixels)[0] / (double)middle(pixels)[3];
  stage_close(&set);
  return lit;
}

static void test_ramp_shadow(void **state) {
  (void)state;
  static const hl_opacity_point all[] = {{0, 1}, {1, 1}}, none[] = {{0, 1}, {2, 0}};
  for (int method = 0; method < 4; method++)
    for (int reference = 0; reference < (method == 0 ? 2 : 1); reference++) {
      double free = light_below_ramp(reference, method, none, 1),
             half = light_below_ramp(reference, method, HALF_AT_THREE, 1),
             whole = light_below_ramp(reference, method, all, 1);
      assert_near(half / free, pow(0.9, N / 2.0 / 2), 4e-3);
      assert_near(whole / free, pow(0.9, N / 2.0), 4e-3);
      assert_true(free > 0.3);
    }
}

/* Returns the root mean square difference over the middle of the picture. The borders are left out because
 * the ramp's gradient ends at the faces of the cube. */
static double difference_inside(const float *a, const float *b) {
  double sum = 0;
  for (int y = 6; y < SIDE - 6; y++)
    for (int x = 6; x < SIDE - 6; x++)
      for (int c = 4 * (y * SIDE + x); c < 4 * (y * SIDE + x + 1); c++) {
        double d = (double)a[c] - (double)b[c];
        sum += d * d / (4 * 12 * 12);
      }
  return sqrt(sum);
}

/* ---- matter that the gradient opacity hides casts no shadow within the matter ---- */

/* A ramp with half of its extinction by gradient opacity and a ramp of half of the extinction give the same
 * picture, as a medium and as a surface, with light by every method. */
static void test_halved_ramp_is_a_thinner_one(void **state) {
  (void)state;
  static float pixels[2][PIXELS * 4];
  for (int k = 0; k < 8; k++) {
    for (int half = 0; half < 2; half++) {
      stage set;
      stage_open(&set);
      set.scene.width = set.scene.height = SIDE;
      set.scene.camera.height = 30;
      stage_look(&set, (vec3){30, 20, 50}, (vec3){0, 0, 0}, (vec3){0, 1, 0});
      hl_scene_volume *cube = add_cube(&set, ramp, 1);
      double thin = 0.9 - 0.2 * (k / 4), thick = 1 - (1 - thin) * (1 - thin);
      stage_set_opacity(&set, cube, half ? thin : thick, 4);
      if (half == 0) set_gradient(cube, HALF_AT_THREE, 2);
      if (k >= 4) cube->shading = HL_SHADING_PHONG;
      /* the ramp's gradient shades the surface, and the grid's faces do not */
      cube->cut_shading = HL_CUT_SHADING_GRADIENT;
      stage_add_directional(&set, (vec3){-0.6, -0.3, -1});
      if (k % 4 > 0) set.lights[0].angular_diameter_deg = 12;
      set.scene.render.shadows = k % 4 > 0 ? HL_SHADOWS_SOFT : HL_SHADOWS_HARD;
      set.scene.render.soft_method = (hl_soft_method)(k % 4 > 0 ? k % 4 - 1 : 0);
      stage_render_sheets(&set, pixels[half]);
      stage_close(&set);
    }
    assert_near(difference_inside(pixels[0], pixels[1]), 0, 0.02);
  }
}

/* ---- light from everywhere ---- */

static void light_from_everywhere(stage *set, bool sky, hl_scene_volume *cube) {
  if (sky) {
    set->scene.sky.type = HL_SKY_UNIFORM;
  } else {
    stage_add_directional(set, (vec3){-0.6, -0.3, -1});
    cube->multiple_scattering = 1;
    for (int c = 0; c < 3; c++) cube->albedo[c] = 0.9;
  }
}

/* The halved ramp looks like the thinner ramp also in the light of a sky and in light that is scattered
 * repeatedly. A renderer does not reuse the data that it kept of the cube without gradient opacity for the
 * cube with gradient opacity. */
static void test_light_from_everywhere(void **state) {
  (void)state;
  static float pixels[3][PIXELS * 4];
  for (int sky = 0; sky < 2; sky++) {
    for (int half = 0; half < 2; half++) {
      stage set;
      hl_renderer *renderer = NULL;
      stage_open(&set);
      set.scene.width = set.scene.height = SIDE;
      set.scene.camera.height = 30;
      stage_look(&set, (vec3){30, 20, 50}, (vec3){0, 0, 0}, (vec3){0, 1, 0});
      hl_scene_volume *cube = add_cube(&set, ramp, 1);
      light_from_everywhere(&set, sky, cube);
      stage_set_opacity(&set, cube, half ? 0.5 : 0.75, 4);
      assert_int_equal(hl_renderer_create(set.context, &renderer, NULL), HL_OK);
      stage_render_with(&set, renderer, pixels[2]);
      if (half == 0) set_gradient(cube, HALF_AT_THREE, 2);
      stage_render_with(&set, renderer, pixels[2]);
      stage_render_sheets(&set, pixels[half]);
      assert_memory_equal(pixels[half], pixels[2], sizeof pixels[2]);
      hl_renderer_destroy(renderer);
      stage_close(&set);
    }
    assert_near(difference_inside(pixels[0], pixels[1]), 0, 0.02);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_ramp),
      cmocka_unit_test(test_ball),
      cmocka_unit_test(test_ramp_shadow),
      cmocka_unit_test(test_halved_ramp_is_a_thinner_one),
      cmocka_unit_test(test_light_from_everywhere),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
