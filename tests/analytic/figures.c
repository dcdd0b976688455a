/* analytic/figures.c - the scenes of the paper's figures, measured against closed forms on their own shapes
 * and lights. The scenes are read as they are; the tests then set the cameras and sizes that a measurement
 * needs. The scenes' real data are not needed: the shapes that stand for them are rendered. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include <halflight/halflight.h>

#include "core/vector.h"

enum { MOST = 256 * 256 };

static float pixels[MOST * 4], other[MOST * 4];

static void assert_near(double value, double expected, double tolerance, const char *what) {
  if (!(fabs(value - expected) <= tolerance))
    fail_msg("%s: %.9g is not within %g of %.9g", what, value, tolerance, expected);
}

static hl_context *make_context(void) {
  hl_context *context = NULL;
  assert_int_equal(hl_context_create(NULL, &context, NULL), HL_OK);
  return context;
}

static hl_scene *load(hl_context *context, const char *name) {
  char path[1000];
  hl_scene *scene = NULL;
  hl_error error = {0};
  snprintf(path, sizeof path, "%s/examples/%s.json", HALFLIGHT_SOURCE, name);
  if (hl_scene_load(context, path, &scene, &error) != HL_OK) fail_msg("%s", error.message);
  return scene;
}

static hl_scene *read_text(hl_context *context, const char *text) {
  hl_scene *scene = NULL;
  hl_error error = {0};
  if (hl_scene_from_json(context, text, strlen(text), NULL, "S", &scene, &error) != HL_OK)
    fail_msg("%s", error.message);
  return scene;
}

static void render(hl_context *context, const hl_scene_description *d, float *picture) {
  hl_renderer *renderer = NULL;
  hl_scene *scene = NULL;
  hl_error error = {0};
  assert_true(d->width * d->height <= MOST);
  if (hl_scene_create(context, d, &scene, &error) != HL_OK ||
      hl_renderer_create(context, &renderer, &error) != HL_OK ||
      hl_renderer_render(renderer, scene, picture, 4 * (size_t)d->width, NULL, &error) != HL_OK)
    fail_msg("%s", error.message);
  hl_renderer_destroy(renderer);
  hl_scene_release(scene);
}

/* ---- figure 1 ---- */

/* With shadows, hard or soft, pixels of the table are darker in the shadow alone, and no pixel is brighter
 * than without shadows. */
static void bonsai_differs_in_its_shadow_only(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_scene *off = load(context, "fig01-bonsai-a"), *hard = load(context, "fig01-bonsai-b"),
           *soft = load(context, "fig01-bonsai-c");
  hl_scene *shadowed[] = {hard, soft};
  enum { SIZE = 128 };
  hl_scene_description d = *hl_scene_describe(off);
  d.width = d.height = SIZE;
  d.render.sheet_spacing = 2;
  render(context, &d, pixels);
  for (int n = 0; n < 2; n++) {
    int same = 0, darker = 0, brighter = 0;
    d = *hl_scene_describe(shadowed[n]);
    assert_int_equal(d.render.shadows, n == 0 ? HL_SHADOWS_HARD : HL_SHADOWS_SOFT);
    d.width = d.height = SIZE;
    d.render.sheet_spacing = 2;
    render(context, &d, other);
    for (int p = 0; p < SIZE * SIZE; p++) {
      double before = pixels[4 * p + 1], after = other[4 * p + 1];
      brighter += after > before + 0.02;
      same += fabs(after - before) <= 0.01;
      darker += after < before - 0.05;
    }
    assert_true(same > 0.5 * SIZE * SIZE && darker > 0.1 * SIZE * SIZE);
    /* Pixels of silhouettes may be brighter with shadows, because the sheets lie in other places than without
     * shadows. */
    assert_true(brighter < 0.012 * SIZE * SIZE);
    /* pixels of the table at the lower left, on the light's side */
    int corner = 4 * (SIZE - 1) * SIZE;
    assert_near(other[corner], pixels[corner], 0.002, "the lit table");
  }
  hl_scene_release(off);
  hl_scene_release(hard);
  hl_scene_release(soft);
  hl_context_destroy(context);
}

