/* analytic/sheets_plane.c - transfer functions of two numbers: value and gradient of a ramp, or the values of
 * two volumes. The two numbers are known everywhere, so that the picture and the light that passes are known.
 * The sheets and the reference are tested. */
#include <stdlib.h>
#include <string.h>

#include "../asserts.h"
#include "grid/classifier.h"
#include "reference_stage.h"

enum { SIDE = 24, PIXELS = SIDE * SIDE, N = 24 };

typedef double field_function(double x, double y, double z);

static double ramp(double x, double y, double z) {
  (void)y, (void)z;
  return 3 * x;
}
static double rising_along_y(double x, double y, double z) {
  (void)x, (void)z;
  return 2 * y + 100;
}
static double paraboloid(double x, double y, double z) { return x * x + y * y + z * z; }

/* Adds a cube of N^3 voxels of edge 1 around the origin with a field. */
static hl_scene_volume *add_cube(stage *set, field_function *field) {
  static float voxels[N * N * N];
  float *out = voxels;
  const double low = -N / 2.0;
  for (int k = 0; k < N; k++)
    for (int j = 0; j < N; j++)
      for (int i = 0; i < N; i++) *out++ = (float)field(i + 0.5 + low, j + 0.5 + low, k + 0.5 + low);
  return stage_add_grid(set, (size_t[3]){N, N, N}, (double[3]){1, 1, 1}, (vec3){low, low, low}, voxels);
}

static void open_from_z(stage *set) {
  stage_open(set);
  set->scene.width = set->scene.height = SIDE;
  set->scene.camera.height = N;
  stage_look(set, (vec3){0, 0, 100}, (vec3){0, 0, 0}, (vec3){0, 1, 0});
}

static void set_boxes(hl_scene_volume *volume, hl_second_axis second, const hl_function_box *boxes,
                      size_t count) {
  volume->transfer_function.plane.second = second;
  volume->transfer_function.plane.boxes = boxes;
  volume->transfer_function.plane.box_count = count;
}

static const float *pixel_at(const float *pixels, double x, double y) {
  return &pixels[4 * ((int)(SIDE / 2 - y) * SIDE + (int)(x + SIDE / 2))];
}

static void assert_seen(const float *pixel, const double color[3], double alpha, double tolerance) {
  assert_near((double)pixel[3], alpha, tolerance);
  for (int c = 0; c < 3; c++) assert_near((double)pixel[c], color[c] * alpha, tolerance);
}

/* ---- a ramp whose gradient has the length 3: only the box that holds it shows ---- */

static const double RED[3] = {0.9, 0.2, 0.1}, BLUE[3] = {0.1, 0.3, 0.8};

/* The boxes hold the ramp's values where x is from -8 to -2 and from 2 to 8. */
static void test_ramp_shows_the_box_with_its_gradient(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  const hl_function_box boxes[] = {
      {.low = {-24, 2}, .high = {-6, 4}, .color = {0.9, 0.2, 0.1}, .opacity = 0.1},
      {.low = {-24, 4.5}, .high = {-6, 9}, .color = {1, 1, 1}, .opacity = 0.9},
      {.low = {-24, 0}, .high = {-6, 2.5}, .color = {1, 1, 1}, .opacity = 0.9},
      {.low = {6, 2.8}, .high = {24, 3.2}, .color = {0.1, 0.3, 0.8}, .opacity = 0.2}};
  for (int k = 0; k < 4; k++) {
    stage set;
    open_from_z(&set);
    hl_scene_volume *cube = add_cube(&set, ramp);
    cube->shading = HL_SHADING_FLAT;
    cube->transfer_function.unit_distance = 2;
    set_boxes(cube, HL_SECOND_GRADIENT, boxes, 4);
    if (k == 1) set.scene.render.kernel = HL_KERNEL_LINEAR;
    stage_render_by(&set, k >= 2, pixels);
    assert_seen(pixel_at(pixels, -5, 1), RED, 1 - pow(0.9, N / 2), 2e-4);
    assert_seen(pixel_at(pixels, 5, -3), BLUE, 1 - pow(0.8, N / 2), 2e-4);
    assert_near((double)pixel_at(pixels, 0.5, 0)[3], 0, 1e-7);
    assert_near((double)pixel_at(pixels, -9.5, 0)[3], 0, 1e-7);
    stage_close(&set);
  }
}

/* The picture does not depend on world units. A cube that is ten times as large has a tenth of the gradient.
 */
