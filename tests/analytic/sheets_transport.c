/* analytic/sheets_transport.c - the sheets, against closed forms of absorption, emission and shadow.
 * reference_transport.c tests the reference in the same way. The scenes are homogeneous boxes, for which the
 * value of each ray is known. */
#include <string.h>

#include "../asserts.h"
#include "reference_stage.h"

enum { SIDE = 48, PIXELS = SIDE * SIDE };

/* The bar for homogeneous boxes, as a fraction of full brightness. Floats and tables of 4096 entries are
 * precise enough for this bar. */
static const double TIGHT = 1e-3;

static double transmittance(double opacity, double unit, double distance) {
  return pow(1 - opacity, distance / unit);
}

/* ---- a homogeneous box of several voxels with unequal edges ---- */

static const vec3 BOX_LOW = {-3, -2.5, -6}, BOX_HIGH = {4, 5, 2};
static const double OPACITY = 0.2, UNIT = 1.7, SIGMA = 0.13126091261247; /* -ln(1 - OPACITY) / UNIT */

static hl_scene_volume *stage_homogeneous(stage *set) {
  hl_scene_volume *box = stage_add_grid(set, (size_t[3]){7, 5, 4}, (double[3]){1, 1.5, 2}, BOX_LOW, NULL);
  stage_set_opacity(set, box, OPACITY, UNIT);
  set->scene.width = set->scene.height = SIDE;
  set->scene.camera.height = 14;
  return box;
}

/* Finds the ray of the pixel (x, y) in the box's own space, before the volume's transform. The ray's
 * parameter remains a length in the world. */
static void local_ray(const stage *set, int x, int y, vec3 *origin, vec3 *direction) {
  const hl_scene_volume *volume = &set->volumes[0];
  stage_eye_ray(set, x, y, origin, direction);
  mat3 turn_back = mat3_rotation(vec3_normalise(vec3_of(volume->rotate_axis)),
                                 -volume->rotate_angle_deg * HL_PI / 180);
  vec3 moved = vec3_subtract(*origin, vec3_of(volume->translate));
  *origin = vec3_scale(mat3_apply(turn_back, moved), 1 / volume->scale);
  *direction = vec3_scale(mat3_apply(turn_back, *direction), 1 / volume->scale);
}

static double chord_of_pixel(const stage *set, int x, int y) {
  vec3 origin, direction;
  local_ray(set, x, y, &origin, &direction);
  return stage_chord(BOX_LOW, BOX_HIGH, origin, direction);
}

/* Tests alpha in all pixels, silhouettes included, because the renderer knows where each ray enters and
 * leaves the box. */
static void check_alpha(stage *set) {
  static float pixels[PIXELS * 4];
  int hits = 0;
  stage_render_sheets(set, pixels);
  for (int y = 0; y < SIDE; y++)
    for (int x = 0; x < SIDE; x++) {
      double chord = chord_of_pixel(set, x, y);
      hits += chord > 0;
      assert_near(pixels[4 * (y * SIDE + x) + 3], 1 - transmittance(OPACITY, UNIT, chord), TIGHT);
    }
  assert_true(hits > 300);
}

/* Tests alpha without light and under light from behind, from the front, from the side and from an oblique
 * direction. Alpha must be the same, although the light changes the direction of the sheets. */
static void check_alpha_through_all_sheets(stage *set) {
  static const vec3 lights[] = {{0, 0, -1}, {0, 0, 1}, {1, 0, 0}, {0.5, -1, 0.3}};
  static const double spacings[] = {0.5, 1, 2};
  hl_light *light = stage_add_directional(set, lights[0]);
  for (int s = 0; s < 3; s++) {
    set->scene.render.sheet_spacing = spacings[s];
    set->scene.render.shadows = HL_SHADOWS_OFF;
    check_alpha(set);
    for (size_t l = 0; l < sizeof lights / sizeof *lights; l++) {
      light->direction[0] = lights[l].x;
      light->direction[1] = lights[l].y;
      light->direction[2] = lights[l].z;
      light->angular_diameter_deg = l % 2 == 1 ? 10 : 0;
      set->scene.render.shadows = l % 2 == 1 ? HL_SHADOWS_SOFT : HL_SHADOWS_HARD;
      check_alpha(set);
    }
  }
}

static void test_alpha_along_axis(void **state) {
  (void)state;
  stage set;
  stage_open(&set);
  stage_homogeneous(&set);
  check_alpha_through_all_sheets(&set);
  stage_close(&set);
}

