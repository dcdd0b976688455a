/* analytic/sheets_cut_meshes.c - a scene's cuts remove parts of meshes: coverage, light within and shadows,
 * against closed forms, by the sheets and by the reference. */
#include <stdlib.h>
#include <string.h>

#include <halflight/compose.h>

#include "../asserts.h"
#include "mesh_stage.h"

enum { SIDE = 64, PIXELS = SIDE * SIDE };

/* A pixel is half a unit wide. */
static const double PIXEL_AREA = 0.25;

static void cut(mesh_stage *all, const hl_cut *cuts, size_t count) {
  all->set.scene.cuts = cuts;
  all->set.scene.cut_count = count;
}

static hl_scene_mesh *add_sphere(mesh_stage *all, double radius) {
  const float sphere[1][4] = {{0, 0, 0, (float)radius}};
  hl_mesh *made = NULL;
  hl_mesh_description d;
  hl_mesh_description_defaults(&d);
  d.spheres = sphere, d.sphere_count = 1;
  assert_int_equal(hl_mesh_create(all->set.context, &d, &made, NULL), HL_OK);
  return mesh_stage_add(all, made);
}

/* Adds a closed ball of triangles in rings of latitude, with the poles at +-z. */
static hl_scene_mesh *add_ball(mesh_stage *all, double radius) {
  enum { RINGS = 32, ROUND = 64 };
  static float positions[(RINGS - 1) * ROUND + 2][3];
  static uint32_t triangles[2 * (RINGS - 1) * ROUND][3];
  uint32_t top = (RINGS - 1) * ROUND, count = 0;
  for (uint32_t v = 0; v < top; v++) {
    double polar = HL_PI * (v / ROUND + 1) / RINGS, turn = 2 * HL_PI * (v % ROUND) / ROUND;
    vec3_store(positions[v],
               vec3_scale((vec3){sin(polar) * cos(turn), sin(polar) * sin(turn), cos(polar)}, radius));
  }
  vec3_store(positions[top], (vec3){0, 0, radius});
  vec3_store(positions[top + 1], (vec3){0, 0, -radius});
  for (uint32_t ring = 0; ring < RINGS; ring++)
    for (uint32_t i = 0; i < ROUND; i++) {
      uint32_t next = (i + 1) % ROUND, above = (ring - 1) * ROUND, below = ring * ROUND;
      uint32_t a = ring == 0 ? top : above + i, b = ring == 0 ? top : above + next;
      uint32_t c = ring == RINGS - 1 ? top + 1 : below + i, d = ring == RINGS - 1 ? top + 1 : below + next;
      if (c != d) memcpy(triangles[count++], (uint32_t[3]){a, c, d}, sizeof triangles[0]);
      if (a != b) memcpy(triangles[count++], (uint32_t[3]){a, d, b}, sizeof triangles[0]);
    }
  hl_mesh_description d;
  hl_mesh *made = NULL;
  hl_mesh_description_defaults(&d);
  d.positions = (const float(*)[3])positions, d.vertex_count = top + 2;
  d.triangles = (const uint32_t(*)[3])triangles, d.triangle_count = count;
  assert_int_equal(hl_mesh_create(all->set.context, &d, &made, NULL), HL_OK);
  return mesh_stage_add(all, made);
}

static double pixel_x(int i) { return (i % SIDE + 0.5 - SIDE / 2) * 0.5; }
static double pixel_y(int i) { return -(i / SIDE + 0.5 - SIDE / 2) * 0.5; }

/* ---- coverage ---- */

/* Returns the area of the part of a disk beyond a line at the distance x from the disk's middle. */
static double segment(double radius, double x) {
  return radius * radius * acos(x / radius) - x * sqrt(radius * radius - x * x);
}

/* A plane across the eye's rays leaves a disk without a segment. The body is a sphere or a ball of triangles.
 * Pixels beyond the plane are transparent. */
