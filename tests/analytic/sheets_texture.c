/* analytic/sheets_texture.c - projected images and cones of light: their place on a floor, their brightness
 * and their edges are compared with closed forms. */
#include <stdlib.h>

#include "../asserts.h"
#include "reference_stage.h"

enum { SIDE = 96, FINE = 1024 };

/* Makes a checkerboard of count x count pixels, in squares of `squares` pixels a side, with white in the
 * upper left corner. */
static float *checker(int count, int squares) {
  float *pixels = malloc((size_t)count * (size_t)count * 3 * sizeof *pixels);
  assert_non_null(pixels);
  for (int i = 0; i < 3 * count * count; i++)
    pixels[i] = (i / 3 % count / squares + i / 3 / count / squares) % 2 == 0;
  return pixels;
}

/* Opens a scene of an opaque floor with its surface at z = 0, seen from straight above. A pixel is a quarter
 * of a unit wide. */
static void stage_floor(stage *set) {
  hl_scene_volume *floor = stage_add_grid(set, (size_t[3]){40, 40, 2}, (double[3]){1, 1, 1},
                                          (vec3){-20, -20, -2}, NULL);
  stage_set_opacity(set, floor, 0.9999, 0.005);
  floor->casts_shadow = 0;
  set->scene.width = set->scene.height = SIDE;
  set->scene.camera.height = 24;
  set->scene.render.shadows = HL_SHADOWS_OFF;
}

/* Returns the first place after `from` at which the brightness passes one half, in world units along a row or
 * column of the floor's picture. */
static double edge_after(const float *first, int step, double from) {
  for (int i = 0; i + 1 < SIDE; i++) {
    double at = -12 + (i + 0.5) * 0.25, a = first[4 * i * step], b = first[4 * (i + 1) * step];
    if (at >= from && (a - 0.5) * (b - 0.5) <= 0 && a != b) return at + 0.25 * (0.5 - a) / (b - a);
  }
  return INFINITY;
}

/* Parallel light meets the floor at 30 degrees to the normal, and the light's screen is perpendicular to the
 * light. The squares of a checkerboard keep their width along y, and are longer by 1 / cos 30 along x. */
static void test_checker_at_30_degrees(void **state) {
  (void)state;
  static float pixels[SIDE * SIDE * 4];
  float *image = checker(256, 32);
  stage set;
  stage_open(&set);
  stage_floor(&set);
  double s = 0.5, c = sqrt(0.75);
  hl_light *light = stage_add_directional(&set, (vec3){s, 0, -c});
  stage_set_texture(light, 256, 256, image, (vec3){-30 * s, 0, 30 * c}, (vec3){8 * c, 0, 8 * s},
                    (vec3){0, 8, 0});
  for (int shadows = HL_SHADOWS_OFF; shadows <= HL_SHADOWS_HARD; shadows++) {
    set.scene.render.shadows = (hl_shadows)shadows;
    stage_render_sheets(&set, pixels);
    for (int line = -3; line <= 3; line++) {
      double x = 2 * line / c, y = 2 * line;
      assert_near(edge_after(&pixels[4 * SIDE * 44], 1, x - 0.9), x, 0.125);
      assert_near(edge_after(&pixels[4 * 44], SIDE, y - 0.9), y, 0.125);
    }
    /* the floor is dark beside the screen, from two pixels beyond its edge */
    int outside = (int)floor((-8 / c + 12) / 0.25) - 2, sum = 0;
    for (int y = 0; y < SIDE; y++) {
      assert_true(pixels[4 * (SIDE * y + outside)] == 0);
      sum += pixels[4 * (SIDE * y + outside + 4)] > 0.99f;
    }
    assert_in_range(sum, 30, 32); /* half of the screen's 64 rows are white beside the edge */
  }
  stage_close(&set);
  free(image);
}

/* Under a point light above the floor, an edge at the height h of the screen falls H / (H - h) as far out.
 * The light shines through its screen alone, so that nothing above the light is lit. */