static void test_alpha_obliquely(void **state) {
  (void)state;
  stage set;
  stage_open(&set);
  stage_homogeneous(&set);
  stage_look(&set, (vec3){40, -31, 52}, (vec3){0, 1, -2}, (vec3){0.2, 0.3, 1});
  check_alpha_through_all_sheets(&set);
  stage_close(&set);
}

static void test_alpha_in_perspective(void **state) {
  (void)state;
  stage set;
  stage_open(&set);
  stage_homogeneous(&set);
  set.scene.camera.type = HL_CAMERA_PERSPECTIVE;
  set.scene.camera.fovy_deg = 55;
  stage_look(&set, (vec3){9, -7, 8}, (vec3){0.5, 1.2, -2}, (vec3){0, 1, 0.1});
  check_alpha_through_all_sheets(&set);
  stage_close(&set);
}

static void test_alpha_of_oblique_grid(void **state) {
  (void)state;
  stage set;
  stage_open(&set);
  hl_scene_volume *box = stage_homogeneous(&set);
  box->scale = 1.2;
  box->rotate_axis[0] = 0.3;
  box->rotate_axis[1] = -0.7;
  box->rotate_axis[2] = 0.5;
  box->rotate_angle_deg = 71;
  box->translate[0] = 50;
  stage_look(&set, (vec3){90, -31, 52}, (vec3){50, 0, -1}, (vec3){0.2, 0.3, 1});
  check_alpha_through_all_sheets(&set);
  for (int kernel = HL_KERNEL_BSPLINE; kernel <= HL_KERNEL_LINEAR; kernel++)
    for (int way = HL_RECONSTRUCTION_SPLAT; way <= HL_RECONSTRUCTION_GATHER; way++) {
      set.scene.render.kernel = (hl_kernel)kernel;
      set.scene.render.reconstruction = (hl_reconstruction)way;
      for (double spacing = 0.5; spacing <= 2; spacing *= 2) {
        set.scene.render.sheet_spacing = spacing;
        check_alpha(&set);
      }
    }
  stage_close(&set);
}

/* ---- emission: integral of sigma exp(-tau_eye) exp(-tau_light) ds along the ray ---- */

/* Returns the integral along the ray's way through the box by Simpson's rule, in which stage_chord() gives
 * the length of the light's way to each point. The steps are far finer than the sheets. *deepest: the length
 * of the light's longest way. */
static double lit_brightness(vec3 origin, vec3 direction, vec3 light, double *deepest) {
  enum { STEPS = 400 };
  *deepest = 0;
  double chord = stage_chord(BOX_LOW, BOX_HIGH, origin, direction), sum = 0;
  if (chord == 0) return 0;
  double enter = stage_chord((vec3){-1e3, -1e3, -1e3}, (vec3){1e3, 1e3, 1e3}, origin, direction), low = 0,
         high = enter;
  for (int i = 0; i < 80; i++) { /* bisection finds the last parameter at which the whole chord lies ahead */
    double middle = (low + high) / 2;
    vec3 start = vec3_add(origin, vec3_scale(direction, middle));
    if (stage_chord(BOX_LOW, BOX_HIGH, start, direction) >= chord * (1 - 1e-12)) low = middle;
    else high = middle;
  }
  for (int i = 0; i <= STEPS; i++) {
    double depth = chord * i / STEPS;
    vec3 point = vec3_add(origin, vec3_scale(direction, low + depth));
    double way_in = stage_chord(BOX_LOW, BOX_HIGH, point, vec3_scale(light, -1));
    *deepest = fmax(*deepest, way_in);
    sum += (i == 0 || i == STEPS ? 1 : i % 2 ? 4 : 2) * exp(-SIGMA * (depth + way_in));
  }
  return SIGMA * sum * chord / STEPS / 3;
}

/* Returns whether a pixel is away from silhouettes: the rays of all eight neighbouring pixels meet the box,
 * too. */
static bool well_inside(const stage *set, int x, int y) {
  for (int j = y - 1; j <= y + 1; j++)
    for (int i = x - 1; i <= x + 1; i++)
      if (chord_of_pixel(set, i, j) == 0) return false;
  return true;
}

