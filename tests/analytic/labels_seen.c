/* analytic/labels_seen.c - thin and small labels in pictures: how much is seen of a plate, a shell, a line, a
 * single voxel, and balls of a few voxels. */
#include <math.h>
#include <string.h>

#include "../asserts.h"
#include "reference_stage.h"

enum { SIDE = 160, PIXELS = SIDE * SIDE, N = 40 };

static unsigned char voxels[N * N * N];
static float pixels[4 * PIXELS];

/* Returns how far inside a shape a point lies; below 0: the point lies outside. */
typedef double depth_function(const void *shape, vec3 p);

/* Fills the grid, whose middle is the origin, with a shape's voxels. Returns the number of the label's
 * voxels. */
static int fill_voxels(depth_function *depth, const void *shape) {
  int count = 0;
  for (int k = 0; k < N; k++)
    for (int j = 0; j < N; j++)
      for (int i = 0; i < N; i++) {
        const vec3 p = {i - (N - 1) / 2.0, j - (N - 1) / 2.0, k - (N - 1) / 2.0};
        count += voxels[(k * N + j) * N + i] = depth(shape, p) > 0;
      }
  return count;
}

/* Draws label 1 as solid matter, seen orthographically along a direction. The picture is `height` voxels
 * high. */
static void draw(vec3 along, double height) {
  static const hl_label label[] = {{1, NULL, {1, 1, 1}, 1, 1, 0, 0}};
  stage set;
  stage_open(&set);
  set.scene.width = set.scene.height = SIDE;
  set.scene.camera.height = height;
  const vec3 up = fabs(along.y) < 0.9 ? (vec3){0, 1, 0} : (vec3){1, 0, 0};
  stage_look(&set, vec3_scale(vec3_normalise(along), -100), (vec3){0, 0, 0}, up);
  static float values[N * N * N];
  for (int n = 0; n < N * N * N; n++) values[n] = voxels[n];
  hl_scene_volume *map = stage_add_grid(&set, (size_t[3]){N, N, N}, (double[3]){1, 1, 1},
                                        (vec3){-N / 2, -N / 2, -N / 2}, values);
  map->labels = label;
  map->label_count = 1;
  map->shading = HL_SHADING_FLAT;
  stage_render_by(&set, false, pixels);
  stage_close(&set);
}

/* Returns the area that the label covers in the picture, in squared voxels. */
static double area_seen(double height) {
  double sum = 0;
  for (int n = 0; n < PIXELS; n++) sum += (double)pixels[4 * n + 3];
  return sum * height / SIDE * height / SIDE;
}

/* Returns the alpha at a point of the picture. x, y: the point's distance from the picture's middle, in
 * voxels. */
static double alpha_at(double x, double y, double height) {
  const int column = (int)((x / height + 0.5) * SIDE), row = (int)((0.5 - y / height) * SIDE);
  return (double)pixels[4 * (row * SIDE + column) + 3];
}

/* ---- plates ---- */

typedef struct plate {
  vec3 normal;
  double half, radius, offset;
} plate;

static double depth_in_plate(const void *shape, vec3 p) {
  const plate *s = shape;
  const double height = vec3_dot(p, s->normal) - s->offset;
  const double across = sqrt(fmax(vec3_dot(p, p) - (height + s->offset) * (height + s->offset), 0));
  return fmin(s->half - fabs(height), s->radius - across);
}

/* A round plate of one voxel's thickness covers at least 0.9 of the area of a plate of two voxels' thickness,
 * seen from the front and from the side. */
static void test_plates(void **state) {
  (void)state;
  uint32_t seed = 3;
  for (int k = 0; k < 33; k++) {
    plate s = {.normal = stage_random_direction(&seed), .radius = 13, .offset = 0.5 * stage_random(&seed)};
    if (k < 3) s.normal = (vec3){k == 0, k == 1, k == 2}, s.offset = 0.5;
    const vec3 aside = stage_random_direction(&seed);
    for (int view = 0; view < 2; view++) {
      const vec3 along = view == 0 ? s.normal : vec3_add(s.normal, vec3_scale(aside, 0.8));
      double area[2];
      for (int thickness = 1; thickness <= 2; thickness++) {
        s.half = thickness / 2.0;
        (void)fill_voxels(depth_in_plate, &s);
        draw(along, 36);
        area[thickness - 1] = area_seen(36);
      }
      assert_true(area[1] > 0.9 * HL_PI * 13 * 13 * fabs(vec3_dot(s.normal, vec3_normalise(along))));
      assert_true(area[0] > 0.9 * area[1]);
    }
  }
}

/* ---- shells ---- */

static double depth_in_shell(const void *shape, vec3 p) {
  return 0.5 - fabs(vec3_length(p) - *(const double *)shape);
}