/* ---- figures 4 and 19 ---- */

/* Returns the least distance between a ring's surface and the light's ray to a point of the floor. */
static double clearance(double x, double y, double height, vec3 towards_light) {
  double least = INFINITY;
  for (double s = height - 10; s < height + 10; s += 0.02) {
    double px = x + s * towards_light.x, py = y + s * towards_light.y, pz = s - height;
    least = fmin(least, hypot(hypot(px, py) - 20, pz) - 4.5);
  }
  return least;
}

/* The scene is one ring of the figure over a floor, seen from above. The light comes at 45 degrees, so that
 * the shadow lies beside the ring. */
static void ring_casts_its_outline(void **state) {
  (void)state;
  static const char text[] =
      "{ \"halflight\": 1, \"image\": { \"width\": 160, \"height\": 160 },"
      "  \"camera\": { \"type\": \"orthographic\", \"position\": [60, 0, 200], \"target\": [60, 0, 0], "
      "\"up\": [0, 1, 0],"
      "                \"height\": 60 },"
      "  \"ambient\": [0.2, 0.2, 0.2], \"lights\": [ { \"direction\": [1, 0, -1] } ],"
      "  \"volumes\": [ { \"shapes\": [ { \"type\": \"torus\", \"radius\": 20, \"tube_radius\": 4.5, "
      "\"position\": [0, 0, 60] } ],"
      "                   \"voxel_size\": 0.5 },"
      "                 { \"shapes\": [ { \"type\": \"plane\", \"size\": [160, 80], \"thickness\": 8, "
      "\"position\": [40, 0, 0] } ],"
      "                   \"voxel_size\": 2, \"casts_shadow\": false, \"material\": { \"specular\": 0 },"
      "                   \"transfer_function\": { \"opacity\": [[0.46, 0], [0.54, 0.95]], "
      "\"unit_distance\": 0.3 } } ],"
      "  \"render\": { \"shadows\": \"hard\", \"sheet_spacing\": 1 } }";
  hl_context *context = make_context();
  hl_scene *scene = read_text(context, text);
  render(context, hl_scene_describe(scene), pixels);
  /* by equation (3), lit pixels have ambient light and diffuse light at 45 degrees */
  double lit = 0.2 + 0.7 * sqrt(0.5), dark = 0.2;
  int umbra = 0, light = 0, edge_lit = 0, edge = 0;
  for (int j = 0; j < 160; j++)
    for (int i = 0; i < 160; i++) {
      double x = 60 + (i + 0.5 - 80) * 60 / 160, y = (80 - j - 0.5) * 60 / 160;
      double gap = clearance(x, y, 60, (vec3){-1, 0, 1}), value = pixels[4 * (160 * j + i)];
      if (gap < -1) {
        assert_near(value, dark, 0.01, "the umbra");
        umbra++;
      } else if (gap > 1) {
        assert_near(value, lit, 0.01, "the lit floor");
        light++;
      } else if (fabs(gap) < 0.75) {
        /* There are as many pixels on either side of the outline. If the shadow's outline is in its place,
         * half of these pixels are lit. */
        edge++;
        edge_lit += value > (lit + dark) / 2;
      }
    }
  assert_true(umbra > 1500 && light > 5000 && edge > 800);
  /* The edge's pixels are 1.5 units wide. So a fraction of 0.1 is an error of 0.15 units, which is a third of
   * a voxel. */
  assert_near((double)edge_lit / edge, 0.5, 0.1, "the outline");
  hl_scene_release(scene);
  hl_context_destroy(context);
}

/* ---- figure 5 ---- */

