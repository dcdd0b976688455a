/* analytic/sheets_emission.c - lights that have an image on their own surface: the image's shape and colours
 * in penumbrae, against plane geometry and the reference. */
#include <stdlib.h>
#include <string.h>

#include "../asserts.h"
#include "reference_stage.h"

enum { WIDE = 160, ROWS = 6, SIDE = 48, SMALL = 16, IMAGE = 32 };

/* Opens a scene of an opaque floor with its surface at z = 0, seen from straight above. The floor casts no
 * shadow. */
static void stage_floor(stage *set, int width, int height, double across) {
  hl_scene_volume *floor = stage_add_grid(set, (size_t[3]){40, 40, 2}, (double[3]){1, 1, 1},
                                          (vec3){-20, -20, -2}, NULL);
  stage_set_opacity(set, floor, 0.999, 0.01);
  floor->casts_shadow = 0;
  set->scene.render.shadows = HL_SHADOWS_SOFT;
  set->scene.render.sheet_spacing = 2; /* in thicknesses of the plates */
  set->scene.width = width;
  set->scene.height = height;
  set->scene.camera.height = across * height / width;
  stage_look(set, (vec3){0, 0, 100}, (vec3){0, 0, 0}, (vec3){0, 1, 0});
}

/* The distance of the sheets, in thicknesses of the plates, for light from straight above. Sheets are then
 * parallel to the plates, and a plate that is thinner than a slab counts as if it filled the slab. With
 * sheets 2, 1 and 0.5 thicknesses apart, the errors of the two colours were .032, .026 and .024 (cascade) and
 * .018, .011 and .009 (sub-lights). With these distances, the colours behind the pin hole, which should be 1,
 * were 1.06 to 1.07, 1.01 to 1.04 and .97 to .99 (cascade). */
static const double PARALLEL_SPACING = 0.5;

/* Adds an opaque plate that the eye does not see, an eighth of a unit thick. height: of the plate's
 * middle. */
static void add_plate(stage *set, double x0, double x1, double y0, double y1, double height) {
  hl_scene_volume *plate = stage_add_grid(
      set, (size_t[3]){(size_t)ceil(x1 - x0), (size_t)ceil(y1 - y0), 1},
      (double[3]){(x1 - x0) / ceil(x1 - x0), (y1 - y0) / ceil(y1 - y0), 0.125},
      (vec3){x0, y0, height - 0.0625}, NULL);
  stage_set_opacity(set, plate, 0.9999, 0.001);
  plate->visible = 0;
}

static hl_light *add_rect(stage *set, double height, double side) {
  hl_light *light = stage_add_point(set, (vec3){0, 0, height});
  light->type = HL_LIGHT_RECT;
  memcpy(light->edge1, (double[3]){side, 0, 0}, sizeof light->edge1);
  memcpy(light->edge2, (double[3]){0, side, 0}, sizeof light->edge2);
  return light;
}

static void set_emission(hl_light *light, int side, const float *pixels) {
  light->emission.pixels = pixels;
  light->emission.width = light->emission.height = side;
}

/* halves() returns an image with a red and a blue half. quarters() returns an image with a red, a green, a
 * blue and a white quarter, in rows from the upper left. */
static const float *halves(void) {
  static float pixels[IMAGE * IMAGE * 3];
  for (int i = 0; i < IMAGE * IMAGE; i++) pixels[3 * i + (i % IMAGE < IMAGE / 2 ? 0 : 2)] = 1;
  return pixels;
}

static const float *quarters(void) {
  static float pixels[IMAGE * IMAGE * 3];
  for (int i = 0; i < IMAGE * IMAGE; i++) {
    int quarter = i / IMAGE / (IMAGE / 2) * 2 + i % IMAGE / (IMAGE / 2);
    for (int c = 0; c < 3; c++) pixels[3 * i + c] = quarter == c || quarter == 3;
  }
  return pixels;
}

/* Beyond the edge of a plate, the light's right half, which is blue, rises on one side, and the light's left
 * half rises on the other side. Each colour rises over half of the width of equation (5). The light is 6 wide
 * at the height 24, and the plate is at the height 8. From x, the part of the light right of -2 x is seen. */
