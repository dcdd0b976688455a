/* analytic/sheets_umbrae.c - floors below triangles or spheres. A floor is dark, without streaks and rings,
 * where a triangle or sphere hides all of a soft light. Elsewhere the floor is as bright as the fraction of
 * the light that is not hidden. */
#include <string.h>

#include "../asserts.h"
#include "mesh_stage.h"

enum { SIDE = 128, PIXELS = SIDE * SIDE, RIM = 32, LARGE_SIDE = 384, DISK = 600 };

/* WIDE: the height of the picture in world units */
static const double FLOOR = -6, FLOOR_EDGE = 60, WIDE = 48;
static const vec3 EYE = {60, -90, 50};

/* Finds the directions to points of the light's rim. */
static void find_rim(vec3 travels, double angle_deg, vec3 rim[RIM]) {
  vec3 towards = vec3_normalise(vec3_scale(travels, -1)),
       u = vec3_normalise(vec3_cross(towards, (vec3){0, 1, 0})), v = vec3_cross(towards, u);
  double radius = tan(angle_deg / 2 * HL_PI / 180);
  for (int i = 0; i < RIM; i++) {
    double turn = 2 * HL_PI * i / RIM;
    rim[i] = vec3_add(towards,
                      vec3_add(vec3_scale(u, radius * cos(turn)), vec3_scale(v, radius * sin(turn))));
  }
}

/* An occluder: a rectangle around a centre, or a sphere. */
typedef struct hider {
  vec3 centre, u, v;
  double radius; /* the sphere's radius; 0: the occluder is the rectangle */
  double dome;   /* if above 0, the occluder is a dome of triangles of this radius over the rectangle */
  /* another occluder that hides a part of the light from this one; borrowed; may be null */
  const struct hider *before;
} hider;

static bool is_hit(const hider *by, vec3 from, vec3 way) {
  vec3 to = vec3_subtract(by->centre, from);
  if (by->radius > 0) {
    double along = vec3_dot(to, vec3_normalise(way));
    return along > 0 && vec3_dot(to, to) - along * along < by->radius * by->radius;
  }
  vec3 normal = vec3_cross(by->u, by->v);
  vec3 at = vec3_subtract(vec3_scale(way, vec3_dot(to, normal) / vec3_dot(way, normal)), to);
  return fabs(vec3_dot(at, by->u)) < vec3_dot(by->u, by->u) &&
         fabs(vec3_dot(at, by->v)) < vec3_dot(by->v, by->v);
}

/* Returns the point of the floor that the eye sees at (column, row), counted from the middle of a picture of
 * side x side pixels. */
static vec3 on_floor(double column, double row, int side) {
  vec3 way = vec3_normalise(vec3_scale(EYE, -1)), right = vec3_normalise(vec3_cross(way, (vec3){0, 0, 1})),
       down = vec3_cross(way, right);
  vec3 at = vec3_scale(vec3_add(vec3_scale(right, column), vec3_scale(down, row)), WIDE / side);
  return vec3_add(at, vec3_scale(way, (FLOOR - at.z) / way.z));
}

/* Finds the greatest and the mean light that is left in the umbra, at least a pixel within its edge. The
 * occluder is convex, so that it hides all of the light where it hides the light's rim. */
static void find_leaks(const float *pixels, const hider *by, const vec3 rim[RIM], double *greatest,
                       double *mean) {
  double sum = 0;
  int count = 0;
  *greatest = 0;
  for (int i = 0; i < PIXELS; i++) {
    bool hidden = true;
    for (int k = 0; k < RIM; k++)
      for (int corner = 0; corner < 4; corner++)
        hidden = hidden && is_hit(by,
                                  on_floor(i % SIDE - SIDE / 2 + (corner & 1 ? 1.5 : -0.5),
                                           i / SIDE - SIDE / 2 + (corner & 2 ? 1.5 : -0.5), SIDE),
                                  rim[k]);
    if (!hidden) continue;
    *greatest = fmax(*greatest, (double)pixels[4 * i]);
    sum += (double)pixels[4 * i];
    count++;
  }
  assert_true(count > 200);
  *mean = sum / count;
}

static hl_scene_mesh *add_sphere(mesh_stage *all, vec3 centre, double radius) {
  const float sphere[1][4] = {{(float)centre.x, (float)centre.y, (float)centre.z, (float)radius}};
  hl_mesh_description d;
  hl_mesh_description_defaults(&d);
  d.spheres = sphere, d.sphere_count = 1;
  return mesh_stage_describe(all, &d);
}