static void test_half_a_ball(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  const double radius = 11.3;
  for (int k = 0; k < 8; k++) {
    const double at = 0.37 + 1.9 * (k / 2), turn = 0.4 * (k / 2);
    const hl_cut plane = {.type = HL_CUT_PLANE,
                          .point = {at * cos(turn), at * sin(turn), 3},
                          .normal = {cos(turn), sin(turn), 0}};
    mesh_stage all;
    mesh_stage_open(&all, SIDE, 32);
    if (k % 2 == 0) add_sphere(&all, radius);
    else add_ball(&all, radius);
    if (k >= 4) stage_add_directional(&all.set, (vec3){0.8, 0.3, -0.4});
    cut(&all, &plane, 1);
    stage_render_sheets(&all.set, pixels);
    double sum = 0;
    for (int i = 0; i < PIXELS; i++) {
      double x = pixel_x(i), y = pixel_y(i), alpha = (double)pixels[4 * i + 3];
      double left = at - x * cos(turn) - y * sin(turn), inside = radius - sqrt(x * x + y * y);
      sum += alpha;
      if (fmin(left, inside) < -0.4) assert_near(alpha, 0, 1e-6);
      if (left > 0.4 && inside > 0.5) assert_near(alpha, 1, 1e-5);
    }
    double area = HL_PI * radius * radius - segment(radius, at);
    /* the triangles lie within the ball */
    assert_near(sum * PIXEL_AREA / area, k % 2 == 0 ? 1 : 0.997, 0.003);
    mesh_stage_close(&all);
  }
}

/* A translucent sphere is cut by a sphere around its front pole, by a box, or by all but a box. Pixels within
 * the cut show one side of the sphere, or nothing if both sides are cut. */
static void test_holes(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  const double radius = 12, opacity = 0.4, both = 1 - (1 - opacity) * (1 - opacity);
  static const hl_cut cuts[] = {
      {.type = HL_CUT_SPHERE, .center = {0, 0, 12}, .radius = 7},
      {.type = HL_CUT_BOX, .min = {-5.1, -4.3, 0}, .max = {5.1, 4.3, 40}},
      {.type = HL_CUT_BOX, .min = {-5.1, -4.3, 0}, .max = {5.1, 4.3, 40}, .keep = HL_CUT_KEEP_INSIDE},
      {.type = HL_CUT_BOX, .min = {-5.1, -4.3, -40}, .max = {5.1, 4.3, 40}}};
  /* the radius of the circle in which the spheres meet */
  const double width = 7 * sqrt(1 - 49.0 / (4 * 144));
  const double disk = HL_PI * 144, hole = HL_PI * width * width, box = 4 * 5.1 * 4.3;
  const double expected[] = {both * (disk - hole) + opacity * hole, both * (disk - box) + opacity * box,
                             opacity * box, both * (disk - box)};
  for (int k = 0; k < 4; k++) {
    mesh_stage all;
    mesh_stage_open(&all, SIDE, 32);
    add_sphere(&all, radius)->opacity = opacity;
    cut(&all, &cuts[k], 1);
    stage_render_sheets(&all.set, pixels);
    double sum = 0;
    for (int i = 0; i < PIXELS; i++) sum += (double)pixels[4 * i + 3];
    assert_near(sum * PIXEL_AREA / expected[k], 1, 0.003);
    assert_near((double)pixels[4 * (SIDE / 2 * SIDE + SIDE / 2) + 3], k == 3 ? 0 : opacity, 1e-5);
    mesh_stage_close(&all);
  }
}

/* ---- light ---- */

/* A bowl, half of an opaque ball, shows its inside to the eye and the light. The brightness of the inside is
 * N.L: the bowl does not shade itself. */
static void test_inside_of_a_bowl(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  static const hl_cut plane = {.type = HL_CUT_PLANE, .normal = {0, 0, 1}};
  for (int k = 0; k < 8; k++) {
    mesh_stage all;
    mesh_stage_open(&all, SIDE, 32);
    if (k % 2 == 0) add_sphere(&all, 12);
    else add_ball(&all, 12);
    mesh_stage_choose_shadows(&all, stage_add_directional(&all.set, (vec3){0, 0, -1}), k / 2, 3);
    cut(&all, &plane, 1);
    stage_render_sheets(&all.set, pixels);
    for (int i = 0; i < PIXELS; i++) {
      double square = pixel_x(i) * pixel_x(i) + pixel_y(i) * pixel_y(i);
      if (square > 10 * 10) continue;
      assert_near((double)pixels[4 * i], sqrt(144 - square) / 12, 0.03);
      assert_near((double)pixels[4 * i + 3], 1, 1e-5);
    }
    mesh_stage_close(&all);
  }
}

/* Slanting light falls into a bowl. A point of the bowl's wall has the brightness N.L if the ray to the light
 * leaves through the opening, and is dark if the ray meets the wall. Derived: a ray from a point of a ball at
 * which N.L = s meets the ball again after 2 R s. */
