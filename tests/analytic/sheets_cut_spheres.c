/* analytic/sheets_cut_spheres.c - spheres with parts cut off stand on a floor. Up to the contact, the floor
 * is dark where the ray to the light meets what is left of a sphere, and lit elsewhere. */
#include "../asserts.h"
#include "mesh_stage.h"

enum { SIDE = 128, PIXELS = SIDE * SIDE };

static const double RADIUS = 12, FLOOR_EDGE = 40, BAND = 9;

/* A cut ball: the height of the ball's middle above the floor, and the cut. */
typedef struct cut_ball {
  double height;
  hl_cut cut;
} cut_ball;

/* The balls are a bowl, half of a ball, most of a ball with a cut by a sphere, and a dome. */
static const cut_ball BALLS[] = {
    {12, {.type = HL_CUT_PLANE, .point = {0, 0, 14}, .normal = {0, 0, 1}}},
    {12, {.type = HL_CUT_PLANE, .point = {0.3, 0, 0}, .normal = {1, 0.3, 0}}},
    {12, {.type = HL_CUT_SPHERE, .center = {9, 2, 16}, .radius = 8}},
    {0, {.type = HL_CUT_PLANE, .normal = {0, 0, -1}}},
};

static void add_floor(mesh_stage *all) {
  hl_mesh *floor = stage_make_quad(&all->set, (vec3){0, 0, 0}, (vec3){FLOOR_EDGE, 0, 0},
                                   (vec3){0, FLOOR_EDGE, 0});
  mesh_stage_add(all, floor)->cut = 0;
}

static void add_ball(mesh_stage *all, const cut_ball *ball) {
  const float sphere[1][4] = {{0, 0, (float)ball->height, (float)RADIUS}};
  hl_mesh_description d;
  hl_mesh_description_defaults(&d);
  d.spheres = sphere, d.sphere_count = 1;
  (void)mesh_stage_describe(all, &d);
  all->set.scene.cuts = &ball->cut;
  all->set.scene.cut_count = 1;
}

static bool is_left(const hl_cut *cut, vec3 point) {
  if (cut->type == HL_CUT_SPHERE)
    return vec3_length(vec3_subtract(point, vec3_of(cut->center))) >= cut->radius;
  return vec3_dot(vec3_subtract(point, vec3_of(cut->point)), vec3_of(cut->normal)) <= 0;
}

/* Returns the distance along a ray of unit direction at which the ray meets the rest of the ball; infinite if
 * the ray misses the ball. */
static double distance_to(const cut_ball *ball, vec3 from, vec3 way) {
  vec3 away = vec3_subtract(from, (vec3){0, 0, ball->height});
  double along = vec3_dot(away, way), square = along * along - vec3_dot(away, away) + RADIUS * RADIUS;
  for (int side = -1; side <= 1 && square > 0; side += 2) {
    double at = -along + side * sqrt(square);
    if (at > 0 && is_left(&ball->cut, vec3_add(from, vec3_scale(way, at)))) return at;
  }
  return INFINITY;
}

/* Whether the floor's points within a margin of a point are all dark, all lit, or of either kind. */
typedef enum shade { DARK, LIT, UNKNOWN } shade;

static shade shade_of(const cut_ball *ball, vec3 at, vec3 sun, double margin) {
  int lit = 0;
  for (int k = 0; k < 8; k++) {
    vec3 beside = {at.x + margin * cos(k * HL_PI / 4), at.y + margin * sin(k * HL_PI / 4), 0};
    lit += isinf(distance_to(ball, beside, sun));
  }
  return lit == 0 ? DARK : lit == 8 ? LIT : UNKNOWN;
}

/* Finds the point of the floor that a pixel shows. Returns false if this point is not near the ball or the
 * pixel shows other things than the floor. */
static bool floor_of_pixel(const stage *set, const cut_ball *ball, int x, int y, vec3 *at) {
  for (int k = 0; k < 5; k++) {
    vec3 eye, right, down, way, unused;
    const double u = k == 4 ? 0 : k % 2 - 0.5, v = k == 4 ? 0 : k / 2 - 0.5;
    stage_eye_ray(set, x, y, &eye, &way);
    stage_eye_ray(set, x + 1, y, &right, &unused);
    stage_eye_ray(set, x, y + 1, &down, &unused);
    eye = vec3_add(
        eye, vec3_add(vec3_scale(vec3_subtract(right, eye), u), vec3_scale(vec3_subtract(down, eye), v)));
    const double to_floor = -eye.z / way.z;
    *at = vec3_add(eye, vec3_scale(way, to_floor));
    if (distance_to(ball, eye, way) < to_floor) return false;
  }
  const double from_foot = sqrt(at->x * at->x + at->y * at->y);
  return ball->height > 0 ? from_foot < BAND : fabs(from_foot - RADIUS) < BAND / 2;
}