static void check_lit(stage *set, vec3 light) {
  static float pixels[PIXELS * 4];
  int hits = 0;
  double worst = 0, worst_below_face = 0, slab = set->scene.render.sheet_spacing * sqrt(2);
  stage_render_sheets(set, pixels);
  for (int y = 0; y < SIDE; y++)
    for (int x = 0; x < SIDE; x++) {
      if (!well_inside(set, x, y)) continue;
      vec3 origin, direction;
      stage_eye_ray(set, x, y, &origin, &direction);
      double deepest, expected = lit_brightness(origin, direction, light, &deepest);
      double error = fabs(pixels[4 * (y * SIDE + x)] - expected);
      if (deepest < slab) /* the ray runs along a lit face, within the slabs in which the light enters */
        worst_below_face = fmax(worst_below_face, error);
      else worst = fmax(worst, error);
      hits++;
    }
  assert_true(hits > 300);
  assert_near(worst, 0, 0.005);
  assert_near(worst_below_face, 0, 0.015);
}

/* In the middle of the box, three directions of light have a closed form. d: the depth of the box; z: the
 * distance from the eye's side. Light with the view: int sigma exp(-2 sigma z) dz = (1 - exp(-2 sigma d)) /
 * 2. Light against the view: int sigma exp(-sigma z) exp(-sigma (d - z)) dz = sigma d exp(-sigma d). Light
 * across the view, at the depth x below the lit face: exp(-sigma x) (1 - exp(-sigma d)). */
static void test_lit_along_axes(void **state) {
  (void)state;
  static const double spacings[] = {0.5, 1, 2}, across[] = {0.005, 0.01, 0.035};
  static float pixels[PIXELS * 4];
  stage set;
  stage_open(&set);
  stage_homogeneous(&set);
  hl_light *light = stage_add_directional(&set, (vec3){0, 0, -1});
  double depth = BOX_HIGH.z - BOX_LOW.z;
  const float *row = &pixels[4 * (SIDE / 2) * SIDE];
  set.scene.render.shadow_resolution = 256;
  for (int s = 0; s < 3; s++) {
    set.scene.render.sheet_spacing = spacings[s];
    light->direction[0] = 0;
    light->direction[2] = -1;
    stage_render_sheets(&set, pixels);
    assert_near(row[4 * (SIDE / 2)], (1 - exp(-2 * SIGMA * depth)) / 2, TIGHT);
    light->direction[2] = 1;
    stage_render_sheets(&set, pixels);
    assert_near(row[4 * (SIDE / 2)], SIGMA * depth * exp(-SIGMA * depth), TIGHT);
    light->direction[0] = 1;
    light->direction[2] = 0;
    stage_render_sheets(&set, pixels);
    for (int x = 0; x < SIDE; x++) {
      double below = (x + 0.5) * 14 / SIDE - 7 - BOX_LOW.x;
      if (below < spacings[s] * sqrt(2) || below > BOX_HIGH.x - BOX_LOW.x)
        continue; /* the slabs in which the light enters */
      assert_near(row[4 * x], exp(-SIGMA * below) * (1 - exp(-SIGMA * depth)), across[s]);
    }
  }
  stage_close(&set);
}

/* The picture is right to half a per cent of full brightness. The box's faces cut slabs and pixels of the
 * shadow buffer, so that this test has fine sheets and fine shadow pixels. */
static void check_lit_from_everywhere(stage *set, int resolution) {
  static const vec3 lights[] = {{0, 0, -1},     {0, 0, 1},          {1, 0, 0},     {0, -1, 0},
                                {0.6, 0, -0.8}, {0.48, -0.64, 0.6}, {-0.6, 0.8, 0}};
  hl_light *light = stage_add_directional(set, lights[0]);
  set->scene.render.sheet_spacing = 0.5;
  set->scene.render.shadow_resolution = resolution;
  for (size_t l = 0; l < sizeof lights / sizeof *lights; l++) {
    light->direction[0] = lights[l].x;
    light->direction[1] = lights[l].y;
    light->direction[2] = lights[l].z;
    check_lit(set, lights[l]);
  }
}

static void test_lit_every_pixel(void **state) {
  (void)state;
  stage set;
  stage_open(&set);
  stage_homogeneous(&set);
  check_lit_from_everywhere(&set, 256);
  stage_close(&set);
}

static void test_lit_in_perspective(void **state) {
  (void)state;
  stage set;
  stage_open(&set);
  stage_homogeneous(&set);
  set.scene.camera.type = HL_CAMERA_PERSPECTIVE;
  set.scene.camera.fovy_deg = 40;
  stage_look(&set, (vec3){9, -9, 12}, (vec3){0.5, 1.2, -2}, (vec3){0, 1, 0.1});
  check_lit_from_everywhere(&set, 512);
  stage_close(&set);
}