static void test_point_light_through_a_screen(void **state) {
  (void)state;
  static float pixels[SIDE * SIDE * 4];
  float *image = checker(64, 16);
  stage set;
  stage_open(&set);
  stage_floor(&set);
  hl_light *light = stage_add_point(&set, (vec3){1, 0.5, 10});
  stage_set_texture(light, 64, 64, image, (vec3){0.8, 0, 6}, (vec3){4, 0, 0}, (vec3){0, 3, 0});
  for (int shadows = HL_SHADOWS_OFF; shadows <= HL_SHADOWS_HARD; shadows++) {
    set.scene.render.shadows = (hl_shadows)shadows;
    stage_render_sheets(&set, pixels);
    for (int line = -1; line <= 1; line++) {
      double x = 1 + (0.8 + 2 * line - 1) * 2.5, y = 0.5 + (1.5 * line - 0.5) * 2.5;
      assert_near(edge_after(&pixels[4 * SIDE * 44], 1, x - 2), x, 0.125);
      /* the picture's rows run downwards, so that y changes its sign */
      assert_near(-edge_after(&pixels[4 * 56], SIDE, -y - 1.5), y, 0.125);
    }
  }
  light->position[2] = -10;
  light->texture.screen_center[2] = -14;
  light->shadows = HL_SHADOWS_OFF;
  stage_render_sheets(&set, pixels);
  for (int i = 0; i < SIDE * SIDE; i++) assert_true(pixels[4 * i] == 0);
  stage_close(&set);
  free(image);
}

/* If an image is finer than the picture, a pixel shows the image's mean, at any angle. A pixel of the picture
 * averages 3.2 x 3.2 pixels of the image. Image pixels of -1 and 1 have a mean of at most 1 / 3.2 along a
 * row, so that the mean over a square deviates by at most 1 / 3.2^2 of half of the contrast, 0.05. */
static void test_fine_images_are_averaged(void **state) {
  (void)state;
  static float pixels[SIDE * SIDE * 4];
  float *image = checker(FINE, 1);
  stage set;
  stage_open(&set);
  stage_floor(&set);
  hl_light *light = stage_add_directional(&set, (vec3){0.3, 0.2, -1});
  for (int turn = 0; turn < 8; turn++) {
    double a = turn * 0.2;
    stage_set_texture(light, FINE, FINE, image, (vec3){-9, -6, 30}, (vec3){40 * cos(a), 40 * sin(a), 0},
                      (vec3){-40 * sin(a), 40 * cos(a), 0});
    stage_render_sheets(&set, pixels);
    for (int i = 0; i < SIDE * SIDE; i++) assert_near((double)pixels[4 * i], 0.5, 0.05);
  }
  stage_close(&set);
  free(image);
}

/* Three beams of one colour each cross a translucent cube, seen from the side. Without attenuation all light
 * comes out of the cube. With attenuation the fraction exp(-sigma way) comes out. */