/* Amber lobes stay amber in the shadow, blue lobes stay blue, and shadows make no pixel brighter. */
static void lobes_keep_their_colour(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_scene *off = load(context, "fig05-hipip-a"), *hard = load(context, "fig05-hipip-b");
  enum { SIZE = 128 };
  hl_scene_description a = *hl_scene_describe(off), b = *hl_scene_describe(hard);
  a.width = a.height = b.width = b.height = SIZE;
  a.render.sheet_spacing = b.render.sheet_spacing = 0.5;
  a.volume_count = b.volume_count = 1;
  render(context, &a, pixels);
  render(context, &b, other);
  int amber = 0, blue = 0, wrong = 0, darker = 0;
  for (int p = 0; p < SIZE * SIZE; p++) {
    const float *before = &pixels[4 * p], *after = &other[4 * p];
    if (before[3] < 0.99f || after[3] < 0.99f) continue;
    for (int c = 0; c < 3; c++) wrong += after[c] > before[c] + 0.02f;
    darker += after[1] < before[1] - 0.02f;
    if (before[0] > 2 * before[2]) amber++, wrong += !(after[0] > after[2]);
    if (before[2] > 2 * before[0]) blue++, wrong += !(after[2] > after[0]);
  }
  assert_true(amber > 500 && blue > 500);
  /* Pixels are darker only where lobes shade each other: no lobe shades its own lit side. */
  assert_true(darker > 10 && darker < 500);
  assert_true(wrong < 20); /* the number of pixels in which two lobes meet */
  hl_scene_release(off);
  hl_scene_release(hard);
  hl_context_destroy(context);
}

/* ---- figures 6 and 22 ---- */

static void both_hypertextures_are_the_same_bytes(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_scene *hard = load(context, "fig06-hypertexture"), *soft = load(context, "fig22-hypertexture-soft");
  const hl_volume *a = hl_scene_describe(hard)->volumes[0].volume,
                  *b = hl_scene_describe(soft)->volumes[0].volume;
  hl_volume_info one = {.struct_size = sizeof one}, two = {.struct_size = sizeof two};
  assert_int_equal(hl_volume_get_info(a, &one), HL_OK);
  assert_int_equal(hl_volume_get_info(b, &two), HL_OK);
  assert_memory_equal(&one, &two, sizeof one);
  assert_true(one.histogram[128] > 100);
  for (size_t n = 0; n < 100000; n++) {
    size_t i = 7919 * n % one.dimensions[0], j = 104729 * n % one.dimensions[1],
           k = 1299709 * n % one.dimensions[2];
    assert_true(hl_volume_value(a, i, j, k) == hl_volume_value(b, i, j, k));
  }
  hl_scene_release(hard);
  hl_scene_release(soft);
  hl_context_destroy(context);
}

/* ---- figure 7 ---- */

/* The shadow of a straight edge that is askew to all grids stays within 1.5 pixels of a line. A voxel is
 * eight pixels wide. */
