/* analytic/sheets_shadow.c - the places of shadows and the widths of their edges, against plane geometry. */
#include <stdlib.h>
#include <string.h>

#include "../asserts.h"
#include "reference_stage.h"

enum { WIDE = 160, WIDEST = 320, ROWS = 6, MOST = 96 * 96 };

/* Adds an opaque floor with its surface at z = 0, which casts no shadow, and an opaque plate, half a unit
 * thick, that the eye does not see. The eye looks straight down. */
static void stage_plate(stage *set, vec3 low, double nx, double ny) {
  hl_scene_volume *floor = stage_add_grid(set, (size_t[3]){40, 40, 2}, (double[3]){1, 1, 1},
                                          (vec3){-20, -20, -2}, NULL);
  hl_scene_volume *plate = stage_add_grid(set, (size_t[3]){(size_t)nx, (size_t)ny, 1}, (double[3]){1, 1, 0.5},
                                          low, NULL);
  stage_set_opacity(set, floor, 0.999, 0.01);
  stage_set_opacity(set, plate, 0.9999, 0.001);
  floor->casts_shadow = 0;
  plate->visible = 0;
}

/* Returns the first x between `from` and `to`, in world units, at which the brightness of a row passes a
 * level.
 */
static double crossing(const float *row, int count, double left, double pitch, double level, double from,
                       double to) {
  for (int x = 0; x + 1 < count; x++) {
    double at = left + (x + 0.5) * pitch, a = row[4 * x], b = row[4 * (x + 1)];
    if (at < from || at > to || (a - level) * (b - level) > 0 || a == b) continue;
    return at + pitch * (level - a) / (b - a);
  }
  fail_msg("brightness does not pass %g between %g and %g", level, from, to);
  return 0;
}

/* ---- hard shadows ---- */

static void open_under_point_light(stage *set) {
  stage_open(set);
  stage_plate(set, (vec3){-2, -3, 4}, 4, 6);
  stage_add_point(set, (vec3){0.5, -0.5, 10});
  set->scene.width = set->scene.height = 96;
  set->scene.camera.height = 24;
}

/* By similar triangles, an edge at the height h under a light at the height H casts its shadow H / (H - h)
 * times as far out. The plate's upper face, which is nearer to the light, makes the outline. The tolerance is
 * half of the smallest voxel edge. */
static void test_size_under_point_light(void **state) {
  (void)state;
  static float pixels[MOST * 4];
  stage set;
  open_under_point_light(&set);
  for (double spacing = 0.5; spacing <= 2; spacing *= 2) {
    set.scene.render.sheet_spacing = spacing;
    stage_render_sheets(&set, pixels);
    const float *row = &pixels[4 * 96 * 50];
    double grown = 10 / (10 - 4.5);
    assert_near(crossing(row, 96, -12, 0.25, 0.5, -11, 0), 0.5 - 2.5 * grown, 0.25);
    assert_near(crossing(row, 96, -12, 0.25, 0.5, 0, 11), 0.5 + 1.5 * grown, 0.25);
    assert_near(row[4 * 48], 0, 2e-3);
    assert_near(row[4 * 92], 1, 2e-3);
  }
  stage_close(&set);
}

static void render_hard(stage *set, double spacing, hl_shadow_lookup lookup, float *pixels) {
  set->scene.render.sheet_spacing = spacing;
  set->scene.render.shadow_lookup = lookup;
  stage_render_sheets(set, pixels);
}

/* Light shines along the faces of a cube of haze, which is seen from the side. Within the cube, the light
 * falls by exp(-sigma way). Light that passes beside the cube does not enter through its faces, wherever the
 * pixels of the buffer lie. */
