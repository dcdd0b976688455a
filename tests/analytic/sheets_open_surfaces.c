/* analytic/sheets_open_surfaces.c - a volume's surface is lit by the light at its outside. A white surface is
 * as bright as the cosine of the light's angle, at any width of the surface's edge, under any transfer
 * function, from any view and by every method of shadows. A layer shades the matter behind it. */
#include "../asserts.h"
#include "reference_stage.h"

enum { SIDE = 12, PIXELS = SIDE * SIDE, GRID = 48 };

static const double DEGREE = HL_PI / 180;

/* Adds a wide floor at z = 0, whose values fall from 1 to 0 over `edge` voxels. */
static hl_scene_volume *add_floor(stage *set, double edge) {
  static float voxels[16 * 16 * GRID];
  for (int i = 0; i < 16 * 16 * GRID; i++) {
    double z = i / 256 - (GRID - 1) / 2.0;
    voxels[i] = (float)fmin(fmax(0.5 - z / edge, 0), 1);
  }
  hl_scene_volume *volume = stage_add_grid(set, (size_t[3]){16, 16, GRID}, (double[3]){24, 24, 1},
                                           (vec3){-192, -192, -GRID / 2.0}, voxels);
  volume->transfer_function.unit_distance = 1;
  volume->shading = HL_SHADING_PHONG;
  volume->material = (hl_material){.diffuse = 1};
  return volume;
}

static vec3 way_from(double elevation, double azimuth) {
  return (vec3){-cos(elevation) * cos(azimuth), -cos(elevation) * sin(azimuth), -sin(elevation)};
}

static void open_floor(stage *set, hl_shadows shadows, hl_soft_method method) {
  stage_open(set);
  set->scene.width = set->scene.height = SIDE;
  set->scene.camera.type = HL_CAMERA_ORTHOGRAPHIC;
  set->scene.camera.height = 14;
  set->scene.render.shadows = shadows;
  set->scene.render.soft_method = method;
}

static void look_from(stage *set, double elevation) {
  vec3 way = way_from(elevation, 0);
  stage_look(set, vec3_scale(way, -300), (vec3){0, 0, 0},
             elevation < 1.4 ? (vec3){0, 0, 1} : (vec3){1, 0, 0});
}

static double mean(const float *pixels) {
  double sum = 0;
  for (int i = 0; i < PIXELS; i++) sum += (double)pixels[4 * i];
  return sum / PIXELS;
}

static const hl_opacity_point FUNCTIONS[4][3] = {{{0, 0}, {1, 0.999}, {2, 0.999}},
                                                 {{0.5, 0}, {0.7, 0.99}, {1, 0.99}},
                                                 {{0.4, 0}, {0.405, 0.9}, {1, 0.9}},
                                                 {{0.4, 0}, {0.405, 0.999}, {1, 0.999}}};

/* A floor that nothing shades is as bright as N.L. */
static void test_floors(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  static const double lights[4] = {10, 25, 50, 90}, eyes[3] = {15, 45, 90}, edges[3] = {1, 3, 6};
  for (int trial = 0; trial < 4 * 4 * 3 * 3; trial++) {
    const double light = lights[trial % 4] * DEGREE, eye = eyes[trial / 4 % 3] * DEGREE;
    const int method = trial % 3; /* hard shadows, or soft shadows by the cascade or the paper's method */
    stage set;
    open_floor(&set, method == 0 ? HL_SHADOWS_HARD : HL_SHADOWS_SOFT,
               method == 1 ? HL_SOFT_CASCADE : HL_SOFT_PAPER);
    hl_scene_volume *volume = add_floor(&set, edges[trial / 12 % 3]);
    volume->transfer_function.opacity = FUNCTIONS[trial / 36];
    volume->transfer_function.opacity_count = 3;
    stage_add_directional(&set, way_from(light, 0.5))->angular_diameter_deg = 3;
    look_from(&set, eye);
    stage_render_sheets(&set, pixels);
    assert_near(mean(pixels) / sin(light), 1, 0.03);
    stage_close(&set);
  }
}

/* The floor of test_floors() is as bright as N.L also under sub-lights. There are fewer trials, because each
 * trial has many lights. */
static void test_floors_by_sublights(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  for (int trial = 0; trial < 4; trial++) {
    stage set;
    open_floor(&set, HL_SHADOWS_SOFT, HL_SOFT_SUBLIGHTS);
    hl_scene_volume *volume = add_floor(&set, 2 + trial);
    volume->transfer_function.opacity = FUNCTIONS[trial];
    volume->transfer_function.opacity_count = 3;
    stage_add_directional(&set, way_from((20 + 15 * trial) * DEGREE, 0.5))->angular_diameter_deg = 3;
    look_from(&set, 40 * DEGREE);
    stage_render_sheets(&set, pixels);
    assert_near(mean(pixels) / sin((20 + 15 * trial) * DEGREE), 1, 0.03);
    stage_close(&set);
  }
}

/* Returns the fraction of light that skin lets pass. White bone lies below black skin of neighbouring values,
 * and eye and light are above. The fraction is the bone's brightness divided by its brightness without
 * shadows. */
