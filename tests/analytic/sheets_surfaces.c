/* analytic/sheets_surfaces.c - meshes among volumes: coverage, opacity, light and shadows, against closed
 * forms. */
#include <stdlib.h>
#include <string.h>

#include "../asserts.h"
#include "mesh_stage.h"

enum { SIDE = 64, PIXELS = SIDE * SIDE };

static void open_meshes(mesh_stage *all) { mesh_stage_open(all, SIDE, 32); }

static hl_scene_mesh *add_mesh(mesh_stage *all, const float (*positions)[3], size_t vertices,
                               const uint32_t (*triangles)[3], size_t count) {
  hl_mesh_description d;
  hl_mesh_description_defaults(&d);
  d.positions = positions, d.vertex_count = vertices, d.triangles = triangles, d.triangle_count = count;
  return mesh_stage_describe(all, &d);
}

/* Adds a rectangle around a centre. u, v: the vectors from the centre to the middles of two edges. */
static hl_scene_mesh *add_quad(mesh_stage *all, vec3 centre, vec3 u, vec3 v) {
  return mesh_stage_add(all, stage_make_quad(&all->set, centre, u, v));
}

/* ---- coverage ---- */

/* A rectangle's edges lie at odd fractions of pixels. A pixel's alpha is the fraction of the pixel that the
 * rectangle covers, to a sixteenth for each side. No seam shows where the rectangle's triangles meet. A pixel
 * is half a unit wide. */
static void test_coverage(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  for (int k = 0; k < 6; k++) {
    double opacity = k % 2 ? 0.5 : 1, x = 5.15 + 0.31 * k, y = 7.27 - 0.23 * k;
    mesh_stage all;
    open_meshes(&all);
    add_quad(&all, (vec3){0, 0, 3}, (vec3){x, 0, 0}, (vec3){0, y, 0})->opacity = opacity;
    stage_render_sheets(&all.set, pixels);
    double sum = 0;
    for (int i = 0; i < PIXELS; i++) {
      double left = (i % SIDE - SIDE / 2) * 0.5, top = (i / SIDE - SIDE / 2) * 0.5;
      double across = fmax(fmin(left + 0.5, x) - fmax(left, -x), 0) / 0.5,
             down = fmax(fmin(top + 0.5, y) - fmax(top, -y), 0) / 0.5;
      double alpha = (double)pixels[4 * i + 3];
      sum += alpha;
      assert_near(alpha, opacity * across * down, across * down == 1 ? 1e-6 : opacity * 0.13);
    }
    assert_near(sum, opacity * 4 * x * y / 0.25, opacity * 12);
    mesh_stage_close(&all);
  }
}

/* All pixels within a board of many small triangles, oblique to the eye, have the board's opacity. */
static void test_no_seams(void **state) {
  (void)state;
  enum { N = 24 };
  static float positions[(N + 1) * (N + 1)][3], pixels[PIXELS * 4];
  static uint32_t triangles[2 * N * N][3];
  for (int i = 0; i < (N + 1) * (N + 1); i++) {
    double x = (i % (N + 1)) * 24.0 / N - 12, y = (i / (N + 1)) * 24.0 / N - 12;
    vec3_store(positions[i], (vec3){x, y, 0.4 * x - 0.3 * y});
  }
  for (int i = 0; i < N * N; i++) {
    uint32_t at = (uint32_t)(i / N * (N + 1) + i % N);
    memcpy(triangles[2 * i], (uint32_t[3]){at, at + 1, at + N + 2}, sizeof triangles[0]);
    memcpy(triangles[2 * i + 1], (uint32_t[3]){at, at + N + 2, at + N + 1}, sizeof triangles[0]);
  }
  for (int k = 0; k < 4; k++) {
    mesh_stage all;
    open_meshes(&all);
    double opacity = k % 2 ? 0.7 : 1;
    add_mesh(&all, (const float(*)[3])positions, (N + 1) * (N + 1), (const uint32_t(*)[3])triangles,
             2 * N * N)
        ->opacity = opacity;
    stage_add_directional(&all.set, k < 2 ? (vec3){0.2, 0.3, -1} : (vec3){0.2, 0.3, 1});
    stage_render_sheets(&all.set, pixels);
    for (int y = 12; y < SIDE - 12; y++)
      for (int x = 12; x < SIDE - 12; x++) assert_near((double)pixels[4 * (y * SIDE + x) + 3], opacity, 1e-5);
    mesh_stage_close(&all);
  }
}