static void check_two_colors(hl_soft_method method, int samples, bool reference, double tolerance) {
  static float pixels[WIDE * ROWS * 4];
  int wide = reference ? WIDE / 4 : WIDE;
  stage set;
  stage_open(&set);
  stage_floor(&set, wide, reference ? 2 : ROWS, 16);
  add_plate(&set, -20, 0, -20, 20, 8);
  set.scene.render.sheet_spacing = PARALLEL_SPACING;
  set.scene.render.soft_method = method;
  set.scene.render.light_samples = samples;
  set_emission(add_rect(&set, 24, 6), IMAGE, halves());
  hl_reference_options options;
  hl_reference_options_defaults(&options);
  options.light_points = 400;
  if (reference) stage_render(&set, &options, pixels);
  else stage_render_sheets(&set, pixels);
  const float *row = &pixels[reference ? 0 : 4 * WIDE * (ROWS / 2)];
  double greatest = 0;
  for (int i = 0; i < wide; i++) {
    double x = -8 + (i + 0.5) * 16 / wide;
    double red = fmin(fmax(2 * x / 3, 0), 1) / 2, blue = fmin(fmax(1 + 2 * x / 3, 0), 1) / 2;
    greatest = fmax(greatest, fmax(fabs((double)row[4 * i] - red), fabs((double)row[4 * i + 2] - blue)));
    assert_true(row[4 * i + 1] == 0);
  }
  print_message("# two colours, method %d%s: greatest error %.4f\n", (int)method,
                reference ? ", reference" : "", greatest);
  assert_true(greatest < tolerance);
  stage_close(&set);
}

static void test_two_colors_over_an_edge(void **state) {
  (void)state;
  check_two_colors(HL_SOFT_CASCADE, 4, true, 0.01);
  check_two_colors(HL_SOFT_CASCADE, 4, false, 0.025);
  check_two_colors(HL_SOFT_SUBLIGHTS, 8, false, 0.015);
}

/* A pin hole shows the light upside down and half as large. The light is 12 wide at 24, and the hole is 1
 * wide at 8. From the middle of a quarter's picture, the hole shows 3 x 3 units of the light, which are about
 * nine of its 12 x 12 sub-lights. */
static void render_camera(hl_soft_method method, int samples, const float *image, float *pixels) {
  stage set;
  stage_open(&set);
  stage_floor(&set, SIDE, SIDE, 12);
  add_plate(&set, -20, -0.5, -20, 20, 8);
  add_plate(&set, 0.5, 20, -20, 20, 8);
  add_plate(&set, -0.5, 0.5, -20, -0.5, 8);
  add_plate(&set, -0.5, 0.5, 0.5, 20, 8);
  set.scene.render.sheet_spacing = PARALLEL_SPACING;
  set.scene.render.soft_method = method;
  set.scene.render.light_samples = samples;
  hl_light *light = add_rect(&set, 24, 12);
  set_emission(light, IMAGE, image);
  light->intensity = 16;
  stage_render_sheets(&set, pixels);
  stage_close(&set);
}

static const float *pixel_at(const float *pixels, double x, double y) {
  return &pixels[4 * (SIDE * (int)((6 - y) * SIDE / 12) + (int)((x + 6) * SIDE / 12))];
}

static void check_camera(hl_soft_method method, int samples) {
  static float pixels[SIDE * SIDE * 4];
  render_camera(method, samples, quarters(), pixels);
  for (int quarter = 0; quarter < 4; quarter++) {
    /* red, the upper left of the image, falls on the lower right */
    const float *at = pixel_at(pixels, quarter % 2 == 0 ? 1.5 : -1.5, quarter / 2 == 0 ? -1.5 : 1.5);
    print_message("# camera, method %d: quarter %d is %.3f %.3f %.3f\n", (int)method, quarter, (double)at[0],
                  (double)at[1], (double)at[2]);
    for (int c = 0; c < 3; c++) {
      bool lit = quarter == c || quarter == 3;
      assert_near((double)at[c], lit ? 1 : 0, lit ? (method == HL_SOFT_SUBLIGHTS ? 0.2 : 0.05) : 0.02);
    }
  }
  for (int i = 0; i < SIDE; i++) {
    /* beyond 4.25 the floor is dark: half of the picture is 3, the hole blurs it by 0.75, and a twelfth of
     * the light blurs it by 0.5 */
    double x = fabs(-6 + (i + 0.5) * 12 / SIDE);
    for (int c = 0; c < 3 && x > 4.25; c++)
      assert_near((double)pixels[4 * (SIDE * SIDE / 2 + i) + c], 0, 0.03);
  }
}

