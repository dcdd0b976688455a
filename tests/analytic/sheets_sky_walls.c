/* analytic/sheets_sky_walls.c - the light of a sky within thin walls, at any angle to the lattice of the
 * light's cells, against closed forms. */
#include "../asserts.h"
#include "mesh_stage.h"

enum { SIDE = 32, PIXELS = SIDE * SIDE };

/* A box with walls of no thickness that stands on z = 0, turned around the z axis. The last two triangles of
 * its mesh are the lid. */
typedef struct walled_box {
  double half, height, angle;
} walled_box;

static vec3 turned(const walled_box *box, double x, double y, double z) {
  const double c = cos(box->angle), s = sin(box->angle);
  return (vec3){c * x - s * y, s * x + c * y, z};
}

static void add_walls(mesh_stage *all, const walled_box *box, bool lid) {
  static const uint32_t triangles[12][3] = {{0, 2, 1}, {1, 2, 3}, {0, 1, 4}, {1, 5, 4}, {2, 6, 3}, {3, 6, 7},
                                            {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}, {4, 5, 6}, {5, 7, 6}};
  float positions[8][3];
  hl_mesh_description d;
  hl_mesh_description_defaults(&d);
  for (int i = 0; i < 8; i++)
    vec3_store(positions[i], turned(box, i & 1 ? box->half : -box->half, i & 2 ? box->half : -box->half,
                                    i & 4 ? box->height : 0));
  d.positions = positions, d.vertex_count = 8;
  d.triangles = triangles, d.triangle_count = lid ? 12 : 10;
  mesh_stage_describe(all, &d)->smooth = 0;
}

static void open_under_sky(mesh_stage *all, double height) {
  mesh_stage_open(all, SIDE, height);
  all->set.scene.sky.type = HL_SKY_UNIFORM;
}

/* Returns the fraction of a half sky's light that comes through a horizontal rectangle to a point below one
 * of the rectangle's corners (the form factor of a corner). x, y: the rectangle's sides divided by its
 * height, of either sign. */
static double light_of_corner(double x, double y) {
  const double a = sqrt(1 + x * x), b = sqrt(1 + y * y);
  return (x / a * atan(y / a) + y / b * atan(x / b)) / (2 * HL_PI);
}

/* Returns the light of the sky that reaches a point of a black cup's floor through the cup's opening. */
static double light_in_cup(const walled_box *cup, double x, double y) {
  double light = 0;
  for (int corner = 0; corner < 4; corner++)
    light += light_of_corner((cup->half + (corner & 1 ? x : -x)) / cup->height,
                             (cup->half + (corner & 2 ? y : -y)) / cup->height);
  return light;
}

/* The thin walls of a cup that is turned against the axes let no light through. (Walls parallel to the axes
 * are not tested: the sky's few directions then make errors twice as large.) */
static void test_cups(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  static const double angles[] = {0.3, HL_PI / 4, 1.1};
  for (size_t k = 0; k < sizeof angles / sizeof *angles; k++) {
    const walled_box cup = {40, 80, angles[k]};
    mesh_stage all;
    open_under_sky(&all, 72 / (fabs(cos(cup.angle)) + fabs(sin(cup.angle))));
    add_walls(&all, &cup, false);
    stage_render_sheets(&all.set, pixels);
    double squares = 0, mean = 0;
    for (int i = 0; i < PIXELS; i++) {
      const double pixel = all.set.scene.camera.height / SIDE, u = (i % SIDE + 0.5 - SIDE / 2) * pixel,
                   v = (SIDE / 2 - i / SIDE - 0.5) * pixel;
      const vec3 at = turned(&(walled_box){.angle = -cup.angle}, u, v, 0);
      const double wrong = (double)pixels[4 * i] - light_in_cup(&cup, at.x, at.y);
      squares += wrong * wrong / PIXELS;
      mean += wrong / PIXELS;
    }
    assert_near(mean, 0, 0.012);
    assert_near(sqrt(squares), 0, 0.015);
    mesh_stage_close(&all);
  }
}

/* The inside of a closed box is dark, also at its edges and corners. */
static void test_closed_boxes(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  for (int turn = 0; turn < 3; turn++) {
    const walled_box box = {40, 64, 0.4 * turn};
    mesh_stage all;
    open_under_sky(&all, 24);
    add_walls(&all, &box, true);
    all.set.scene.camera.type = HL_CAMERA_PERSPECTIVE;
    all.set.scene.camera.fovy_deg = 90;
    stage_look(&all.set, turned(&box, -28, -24, 24), turned(&box, 28, 24, 28), (vec3){0, 0, 1});
    stage_render_sheets(&all.set, pixels);
    for (int i = 0; i < PIXELS; i++) {
      assert_near((double)pixels[4 * i + 3], 1, 1e-3);
      assert_near((double)pixels[4 * i], 0, 0.03);
    }
    mesh_stage_close(&all);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_cups), cmocka_unit_test(test_closed_boxes)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