static void test_gradients_are_of_the_world(void **state) {
  (void)state;
  static float pixels[2][PIXELS * 4];
  for (int large = 0; large < 2; large++) {
    double size = large ? 10 : 1;
    stage set;
    open_from_z(&set);
    hl_scene_volume *cube = add_cube(&set, ramp);
    const hl_function_box box = {.low = {-30, 1 / size},
                                 .high = {30, 5 / size},
                                 .color = {1, 1, 1},
                                 .opacity = 0.3,
                                 .edge = {4, 1 / size}};
    cube->scale = size;
    cube->transfer_function.unit_distance = size;
    set.scene.camera.height = N * size;
    stage_look(&set, (vec3){0, 0, 100 * size}, (vec3){0, 0, 0}, (vec3){0, 1, 0});
    set_boxes(cube, HL_SECOND_GRADIENT, &box, 1);
    stage_render_by(&set, false, pixels[large]);
    stage_close(&set);
  }
  for (int i = 0; i < 4 * PIXELS; i++) assert_near((double)pixels[1][i], (double)pixels[0][i], 2e-5);
}

/* ---- weights ---- */

/* The shapes of the function are a box with soft edges, a polygon's cone and an image, each with the gradient
 * 3 in its middle. These functions return a shape's weight at x. */
static double weight_of_edges(double x) { return fmin(fmax((24 - fabs(3 * x)) / 12, 0), 1); }
static double weight_of_cone(double x) { return fmax(1 - fabs(3 * x) / 24, 0); }

static const double DIAMOND[4][2] = {{-24, 3}, {0, 1}, {24, 3}, {0, 5}};
static const float IMAGE[3][3][4] = {{{0}}, {{0}, {0.09f, 0.02f, 0.01f, 0.1f}, {0}}, {{0}}};

static void set_shape(hl_scene_volume *cube, int shape) {
  static const hl_function_box box = {
      .low = {-24, 1}, .high = {24, 5}, .color = {0.9, 0.2, 0.1}, .opacity = 0.1, .edge = {12, 0}};
  static const hl_function_polygon polygon = {.vertices = DIAMOND,
                                              .vertex_count = 4,
                                              .apex = {0, 3},
                                              .color = {0.9, 0.2, 0.1},
                                              .opacity = 0.1,
                                              .falloff = 1};
  hl_function_plane *plane = &cube->transfer_function.plane;
  plane->second = HL_SECOND_GRADIENT;
  if (shape == 0) plane->boxes = &box, plane->box_count = 1;
  if (shape == 1) plane->polygons = &polygon, plane->polygon_count = 1;
  if (shape == 2)
    plane->image = (hl_function_image){
        .pixels = &IMAGE[0][0][0], .width = 3, .height = 3, .low = {-36, 0}, .high = {36, 6}};
}

static void test_weights(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  for (int k = 0; k < 6; k++) {
    int shape = k % 3;
    stage set;
    open_from_z(&set);
    hl_scene_volume *cube = add_cube(&set, ramp);
    cube->shading = HL_SHADING_FLAT;
    cube->clipped = 1; /* at the cube's faces gradients are shorter, so that a clip box leaves them out */
    for (int a = 0; a < 3; a++) cube->clip_min[a] = -10, cube->clip_max[a] = 10;
    cube->transfer_function.unit_distance = 2;
    set_shape(cube, shape);
    stage_render_by(&set, k >= 3, pixels);
    for (int x = -8; x < 8; x++) {
      double weight = shape == 0 ? weight_of_edges(x + 0.5) : weight_of_cone(x + 0.5);
      /* an image interpolates opacity linearly between the middles of pixels, and the other shapes
       * interpolate extinction */
      double opacity = shape == 2 ? 0.1 * weight : 1 - pow(0.9, weight);
      /* the sheets' table has 256 rows for four units, so that a ridge is lower by 1/250 */
      assert_seen(pixel_at(pixels, x + 0.5, 0.5), RED, 1 - pow(1 - opacity, 10),
                  k >= 3 || shape == 0 ? 1e-4 : 4.5e-3);
    }
    stage_close(&set);
  }
}

/* Where boxes overlap, their extinctions are added, and their colours are averaged with the extinctions as
 * weights. */
