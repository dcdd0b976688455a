/* analytic/sheets_maximum.c - maximum projections: fields whose greatest value along a ray is known, and
 * fields of noise that are compared with the reference. Each closed form is tested on the sheets and on the
 * reference. */
#include <stdlib.h>
#include <string.h>

#include "../asserts.h"
#include "reference_stage.h"

enum { SIDE = 24, PIXELS = SIDE * SIDE, N = 24 };

/* The colour is the grey of the value itself, from 0 to 1. Values above 0 are shown. */
static const hl_opacity_point ABOVE_ZERO[] = {{0, 0}, {1, 1}};
static const hl_color_point GREY[] = {{0, {0, 0, 0}}, {1, {1, 1, 1}}};

static void set_function(hl_scene_volume *volume, const hl_opacity_point *opacity, size_t opacity_count,
                         const hl_color_point *color, size_t color_count) {
  volume->transfer_function.opacity = opacity;
  volume->transfer_function.opacity_count = opacity_count;
  volume->transfer_function.color = color;
  volume->transfer_function.color_count = color_count;
}

typedef double field_function(double x, double y, double z);

/* Adds a cube of N^3 voxels of edge 1 around the origin. */
static hl_scene_volume *add_field(stage *set, field_function *field) {
  static float voxels[N * N * N];
  for (int i = 0; i < N * N * N; i++)
    voxels[i] = (float)field(i % N - (N - 1) / 2.0, i / N % N - (N - 1) / 2.0, i / N / N - (N - 1) / 2.0);
  hl_scene_volume *volume = stage_add_grid(set, (size_t[3]){N, N, N}, (double[3]){1, 1, 1},
                                           (vec3){-N / 2.0, -N / 2.0, -N / 2.0}, voxels);
  set_function(volume, ABOVE_ZERO, 2, GREY, 2);
  return volume;
}

static void open_maximum(stage *set) {
  stage_open(set);
  set->scene.width = set->scene.height = SIDE;
  set->scene.camera.height = 30;
  set->scene.render.compositing = HL_COMPOSITING_MAXIMUM;
  stage_look(set, (vec3){30, -50, 24}, (vec3){0, 0, 0}, (vec3){0, 0, 1});
}

static void look_in_perspective(stage *set) {
  set->scene.camera.type = HL_CAMERA_PERSPECTIVE;
  set->scene.camera.fovy_deg = 30;
}

static void render(stage *set, bool reference, float *pixels) {
  if (reference) stage_render(set, NULL, pixels);
  else stage_render_sheets(set, pixels);
}

/* ---- a ramp: the greatest value is where the ray enters or leaves the box ---- */

static double ramp(double x, double y, double z) { return 0.5 + (x + 2 * y - z) * 0.01; }

/* Sets the points at which the ray enters and leaves the box. Returns false if the ray misses the box. */
static bool ends(const stage *set, int pixel, vec3 low, vec3 high, vec3 end[2]) {
  vec3 origin, direction;
  stage_eye_ray(set, pixel % SIDE, pixel / SIDE, &origin, &direction);
  const double o[3] = {origin.x, origin.y, origin.z}, d[3] = {direction.x, direction.y, direction.z};
  const double from[3] = {low.x, low.y, low.z}, to[3] = {high.x, high.y, high.z};
  double enter = set->scene.camera.type == HL_CAMERA_PERSPECTIVE ? 0 : -INFINITY, leave = INFINITY;
  for (int a = 0; a < 3; a++) {
    double first = (from[a] - o[a]) / d[a], second = (to[a] - o[a]) / d[a];
    enter = fmax(enter, fmin(first, second));
    leave = fmin(leave, fmax(first, second));
  }
  end[0] = vec3_add(origin, vec3_scale(direction, enter));
  end[1] = vec3_add(origin, vec3_scale(direction, leave));
  return enter < leave;
}

/* Clip boxes cut projections. A perspective eye within the box sees only what is before it. Lights do not
 * matter. */