static void test_light_along_faces(void **state) {
  (void)state;
  static float pixels[MOST * 4];
  stage set;
  stage_open(&set);
  hl_scene_volume *cube = stage_add_grid(&set, (size_t[3]){20, 20, 20}, (double[3]){1, 1, 1},
                                         (vec3){-10, -10, -10}, NULL);
  stage_set_opacity(&set, cube, 0.1, 1);
  stage_add_directional(&set, (vec3){1, 0, 0});
  stage_look(&set, (vec3){0, -50, 0}, (vec3){0, 0, 0}, (vec3){0, 0, 1});
  set.scene.width = set.scene.height = 96;
  set.scene.camera.height = 24;
  set.scene.render.shadows = HL_SHADOWS_HARD;
  for (double spacing = 0.25; spacing < 0.8; spacing += 0.1) {
    set.scene.render.sheet_spacing = spacing;
    stage_render_sheets(&set, pixels);
    /* these pixels are more than a slab away from the faces through which light enters and leaves */
    int first = 12, last = 83;
    const float *row = &pixels[4 * 96 * 48];
    double left = pow(0.9, (last - first) * 0.25);
    assert_near((double)row[4 * last] / (double)row[4 * first], left, 0.005 * left);
  }
  stage_close(&set);
}

/* Hard shadows are read by cubic convolution if sheets are closer together than five sixths of a voxel. If
 * sheets are farther apart, cubic convolution would need shadow buffers with pixels of more than three
 * quarters of a voxel, so that the look-ups are bilinear. */
static void test_what_auto_reads(void **state) {
  (void)state;
  static float chosen[MOST * 4], cubic[MOST * 4], bilinear[MOST * 4];
  const struct {
    double spacing;
    int cubic;
  } cases[] = {{0.5, 1}, {0.8, 1}, {0.9, 0}, {1, 0}, {2, 0}};
  stage set;
  open_under_point_light(&set);
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    render_hard(&set, cases[i].spacing, HL_LOOKUP_AUTO, chosen);
    render_hard(&set, cases[i].spacing, HL_LOOKUP_CUBIC, cubic);
    render_hard(&set, cases[i].spacing, HL_LOOKUP_BILINEAR, bilinear);
    assert_memory_not_equal(cubic, bilinear, sizeof cubic);
    assert_memory_equal(chosen, cases[i].cubic ? cubic : bilinear, sizeof chosen);
  }
  stage_close(&set);
}

/* A slanting light moves the shadow by h tan(angle), on whichever side of the light the sheets are. */
static void test_offset_of_directional_light(void **state) {
  (void)state;
  static float pixels[MOST * 4];
  static const double slopes[] = {-1.2, -0.5, 0, 0.7, 1.5};
  stage set;
  stage_open(&set);
  stage_plate(&set, (vec3){-2, -3, 4}, 4, 6);
  hl_light *light = stage_add_directional(&set, (vec3){0, 0, -1});
  set.scene.width = set.scene.height = 96;
  set.scene.camera.height = 24;
  for (size_t i = 0; i < sizeof slopes / sizeof *slopes; i++) {
    light->direction[0] = slopes[i];
    stage_render_sheets(&set, pixels);
    const float *row = &pixels[4 * 96 * 48];
    double near = 4 * slopes[i], far = 4.5 * slopes[i];
    assert_near(crossing(row, 96, -12, 0.25, 0.5, -11, (near + far) / 2), -2 + fmin(near, far), 0.25);
    assert_near(crossing(row, 96, -12, 0.25, 0.5, (near + far) / 2, 11), 2 + fmax(near, far), 0.25);
  }
  stage_close(&set);
}

/* ---- soft shadows ---- */

/* Returns the fraction of a disk of radius 1 at which u < s. */
static double disk_below(double s) {
  if (s <= -1) return 0;
  if (s >= 1) return 1;
  return 0.5 + (s * sqrt(1 - s * s) + asin(s)) / HL_PI;
}

/* Returns the width from 10 to 90 % of the profile of a disk's light: 2 s with disk_below(s) = 0.9, by
 * bisection. */
static double disk_width(void) {
  double low = 0, high = 1;
  for (int i = 0; i < 60; i++) {
    double middle = (low + high) / 2;
    if (disk_below(middle) < 0.9) low = middle;
    else high = middle;
  }
  return 2 * low;
}

/* Returns the width from 10 to 90 % of the shadow's edge of a plate over x < 0, lit from straight above.
 * height: of the plate's middle. */