/* The paper's convolutions add variances, so that the picture is too small. But the convolutions add means
 * rightly, so that the middle of each colour lies 1.5 from the hole's middle. */
static void check_camera_of_paper(void) {
  static float pixels[SIDE * SIDE * 4];
  double light[2] = {0, 0}, middle[2] = {0, 0};
  render_camera(HL_SOFT_PAPER, 4, halves(), pixels);
  for (int i = 0; i < SIDE * SIDE; i++)
    for (int c = 0; c < 2; c++) {
      double at = (double)pixels[4 * i + 2 * c];
      light[c] += at;
      middle[c] += at * (-6 + (i % SIDE + 0.5) * 12 / SIDE);
    }
  print_message("# camera of the paper: red around %.3f, blue around %.3f\n", middle[0] / light[0],
                middle[1] / light[1]);
  assert_near(middle[0] / light[0], 1.5, 0.25);
  assert_near(middle[1] / light[1], -1.5, 0.25);
}

static void test_a_pin_hole_shows_the_light(void **state) {
  (void)state;
  check_camera(HL_SOFT_CASCADE, 4);
  check_camera(HL_SOFT_SUBLIGHTS, 12);
  check_camera_of_paper();
}

/* Adds a plate over a quarter of the floor, so that the light's image matters in both directions. */
static void stage_corner(stage *set, int side) {
  stage_floor(set, side, side, 12);
  add_plate(set, -20, 0, -20, 0, 9);
}

/* An even white image changes nothing. A grey image changes the strength of the light. */
static void test_an_even_image_is_none(void **state) {
  (void)state;
  static float white[IMAGE * IMAGE * 3], gray[IMAGE * IMAGE * 3];
  static float plain[SIDE * SIDE * 4], pixels[SIDE * SIDE * 4], dimmed[SIDE * SIDE * 4];
  for (int i = 0; i < IMAGE * IMAGE * 3; i++) white[i] = 1, gray[i] = 0.25f;
  for (int method = HL_SOFT_CASCADE; method <= HL_SOFT_SUBLIGHTS; method++) {
    stage set;
    stage_open(&set);
    stage_corner(&set, SIDE);
    set.scene.render.soft_method = (hl_soft_method)method;
    hl_light *light = add_rect(&set, 20, 6);
    stage_render_sheets(&set, plain);
    set_emission(light, IMAGE, white);
    stage_render_sheets(&set, pixels);
    set_emission(light, IMAGE, gray);
    stage_render_sheets(&set, dimmed);
    for (int i = 0; i < SIDE * SIDE * 4; i++) {
      assert_near((double)pixels[i], (double)plain[i], 1e-6);
      assert_near((double)dimmed[i], i % 4 == 3 ? (double)plain[i] : 0.25 * (double)plain[i], 1e-6);
    }
    stage_close(&set);
  }
}

/* Without soft shadows, the light has the mean colour of its image. */
static void test_hard_shadows_have_the_mean(void **state) {
  (void)state;
  static float pixels[SMALL * SMALL * 4];
  stage set;
  stage_open(&set);
  stage_floor(&set, SMALL, SMALL, 4);
  set_emission(add_rect(&set, 20, 6), IMAGE, halves());
  for (int shadows = HL_SHADOWS_OFF; shadows <= HL_SHADOWS_HARD; shadows++)
    for (int reference = 0; reference < 2; reference++) {
      set.scene.render.shadows = (hl_shadows)shadows;
      if (reference) stage_render(&set, NULL, pixels);
      else stage_render_sheets(&set, pixels);
      for (int i = 0; i < SMALL * SMALL; i++)
        for (int c = 0; c < 3; c++) assert_near((double)pixels[4 * i + c], c == 1 ? 0 : 0.5, 2e-3);
    }
  stage_close(&set);
}