static void close_shadow_edges_are_not_blocky(void **state) {
  (void)state;
  static const char text[] =
      "{ \"halflight\": 1, \"image\": { \"width\": 200, \"height\": 200 },"
      "  \"camera\": { \"type\": \"orthographic\", \"position\": [0, 0, 100], \"target\": [0, 0, 0], \"up\": "
      "[0, 1, 0],"
      "                \"height\": 25 },"
      "  \"ambient\": [0, 0, 0], \"lights\": [ { \"direction\": [0.5, 0.1, -1] } ],"
      "  \"volumes\": [ { \"shapes\": [ { \"type\": \"box\", \"size\": [40, 120, 10], \"position\": [-31, 0, "
      "22],"
      "                                    \"rotate\": { \"axis\": [0, 0, 1], \"angle_deg\": 23 } } ], "
      "\"voxel_size\": 1 },"
      "                 { \"shapes\": [ { \"type\": \"plane\", \"size\": [80, 80], \"thickness\": 8 } ],"
      "                   \"voxel_size\": 1, \"casts_shadow\": false, \"material\": { \"specular\": 0 } } ],"
      "  \"render\": { \"shadows\": \"hard\" } }";
  hl_context *context = make_context();
  hl_scene *scene = read_text(context, text);
  hl_scene_description d = *hl_scene_describe(scene);
  hl_scene_volume volumes[2] = {d.volumes[0], d.volumes[1]};
  volumes[0].visible = 0;
  d.volumes = volumes;
  render(context, &d, pixels);
  double lit = 0;
  for (int p = 0; p < 200 * 200; p++) lit = fmax(lit, pixels[4 * p]);
  double n = 0, sy = 0, sx = 0, syy = 0, sxy = 0, at[200];
  for (int j = 0; j < 200; j++) {
    at[j] = NAN;
    for (int i = 0; i + 1 < 200; i++) {
      double a = pixels[4 * (200 * j + i)], b = pixels[4 * (200 * j + i + 1)];
      if (a <= lit / 2 && b > lit / 2) at[j] = i + (lit / 2 - a) / (b - a);
    }
    if (isnan(at[j])) continue;
    n++, sy += j, sx += at[j], syy += (double)j * j, sxy += j * at[j];
  }
  assert_true(n > 150);
  double slope = (n * sxy - sy * sx) / (n * syy - sy * sy), start = (sx - slope * sy) / n;
  /* The rows of the picture go down, so that the slope has the other sign. */
  assert_near(slope, tan(23 * HL_PI / 180), 0.02, "the edge's slope");
  for (int j = 0; j < 200; j++)
    if (!isnan(at[j])) assert_near(at[j], start + slope * j, 1.5, "the shadow's edge");
  hl_scene_release(scene);
  hl_context_destroy(context);
}

/* ---- figures 20 and 21 ---- */

/* Returns the variance, in world units squared, of the places at which the brightness of a row rises or falls
 * at an edge. */
static double edge_variance(const float *row, int count, double pitch) {
  double weight = 0, first = 0, second = 0;
  for (int i = 0; i + 1 < count; i++) {
    double step = row[4 * (i + 1)] - row[4 * i], x = i * pitch;
    weight += step, first += step * x, second += step * x * x;
  }
  double mean = first / weight;
  return second / weight - mean * mean;
}

/* Returns the variance of the edge of the shadow that a bar at a height casts under the light of figure 20.
 * The variance of the same edge with hard shadows is subtracted. */
static double penumbra_spread(hl_context *context, double height, double angle_deg) {
  char text[2000];
  double variance[2];
  for (int soft = 0; soft < 2; soft++) {
    snprintf(
        text, sizeof text,
        "{ \"halflight\": 1, \"image\": { \"width\": 240, \"height\": 8 },"
        "  \"camera\": { \"type\": \"orthographic\", \"position\": [0, 0, 200], \"target\": [0, 0, 0],"
        "                \"up\": [0, 1, 0], \"height\": 1 },"
        "  \"ambient\": [0, 0, 0], \"lights\": [ { \"direction\": [0, 0, -1], \"angular_diameter_deg\": %g } "
        "],"
        "  \"volumes\": [ { \"shapes\": [ { \"type\": \"box\", \"size\": [60, 40, 3], \"position\": [-30, 0, "
        "%g] } ],"
        "                   \"voxel_size\": 0.5, \"visible\": false },"
        "                 { \"shapes\": [ { \"type\": \"plane\", \"size\": [60, 40], \"thickness\": 5 } ],"
        "                   \"voxel_size\": 1, \"casts_shadow\": false, \"material\": { \"specular\": 0 } } "
        "],"
        "  \"render\": { \"shadows\": \"%s\", \"sheet_spacing\": 1 } }",
        angle_deg, height, soft ? "soft" : "hard");
    hl_scene *scene = read_text(context, text);
    render(context, hl_scene_describe(scene), pixels);
    variance[soft] = edge_variance(&pixels[4 * 240 * 4], 240, 1.0 / 8);
    hl_scene_release(scene);
  }
  return sqrt(variance[1] - variance[0]);
}