/* ---- matter before and behind ---- */

/* A haze of one colour has a black pane in its middle. The eye sees the haze before the pane, and sees the
 * haze behind the pane only through a translucent pane. */
static void test_pane_in_haze(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  for (int k = 0; k < 8; k++) {
    double opacity = k % 4 / 3.0, depth = 8 * -log(1 - 0.1), half = exp(-depth / 2);
    mesh_stage all;
    open_meshes(&all);
    hl_scene_volume *haze = stage_add_box(&all.set, (vec3){-8, -8, -4}, (vec3){8, 8, 4});
    stage_set_opacity(&all.set, haze, 0.1, 1);
    stage_set_color(&all.set, haze, 1, 0.5, 0.25);
    haze->shading = HL_SHADING_FLAT;
    add_quad(&all, (vec3){0, 0, 0}, (vec3){6, 0, 0}, (vec3){0, 6, 0})->opacity = opacity;
    all.meshes[0].material.diffuse = 0;
    /* light from behind: sheets go from back to front */
    if (k >= 4) stage_add_directional(&all.set, (vec3){0.2, 0.3, 1});
    stage_render_sheets(&all.set, pixels);
    double seen = 1 - half + half * (1 - opacity) * (1 - half), alpha = 1 - half * half * (1 - opacity);
    for (int y = SIDE / 2 - 8; y < SIDE / 2 + 8; y++)
      for (int x = SIDE / 2 - 8; x < SIDE / 2 + 8; x++) {
        const float *pixel = pixels + 4 * (y * SIDE + x);
        assert_near((double)pixel[0], seen, 2e-4);
        assert_near((double)pixel[2], seen * 0.25, 2e-4);
        assert_near((double)pixel[3], alpha, 2e-4);
      }
    mesh_stage_close(&all);
  }
}

/* ---- light ---- */

/* A board alone, at angles to the light up to nearly 90 degrees, is evenly lit by N.L. It does not shade
 * itself. */
static void test_no_acne(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  for (int k = 0; k < 4; k++)
    for (double tilt = 0; tilt <= 80; tilt += 16) {
      double angle = tilt * HL_PI / 180, turn = tilt * 0.7;
      vec3 u = {cos(turn), sin(turn), 0}, v = {-sin(turn) * cos(angle), cos(turn) * cos(angle), sin(angle)};
      mesh_stage all;
      open_meshes(&all);
      add_quad(&all, (vec3){0, 0, 0}, vec3_scale(u, 20), vec3_scale(v, 60));
      hl_light *light = stage_add_directional(&all.set, (vec3){0, 0, -1});
      mesh_stage_choose_shadows(&all, light, k, 8);
      vec3 normal = vec3_cross(u, v); /* the eye is on the lit side */
      stage_look(&all.set, vec3_scale(vec3_add(normal, (vec3){0.1, 0.2, 0.6}), 80), (vec3){0, 0, 0}, u);
      stage_render_sheets(&all.set, pixels);
      int seen = 0;
      for (int i = 0; i < PIXELS; i++) {
        int x = i % SIDE, y = i / SIDE;
        if (x < 16 || x >= SIDE - 16 || y < 16 || y >= SIDE - 16 || pixels[4 * i + 3] < 0.9999f) continue;
        assert_near((double)pixels[4 * i], cos(angle), 0.005);
        seen++;
      }
      assert_true(seen > 300);
      mesh_stage_close(&all);
    }
}

