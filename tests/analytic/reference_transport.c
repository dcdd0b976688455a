/* analytic/reference_transport.c - the reference, against closed forms of absorption, emission and shadow. */
#include <string.h>

#include "../asserts.h"
#include "reference_stage.h"

enum { MOST_PIXELS = 64 * 64 };

static double transmittance(double opacity, double unit, double distance) {
  return pow(1 - opacity, distance / unit);
}

/* ---- absorption: (1 - o)^(d / u) along every ray, wherever the eye stands ---- */

static const vec3 BOX_LOW = {-3, -2.5, -6}, BOX_HIGH = {4, 5, 2};

/* Adds a homogeneous box of several voxels whose edges have different lengths. */
static void stage_homogeneous(stage *set) {
  hl_scene_volume *box = stage_add_grid(set, (size_t[3]){7, 5, 4}, (double[3]){1, 1.5, 2}, BOX_LOW, NULL);
  stage_set_opacity(set, box, 0.2, 1.7);
}

static void check_homogeneous(stage *set) {
  static float pixels[MOST_PIXELS * 4];
  int hits = 0;
  stage_render(set, NULL, pixels);
  for (int y = 0; y < set->scene.height; y++)
    for (int x = 0; x < set->scene.width; x++) {
      vec3 origin, direction;
      stage_eye_ray(set, x, y, &origin, &direction);
      double chord = stage_chord(BOX_LOW, BOX_HIGH, origin, direction);
      hits += chord > 0;
      assert_near(pixels[4 * (y * set->scene.width + x) + 3], 1 - transmittance(0.2, 1.7, chord), 1e-6);
    }
  assert_true(hits > 40);
}

static void test_box_along_axis(void **state) {
  (void)state;
  stage set;
  stage_open(&set);
  stage_homogeneous(&set);
  check_homogeneous(&set);
  stage_close(&set);
}

/* An orthographic eye inside the box still sees the whole box. */
static void test_box_around_parallel_eye(void **state) {
  (void)state;
  stage set;
  float pixels[16 * 16 * 4];
  stage_open(&set);
  stage_homogeneous(&set);
  stage_look(&set, (vec3){0, 0, -2}, (vec3){0, 0, -3}, (vec3){0, 1, 0});
  stage_render(&set, NULL, pixels);
  assert_near(pixels[4 * (8 * 16 + 8) + 3], 1 - transmittance(0.2, 1.7, 8), 1e-6);
  stage_close(&set);
}

static void test_box_obliquely(void **state) {
  (void)state;
  stage set;
  stage_open(&set);
  stage_homogeneous(&set);
  set.scene.width = 20;
  stage_look(&set, (vec3){40, -31, 52}, (vec3){0, 1, -2}, (vec3){0.2, 0.3, 1});
  for (int kernel = HL_KERNEL_BSPLINE; kernel <= HL_KERNEL_LINEAR; kernel++) {
    set.scene.render.kernel = (hl_kernel)kernel;
    check_homogeneous(&set);
  }
  stage_close(&set);
}

static void test_box_in_perspective(void **state) {
  (void)state;
  stage set;
  stage_open(&set);
  stage_homogeneous(&set);
  set.scene.width = 24;
  set.scene.camera.type = HL_CAMERA_PERSPECTIVE;
  set.scene.camera.fovy_deg = 55;
  stage_look(&set, (vec3){9, -8, 7}, (vec3){0, 1, -2}, (vec3){0, 0, 1});
  check_homogeneous(&set);
  stage_look(&set, (vec3){1, 1, -1}, (vec3){3, 4, -2}, (vec3){0, 0, 1}); /* the eye is within the box */
  check_homogeneous(&set);
  stage_close(&set);
}

/* The unit_distance counts in world units, so that a volume of twice the size absorbs along twice the length.
 */
static void test_scaled_box(void **state) {
  (void)state;
  stage set;
  stage_open(&set);
  hl_scene_volume *box = stage_add_box(&set, (vec3){-1, -1, -1}, (vec3){1, 1, 1});
  stage_set_opacity(&set, box, 0.1, 1);
  box->scale = 3;
  box->translate[0] = 100; /* the eye moves along by the same distance */
  stage_look(&set, (vec3){100, 0, 50}, (vec3){100, 0, 0}, (vec3){0, 1, 0});
  float pixels[16 * 16 * 4];
  stage_render(&set, NULL, pixels);
  assert_near(pixels[4 * (8 * 16 + 8) + 3], 1 - transmittance(0.1, 1, 6), 1e-6);
  /* the edge of the box lies at x = -3 */
  assert_true(pixels[4 * (8 * 16 + 4) + 3] == 0 && pixels[4 * (8 * 16 + 5) + 3] > 0);
  stage_close(&set);
}