static void test_overlaps(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  const hl_function_box boxes[] = {
      {.low = {-24, 2}, .high = {12, 4}, .color = {1, 0, 0}, .opacity = 0.1},
      {.low = {-12, 1},
       .high = {24, 5},
       .color = {0, 0, 1},
       .opacity = 0.19}}; /* this box has twice the extinction of the other box */
  for (int reference = 0; reference < 2; reference++) {
    stage set;
    open_from_z(&set);
    hl_scene_volume *cube = add_cube(&set, ramp);
    cube->shading = HL_SHADING_FLAT;
    cube->transfer_function.unit_distance = 4;
    set_boxes(cube, HL_SECOND_GRADIENT, boxes, 2);
    stage_render_by(&set, reference, pixels);
    assert_seen(pixel_at(pixels, 0.5, 0), (double[3]){1.0 / 3, 0, 2.0 / 3}, 1 - pow(0.9, 3 * N / 4.0), 1e-3);
    assert_seen(pixel_at(pixels, -5.5, 0), (double[3]){1, 0, 0}, 1 - pow(0.9, N / 4.0), 1e-3);
    stage_close(&set);
  }
}

/* ---- another volume: shows where its value, 2 y + 100, lies in the box, whatever its grid ---- */

static void test_two_volumes(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  const hl_function_box boxes[] = {
      /* the box holds the second volume's values where y is from 2 to 8 */
      {.low = {-24, 104}, .high = {0, 116}, .color = {0.9, 0.2, 0.1}, .opacity = 0.1},
      {.low = {0, 84},
       .high = {24, 96},
       .color = {0.1, 0.3, 0.8},
       .opacity = 0.2}}; /* the box holds the second volume's values where y is from -8 to -2 */
  for (int k = 0; k < 6; k++) {
    stage set;
    open_from_z(&set);
    if (k % 2) set.type = HL_VOXEL_F32;
    hl_scene_volume *cube = add_cube(&set, ramp);
    cube->shading = HL_SHADING_FLAT;
    cube->transfer_function.unit_distance = 2;
    hl_scene_volume *other = add_cube(&set, rising_along_y);
    if (k % 3 == 1) {
      /* the second volume is half as large and turned; its scale in the scene makes up for the size */
      other->scale = 2;
      other->translate[1] = -12; /* 2 (y + 12) / 2 + 100 = 2 (y / 2) + 112 */
    }
    other->name = "other";
    other->visible = other->casts_shadow = 0;
    set_boxes(cube, HL_SECOND_VOLUME, boxes, 2);
    cube->transfer_function.plane.volume = "other";
    double shift = 0, factor = 1;
    if (k % 3 == 1) shift = -12, factor = 2; /* the second volume has at y the value of (y + 12) / 2 */
    stage_render_by(&set, k >= 3, pixels);
    for (int y = -10; y < 10; y++) {
      double own = (y + 0.5 - shift) / factor;
      bool first = own > 2 && own<8, second = own> - 8 && own < -2;
      bool near_edge = fabs(fabs(own) - 2) < 0.6 || fabs(fabs(own) - 8) < 0.6;
      if (near_edge || fabs(own) > 10) continue;
      assert_seen(pixel_at(pixels, -5, y + 0.5), RED, first ? 1 - pow(0.9, N / 2) : 0, 3e-4);
      assert_seen(pixel_at(pixels, 5, y + 0.5), BLUE, second ? 1 - pow(0.8, N / 2) : 0, 3e-4);
    }
    stage_close(&set);
  }
}

/* The function follows the second volume from frame to frame. A renderer that has drawn another second
 * volume, or the same second volume at another place, makes the bytes of a new renderer. */
static void test_second_volume_changes(void **state) {
  (void)state;
  static float pixels[2][PIXELS * 4];
  const hl_function_box box = {.low = {-30, 90}, .high = {30, 110}, .color = {1, 1, 1}, .opacity = 0.2};
  stage set;
  hl_renderer *renderer = NULL;
  open_from_z(&set);
  hl_scene_volume *cube = add_cube(&set, ramp);
  set_boxes(cube, HL_SECOND_VOLUME, &box, 1);
  cube->transfer_function.plane.volume = "other";
  cube->multiple_scattering = 1;
  for (int c = 0; c < 3; c++) cube->albedo[c] = 0.9;
  hl_scene_volume *first = add_cube(&set, rising_along_y), *second = add_cube(&set, paraboloid);
  first->visible = second->visible = first->casts_shadow = second->casts_shadow = 0;
  set.scene.sky.type = HL_SKY_UNIFORM;
  stage_add_directional(&set, (vec3){-1, -1, -1});
  assert_int_equal(hl_renderer_create(set.context, &renderer, NULL), HL_OK);
  for (int k = 0; k < 4; k++) {
    first->name = k % 2 ? NULL : "other";
    second->name = k % 2 ? "other" : NULL;
    first->translate[0] = second->translate[1] = 3 * (k / 2);
    stage_render_with(&set, renderer, pixels[0]);
    stage_render_sheets(&set, pixels[1]);
    assert_memory_equal(pixels[0], pixels[1], sizeof pixels[0]);
  }
  hl_renderer_destroy(renderer);
  stage_close(&set);
}