static void test_ramp_in_a_clip_box(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  const vec3 low = {-7, -9, -8}, high = {8, 6.5, 9};
  for (int k = 0; k < 12; k++) {
    stage set;
    open_maximum(&set);
    /* the field is exact away from the borders, where voxels are repeated */
    hl_scene_volume *volume = add_field(&set, ramp);
    volume->clipped = 1;
    memcpy(volume->clip_min, &low, sizeof low);
    memcpy(volume->clip_max, &high, sizeof high);
    volume->shading = k % 2 ? HL_SHADING_PHONG : HL_SHADING_NONE;
    stage_add_directional(&set, (vec3){0.3, 0.8, -1});
    if (k / 2 % 3 > 0) look_in_perspective(&set);
    if (k / 2 % 3 == 2) stage_look(&set, (vec3){1, -3, 2}, (vec3){0, 5, 0}, (vec3){0, 0, 1});
    if (k / 2 % 3 == 2) set.scene.camera.fovy_deg = 80;
    render(&set, k >= 6, pixels);
    int hits = 0;
    for (int i = 0; i < PIXELS; i++) {
      vec3 end[2];
      bool hit = ends(&set, i, low, high, end);
      hits += hit;
      double a = ramp(end[0].x, end[0].y, end[0].z), b = ramp(end[1].x, end[1].y, end[1].z);
      for (int c = 0; c < 3; c++) assert_near((double)pixels[4 * i + c], hit ? fmax(a, b) : 0, 2e-4);
      assert_true(pixels[4 * i + 3] == (hit ? 1.0f : 0.0f));
    }
    assert_true(hits > 100);
    stage_close(&set);
  }
}

/* ---- a blob: the greatest value is where the ray is nearest to its middle ---- */

static double blob(double x, double y, double z) { return exp(-(x * x + y * y + z * z) / 50); }

/* The B-spline widens a blob, by a variance of 1/3 of a voxel. So the blob's values are (v / (v + 1/3))^1.5
 * exp(-r^2 / (2 v + 2/3)) with v = 25 (derived; the neglected terms are below 1e-3). */
static void test_blob(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  const double variance = 25 + 1.0 / 3, peak = pow(25 / variance, 1.5);
  for (int k = 0; k < 8; k++) {
    stage set;
    open_maximum(&set);
    (void)add_field(&set, blob);
    /* a maximum projection takes a sheet distance of more than half a voxel as half a voxel */
    set.scene.render.sheet_spacing = k % 2 ? 2 : 0.25;
    set.scene.render.reconstruction = k / 4 ? HL_RECONSTRUCTION_GATHER : HL_RECONSTRUCTION_SPLAT;
    if (k % 4 == 3) look_in_perspective(&set);
    render(&set, k == 2, pixels);
    for (int i = 0; i < PIXELS; i++) {
      vec3 origin, direction;
      stage_eye_ray(&set, i % SIDE, i / SIDE, &origin, &direction);
      vec3 nearest = vec3_add(origin, vec3_scale(direction, -vec3_dot(origin, direction)));
      double r = vec3_length(nearest);
      if (r < 9) assert_near((double)pixels[4 * i], peak * exp(-r * r / (2 * variance)), 1.5e-3);
    }
    stage_close(&set);
  }
}

/* ---- the values that the transfer function shows ---- */

/* If only a range of values is shown, the pixel has exactly the colour of the greatest value in the range,
 * whatever greater values the ray meets. */