static void test_wall_within(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  static const hl_cut plane = {.type = HL_CUT_PLANE, .normal = {0, 0, 1}};
  const double radius = 12;
  for (int k = 0; k < 24; k++) {
    const double height = (25 + 7 * (k / 8)) * HL_PI / 180, turn = 0.7 * k;
    const vec3 sun = {cos(height) * cos(turn), cos(height) * sin(turn), sin(height)};
    int dark = 0, lit = 0;
    mesh_stage all;
    mesh_stage_open(&all, SIDE, 32);
    if (k % 2 == 0) add_sphere(&all, radius);
    else add_ball(&all, radius);
    mesh_stage_choose_shadows(&all, stage_add_directional(&all.set, vec3_scale(sun, -1)), k / 2 % 4, 3);
    cut(&all, &plane, 1);
    stage_render_sheets(&all.set, pixels);
    double sum = 0;
    for (int i = 0; i < PIXELS; i++) {
      double square = pixel_x(i) * pixel_x(i) + pixel_y(i) * pixel_y(i);
      if (square > 11 * 11) continue;
      vec3 at = {pixel_x(i), pixel_y(i), -sqrt(radius * radius - square)};
      double facing = -vec3_dot(at, sun) / radius, value = (double)pixels[4 * i];
      /* the height at which the ray to the light meets the ball again */
      double height_met = at.z + 2 * radius * facing * sun.z;
      if (facing < 0 || height_met < -2) {
        assert_near(value, 0, 0.02);
        sum += value;
        dark++;
      } else if (height_met > 2) {
        assert_near(value, facing, 0.01);
        lit++;
      }
    }
    assert_true(dark > 500 && lit > 50);
    assert_near(sum / dark, 0, 0.0003);
    mesh_stage_close(&all);
  }
}

/* A sphere lets a part of the light through. The sphere looks the same whether the alpha of its own colour or
 * the mesh's opacity makes it translucent. */
static void test_wall_of_a_clear_sphere(void **state) {
  (void)state;
  static float pixels[2][PIXELS * 4];
  const float sphere[1][4] = {{0, 0, 0, 12}}, clear[1][4] = {{1, 1, 1, 0.4f}};
  for (int k = 0; k < 8; k++) {
    for (int own = 0; own < 2; own++) {
      mesh_stage all;
      hl_mesh_description d;
      mesh_stage_open(&all, SIDE, 32);
      hl_mesh_description_defaults(&d);
      d.spheres = sphere, d.sphere_count = 1;
      d.sphere_colors = own ? clear : NULL;
      mesh_stage_describe(&all, &d)->opacity = own ? 1 : (double)clear[0][3];
      const vec3 travels = {cos(k), sin(k), -0.4};
      mesh_stage_choose_shadows(&all, stage_add_directional(&all.set, travels), k % 4, 3);
      stage_render_sheets(&all.set, pixels[own]);
      mesh_stage_close(&all);
    }
    for (int i = 0; i < 4 * PIXELS; i++) assert_near((double)pixels[1][i], (double)pixels[0][i], 1e-5);
  }
}

/* A floor lies below a ball that the eye does not see. The part that is cut off the ball casts no shadow. */
static void test_shadow_of_half_a_ball(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  static const hl_cut plane = {.type = HL_CUT_PLANE, .point = {2.2, 0, 0}, .normal = {1, 0, 0}};
  for (int k = 0; k < 8; k++) {
    mesh_stage all;
    mesh_stage_open(&all, SIDE, 32);
    hl_mesh *floor = stage_make_quad(&all.set, (vec3){-20, 0, -12}, (vec3){22, 0, 0}, (vec3){0, 40, 0});
    mesh_stage_add(&all, floor);
    hl_scene_mesh *ball = k % 2 == 0 ? add_sphere(&all, 9) : add_ball(&all, 9);
    ball->visible = 0;
    ball->translate[0] = -1;
    mesh_stage_choose_shadows(&all, stage_add_directional(&all.set, (vec3){0, 0, -1}), k / 2, 1);
    cut(&all, &plane, 1);
    stage_render_sheets(&all.set, pixels);
    double dark = 0;
    for (int i = 0; i < PIXELS; i++)
      if (pixel_x(i) < 2) dark += (1 - (double)pixels[4 * i]) * PIXEL_AREA;
    assert_near(dark / (HL_PI * 81 - segment(9, 3.2) - 2 * 0.2 * sqrt(81 - 9)), 1, 0.02);
    assert_near((double)pixels[4 * (SIDE / 2 * SIDE + SIDE / 2 + 2)], 0, 0.02);
    mesh_stage_close(&all);
  }
}

