/* analytic/sheets_sky.c - the light of a sky in pictures of sheets, compared with closed forms, with the
 * reference, and between numbers of threads. */
#include <stdlib.h>
#include <string.h>

#include "../asserts.h"
#include "reference_stage.h"

enum { SIDE = 16, PIXELS = SIDE * SIDE };

static void open_sky(stage *set) {
  stage_open(set);
  set->scene.width = set->scene.height = SIDE;
  set->scene.camera.height = 24;
  set->scene.sky.type = HL_SKY_UNIFORM;
}

/* Returns the colour of the pixel in the middle, divided by its alpha. */
static double middle(const float *pixels, int channel) {
  const float *pixel = pixels + 4 * (SIDE / 2 * SIDE + SIDE / 2);
  return (double)pixel[channel] / (double)pixel[3];
}

/* Haze that is so thin that it hides nothing has the sky's mean radiance in each colour. */
static void test_thin_haze(void **state) {
  (void)state;
  for (int kind = 0; kind < 2; kind++) {
    static float pixels[PIXELS * 4];
    stage set;
    open_sky(&set);
    stage_set_opacity(&set, stage_add_box(&set, (vec3){-8, -8, -8}, (vec3){8, 8, 8}), 1e-4, 1);
    hl_sky *sky = &set.scene.sky;
    sky->type = kind == 0 ? HL_SKY_UNIFORM : HL_SKY_GRADIENT;
    sky->color[0] = 0.5, sky->color[2] = 2;
    stage_render_sheets(&set, pixels);
    for (int c = 0; c < 3; c++) {
      double expected = kind == 0 ? sky->color[c]
                                  : sky->horizon[c] / 2 + (sky->zenith[c] + sky->ground[c]) / 4;
      assert_near(middle(pixels, c), expected, 0.004 * expected);
    }
    stage_close(&set);
  }
}

/* The light of a wide slab of haze under an even sky is the mean of (E2(t) + E2(T - t)) / 2 over the optical
 * depth t, weighted by the fraction of each depth that the eye sees. Each colour has its own optical
 * depth. */
static void test_slab(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  const double thickness = 8, sigma = 0.1;
  stage set;
  open_sky(&set);
  hl_scene_volume *slab = stage_add_grid(&set, (size_t[3]){60, 60, 8}, (double[3]){2, 2, 1},
                                         (vec3){-60, -60, -4}, NULL);
  stage_set_opacity(&set, slab, 1 - exp(-sigma), 1);
  slab->attenuation_color[1] = 0.5;
  slab->attenuation_color[2] = 0;
  stage_render_sheets(&set, pixels);
  for (int c = 0; c < 3; c++) {
    double sum = 0, weights = 0;
    for (int i = 0; i < 200; i++) {
      double t = sigma * thickness * (i + 0.5) / 200, weight = exp(-t), scale = slab->attenuation_color[c],
             mean = 0;
      for (int j = 0; j < 400; j++) {
        double mu = (j + 0.5) / 400;
        mean += (exp(-scale * t / mu) + exp(-scale * (sigma * thickness - t) / mu)) / 800;
      }
      sum += weight * mean;
      weights += weight;
    }
    assert_near(middle(pixels, c), sum / weights, 0.015);
  }
  stage_close(&set);
}

/* The light of a hemisphere comes only from above. */
static void test_hemisphere(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  stage set;
  open_sky(&set);
  stage_set_opacity(&set, stage_add_box(&set, (vec3){-8, -8, -8}, (vec3){8, 8, 8}), 1e-4, 1);
  set.scene.sky.hemisphere = 1;
  stage_render_sheets(&set, pixels);
  assert_near(middle(pixels, 0), 0.5, 0.004);
  stage_close(&set);
}

enum { GRID = 24 };

/* Adds a ball above a plate, of smooth voxels, shaded as surfaces. */
static void add_scene(stage *set, const hl_opacity_point opacity[2]) {
  hl_scene_volume *volume = stage_add_ball_and_plate(set, opacity);
  volume->transfer_function.unit_distance = 1;
  volume->shading = HL_SHADING_PHONG;
  volume->material = (hl_material){.diffuse = 1};
  stage_look(set, (vec3){30, -80, 50}, (vec3){0, 0, -2}, (vec3){0, 0, 1});
}