static double light_on_bone(const hl_opacity_point *function, size_t count, double skin) {
  static float pixels[PIXELS * 4], voxels[16 * 16 * GRID];
  static const hl_color_point colors[] = {
      {0, {0, 0, 0}}, {0.64, {0, 0, 0}}, {0.65, {1, 1, 1}}, {1, {1, 1, 1}}};
  double sent[2];
  for (int i = 0; i < 16 * 16 * GRID; i++) {
    double z = i / 256 - (GRID - 1) / 2.0;
    voxels[i] = z < 0 ? 1 : z < skin ? 0.4f : 0;
  }
  for (int shadowed = 0; shadowed < 2; shadowed++) {
    stage set;
    open_floor(&set, shadowed ? HL_SHADOWS_HARD : HL_SHADOWS_OFF, HL_SOFT_CASCADE);
    hl_scene_volume *volume = stage_add_grid(&set, (size_t[3]){16, 16, GRID}, (double[3]){24, 24, 1},
                                             (vec3){-192, -192, -GRID / 2.0}, voxels);
    volume->transfer_function = (hl_transfer_function){
        .opacity = function, .opacity_count = count, .color = colors, .color_count = 4, .unit_distance = 1};
    volume->shading = HL_SHADING_PHONG;
    volume->material = (hl_material){.diffuse = 1};
    stage_add_directional(&set, (vec3){0, 0, -1});
    look_from(&set, 90 * DEGREE);
    stage_render_sheets(&set, pixels);
    sent[shadowed] = mean(pixels);
    stage_close(&set);
  }
  assert_true(sent[0] > 0.01);
  return sent[1] / sent[0];
}

/* Without skin, the bone's blurred edge has values of skin. These values do not shade the bone. A skin that
 * is several voxels thick shades the bone. */
static void test_layers(void **state) {
  (void)state;
  static const hl_opacity_point stair[] = {{0.3, 0}, {0.32, 0.3}, {0.6, 0.3}, {0.7, 0.999}, {1, 0.999}};
  static const hl_opacity_point valley[] = {{0.3, 0}, {0.32, 0.3},   {0.5, 0.3}, {0.52, 0},
                                            {0.6, 0}, {0.65, 0.999}, {1, 0.999}};
  assert_near(light_on_bone(stair, 5, 0), 1, 0.03);
  for (int skin = 4; skin <= 6; skin += 2) {
    double passing = pow(0.7, skin);
    assert_true(light_on_bone(stair, 5, skin) < 1.6 * passing &&
                light_on_bone(stair, 5, skin) > 0.8 * passing);
    assert_true(light_on_bone(valley, 7, skin) < 1.9 * passing &&
                light_on_bone(valley, 7, skin) > 0.8 * passing);
  }
}

static double greatest(const float *pixels) {
  double most = 0;
  for (int i = 0; i < PIXELS; i++) most = fmax(most, (double)pixels[4 * i]);
  return most;
}

/* Adds a wall on a floor. The wall's first voxel is 4 voxels below the origin. */
static void add_wall(stage *set, int thickness, const hl_opacity_point *function) {
  static float voxels[64 * 8 * GRID];
  for (int i = 0; i < 64 * 8 * GRID; i++) {
    int x = i % 64, z = i / 512;
    voxels[i] = z < 16 || (x >= 24 && x < 24 + thickness && z < 40) ? 1 : 0;
  }
  hl_scene_volume *volume = stage_add_grid(set, (size_t[3]){64, 8, GRID}, (double[3]){1, 24, 1},
                                           (vec3){-28, -96, -16}, voxels);
  volume->transfer_function.opacity = function;
  volume->transfer_function.opacity_count = 3;
  volume->transfer_function.unit_distance = 1;
  volume->shading = HL_SHADING_PHONG;
  volume->material = (hl_material){.diffuse = 1};
}

/* No light comes through the corner behind a wall on a floor, even if the wall is thin and the light is low.
 * Before the wall, the floor is as bright as N.L. */
static void test_wall_on_a_floor(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  for (int trial = 0; trial < 4 * 2 * 2; trial++) {
    const int f = trial % 4, thickness = trial / 4 % 2 ? 3 : 8;
    const double light = trial / 8 ? 15 * DEGREE : 30 * DEGREE;
    stage set;
    open_floor(&set, HL_SHADOWS_HARD, HL_SOFT_CASCADE);
    add_wall(&set, thickness, FUNCTIONS[f]);
    stage_add_directional(&set, way_from(light, HL_PI));
    set.scene.camera.height = 6;
    for (int side = 0; side < 2; side++) { /* the pictures show the floor 5 to 11 voxels before the wall, and
                                              0 to 6 voxels behind the wall */
      double x = side == 0 ? -12 : thickness - 0.5;
      stage_look(&set, (vec3){x, 0, 300}, (vec3){x, 0, 0}, (vec3){0, 1, 0});
      stage_render_sheets(&set, pixels);
      assert_near(mean(pixels) / sin(light), side == 0 ? 1 : 0, 0.03);
      if (side == 1 && !(greatest(pixels) / sin(light) < 0.08))
        fail_msg("function %d, wall of %d, light at %.0f degrees: %.3f of the light in the corner", f,
                 thickness, light / DEGREE, greatest(pixels) / sin(light));
    }
    stage_close(&set);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_floors),
                                     cmocka_unit_test(test_floors_by_sublights),
                                     cmocka_unit_test(test_layers), cmocka_unit_test(test_wall_on_a_floor)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