static void test_hidden_values_do_not_count(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  static const hl_opacity_point band[] = {{0.3, 0}, {0.3, 0.5}, {0.6, 0.5}, {0.6, 0}};
  static const hl_color_point color[] = {{0.3, {1, 0, 0.2}}, {0.6, {0, 1, 0.2}}};
  for (int reference = 0; reference < 2; reference++) {
    stage set;
    open_maximum(&set);
    set_function(add_field(&set, blob), band, 4, color, 2);
    render(&set, reference == 1, pixels);
    int inner = 0, between = 0;
    for (int i = 0; i < PIXELS; i++) {
      vec3 origin, direction;
      stage_eye_ray(&set, i % SIDE, i / SIDE, &origin, &direction);
      double r = vec3_length(vec3_add(origin, vec3_scale(direction, -vec3_dot(origin, direction))));
      double greatest = pow(25 / (25 + 1.0 / 3), 1.5) * exp(-r * r / (50 + 2.0 / 3));
      const float *pixel = &pixels[4 * i];
      if (greatest > 0.61) { /* the field passes 0.6 along the ray */
        inner++;
        for (int c = 0; c < 3; c++) assert_near((double)pixel[c], c == 1 ? 1 : c == 2 ? 0.2 : 0, 2e-3);
      } else if (greatest > 0.31 && greatest < 0.59) {
        between++;
        assert_near((double)pixel[1], (greatest - 0.3) / 0.3, 0.01);
        assert_near((double)pixel[0], 1 - (greatest - 0.3) / 0.3, 0.01);
      } else if (greatest < 0.29) {
        assert_true(pixel[3] == 0 && pixel[0] == 0);
      }
    }
    assert_true(inner > 15 && between > 25);
    stage_close(&set);
  }
}

/* Three regions have neighbouring values. A background of the opacity 0 does not show, but the next whole
 * value does. */
static double steps(double x, double y, double z) {
  (void)z;
  return (x < 0 ? 38 : y < 0 ? 39 : 41) / 255.0;
}

static void test_the_background_is_not_shown(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  static const hl_opacity_point rising[] = {{38 / 255.0, 0}, {1, 1}};
  static const hl_voxel_type types[] = {HL_VOXEL_F32, HL_VOXEL_U8, HL_VOXEL_U16};
  for (int k = 0; k < 6; k++) {
    stage set;
    open_maximum(&set);
    set.type = types[k % 3];
    stage_look(&set, (vec3){0, 0, 50}, (vec3){0, 0, 0}, (vec3){0, 1, 0});
    set_function(add_field(&set, steps), rising, 2, GREY, 2);
    render(&set, k >= 3, pixels);
    for (int i = 0; i < PIXELS; i++) {
      vec3 origin, direction;
      stage_eye_ray(&set, i % SIDE, i / SIDE, &origin, &direction);
      if (fabs(origin.x) > 11 || fabs(origin.y) > 11 || fabs(origin.x) < 2.5 || fabs(origin.y) < 2.5)
        continue;
      double value = steps(origin.x, origin.y, 0);
      assert_true(pixels[4 * i + 3] == (value > 38.5 / 255 ? 1.0f : 0.0f));
      assert_near((double)pixels[4 * i], value > 38.5 / 255 ? value : 0, 1e-4);
    }
    stage_close(&set);
  }
}

/* ---- several volumes ---- */

static double shifted_blob(double x, double y, double z) { return blob(x - 4, y + 2, z); }

/* If there are several volumes, each is projected alone. Each channel of a pixel then has the greatest value
 * of all projections. Hidden volumes do not count, and the order of volumes does not matter. */
static void test_several_volumes(void **state) {
  (void)state;
  static float pixels[4][PIXELS * 4];
  static const hl_color_point red[] = {{0, {0, 0.1, 0}}, {1, {1, 0.1, 0}}},
                              green[] = {{0, {0, 0, 0}}, {1, {0.2, 1, 0}}};
  for (int reference = 0; reference < 2; reference++) {
    for (int k = 0; k < 4; k++) { /* the scenes have the first volume, the second volume, both volumes, and
                                     both volumes in the other order */
      stage set;
      open_maximum(&set);
      for (int n = 0; n < 2; n++) {
        bool first = (n == 0) == (k != 3);
        hl_scene_volume *volume = add_field(&set, first ? blob : shifted_blob);
        set_function(volume, ABOVE_ZERO, 2, first ? red : green, 2);
        volume->visible = k >= 2 || k == !first;
      }
      render(&set, reference == 1, pixels[k]);
      stage_close(&set);
    }
    for (int i = 0; i < 4 * PIXELS; i++)
      assert_true(pixels[2][i] == fmaxf(pixels[0][i], pixels[1][i]) && pixels[3][i] == pixels[2][i]);
  }
}