/* Opens a scene of a floor, seen from the side, with sheets a voxel apart. */
static void open_floor(mesh_stage *all) {
  open_meshes(all);
  add_quad(all, (vec3){0, 0, 0}, (vec3){60, 0, 0}, (vec3){0, 60, 0});
  all->set.scene.camera.height = 70;
  stage_look(&all->set, (vec3){43, -60, 71}, (vec3){0, 0, 0}, (vec3){0, 0, 1});
  all->set.scene.render.shadow_resolution = SIDE;
  all->set.scene.render.sheet_spacing = 1;
}

/* Asserts that a floor alone looks the same with and without shadows: to a tolerance in all pixels but one of
 * a thousand, and to twice the tolerance in every pixel. kind: of the shadows. */
static void assert_no_acne(mesh_stage *floor, hl_light *light, int kind, double tolerance) {
  static float open[PIXELS * 4], pixels[PIXELS * 4];
  floor->set.scene.render.shadows = HL_SHADOWS_OFF;
  stage_render_sheets(&floor->set, open);
  mesh_stage_choose_shadows(floor, light, kind, 0);
  stage_render_sheets(&floor->set, pixels);
  int seen = 0, off = 0;
  for (int i = 0; i < PIXELS; i++) {
    if (open[4 * i + 3] < 0.9999f) continue;
    double ratio = (double)(pixels[4 * i] / open[4 * i]);
    assert_near(ratio, 1, 2 * tolerance);
    off += fabs(ratio - 1) > tolerance;
    seen++;
  }
  assert_true(seen > 2000);
  assert_true(off * 1000 <= seen);
}

/* Under a lamp, rays at the sides of the shadow buffer have other directions than in its middle. So look-ups
 * are moved to places where the floor is not yet in the shadow buffer. */
static void test_no_acne_under_lamps(void **state) {
  (void)state;
  for (int k = 0; k < 4; k++) {
    mesh_stage all;
    open_floor(&all);
    hl_light *lamp = stage_add_point(&all.set, (vec3){0, 0, 40});
    lamp->radius = k == 0 ? 0 : 6;
    assert_no_acne(&all, lamp, k, 0.002);
    mesh_stage_close(&all);
  }
}

/* A floor does not shade itself in hard light from any side and height, to which the sheets are slanted. The
 * floor enters the shadow buffer only behind the reach of its own look-ups. */
static void test_no_acne_at_slopes(void **state) {
  (void)state;
  for (int k = 0; k < 16; k++) {
    double height = (10 + 5 * k) * HL_PI / 180, side = 2.4 * k;
    mesh_stage all;
    open_floor(&all);
    hl_light *light = stage_add_directional(
        &all.set, (vec3){-cos(height) * cos(side), -cos(height) * sin(side), -sin(height)});
    assert_no_acne(&all, light, 0, 0.005);
    mesh_stage_close(&all);
  }
}

/* A pane of the opacity o between a light and a floor absorbs the fraction o of the light, by every method
 * and in every colour. */
static void test_translucent_pane(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  for (int k = 0; k < 4; k++) {
    mesh_stage all;
    open_meshes(&all);
    add_quad(&all, (vec3){0, 0, -4}, (vec3){15, 0, 0}, (vec3){0, 15, 0});
    hl_scene_mesh *pane = add_quad(&all, (vec3){0, 0, 4}, (vec3){12, 0, 0}, (vec3){0, 12, 0});
    pane->opacity = 0.3;
    pane->visible = 0;
    mesh_stage_choose_shadows(&all, stage_add_directional(&all.set, (vec3){0, 0, -1}), k, 5);
    stage_render_sheets(&all.set, pixels);
    for (int y = SIDE / 2 - 10; y < SIDE / 2 + 10; y++)
      for (int x = SIDE / 2 - 10; x < SIDE / 2 + 10; x++)
        assert_near((double)pixels[4 * (y * SIDE + x)], 0.7, 0.01);
    pane->casts_shadow = 0;
    stage_render_sheets(&all.set, pixels);
    assert_near((double)pixels[4 * (SIDE / 2 * SIDE + SIDE / 2)], 1, 1e-4);
    mesh_stage_close(&all);
  }
}

