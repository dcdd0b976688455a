/* analytic/sheets_contact.c - walls that stand on a floor. Behind a wall the floor is dark from the wall's
 * foot on. Before the wall the floor is lit up to the foot. The eye looks from above and from either side. */
#include <string.h>

#include "../asserts.h"
#include "mesh_stage.h"

enum { SIDE = 128, PIXELS = SIDE * SIDE };

/* The wall stands at y = PLACE, which is not at the edge of a pixel. BAND: the greatest distance from the
 * wall at which the floor is looked at. */
static const double HALF_WIDTH = 12, TOP = 16, PLACE = 0.1, THIN = 0.15, BAND = 3, FLOOR_EDGE = 40;

typedef enum wall { SHEET, BOX_WITHOUT_BOTTOM, CUT_BOX, THROUGH_THE_FLOOR, JOINED, WALLS } wall;

static bool is_box(wall kind) { return kind == BOX_WITHOUT_BOTTOM || kind == CUT_BOX; }

/* A light of the test: a sun or a lamp. */
typedef struct shining {
  vec3 at; /* a sun's direction or a lamp's place */
  bool parallel;
} shining;

static vec3 way_to(const shining *light, vec3 from) {
  return light->parallel ? light->at : vec3_subtract(light->at, from);
}

/* Adds a quad's triangles to a mesh of up to 24 vertices. */
static void add_quad(float positions[24][3], uint32_t triangles[12][3], int quad, vec3 centre, vec3 u,
                     vec3 v) {
  for (int i = 0; i < 4; i++) {
    double a = i == 1 || i == 2 ? 1 : -1, b = i >= 2 ? 1 : -1;
    vec3_store(positions[4 * quad + i], vec3_add(centre, vec3_add(vec3_scale(u, a), vec3_scale(v, b))));
  }
  uint32_t first = 4 * (uint32_t)quad;
  memcpy(triangles[2 * quad], (uint32_t[3]){first, first + 1, first + 2}, sizeof *triangles);
  memcpy(triangles[2 * quad + 1], (uint32_t[3]){first, first + 2, first + 3}, sizeof *triangles);
}