/* ---- noise ---- */

static double noise(double x, double y, double z) {
  uint32_t hash = (uint32_t)(int)(x * 2 + 1000) * 73856093u ^ (uint32_t)(int)(y * 2 + 1000) * 19349663u ^
                  (uint32_t)(int)(z * 2 + 1000) * 83492791u;
  hash = (hash ^ hash >> 13) * 1274126177u;
  return fmax(0.05, (double)((hash ^ hash >> 16) & 0xffff) / 65535);
}

/* The voxels are independent random numbers. The greatest errors are at peaks that lie between sheets. */
static void test_noise_against_the_reference(void **state) {
  (void)state;
  static float sheets[PIXELS * 4], reference[PIXELS * 4];
  static const struct {
    hl_kernel kernel;
    hl_voxel_type type;
    double spacing, rms, greatest;
  } cases[] = {{HL_KERNEL_BSPLINE, HL_VOXEL_F32, 1, 0.003, 0.016},
               {HL_KERNEL_BSPLINE, HL_VOXEL_U8, 1, 0.003, 0.016},
               {HL_KERNEL_BSPLINE, HL_VOXEL_F32, 0.25, 0.0006, 0.004},
               {HL_KERNEL_GAUSSIAN, HL_VOXEL_U16, 1, 0.0045, 0.03},
               {HL_KERNEL_LINEAR, HL_VOXEL_F32, 1, 0.03, 0.15},
               {HL_KERNEL_LINEAR, HL_VOXEL_F32, 0.1, 0.007, 0.07}};
  for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
    stage set;
    open_maximum(&set);
    set.type = cases[n].type;
    (void)add_field(&set, noise);
    set.scene.camera.height = 16;
    set.scene.render.kernel = cases[n].kernel;
    set.scene.render.sheet_spacing = cases[n].spacing;
    render(&set, false, sheets);
    render(&set, true, reference);
    double sum = 0, greatest = 0;
    for (int i = 0; i < 4 * PIXELS; i++) {
      double off = fabs((double)sheets[i] - (double)reference[i]);
      sum += off * off / (4 * PIXELS);
      greatest = fmax(greatest, off);
    }
    print_message("# noise, kernel %d, spacing %g: rms %.5f, greatest %.5f\n", (int)cases[n].kernel,
                  cases[n].spacing, sqrt(sum), greatest);
    assert_true(sqrt(sum) <= cases[n].rms && greatest <= cases[n].greatest);
    stage_close(&set);
  }
}

/* ---- changes that must not change the picture ---- */

static double ridge_height, beside_ridge;

/* For x < 4, a ridge crosses the rays along z at another depth in each row. For x > 4 the field has one
 * value, and a strip of ones gives all fields the same range of values. */
static double ridge(double x, double y, double z) {
  const double off = z - 0.17 * y;
  return x < 4 ? ridge_height * exp(-off * off / 4) : y > 10 ? 1 : beside_ridge;
}

/* The ridge is about as high as the least value that is shown. Between two sheets a ray may meet a greater
 * value than on any sheet. Whether a pixel shows such a value must not depend on whether other pixels of its
 * block show anything. */