/* Returns the fraction of a disk of the radius 1 on one side of a line at the distance x from its middle. */
static double disk_beyond(double x) {
  if (x <= -1) return 1;
  if (x >= 1) return 0;
  return (acos(x) - x * sqrt(1 - x * x)) / HL_PI;
}

/* An edge at the height 12 above a floor, under a light of 20 degrees. In the penumbra the floor gets the
 * fraction of the light's disk that the floor sees past the edge. The paper's method is not tested, because
 * its penumbrae have another width. */
static void test_penumbra(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  static const struct {
    int kind;
    double angle, tolerance, mean;
  } cases[] = {{0, 0, 0.51, 0.02}, {1, 20, 0.06, 0.02}, {3, 20, 0.14, 0.04}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    mesh_stage all;
    open_meshes(&all);
    add_quad(&all, (vec3){0, 0, -6}, (vec3){15.5, 0, 0}, (vec3){0, 15.5, 0});
    /* the edge lies at x = 0 */
    add_quad(&all, (vec3){-15, 0, 6}, (vec3){15, 0, 0}, (vec3){0, 40, 0})->visible = 0;
    mesh_stage_choose_shadows(&all, stage_add_directional(&all.set, (vec3){0, 0, -1}), cases[k].kind,
                              cases[k].angle);
    stage_render_sheets(&all.set, pixels);
    double radius = fmax(12 * tan(cases[k].angle / 2 * HL_PI / 180), 1e-9), sum = 0;
    int count = 0;
    for (int x = 4; x < SIDE - 4; x++) {
      double at = (x + 0.5 - SIDE / 2.0) * 0.5, light = (double)pixels[4 * (SIDE / 2 * SIDE + x)];
      double expected = 1 - disk_beyond(at / radius);
      assert_near(light, expected, cases[k].tolerance);
      sum += fabs(light - expected);
      count++;
    }
    assert_near(sum / count, 0, cases[k].mean);
    mesh_stage_close(&all);
  }
}

/* Volumes shade meshes: a floor behind a box of haze gets the light that the haze lets through. Meshes shade
 * volumes: haze below an opaque pane is dark. */
static void test_volume_and_mesh(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  for (int k = 0; k < 4; k++) {
    mesh_stage all;
    open_meshes(&all);
    hl_scene_volume *haze = stage_add_box(&all.set, (vec3){-12, -12, 0}, (vec3){12, 12, 8});
    stage_set_opacity(&all.set, haze, 0.1, 1);
    haze->visible = 0;
    add_quad(&all, (vec3){0, 0, -4}, (vec3){15, 0, 0}, (vec3){0, 15, 0});
    mesh_stage_choose_shadows(&all, stage_add_directional(&all.set, (vec3){0, 0, -1}), k, 5);
    stage_render_sheets(&all.set, pixels);
    for (int y = SIDE / 2 - 10; y < SIDE / 2 + 10; y++)
      for (int x = SIDE / 2 - 10; x < SIDE / 2 + 10; x++)
        assert_near((double)pixels[4 * (y * SIDE + x)], pow(0.9, 8), 0.01);
    haze->visible = 1;
    haze->casts_shadow = 0;
    add_quad(&all, (vec3){0, 0, 10}, (vec3){15, 0, 0}, (vec3){0, 15, 0})->visible = 0;
    stage_render_sheets(&all.set, pixels);
    for (int c = 0; c < 3; c++) assert_near((double)pixels[4 * (SIDE / 2 * SIDE + SIDE / 2) + c], 0, 0.01);
    mesh_stage_close(&all);
  }
}

/* ---- invariance ---- */

/* Adds two boards, one of them translucent, and a sphere in a haze. reach: the haze's size from the
 * middle. */