/* ---- light: what the function hides casts no shadow ---- */

static const hl_function_box HALF[] = {
    {.low = {-1000, 2}, .high = {1000, 4}, .color = {1, 1, 1}, .opacity = 0}};

/* A ramp is drawn as a medium of even opacity in two ways: by its value alone, or by a box around its
 * gradient, beside a box of other gradients with more opacity. The two pictures are the same under each
 * method, under a sky, and with light that is scattered repeatedly. */
static void test_light(void **state) {
  (void)state;
  static float pixels[2][PIXELS * 4];
  for (int k = 0; k < 10; k++) {
    for (int of_two = 0; of_two < 2; of_two++) {
      stage set;
      open_from_z(&set);
      set.scene.camera.height = 30;
      stage_look(&set, (vec3){30, 20, 50}, (vec3){0, 0, 0}, (vec3){0, 1, 0});
      hl_scene_volume *cube = add_cube(&set, ramp);
      stage_set_opacity(&set, cube, 0.5, 4);
      hl_function_box boxes[2] = {HALF[0], HALF[0]};
      boxes[0].opacity = 0.5;
      boxes[1].opacity = 0.95;
      boxes[1].low[1] = 5;
      boxes[1].high[1] = 9;
      if (of_two) set_boxes(cube, HL_SECOND_GRADIENT, boxes, 2);
      cube->clipped = 1;
      for (int a = 0; a < 3; a++) cube->clip_min[a] = -10, cube->clip_max[a] = 10;
      if (k >= 4 && k < 8) cube->shading = HL_SHADING_PHONG;
      if (k != 8) stage_add_directional(&set, (vec3){-0.6, -0.3, -1});
      if (k % 4 > 0 && k < 8) set.lights[0].angular_diameter_deg = 12;
      if (k == 8) set.scene.sky.type = HL_SKY_UNIFORM;
      if (k == 9) {
        cube->multiple_scattering = 1;
        for (int c = 0; c < 3; c++) cube->albedo[c] = 0.9;
      }
      set.scene.render.shadows = k % 4 > 0 && k < 8 ? HL_SHADOWS_SOFT : HL_SHADOWS_HARD;
      set.scene.render.soft_method = (hl_soft_method)(k % 4 > 0 && k < 8 ? k % 4 - 1 : 0);
      stage_render_sheets(&set, pixels[of_two]);
      stage_close(&set);
    }
    double sum = 0;
    for (int i = 0; i < 4 * PIXELS; i++) sum += pow((double)pixels[0][i] - (double)pixels[1][i], 2);
    assert_near(sqrt(sum / (4 * PIXELS)), 0, k < 8 ? 1e-3 : 4e-3);
  }
}

/* ---- threads ---- */

static void test_threads(void **state) {
  (void)state;
  static float pixels[2][PIXELS * 4];
  for (int threads = 1; threads < 4; threads += 2) {
    stage set;
    open_from_z(&set);
    hl_scene_volume *cube = add_cube(&set, paraboloid);
    const hl_function_box box = {
        .low = {20, 5}, .high = {200, 20}, .color = {1, 0.5, 0}, .opacity = 0.4, .edge = {20, 3}};
    set_boxes(cube, HL_SECOND_GRADIENT, &box, 1);
    cube->shading = HL_SHADING_PHONG;
    stage_add_directional(&set, (vec3){-1, -1, -1})->angular_diameter_deg = 5;
    set.scene.render.shadows = HL_SHADOWS_SOFT;
    set.scene.render.threads = threads;
    stage_render_by(&set, false, pixels[threads / 2]);
    stage_close(&set);
  }
  assert_memory_equal(pixels[0], pixels[1], sizeof pixels[0]);
}

/* ---- scenes that are refused ---- */

