/* tests/unit/scene_ranges.c - percentiles of volumes, and transfer functions that are spread over ranges,
 * evenly or by logarithms. */
#include "guess/function_writer.h"
#include "scene/function/transfer_function.h"
#include "scene_parts.h"

enum { N = 20, COUNT = N * N * N };

static hl_volume *volume_of(hl_context *context, hl_voxel_type type, const void *voxels, double scale) {
  hl_volume_description d = describe_voxels(N, N, N, type, voxels);
  d.value_scale = scale;
  d.value_offset = 7;
  return create_volume(context, &d);
}

static double percentile_of(const hl_volume *volume, double percent) {
  double value = NAN;
  assert_int_equal(hl_volume_percentiles(volume, &percent, 1, &value, NULL), HL_OK);
  return value;
}

/* The numbers 0 to COUNT - 1 in mixed order (7919 and COUNT have no common factor). */
static unsigned mixed(unsigned n) { return n * 7919u % COUNT; }

/* For the numbers from 0 to n - 1, percentile p is p (n - 1) / 100, in whatever order and type they are
 * stored. */
static void percentiles_of_a_ramp(void **state) {
  (void)state;
  static uint16_t whole[COUNT];
  static float real[COUNT];
  for (unsigned n = 0; n < COUNT; n++) {
    whole[n] = (uint16_t)mixed(n);
    real[n] = ((float)mixed(n) - 1000) * 0.25f; /* of both signs */
  }
  hl_context *context = make_context();
  hl_volume *volumes[3] = {volume_of(context, HL_VOXEL_U16, whole, 2),
                           volume_of(context, HL_VOXEL_F32, real, 2),
                           volume_of(context, HL_VOXEL_F32, real, -2)};
  for (double percent = 0; percent <= 100; percent += 0.8) {
    double rank = percent / 100 * (COUNT - 1), other = COUNT - 1 - rank;
    assert_near(percentile_of(volumes[0], percent), 2 * rank + 7, 1e-8);
    assert_near(percentile_of(volumes[1], percent), 2 * 0.25 * (rank - 1000) + 7, 1e-8);
    assert_near(percentile_of(volumes[2], percent), -2 * 0.25 * (other - 1000) + 7, 1e-8);
  }
  for (int v = 0; v < 3; v++) hl_volume_release(volumes[v]);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* Voxels that are not finite do not count. If a volume has only such voxels, all its percentiles are 0. */
static void only_finite_voxels_count(void **state) {
  (void)state;
  static float values[COUNT];
  for (unsigned n = 0; n < COUNT; n++)
    values[n] = n % 2 != 0 ? (n % 4 == 1 ? NAN : INFINITY) : (float)(n / 2);
  hl_context *context = make_context();
  hl_volume *volume = volume_of(context, HL_VOXEL_F32, values, 1);
  assert_near(percentile_of(volume, 50), 0.5 * (COUNT / 2.0 - 1) + 7, 1e-9);
  hl_volume_release(volume);
  for (unsigned n = 0; n < COUNT; n++) values[n] = NAN;
  volume = volume_of(context, HL_VOXEL_F32, values, 1);
  assert_near(percentile_of(volume, 50), 0, 0);
  double beyond = 101, value;
  hl_error error = {0};
  assert_int_equal(hl_volume_percentiles(volume, &beyond, 1, &value, &error), HL_ERROR_INPUT);
  assert_string_equal(error.message, "percentile 101 is out of range: give 0 to 100");
  hl_volume_release(volume);
  hl_context_destroy(context);
}

/* A colormap over the range from 1 to 10^6 by logarithms. The value v has the colour at log10(v) / 6, as
 * exactly as in an even colormap. */
static void colormap_by_logarithms(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_transfer_function f = {0};
  const double range[2] = {1, 1e6};
  assert_int_equal(hl_transfer_function_colormap_scaled(context, "viridis", range, HL_RANGE_LOG, &f, NULL),
                   HL_OK);
  for (double exponent = 0; exponent <= 6; exponent += 0.01) {
    double exact[3], line[3];
    hl_colormap_evaluate("viridis", exponent / 6, exact);
    hl_transfer_function_color(&f, pow(10, exponent), line);
    for (int c = 0; c < 3; c++) assert_near(exact[c], line[c], 0.004);
  }
  assert_true(f.color[0].value == 1 && f.color[f.color_count - 1].value == 1e6);
  const double refused[2] = {0, 10};
  hl_error error = {0};
  assert_int_equal(hl_transfer_function_colormap_scaled(context, "hot", refused, HL_RANGE_LOG, &f, &error),
                   HL_ERROR_INPUT);
  assert_string_equal(error.message,
                      "a logarithmic range must begin above 0, and 0 to 10 does not: give a range such as "
                      "0.01 to 10, or the linear scale");
  hl_transfer_function_release(context, &f);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* A ramp from 10 to 20 with a step at 15. By logarithms over 1 to 100, the step is at 10 = sqrt(1 * 100), the
 * value v has what was at 10 + 10 log(v) / log(100), and the ends hold beyond the range. */
static void points_by_logarithms(void **state) {
  (void)state;
  hl_opacity_point opacity[] = {{0, 0}, {10, 0.1}, {15, 0.3}, {15, 0.6}, {30, 0.9}}, gradient[] = {{5, 1}};
  hl_color_point color[] = {{12, {0, 0, 0}}, {17, {1, 0.5, 0}}};
  const hl_transfer_function from = {.unit_distance = 3,
                                     .opacity = opacity,
                                     .opacity_count = 5,
                                     .color = color,
                                     .color_count = 2,
                                     .gradient_opacity = gradient,
                                     .gradient_opacity_count = 1};
  const double old[2] = {10, 20}, range[2] = {1, 100};
  hl_transfer_function to;
  hl_context *context = make_context();
  assert_int_equal(hl_transfer_function_spread(context, &from, old, range, HL_RANGE_LOG, &to, NULL), HL_OK);
  assert_true(to.unit_distance == 3 && to.gradient_opacity[0].value == 5 * 9.9);
  for (double t = 0; t <= 1; t += 1.0 / 256) {
    double value = pow(100, t), was = 10 + 10 * t, colors[2][3];
    if (t != 0.5)
      assert_near(hl_transfer_function_opacity(&to, value), hl_transfer_function_opacity(&from, was), 1e-3);
    hl_transfer_function_color(&to, value, colors[0]);
    hl_transfer_function_color(&from, was, colors[1]);
    for (int c = 0; c < 3; c++) assert_near(colors[0][c], colors[1][c], 1e-3);
  }
  assert_near(hl_transfer_function_opacity(&to, 10 - 1e-9), 0.3, 1e-6);
  assert_near(hl_transfer_function_opacity(&to, 10 + 1e-9), 0.6, 1e-6);
  assert_near(hl_transfer_function_opacity(&to, 1e9), 0.7, 1e-12);
  assert_near(hl_transfer_function_opacity(&to, 0), 0.1, 1e-12);
  hl_transfer_function_release(context, &to);
  assert_int_equal(hl_transfer_function_spread(context, &from, old, range, HL_RANGE_LINEAR, &to, NULL),
                   HL_OK);
  assert_true(to.opacity_count == 5 && to.opacity[0].value == 1 - 99 && to.opacity[2].value == 50.5);
  hl_transfer_function_release(context, &to);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

static double opacity_at(const hl_transfer_function *function, double value) {
  return hl_transfer_function_opacity(function, value);
}

/* An opacity between 300 and 1000, of values from 0 to 1000, moves to the ends of a range, but not to an end
 * that chooses no values. */
static void clear_surroundings_stay_clear(void **state) {
  (void)state;
  static float values[COUNT];
  for (unsigned n = 0; n < COUNT; n++) values[n] = 1000 * (float)n / (COUNT - 1) - 7;
  hl_opacity_point opacity[] = {{300, 0}, {500, 0.4}, {900, 0.8}};
  hl_color_point color[] = {{300, {0, 0, 0}}, {1000, {1, 1, 1}}};
  const hl_transfer_function from = {
      .unit_distance = 1, .opacity = opacity, .opacity_count = 3, .color = color, .color_count = 2};
  /* `range` chooses all values, from 0 to 1000. `value` is the place at which the opacity is what `from` has
   * at `was`. */
  static const struct {
    double range[2];
    hl_spread_use use;
    double value, was;
  } cases[] = {
      {{100, 1000}, HL_SPREAD_ALONE, 100, 300},    /* a lower end shows fainter matter */
      {{100, 1000}, HL_SPREAD_COLORMAP, 300, 300}, /* a colormap begins there */
      {{0, 1000}, HL_SPREAD_ALONE, 300, 300},      /* the range of all values chooses no values */
      {{-1000, 1000}, HL_SPREAD_ALONE, -400, 300}, /* values of other files are less */
      {{0, 4000}, HL_SPREAD_COLORMAP, 1200, 300},  /* values of other files are greater */
      {{600, 1000}, HL_SPREAD_COLORMAP, 600, 300}, /* a higher end hides matter */
      {{600, 800}, HL_SPREAD_COLORMAP, 800, 1000}, /* and a lower upper end shows more of it as opaque */
      {{0, 1000}, HL_SPREAD_PROJECTION, 0, 300},   /* the colours of a projection fill the range */
  };
  hl_context *context = make_context();
  hl_volume *volume = volume_of(context, HL_VOXEL_F32, values, 1);
  for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
    hl_transfer_function to;
    assert_int_equal(hl_transfer_function_spread_over(context, volume, &from, cases[n].range, HL_RANGE_LINEAR,
                                                      cases[n].use, &to, NULL),
                     HL_OK);
    const double width = cases[n].range[1] - cases[n].range[0];
    assert_near(opacity_at(&to, cases[n].value), opacity_at(&from, cases[n].was), 1e-3);
    if (cases[n].was == 300) {
      assert_true(opacity_at(&to, cases[n].value) < 1e-3);
      assert_true(opacity_at(&to, cases[n].value + 0.1 * width) > 0.01);
    }
    for (int end = 0; end < 2; end++) assert_near(to.color[end].value, cases[n].range[end], 1e-9);
    hl_transfer_function_release(context, &to);
  }
  hl_volume_release(volume);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* A function that shows both sides of clear values, over a range on one side of them: values before the range
 * are clear, and opacity rises from its inner end on. Over a range with the clear values in it both sides
 * stay. */
static void one_side_of_a_signed_field(void **state) {
  (void)state;
  static float values[COUNT];
  for (unsigned n = 0; n < COUNT; n++) values[n] = (float)mixed(n) / (COUNT - 1) * 20 - 10 - 7;
  hl_opacity_point opacity[] = {{-8, 0.75}, {-4, 0.5}, {-1, 0}, {1, 0}, {4, 0.5}, {8, 0.75}};
  hl_color_point color[] = {{-8, {0, 0, 1}}, {8, {1, 0, 0}}};
  const hl_transfer_function from = {
      .unit_distance = 1, .opacity = opacity, .opacity_count = 6, .color = color, .color_count = 2};
  static const struct {
    double range[2], clear[2], seen[2];
  } cases[] =
      {
          {{2.5, 7}, {-10, 2.5}, {3, 10}},   {{-7, -2.5}, {-2.5, 10}, {-10, -3}},
          {{-7, 7}, {-0.5, 0.5}, {2, 10}},   {{-7, 7}, {-0.5, 0.5}, {-10, -2}},
          {{-4, 9}, {-0.3, 0.3}, {2, 10}}, /* the background stays in the clear values */
          {{-4, 9}, {-0.3, 0.3}, {-10, -2}},
      };
  hl_context *context = make_context();
  hl_volume *volume = volume_of(context, HL_VOXEL_F32, values, 1);
  for (size_t n = 0; n < 2 * sizeof cases / sizeof *cases; n++) {
    const hl_spread_use use = n % 2 == 0 ? HL_SPREAD_ALONE : HL_SPREAD_COLORMAP;
    const double *clear = cases[n / 2].clear, *seen = cases[n / 2].seen;
    hl_transfer_function to;
    assert_int_equal(hl_transfer_function_spread_over(context, volume, &from, cases[n / 2].range,
                                                      HL_RANGE_LINEAR, use, &to, NULL),
                     HL_OK);
    for (int part = 0; part <= 20; part++) {
      assert_true(opacity_at(&to, clear[0] + part * (clear[1] - clear[0]) / 20) == 0);
      assert_true(opacity_at(&to, seen[0] + part * (seen[1] - seen[0]) / 20) > 0);
    }
    hl_transfer_function_release(context, &to);
  }
  hl_volume_release(volume);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* Of a volume with one value, all ranges are allowed. */
static void range_of_one_value(void **state) {
  (void)state;
  static float values[COUNT];
  for (unsigned n = 0; n < COUNT; n++) values[n] = 5;
  hl_opacity_point opacity[] = {{0, 0}, {1, 1}};
  const hl_transfer_function from = {.unit_distance = 1, .opacity = opacity, .opacity_count = 2};
  const double range[2] = {2, 30};
  hl_context *context = make_context();
  hl_volume *volume = volume_of(context, HL_VOXEL_F32, values, 1);
  hl_transfer_function to;
  assert_int_equal(hl_transfer_function_spread_over(context, volume, &from, range, HL_RANGE_LINEAR,
                                                    HL_SPREAD_COLORMAP, &to, NULL),
                   HL_OK);
  assert_true(to.opacity[0].value == 2 && to.opacity[1].value == 30);
  hl_transfer_function_release(context, &to);
  hl_volume_release(volume);
  hl_context_destroy(context);
}

/* If two parts of a colormap meet at a number, the points rise, however the numbers are rounded. */
static void parts_of_a_colormap_meet(void **state) {
  (void)state;
  const hl_data_analysis analysis = {.background = 0, .direction = 1};
  for (int n = 1; n < 10000; n++) {
    hl_function_writer writer = {.analysis = &analysis, .direction = 1};
    const double begin = n / 7919.0, middle = 3 * begin + n / 6007.0;
    hl_add_colormap(&writer, "plasma", begin, middle, 0.2, 0.8);
    hl_add_colormap(&writer, "plasma", middle, 2 * middle, 0.8, 0.95);
    for (size_t c = 1; c < writer.color_count; c++)
      assert_true(writer.color[c].value >= writer.color[c - 1].value);
  }
}

/* The greatest difference of a function with a peak or a step has a closed form. For a function of many
 * points it is found by trying. */
static void opacities_of_near_values(void **state) {
  (void)state;
  static const hl_opacity_point peak[] = {{0, 0}, {1, 0.8}, {3, 0}}, step[] = {{2, 0.1}, {2, 0.7}};
  hl_transfer_function function = {.opacity = peak, .opacity_count = 3};
  assert_near(hl_transfer_function_opacity_change(&function, 0), 0, 0);
  assert_near(hl_transfer_function_opacity_change(&function, 0.25), 0.2, 1e-12);
  assert_near(hl_transfer_function_opacity_change(&function, 5), 0.8, 1e-12);
  assert_true(isnan(hl_transfer_function_opacity_change(&function, NAN)));
  function = (hl_transfer_function){.opacity = step, .opacity_count = 2};
  assert_near(hl_transfer_function_opacity_change(&function, 1e-9), 0.6, 1e-12);
  enum { POINTS = 12, TRIALS = 2000 };
  hl_opacity_point many[POINTS];
  for (unsigned n = 0; n < POINTS; n++)
    many[n] = (hl_opacity_point){n + mixed(n) / (double)COUNT, mixed(3 * n + 1) / (double)COUNT};
  function = (hl_transfer_function){.opacity = many, .opacity_count = POINTS};
  for (double reach = 0.05; reach < 8; reach *= 1.7) {
    double most = 0;
    for (int a = 0; a < TRIALS; a++)
      for (int b = -20; b <= 20; b++) {
        const double value = POINTS * (double)a / TRIALS, other = value + reach * b / 20;
        most = fmax(most, fabs(hl_transfer_function_opacity(&function, value) -
                               hl_transfer_function_opacity(&function, other)));
      }
    const double found = hl_transfer_function_opacity_change(&function, reach);
    assert_true(most <= found + 1e-12 && most > 0.97 * found);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(percentiles_of_a_ramp),         cmocka_unit_test(only_finite_voxels_count),
      cmocka_unit_test(clear_surroundings_stay_clear), cmocka_unit_test(range_of_one_value),
      cmocka_unit_test(one_side_of_a_signed_field),    cmocka_unit_test(colormap_by_logarithms),
      cmocka_unit_test(points_by_logarithms),          cmocka_unit_test(parts_of_a_colormap_meet),
      cmocka_unit_test(opacities_of_near_values),
  };
  return cmocka_run_group_tests_name("scene_ranges", tests, NULL, NULL);
}