static void test_clip(void **state) {
  (void)state;
  stage set;
  stage_open(&set);
  stage_homogeneous(&set);
  set.volumes[0].clipped = 1;
  for (int a = 0; a < 3; a++) {
    set.volumes[0].clip_min[a] = -100;
    set.volumes[0].clip_max[a] = 100;
  }
  set.volumes[0].clip_max[2] = -4.3;
  float pixels[16 * 16 * 4];
  stage_render(&set, NULL, pixels);
  assert_near(pixels[4 * (8 * 16 + 8) + 3], 1 - transmittance(0.2, 1.7, 1.7), 1e-6);
  stage_close(&set);
}

static void test_overlapping_volumes(void **state) {
  (void)state;
  stage set;
  stage_open(&set);
  hl_scene_volume *red = stage_add_box(&set, (vec3){-4, -4, -2}, (vec3){4, 4, 2});
  hl_scene_volume *blue = stage_add_box(&set, (vec3){-4, -4, -1}, (vec3){4, 4, 5});
  stage_set_opacity(&set, red, 0.3, 1);
  stage_set_opacity(&set, blue, 0.1, 1);
  stage_set_color(&set, red, 1, 0, 0);
  stage_set_color(&set, blue, 0, 0, 1);
  for (int c = 0; c < 3; c++) set.scene.ambient[c] = 0.5;
  float pixels[16 * 16 * 4];
  stage_render(&set, NULL, pixels);
  const float *middle = &pixels[4 * (8 * 16 + 8)];
  /* from front to back, the ray passes 3 units of the blue box alone, 3 units of both boxes and 1 unit of the
   * red box alone */
  double r = -log(0.7), b = -log(0.9), after_blue = exp(-3 * b), after_both = after_blue * exp(-3 * (r + b));
  double both = after_blue - after_both, red_alone = after_both * (1 - exp(-r));
  assert_near(middle[3], 1 - after_both * exp(-r), 1e-6);
  assert_near(middle[0], 0.5 * (both * r / (r + b) + red_alone), 1e-6);
  assert_near(middle[2], 0.5 * (1 - after_blue + both * b / (r + b)), 1e-6);
  stage_close(&set);
}

/* ---- emission: the light attenuated on its way in ---- */

/* The light comes from the side, so that the transmittance exp(-sigma depth) is the same along a ray. */
static void test_lit_from_the_side(void **state) {
  (void)state;
  stage set;
  stage_open(&set);
  hl_scene_volume *box = stage_add_box(&set, (vec3){-4, -4, -3}, (vec3){4, 4, 3});
  stage_set_opacity(&set, box, 0.15, 1);
  stage_set_color(&set, box, 0.8, 0.8, 0.8);
  box->material.ambient = 0.5;
  for (int c = 0; c < 3; c++) {
    box->attenuation_color[c] = c / 2.0;
    set.scene.ambient[c] = 0.3;
  }
  stage_add_directional(&set, (vec3){1, 0, 0})->intensity = 2;
  float pixels[16 * 16 * 4];
  stage_render(&set, NULL, pixels);
  for (int x = 4; x < 12; x++)
    for (int c = 0; c < 3; c++) {
      double depth = x + 0.5 - 4, lit = 2 * transmittance(0.15, 1, depth * c / 2.0);
      double expected = 0.8 * (0.5 * 0.3 + lit) * (1 - transmittance(0.15, 1, 6));
      assert_near(pixels[4 * (8 * 16 + x) + c], expected, 1e-6);
    }
  stage_close(&set);
}

/* The light comes from the eye. The picture is the integral of sigma exp(-2 sigma z). The ray march's error
 * is of the second order in the step. */