static void add_scenery(mesh_stage *all, double reach) {
  add_quad(all, (vec3){0, 0, -6}, (vec3){14, 2, 1}, (vec3){-2, 14, 3});
  add_quad(all, (vec3){2, 1, 3}, (vec3){5, 1, 3}, (vec3){-1, 6, -2})->opacity = 0.6;
  hl_scene_volume *haze = stage_add_box(&all->set, (vec3){-reach, -reach, -5}, (vec3){reach, reach, 4});
  stage_set_opacity(&all->set, haze, 0.03, 1);
  hl_light *light = stage_add_directional(&all->set, (vec3){0.3, -0.4, -1});
  light->angular_diameter_deg = 10;
  all->set.scene.camera.type = HL_CAMERA_PERSPECTIVE;
  all->set.scene.camera.fovy_deg = 25;
  stage_look(&all->set, (vec3){30, -40, 50}, (vec3){0, 0, 0}, (vec3){0, 0, 1});
}

static void test_threads_and_instruction_sets(void **state) {
  (void)state;
  static float first[PIXELS * 4], other[PIXELS * 4];
  for (int k = 0; k < 4; k++)
    for (int run = 0; run < 4; run++) {
      mesh_stage all;
      open_meshes(&all);
      add_scenery(&all, 7);
      mesh_stage_choose_shadows(&all, &all.set.lights[0], k, 10);
      all.set.scene.render.threads = (const int[]){1, 2, 7, 1}[run];
      stage_render_sheets(&all.set, run == 0 ? first : other);
      if (run > 0) assert_memory_equal(first, other, sizeof first);
      mesh_stage_close(&all);
    }
}

/* Changes the scene between two frames of one renderer, which keeps data of the frame before. */
static void change(mesh_stage *all, int step) {
  hl_scene_mesh *board = &all->meshes[0], *pane = &all->meshes[1];
  if (step == 1) stage_look(&all->set, (vec3){-35, -40, 40}, (vec3){0, 0, 0}, (vec3){0, 0, 1});
  if (step == 2) board->color[0] = 0.2, pane->opacity = 0.9;
  if (step == 3) pane->translate[0] += 3;
  if (step == 4) board->rotate_angle_deg = 20;
  if (step == 5) board->scale = 0.7;
  if (step == 6) all->set.scene.mesh_count = 1;
  if (step == 7) all->set.scene.mesh_count = 0;
  if (step == 8) all->set.scene.mesh_count = 2;
  if (step != 9) return;
  hl_mesh_release(board->mesh);
  board->mesh = stage_make_quad(&all->set, (vec3){1, 0, -6}, (vec3){12, 2, 1}, (vec3){-2, 9, 3});
}

/* After each change, a renderer that has drawn other frames makes the bytes of a new renderer. */
static void test_kept_between_frames(void **state) {
  (void)state;
  static float fresh[PIXELS * 4], kept[PIXELS * 4], before[PIXELS * 4];
  mesh_stage all;
  hl_renderer *renderer = NULL;
  open_meshes(&all);
  add_scenery(&all, 7);
  mesh_stage_choose_shadows(&all, &all.set.lights[0], 0, 0);
  all.set.scene.width = all.set.scene.height = SIDE / 4;
  assert_int_equal(hl_renderer_create(all.set.context, &renderer, NULL), HL_OK);
  for (int step = 0; step < 10; step++) {
    change(&all, step);
    stage_render_sheets(&all.set, fresh);
    stage_render_with(&all.set, renderer, kept);
    assert_memory_equal(fresh, kept, sizeof fresh);
    if (step > 0) assert_memory_not_equal(before, kept, sizeof kept);
    memcpy(before, kept, sizeof kept);
  }
  hl_renderer_destroy(renderer);
  mesh_stage_close(&all);
}

/* The picture with hard shadows is near the picture of the reference, which has sixteen rays for each
 * pixel. */