/* Equation (5), dx = L dZ / Z: parallel light with an angle has dx = 2 tan(angle / 2) dZ. A disk of the
 * diameter D has the standard deviation D / 4. */
static void penumbra_grows_with_height(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_scene *robots = load(context, "fig20-robots-a");
  double angle_deg = hl_scene_describe(robots)->lights[0].angular_diameter_deg;
  double head = penumbra_spread(context, 61, angle_deg), hips = penumbra_spread(context, 24.5, angle_deg);
  assert_near(head, 2 * tan(angle_deg * HL_PI / 360) * 61 / 4, 0.08 * head, "the spread under the head");
  assert_near(head / hips, 61 / 24.5, 0.15, "head over hips");
  hl_scene_release(robots);
  hl_context_destroy(context);
}

/* The block of figure 21 is seen from the side, and a straight edge takes the ring's place. A row of the
 * picture shows the shadow's edge at one depth in the block. */
static void shadow_widens_through_the_block(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_scene *example = load(context, "fig21-translucent-b");
  double angle_deg = hl_scene_describe(example)->lights[0].angular_diameter_deg;
  static const char text[] =
      "{ \"halflight\": 1, \"image\": { \"width\": 240, \"height\": 256 },"
      "  \"camera\": { \"type\": \"orthographic\", \"position\": [0, -300, 37], \"target\": [0, 0, 37], "
      "\"height\": 64 },"
      "  \"ambient\": [0, 0, 0], \"lights\": [ { \"direction\": [0, 0, -1], \"angular_diameter_deg\": 0 } ],"
      "  \"volumes\": [ { \"shapes\": [ { \"type\": \"box\", \"size\": [66, 46, 62], \"position\": [0, 0, "
      "37] } ], \"voxel_size\": 1,"
      "                   \"transfer_function\": { \"opacity\": 0.018 }, \"shading\": \"none\" },"
      "                 { \"shapes\": [ { \"type\": \"box\", \"size\": [60, 60, 3], \"position\": [-30, 0, "
      "82] } ],"
      "                   \"voxel_size\": 0.5, \"visible\": false } ],"
      "  \"render\": { \"shadows\": \"soft\", \"sheet_spacing\": 1 } }";
  hl_scene *scene = read_text(context, text);
  hl_scene_description d = *hl_scene_describe(scene);
  hl_light light = d.lights[0];
  d.lights = &light;
  render(context, &d, other);
  light.angular_diameter_deg = angle_deg;
  render(context, &d, pixels);
  /* two depths in the block: near the face where light enters, and near the face where it leaves */
  const double depths[] = {62, 12};
  for (int n = 0; n < 2; n++) {
    int row = (int)((69 - depths[n]) * 4), first = 40,
        count = 160; /* 40 units around the edge, a quarter of a unit for each pixel */
    double variance = edge_variance(&pixels[4 * (240 * row + first)], count, 0.25) -
                      edge_variance(&other[4 * (240 * row + first)], count, 0.25);
    double expected = 2 * tan(angle_deg * HL_PI / 360) * (82 - depths[n]) / 4;
    /* The cascade's edge is 4 % too wide where the light enters and 18 % too wide where it leaves; in the
     * middle the block's own groups widen it. */
    assert_near(sqrt(variance), expected, (n == 0 ? 0.08 : 0.2) * expected,
                n == 0 ? "the entrance" : "the exit");
  }
  hl_scene_release(scene);
  hl_scene_release(example);
  hl_context_destroy(context);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(bonsai_differs_in_its_shadow_only),
      cmocka_unit_test(ring_casts_its_outline),
      cmocka_unit_test(lobes_keep_their_colour),
      cmocka_unit_test(both_hypertextures_are_the_same_bytes),
      cmocka_unit_test(close_shadow_edges_are_not_blocky),
      cmocka_unit_test(penumbra_grows_with_height),
      cmocka_unit_test(shadow_widens_through_the_block),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