static const hl_opacity_point OPACITY[2] = {{0.3, 0}, {0.7, 0.9}};

/* The root mean square difference from the reference's picture is small. */
static void test_against_the_reference(void **state) {
  (void)state;
  static float sheets[PIXELS * 4], exact[PIXELS * 4];
  stage set;
  open_sky(&set);
  add_scene(&set, OPACITY);
  hl_reference_options options;
  hl_reference_options_defaults(&options);
  options.light_points = 100;
  stage_render_sheets(&set, sheets);
  stage_render(&set, &options, exact);
  double squares = 0, difference = 0, count = 0, light = 0;
  for (int i = 0; i < PIXELS; i++) {
    if (exact[4 * i + 3] < 0.5f) continue;
    double d = (double)(sheets[4 * i] / sheets[4 * i + 3]) - (double)(exact[4 * i] / exact[4 * i + 3]);
    squares += d * d;
    difference += d;
    light += (double)(exact[4 * i] / exact[4 * i + 3]);
    count++;
  }
  assert_true(count > 60 && light / count > 0.3);
  assert_near(difference / count, 0, 0.02);
  assert_near(sqrt(squares / count), 0, 0.035);
  stage_close(&set);
}

/* Adds a wide slab, whose values fall from 1 to 0 over `edge` voxels at its upper face, or a ball of the
 * radius 9.
 */
static hl_scene_volume *add_soft_matter(stage *set, bool ball, double edge) {
  static float voxels[GRID * GRID * GRID];
  for (int i = 0; i < GRID * GRID * GRID; i++) {
    double x = i % GRID - 11.5, y = i / GRID % GRID - 11.5, z = i / GRID / GRID - 11.5,
           depth = ball ? 7 - sqrt(x * x + y * y + z * z) : -z;
    voxels[i] = (float)fmin(fmax(0.5 + depth / edge, 0), 1);
  }
  const double wide = ball ? 1 : 8;
  hl_scene_volume *volume = stage_add_grid(set, (size_t[3]){GRID, GRID, GRID}, (double[3]){wide, wide, 1},
                                           (vec3){-12 * wide, -12 * wide, -12}, voxels);
  volume->transfer_function.opacity_count = 2;
  volume->transfer_function.unit_distance = 1;
  volume->shading = HL_SHADING_PHONG;
  volume->material = (hl_material){.diffuse = 1};
  return volume;
}

static const hl_opacity_point FUNCTIONS[4][2] = {
    {{0.3, 0}, {0.7, 0.9}}, {{0.2, 0}, {0.6, 0.99}}, {{0.45, 0}, {0.55, 0.999}}, {{0.6, 0}, {0.8, 0.95}}};

/* A white surface of a volume that sees half of an even sky has the sky's radiance, at any width of its edge
 * and under any transfer function, because the light at its outside lights the surface. Each point of a ball
 * sees half of the sky, so that a ball has the sky's radiance from all sides. */
static void test_open_surfaces(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  static const double edges[3] = {1, 3, 6};
  for (int trial = 0; trial < 2 * 4 * 3; trial++) {
    bool ball = trial % 2;
    stage set;
    open_sky(&set);
    set.scene.camera.height = ball ? 10 : 24;
    add_soft_matter(&set, ball, edges[trial / 2 % 3])->transfer_function.opacity = FUNCTIONS[trial / 6];
    stage_look(&set, (vec3){10, -30, 60}, (vec3){0, 0, 0}, (vec3){0, 0, 1});
    stage_render_sheets(&set, pixels);
    assert_near(middle(pixels, 0), 1, 0.05);
    stage_close(&set);
  }
}

/* Adds a square ground, `half` to either side, and a pane that the eye does not see. meshes: [2]; the ground
 * and the pane, which own their hl_mesh. */