static void test_beams_through_a_cube(void **state) {
  (void)state;
  static float pixels[SIDE * SIDE * 4];
  enum { ROWS = 70 };
  static float image[ROWS * 3];
  for (int y = 0; y < ROWS; y++)
    for (int c = 0; c < 3; c++) image[3 * y + c] = y / 10 % 2 == 1 && y / 20 == c;
  stage set;
  stage_open(&set);
  hl_scene_volume *cube = stage_add_grid(&set, (size_t[3]){20, 20, 20}, (double[3]){1, 1, 1},
                                         (vec3){-10, -10, -10}, NULL);
  stage_set_opacity(&set, cube, 0.1, 1);
  double sigma = -log(0.9);
  stage_look(&set, (vec3){0, -50, 0}, (vec3){0, 0, 0}, (vec3){0, 0, 1});
  set.scene.width = set.scene.height = SIDE;
  set.scene.camera.height = 24;
  hl_light *light = stage_add_directional(&set, (vec3){1, 0, 0});
  stage_set_texture(light, 1, ROWS, image, (vec3){-30, 0, 0}, (vec3){0, 12, 0}, (vec3){0, 0, 8.75});
  for (int shadows = HL_SHADOWS_OFF; shadows <= HL_SHADOWS_HARD; shadows++) {
    set.scene.render.shadows = (hl_shadows)shadows;
    stage_render_sheets(&set, pixels);
    int first = 12, last = 83; /* pixels that are more than a slab within the cube's faces */
    for (int beam = 0; beam < 3; beam++) {
      /* the beam's middle: row 15, 35 or 55 of the image; a row is a quarter of a unit high, as a pixel is */
      int y = (int)((12 - (8.75 - (15 + 20 * beam) * 0.25)) / 0.25);
      const float *entry = &pixels[4 * (SIDE * y + first)], *exit = &pixels[4 * (SIDE * y + last)];
      double passed = shadows == HL_SHADOWS_OFF ? 1 : exp(-sigma * (last - first) * 0.25);
      double entered = (1 - exp(-sigma * 20)) *
                       (shadows == HL_SHADOWS_OFF ? 1 : exp(-sigma * ((first + 0.5) * 0.25 - 2)));
      for (int c = 0; c < 3; c++) {
        assert_near((double)entry[c], c == beam ? entered : 0, c == beam ? 0.01 * entered : 1e-4);
        assert_near((double)exit[c], c == beam ? passed * (double)entry[c] : 0,
                    c == beam ? 0.01 * passed * entered : 1e-4);
      }
      const float *beside = &pixels[4 * (SIDE * (y + 10) + 48)];
      for (int c = 0; c < 3; c++) assert_true(beside[c] < 1e-4f);
    }
  }
  stage_close(&set);
}

/* A tilted cone of light falls on the floor. Each pixel's brightness is the smooth step of the cosine of the
 * angle to the cone's axis, with shadows and without. No light falls outside of the cone. */
static void test_spot_light(void **state) {
  (void)state;
  static float pixels[SIDE * SIDE * 4];
  vec3 position = {-4, 3, 18}, direction = {0.25, -0.1, -1};
  double outer = cos(15 * HL_PI / 180), full = cos(8 * HL_PI / 180);
  stage set;
  stage_open(&set);
  stage_floor(&set);
  stage_add_spot(&set, position, direction, 30, 7);
  for (int shadows = HL_SHADOWS_OFF; shadows <= HL_SHADOWS_HARD; shadows++) {
    set.scene.render.shadows = (hl_shadows)shadows;
    stage_render_sheets(&set, pixels);
    for (int y = 0; y < SIDE; y++)
      for (int x = 0; x < SIDE; x++) {
        vec3 at = {-12 + (x + 0.5) * 0.25, 12 - (y + 0.5) * 0.25, 0};
        double cosine = vec3_dot(vec3_normalise(vec3_subtract(at, position)), vec3_normalise(direction));
        double part = fmin(fmax((cosine - outer) / (full - outer), 0), 1);
        if (part == 0) assert_true(pixels[4 * (SIDE * y + x)] == 0);
        assert_near((double)pixels[4 * (SIDE * y + x)], part * part * (3 - 2 * part), 2e-3);
      }
  }
  stage_close(&set);
}

/* ---- extended lights ---- */

/* Returns the fraction of a disk of radius 1 at which u < s. */
static double disk_below(double s) {
  if (s <= -1) return 0;
  if (s >= 1) return 1;
  return 0.5 + (s * sqrt(1 - s * s) + asin(s)) / HL_PI;
}

/* The brightness along the floor's middle row is the fraction of the light's disk that the floor sees past
 * the screen's edge. edge: the place on the floor at which half of the disk is seen. radius: half of the
 * penumbra's width. */
