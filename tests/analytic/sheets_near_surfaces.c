/* analytic/sheets_near_surfaces.c - haze right behind a pane gets no more light than the pane lets through.
 */
#include "../asserts.h"
#include "mesh_stage.h"

enum { SIDE = 24, PIXELS = SIDE * SIDE };

/* A block of haze 24 x 24 x 24 whose picture is 16 wide, with a light from beyond it, and in it a wide pane
 * without colour. point: the light is a point. */
typedef struct pane_scene {
  double opacity, height, tilt, diameter;
  int kind; /* of shadows */
  bool point;
} pane_scene;

static void render_pane(const pane_scene *pane, float *pixels) {
  mesh_stage all;
  mesh_stage_open(&all, SIDE, 16);
  hl_scene_volume *haze = stage_add_grid(&all.set, (size_t[3]){24, 24, 24}, (double[3]){1, 1, 1},
                                         (vec3){-12, -12, -12}, NULL);
  stage_set_opacity(&all.set, haze, 0.1, 1);
  haze->shading = HL_SHADING_NONE;
  hl_scene_mesh *mesh = mesh_stage_add(&all,
                                       stage_make_quad(&all.set, (vec3){0, 0, pane->height}, (vec3){40, 0, 0},
                                                       (vec3){0, 40, 40 * pane->tilt}));
  mesh->opacity = pane->opacity;
  for (int c = 0; c < 3; c++) mesh->color[c] = 0;
  mesh->material.specular = 0;
  hl_light *light = pane->point ? stage_add_point(&all.set, (vec3){3, -4, -60})
                                : stage_add_directional(&all.set, (vec3){0.1, 0.2, 1});
  mesh_stage_choose_shadows(&all, light, pane->kind, pane->diameter);
  stage_render_sheets(&all.set, pixels);
  mesh_stage_close(&all);
}

/* A pane across all of the haze halves what comes to the eye, wherever it stands: before it half of the light
 * arrives, and of what is behind it the eye sees half. An opaque one leaves nothing. */
static void test_pane_in_haze(void **state) {
  (void)state;
  static float open[4 * PIXELS], pixels[4 * PIXELS];
  for (int k = 0; k < 12; k++) {
    pane_scene pane = {.opacity = 0,
                       .height = -1 + 0.23 * k,
                       .tilt = k % 3 * 0.3,
                       .diameter = 3,
                       .kind = k % 4,
                       .point = k == 4};
    render_pane(&pane, open);
    for (int half = 0; half < 2; half++) {
      pane.opacity = half ? 0.5 : 1;
      render_pane(&pane, pixels);
      double worst = 0, sum = 0;
      for (int i = 0; i < PIXELS; i++) {
        double wrong = (double)pixels[4 * i] / (double)open[4 * i] - (1 - pane.opacity);
        worst = fmax(worst, fabs(wrong));
        sum += wrong;
      }
      assert_near(worst, 0, half ? 0.02 : 0.006);
      assert_near(sum / PIXELS, 0, 0.006);
    }
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_pane_in_haze)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
