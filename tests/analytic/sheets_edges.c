/* analytic/sheets_edges.c - a long box without normals has creases, although its short faces are a small part
 * of the area at its corners. So the box's faces are evenly lit. */
#include "../asserts.h"
#include "mesh_stage.h"

enum { SIDE = 64, PIXELS = SIDE * SIDE };

static void test_long_box(void **state) {
  (void)state;
  static const float positions[8][3] = {{-30, -3, -2}, {30, -3, -2}, {-30, 3, -2}, {30, 3, -2},
                                        {-30, -3, 2},  {30, -3, 2},  {-30, 3, 2},  {30, 3, 2}};
  static const uint32_t triangles[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                                            {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  static float pixels[PIXELS * 4];
  for (int k = 0; k < 4; k++) {
    mesh_stage all;
    mesh_stage_open(&all, SIDE, 12);
    hl_mesh_description d;
    hl_mesh_description_defaults(&d);
    d.positions = positions, d.vertex_count = 8;
    d.triangles = triangles, d.triangle_count = 12;
    hl_scene_mesh *box = mesh_stage_describe(&all, &d);
    box->rotate_axis[0] = 1; /* the box's edge along x is turned to the eye */
    box->rotate_axis[2] = 0;
    box->rotate_angle_deg = 40;
    double turn = 40 * HL_PI / 180;
    vec3 upper = {0, cos(turn), sin(turn)}, lower = {0, -sin(turn), cos(turn)},
         towards = vec3_normalise((vec3){0.3, k < 2 ? 0.4 : -0.3, 1});
    stage_add_directional(&all.set, vec3_scale(towards, -1));
    stage_render_by(&all.set, k % 2, pixels);
    /* the y of the edge between the two faces that the eye sees */
    double edge = 3 * cos(turn) - 2 * sin(turn);
    int counted[2] = {0, 0};
    for (int i = 0; i < PIXELS; i++) {
      double y = 6 - (i / SIDE + 0.5) * 12 / SIDE;
      if (pixels[4 * i + 3] < 1 || fabs(y - edge) < 0.3) continue;
      assert_near((double)pixels[4 * i], vec3_dot(towards, y > edge ? upper : lower), 1e-4);
      counted[y > edge]++;
    }
    assert_true(counted[0] > 5 * SIDE && counted[1] > 5 * SIDE);
    mesh_stage_close(&all);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_long_box)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