static double penumbra(double angle_deg, double height, hl_soft_method method) {
  static float pixels[WIDE * ROWS * 4];
  stage set;
  stage_open(&set);
  stage_plate(&set, (vec3){-20, -20, height - 0.25}, 20, 40);
  set.scene.render.shadows = HL_SHADOWS_SOFT;
  set.scene.render.soft_method = method;
  stage_add_directional(&set, (vec3){0, 0, -1})->angular_diameter_deg = angle_deg;
  set.scene.width = WIDE;
  set.scene.height = ROWS;
  set.scene.camera.height = 16.0 * ROWS / WIDE;
  stage_look(&set, (vec3){0, 0, 100}, (vec3){0, 0, 0}, (vec3){0, 1, 0});
  stage_render_sheets(&set, pixels);
  const float *row = &pixels[4 * WIDE * (ROWS / 2)];
  double low = crossing(row, WIDE, -8, 16.0 / WIDE, 0.1, -8, 8),
         high = crossing(row, WIDE, -8, 16.0 / WIDE, 0.9, -8, 8);
  double radius = height * tan(angle_deg * HL_PI / 360);
  for (int x = 0; x < WIDE; x++) {
    double at = -8 + (x + 0.5) * 16.0 / WIDE;
    if (at < -1.6 * radius - 0.3) assert_near(row[4 * x], 0, 5e-3); /* umbra */
    if (at > 1.6 * radius + 0.3) assert_near(row[4 * x], 1, 5e-3);
  }
  stage_close(&set);
  return high - low;
}

static void test_penumbra_of_cascade(void **state) {
  (void)state;
  static const double angles[] = {5, 15, 30}, heights[] = {3, 6, 12};
  for (int a = 0; a < 3; a++)
    for (int h = 0; h < 3; h++) {
      double expected = disk_width() * heights[h] * tan(angles[a] * HL_PI / 360);
      double width = penumbra(angles[a], heights[h], HL_SOFT_CASCADE);
      print_message("# cascade: %2g degrees, height %2g: penumbra %.3f, disk's %.3f\n", angles[a], heights[h],
                    width, expected);
      if (expected < 0.3) continue; /* three pixels */
      assert_near(width / expected, 1, 0.15);
    }
}

/* The paper's convolutions add variances. Four times the distance gives about twice the width, and the edge
 * is narrower than the true edge. */
static void test_penumbra_of_paper(void **state) {
  (void)state;
  static const double angles[] = {15, 30};
  for (int a = 0; a < 2; a++) {
    double near = penumbra(angles[a], 3, HL_SOFT_PAPER), far = penumbra(angles[a], 12, HL_SOFT_PAPER);
    double expected = disk_width() * 12 * tan(angles[a] * HL_PI / 360);
    print_message("# paper: %2g degrees: penumbra %.3f at 3, %.3f at 12, disk's %.3f there\n", angles[a],
                  near, far, expected);
    assert_in_range((int)(100 * far / near), 150, 290);
    assert_true(far < 0.8 * expected);
  }
}

/* A rectangular light above the plate's edge, and the resolution of the picture of its penumbra. */
typedef struct rect_case {
  double across, along; /* the light's sides across the edge and along it */
  double light, plate;  /* heights */
  int width;            /* the number of pixels for 16 units */
  double spacing;
} rect_case;

static const rect_case rect_cases[] = {
    {1.6, 4, 24, 8, 160, 0.5}, {1.6, 0, 24, 8, 160, 1},   {6, 1, 24, 8, 160, 1},   {6, 6, 24, 8, 320, 0.5},
    {6, 12, 24, 8, 160, 0.5},  {10, 3, 30, 15, 320, 0.5}, {10, 8, 30, 15, 320, 1},
};

/* Returns the width from 10 to 90 % of the penumbra, divided by the width of equation (5). The profile of a
 * rectangular light is linear, so that 0.8 L dZ / Z is expected. */
