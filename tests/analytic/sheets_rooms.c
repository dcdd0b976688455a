/* analytic/sheets_rooms.c - rooms of thin walls, seen from within, with the sun outside. A room is dark, also
 * at its corners, if no window lets the light in. */
#include <string.h>

#include "../asserts.h"
#include "mesh_stage.h"

enum { SIDE = 96, PIXELS = SIDE * SIDE };

/* The room is a cube of the half width HALF. The window is a rectangle of the room's ceiling. */
static const double HALF = 30, WINDOW_LOW[2] = {-9, -5}, WINDOW_HIGH[2] = {7, 12};

/* How the walls are made. CLOSED: the walls share their vertices, and their fronts are outwards. INWARDS: the
 * walls share their vertices, and their fronts are inwards. APART: each wall has vertices of its own. WINDOW:
 * the ceiling has a hole. */
typedef enum room { CLOSED, INWARDS, APART, WINDOW, ROOMS } room;

static const uint32_t BOX[12][3] = {{0, 2, 1}, {1, 2, 3}, {0, 1, 4}, {1, 5, 4}, {2, 6, 3}, {3, 6, 7},
                                    {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}, {4, 5, 6}, {5, 7, 6}};

/* The triangles of the ceiling around the window. Vertices 8 to 11 are the window's. */
static const uint32_t AROUND[8][3] = {{4, 5, 9},  {4, 9, 8},   {5, 7, 11}, {5, 11, 9},
                                      {7, 6, 10}, {7, 10, 11}, {6, 4, 8},  {6, 8, 10}};

static void set_corners(float positions[36][3]) {
  for (int i = 0; i < 8; i++)
    for (int axis = 0; axis < 3; axis++) positions[i][axis] = (float)(i >> axis & 1 ? HALF : -HALF);
  for (int i = 0; i < 4; i++) {
    positions[8 + i][0] = (float)(i & 1 ? WINDOW_HIGH[0] : WINDOW_LOW[0]);
    positions[8 + i][1] = (float)(i & 2 ? WINDOW_HIGH[1] : WINDOW_LOW[1]);
    positions[8 + i][2] = (float)HALF;
  }
}

static void add_room(mesh_stage *all, room kind) {
  static float positions[36][3], apart[36][3];
  static uint32_t triangles[18][3];
  hl_mesh_description d;
  hl_mesh_description_defaults(&d);
  set_corners(positions);
  memcpy(triangles, BOX, sizeof BOX);
  d.positions = (const float(*)[3])positions, d.vertex_count = 8;
  d.triangles = (const uint32_t(*)[3])triangles, d.triangle_count = 12;
  if (kind == WINDOW) {
    memcpy(triangles + 10, AROUND, sizeof AROUND);
    d.vertex_count = 12, d.triangle_count = 18;
  }
  for (uint32_t i = 0; i < 36 && kind == APART; i++) {
    memcpy(apart[i], positions[BOX[i / 3][i % 3]], sizeof *apart);
    triangles[i / 3][i % 3] = i;
    d.positions = (const float(*)[3])apart, d.vertex_count = 36;
  }
  for (int t = 0; t < 12 && kind == INWARDS; t++) triangles[t][1] = BOX[t][2], triangles[t][2] = BOX[t][1];
  mesh_stage_describe(all, &d)->smooth = false;
}

/* Returns the distance along a ray from within the room to the room's walls. *normal: the inward normal of
 * the wall. */
static double way_out(vec3 from, vec3 way, vec3 *normal) {
  const double o[3] = {from.x, from.y, from.z}, w[3] = {way.x, way.y, way.z};
  *normal = (vec3){0, 0, 0};
  double least = INFINITY;
  for (int axis = 0; axis < 3; axis++) {
    double far = ((w[axis] > 0 ? HALF : -HALF) - o[axis]) / w[axis], n[3] = {0, 0, 0};
    if (!(far < least)) continue;
    least = far;
    n[axis] = w[axis] > 0 ? -1 : 1;
    *normal = vec3_of(n);
  }
  return least;
}

/* Returns the light that the point at the end of an eye ray must have; -1: the light is not known. margin:
 * the width around the edge of the window's light in which the light is not known. */
static double expected(room kind, vec3 sun, double margin, vec3 eye, vec3 way) {
  vec3 normal, unused;
  vec3 at = vec3_add(eye, vec3_scale(way, way_out(eye, way, &normal)));
  double facing = vec3_dot(normal, sun);
  if (kind != WINDOW || facing <= 0) return 0;
  vec3 out = vec3_add(at, vec3_scale(sun, way_out(vec3_add(at, vec3_scale(normal, 1e-9)), sun, &unused)));
  if (out.z < HALF - 1e-6) return 0;
  const double place[2] = {out.x, out.y};
  double inside = INFINITY; /* the distance inwards from the window's edge */
  for (int axis = 0; axis < 2; axis++)
    inside = fmin(inside, fmin(place[axis] - WINDOW_LOW[axis], WINDOW_HIGH[axis] - place[axis]));
  return fabs(inside) < margin ? -1 : inside > 0 ? facing : 0;
}