/* A board that is cut into half and a board of half the width make the same picture in the light of the sky,
 * and among haze that scatters light repeatedly. */
static void add_board(mesh_stage *all, bool is_cut) {
  double right = is_cut ? 10 : 0;
  hl_mesh *board = stage_make_quad(&all->set, (vec3){(right - 10) / 2, 0, 2}, (vec3){(right + 10) / 2, 0, 0},
                                   (vec3){0, 10, 0});
  mesh_stage_add(all, board)->visible = 0;
}

static void test_light_of_fields(void **state) {
  (void)state;
  static float pixels[3][PIXELS * 4];
  static const hl_cut plane = {.type = HL_CUT_PLANE, .normal = {1, 0, 0}};
  for (int k = 0; k < 2; k++) {
    for (int run = 0; run < 3; run++) { /* half a board, a cut board, and no board */
      mesh_stage all;
      mesh_stage_open(&all, SIDE, 32);
      if (run < 2) add_board(&all, run == 1);
      hl_scene_volume *haze = stage_add_box(&all.set, (vec3){-10, -10, -8}, (vec3){0, 10, 8});
      stage_set_opacity(&all.set, haze, 0.06, 1);
      haze->shading = HL_SHADING_NONE;
      haze->multiple_scattering = k;
      stage_add_directional(&all.set, (vec3){0, 0.1, -1});
      all.set.scene.render.shadows = HL_SHADOWS_HARD;
      if (k == 0) all.set.scene.sky.type = HL_SKY_UNIFORM;
      cut(&all, &plane, 1); /* the haze ends at the cut, so that the cut removes no haze */
      stage_render_sheets(&all.set, pixels[run]);
      mesh_stage_close(&all);
    }
    double off = 0, change = 0;
    for (int i = 0; i < PIXELS; i++) {
      off = fmax(off, fabs((double)pixels[0][4 * i] - (double)pixels[1][4 * i]));
      change = fmax(change, fabs((double)pixels[2][4 * i] - (double)pixels[1][4 * i]));
    }
    assert_true(change > 0.1);
    assert_near(off, 0, 0.01);
  }
}

/* ---- scenes that cuts leave whole ---- */

/* One plane cuts two boards over a floor into halves. The first board and the floor are set not to be cut.
 * The eye sees the floor everywhere and the boards nowhere. By the sheets and by the reference, the uncut
 * board shades the floor with its whole area, and the cut board with half of its area. */
static void test_whole_meshes(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  static const hl_cut plane = {.type = HL_CUT_PLANE, .normal = {1, 0, 0}};
  hl_reference_options options;
  hl_reference_options_defaults(&options);
  mesh_stage all;
  mesh_stage_open(&all, SIDE, 32);
  for (int i = 0; i < 2; i++) {
    hl_scene_mesh *board = mesh_stage_add(
        &all, stage_make_quad(&all.set, (vec3){0, i == 0 ? 8 : -8, 0}, (vec3){10, 0, 0}, (vec3){0, 4, 0}));
    board->cut = i;
    board->visible = 0;
  }
  hl_scene_mesh *floor = mesh_stage_add(
      &all, stage_make_quad(&all.set, (vec3){0, 0, -12}, (vec3){20, 0, 0}, (vec3){0, 20, 0}));
  hl_mesh *square = floor->mesh;
  hl_scene_floor_defaults(floor);
  floor->mesh = square;
  mesh_stage_choose_shadows(&all, stage_add_directional(&all.set, (vec3){0, 0, -1}), 0, 1);
  cut(&all, &plane, 1);
  for (int by_reference = 0; by_reference < 2; by_reference++) {
    double dark[2] = {0, 0}, lit = 0.5 * floor->material.diffuse;
    if (by_reference) stage_render(&all.set, &options, pixels);
    else stage_render_sheets(&all.set, pixels);
    for (int i = 0; i < PIXELS; i++) {
      assert_near((double)pixels[4 * i + 3], 1, 1e-5);
      dark[pixel_y(i) < 0] += (1 - (double)pixels[4 * i] / lit) * PIXEL_AREA;
    }
    assert_near(dark[0], 20 * 8, 3);
    assert_near(dark[1], 10 * 8, 3);
  }
  mesh_stage_close(&all);
}

/* ---- the reference, and invariance ---- */