/* ---- transparent volumes, and volumes that block some channels alone ---- */

static void test_empty_function_gives_zero(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  stage set;
  stage_open(&set);
  stage_set_opacity(&set, stage_homogeneous(&set), 0, 1);
  stage_add_directional(&set, (vec3){0, -1, -1});
  for (int c = 0; c < 3; c++) set.scene.ambient[c] = 1;
  for (int shadows = HL_SHADOWS_OFF; shadows <= HL_SHADOWS_SOFT; shadows++) {
    set.scene.render.shadows = (hl_shadows)shadows;
    set.lights[0].angular_diameter_deg = 5;
    memset(pixels, 0xff, sizeof pixels);
    stage_render_sheets(&set, pixels);
    for (int i = 0; i < PIXELS * 4; i++) assert_true(pixels[i] == 0);
  }
  stage_close(&set);
}

/* A half-transparent block stands between the light and an opaque wall, and the eye sees block and wall from
 * +z. Light travels along +x, and the wall's face lies at x = 2. The block is higher than the wall, so that
 * the wall's surface lies well within the block's shadow. */
static void stage_block_and_wall(stage *set, hl_scene_volume **block, hl_scene_volume **wall) {
  *wall = stage_add_grid(set, (size_t[3]){4, 8, 8}, (double[3]){1, 1, 1}, (vec3){2, -4, -4}, NULL);
  *block = stage_add_grid(set, (size_t[3]){2, 8, 9}, (double[3]){1, 1, 1}, (vec3){-3, -4, -4}, NULL);
  stage_set_opacity(set, *wall, 0.9, 0.25);
  stage_set_opacity(set, *block, 0.15, 1);
  (*wall)->casts_shadow = 0;
  set->scene.width = set->scene.height = SIDE;
  set->scene.camera.height = 12;
  set->scene.render.sheet_spacing = 0.25;
  set->scene.render.shadow_resolution = 256;
  stage_add_directional(set, (vec3){1, 0, 0});
}

/* Renders the scene, and finds the colour of the block and of the wall. The wall is opaque, so that it shows
 * its own light alone. */
static void look_at_both(stage *set, float block[4], float wall[4]) {
  static float pixels[PIXELS * 4];
  stage_render_sheets(set, pixels);
  memcpy(block, &pixels[4 * (SIDE / 2 * SIDE + 16)], 4 * sizeof(float)); /* x = -1.875 */
  memcpy(wall, &pixels[4 * (SIDE / 2 * SIDE + 36)], 4 * sizeof(float));  /* x = 3.125 */
}

static void test_flags(void **state) {
  (void)state;
  stage set;
  stage_open(&set);
  hl_scene_volume *block, *wall;
  stage_block_and_wall(&set, &block, &wall);
  float on_block[4], on_wall[4];
  double passed = transmittance(0.15, 1, 2), alpha = 1 - transmittance(0.15, 1, 9);
  double within = transmittance(0.15, 1, 1.125);
  look_at_both(&set, on_block, on_wall);
  assert_near(on_wall[0], passed, 0.005);
  assert_near(on_block[0], within * alpha, 0.005);
  block->receives_shadow = 0;
  look_at_both(&set, on_block, on_wall);
  assert_near(on_wall[0], passed, 0.005);
  assert_near(on_block[0], alpha, 0.002);
  block->receives_shadow = 1;
  block->visible = 0;
  look_at_both(&set, on_block, on_wall);
  assert_true(on_block[0] == 0 && on_block[3] == 0);
  assert_near(on_wall[0], passed, 0.005);
  block->visible = 1;
  block->casts_shadow = 0;
  look_at_both(&set, on_block, on_wall);
  assert_near(on_wall[0], 1, 0.005);
  assert_near(on_block[0], alpha, 0.002);
  block->casts_shadow = 1;
  wall->receives_shadow = 0;
  look_at_both(&set, on_block, on_wall);
  assert_near(on_wall[0], 1, 0.002);
  stage_close(&set);
}

/* A block absorbs no red, some green and twice as much blue, so that the three channels have different
 * transmittances. */
