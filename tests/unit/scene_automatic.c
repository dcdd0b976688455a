/* tests/unit/scene_automatic.c - automatic transfer functions, presets, colormaps, default scenes. */
#define _GNU_SOURCE /* mkstemps */
#include <stdio.h>
#include <unistd.h>

#include "guess/analysis.h"
#include "guess/sample.h"
#include "scene/function/transfer_function.h"
#include "scene_parts.h"
#include "text/edit_distance.h"

enum { N = 40 };

static float noise(unsigned *state) { /* 0..1 */
  *state = *state * 1664525u + 1013904223u;
  return (float)(*state >> 8) / 16777216.0f;
}

/* A ball of material 1 with a blurred edge and a core of material 2, in noisy air, as a scanner sees it. */
static void make_ball(float *values, double noisy) {
  unsigned state = 5;
  for (int k = 0, v = 0; k < N; k++)
    for (int j = 0; j < N; j++)
      for (int i = 0; i < N; i++, v++) {
        double r = hypot(hypot(i - 20, j - 19), k - 21);
        double thing = 1 / (1 + exp((r - 12) / 0.7)), core = 1 / (1 + exp((r - 5) / 0.7));
        values[v] = (float)(thing + 1.2 * core + noisy * (double)noise(&state));
      }
}

static hl_volume *scaled_volume(hl_context *context, const float *values, double scale, double offset) {
  hl_volume_description d = describe_voxels(N, N, N, HL_VOXEL_F32, values);
  d.value_scale = scale;
  d.value_offset = offset;
  return create_volume(context, &d);
}

static void assert_ascending(const hl_transfer_function *f) {
  for (size_t p = 1; p < f->opacity_count; p++) assert_true(f->opacity[p].value >= f->opacity[p - 1].value);
  for (size_t p = 1; p < f->color_count; p++) assert_true(f->color[p].value >= f->color[p - 1].value);
}

/* The air is transparent, the ball shows, and its core has another colour. */
static void separates_air_from_things(void **state) {
  (void)state;
  static float values[N * N * N];
  make_ball(values, 0.15);
  hl_context *context = make_context();
  hl_volume *volume = scaled_volume(context, values, 1, 0);
  hl_data_analysis a;
  assert_int_equal(hl_data_analyse(volume, &a, NULL), HL_OK);
  assert_int_equal(a.kind, HL_DATA_SURFACES);
  assert_true(a.background < 0.16 && a.direction == 1 && a.faint > 0.05 && a.faint < 0.6 && a.solid < 1);
  hl_transfer_function f;
  assert_int_equal(hl_transfer_function_automatic(context, volume, &f, NULL), HL_OK);
  assert_ascending(&f);
  assert_true(f.unit_distance == 1);
  assert_true(hl_transfer_function_opacity(&f, 0.14) == 0 && hl_transfer_function_opacity(&f, 1.07) > 0.4);
  double shell[3], core[3];
  hl_transfer_function_color(&f, 1.07, shell);
  hl_transfer_function_color(&f, 2.27, core);
  assert_true(fabs(core[0] - shell[0]) + fabs(core[1] - shell[1]) + fabs(core[2] - shell[2]) > 0.2);
  hl_transfer_function_release(context, &f);
  hl_volume_release(volume);
  hl_context_destroy(context);
}