static void test_lit_from_the_front(void **state) {
  (void)state;
  stage set;
  stage_open(&set);
  hl_scene_volume *box = stage_add_box(&set, (vec3){-4, -4, 0}, (vec3){4, 4, 1});
  stage_add_directional(&set, (vec3){0, 0, -1});
  float pixels[16 * 16 * 4];
  hl_reference_options options;
  hl_reference_options_defaults(&options);
  double error[2];
  stage_set_opacity(&set, box, 0.16, 1);
  for (int fine = 0; fine < 2; fine++) {
    options.step = fine ? 0.05 : 0.1;
    stage_render(&set, &options, pixels);
    error[fine] = pixels[4 * (8 * 16 + 8)] - (1 - transmittance(0.16, 1, 2)) / 2;
  }
  assert_near(error[1], 0, 1e-5);
  assert_near(error[0] / error[1], 4, 0.1);
  /* the matter is so dense that the eye sees less than one step into it */
  stage_set_opacity(&set, box, 0.99, 0.1);
  stage_render(&set, NULL, pixels);
  assert_near(pixels[4 * (8 * 16 + 8)], 0.5, 1e-3);
  stage_close(&set);
}

static void test_inverse_square(void **state) {
  (void)state;
  stage set;
  stage_open(&set);
  stage_set_opacity(&set, stage_add_box(&set, (vec3){-8, -8, 0}, (vec3){8, 8, 0.1}), 0.999, 0.001);
  set.volumes[0].receives_shadow = 0;
  stage_add_point(&set, (vec3){2, 1, 5.1})->falloff = HL_FALLOFF_INVERSE_SQUARE;
  float pixels[16 * 16 * 4];
  stage_render(&set, NULL, pixels);
  for (int x = 0; x < 16; x++) {
    double dx = x + 0.5 - 8 - 2, dy = -0.5 - 1;
    assert_near(pixels[4 * (8 * 16 + x)], 1 / (dx * dx + dy * dy + 25), 3e-4);
  }
  stage_close(&set);
}

/* ---- shadows ---- */

/* Adds an opaque receiver with its surface at z = 0, which casts no shadow, and an opaque plate that the eye
 * does not see. */
static void stage_plate(stage *set, vec3 low, vec3 high) {
  hl_scene_volume *receiver = stage_add_box(set, (vec3){-16, -16, -1}, (vec3){16, 16, 0});
  hl_scene_volume *plate = stage_add_box(set, low, high);
  stage_set_opacity(set, receiver, 0.999, 0.01);
  stage_set_opacity(set, plate, 0.9999, 0.001);
  receiver->casts_shadow = 0;
  plate->visible = 0;
}

/* By similar triangles, a plate at the height h below a light at the height H casts a shadow that is H / (H -
 * h) times as large. */
static void test_plate_under_point_light(void **state) {
  (void)state;
  stage set;
  stage_open(&set);
  stage_plate(&set, (vec3){-2, -3, 4}, (vec3){2, 3, 4.1});
  stage_add_point(&set, (vec3){1, -1, 10});
  set.scene.width = set.scene.height = 64;
  set.scene.camera.height = 32;
  static float pixels[64 * 64 * 4];
  stage_render(&set, NULL, pixels);
  for (int y = 0; y < 64; y++)
    for (int x = 0; x < 64; x++) {
      /* (pu, pv) and (qu, qv): where the way from the receiver's point to the light crosses the plate's lower
       * and upper face */
      double u = (x + 0.5 - 32) / 2, v = (32 - y - 0.5) / 2, lower = 0.4, upper = 0.41;
      double pu = u + (1 - u) * lower, pv = v + (-1 - v) * lower;
      double qu = u + (1 - u) * upper, qv = v + (-1 - v) * upper, margin = 0.05;
      bool dark = fabs(pu) < 2 - margin && fabs(pv) < 3 - margin;
      bool lit = fmax(fabs(pu) - 2, fabs(pv) - 3) > margin && fmax(fabs(qu) - 2, fabs(qv) - 3) > margin;
      if (dark) assert_near(pixels[4 * (y * 64 + x)], 0, 1e-6);
      if (lit) assert_near(pixels[4 * (y * 64 + x)], 1, 1e-4);
    }
  stage_close(&set);
}

/* Returns the fraction of a disk of radius 1 at which u < s. */
static double disk_below(double s) {
  if (s <= -1) return 0;
  if (s >= 1) return 1;
  return 0.5 + (s * sqrt(1 - s * s) + asin(s)) / HL_PI;
}