static void test_attenuation_color(void **state) {
  (void)state;
  stage set;
  stage_open(&set);
  hl_scene_volume *block, *wall;
  stage_block_and_wall(&set, &block, &wall);
  for (int c = 0; c < 3; c++) block->attenuation_color[c] = c;
  for (int shadows = HL_SHADOWS_HARD; shadows <= HL_SHADOWS_SOFT; shadows++) {
    float on_block[4], on_wall[4];
    set.scene.render.shadows = (hl_shadows)shadows;
    set.lights[0].angular_diameter_deg = shadows == HL_SHADOWS_SOFT ? 1 : 0;
    look_at_both(&set, on_block, on_wall);
    double alpha = 1 - transmittance(0.15, 1, 9);
    assert_near(on_block[3], alpha, TIGHT);
    for (int c = 0; c < 3; c++) {
      assert_near(on_wall[c], transmittance(0.15, 1, 2 * c), 0.005);
      assert_near(on_block[c], alpha * transmittance(0.15, 1, 1.125 * c), 0.005);
    }
  }
  stage_close(&set);
}

static double greatest_difference(const float *a, const float *b) {
  double worst = 0;
  for (int i = 0; i < PIXELS * 4; i++) worst = fmax(worst, fabs((double)a[i] - b[i]));
  return worst;
}

/* Lights add up: two lights of half the strength give the picture of one light of the full strength. Ambient
 * light counts once, however many sweeps there are. */
static void test_half_lights_add(void **state) {
  (void)state;
  static float one[PIXELS * 4], two[PIXELS * 4], left[PIXELS * 4], right[PIXELS * 4];
  stage set;
  stage_open(&set);
  stage_homogeneous(&set)->material.ambient = 1;
  stage_add_directional(&set, (vec3){1, -1, -1});
  stage_render_sheets(&set, one);
  set.lights[0].intensity = 0.5;
  stage_add_directional(&set, (vec3){1, -1, -1})->intensity = 0.5;
  stage_render_sheets(&set, two);
  assert_near(greatest_difference(one, two), 0, 1e-5);
  /* opposite lights need a sweep each */
  set.lights[1].direction[0] = -1;
  set.lights[1].direction[1] = 1;
  set.lights[1].direction[2] = 1;
  for (int c = 0; c < 3; c++) set.scene.ambient[c] = 0.2;
  stage_render_sheets(&set, two);
  set.scene.light_count = 1;
  stage_render_sheets(&set, left);
  for (int c = 0; c < 3; c++) set.scene.ambient[c] = 0;
  set.lights[0] = set.lights[1];
  stage_render_sheets(&set, right);
  for (int i = 0; i < PIXELS * 4; i++) left[i] = i % 4 == 3 ? left[i] : left[i] + right[i];
  assert_near(greatest_difference(left, two), 0, TIGHT);
  stage_close(&set);
}

/* Extinctions add up: the opacity o over a unit, twice, is the opacity 1 - (1 - o)^2, once. */
static void test_overlapping_twins(void **state) {
  (void)state;
  static float one[PIXELS * 4], two[PIXELS * 4];
  for (int shadows = HL_SHADOWS_OFF; shadows <= HL_SHADOWS_SOFT; shadows++) {
    stage set;
    stage_open(&set);
    hl_scene_volume *box = stage_homogeneous(&set);
    set.scene.render.shadows = (hl_shadows)shadows;
    stage_add_directional(&set, (vec3){1, -1, -1})->angular_diameter_deg = 5;
    stage_homogeneous(&set);
    stage_render_sheets(&set, two);
    hl_volume_release(set.volumes[1].volume);
    set.scene.volume_count = 1;
    stage_set_opacity(&set, box, 1 - (1 - OPACITY) * (1 - OPACITY), UNIT);
    stage_render_sheets(&set, one);
    assert_near(greatest_difference(one, two), 0, 1e-4);
    stage_close(&set);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_alpha_along_axis),
      cmocka_unit_test(test_alpha_obliquely),
      cmocka_unit_test(test_alpha_in_perspective),
      cmocka_unit_test(test_alpha_of_oblique_grid),
      cmocka_unit_test(test_lit_along_axes),
      cmocka_unit_test(test_lit_every_pixel),
      cmocka_unit_test(test_lit_in_perspective),
      cmocka_unit_test(test_empty_function_gives_zero),
      cmocka_unit_test(test_flags),
      cmocka_unit_test(test_attenuation_color),
      cmocka_unit_test(test_half_lights_add),
      cmocka_unit_test(test_overlapping_twins),
  };
  return cmocka_run_group_tests_name("sheets_transport", tests, NULL, NULL);
}