static const vec3 EYES[] = {{0, 0, 110}, {60, -80, 50}, {-50, 90, 35}};

static vec3 direction(double elevation_deg, double azimuth_deg) {
  double e = elevation_deg * HL_PI / 180, a = azimuth_deg * HL_PI / 180;
  return (vec3){cos(a) * cos(e), sin(a) * cos(e), sin(e)};
}

/* The greatest light of pixels that must be dark, and the numbers of pixels that were looked at. */
typedef struct found {
  double most;
  int dark, lit;
} found;

static void render_ball(const cut_ball *ball, vec3 sun, vec3 eye, int shadows, found *found) {
  static float pixels[PIXELS * 4];
  const double margin = shadows == 0 ? 1.2 : 2;
  mesh_stage all;
  mesh_stage_open(&all, SIDE, 48);
  add_floor(&all);
  add_ball(&all, ball);
  stage_look(&all.set, eye, (vec3){0, 0, 3}, eye.y == 0 ? (vec3){0, 1, 0} : (vec3){0, 0, 1});
  mesh_stage_choose_shadows(&all, stage_add_directional(&all.set, vec3_scale(sun, -1)), shadows, 3);
  stage_render_sheets(&all.set, pixels);
  for (int i = 0; i < PIXELS; i++) {
    vec3 at;
    if (!floor_of_pixel(&all.set, ball, i % SIDE, i / SIDE, &at)) continue;
    const shade shade = shade_of(ball, at, sun, margin);
    const double value = (double)pixels[4 * i] / sun.z;
    if (shade == LIT) assert_near(value, 1, 0.05);
    if (shade == DARK) found->most = fmax(found->most, value);
    found->dark += shade == DARK;
    found->lit += shade == LIT;
  }
  mesh_stage_close(&all);
}

/* Renders all balls under suns from all sides. */
static found render_all(int shadows) {
  found found = {0};
  for (int b = 0; b < 4; b++)
    for (int k = 0; k < 6; k++)
      render_ball(&BALLS[b], direction(30 + 25 * (k % 2), 110 * (k / 2)), EYES[k % 3], shadows, &found);
  assert_true(found.dark > 2000 && found.lit > 5000);
  return found;
}

static void test_hard(void **state) {
  (void)state;
  assert_near(render_all(0).most, 0, 1e-6);
}

/* The cascade's and the sub-lights' soft shadows leave the dark pixels dark. */
static void test_soft(void **state) {
  (void)state;
  for (int shadows = 1; shadows <= 3; shadows += 2) assert_near(render_all(shadows).most, 0, 0.02);
}

/* If a cut moves between the frames of a renderer, shadows change with it. */
static void test_moved_cut(void **state) {
  (void)state;
  static float fresh[PIXELS * 4], kept[PIXELS * 4];
  hl_renderer *renderer = NULL;
  cut_ball ball = BALLS[1];
  mesh_stage all;
  mesh_stage_open(&all, SIDE, 48);
  add_floor(&all);
  add_ball(&all, &ball);
  stage_look(&all.set, EYES[1], (vec3){0, 0, 3}, (vec3){0, 0, 1});
  mesh_stage_choose_shadows(&all, stage_add_directional(&all.set, vec3_scale(direction(30, 110), -1)), 0, 3);
  assert_int_equal(hl_renderer_create(all.set.context, &renderer, NULL), HL_OK);
  for (int step = 0; step < 4; step++) {
    ball.cut.point[0] = step == 2 ? 40 : 0.3 + 3 * step; /* a cut at 40 removes nothing */
    stage_render_sheets(&all.set, fresh);
    stage_render_with(&all.set, renderer, kept);
    assert_memory_equal(fresh, kept, sizeof fresh);
  }
  hl_renderer_destroy(renderer);
  mesh_stage_close(&all);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_hard), cmocka_unit_test(test_soft),
                                     cmocka_unit_test(test_moved_cut)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