static void test_against_the_reference(void **state) {
  (void)state;
  static float sheets[PIXELS * 4], exact[PIXELS * 4];
  hl_reference_options options;
  hl_reference_options_defaults(&options);
  options.rays = 4;
  options.step = 2; /* the haze is even */
  mesh_stage all;
  open_meshes(&all);
  add_scenery(&all, 60); /* edges of volumes are not antialiased, and lie outside of the picture */
  mesh_stage_choose_shadows(&all, &all.set.lights[0], 0, 0);
  all.set.scene.width = all.set.scene.height = SIDE / 2;
  stage_render_sheets(&all.set, sheets);
  stage_render(&all.set, &options, exact);
  double sum = 0, signed_sum = 0;
  for (int i = 0; i < PIXELS; i++) {
    double difference = (double)sheets[i] - (double)exact[i];
    sum += difference * difference;
    signed_sum += difference;
  }
  assert_near(sqrt(sum / PIXELS), 0, 0.016);
  assert_near(signed_sum / PIXELS, 0, 0.0015);
  mesh_stage_close(&all);
}

/* ---- spheres and tubes ---- */

static hl_scene_mesh *add_round(mesh_stage *all, const float (*spheres)[4], size_t count,
                                const float (*points)[4], uint32_t length) {
  hl_mesh_description d;
  hl_mesh_description_defaults(&d);
  d.spheres = spheres, d.sphere_count = count;
  d.line_points = points, d.line_point_count = length, d.line_lengths = &length, d.line_count = length > 0;
  return mesh_stage_describe(all, &d);
}

/* Spheres at odd fractions of pixels cover the area of their disks, with level and slanted sheets.
 * Translucent spheres absorb light at the front and at the back. */
static void test_sphere_coverage(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  for (int k = 0; k < 8; k++) {
    double opacity = k % 2 ? 0.4 : 1, taken = k % 2 ? 1 - 0.6 * 0.6 : 1;
    const float sphere[1][4] = {{0.13f * (float)k, -0.21f, 1, 6.3f + 0.37f * (float)k}};
    mesh_stage all;
    open_meshes(&all);
    add_round(&all, sphere, 1, NULL, 0)->opacity = opacity;
    if (k >= 4) stage_add_directional(&all.set, (vec3){0.8, 0.3, -0.4});
    stage_render_sheets(&all.set, pixels);
    double sum = 0;
    for (int i = 0; i < PIXELS; i++) {
      double x = (i % SIDE + 0.5 - SIDE / 2) * 0.5 - (double)sphere[0][0],
             y = -(i / SIDE + 0.5 - SIDE / 2) * 0.5 - (double)sphere[0][1], distance = sqrt(x * x + y * y);
      double alpha = (double)pixels[4 * i + 3], inside = (double)sphere[0][3] - distance;
      sum += alpha;
      if (fabs(inside) > 0.36) assert_near(alpha, inside > 0 ? taken : 0, 1e-5);
    }
    assert_near(sum * 0.25, taken * HL_PI * (double)sphere[0][3] * (double)sphere[0][3], taken * 0.5);
    mesh_stage_close(&all);
  }
}

/* Under a distant light, a sphere is lit by N.L on one side of the terminator and dark on the other, by every
 * method. The sphere's own shadow does not cross the terminator, and no light is left on the dark side. */
static void test_terminator(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  static const float sphere[1][4] = {{0, 0, 0, 12}};
  const vec3 towards = vec3_normalise((vec3){0.8, 0.1, 0.35});
  for (int k = 0; k < 4; k++) {
    mesh_stage all;
    open_meshes(&all);
    add_round(&all, sphere, 1, NULL, 0);
    mesh_stage_choose_shadows(&all, stage_add_directional(&all.set, vec3_scale(towards, -1)), k, 4);
    stage_render_sheets(&all.set, pixels);
    int lit = 0, dark = 0;
    for (int i = 0; i < PIXELS; i++) {
      double x = (i % SIDE + 0.5 - SIDE / 2) * 0.5, y = -(i / SIDE + 0.5 - SIDE / 2) * 0.5,
             z = sqrt(fmax(144 - x * x - y * y, 0));
      if (x * x + y * y > 11.4 * 11.4) continue; /* the silhouette is antialiased, and is left out */
      double cosine = vec3_dot((vec3){x / 12, y / 12, z / 12}, towards);
      assert_near((double)pixels[4 * i], fmax(cosine, 0), cosine > 0.25 ? 0.012 : 0.05);
      lit += cosine > 0;
      dark += cosine <= 0;
    }
    assert_true(lit > 300 && dark > 300);
    mesh_stage_close(&all);
  }
}