static void add_ground_and_pane(stage *set, hl_scene_mesh *meshes, double half, hl_mesh *pane) {
  for (int m = 0; m < 2; m++) {
    hl_scene_mesh_defaults(&meshes[m]);
    meshes[m].material = (hl_material){.diffuse = 1};
    for (int c = 0; c < 3; c++) meshes[m].color[c] = 1;
  }
  meshes[0].mesh = stage_make_quad(set, (vec3){0, 0, 0}, (vec3){half, 0, 0}, (vec3){0, half, 0});
  meshes[1].mesh = pane;
  meshes[1].visible = 0;
  set->scene.meshes = meshes;
  set->scene.mesh_count = 2;
}

/* A square below a half plane gets (1 - sin a) / 2 of the sky, where a is the angle from the vertical at
 * which the square sees the half plane's edge. The mean of the pixels on the two sides of the edge is 1/2, or
 * 0.8 below a pane of the opacity 0.4, or 1 below a transparent pane. The pane is a mesh that the eye does
 * not see. */
static void test_meshes(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  const double opacity[3] = {1, 0.4, 0}, expected[3] = {0.5, 0.8, 1};
  for (int k = 0; k < 3; k++) {
    stage set;
    hl_scene_mesh meshes[2];
    open_sky(&set);
    stage_set_opacity(&set, stage_add_box(&set, (vec3){-0.5, -0.5, -0.5}, (vec3){0.5, 0.5, 0.5}), 0, 1);
    add_ground_and_pane(&set, meshes, 9,
                        stage_make_quad(&set, (vec3){40, 0, 5}, (vec3){40, 0, 0}, (vec3){0, 40, 0}));
    meshes[1].opacity = opacity[k];
    stage_render_sheets(&set, pixels);
    const float *pair = pixels + 4 * (SIDE / 2 * SIDE + SIDE / 2 - 1);
    assert_near((double)(pair[0] + pair[4]) / 2, expected[k], 0.03);
    for (int m = 0; m < 2; m++) hl_mesh_release(meshes[m].mesh);
    stage_close(&set);
  }
}

/* Returns the fraction of a whole sky's light that a rectangle hides from a parallel square below one of its
 * corners (the form factor of a corner). x, y: the rectangle's sides divided by its height. */
static double hidden_by_corner(double x, double y) {
  double a = sqrt(1 + x * x), b = sqrt(1 + y * y);
  return (x / a * atan(y / a) + y / b * atan(x / b)) / (2 * HL_PI);
}

/* The light below the edge of a pane grows evenly, without steps at the places where the light of one
 * direction ends. */
static void test_edge_of_a_mesh(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  const double height = 12, side = 40;
  double squares = 0;
  stage set;
  hl_scene_mesh meshes[2];
  open_sky(&set);
  stage_set_opacity(&set, stage_add_box(&set, (vec3){-0.5, -0.5, -0.5}, (vec3){0.5, 0.5, 0.5}), 0, 1);
  add_ground_and_pane(
      &set, meshes, 12,
      stage_make_quad(&set, (vec3){side / 2, 0, height}, (vec3){side / 2, 0, 0}, (vec3){0, side, 0}));
  stage_render_sheets(&set, pixels);
  for (int column = 1; column < SIDE - 1; column++) {
    double x = (column + 0.5 - SIDE / 2) * set.scene.camera.height / SIDE,
           hidden = 2 * (hidden_by_corner((side - x) / height, side / height) -
                         hidden_by_corner(-x / height, side / height)),
           d = (double)pixels[4 * (SIDE / 2 * SIDE + column)] - (1 - hidden);
    squares += d * d / (SIDE - 2);
  }
  assert_near(sqrt(squares), 0, 0.025);
  for (int m = 0; m < 2; m++) hl_mesh_release(meshes[m].mesh);
  stage_close(&set);
}

/* A cut face of even matter sees half of the sky, as any plane does, and gets the sky's radiance. A clip box
 * and a plane leave the same face. */