/* Adds the upper half of a ball of triangles that are a few pixels large. */
static hl_scene_mesh *add_dome(mesh_stage *all, vec3 centre, double radius) {
  enum { RINGS = 16, ROUND = 64 };
  static float positions[(RINGS + 1) * ROUND][3];
  static uint32_t triangles[2 * RINGS * ROUND][3];
  uint32_t count = 0;
  for (uint32_t i = 0; i < (RINGS + 1) * ROUND; i++) {
    double polar = HL_PI / 2 * (i / ROUND) / RINGS, turn = 2 * HL_PI * (i % ROUND) / ROUND;
    vec3 way = {sin(polar) * cos(turn), sin(polar) * sin(turn), cos(polar)};
    vec3_store(positions[i], vec3_add(centre, vec3_scale(way, radius)));
  }
  for (uint32_t ring = 0; ring < RINGS; ring++)
    for (uint32_t i = 0; i < ROUND; i++) {
      uint32_t a = ring * ROUND + i, b = ring * ROUND + (i + 1) % ROUND;
      const uint32_t quad[2][3] = {{a, a + ROUND, b + ROUND}, {a, b + ROUND, b}};
      for (int half = 0; half < 2; half++) memcpy(triangles[count++], quad[half], sizeof quad[half]);
    }
  hl_mesh_description d;
  hl_mesh_description_defaults(&d);
  d.positions = (const float(*)[3])positions, d.vertex_count = (RINGS + 1) * ROUND;
  d.triangles = (const uint32_t(*)[3])triangles, d.triangle_count = count;
  return mesh_stage_describe(all, &d);
}

/* Adds an occluder to the scene. */
static hl_scene_mesh *add_hider(mesh_stage *all, const hider *by) {
  if (by->dome > 0) return add_dome(all, by->centre, by->dome);
  if (by->radius > 0) return add_sphere(all, by->centre, by->radius);
  return mesh_stage_add(all, stage_make_quad(&all->set, by->centre, by->u, by->v));
}

/* Renders a floor that has the light 1 where nothing hides it. The sheets are slanted against the occluder.
 * pixels: [side][side][4]. */
static void render_floor(const hider *by, vec3 travels, double angle, hl_soft_method method, int side,
                         float *pixels) {
  mesh_stage all;
  mesh_stage_open(&all, side, WIDE);
  for (const hider *one = by; one != NULL; one = one->before) add_hider(&all, one)->visible = 0;
  mesh_stage_add(&all, stage_make_quad(&all.set, (vec3){0, 0, FLOOR}, (vec3){FLOOR_EDGE, 0, 0},
                                       (vec3){0, FLOOR_EDGE, 0}));
  hl_light *light = stage_add_directional(&all.set, travels);
  light->angular_diameter_deg = angle;
  all.set.scene.render.shadows = HL_SHADOWS_SOFT;
  all.set.scene.render.soft_method = method;
  stage_look(&all.set, EYE, (vec3){0, 0, 0}, (vec3){0, 0, 1});
  stage_render_sheets(&all.set, pixels);
  mesh_stage_close(&all);
}

static void measure(const hider *by, double angle, hl_soft_method method, double *greatest, double *mean) {
  static float pixels[PIXELS * 4];
  const vec3 travels = {0.4, 0.3, -1};
  vec3 rim[RIM];
  render_floor(by, travels, angle, method, SIDE, pixels);
  find_rim(travels, angle, rim);
  find_leaks(pixels, by, rim, greatest, mean);
}

/* A rectangle close above the floor is parallel to the floor or tilted. Pieces of the rectangle's shadow fall
 * into different chunks of the cascade, and no line of light shows between these pieces. */
static void test_rectangle(void **state) {
  (void)state;
  for (int k = 0; k < 6; k++) {
    const double tilt = k % 3 * 0.2, gap = 3 + 2 * (k / 3);
    const hider by = {.centre = {0, 0, FLOOR + gap + 12 * tilt}, .u = {12, 0, 0}, .v = {0, 12, 12 * tilt}};
    double greatest, mean;
    measure(&by, k % 2 ? 12 : 7, HL_SOFT_CASCADE, &greatest, &mean);
    assert_near(greatest, 0, 0.025);
  }
}

/* A second board hides half of a first board, above the floor, from the light. The second board's penumbra
 * crosses the first board, and leaves no line of light in the first board's umbra. */
static void test_board_before_board(void **state) {
  (void)state;
  for (int k = 0; k < 4; k++) {
    const double angle = k % 2 ? 12 : 7, gap = 8, apart = k / 2 ? 12 : 7;
    const hider before = {
        .centre = {-30 - 0.4 * apart, -0.3 * apart, FLOOR + gap + apart}, .u = {30, 0, 0}, .v = {0, 30, 0}};
    const hider by = {.centre = {0, 0, FLOOR + gap}, .u = {12, 0, 0}, .v = {0, 12, 0}, .before = &before};
    double greatest, mean;
    measure(&by, angle, HL_SOFT_CASCADE, &greatest, &mean);
    assert_near(greatest, 0, 0.02);
  }
}