/* A bent tube, seen from above, covers its length times its width. At the bend there is no gap, and no part
 * counts twice: every pixel has the opacity of the tube's two sides. */
static void test_tube(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  static const float points[3][4] = {{-9, -4, 0, 2}, {1, -4, 0, 2}, {7, 6, 0, 2}};
  for (int k = 0; k < 2; k++) {
    mesh_stage all;
    open_meshes(&all);
    add_round(&all, NULL, 0, points, 3)->opacity = k == 0 ? 1 : 0.4;
    stage_render_sheets(&all.set, pixels);
    double sum = 0, taken = k == 0 ? 1 : 1 - 0.6 * 0.6;
    for (int i = 0; i < PIXELS; i++) {
      assert_true((double)pixels[4 * i + 3] < taken + 1e-5);
      sum += (double)pixels[4 * i + 3] * 0.25;
    }
    double length =
        10 + sqrt(36 + 100); /* each end of the tube covers half of a disk of the radius 2, as a polygon */
    assert_near(sum / taken, length * 4 + HL_PI * 4, 2);
    mesh_stage_close(&all);
  }
}

/* A red pane colours the light that passes it, by every method, so that the floor behind it is red. */
static void test_colored_pane(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  for (int k = 0; k < 4; k++) {
    mesh_stage all;
    open_meshes(&all);
    add_quad(&all, (vec3){0, 0, -4}, (vec3){15, 0, 0}, (vec3){0, 15, 0});
    for (int pane = 0; pane < 2; pane++) {
      hl_scene_mesh *mesh = add_quad(&all, (vec3){0, 0, 4 + 0.1 * pane}, (vec3){12, 0, 0}, (vec3){0, 12, 0});
      mesh->visible = 0;
      mesh->opacity = pane == 0 ? 0.5 : 1; /* the second pane is opaque in all colours but red */
      memcpy(mesh->attenuation_color, (double[3]){0, 0.2 + 0.3 * pane, 1}, sizeof mesh->attenuation_color);
    }
    mesh_stage_choose_shadows(&all, stage_add_directional(&all.set, (vec3){0, 0, -1}), k, 5);
    stage_render_sheets(&all.set, pixels);
    const float *pixel = pixels + 4 * (SIDE / 2 * SIDE + SIDE / 2);
    assert_near((double)pixel[0], 1, 0.01);
    assert_near((double)pixel[1], 0.9 * 0.5, 0.01);
    assert_near((double)pixel[2], 0, 0.01);
    mesh_stage_close(&all);
  }
}