static void test_refused(void **state) {
  (void)state;
  hl_function_box box = {.low = {0, 0}, .high = {1, 1}, .opacity = 0.5};
  stage set;
  open_from_z(&set);
  hl_scene_volume *cube = add_cube(&set, ramp);
  set_boxes(cube, HL_SECOND_VOLUME, &box, 1);
  cube->transfer_function.plane.volume = "nothing";
  stage_refused(&set,
                "/volumes/0/transfer_function/second/volume: no volume is called \"nothing\": give a volume "
                "of the scene this name");
  cube->transfer_function.plane.second = HL_SECOND_GRADIENT;
  box.high[1] = 0;
  stage_refused(&set,
                "/volumes/0/transfer_function/boxes/0/second: 0 to 0 is empty: give two numbers, the lower "
                "one first");
  box.high[1] = NAN;
  stage_refused(&set,
                "/volumes/0/transfer_function/boxes/0/second/1: nan is not a number: give a number between "
                "-1e30 and 1e30");
  box.high[1] = 1;
  box.color[2] = 2;
  stage_refused(&set,
                "/volumes/0/transfer_function/boxes/0/color/2: 2 is out of range: give linear RGB, each from "
                "0 to 1");
  box.color[2] = 1;
  set.scene.render.compositing = HL_COMPOSITING_MAXIMUM;
  hl_scene *scene = NULL;
  hl_error error = {0};
  assert_int_equal(hl_scene_create(set.context, &set.scene, &scene, &error), HL_ERROR_UNSUPPORTED);
  assert_string_equal(
      error.message,
      "/volumes/0/transfer_function/second: maximum projections go by one number: remove it, or "
      "render with light");
  stage_close(&set);
}

/* ---- functions that do not depend on the second number ---- */

static classifier classifier_of(stage *set, const hl_scene_volume *volume) {
  const grid grid = {.value_scale = 1, .empty = -36};
  classifier made;
  assert_int_equal(hl_classifier_create(set->context, volume, NULL, &grid, &made, NULL), HL_OK);
  return made;
}

/* One box covers all gradients of values below 0, and another box covers some gradients of values above 20.
 * For values up to 20 no gradient is needed. If the first box covers some gradients only, gradients are
 * needed from its lower edge on. If there is no other box, gradients are needed nowhere. */
static void test_even_columns_are_known(void **state) {
  (void)state;
  const hl_function_box boxes[] = {{.low = {-30, -1}, .high = {0, 1e4}, .color = {1, 1, 1}, .opacity = 0.5},
                                   {.low = {20, 2}, .high = {30, 4}, .color = {1, 1, 1}, .opacity = 0.5},
                                   {.low = {-30, 2}, .high = {0, 4}, .color = {1, 1, 1}, .opacity = 0.5}};
  static const double ends[] = {INFINITY, 20, -30};
  for (int k = 0; k < 3; k++) {
    stage set;
    open_from_z(&set);
    hl_scene_volume *cube = add_cube(&set, ramp);
    set_boxes(cube, HL_SECOND_GRADIENT, k < 2 ? boxes : boxes + 1, k == 0 ? 1 : 2);
    classifier made = classifier_of(&set, cube);
    if (k == 0) assert_true(isinf(made.plane.even_before));
    else {
      double coordinate = (ends[k] + 36) * (double)made.scale, step = 1 / (double)made.plane.column_scale;
      double column = coordinate * (double)made.plane.column_scale + (double)made.plane.column_offset;
      assert_true(step > 0 && (double)made.plane.even_before <= column &&
                  (double)made.plane.even_before > column - 6);
    }
    hl_classifier_release(set.context, &made);
    stage_close(&set);
  }
}

/* A gradient opacity of 1 for all gradients has no effect. */
static void test_opaque_gradients_are_left_out(void **state) {
  (void)state;
  const hl_opacity_point points[2][2] = {{{0, 1}, {5, 1}}, {{0, 0.99}, {5, 1}}};
  for (int k = 0; k < 2; k++) {
    stage set;
    open_from_z(&set);
    hl_scene_volume *cube = add_cube(&set, ramp);
    cube->transfer_function.gradient_opacity = points[k];
    cube->transfer_function.gradient_opacity_count = 2;
    classifier made = classifier_of(&set, cube);
    assert_int_equal(made.steepness != NULL, k);
    hl_classifier_release(set.context, &made);
    stage_close(&set);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_ramp_shows_the_box_with_its_gradient),
      cmocka_unit_test(test_gradients_are_of_the_world),
      cmocka_unit_test(test_weights),
      cmocka_unit_test(test_overlaps),
      cmocka_unit_test(test_two_volumes),
      cmocka_unit_test(test_second_volume_changes),
      cmocka_unit_test(test_light),
      cmocka_unit_test(test_threads),
      cmocka_unit_test(test_even_columns_are_known),
      cmocka_unit_test(test_opaque_gradients_are_left_out),
      cmocka_unit_test(test_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
