/* analytic/sheets_in_glass.c - a surface of one volume within another volume that casts shadows, as an
 * organ's label in a translucent body. The light on the surface is the light that the other volume lets pass,
 * whatever part of a slab the surface takes. */
#include "../asserts.h"
#include "reference_stage.h"

enum { SIDE = 24, PIXELS = SIDE * SIDE, GRID = 48, GLASS = 60, TOP = 40 };

static const double DEGREE = HL_PI / 180;

/* The glass has an opaque skin and a thin inside. */
static const hl_opacity_point GLASS_OPACITY[] = {{0.1, 0}, {0.2, 0.15}, {0.3, 0.001}, {1, 0.001}};
static const hl_opacity_point FLOOR_OPACITY[][3] = {{{0, 0}, {1, 0.999}, {2, 0.999}},
                                                    {{0.5, 0}, {0.7, 0.99}, {1, 0.99}}};

/* The optical depth of the glass from its top down to the height z, straight down: the values rise by 1 /
 * GLASS per unit of length. */
static double depth_of_glass(double z) {
  const int steps = 100000;
  double sum = 0;
  for (int i = 0; i < steps; i++) {
    const double value = (TOP - z) / GLASS * (i + 0.5) / steps;
    for (int p = 0; p < 3; p++) {
      const hl_opacity_point a = GLASS_OPACITY[p], b = GLASS_OPACITY[p + 1];
      if (value >= a.value && value < b.value)
        sum -= log(1 - (a.opacity + (b.opacity - a.opacity) * (value - a.value) / (b.value - a.value)));
    }
  }
  return sum / steps * (TOP - z);
}

static vec3 way_from(double elevation, double azimuth) {
  return (vec3){-cos(elevation) * cos(azimuth), -cos(elevation) * sin(azimuth), -sin(elevation)};
}

/* Adds a wide opaque floor at z = 0, whose values fall from 1 to 0 over `edge` voxels. */
static void add_floor(stage *set, double edge, const hl_opacity_point *opacity) {
  static float voxels[16 * 16 * GRID];
  for (int i = 0; i < 16 * 16 * GRID; i++)
    voxels[i] = (float)fmin(fmax(0.5 - (i / 256 - (GRID - 1) / 2.0) / edge, 0), 1);
  hl_scene_volume *floor = stage_add_grid(set, (size_t[3]){16, 16, GRID}, (double[3]){24, 24, 1},
                                          (vec3){-192, -192, -GRID / 2.0}, voxels);
  floor->transfer_function.unit_distance = 1;
  floor->transfer_function.opacity = opacity;
  floor->transfer_function.opacity_count = 3;
  floor->shading = HL_SHADING_PHONG;
  floor->material = (hl_material){.diffuse = 1};
}

/* Adds glass around the floor that the eye does not see. Its values rise evenly downwards, from 0 at z = TOP.
 */
static hl_scene_volume *add_glass(stage *set) {
  static float voxels[16 * 16 * (GLASS + 2)];
  for (int i = 0; i < 16 * 16 * (GLASS + 2); i++)
    voxels[i] = (float)(TOP - (TOP - GLASS - 0.5 + i / 256)) / GLASS;
  hl_scene_volume *glass = stage_add_grid(set, (size_t[3]){16, 16, GLASS + 2}, (double[3]){24, 24, 1},
                                          (vec3){-192, -192, TOP - GLASS - 1}, voxels);
  glass->transfer_function.unit_distance = 1;
  glass->transfer_function.opacity = GLASS_OPACITY;
  glass->transfer_function.opacity_count = sizeof GLASS_OPACITY / sizeof *GLASS_OPACITY;
  glass->shading = HL_SHADING_PHONG;
  glass->visible = 0;
  return glass;
}

static void open_floor(stage *set, int trial, double light, double eye) {
  stage_open(set);
  set->scene.width = set->scene.height = SIDE;
  set->scene.camera.type = HL_CAMERA_ORTHOGRAPHIC;
  set->scene.camera.height = 14;
  set->scene.render.shadows = trial % 3 == 0 ? HL_SHADOWS_HARD : HL_SHADOWS_SOFT;
  set->scene.render.soft_method = trial % 3 == 1 ? HL_SOFT_CASCADE : HL_SOFT_PAPER;
  set->scene.render.sheet_spacing = 0.5;
  stage_add_directional(set, way_from(light, 0.5))->angular_diameter_deg = 3;
  stage_look(set, vec3_scale(way_from(eye, 0), -300), (vec3){0, 0, 0},
             eye < 1.4 ? (vec3){0, 0, 1} : (vec3){1, 0, 0});
}

/* Returns the brightness of the floor: N.L times the transmittance of the glass. */
static double expected_on_floor(double light) { return sin(light) * exp(-depth_of_glass(0) / sin(light)); }

/* Every pixel of the floor has the expected brightness. The second function turns opaque over a fifth of the
 * floor's edge; narrower surfaces differ more. */
static void test_floors_in_glass(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  static const double lights[3] = {25, 50, 80}, eyes[3] = {20, 45, 90}, edges[4] = {2, 3, 6, 6};
  for (int trial = 0; trial < 4 * 3 * 3; trial++) {
    const double light = lights[trial % 3] * DEGREE, eye = eyes[trial / 3 % 3] * DEGREE;
    stage set;
    open_floor(&set, trial / 3 + trial, light, eye);
    add_floor(&set, edges[trial / 9], FLOOR_OPACITY[trial / 27]);
    add_glass(&set);
    stage_render_sheets(&set, pixels);
    for (int i = 0; i < PIXELS; i++)
      assert_near((double)pixels[4 * i] / expected_on_floor(light), 1, trial < 27 ? 0.02 : 0.08);
    stage_close(&set);
  }
}

/* So has the reference's floor. */
static void test_the_reference(void **state) {
  (void)state;
  static float pixels[4];
  for (int trial = 0; trial < 2; trial++) {
    stage set;
    open_floor(&set, 0, 50 * DEGREE, 45 * DEGREE);
    set.scene.width = set.scene.height = 1;
    add_floor(&set, 3, FLOOR_OPACITY[trial]);
    add_glass(&set);
    stage_render_by(&set, true, pixels);
    assert_near((double)pixels[0] / expected_on_floor(50 * DEGREE), 1, 0.005);
    stage_close(&set);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_floors_in_glass),
                                     cmocka_unit_test(test_the_reference)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
