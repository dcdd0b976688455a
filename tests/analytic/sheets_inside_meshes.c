/* analytic/sheets_inside_meshes.c - the insides of closed meshes are evenly lit, by a light within and by
 * light that enters through a translucent mesh. */
#include "../asserts.h"
#include "mesh_stage.h"

enum { SIDE = 96, PIXELS = SIDE * SIDE };

/* Adds a closed box around the origin, with the fronts of its triangles outwards. */
static hl_scene_mesh *add_box(mesh_stage *all, vec3 half) {
  static const uint32_t triangles[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                                            {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  float positions[8][3];
  for (int i = 0; i < 8; i++) {
    positions[i][0] = (float)(i & 1 ? half.x : -half.x);
    positions[i][1] = (float)(i & 2 ? half.y : -half.y);
    positions[i][2] = (float)(i & 4 ? half.z : -half.z);
  }
  hl_mesh_description d;
  hl_mesh_description_defaults(&d);
  d.positions = positions, d.vertex_count = 8;
  d.triangles = triangles, d.triangle_count = 12;
  hl_scene_mesh *mesh = mesh_stage_describe(all, &d);
  mesh->smooth = 0;
  return mesh;
}

static hl_scene_mesh *add_sphere(mesh_stage *all, double radius) {
  const float sphere[1][4] = {{0, 0, 0, (float)radius}};
  hl_mesh_description d;
  hl_mesh_description_defaults(&d);
  d.spheres = sphere, d.sphere_count = 1;
  return mesh_stage_describe(all, &d);
}

/* Returns the inward normal at the point where a ray from within a box meets the box. *second: how much
 * farther the ray goes to the plane of the next wall. */
static vec3 leave_box(vec3 half, vec3 from, vec3 way, vec3 *at, double *second) {
  const double h[3] = {half.x, half.y, half.z}, o[3] = {from.x, from.y, from.z}, d[3] = {way.x, way.y, way.z};
  double nearest = INFINITY;
  double normal[3] = {0, 0, 0};
  *second = INFINITY;
  for (int axis = 0; axis < 3; axis++) {
    double s = (copysign(h[axis], d[axis]) - o[axis]) / d[axis];
    *second = fmin(*second, fmax(s, nearest));
    if (s >= nearest) continue;
    nearest = s;
    for (int i = 0; i < 3; i++) normal[i] = i == axis ? -copysign(1, d[i]) : 0;
  }
  *second -= nearest;
  *at = vec3_add(from, vec3_scale(way, nearest));
  return (vec3){normal[0], normal[1], normal[2]};
}

static void look_from_within(mesh_stage *all, vec3 eye, vec3 target) {
  all->set.scene.camera.type = HL_CAMERA_PERSPECTIVE;
  all->set.scene.camera.fovy_deg = 70;
  stage_look(&all->set, eye, target, (vec3){0, 0, 1});
}

/* Adds a lamp, a point or a ball, with shadows of a kind of mesh_stage_choose_shadows(). */
static void add_lamp(mesh_stage *all, vec3 at, int kind) {
  hl_light *light = stage_add_point(&all->set, at);
  mesh_stage_choose_shadows(all, light, kind, 0);
  light->radius = kind == 0 ? 0 : 1;
}

/* The walls of a closed room with a lamp in it are as bright as the cosine of the lamp's light. The same
 * holds for a room with one open side. The walls do not shade themselves. */
static void test_lamp_in_room(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  const vec3 half = {20, 24, 16}, lamp = {4, -6, 9}, eye = {8, -18, 2};
  for (int kind = 0; kind < 4; kind++) {
    mesh_stage all;
    mesh_stage_open(&all, SIDE, 1);
    (void)add_box(&all, half);
    add_lamp(&all, lamp, kind);
    look_from_within(&all, eye, (vec3){0, 0, -3});
    stage_render_sheets(&all.set, pixels);
    int counted = 0;
    for (int i = 0; i < PIXELS; i++) {
      vec3 from, way, at;
      double second;
      stage_eye_ray(&all.set, i % SIDE, i / SIDE, &from, &way);
      vec3 normal = leave_box(half, from, way, &at, &second);
      if (second < 2) continue; /* the pixel shows an edge, where two walls share it */
      assert_near((double)pixels[4 * i], vec3_dot(normal, vec3_normalise(vec3_subtract(lamp, at))), 0.02);
      counted++;
    }
    assert_true(counted > PIXELS / 2);
    mesh_stage_close(&all);
  }
}

/* The inside of a ball around a lamp faces the lamp everywhere. */
static void test_lamp_in_ball(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  for (int kind = 0; kind < 4; kind++) {
    mesh_stage all;
    mesh_stage_open(&all, SIDE, 1);
    (void)add_sphere(&all, 20);
    add_lamp(&all, (vec3){0, 0, 0}, kind);
    look_from_within(&all, (vec3){2, -12, 1}, (vec3){0, 0, -3});
    stage_render_sheets(&all.set, pixels);
    for (int i = 0; i < PIXELS; i++) assert_near((double)pixels[4 * i], 1, 0.01);
    mesh_stage_close(&all);
  }
}

/* A box has the opacity 1/2, so that half of the light enters through whichever wall. The floor is seen
 * through the ceiling, which halves the light again, and the floor's own opacity and the cosine multiply the
 * light. Soft light deviates a little where the ceiling meets the walls. */
static void test_glass_box(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  for (int kind = 0; kind < 4; kind++) {
    mesh_stage all;
    mesh_stage_open(&all, SIDE, 20);
    add_box(&all, (vec3){12, 12, 8})->opacity = 0.5;
    vec3 travels = vec3_normalise((vec3){0.3, 0.4, -1});
    mesh_stage_choose_shadows(&all, stage_add_directional(&all.set, travels), kind, 2);
    stage_render_sheets(&all.set, pixels);
    for (int i = 0; i < PIXELS; i++)
      assert_near((double)pixels[4 * i], -travels.z * (0.5 + 0.5 * 0.5 * 0.5), kind == 0 ? 1e-4 : 0.02);
    mesh_stage_close(&all);
  }
}

/* Returns the number of tiles of a lamp's buffers in which work is done. A board hides everything else from
 * the eye. second: whether another board stands behind the first board. */
static uint64_t tiles_between_boards(bool second, float *pixels) {
  mesh_stage all;
  mesh_stage_open(&all, SIDE, 48);
  const size_t volumes = all.set.scene.volume_count;
  const vec3 across = {30, 0, 0}, along = {0, 30, 0};
  mesh_stage_add(&all, stage_make_quad(&all.set, (vec3){0, 0, 10}, across, along));
  if (second) mesh_stage_add(&all, stage_make_quad(&all.set, (vec3){0, 0, -10}, across, along));
  all.set.scene.volume_count = 0;
  stage_look(&all.set, (vec3){20, 0, 100}, (vec3){20, 0, 0}, (vec3){0, 1, 0});
  hl_light *lamp = stage_add_point(&all.set, (vec3){0, 0, 9});
  lamp->shadows = HL_SHADOWS_HARD;
  hl_render_statistics of = stage_render_counted(&all.set, pixels);
  all.set.scene.volume_count = volumes;
  mesh_stage_close(&all);
  return of.tiles_filled_light;
}

/* Matter that the eye does not see costs little work for a lamp's hard shadows. Work on all of the second
 * board would be twice as much. */
static void test_hidden_from_eye(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  uint64_t alone = tiles_between_boards(false, pixels), both = tiles_between_boards(true, pixels);
  assert_true(alone > 0 && both < alone + alone / 2);
}

/* A lamp stands within the content. The cascade has no chunks that are shorter than a pixel. If the length of
 * every chunk were a fixed fraction of the lamp's width in the buffer, threads would wait twice as often. */
static void test_few_chunks(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  mesh_stage all;
  mesh_stage_open(&all, SIDE, 48);
  const size_t volumes = all.set.scene.volume_count;
  mesh_stage_add(&all, stage_make_quad(&all.set, (vec3){0, 0, 5}, (vec3){3, 0, 0}, (vec3){0, 3, 0}));
  mesh_stage_add(&all, stage_make_quad(&all.set, (vec3){0, 0, -60}, (vec3){60, 0, 0}, (vec3){0, 60, 0}));
  all.set.scene.volume_count = 0;
  stage_look(&all.set, (vec3){20, 0, 100}, (vec3){20, 0, 0}, (vec3){0, 1, 0});
  hl_light *lamp = stage_add_point(&all.set, (vec3){0, 0, 4});
  lamp->shadows = HL_SHADOWS_SOFT;
  lamp->radius = 0.5;
  all.set.scene.render.soft_method = HL_SOFT_CASCADE;
  hl_render_statistics of = stage_render_counted(&all.set, pixels);
  assert_true(of.waits > 0 && 2 * of.waits < 3 * (uint64_t)of.sheets);
  all.set.scene.volume_count = volumes;
  mesh_stage_close(&all);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_hidden_from_eye),
                                     cmocka_unit_test(test_few_chunks), cmocka_unit_test(test_lamp_in_room),
                                     cmocka_unit_test(test_lamp_in_ball), cmocka_unit_test(test_glass_box)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