static const double vertices[][3] = {{-4, -3, 20}, {4, -3, 20}, {4, 3, 20}, {-1, 4, 20}};

static void turn_rect(hl_light *light) {
  light->type = HL_LIGHT_RECT;
  memcpy(light->edge1, (double[3]){7, 0, 2}, sizeof light->edge1);
  memcpy(light->edge2, (double[3]){1, 6, -1}, sizeof light->edge2);
}

/* Adds a light with an image of four coloured quarters. The test checks that the image's right, left, top and
 * bottom are in their places for every kind of light. */
static hl_light *add_light(stage *set, hl_light_type type) {
  if (type == HL_LIGHT_DIRECTIONAL) {
    hl_light *light = stage_add_directional(set, (vec3){0.2, 0.1, -1});
    light->angular_diameter_deg = 25;
    memcpy(light->emission.up, (double[3]){1, 2, 0}, sizeof light->emission.up);
    return light;
  }
  hl_light *light = stage_add_point(set, (vec3){1, -1, 20});
  light->radius = 4;
  if (type == HL_LIGHT_SPOT) {
    light->opening_angle_deg = 80;
    memcpy(light->direction, (double[3]){0, 0, -1}, sizeof light->direction);
  }
  if (type == HL_LIGHT_DISK) memcpy(light->normal, (double[3]){0.3, 0.1, -1}, sizeof light->normal);
  memcpy(light->emission.up, (double[3]){-1, 2, 0.5}, sizeof light->emission.up);
  if (type == HL_LIGHT_RECT) turn_rect(light);
  if (type == HL_LIGHT_POLYGON) {
    light->vertices = vertices;
    light->vertex_count = 4;
  }
  light->type = type;
  return light;
}

static double difference(const float *a, const float *b) {
  double sum = 0;
  for (int i = 0; i < SMALL * SMALL * 4; i++)
    if (i % 4 != 3) sum += ((double)a[i] - b[i]) * ((double)a[i] - b[i]);
  return sqrt(sum / (SMALL * SMALL * 3));
}

static void test_every_kind_of_light_against_the_reference(void **state) {
  (void)state;
  static float expected[SMALL * SMALL * 4], pixels[SMALL * SMALL * 4];
  hl_reference_options options;
  hl_reference_options_defaults(&options);
  options.light_points = 96;
  for (int type = HL_LIGHT_DIRECTIONAL; type <= HL_LIGHT_POLYGON; type++) {
    stage set;
    stage_open(&set);
    stage_corner(&set, SMALL);
    hl_light *light = add_light(&set, (hl_light_type)type);
    set_emission(light, IMAGE, quarters());
    stage_render(&set, &options, expected);
    for (int method = HL_SOFT_CASCADE; method <= HL_SOFT_SUBLIGHTS; method += 2) {
      set.scene.render.soft_method = (hl_soft_method)method;
      set.scene.render.light_samples = 6;
      stage_render_sheets(&set, pixels);
      double error = difference(expected, pixels);
      print_message("# light %d, method %d: error %.4f\n", type, method, error);
      assert_true(error < 0.03);
    }
    light->emission.pixels = NULL;
    light->intensity =
        0.5; /* a grey light of the same brightness differs from the coloured light by more than the bar */
    stage_render_sheets(&set, pixels);
    assert_true(difference(expected, pixels) > 0.045);
    stage_close(&set);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_two_colors_over_an_edge),
      cmocka_unit_test(test_a_pin_hole_shows_the_light),
      cmocka_unit_test(test_an_even_image_is_none),
      cmocka_unit_test(test_hard_shadows_have_the_mean),
      cmocka_unit_test(test_every_kind_of_light_against_the_reference),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