static void test_pixels_beside_do_not_matter(void **state) {
  (void)state;
  static float pixels[2][PIXELS * 4];
  static const hl_opacity_point above[] = {{0.4, 0}, {0.4, 1}, {1, 1}};
  int shown = 0, hidden = 0;
  for (int k = 0; k < 24; k++) {
    ridge_height = 0.42 + 0.002 * k;
    for (int bright = 0; bright < 2; bright++) {
      stage set;
      open_maximum(&set);
      stage_look(&set, (vec3){0, 0, 50}, (vec3){0, 0, 0}, (vec3){0, 1, 0});
      beside_ridge = bright;
      set_function(add_field(&set, ridge), above, 3, GREY, 2);
      stage_render_sheets(&set, pixels[bright]);
      stage_close(&set);
    }
    for (int i = 0; i < PIXELS; i++) {
      if (i % SIDE != 12 && i % SIDE != 13)
        continue; /* pixels 14 and 15 of these blocks show the right side */
      assert_memory_equal(&pixels[0][4 * i], &pixels[1][4 * i], 4 * sizeof(float));
      shown += pixels[0][4 * i + 3] > 0;
      hidden += pixels[0][4 * i + 3] == 0;
    }
  }
  assert_true(shown > 100 && hidden > 100);
}

static void test_same_bytes(void **state) {
  (void)state;
  static float first[PIXELS * 4], other[PIXELS * 4];
  static const hl_instruction_set sets[] = {HL_INSTRUCTION_SET_SCALAR, HL_INSTRUCTION_SET_AUTO,
                                            HL_INSTRUCTION_SET_AUTO};
  for (int k = 0; k < 3; k++) {
    hl_context_options options;
    hl_context_options_defaults(&options);
    options.instruction_set = sets[k];
    stage set;
    stage_open_with(&set, &options);
    set.scene.width = set.scene.height = SIDE;
    set.scene.camera.height = 16;
    set.scene.render.compositing = HL_COMPOSITING_MAXIMUM;
    set.scene.render.threads = 1 + 2 * k;
    stage_look(&set, (vec3){30, -50, 24}, (vec3){0, 0, 0}, (vec3){0, 0, 1});
    (void)add_field(&set, noise);
    stage_render_sheets(&set, k == 0 ? first : other);
    if (k > 0) assert_memory_equal(first, other, sizeof first);
    stage_close(&set);
  }
}

static void test_layers_are_refused(void **state) {
  (void)state;
  static float pixels[PIXELS * 4], depth[PIXELS];
  hl_layers layers = {.struct_size = sizeof layers, .depth_first = depth};
  hl_error error = {0};
  hl_scene *scene = NULL;
  hl_renderer *renderer = NULL;
  stage set;
  open_maximum(&set);
  (void)add_field(&set, blob);
  assert_int_equal(hl_scene_create(set.context, &set.scene, &scene, &error), HL_OK);
  assert_int_equal(hl_renderer_create(set.context, &renderer, &error), HL_OK);
  assert_int_equal(hl_renderer_render_layers(renderer, scene, pixels, 4 * SIDE, &layers, NULL, &error),
                   HL_ERROR_UNSUPPORTED);
  assert_int_equal(hl_reference_render_layers(set.context, scene, NULL, pixels, 4 * SIDE, &layers, &error),
                   HL_ERROR_UNSUPPORTED);
  assert_string_equal(
      error.message,
      "/render/compositing: a maximum projection has no layers: use \"light\", or ask for no layers");
  hl_renderer_destroy(renderer);
  hl_scene_release(scene);
  stage_close(&set);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_ramp_in_a_clip_box),
      cmocka_unit_test(test_blob),
      cmocka_unit_test(test_hidden_values_do_not_count),
      cmocka_unit_test(test_the_background_is_not_shown),
      cmocka_unit_test(test_several_volumes),
      cmocka_unit_test(test_noise_against_the_reference),
      cmocka_unit_test(test_pixels_beside_do_not_matter),
      cmocka_unit_test(test_same_bytes),
      cmocka_unit_test(test_layers_are_refused),
  };
  return cmocka_run_group_tests_name("sheets_maximum", tests, NULL, NULL);
}