/* A plate at the height 6 fills x < 0. Under the plate's edge, a fraction of the light is hidden. hidden: the
 * closed form of this fraction at x. The plate is so thin that its two faces give nearly the same profile. */
static void check_penumbra(stage *set, double (*hidden)(double x), double tolerance) {
  static float pixels[64 * 2 * 4];
  set->scene.render.shadows = HL_SHADOWS_SOFT;
  set->scene.width = 64;
  set->scene.height = 2;
  set->scene.camera.height = 0.5;
  stage_render(set, NULL, pixels);
  double worst = 0;
  int partial = 0;
  for (int x = 0; x < 64; x++) {
    double seen = 1 - hidden((x + 0.5 - 32) / 4);
    partial += seen > 0 && seen < 1;
    worst = fmax(worst, fabs(pixels[4 * (64 + x)] - seen));
  }
  assert_true(partial > 20);
  assert_near(worst, 0, tolerance);
}

static void stage_half_plane(stage *set) {
  stage_open(set);
  stage_plate(set, (vec3){-30, -30, 6}, (vec3){0, 30, 6.01});
}

static double hidden_of_directional(double x) { return disk_below(-x / 6 / tan(25 * HL_PI / 180)); }

static void test_penumbra_of_directional_light(void **state) {
  (void)state;
  stage set;
  stage_half_plane(&set);
  stage_add_directional(&set, (vec3){0, 0, -1})->angular_diameter_deg = 50;
  check_penumbra(&set, hidden_of_directional, 0.008);
  stage_close(&set);
}

/* From here on the light stands around (0, 0, 14). A ray from (x, 0, 0) to (u, v, 14 + w) passes the height 6
 * at x + (u - x) 6 / (14 + w). The ray passes the plate's edge if x (8 + w) + 6 u = 0. For a point of the
 * light at u = s c and w = s d, the ray passes the edge at s = -8 x / (6 c + d x). */
static double edge_on_light(double x, double c, double d) { return -8 * x / (6 * c + d * x); }

/* The disk that faces (x, 0, 0) contains the direction (14, 0, x). */
static double hidden_of_sphere(double x) {
  double distance = sqrt(x * x + 14 * 14);
  return disk_below(edge_on_light(x, 14 / distance, x / distance) / 5);
}

static void test_penumbra_of_sphere(void **state) {
  (void)state;
  stage set;
  stage_half_plane(&set);
  stage_add_point(&set, (vec3){0, 0, 14})->radius = 5;
  check_penumbra(&set, hidden_of_sphere, 0.008);
  stage_close(&set);
}

static double hidden_of_disk(double x) { return disk_below(edge_on_light(x, cos(0.5), sin(0.5)) / 5); }

static void test_penumbra_of_disk(void **state) {
  (void)state;
  stage set;
  stage_half_plane(&set);
  hl_light *light = stage_add_point(&set, (vec3){0, 0, 14});
  light->type = HL_LIGHT_DISK;
  light->radius = 5;
  light->normal[0] = sin(0.5);
  light->normal[2] = -cos(0.5);
  check_penumbra(&set, hidden_of_disk, 0.008);
  stage_close(&set);
}

/* One edge of the light leaves the horizontal plane by 1 in 4. The light's other edge is parallel to the
 * plate's edge, so that its length does not matter. */
static double hidden_of_rect(double x) { return fmin(fmax(edge_on_light(x, 8, 2) + 0.5, 0), 1); }

static void test_penumbra_of_rect(void **state) {
  (void)state;
  for (int turned = 0; turned < 2; turned++) {
    stage set;
    stage_half_plane(&set);
    hl_light *light = stage_add_point(&set, (vec3){0, 0, 14});
    light->type = HL_LIGHT_RECT;
    double *across = turned ? light->edge2 : light->edge1, *along = turned ? light->edge1 : light->edge2;
    across[0] = 8;
    across[1] = 0;
    across[2] = 2;
    along[0] = along[2] = 0;
    along[1] = 3;
    check_penumbra(&set, hidden_of_rect, 0.004);
    stage_close(&set);
  }
}

/* The light is an L of three squares whose sides are 5, around (0, 0, 14). */
static double hidden_of_polygon(double x) {
  double s = fmin(fmax(edge_on_light(x, 1, 0), -5), 5);
  return s < 0 ? 10 * (s + 5) / 75 : (50 + 5 * s) / 75;
}