/* Finds the least and the greatest expected light at the corners and the middle of a pixel. */
static void expect_in_pixel(const mesh_stage *all, room kind, vec3 sun, double margin, int i, double *least,
                            double *greatest) {
  vec3 eye, way, right, down;
  stage_eye_ray(&all->set, i % SIDE, i / SIDE, &eye, &way);
  stage_eye_ray(&all->set, i % SIDE + 1, i / SIDE, &eye, &right);
  stage_eye_ray(&all->set, i % SIDE, i / SIDE + 1, &eye, &down);
  *least = 1, *greatest = 0;
  for (int k = 0; k < 5; k++) {
    double u = k == 4 ? 0 : k % 2 - 0.5, v = k == 4 ? 0 : k / 2 - 0.5;
    vec3 beside = vec3_add(vec3_scale(vec3_subtract(right, way), u), vec3_scale(vec3_subtract(down, way), v));
    double here = expected(kind, sun, margin, eye, vec3_add(way, beside));
    *least = fmin(*least, here), *greatest = fmax(*greatest, here);
  }
}

/* Asserts that pixels are lit or dark as expected() says. Returns the number of lit pixels. */
static int check(const mesh_stage *all, room kind, vec3 sun, double margin, double tolerance,
                 const float *pixels) {
  int dark = 0, lit = 0;
  for (int i = 0; i < PIXELS; i++) {
    double least, greatest;
    expect_in_pixel(all, kind, sun, margin, i, &least, &greatest);
    if (least < 0) continue;
    assert_near((double)pixels[4 * i], (least + greatest) / 2, (greatest - least) / 2 + tolerance);
    dark += greatest <= 0;
    lit += least > 0;
  }
  assert_true(dark > PIXELS / 2);
  return lit;
}

/* Opens a scene of a room under a sun. shadows: a kind of mesh_stage_choose_shadows(). */
static void open_room(mesh_stage *all, room kind, vec3 sun, int shadows, int view) {
  static const vec3 eyes[] = {{-20, -24, 12}, {0, -25, 0}, {24, 22, 24}},
                    targets[] = {{30, 30, -22}, {0, 30, -15}, {-30, -22, -30}};
  mesh_stage_open(all, SIDE, 1);
  all->set.scene.camera.type = HL_CAMERA_PERSPECTIVE;
  all->set.scene.camera.fovy_deg = 75;
  add_room(all, kind);
  stage_look(&all->set, eyes[view], targets[view], (vec3){0, 0, 1});
  mesh_stage_choose_shadows(all, stage_add_directional(&all->set, vec3_scale(sun, -1)), shadows, 3);
}

/* Renders a room. Returns the number of lit pixels. */
static int render_room(room kind, vec3 sun, int shadows, int view, double tolerance) {
  static float pixels[PIXELS * 4];
  mesh_stage all;
  open_room(&all, kind, sun, shadows, view);
  stage_render_sheets(&all.set, pixels);
  int lit = check(&all, kind, sun, shadows == 0 ? 1.5 : 4, tolerance, pixels);
  mesh_stage_close(&all);
  return lit;
}

/* The greatest light and the sum of light in pixels that must be dark, and the number of these pixels. */
typedef struct leaks {
  double greatest, sum;
  int count;
} leaks;

static void add_leaks(mesh_stage *all, room kind, vec3 sun, leaks *found) {
  static float pixels[PIXELS * 4];
  stage_render_sheets(&all->set, pixels);
  for (int i = 0; i < PIXELS; i++) {
    double least, greatest, value = (double)pixels[4 * i];
    expect_in_pixel(all, kind, sun, 4, i, &least, &greatest);
    if (least < 0 || greatest > 0) continue;
    found->greatest = fmax(found->greatest, value);
    found->sum += value;
    found->count++;
  }
}

/* The direction to a sun. Every sun is at least 15 degrees above every wall, because grazing suns would light
 * single pixels where walls are not joined. */
static vec3 sun_of(int k) {
  static const vec3 ways[] = {{-1, -0.4, 0.6}, {-0.4, -1, 0.9}, {-0.3, 0.35, 1}, {0.35, 0.3, 0.8}};
  return vec3_normalise(ways[k]);
}

static void test_hard(void **state) {
  (void)state;
  for (int kind = 0; kind < ROOMS; kind++) {
    int lit = 0;
    for (int sun = 0; sun < 4; sun++)
      for (int view = 0; view < 3; view++) lit += render_room((room)kind, sun_of(sun), 0, view, 0.01);
    assert_true((lit > 1000) == (kind == WINDOW));
  }
}

/* Closed rooms are dark with soft shadows by each method. */
static void test_soft_closed(void **state) {
  (void)state;
  for (int kind = 0; kind < APART; kind++)
    for (int shadows = 1; shadows <= 3; shadows++)
      for (int k = 0; k < 3; k++) assert_int_equal(render_room((room)kind, sun_of(k), shadows, k, 1e-6), 0);
}

/* In rooms whose walls are not joined, little light enters where walls meet, with soft shadows by each
 * method. */
static void test_soft_open(void **state) {
  static const double GREATEST[] = {0.035, 0.025, 0.005};
  (void)state;
  for (int kind = APART; kind < ROOMS; kind++)
    for (int shadows = 1; shadows <= 3; shadows++) {
      leaks found = {0};
      for (int sun = 0; sun < 4; sun++)
        for (int view = 0; view < 3; view++) {
          mesh_stage all;
          open_room(&all, (room)kind, sun_of(sun), shadows, view);
          add_leaks(&all, (room)kind, sun_of(sun), &found);
          mesh_stage_close(&all);
        }
      assert_near(found.sum / found.count, 0, shadows == 1 ? 0.00013 : 0.000005);
      assert_near(found.greatest, 0, GREATEST[shadows - 1]);
    }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_hard), cmocka_unit_test(test_soft_closed),
                                     cmocka_unit_test(test_soft_open)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