/* A ball above the floor leaves no rings of light in its umbra. Rings of the ball's lit upper half fall into
 * different chunks of the cascade, and its lower half is dark. */
static void test_ball(void **state) {
  (void)state;
  for (int k = 0; k < 3; k++) {
    const hider by = {.centre = {-3, -2, FLOOR + 10 + k}, .radius = 9};
    double greatest, mean;
    measure(&by, 7, HL_SOFT_CASCADE, &greatest, &mean);
    assert_near(greatest, 0, 0.025);
    assert_near(mean, 0, 0.0002);
  }
}

/* Hardly any light enters through the seams of a dome of small triangles. A seam is a line at which the
 * surface passes from one slab into the next. */
static void test_dome(void **state) {
  (void)state;
  for (int k = 0; k < 4; k++) {
    const double radius = 13, inside = radius / sqrt(2) - 0.3;
    const hider by = {
        .centre = {0, 0, FLOOR + 4 + k}, .u = {inside, 0, 0}, .v = {0, inside, 0}, .dome = radius};
    double greatest, mean;
    measure(&by, 7, k % 2 ? HL_SOFT_CASCADE : HL_SOFT_SUBLIGHTS, &greatest, &mean);
    assert_near(greatest, 0, 0.02);
    assert_near(mean, 0, 0.0008);
  }
}

/* Returns the fraction of the light's disk that a point sees, as a mean over points that fill the disk
 * evenly.
 */
static double part_seen(const hider *by, vec3 from, vec3 travels, double angle) {
  vec3 towards = vec3_normalise(vec3_scale(travels, -1)),
       u = vec3_normalise(vec3_cross(towards, (vec3){0, 1, 0})), v = vec3_cross(towards, u);
  int seen = 0;
  for (int i = 0; i < DISK; i++) {
    double radius = tan(angle / 2 * HL_PI / 180) * sqrt((i + 0.5) / DISK), turn = 2.399963 * i;
    seen += !is_hit(
        by, from,
        vec3_add(towards, vec3_add(vec3_scale(u, radius * cos(turn)), vec3_scale(v, radius * sin(turn)))));
  }
  return (double)seen / DISK;
}

/* A ball hangs half a unit above the floor, below a wide sun. The chunks of the cascade draw no jagged edges
 * beside the ball, and no sharp shadow shows where the sheets begin. The bars are the root mean square and
 * the greatest deviation from the visible fraction of the sun. A sun of 90 degrees nearly grazes the floor,
 * which shades itself. */
static void test_ball_under_wide_sun(void **state) {
  (void)state;
  static float pixels[LARGE_SIDE * LARGE_SIDE * 4];
  static const struct {
    vec3 travels;
    double angle, mean, greatest;
  } cases[] = {{{0.4, 0.3, -1}, 60, 0.04, 0.3}, {{0.45, -0.25, -0.8}, 90, 0.24, 0.6}};
  const hider by = {.centre = {-3, -2, FLOOR + 9.5}, .radius = 9};
  for (int k = 0; k < 2; k++) {
    const double full = -vec3_normalise(cases[k].travels).z; /* Lambert's cosine */
    double square = 0, greatest = 0;
    int count = 0;
    render_floor(&by, cases[k].travels, cases[k].angle, HL_SOFT_CASCADE, LARGE_SIDE, pixels);
    for (int i = 0; i < LARGE_SIDE * LARGE_SIDE; i += 7) {
      vec3 at = on_floor(i % LARGE_SIDE - LARGE_SIDE / 2 + 0.5, i / LARGE_SIDE - LARGE_SIDE / 2 + 0.5,
                         LARGE_SIDE);
      if (fmax(fabs(at.x), fabs(at.y)) > FLOOR_EDGE - 1) continue;
      double differ = (double)pixels[4 * i] / full - part_seen(&by, at, cases[k].travels, cases[k].angle);
      square += differ * differ;
      greatest = fmax(greatest, fabs(differ));
      count++;
    }
    print_message("# sun of %g degrees: rms %.4f, greatest %.4f\n", cases[k].angle, sqrt(square / count),
                  greatest);
    assert_near(sqrt(square / count), 0, cases[k].mean);
    assert_near(greatest, 0, cases[k].greatest);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_rectangle),
                                     cmocka_unit_test(test_board_before_board), cmocka_unit_test(test_ball),
                                     cmocka_unit_test(test_dome), cmocka_unit_test(test_ball_under_wide_sun)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