static void check_screen_edge(stage *set, double edge, double radius) {
  static float pixels[SIDE * SIDE * 4];
  double worst = 0;
  stage_render_sheets(set, pixels);
  for (int x = 0; x < SIDE; x++) {
    double at = -12 + (x + 0.5) * 0.25;
    if (at > 0)
      worst = fmax(worst, fabs((double)pixels[4 * (SIDE * 48 + x)] - disk_below((at - edge) / radius)));
  }
  print_message("# screen's edge, penumbra %.2f: at most %.4f off the disk's\n", 2 * radius, worst);
  /* A narrow edge has the profile of a box filter with the disk's variance, which deviates from the disk's
   * profile by at most 0.5 + (0.866 / 2 + asin 0.866) / pi - 1 = 0.029. No edge is sharper than a pixel,
   * which is 0.25 wide. */
  if (2 * radius > 0.3) assert_near(worst, 0, 0.029);
}

/* The shadow of the screen's edge has a penumbra with the profile of the light's disk and the width of
 * equation (5), for parallel and near lights.
 */
static void test_screen_edge_of_extended_lights(void **state) {
  (void)state;
  const float white[3] = {1, 1, 1};
  stage set;
  stage_open(&set);
  stage_floor(&set);
  set.scene.render.shadows = HL_SHADOWS_SOFT;
  hl_light *light = stage_add_directional(&set, (vec3){0, 0, -1});
  for (double angle = 1; angle <= 16; angle *= 2) {
    light->angular_diameter_deg = angle;
    stage_set_texture(light, 1, 1, white, (vec3){25, 0, 10}, (vec3){20, 0, 0}, (vec3){0, 40, 0});
    check_screen_edge(&set, 5, 10 * tan(angle * HL_PI / 360));
  }
  set.scene.light_count = 0;
  light = stage_add_point(&set, (vec3){0, 0, 30});
  light->radius = 2;
  for (double height = 2; height <= 20; height += 6) {
    double magnified = 30 / (30 - height);
    stage_set_texture(light, 1, 1, white, (vec3){20 + 5 / magnified, 0, height}, (vec3){20, 0, 0},
                      (vec3){0, 40, 0});
    check_screen_edge(&set, 5, 2 * height / (30 - height));
  }
  stage_close(&set);
}

/* ---- unlit matter costs no work ---- */

static uint64_t tiles_filled_for_light(stage *set) {
  static float pixels[SIDE * SIDE * 4];
  return stage_render_counted(set, pixels).tiles_filled_light;
}

/* If the screen or the cone leaves the volume dark, no tile of the shadow buffer is computed. */
static void test_the_shadow_buffer_follows_what_is_lit(void **state) {
  (void)state;
  const float white[3] = {1, 1, 1};
  stage set;
  stage_open(&set);
  stage_set_opacity(
      &set, stage_add_grid(&set, (size_t[3]){20, 20, 20}, (double[3]){1, 1, 1}, (vec3){-10, -10, -10}, NULL),
      0.1, 1);
  set.scene.width = set.scene.height = SIDE;
  set.scene.camera.height = 24;
  hl_light *light = stage_add_point(&set, (vec3){5, -8, 40});
  int all = (int)tiles_filled_for_light(&set);
  stage_set_texture(light, 1, 1, white, (vec3){4, -6.4, 32}, (vec3){1, 0, 0}, (vec3){0, 1, 0});
  int screen = (int)tiles_filled_for_light(&set);
  set.scene.light_count = 0;
  stage_add_spot(&set, (vec3){5, -8, 40}, (vec3){-5, 8, -40}, 12, 2);
  int cone = (int)tiles_filled_for_light(&set);
  print_message("# tiles filled for a point light: %d, through a screen %d, for a spot %d\n", all, screen,
                cone);
  assert_in_range(screen, 1, all / 3);
  assert_in_range(cone, 1, all / 3);
  stage_close(&set);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_checker_at_30_degrees),
      cmocka_unit_test(test_point_light_through_a_screen),
      cmocka_unit_test(test_fine_images_are_averaged),
      cmocka_unit_test(test_beams_through_a_cube),
      cmocka_unit_test(test_spot_light),
      cmocka_unit_test(test_screen_edge_of_extended_lights),
      cmocka_unit_test(test_the_shadow_buffer_follows_what_is_lit),
  };
  return cmocka_run_group_tests_name("sheets_texture", tests, NULL, NULL);
}