static void test_cut_faces(void **state) {
  (void)state;
  enum { HEIGHTS = 5 };
  static float pixels[PIXELS * 4], voxels[GRID * GRID * GRID];
  for (int i = 0; i < GRID * GRID * GRID; i++) voxels[i] = (float)(0.9 + 0.004 * (i % GRID));
  for (int i = 0; i < 2 * HEIGHTS; i++) {
    const double height = 1 + 0.2 * (i / 2);
    const hl_cut plane = {.type = HL_CUT_PLANE, .point = {0, 0, height}, .normal = {0, 0, 1}};
    stage set;
    open_sky(&set);
    hl_scene_volume *volume = stage_add_grid(&set, (size_t[3]){GRID, GRID, GRID}, (double[3]){1, 1, 1},
                                             (vec3){-12, -12, -12}, voxels);
    volume->transfer_function.opacity = OPACITY;
    volume->transfer_function.opacity_count = 2;
    volume->shading = HL_SHADING_PHONG;
    volume->material = (hl_material){.diffuse = 1};
    if (i % 2) {
      volume->clipped = true;
      for (int a = 0; a < 3; a++) volume->clip_min[a] = -12.5, volume->clip_max[a] = a == 2 ? height : 11.5;
    } else {
      volume->cuts = &plane;
      volume->cut_count = 1;
    }
    stage_look(&set, (vec3){10, -30, 60}, (vec3){0, 0, height}, (vec3){0, 0, 1});
    stage_render_sheets(&set, pixels);
    assert_near(middle(pixels, 0), 1, 0.03);
    stage_close(&set);
  }
}

static void render_on(int threads, hl_instruction_set instructions, float *pixels) {
  hl_context_options options;
  hl_context_options_defaults(&options);
  options.instruction_set = instructions;
  stage own;
  stage_open_with(&own, &options);
  own.scene.width = own.scene.height = SIDE;
  own.scene.camera.height = 24;
  own.scene.sky.type = HL_SKY_GRADIENT;
  own.scene.render.threads = threads;
  add_scene(&own, OPACITY);
  stage_render_sheets(&own, pixels);
  stage_close(&own);
}

static void test_same_bytes(void **state) {
  (void)state;
  static float one[PIXELS * 4], other[PIXELS * 4];
  render_on(1, HL_INSTRUCTION_SET_AUTO, one);
  render_on(5, HL_INSTRUCTION_SET_AUTO, other);
  assert_memory_equal(one, other, sizeof one);
  render_on(2, HL_INSTRUCTION_SET_SCALAR, other);
  assert_memory_equal(one, other, sizeof one);
}

/* A renderer that keeps the sky's light between frames makes the picture of a new renderer after the camera,
 * the sky, or a volume's opacity has changed. */
static void test_kept_light(void **state) {
  (void)state;
  static float kept[PIXELS * 4], fresh[PIXELS * 4];
  static const hl_opacity_point thinner[2] = {{0.4, 0}, {0.7, 0.5}};
  stage set;
  hl_renderer *renderer = NULL;
  open_sky(&set);
  add_scene(&set, OPACITY);
  assert_int_equal(hl_renderer_create(set.context, &renderer, NULL), HL_OK);
  for (int change = 0; change < 5; change++) {
    if (change == 1) stage_look(&set, (vec3){-30, -60, 30}, (vec3){0, 0, -2}, (vec3){0, 0, 1});
    if (change == 2) set.scene.sky.color[0] = 0.4;
    if (change == 3) set.volumes[0].transfer_function.opacity = thinner;
    if (change == 4) set.scene.sky.hemisphere = 1;
    stage_render_with(&set, renderer, kept);
    stage_render_sheets(&set, fresh);
    assert_memory_equal(kept, fresh, sizeof kept);
  }
  hl_renderer_destroy(renderer);
  stage_close(&set);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_thin_haze),  cmocka_unit_test(test_slab),
      cmocka_unit_test(test_hemisphere), cmocka_unit_test(test_against_the_reference),
      cmocka_unit_test(test_meshes),     cmocka_unit_test(test_edge_of_a_mesh),
      cmocka_unit_test(test_same_bytes), cmocka_unit_test(test_kept_light),
      cmocka_unit_test(test_cut_faces),  cmocka_unit_test(test_open_surfaces),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
