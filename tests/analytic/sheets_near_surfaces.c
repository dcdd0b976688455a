/* analytic/sheets_near_surfaces.c - haze close behind a pane gets only the light that the pane lets
 * through. */
#include "../asserts.h"
#include "mesh_stage.h"

enum { SIDE = 24, PIXELS = SIDE * SIDE };

/* A scene of a block of haze, 24 x 24 x 24, with a wide pane without colour in the haze and a light on the
 * far side, in a picture of the width 16. point: whether the light is a point. */
typedef struct pane_scene {
  double opacity, height, tilt, diameter;
  int kind; /* of shadows */
  bool point;
  bool unseen; /* the pane does not show in the picture */
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
  mesh->visible = !pane->unseen;
  for (int c = 0; c < 3; c++) mesh->color[c] = 0;
  mesh->material.specular = 0;
  hl_light *light = pane->point ? stage_add_point(&all.set, (vec3){3, -4, -60})
                                : stage_add_directional(&all.set, (vec3){0.1, 0.2, 1});
  mesh_stage_choose_shadows(&all, light, pane->kind, pane->diameter);
  stage_render_sheets(&all.set, pixels);
  mesh_stage_close(&all);
}

/* A pane of the opacity 1/2 across all of the haze halves the light that comes to the eye, wherever the pane
 * stands. Half of the light arrives at the haze before the pane, and the eye sees half of the light of the
 * haze behind the pane. Behind an opaque pane no light is left. */
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

/* Returns the light that haze between two heights sends to the eye above. The light comes from below, in a
 * direction with the z component `climb`. Derived: the eye sees the fraction e exp(-e (12 - z)) of the height
 * z, and the light there is exp(-e (z + 12) / climb). */
static double light_of_haze(double from, double to, double climb) {
  const double e = -log(0.9), rate = e * (1 - 1 / climb), way = exp(-12 * e * (1 + 1 / climb));
  return e * way * (fabs(rate) < 1e-12 ? to - from : (exp(rate * to) - exp(rate * from)) / rate);
}

/* A pane that the eye does not see lets a fraction of the light through. The haze behind the pane gets this
 * fraction, up to the pane itself. At the picture's lower edge, some light enters through the haze's side. */
static void test_unseen_pane(void **state) {
  (void)state;
  static float open[4 * PIXELS], pixels[4 * PIXELS];
  const double climb = 1 / sqrt(1 + 0.1 * 0.1 + 0.2 * 0.2), all = light_of_haze(-12, 12, climb);
  for (int k = 0; k < 16; k++) {
    pane_scene pane = {
        .height = -3 + 0.23 * k, .tilt = k % 3 * 0.15, .diameter = 1, .kind = k % 4, .unseen = true};
    double worst = 0, sum = 0;
    render_pane(&pane, open);
    pane.opacity = k / 4 % 2 ? 0.5 : 1;
    render_pane(&pane, pixels);
    for (int i = 0; i < PIXELS; i++) {
      double height = pane.height - pane.tilt * (i / SIDE + 0.5 - SIDE / 2) * 16 / SIDE;
      double taken = pane.opacity * light_of_haze(height, 12, climb) / all;
      double wrong = (double)pixels[4 * i] / (double)open[4 * i] - (1 - taken);
      worst = fmax(worst, fabs(wrong));
      sum += wrong;
    }
    assert_near(sum / PIXELS, 0, 0.004);
    assert_near(worst, 0, 0.012);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_pane_in_haze), cmocka_unit_test(test_unseen_pane)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