static void test_shells(void **state) {
  (void)state;
  uint32_t seed = 9;
  for (int k = 0; k < 6; k++) {
    const double radius = 8 + 6 * stage_random(&seed);
    (void)fill_voxels(depth_in_shell, &radius);
    draw(stage_random_direction(&seed), 36);
    for (int n = 0; n < 4000; n++) {
      const double r = (radius - 1) * sqrt(stage_random(&seed)), turn = 2 * HL_PI * stage_random(&seed);
      assert_true(alpha_at(r * cos(turn), r * sin(turn), 36) > 0.98);
    }
  }
}

/* ---- lines and voxels ---- */

typedef struct line {
  vec3 direction;
  double half;
} line;

/* Marks the voxels to which points of a line are nearest. */
static void fill_line(const line *s) {
  memset(voxels, 0, sizeof voxels);
  for (int n = -1000; n <= 1000; n++) {
    const vec3 p = vec3_scale(s->direction, s->half * n / 1000);
    const int i = (int)floor(p.x + N / 2), j = (int)floor(p.y + N / 2), k = (int)floor(p.z + N / 2);
    voxels[(k * N + j) * N + i] = 1;
  }
}

/* A line, seen from the side, is a band without a gap. */
static void test_lines(void **state) {
  (void)state;
  uint32_t seed = 4;
  for (int k = 0; k < 30; k++) {
    line s = {stage_random_direction(&seed), 14};
    if (k < 3) s.direction = (vec3){k == 0, k == 1, k == 2};
    if (k == 3) s.direction = vec3_normalise((vec3){1, 1, 1});
    const vec3 aside = vec3_normalise(vec3_cross(s.direction, stage_random_direction(&seed)));
    fill_line(&s);
    draw(aside, 36);
    const vec3 up = fabs(aside.y) < 0.9 ? (vec3){0, 1, 0} : (vec3){1, 0, 0};
    const vec3 right = vec3_normalise(vec3_cross(aside, up)), above = vec3_cross(right, aside);
    for (int n = -120; n <= 120; n++) {
      const vec3 p = vec3_scale(s.direction, 13.0 * n / 120);
      double most = 0;
      for (int b = -12; b <= 12; b++) {
        const vec3 q = vec3_add(p, vec3_scale(vec3_cross(s.direction, aside), b / 10.0));
        most = fmax(most, alpha_at(vec3_dot(q, right), vec3_dot(q, above), 36));
      }
      assert_true(most > 0.7);
    }
  }
}

static void test_a_voxel(void **state) {
  (void)state;
  uint32_t seed = 6;
  memset(voxels, 0, sizeof voxels);
  voxels[(20 * N + 20) * N + 20] = 1;
  for (int k = 0; k < 8; k++) {
    draw(stage_random_direction(&seed), 8);
    /* In the mean over all directions, a cube of one voxel shows an area of 1.5. */
    assert_true(area_seen(8) > 1);
    assert_true(area_seen(8) < 2);
  }
}

/* ---- volumes ---- */

typedef struct ball {
  vec3 centre;
  double radius;
} ball;

static double depth_in_ball(const void *shape, vec3 p) {
  const ball *b = shape;
  return b->radius - vec3_length(vec3_subtract(p, b->centre));
}

/* The outlines of a ball of a few voxels enclose the area of a ball that has the voxels' volume, in the mean
 * over places and views. Small balls are less round, so that their mean is taken over more views. */
static void test_outlines_of_balls(void **state) {
  (void)state;
  static const double radii[] = {1.5, 1.75, 2, 2.25, 2.5, 3, 4, 6, 10};
  uint32_t seed = 2;
  for (size_t k = 0; k < sizeof radii / sizeof *radii; k++) {
    const double height = 3 * radii[k] + 2;
    const int views = radii[k] < 3 ? 60 : 12;
    double sum = 0;
    for (int view = 0; view < views; view++) {
      const ball b = {{stage_random(&seed), stage_random(&seed), stage_random(&seed)}, radii[k]};
      const int count = fill_voxels(depth_in_ball, &b);
      draw(stage_random_direction(&seed), height);
      sum += pow(area_seen(height) / HL_PI, 1.5) * 4 * HL_PI / 3 / count / views;
    }
    assert_near(sum, 1, 0.01);
  }
}

/* ---- labels that touch ---- */

enum { CELLS = 100 };

