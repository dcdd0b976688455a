/* analytic/sheets_labels.c - pictures of label maps: the light that skins and solid matter absorb, and which
 * labels show. The sheets and the reference are tested. */
#include <stdlib.h>
#include <string.h>

#include "../asserts.h"
#include "reference_stage.h"

enum { SIDE = 32, PIXELS = SIDE * SIDE, N = 40 };

/* Opens a scene of two balls of the radius 7 side by side, label 1 on the left and label 2 on the right, seen
 * along -z. */
static hl_scene_volume *open_balls(stage *set, const hl_label *labels, size_t count) {
  static float voxels[N * N * N];
  for (int k = 0; k < N; k++)
    for (int j = 0; j < N; j++)
      for (int i = 0; i < N; i++) {
        double y = j - 19.5, z = k - 19.5, left = hypot(hypot(i - 10.5, y), z),
               right = hypot(hypot(i - 29.5, y), z);
        voxels[(k * N + j) * N + i] = left < 7 ? 1 : right < 7 ? 2 : 0;
      }
  stage_open(set);
  set->scene.width = set->scene.height = SIDE;
  set->scene.camera.height = N;
  stage_look(set, (vec3){0, 0, 100}, (vec3){0, 0, 0}, (vec3){0, 1, 0});
  hl_scene_volume *map = stage_add_grid(set, (size_t[3]){N, N, N}, (double[3]){1, 1, 1},
                                        (vec3){-N / 2, -N / 2, -N / 2}, voxels);
  map->labels = labels;
  map->label_count = count;
  map->shading = HL_SHADING_FLAT;
  return map;
}

/* Returns the pixel at a world position. */
static const float *pixel_at(const float *pixels, double x, double y) {
  int column = (int)((x / N + 0.5) * SIDE), row = (int)((0.5 - y / N) * SIDE);
  return &pixels[4 * (row * SIDE + column)];
}

/* A ray through the middle of a ball crosses its skin twice, so that (1 - o)^2 of the light passes. The
 * reference's steps are short near the skin. */
static void test_skin_takes_its_opacity(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  static const double opacities[] = {0.2, 0.5, 0.9};
  for (int k = 0; k < 6; k++) {
    double o = opacities[k % 3];
    const hl_label labels[] = {{1, "left", {0.9, 0.2, 0.1}, o, 1, 0, 0},
                               {2, "right", {0.1, 0.3, 0.9}, 1, 1, 0, 0}};
    stage set;
    hl_reference_options options;
    hl_reference_options_defaults(&options);
    options.step = 0.1;
    open_balls(&set, labels, 2);
    if (k < 3) stage_render_sheets(&set, pixels);
    else stage_render(&set, &options, pixels);
    const float *left = pixel_at(pixels, -9.4, 0), *right = pixel_at(pixels, 9.4, 0);
    assert_near((double)left[3], 1 - (1 - o) * (1 - o), 0.05);
    assert_near((double)right[3], 1, 2e-3);
    for (int c = 0; c < 3; c++) {
      assert_near((double)left[c], labels[0].color[c] * (double)left[3], 1e-5);
      assert_near((double)right[c], labels[1].color[c] * (double)right[3], 1e-5);
    }
    assert_true(pixel_at(pixels, 0, 0)[3] == 0);
    stage_close(&set);
  }
}

static void test_hidden_labels_are_not_there(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  for (int k = 0; k < 2; k++) {
    const hl_label labels[] = {{1, NULL, {1, 1, 1}, 1, k, 0, 0}, {2, NULL, {1, 1, 1}, 1, 1 - k, 0, 0}};
    stage set;
    open_balls(&set, labels, 2);
    stage_render_by(&set, false, pixels);
    assert_true(pixel_at(pixels, k ? 9.4 : -9.4, 0)[3] == 0);
    assert_near((double)pixel_at(pixels, k ? -9.4 : 9.4, 0)[3], 1, 2e-3);
    stage_close(&set);
  }
}

/* Pictures of labels with shadows by the sheets are near the reference's pictures. */
static void test_labels_against_the_reference(void **state) {
  (void)state;
  static float pixels[2][PIXELS * 4];
  const hl_label labels[] = {{1, NULL, {0.9, 0.2, 0.1}, 0.6, 1, 0, 0},
                             {2, NULL, {0.1, 0.3, 0.9}, 1, 1, 0, 0}};
  for (int reference = 0; reference < 2; reference++) {
    stage set;
    open_balls(&set, labels, 2)->shading = HL_SHADING_PHONG;
    stage_add_directional(&set, (vec3){-1, -0.2, -0.8});
    stage_render_by(&set, reference, pixels[reference]);
    stage_close(&set);
  }
  double sum = 0;
  for (int i = 0; i < 4 * PIXELS; i++) {
    double d = (double)pixels[0][i] - (double)pixels[1][i];
    sum += d * d / (4 * PIXELS);
  }
  assert_near(sqrt(sum), 0, 0.012);
}

/* In a scene with the interpolating kernel, the sheets and the reference still draw labels with the B-spline,
 * for which the labels' fields are made. */
static void test_labels_keep_their_kernel(void **state) {
  (void)state;
  static float pixels[2][PIXELS * 4];
  const hl_label labels[] = {{1, NULL, {0.9, 0.2, 0.1}, 0.6, 1, 0, 0},
                             {2, NULL, {0.1, 0.3, 0.9}, 1, 1, 0, 0}};
  for (int reference = 0; reference < 2; reference++) {
    for (int k = 0; k < 2; k++) {
      stage set;
      open_balls(&set, labels, 2)->shading = HL_SHADING_PHONG;
      stage_add_directional(&set, (vec3){0.3, -0.5, -1});
      set.scene.render.kernel = k == 0 ? HL_KERNEL_BSPLINE : HL_KERNEL_INTERPOLATING;
      stage_render_by(&set, reference, pixels[k]);
      stage_close(&set);
    }
    assert_memory_equal(pixels[0], pixels[1], sizeof pixels[0]);
  }
}

static void test_wrong_labels_are_refused(void **state) {
  (void)state;
  const hl_label bright = {1, NULL, {2, 1, 1}, 1, 1, 0, 0};
  const hl_label twice[] = {{1, NULL, {1, 1, 1}, 1, 1, 0, 0}, {1, NULL, {1, 1, 1}, 1, 1, 0, 0}};
  stage set;
  open_balls(&set, &bright, 1);
  stage_refused(&set, "/volumes/0/labels/0/color/0: 2 is out of range: give linear RGB, each from 0 to 1");
  set.volumes[0].labels = twice;
  set.volumes[0].label_count = 2;
  stage_refused(&set,
                "/volumes/0/labels/1/value: does not come after the label before: sort them by number, each "
                "once");
  stage_close(&set);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_skin_takes_its_opacity),       cmocka_unit_test(test_hidden_labels_are_not_there),
      cmocka_unit_test(test_labels_against_the_reference), cmocka_unit_test(test_labels_keep_their_kernel),
      cmocka_unit_test(test_wrong_labels_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