/* Adds a cube of triangles around the middle. half: half of the cube's edge. */
static hl_scene_mesh *add_cube(mesh_stage *all, double half) {
  static const uint32_t faces[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                                        {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  float corners[8][3];
  for (int i = 0; i < 8; i++)
    vec3_store(corners[i], (vec3){i & 1 ? half : -half, i & 2 ? half : -half, i & 4 ? half : -half});
  return add_mesh(all, (const float(*)[3])corners, 8, faces, 12);
}

/* A cube of triangles and an opaque box of a volume have the same silhouettes and the same shadow on a floor,
 * by every method. In the cascade's umbra of the box some light is left, so that the cascade's shadow of the
 * cube is compared with the shadow of the box by sub-lights. */
static void test_cube_and_box(void **state) {
  (void)state;
  static float cube[PIXELS * 4], box[PIXELS * 4];
  double by_cascade[2] = {0, 0};
  for (int k = 0; k < 4; k++)
    for (int invisible = 0; invisible < 2; invisible++) {
      for (int of_volume = 0; of_volume < 2; of_volume++) {
        mesh_stage all;
        open_meshes(&all);
        add_quad(&all, (vec3){0, 0, -8}, (vec3){22, 0, 0}, (vec3){0, 22, 0});
        if (of_volume) {
          hl_scene_volume *made = stage_add_box(&all.set, (vec3){-5, -5, -5}, (vec3){5, 5, 5});
          stage_set_opacity(&all.set, made, 0.999999, 0.1);
          stage_set_color(&all.set, made, 0, 0, 0);
          made->visible = !invisible;
        } else {
          hl_scene_mesh *made = add_cube(&all, 5);
          made->material.diffuse = 0;
          made->visible = !invisible;
        }
        mesh_stage_choose_shadows(&all, stage_add_directional(&all.set, (vec3){0.5, -0.3, -1}), k, 6);
        stage_look(&all.set, (vec3){30, 20, 80}, (vec3){0, 0, -3}, (vec3){0, 1, 0});
        stage_render_sheets(&all.set, of_volume ? box : cube);
        mesh_stage_close(&all);
      }
      double sum = 0, signed_sum = 0, dark = 0, light = 0;
      for (int i = 0; i < PIXELS; i++) {
        double difference = (double)cube[4 * i] - (double)box[4 * i];
        light += (double)cube[4 * i];
        sum += fabs(difference);
        signed_sum += difference;
        dark += (double)cube[4 * i] < 0.3 && cube[4 * i + 3] > 0.99f;
      }
      assert_true(dark > 200);
      assert_near(sum / PIXELS, 0, 0.008); /* edges of volumes are not antialiased */
      if (k == 1) by_cascade[invisible] = light;
      else assert_near(signed_sum / PIXELS, 0, 0.0006);
      if (k == 3) assert_near((by_cascade[invisible] - light) / PIXELS, 0, 0.0012);
    }
}

/* A scene of meshes alone gives the same picture as the meshes beside a transparent volume. */
static void test_no_volume(void **state) {
  (void)state;
  static float alone[PIXELS * 4];
  mesh_stage all;
  open_meshes(&all);
  add_quad(&all, (vec3){0, 0, 0}, (vec3){9.9, 0, 0}, (vec3){0, 9.9, 0});
  stage_add_directional(&all.set, (vec3){0.6, 0, -0.8});
  all.set.scene.volume_count = 0;
  stage_render_sheets(&all.set, alone);
  const float *middle = alone + 4 * (SIDE / 2 * SIDE + SIDE / 2);
  assert_near((double)middle[0], 0.8, 1e-3);
  assert_near((double)middle[3], 1, 1e-6);
  assert_near((double)alone[3], 0, 0);
  all.set.scene.volume_count = 1; /* mesh_stage_close() releases the volume */
  mesh_stage_close(&all);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_coverage),
                                     cmocka_unit_test(test_no_seams),
                                     cmocka_unit_test(test_pane_in_haze),
                                     cmocka_unit_test(test_no_acne),
                                     cmocka_unit_test(test_no_acne_under_lamps),
                                     cmocka_unit_test(test_no_acne_at_slopes),
                                     cmocka_unit_test(test_cube_and_box),
                                     cmocka_unit_test(test_translucent_pane),
                                     cmocka_unit_test(test_penumbra),
                                     cmocka_unit_test(test_volume_and_mesh),
                                     cmocka_unit_test(test_threads_and_instruction_sets),
                                     cmocka_unit_test(test_kept_between_frames),
                                     cmocka_unit_test(test_against_the_reference),
                                     cmocka_unit_test(test_sphere_coverage),
                                     cmocka_unit_test(test_terminator),
                                     cmocka_unit_test(test_tube),
                                     cmocka_unit_test(test_colored_pane),
                                     cmocka_unit_test(test_no_volume)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