static void test_penumbra_of_polygon(void **state) {
  (void)state;
  static const double outline[][3] = {{-5, -5, 14}, {5, -5, 14}, {5, 0, 14},
                                      {0, 0, 14},   {0, 5, 14},  {-5, 5, 14}};
  stage set;
  stage_half_plane(&set);
  hl_light *light = stage_add_point(&set, (vec3){0, 0, 0});
  light->type = HL_LIGHT_POLYGON;
  light->vertices = outline;
  light->vertex_count = 6;
  check_penumbra(&set, hidden_of_polygon, 0.008);
  stage_close(&set);
}

/* A light without extent shines from its centre. */
static void test_lights_without_extent(void **state) {
  (void)state;
  static float point[16 * 16 * 4], other[16 * 16 * 4];
  stage set;
  stage_half_plane(&set);
  set.scene.render.shadows = HL_SHADOWS_SOFT;
  hl_light *light = stage_add_point(&set, (vec3){1, 2, 14});
  stage_render(&set, NULL, point);
  light->type = HL_LIGHT_DISK;
  stage_render(&set, NULL, other);
  assert_memory_equal(point, other, sizeof point);
  light->type = HL_LIGHT_RECT;
  for (int axis = 0; axis < 3; axis++) light->edge1[axis] = light->edge2[axis] = 0;
  stage_render(&set, NULL, other);
  assert_memory_equal(point, other, sizeof point);
  stage_close(&set);
}

/* Shadows are off, hard, and soft with a light without size. A light's own setting replaces the setting of
 * the render. */
static void test_shadow_settings(void **state) {
  (void)state;
  stage set;
  stage_open(&set);
  stage_plate(&set, (vec3){-30, -30, 6}, (vec3){0, 30, 6.05});
  hl_light *light = stage_add_directional(&set, (vec3){0, 0, -1});
  float pixels[16 * 16 * 4];
  const struct {
    hl_shadows render, light;
    double dark;
  } cases[] = {
      {HL_SHADOWS_OFF, HL_SHADOWS_DEFAULT, 1},  {HL_SHADOWS_HARD, HL_SHADOWS_DEFAULT, 0},
      {HL_SHADOWS_SOFT, HL_SHADOWS_DEFAULT, 0}, {HL_SHADOWS_OFF, HL_SHADOWS_HARD, 0},
      {HL_SHADOWS_HARD, HL_SHADOWS_OFF, 1},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    set.scene.render.shadows = cases[i].render;
    light->shadows = cases[i].light;
    stage_render(&set, NULL, pixels);
    assert_near(pixels[4 * (8 * 16 + 4)], cases[i].dark, 1e-4);
    assert_near(pixels[4 * (8 * 16 + 12)], 1, 1e-4);
  }
  light->shadows = HL_SHADOWS_HARD;
  set.volumes[0].receives_shadow = 0;
  stage_render(&set, NULL, pixels);
  assert_near(pixels[4 * (8 * 16 + 4)], 1, 1e-4);
  set.volumes[0].receives_shadow = 1;
  set.volumes[1].casts_shadow = 0;
  stage_render(&set, NULL, pixels);
  assert_near(pixels[4 * (8 * 16 + 4)], 1, 1e-4);
  stage_close(&set);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_box_along_axis),
      cmocka_unit_test(test_box_around_parallel_eye),
      cmocka_unit_test(test_box_obliquely),
      cmocka_unit_test(test_box_in_perspective),
      cmocka_unit_test(test_scaled_box),
      cmocka_unit_test(test_clip),
      cmocka_unit_test(test_overlapping_volumes),
      cmocka_unit_test(test_lit_from_the_side),
      cmocka_unit_test(test_lit_from_the_front),
      cmocka_unit_test(test_inverse_square),
      cmocka_unit_test(test_plate_under_point_light),
      cmocka_unit_test(test_penumbra_of_directional_light),
      cmocka_unit_test(test_penumbra_of_sphere),
      cmocka_unit_test(test_penumbra_of_disk),
      cmocka_unit_test(test_penumbra_of_rect),
      cmocka_unit_test(test_penumbra_of_polygon),
      cmocka_unit_test(test_lights_without_extent),
      cmocka_unit_test(test_shadow_settings),
  };
  return cmocka_run_group_tests_name("reference_transport", tests, NULL, NULL);
}