static const hl_cut CORNER[] = {{.type = HL_CUT_BOX, .min = {-1, -40, 0.3}, .max = {40, 0.7, 40}},
                                {.type = HL_CUT_SPHERE, .center = {-7, 6, 5}, .radius = 6},
                                {.type = HL_CUT_PLANE, .point = {0, 0, -8}, .normal = {0.1, 0.3, -1}}};

static void open_scenery(mesh_stage *all, int side) {
  mesh_stage_open(all, side, 32);
  mesh_stage_add(all, stage_make_quad(&all->set, (vec3){0, 0, -6}, (vec3){14, 2, 1}, (vec3){-2, 14, 3}));
  add_ball(all, 9)->translate[0] = 2;
  add_sphere(all, 6)->opacity = 0.6;
  all->meshes[2].translate[0] = -7;
  stage_add_directional(&all->set, (vec3){0.3, -0.4, -1});
  all->set.scene.render.shadows = HL_SHADOWS_HARD;
  /* shadows begin a little behind a mesh, and fine shadow pixels make this strip thin */
  all->set.scene.render.shadow_resolution = 512;
  all->set.scene.camera.type = HL_CAMERA_PERSPECTIVE;
  all->set.scene.camera.fovy_deg = 25;
  stage_look(&all->set, (vec3){30, -40, 50}, (vec3){0, 0, 0}, (vec3){0, 0, 1});
  cut(all, CORNER, 3);
}

static void test_against_the_reference(void **state) {
  (void)state;
  static float sheets[PIXELS * 4], exact[PIXELS * 4];
  hl_reference_options options;
  hl_reference_options_defaults(&options);
  options.rays = 4;
  mesh_stage all;
  open_scenery(&all, SIDE);
  stage_render_sheets(&all.set, sheets);
  stage_render(&all.set, &options, exact);
  double sum[4] = {0}, signed_sum[4] = {0};
  for (int i = 0; i < 4 * PIXELS; i++) {
    double difference = (double)sheets[i] - (double)exact[i];
    sum[i % 4] += difference * difference;
    signed_sum[i % 4] += difference;
  }
  assert_near(sqrt(sum[0] / PIXELS), 0, 0.036);
  assert_near(sqrt(sum[3] / PIXELS), 0, 0.015);
  assert_near(signed_sum[0] / PIXELS, 0, 0.003);
  assert_near(signed_sum[3] / PIXELS, 0, 0.001);
  mesh_stage_close(&all);
}

/* One renderer draws a scene whole, cut, cut elsewhere, with one mesh that is not cut, and whole again, by
 * one thread or seven. Each picture has the bytes of a new renderer's picture. */
static void test_kept_between_frames(void **state) {
  (void)state;
  static float fresh[PIXELS * 4], kept[PIXELS * 4], before[PIXELS * 4];
  mesh_stage all;
  hl_renderer *renderer = NULL;
  open_scenery(&all, SIDE / 2);
  all.set.scene.sky.type = HL_SKY_UNIFORM;
  assert_int_equal(hl_renderer_create(all.set.context, &renderer, NULL), HL_OK);
  for (int step = 0; step < 5; step++) {
    cut(&all, step == 1 ? CORNER : CORNER + 1, step % 4 == 0 ? 0 : 2);
    all.meshes[1].cut = step != 3;
    all.set.scene.render.threads = step % 2 ? 7 : 1;
    stage_render_sheets(&all.set, fresh);
    all.set.scene.render.threads = 2;
    stage_render_with(&all.set, renderer, kept);
    assert_memory_equal(fresh, kept, (SIDE / 2) * (SIDE / 2) * 4 * sizeof *fresh);
    if (step > 0) assert_memory_not_equal(before, kept, (SIDE / 2) * (SIDE / 2) * 4 * sizeof *kept);
    memcpy(before, kept, sizeof kept);
  }
  hl_renderer_destroy(renderer);
  mesh_stage_close(&all);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_half_a_ball),
      cmocka_unit_test(test_holes),
      cmocka_unit_test(test_inside_of_a_bowl),
      cmocka_unit_test(test_wall_within),
      cmocka_unit_test(test_wall_of_a_clear_sphere),
      cmocka_unit_test(test_shadow_of_half_a_ball),
      cmocka_unit_test(test_light_of_fields),
      cmocka_unit_test(test_whole_meshes),
      cmocka_unit_test(test_against_the_reference),
      cmocka_unit_test(test_kept_between_frames),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
