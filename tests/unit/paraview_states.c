/* tests/unit/paraview_states.c - transfer functions from ParaView's states (.pvsm): colours and opacities,
 * the opacity of boxes, their places on a volume, and errors. */
#define _GNU_SOURCE
#include <stdio.h>
#include <unistd.h>

#include "scene/function/function_plane.h"
#include "scene_parts.h"

static char path[] = "/tmp/halflight-state-XXXXXX.pvsm";

static int make_file(void **state) {
  (void)state;
  int descriptor = mkstemps(path, 5);
  return descriptor < 0 ? -1 : close(descriptor);
}

static int remove_file(void **state) {
  (void)state;
  return unlink(path);
}

#define ELEMENT(index, value)   "<Element index=\"" #index "\" value=\"" #value "\"/>"
#define PROPERTY(name, content) "<Property name=\"" name "\">" content "</Property>"
#define BOX(alpha)                                                                                          \
  PROPERTY("Boxes", ELEMENT(0, 20) ELEMENT(1, 2) ELEMENT(2, 40) ELEMENT(3, 4) ELEMENT(4, 1) ELEMENT(5, 0.5) \
                        ELEMENT(6, 0) ELEMENT(7, alpha))
#define RANGE PROPERTY("Range", ELEMENT(0, 0) ELEMENT(1, 100) ELEMENT(2, 0) ELEMENT(3, 10))
#define FUNCTION(content) \
  "<Proxy group=\"transfer_2d_functions\" type=\"TransferFunction2D\">" content "</Proxy>"
#define VOLUME(uses, by_gradient)                                                             \
  "<Proxy group=\"representations\" type=\"UniformGridRepresentation\">" PROPERTY(            \
      "ScalarOpacityUnitDistance", ELEMENT(0, 2)) PROPERTY("UseTransfer2D", ELEMENT(0, uses)) \
      PROPERTY("UseGradientForTransfer2D", ELEMENT(0, by_gradient)) "</Proxy>"
#define STATE(content) "<ParaView><ServerManagerState>" content "</ServerManagerState></ParaView>"

static hl_status load(hl_context *context, const char *text, const hl_volume *volume, hl_transfer_function *f,
                      hl_error *error) {
  FILE *file = fopen(path, "wb");
  assert_non_null(file);
  fputs(text, file);
  fclose(file);
  return hl_transfer_function_load_for(context, path, volume, f, error);
}

static plane_sum at(const hl_transfer_function *f, double value, double second) {
  return hl_plane_mean(f, &(plane_box){{value, second}, {value, second}});
}

/* Over the unit of length, a box of ParaView with the opacity alpha has alpha exp(-r^2 / (2 0.3^2)), where r
 * is the distance from its middle in its sides. Without a volume, the numbers of the file are kept. */