/* A closed box that reaches below the floor, where a cut of the scene removes it. */
static void add_cut_box(mesh_stage *all) {
  static const uint32_t triangles[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                                            {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  static const hl_cut below = {.type = HL_CUT_PLANE, .normal = {0, 0, -1}};
  float positions[8][3];
  for (int i = 0; i < 8; i++)
    vec3_store(positions[i],
               (vec3){i & 1 ? HALF_WIDTH : -HALF_WIDTH, PLACE + (i & 2 ? THIN : -THIN), i & 4 ? TOP : -TOP});
  hl_mesh_description d;
  hl_mesh_description_defaults(&d);
  d.positions = (const float(*)[3])positions, d.vertex_count = 8;
  d.triangles = triangles, d.triangle_count = 12;
  (void)mesh_stage_describe(all, &d);
  all->meshes[0].cut = 0; /* the floor */
  all->set.scene.cuts = &below;
  all->set.scene.cut_count = 1;
}

static void add_wall(mesh_stage *all, wall kind) {
  static float positions[24][3];
  static uint32_t triangles[12][3];
  const vec3 up = {0, 0, TOP / 2}, along = {HALF_WIDTH, 0, 0}, across = {0, THIN, 0};
  int quads = 1;
  if (kind == BOX_WITHOUT_BOTTOM) {
    quads = 5;
    for (int side = 0; side < 2; side++) {
      double sign = side ? 1 : -1;
      add_quad(positions, triangles, side, (vec3){0, PLACE + sign * THIN, TOP / 2}, vec3_scale(along, -sign),
               up);
      add_quad(positions, triangles, 2 + side, (vec3){sign * HALF_WIDTH, PLACE, TOP / 2},
               vec3_scale(across, sign), up);
    }
    add_quad(positions, triangles, 4, (vec3){0, PLACE, TOP}, along, across);
  } else {
    double foot = kind == THROUGH_THE_FLOOR ? -4 : 0;
    add_quad(positions, triangles, 0, (vec3){0, PLACE, (TOP + foot) / 2}, along,
             (vec3){0, 0, (TOP - foot) / 2});
  }
  if (kind == JOINED) {
    /* a strip of the floor before the wall, which begins at the wall's two lower vertices */
    quads = 2;
    add_quad(positions, triangles, 1, (vec3){0, PLACE - 4, 0.01}, along, (vec3){0, 4, 0});
    for (int i = 2; i < 4; i++)
      for (int k = 0; k < 3; k++)
        triangles[i][k] = triangles[i][k] == 6 ? 1 : triangles[i][k] == 7 ? 0 : triangles[i][k];
  }
  hl_mesh_description d;
  hl_mesh_description_defaults(&d);
  d.positions = (const float(*)[3])positions, d.vertex_count = 4 * (size_t)quads;
  d.triangles = (const uint32_t(*)[3])triangles, d.triangle_count = 2 * (size_t)quads;
  mesh_stage_describe(all, &d)->smooth = kind != JOINED;
}

/* Returns the light that the point at the end of an eye ray must have; -1: the light there is not known. */
static double expected(const shining *light, wall kind, double margin, vec3 eye, vec3 way) {
  /* side: -1 or 1, the side of the wall that the eye sees */
  const double thick = is_box(kind) ? THIN : 0, side = way.y > 0 ? -1 : 1;
  double to_wall = (PLACE + side * thick - eye.y) / way.y, to_floor = -eye.z / way.z;
  vec3 met = vec3_add(eye, vec3_scale(way, to_wall)), at = vec3_add(eye, vec3_scale(way, to_floor));
  bool near_wall = fabs(met.x) < HALF_WIDTH + 1 && met.z > 0 && met.z < TOP + 1;
  if (to_wall < to_floor && near_wall) {
    if (fabs(met.x) > HALF_WIDTH - 0.5 || met.z > TOP - 0.5) return -1;
    return fmax(side * vec3_normalise(way_to(light, met)).y, 0);
  }
  double beyond = fabs(at.y - PLACE) - thick;
  if (beyond < 0 || beyond > BAND || fabs(at.x) > HALF_WIDTH + 8) return -1;
  vec3 to = way_to(light, at);
  double along = (PLACE - at.y) / to.y;
  vec3 passed = vec3_add(at, vec3_scale(to, along));
  if (along > 0 && fabs(passed.x) < HALF_WIDTH - margin && passed.z < TOP - margin) return 0;
  if (along > 0 && fabs(passed.x) < HALF_WIDTH + margin) return -1;
  return vec3_normalise(to).z;
}

/* Asserts that a pixel is lit or dark, if its light is known at its middle and its four corners. If a wall
 * goes through the floor, the wall's two triangles and the floor cross in one pixel. Samples of such a pixel
 * may go to the wrong triangle, so that these pixels are left out. */
static void check(const stage *set, const shining *light, wall kind, double margin, const float *pixels) {
  int dark = 0, lit = 0, crossed = 0;
  for (int i = 0; i < PIXELS; i++) {
    vec3 eye, way, right, down, unused;
    stage_eye_ray(set, i % SIDE, i / SIDE, &eye, &way);
    stage_eye_ray(set, i % SIDE + 1, i / SIDE, &right, &unused);
    stage_eye_ray(set, i % SIDE, i / SIDE + 1, &down, &unused);
    double least = 1, greatest = 0;
    for (int k = 0; k < 5; k++) {
      double u = k == 4 ? 0 : k % 2 - 0.5, v = k == 4 ? 0 : k / 2 - 0.5;
      vec3 from = vec3_add(
          eye, vec3_add(vec3_scale(vec3_subtract(right, eye), u), vec3_scale(vec3_subtract(down, eye), v)));
      double light_here = expected(light, kind, margin, from, way);
      least = fmin(least, light_here), greatest = fmax(greatest, light_here);
    }
    if (least < 0 || (least == 0) != (greatest == 0)) continue;
    double value = (double)pixels[4 * i];
    if (kind == THROUGH_THE_FLOOR && !(value >= least - 0.02 && value <= greatest + 0.02) && ++crossed == 1)
      continue;
    assert_near(value, (least + greatest) / 2, (greatest - least) / 2 + 0.02);
    dark += greatest == 0;
    lit += greatest > 0;
  }
  assert_true(dark + lit > 1000);
}

static void render_wall(wall kind, const shining *light, int shadows, vec3 eye, double margin) {
  static float pixels[PIXELS * 4];
  mesh_stage all;
  mesh_stage_open(&all, SIDE, 48);
  mesh_stage_add(
      &all, stage_make_quad(&all.set, (vec3){0, 0, 0}, (vec3){FLOOR_EDGE, 0, 0}, (vec3){0, FLOOR_EDGE, 0}));
  if (kind == CUT_BOX) add_cut_box(&all);
  else add_wall(&all, kind);
  stage_look(&all.set, eye, (vec3){0, 0, 0}, eye.y == 0 ? (vec3){0, 1, 0} : (vec3){0, 0, 1});
  hl_light *made = light->parallel ? stage_add_directional(&all.set, vec3_scale(light->at, -1))
                                   : stage_add_point(&all.set, light->at);
  mesh_stage_choose_shadows(&all, made, shadows, 3);
  stage_render_sheets(&all.set, pixels);
  check(&all.set, light, kind, margin, pixels);
  mesh_stage_close(&all);
}

static const vec3 EYES[] = {{0, 0, 100}, {30, -60, 40}, {-20, 60, 30}};

static vec3 direction(double elevation_deg, double azimuth_deg) {
  double e = elevation_deg * HL_PI / 180, a = azimuth_deg * HL_PI / 180;
  return (vec3){sin(a) * cos(e), cos(a) * cos(e), sin(e)};
}

/* Walls of every kind cast hard shadows under suns that stand behind the wall and beside it. */
static void test_hard(void **state) {
  (void)state;
  for (int kind = 0; kind < WALLS; kind++)
    for (int k = 0; k < 6; k++) {
      const shining sun = {direction(20 + 20 * (k % 3), k / 3 * 60), true};
      for (int eye = 0; eye < 3; eye++) render_wall((wall)kind, &sun, 0, EYES[eye], 1.5);
    }
}

/* Walls cast hard shadows under a near lamp. */
static void test_near_light(void **state) {
  (void)state;
  for (int k = 0; k < 4; k++) {
    const shining lamp = {vec3_scale(direction(25 + 30 * (k % 2), k / 2 * 45), 50), false};
    for (int eye = 0; eye < 3; eye++) render_wall(SHEET, &lamp, 0, EYES[eye], 1.5);
  }
}

/* Walls cast soft shadows, by each method. */
static void test_soft(void **state) {
  (void)state;
  for (int shadows = 1; shadows <= 3; shadows++)
    for (int k = 0; k < 4; k++) {
      const shining sun = {direction(25 + 30 * (k % 2), k / 2 * 50), true};
      render_wall(k % 2 ? BOX_WITHOUT_BOTTOM : SHEET, &sun, shadows, EYES[k % 3], 2.5);
      render_wall(CUT_BOX, &sun, shadows, EYES[k % 3], 2.5);
    }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_hard), cmocka_unit_test(test_near_light),
                                     cmocka_unit_test(test_soft)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