/* If a volume's values are scaled, shifted and reversed, it gets the same function in its own units. */
static void does_not_depend_on_units(void **state) {
  (void)state;
  static float values[N * N * N];
  make_ball(values, 0.15);
  hl_context *context = make_context();
  const double units[][2] = {{1, 0}, {1000, -400}, {1e-6, 3e-6}, {37, 1e4}, {-1, 0}, {-200, 700}};
  hl_transfer_function first = {0};
  for (size_t u = 0; u < sizeof units / sizeof *units; u++) {
    hl_volume *volume = scaled_volume(context, values, units[u][0], units[u][1]);
    hl_transfer_function f;
    assert_int_equal(hl_transfer_function_automatic(context, volume, &f, NULL), HL_OK);
    assert_ascending(&f);
    if (u == 0) first = f;
    assert_int_equal(f.opacity_count, first.opacity_count);
    for (int n = 0; n <= 200; n++) {
      double value = n * 0.0123, other = units[u][0] * value + units[u][1], a[3], b[3];
      assert_near(hl_transfer_function_opacity(&first, value), hl_transfer_function_opacity(&f, other), 2e-3);
      hl_transfer_function_color(&first, value, a);
      hl_transfer_function_color(&f, other, b);
      for (int c = 0; c < 3; c++) assert_near(a[c], b[c], 2e-3);
    }
    if (u > 0) hl_transfer_function_release(context, &f);
    hl_volume_release(volume);
  }
  hl_transfer_function_release(context, &first);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* Two lobes of different signs, on any value of the background. */
static void signed_fields_show_both_lobes(void **state) {
  (void)state;
  static float values[N * N * N];
  hl_context *context = make_context();
  for (int k = 0, v = 0; k < N; k++)
    for (int j = 0; j < N; j++)
      for (int i = 0; i < N; i++, v++) {
        double r1 = hypot(hypot(i - 12.31, j - 20.17), k - 19.62),
               r2 = hypot(hypot(i - 27.73, j - 19.86), k - 20.41);
        values[v] = (float)(exp(-r1 * r1 / 30) - 0.8 * exp(-r2 * r2 / 30));
      }
  for (int shifted = 0; shifted < 2; shifted++) {
    double offset = shifted ? 5 : 0;
    hl_volume *volume = scaled_volume(context, values, 1, offset);
    hl_data_analysis a;
    hl_transfer_function f;
    assert_int_equal(hl_data_analyse(volume, &a, NULL), HL_OK);
    assert_int_equal(a.kind, HL_DATA_SIGNED);
    assert_int_equal(hl_transfer_function_automatic(context, volume, &f, NULL), HL_OK);
    assert_ascending(&f);
    assert_true(hl_transfer_function_opacity(&f, offset) == 0);
    assert_true(hl_transfer_function_opacity(&f, offset + 0.7) > 0.2 &&
                hl_transfer_function_opacity(&f, offset - 0.7) > 0.2);
    /* each side has a clear shell: it is more opaque than the matter outside of it and within it */
    const double shell = a.faint + 0.35 * (a.solid - a.faint);
    for (int side = -1; side <= 1; side += 2) {
      const double at = hl_transfer_function_opacity(&f, offset + side * shell);
      assert_true(at > 2 * hl_transfer_function_opacity(&f, offset + side * 0.5 * (a.faint + shell)));
      assert_true(at > 2 * hl_transfer_function_opacity(&f, offset + side * 0.5 * (shell + a.solid)));
    }
    double positive[3], negative[3];
    hl_transfer_function_color(&f, offset + 0.7, positive);
    hl_transfer_function_color(&f, offset - 0.7, negative);
    assert_true(positive[0] > positive[2] + 0.2 && negative[2] > negative[0] + 0.2);
    hl_transfer_function_release(context, &f);
    hl_volume_release(volume);
  }
  hl_context_destroy(context);
}

/* The light on the lit border of an even ball, relative to the light on its middle, for light that is
 * scattered once: m / (m + e), with the cosines m and e of the light's and the eye's directions to the border
 * (Lommel and Seeliger). At the border e is 0, and in the middle it is 1. */
static double depth_of_ball(const hl_light *light) {
  const double to_light = -light->direction[2], middle = to_light / (to_light + 1);
  return 1 / fmax(middle, 1e-9);
}

/* A field that falls off smoothly and smoke that is rough but falls off are told apart. Smoke is lit as a
 * medium, from the side, so that the borders of round smoke show. */
static void tells_fields_from_smoke(void **state) {
  (void)state;
  static float values[N * N * N];
  hl_context *context = make_context();
  unsigned seed = 9;
  for (int rough = 0; rough < 2; rough++) {
    for (int k = 0, v = 0; k < N; k++)
      for (int j = 0; j < N; j++)
        for (int i = 0; i < N; i++, v++) {
          double r = hypot(hypot(i - 20, j - 20), k - 20), smooth = fmax(0, exp(-r * r / 60) - 0.02);
          values[v] = (float)(rough ? smooth * (0.2 + 1.6 * (double)noise(&seed)) : smooth);
        }
    hl_volume *volume = scaled_volume(context, values, 1, 0);
    hl_data_analysis a;
    assert_int_equal(hl_data_analyse(volume, &a, NULL), HL_OK);
    assert_int_equal(a.kind, rough ? HL_DATA_MEDIUM : HL_DATA_FIELD);
    hl_scene *scene = NULL;
    assert_int_equal(hl_scene_for_volume(context, volume, NULL, &scene, NULL), HL_OK);
    assert_int_equal(hl_scene_describe(scene)->volumes[0].shading,
                     rough ? HL_SHADING_NONE : HL_SHADING_PHONG);
    if (rough) assert_true(depth_of_ball(&hl_scene_describe(scene)->lights[0]) > 5);
    hl_scene_release(scene);
    hl_volume_release(volume);
  }
  hl_context_destroy(context);
}

/* Grids in which nothing can be told apart, or with hardly any data, still get a scene. */
static void odd_volumes_get_a_scene(void **state) {
  (void)state;
  hl_context *context = make_context();
  float constant = 7, two[2] = {0, 1}, holes[8] = {NAN, 1, INFINITY, 2, NAN, 0, 3, -INFINITY},
        nothing[1] = {NAN};
  const struct {
    float *values;
    size_t n[3];
  } odd[] = {
      {&constant, {1, 1, 1}}, {two, {2, 1, 1}}, {two, {1, 1, 2}}, {holes, {2, 2, 2}}, {nothing, {1, 1, 1}}};
  for (size_t o = 0; o < sizeof odd / sizeof *odd; o++) {
    const size_t *size = odd[o].n;
    hl_volume *volume = volume_of_voxels(context, size[0], size[1], size[2], HL_VOXEL_F32, odd[o].values);
    hl_scene *scene = NULL;
    hl_error error = {0};
    if (hl_scene_for_volume(context, volume, NULL, &scene, &error) != HL_OK)
      fail_msg("%zu: %s", o, error.message);
    for (size_t p = 0; hl_preset_name(p) != NULL; p++) {
      hl_transfer_function f = {0};
      assert_int_equal(hl_transfer_function_preset(context, hl_preset_name(p), volume, &f, NULL), HL_OK);
      assert_ascending(&f);
      hl_transfer_function_release(context, &f);
    }
    hl_scene_release(scene);
    hl_volume_release(volume);
  }
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* If NaN takes the place of air, also on the grid's faces, the rest shows. */
static void nan_may_be_the_air(void **state) {
  (void)state;
  static float values[N * N * N];
  make_ball(values, 0.05);
  for (int v = 0; v < N * N * N; v++)
    if (values[v] < 0.5f) values[v] = NAN;
  hl_context *context = make_context();
  hl_volume *volume = scaled_volume(context, values, 1, 0);
  hl_transfer_function f;
  assert_int_equal(hl_transfer_function_automatic(context, volume, &f, NULL), HL_OK);
  assert_ascending(&f);
  assert_true(hl_transfer_function_opacity(&f, 2.2) > 0.5);
  hl_transfer_function_release(context, &f);
  hl_volume_release(volume);
  static float lonely[N * N * N * 27]; /* one finite voxel lies where a search with gaps does not look */
  for (int v = 0; v < N * N * N * 27; v++) lonely[v] = NAN;
  lonely[3 * N * (3 * N * 3 + 3) + 3] = 1;
  lonely[3 * N * (3 * N * 3 + 3) + 4] = 2;
  hl_scene *scene = NULL;
  volume = volume_of_voxels(context, 3 * N, 3 * N, 3 * N, HL_VOXEL_F32, lonely);
  assert_int_equal(hl_scene_for_volume(context, volume, NULL, &scene, NULL), HL_OK);
  assert_true(hl_transfer_function_opacity(&hl_scene_describe(scene)->volumes[0].transfer_function, 2) > 0);
  hl_scene_release(scene);
  hl_volume_release(volume);
  /* A hundred voxels of a million lie above or below the rest. */
  for (int below = 0; below < 2; below++) {
    for (int v = 0; v < N * N * N * 27; v++) lonely[v] = v % 17389 == 0 ? (below ? -3.0f : 3.0f) : 0.0f;
    volume = volume_of_voxels(context, 3 * N, 3 * N, 3 * N, HL_VOXEL_F32, lonely);
    assert_int_equal(hl_transfer_function_automatic(context, volume, &f, NULL), HL_OK);
    assert_ascending(&f);
    assert_true(hl_transfer_function_opacity(&f, 0) == 0 &&
                hl_transfer_function_opacity(&f, below ? -3 : 3) > 0.5);
    hl_transfer_function_release(context, &f);
    hl_volume_release(volume);
  }
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* A CT in Hounsfield units, and the same CT in 8 bits: bone is in the same places. */
static void ct_presets_adapt(void **state) {
  (void)state;
  static float values[N * N * N];
  hl_context *context = make_context();
  unsigned seed = 1;
  for (int k = 0, v = 0; k < N; k++)
    for (int j = 0; j < N; j++)
      for (int i = 0; i < N; i++, v++) {
        double r = hypot(hypot(i - 20, j - 20), k - 20);
        values[v] = (float)((r < 7 ? 1100 : r < 15 ? 40 : -1000) + 40 * (double)noise(&seed));
      }
  for (int squeezed = 0; squeezed < 2; squeezed++) {
    double scale = squeezed ? 255 / 2200.0 : 1, offset = squeezed ? 1000 * scale : 0;
    hl_volume *volume = scaled_volume(context, values, scale, offset);
    hl_transfer_function f;
    assert_int_equal(hl_transfer_function_preset(context, "ct-bone", volume, &f, NULL), HL_OK);
    assert_true(hl_transfer_function_opacity(&f, scale * 1100 + offset) > 0.8);
    assert_true(hl_transfer_function_opacity(&f, scale * 60 + offset) == 0);
    hl_transfer_function_release(context, &f);
    assert_int_equal(hl_transfer_function_preset(context, "ct-skin", volume, &f, NULL), HL_OK);
    assert_true(hl_transfer_function_opacity(&f, scale * 60 + offset) > 0.8);
    assert_true(hl_transfer_function_opacity(&f, scale * -960 + offset) == 0);
    hl_transfer_function_release(context, &f);
    hl_volume_release(volume);
  }
  hl_transfer_function f = {0};
  hl_error error = {0};
  hl_volume *volume = scaled_volume(context, values, 1, 0);
  assert_int_equal(hl_transfer_function_preset(context, "ct-bones", volume, &f, &error), HL_ERROR_INPUT);
  assert_string_equal(error.message, "unknown preset \"ct-bones\": did you mean \"ct-bone\"?");
  hl_volume_release(volume);
  hl_context_destroy(context);
}

static void colormaps_have_their_published_colors(void **state) {
  (void)state;
  const struct {
    const char *name;
    double t;
    int srgb;
  } published[] = {{"viridis", 0, 0x440154},   {"viridis", 0.5, 0x21918c}, {"viridis", 1, 0xfde725},
                   {"inferno", 0.5, 0xbc3754}, {"magma", 0.5, 0xb73779},   {"plasma", 0.5, 0xcc4778},
                   {"cividis", 1, 0xfee838},   {"coolwarm", 0, 0x3b4cc0},  {"coolwarm", 1, 0xb40426},
                   {"turbo", 0, 0x23171b},     {"grays", 1, 0xffffff},     {"hot", 1, 0xffffff}};
  for (size_t n = 0; n < sizeof published / sizeof *published; n++) {
    double linear[3];
    assert_true(hl_colormap_evaluate(published[n].name, published[n].t, linear));
    for (int c = 0; c < 3; c++) {
      double srgb = (published[n].srgb >> (16 - 8 * c) & 255) / 255.0;
      assert_near(linear[c], hl_srgb_decode(srgb), 0.01);
    }
  }
  double ignored[3];
  assert_false(hl_colormap_evaluate("no such map", 0.5, ignored));
  hl_context *context = make_context();
  hl_transfer_function f = {0};
  assert_int_equal(hl_transfer_function_colormap(context, "viridis", 10, 20, &f, NULL), HL_OK);
  assert_true(f.color[0].value == 10 && f.color[f.color_count - 1].value == 20);
  for (int n = 0; n <= 100; n++) { /* the points stand for the whole colormap */
    double exact[3], line[3];
    hl_colormap_evaluate("viridis", n / 100.0, exact);
    hl_transfer_function_color(&f, 10 + n / 10.0, line);
    for (int c = 0; c < 3; c++) assert_near(exact[c], line[c], 0.004);
  }
  hl_error error = {0};
  assert_int_equal(hl_transfer_function_colormap(context, "virdis", 0, 1, &f, &error), HL_ERROR_INPUT);
  assert_string_equal(error.message, "unknown colormap \"virdis\": did you mean \"viridis\"?");
  assert_int_equal(hl_transfer_function_colormap(context, "hot", 1, 1, &f, NULL), HL_ERROR_INPUT);
  hl_transfer_function_release(context, &f);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

static void names_and_statistics(void **state) {
  (void)state;
  assert_int_equal(hl_edit_distance("", "abc"), 3);
  assert_int_equal(hl_edit_distance("kitten", "sitting"), 3);
  assert_int_equal(hl_edit_distance("ab", "ba"), 1);
  const char *const names[] = {"radius", "direction", NULL};
  assert_string_equal(hl_nearest_name("raduis", names), "radius");
  assert_null(hl_nearest_name("colour", names));
  float values[] = {9, -1, 3.5f, -20, 0, 3.5f, 8, 2}, sorted[] = {-20, -1, 0, 2, 3.5f, 3.5f, 8, 9};
  hl_context *context = make_context();
  assert_true(hl_sort(context, values, 8));
  assert_memory_equal(values, sorted, sizeof values);
  assert_near(hl_quantile(sorted, 8, 0.5), 2.75, 1e-9);
  assert_near(hl_mode(sorted, 8), 3.5, 1e-6);
  assert_int_equal(hl_lattice_step((size_t[3]){10, 10, 10}, 1000), 1);
  assert_int_equal(hl_lattice_step((size_t[3]){100, 100, 100}, 125000), 2);
  assert_true(1e9 / (double)hl_lattice_step((size_t[3]){1, 1000000000, 1}, 1000) <= 1000);
  float two[] = {0, 0, 0, 1, 1, 10, 10, 11};
  assert_near(hl_threshold_otsu(two, 8, -1), 5.5, 1e-6);
  hl_context_destroy(context);
}

static double spacing_of_ball(double softness) {
  static float values[N * N * N];
  for (int k = 0, v = 0; k < N; k++)
    for (int j = 0; j < N; j++)
      for (int i = 0; i < N; i++, v++) {
        double r = hypot(hypot(i - 20, j - 19), k - 21);
        values[v] = (float)(1 / (1 + exp((r - 11) / softness)));
      }
  hl_context *context = make_context();
  hl_volume *volume = scaled_volume(context, values, 1, 0);
  hl_scene *scene = NULL;
  assert_int_equal(hl_scene_for_volume(context, volume, NULL, &scene, NULL), HL_OK);
  double spacing = hl_scene_describe(scene)->render.sheet_spacing;
  hl_scene_release(scene);
  hl_volume_release(volume);
  hl_context_destroy(context);
  return spacing;
}

/* In a small grid, sheets are closer together than a quarter of a voxel if surfaces are thin, and else they
 * are not. */
static void thin_surfaces_of_small_grids_get_more_sheets(void **state) {
  (void)state;
  double thin = spacing_of_ball(0.4), thick = spacing_of_ball(3);
  assert_true(thin >= 0.125 && thin < 0.2);
  assert_true(thick == 0.25);
}

/* The numbers of an atlas's labels are far from each other and from 0. */
static void ids_of_any_size_are_labels(void **state) {
  (void)state;
  enum { N = 24 };
  static uint32_t voxels[N * N * N];
  static hl_data_analysis analysis;
  for (int at = 0; at < N * N * N; at++) {
    const int i = at % N, j = at / N % N, k = at / N / N;
    const bool inside = i >= 4 && i < 20 && j >= 4 && j < 20 && k >= 4 && k < 20;
    voxels[at] = !inside ? 0 : i < 10 ? 614454278 : i < 15 ? 614454277 : 12;
  }
  hl_context *context = make_context();
  hl_volume *map = volume_of_voxels(context, N, N, N, HL_VOXEL_U32, voxels);
  assert_int_equal(hl_data_analyse(map, &analysis, NULL), HL_OK);
  assert_int_equal(hl_data_find_labels(map, &analysis, NULL), HL_OK);
  assert_int_equal(analysis.kind, HL_DATA_LABELS);
  assert_int_equal(analysis.label_count, 3);
  assert_true(analysis.labels[0] == 12 && analysis.labels[1] == 614454277 && analysis.labels[2] == 614454278);
  hl_volume_release(map);
  hl_context_destroy(context);
}

/* Voxels that are repeated, as a scan is enlarged by nearest neighbours, are equal to their neighbours, but
 * they are no labels. A label map that is enlarged in this way is one. */
static void repeated_voxels_are_no_labels(void **state) {
  (void)state;
  enum { N = 12, TIMES = 4, SIDE = N * TIMES };
  static uint8_t voxels[SIDE * SIDE * SIDE];
  for (int labels = 0; labels < 2; labels++) {
    for (int at = 0; at < SIDE * SIDE * SIDE; at++) {
      const int i = at % SIDE / TIMES, j = at / SIDE % SIDE / TIMES, k = at / SIDE / SIDE / TIMES;
      const unsigned noise = (unsigned)(i + N * (j + N * k)) * 2654435761u >> 16;
      const bool inside = i >= 1 && i < 11 && j >= 1 && j < 11 && k >= 1 && k < 11;
      voxels[at] = (uint8_t)(!inside ? 0 : labels ? 1 + i / 5 : 100 + (int)(noise % 60));
    }
    hl_context *context = make_context();
    hl_volume *volume = volume_of_voxels(context, SIDE, SIDE, SIDE, HL_VOXEL_U8, voxels);
    int is_map = -1;
    assert_int_equal(hl_volume_is_label_map(context, volume, &is_map, NULL), HL_OK);
    assert_int_equal(is_map, labels);
    hl_volume_release(volume);
    hl_context_destroy(context);
  }
}

/* A NIfTI file of 300 values, none of which lies in a block, with the intent code. */
static void write_nifti(const char *path, int intent) {
  enum { SIDE = 16, HEADER = 352 };
  static unsigned char bytes[HEADER + 2 * SIDE * SIDE * SIDE];
  const int16_t header[] = {3, SIDE, SIDE, SIDE, 1, 1, 1, 1}, codes[] = {(int16_t)intent, 4, 16};
  const int32_t size = 348;
  const float offset = HEADER, slope = 1;
  memset(bytes, 0, HEADER);
  memcpy(bytes, &size, sizeof size);
  memcpy(bytes + 40, header, sizeof header);
  memcpy(bytes + 68, codes, sizeof codes);
  memcpy(bytes + 108, &offset, sizeof offset);
  memcpy(bytes + 112, &slope, sizeof slope);
  memcpy(bytes + 344, "n+1", 4);
  for (int n = 0; n < SIDE * SIDE * SIDE; n++) {
    const int16_t value = (int16_t)(n % 3 == 0 ? 0 : (unsigned)n * 2654435761u % 300);
    memcpy(bytes + HEADER + 2 * n, &value, sizeof value);
  }
  FILE *file = fopen(path, "wb");
  assert_non_null(file);
  assert_int_equal(fwrite(bytes, 1, sizeof bytes, file), sizeof bytes);
  assert_int_equal(fclose(file), 0);
}

/* The intent code for labels makes a label map of values that would not be taken for one, however many there
 * are. */
static void files_say_that_they_hold_labels(void **state) {
  (void)state;
  char path[] = "/tmp/halflight-labels-XXXXXX.nii";
  const int made = mkstemps(path, 4);
  assert_true(made >= 0);
  close(made);
  for (int labels = 0; labels < 2; labels++) {
    write_nifti(path, labels ? 1002 : 0);
    hl_context *context = make_context();
    hl_volume *volume = NULL;
    int is_map = -1;
    assert_int_equal(hl_volume_load(context, path, &volume, NULL), HL_OK);
    assert_int_equal(hl_volume_is_label_map(context, volume, &is_map, NULL), HL_OK);
    assert_int_equal(is_map, labels);
    hl_volume_release(volume);
    hl_context_destroy(context);
  }
  assert_int_equal(remove(path), 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(separates_air_from_things),
      cmocka_unit_test(does_not_depend_on_units),
      cmocka_unit_test(signed_fields_show_both_lobes),
      cmocka_unit_test(tells_fields_from_smoke),
      cmocka_unit_test(odd_volumes_get_a_scene),
      cmocka_unit_test(nan_may_be_the_air),
      cmocka_unit_test(ct_presets_adapt),
      cmocka_unit_test(colormaps_have_their_published_colors),
      cmocka_unit_test(names_and_statistics),
      cmocka_unit_test(ids_of_any_size_are_labels),
      cmocka_unit_test(repeated_voxels_are_no_labels),
      cmocka_unit_test(files_say_that_they_hold_labels),
      cmocka_unit_test(thin_surfaces_of_small_grids_get_more_sheets),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