/* Divides a ball into the labels 1 to CELLS: each voxel belongs to the nearest of CELLS points. */
static void fill_atlas(void) {
  uint32_t seed = 12;
  vec3 points[CELLS];
  for (int n = 0; n < CELLS; n++)
    points[n] = vec3_scale(stage_random_direction(&seed), 16 * stage_random(&seed));
  for (int at = 0; at < N * N * N; at++) {
    const vec3 p = {at % N - (N - 1) / 2.0, at / N % N - (N - 1) / 2.0, at / N / N - (N - 1) / 2.0};
    int nearest = 0;
    for (int n = 1; n < CELLS; n++)
      if (vec3_length(vec3_subtract(p, points[n])) < vec3_length(vec3_subtract(p, points[nearest])))
        nearest = n;
    voxels[at] = vec3_length(p) < 16 ? (unsigned char)(nearest + 1) : 0;
  }
}

/* Draws the labels, lit from the eye, without shadows. The labels are red and blue in turn, so that the sum
 * of a pixel's red and blue is the light that a white body sends. cut: may be null. */
static void draw_lit(vec3 along, int label_count, const hl_cut *cut) {
  static float values[N * N * N];
  hl_label labels[CELLS];
  stage set;
  for (int n = 0; n < label_count; n++)
    labels[n] = (hl_label){n + 1, NULL, {n % 2 == 0, 0, n % 2 == 1}, 1, 1, 0, 0};
  for (int n = 0; n < N * N * N; n++) values[n] = voxels[n];
  stage_open(&set);
  set.scene.width = set.scene.height = SIDE;
  set.scene.camera.height = 36;
  const vec3 up = fabs(along.y) < 0.9 ? (vec3){0, 1, 0} : (vec3){1, 0, 0};
  stage_look(&set, vec3_scale(along, -100), (vec3){0, 0, 0}, up);
  hl_scene_volume *map = stage_add_grid(&set, (size_t[3]){N, N, N}, (double[3]){1, 1, 1},
                                        (vec3){-N / 2, -N / 2, -N / 2}, values);
  map->labels = labels;
  map->label_count = (size_t)label_count;
  map->shading = HL_SHADING_PHONG;
  map->material = (hl_material){.diffuse = 1};
  map->cuts = cut;
  map->cut_count = cut != NULL;
  stage_add_directional(&set, along)->shadows = HL_SHADOWS_OFF;
  stage_render_by(&set, false, pixels);
  stage_close(&set);
}

static double brightness_at(double x, double y) {
  const int column = (int)((x / 36 + 0.5) * SIDE), row = (int)((0.5 - y / 36) * SIDE);
  const float *pixel = &pixels[4 * (row * SIDE + column)];
  return (double)pixel[0] + (double)pixel[2];
}

/* A box, half red and half blue, is as bright at the seam between the colours as beside the seam. */
static void test_seam(void **state) {
  (void)state;
  for (int at = 0; at < N * N * N; at++) {
    const int i = at % N, j = at / N % N, k = at / N / N;
    const bool inside = i >= 8 && i < 32 && j >= 8 && j < 32 && k >= 8 && k < 32;
    voxels[at] = !inside ? 0 : i < 20 ? 1 : 2;
  }
  draw_lit((vec3){0, 0, -1}, 2, NULL);
  const double beside = brightness_at(-5, 0);
  assert_near(beside, 1, 0.01);
  for (int n = -40; n <= 40; n++)
    for (int y = -6; y <= 6; y += 3) assert_true(brightness_at(n / 10.0, y) > 0.95 * beside);
  /* each of these pixels is red alone or blue alone */
  assert_true(pixels[4 * (SIDE / 2 * SIDE + SIDE / 2 - 12)] > 0.99);
  assert_true(pixels[4 * (SIDE / 2 * SIDE + SIDE / 2 + 12) + 2] > 0.99);
}

/* A ball of a hundred labels, cut through the middle, shows no dark line between labels, on the cut's face or
 * on the ball. */
static void test_sliced_atlas(void **state) {
  (void)state;
  uint32_t seed = 15;
  fill_atlas();
  for (int k = 0; k < 20; k++) {
    const vec3 along = stage_random_direction(&seed);
    const hl_cut cut = {.type = HL_CUT_PLANE, .normal = {-along.x, -along.y, -along.z}};
    for (int whole = 0; whole < 2; whole++) {
      draw_lit(along, CELLS, whole ? NULL : &cut);
      for (int n = 0; n < 2000; n++) {
        const double r = 13 * sqrt(stage_random(&seed)), turn = 2 * HL_PI * stage_random(&seed);
        const double expected = whole ? sqrt(1 - r * r / (16 * 16)) : 1;
        assert_true(brightness_at(r * cos(turn), r * sin(turn)) > (whole ? 0.85 : 0.95) * expected);
      }
    }
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_plates),
                                     cmocka_unit_test(test_shells),
                                     cmocka_unit_test(test_lines),
                                     cmocka_unit_test(test_a_voxel),
                                     cmocka_unit_test(test_outlines_of_balls),
                                     cmocka_unit_test(test_seam),
                                     cmocka_unit_test(test_sliced_atlas)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
