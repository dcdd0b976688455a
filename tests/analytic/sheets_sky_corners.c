/* analytic/sheets_sky_corners.c - the light of a sky in the corner of a cubic block from which a box is cut,
 * against closed forms. */
#include "../asserts.h"
#include "reference_stage.h"

enum { GRID = 48, SIDE = 96 };

/* Returns the fraction of a half sky's light that an upright rectangle hides from a point (the form factor of
 * a rectangle whose lower side lies in the point's plane). out: the point's distance from the rectangle's
 * plane. before, after: the lengths of the rectangle to both sides of the point. height: of the rectangle.
 * (Howell, A Catalog of Radiation Heat Transfer Configuration Factors, B-3.) */
static double hidden_by_wall(double out, double before, double after, double height) {
  const double far = sqrt(out * out + height * height);
  return (atan(before / out) - out / far * atan(before / far) + atan(after / out) -
          out / far * atan(after / far)) /
         (2 * HL_PI);
}

/* Returns the light at a point of one of the corner's three square faces. x, y: the point's distances from
 * the two other faces. */
static double light_of_face(double side, double x, double y) {
  return 1 - hidden_by_wall(x, y, side - y, side) - hidden_by_wall(y, x, side - x, side);
}

/* Finds the face of the corner that a ray meets, and the light at the met point. corner: each coordinate of
 * the cut box's corner. Returns whether the met point lies near the edge between two faces, but not where
 * three faces meet. */
static bool light_near_edge(vec3 origin, vec3 way, double corner, double side, double *light) {
  const double from[3] = {origin.x, origin.y, origin.z}, by[3] = {way.x, way.y, way.z};
  double at[3], nearest = INFINITY;
  int face = 0;
  for (int a = 0; a < 3; a++) { /* matter lies behind the face that the ray meets last */
    const double t = (corner - from[a]) / by[a];
    if (a == 0 || t < nearest) nearest = t, face = a;
  }
  for (int a = 0; a < 3; a++) at[a] = from[a] + nearest * by[a] - corner;
  const double x = at[(face + 1) % 3], y = at[(face + 2) % 3], least = fmin(x, y), most = fmax(x, y);
  if (least < 0.1 || least > 3 || most < 4 || most > side - 6) return false;
  *light = light_of_face(side, x, y);
  return true;
}

/* Renders the corner. The cut box's corner lies at a place between the cells of the sky's field. Returns the
 * greatest error near the corner's edges. */
static double greatest_error(double corner) {
  static float pixels[SIDE * SIDE * 4];
  const double half = GRID / 2.0, side = half - corner;
  const hl_cut box = {.type = HL_CUT_BOX, .min = {corner, corner, corner}, .max = {GRID, GRID, GRID}};
  stage set;
  stage_open(&set);
  set.scene.width = set.scene.height = SIDE;
  set.scene.camera.height = 24;
  set.scene.render.sheet_spacing = 0.5;
  set.scene.sky.type = HL_SKY_UNIFORM;
  hl_scene_volume *block = stage_add_grid(&set, (size_t[3]){GRID, GRID, GRID}, (double[3]){1, 1, 1},
                                          (vec3){-half, -half, -half}, NULL);
  stage_set_opacity(&set, block, 0.999, 1);
  block->shading = HL_SHADING_PHONG;
  block->material = (hl_material){.diffuse = 1};
  block->cuts = &box;
  block->cut_count = 1;
  stage_look(&set, (vec3){corner + 90, corner + 80, corner + 70}, (vec3){corner, corner, corner},
             (vec3){0, 0, 1});
  stage_render_sheets(&set, pixels);
  double greatest = 0;
  int count = 0;
  for (int p = 0; p < SIDE * SIDE; p++) {
    vec3 origin, way;
    double light;
    stage_eye_ray(&set, p % SIDE, p / SIDE, &origin, &way);
    if (!light_near_edge(origin, way, corner, side, &light)) continue;
    greatest = fmax(greatest, fabs((double)pixels[4 * p] - light));
    count++;
  }
  stage_close(&set);
  assert_true(count > 100);
  return greatest;
}

/* Beside an edge between two faces, the light has the closed form's brightness, wherever the faces lie
 * between the cells of the sky's field. */
static void test_corner_of_a_cut(void **state) {
  (void)state;
  for (int i = 0; i < 5; i++) {
    const double corner = 0.2 * i, error = greatest_error(corner);
    print_message("# corner at %.1f: greatest error %.4f\n", corner, error);
    assert_true(error < 0.05);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_corner_of_a_cut)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