static double rect_penumbra(const rect_case *c, hl_soft_method method, int samples) {
  static float pixels[WIDEST * ROWS * 4];
  stage set;
  stage_open(&set);
  stage_plate(&set, (vec3){-20, -20, c->plate - 0.25}, 20, 40);
  /* This plate reaches as far to the right as the other plate reaches to the left, so that the light is
   * nearly above the middle of the two plates. */
  hl_scene_volume *balance = stage_add_box(&set, (vec3){19, -20, c->plate - 0.25},
                                           (vec3){20, 20, c->plate + 0.25});
  balance->visible = 0; /* its shadow falls beside the pixels that are measured */
  set.scene.render.shadows = HL_SHADOWS_SOFT;
  set.scene.render.soft_method = method;
  set.scene.render.light_samples = samples;
  set.scene.render.sheet_spacing = c->spacing;
  hl_light *light = stage_add_point(&set, (vec3){0, 0, c->light});
  light->type = HL_LIGHT_RECT;
  light->edge1[0] = c->across;
  light->edge2[1] = c->along;
  light->edge1[1] = light->edge1[2] = light->edge2[0] = light->edge2[2] = 0;
  set.scene.width = c->width;
  set.scene.height = ROWS;
  set.scene.camera.height = 16.0 * ROWS / c->width;
  stage_look(&set, (vec3){0, 0, 100}, (vec3){0, 0, 0}, (vec3){0, 1, 0});
  stage_render_sheets(&set, pixels);
  const float *row = &pixels[(size_t)4 * (size_t)c->width * (ROWS / 2)];
  double pitch = 16.0 / c->width, low = crossing(row, c->width, -8, pitch, 0.1, -8, 8);
  double high = crossing(row, c->width, -8, pitch, 0.9, -8, 8),
         expected = c->across * c->plate / (c->light - c->plate);
  stage_close(&set);
  print_message("# rect, method %d: %5.1f pixels, spacing %g: %.3f of eq. (5), from %.3f to %.3f\n",
                (int)method, expected / pitch, c->spacing, (high - low) / (0.8 * expected), low, high);
  return (high - low) / (0.8 * expected);
}

static void test_penumbra_of_rect_by_cascade(void **state) {
  (void)state;
  for (size_t i = 0; i < sizeof rect_cases / sizeof *rect_cases; i++)
    assert_near(rect_penumbra(&rect_cases[i], HL_SOFT_CASCADE, 1), 1, 0.1);
}

static void test_penumbra_of_rect_by_sublights(void **state) {
  (void)state;
  for (size_t i = 0; i < sizeof rect_cases / sizeof *rect_cases; i++)
    assert_near(rect_penumbra(&rect_cases[i], HL_SOFT_SUBLIGHTS, 4), 1, 0.05);
}

/* ---- the two slicing directions ---- */

static hl_scene_volume *add_blob(stage *set) {
  enum { N = 24 };
  float *voxels = malloc(N * N * N * sizeof *voxels);
  assert_non_null(voxels);
  for (int i = 0; i < N * N * N; i++) {
    double x = i % N - 11.5, y = i / N % N - 11.5, z = i / N / N - 11.5, r = sqrt(x * x + y * y + z * z) / 11;
    voxels[i] = (float)fmax(0, 1 - r * r);
  }
  static const hl_opacity_point ramp[] = {{0, 0}, {0.1, 0}, {1, 0.3}};
  hl_scene_volume *blob = stage_add_grid(set, (size_t[3]){N, N, N}, (double[3]){1, 1, 1},
                                         (vec3){-12, -12, -12}, voxels);
  free(voxels);
  blob->transfer_function.opacity = ramp;
  blob->transfer_function.opacity_count = 3;
  return blob;
}

/* Adds a ball on a floor. Ball and floor have a skin one voxel thick. */
static void add_ball_on_floor(stage *set) {
  enum { N = 32 };
  float *voxels = malloc(N * N * N * sizeof *voxels);
  assert_non_null(voxels);
  for (int i = 0; i < N * N * N; i++) {
    double x = i % N - 15.5, y = i / N % N - 15.5, z = i / N / N - 15.5;
    double ball = 8 - sqrt(x * x + y * y + (z - 1) * (z - 1));
    double floor = fmin(fmin(-9 - z, z + 13), fmin(13 - fabs(x), 13 - fabs(y)));
    voxels[i] = (float)fmin(1, fmax(0, 0.5 + 0.5 * fmax(ball, floor)));
  }
  static const hl_opacity_point ramp[] = {{0, 0}, {0.2, 0}, {0.8, 0.9}};
  hl_scene_volume *volume = stage_add_grid(set, (size_t[3]){N, N, N}, (double[3]){1, 1, 1},
                                           (vec3){-16, -16, -16}, voxels);
  free(voxels);
  volume->transfer_function.opacity = ramp;
  volume->transfer_function.opacity_count = 3;
  volume->shading = HL_SHADING_PHONG;
}