static void boxes_are_gaussians(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_transfer_function f = {0};
  const double alpha = 0.6;
  assert_int_equal(load(context, STATE(FUNCTION(BOX(0.6) RANGE) VOLUME(1, 1)), NULL, &f, NULL), HL_OK);
  assert_int_equal(f.plane.second, HL_SECOND_GRADIENT);
  assert_true(f.unit_distance == 2);
  for (double u = 0.01; u < 1; u += 0.07)
    for (double v = 0.01; v < 1; v += 0.07) {
      plane_sum sum = at(&f, 20 + 40 * u, 2 + 4 * v);
      double r = (u - 0.5) * (u - 0.5) + (v - 0.5) * (v - 0.5);
      assert_near(1 - exp(-2 * sum.extinction), alpha * exp(-r / 0.18), 0.01);
      assert_near(sum.color[1], sum.extinction * hl_srgb_decode(0.5), 1e-9);
    }
  assert_true(at(&f, 19.9, 4).extinction == 0 && at(&f, 40, 6.1).extinction == 0);
  /* The mean of the function over a range of both numbers is the mean over the points of the range. */
  double mean = 0;
  for (int n = 0; n < 1000; n++) mean += at(&f, 15 + 0.02 * (n + 0.5), 4).extinction / 1000;
  assert_near(hl_plane_mean(&f, &(plane_box){{15, 4}, {35, 4}}).extinction, mean, 1e-4);
  hl_transfer_function_release(context, &f);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* VTK lays the function's range, 100 by 10, over the values, 0 to 40, and over a quarter of their range, 10,
 * for each mean edge of a voxel, 3. */
static void boxes_are_laid_over_the_volume(void **state) {
  (void)state;
  hl_context *context = make_context();
  float voxels[8] = {0, 40};
  const double edges[3] = {1, 2, 6};
  hl_volume_description d = describe_voxels(2, 2, 2, HL_VOXEL_F32, voxels);
  for (int a = 0; a < 3; a++) d.axis[a][a] = edges[a];
  hl_volume *volume = create_volume(context, &d);
  hl_transfer_function f = {0};
  assert_int_equal(load(context, STATE(FUNCTION(BOX(0.6) RANGE) VOLUME(1, 1)), volume, &f, NULL), HL_OK);
  plane_box bounds;
  assert_true(hl_plane_bounds(&f.plane, &bounds));
  assert_near(bounds.low[0], 8, 1e-9);
  assert_near(bounds.high[0], 24, 1e-9);
  assert_near(bounds.low[1], 2.0 / 3, 1e-9);
  assert_near(bounds.high[1], 2, 1e-9);
  hl_transfer_function_release(context, &f);
  hl_volume_release(volume);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* A state that ParaView 5.11.0 saved of a volume with one array, without its other parts: the colours and
 * opacities at some values. ParaView has 256 colours of 8 bits, so that they jump by up to 0.012. */
static void states_of_one_number(void **state) {
  (void)state;
  static const struct {
    double value, color[3], opacity;
  } expected[] = {{0, {0.00000, 0.00000, 1.00000}, 0.00000},   {20, {0.00000, 0.00000, 1.00000}, 0.00000},
                  {45, {0.07451, 0.56863, 0.93725}, 0.00000},  {60, {0.11373, 0.83529, 0.90196}, 0.00000},
                  {90, {0.18039, 0.82745, 0.43922}, 0.10000},  {100, {0.20000, 0.80000, 0.30196}, 0.20000},
                  {110, {0.18824, 0.81569, 0.48627}, 0.30000}, {130, {0.16078, 0.80392, 0.85098}, 0.40005},
                  {160, {0.11373, 0.11373, 0.90196}, 0.84296}, {200, {0.96863, 0.03922, 0.77647}, 0.89998},
                  {220, {1.00000, 0.00000, 0.20000}, 0.90000}, {250, {1.00000, 0.00000, 0.20000}, 0.90000}};
  hl_context *context = make_context();
  hl_transfer_function f = {0};
  hl_error error = {0};
  const char *file = HALFLIGHT_SOURCE "/tests/unit/paraview-points.pvsm";
  if (hl_transfer_function_load_for(context, file, NULL, &f, &error) != HL_OK) fail_msg("%s", error.message);
  assert_true(f.unit_distance == 2.5);
  for (size_t n = 0; n < sizeof expected / sizeof *expected; n++) {
    double linear[3];
    hl_transfer_function_color(&f, expected[n].value, linear);
    for (int c = 0; c < 3; c++)
      assert_true(linear[c] >= hl_srgb_decode(fmax(expected[n].color[c] - 0.018, 0)) &&
                  linear[c] <= hl_srgb_decode(fmin(expected[n].color[c] + 0.018, 1)));
    assert_near(hl_transfer_function_opacity(&f, expected[n].value), expected[n].opacity, 0.01);
  }
  hl_transfer_function_release(context, &f);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* The same state with a transfer function of boxes. */
static void states_of_two_numbers(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_transfer_function f = {0};
  const char *file = HALFLIGHT_SOURCE "/tests/unit/paraview-boxes.pvsm";
  assert_int_equal(hl_transfer_function_load_for(context, file, NULL, &f, NULL), HL_OK);
  assert_int_equal(f.plane.second, HL_SECOND_GRADIENT);
  assert_true(f.unit_distance == 2.5);
  assert_near(1 - exp(-2.5 * at(&f, 100, 11).extinction), 0.6, 0.01);
  assert_near(1 - exp(-2.5 * at(&f, 190, 2.5).extinction), 0.3 * exp(-0.45 * 0.45 / 0.18), 0.01);
  hl_transfer_function_release(context, &f);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

#define NAMED(id) "<Proxy value=\"" #id "\"/>"
#define SHOWN(more)                                                                \
  "<Proxy group=\"representations\" type=\"UniformGridRepresentation\">" PROPERTY( \
      "Representation", ELEMENT(0, Volume)) PROPERTY("LookupTable", NAMED(7))      \
      PROPERTY("ScalarOpacityFunction", NAMED(8) "<Domain name=\"d\">" NAMED(9) "</Domain>") more "</Proxy>"
#define COLORS(more)                                                          \
  "<Proxy group=\"lookup_tables\" type=\"PVLookupTable\" id=\"7\">" PROPERTY( \
      "RGBPoints", ELEMENT(0, 0) ELEMENT(1, 1) ELEMENT(2, 0) ELEMENT(3, 0)) more "</Proxy>"
#define OPACITIES                                                                       \
  "<Proxy group=\"piecewise_functions\" type=\"PiecewiseFunction\" id=\"8\">" PROPERTY( \
      "Points", ELEMENT(0, 0) ELEMENT(1, 0.25) ELEMENT(2, 0.5) ELEMENT(3, 0)) "</Proxy>"
#define HIDDEN PROPERTY("Visibility", ELEMENT(0, 0))

/* If a state has several volumes, the visible one counts, wherever its functions stand in the file. */
static void hidden_volumes_do_not_count(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_transfer_function f = {0};
  const char *text = STATE(SHOWN(HIDDEN) OPACITIES SHOWN("") COLORS("") VOLUME(0, 1));
  assert_int_equal(load(context, text, NULL, &f, NULL), HL_OK);
  assert_true(hl_transfer_function_opacity(&f, 3) == 0.25 && f.unit_distance == 1);
  hl_transfer_function_release(context, &f);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

static void refusals_say_what(void **state) {
  (void)state;
  static const struct {
    const char *text, *message;
  } faults[] = {
      {STATE(FUNCTION(RANGE) VOLUME(1, 1)), "holds no TransferFunction2D with boxes: add one"},
      {STATE(FUNCTION(BOX(1) RANGE) VOLUME(0, 1)),
       "no volume uses its function of two numbers: switch on Use 2D Transfer Function"},
      {STATE(FUNCTION(BOX(1) RANGE) VOLUME(1, 0)),
       "a function of a second array is not supported: choose Gradient Magnitude in ParaView"},
      {STATE(FUNCTION(BOX(1) RANGE) FUNCTION(BOX(1) RANGE) VOLUME(1, 1)),
       "holds boxes of several functions: keep one of them"},
      {STATE(FUNCTION(BOX(1) RANGE) VOLUME(1, 1) VOLUME(1, 1)),
       "several volumes use a function of two numbers: keep one"},
      {STATE(FUNCTION(PROPERTY("Boxes", ELEMENT(0, 20)) RANGE) VOLUME(1, 1)),
       "the function's Boxes or Range are incomplete: save the state anew"},
      {STATE(COLORS("") OPACITIES SHOWN(HIDDEN)),
       "shows no volume: choose the representation Volume in ParaView"},
      {STATE(COLORS("") OPACITIES SHOWN("") SHOWN("")), "shows several volumes: hide all but one"},
      {STATE(FUNCTION(BOX(1) RANGE) VOLUME(1, 1) COLORS("") OPACITIES SHOWN("")),
       "shows several volumes: hide all but one"},
      {STATE(COLORS("") SHOWN("")),
       "the colours or opacities of its volume are missing: save the state anew"},
      {STATE(COLORS("") OPACITIES SHOWN(PROPERTY("UseSeparateOpacityArray", ELEMENT(0, 1)))),
       "opacity by another array is not supported: switch off Use Separate Opacity Array"},
      {STATE(COLORS(PROPERTY("IndexedLookup", ELEMENT(0, 1))) OPACITIES SHOWN("")),
       "colours of categories are not supported: switch off Interpret Values As Categories"},
      {STATE(COLORS(PROPERTY("UseAboveRangeColor", ELEMENT(0, 1))) OPACITIES SHOWN("")),
       "colours below and above the range are not supported: switch them off"},
      {STATE(COLORS(PROPERTY("UseLogScale", ELEMENT(0, 1))) OPACITIES SHOWN("")),
       "/UseLogScale: logarithmic colour maps are not supported: save the map with a linear scale"},
      {STATE(COLORS(PROPERTY("ColorSpace", ELEMENT(0, 4))) OPACITIES SHOWN("")),
       "/ColorSpace: \"Lab/CIEDE2000\" is no known choice: use one of RGB, HSV, Lab, Diverging, Step"}};
  hl_context *context = make_context();
  for (size_t n = 0; n < sizeof faults / sizeof *faults; n++) {
    hl_transfer_function f = {0};
    hl_error error = {0};
    assert_true(load(context, faults[n].text, NULL, &f, &error) != HL_OK);
    assert_non_null(strstr(error.message, faults[n].message));
    assert_int_equal(hl_context_memory_held(context), 0);
  }
  hl_context_destroy(context);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(boxes_are_gaussians),         cmocka_unit_test(boxes_are_laid_over_the_volume),
      cmocka_unit_test(states_of_one_number),        cmocka_unit_test(states_of_two_numbers),
      cmocka_unit_test(hidden_volumes_do_not_count), cmocka_unit_test(refusals_say_what),
  };
  return cmocka_run_group_tests(tests, make_file, remove_file);
}