static int by_size(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* Returns the root mean square change of the colours between two pictures. */
static double change(const float *a, const float *b, int pixels) {
  double sum = 0;
  for (int i = 0; i < pixels * 4; i++)
    if (i % 4 != 3) sum += ((double)a[i] - b[i]) * ((double)a[i] - b[i]);
  return sqrt(sum / (3 * pixels));
}

/* Where the directions to eye and light are perpendicular (e.l = 0), the slicing direction turns by 90
 * degrees, and the order of the sheets for the eye is reversed. An animation must not show this turn: of 21
 * pictures a degree apart, the greatest change between neighbouring pictures is less than twice the median
 * change. */
static void check_turn(void (*add)(stage *set), hl_shadows shadows, const char *name) {
  enum { FRAMES = 21, SIDE = 64 };
  static float frame[2][SIDE * SIDE * 4];
  double changes[FRAMES - 1];
  stage set;
  stage_open(&set);
  add(&set);
  set.scene.render.shadows = shadows;
  set.scene.render.sheet_spacing = 0.5;
  set.scene.width = set.scene.height = SIDE;
  set.scene.camera.height = 36;
  stage_look(&set, (vec3){20, -60, 40}, (vec3){0, 0, 0}, (vec3){0, 0, 1});
  vec3 sight = vec3_normalise((vec3){-20, 60, -40}), from_above = {0.8, 0.1, -0.8};
  vec3 side = vec3_normalise(vec3_subtract(from_above, vec3_scale(sight, vec3_dot(sight, from_above))));
  hl_light *light = stage_add_directional(&set, side);
  light->angular_diameter_deg = 8;
  for (int i = 0; i < FRAMES; i++) {
    double angle = (i - 10.2) * HL_PI / 180;
    vec3 way = vec3_add(vec3_scale(side, cos(angle)), vec3_scale(sight, sin(angle)));
    memcpy(light->direction, &way, sizeof way);
    stage_render_sheets(&set, frame[i % 2]);
    if (i > 0) changes[i - 1] = change(frame[0], frame[1], SIDE * SIDE);
  }
  stage_close(&set);
  qsort(changes, FRAMES - 1, sizeof changes[0], by_size);
  double median = (changes[9] + changes[10]) / 2;
  print_message("# turn, %s, shadows %d: median change %.5f, greatest %.5f\n", name, shadows, median,
                changes[FRAMES - 2]);
  assert_true(median > 1e-4);
  assert_true(changes[FRAMES - 2] < 2 * median);
}

static void add_blob_alone(stage *set) { add_blob(set); }

static void test_no_jump_where_the_axis_turns(void **state) {
  (void)state;
  for (int shadows = HL_SHADOWS_HARD; shadows <= HL_SHADOWS_SOFT; shadows++) {
    check_turn(add_blob_alone, (hl_shadows)shadows, "haze");
    check_turn(add_ball_on_floor, (hl_shadows)shadows, "surfaces");
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_size_under_point_light),
      cmocka_unit_test(test_light_along_faces),
      cmocka_unit_test(test_what_auto_reads),
      cmocka_unit_test(test_offset_of_directional_light),
      cmocka_unit_test(test_penumbra_of_cascade),
      cmocka_unit_test(test_penumbra_of_paper),
      cmocka_unit_test(test_penumbra_of_rect_by_cascade),
      cmocka_unit_test(test_penumbra_of_rect_by_sublights),
      cmocka_unit_test(test_no_jump_where_the_axis_turns),
  };
  return cmocka_run_group_tests_name("sheets_shadow", tests, NULL, NULL);
}
