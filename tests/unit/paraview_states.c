/* tests/unit/paraview_states.c - two-dimensional functions of ParaView's states (.pvsm): the opacity that
 * their boxes have, where they lie on a volume, and errors. */
#define _GNU_SOURCE
#include <stdio.h>
#include <unistd.h>

#include "scene/function_plane.h"
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

/* Over the length of the unit a box of ParaView with this alpha has the opacity alpha exp(-r^2 / (2 0.3^2)),
 * r from its middle, of its sides; without a volume numbers are the file's. */
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
  /* The mean over a part is that of its points. */
  double mean = 0;
  for (int n = 0; n < 1000; n++) mean += at(&f, 15 + 0.02 * (n + 0.5), 4).extinction / 1000;
  assert_near(hl_plane_mean(&f, &(plane_box){{15, 4}, {35, 4}}).extinction, mean, 1e-4);
  hl_transfer_function_release(context, &f);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* VTK lays the function's range, 100 by 10, over the values, 0 to 40, and over a quarter of their range, 10,
 * per mean voxel edge, 3. */
static void boxes_are_laid_over_the_volume(void **state) {
  (void)state;
  hl_context *context = make_context();
  float voxels[8] = {0, 40};
  const double edges[3] = {1, 2, 6};
  hl_volume_description d;
  hl_volume_description_defaults(&d);
  for (int a = 0; a < 3; a++) d.dimensions[a] = 2, d.axis[a][a] = edges[a];
  d.type = HL_VOXEL_F32;
  d.voxels = voxels;
  hl_volume *volume = NULL;
  hl_transfer_function f = {0};
  assert_int_equal(hl_volume_create(context, &d, &volume, NULL), HL_OK);
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

static void refusals_say_what(void **state) {
  (void)state;
  static const struct {
    const char *text, *message;
  } faults[] = {{STATE(FUNCTION(RANGE) VOLUME(1, 1)), "holds no TransferFunction2D with boxes: add one"},
                {STATE(FUNCTION(BOX(1) RANGE) VOLUME(0, 1)),
                 "no volume uses its function of two numbers: switch on Use 2D Transfer Function"},
                {STATE(FUNCTION(BOX(1) RANGE) VOLUME(1, 0)),
                 "a function of a second array is not supported: choose Gradient Magnitude in ParaView"},
                {STATE(FUNCTION(BOX(1) RANGE) FUNCTION(BOX(1) RANGE) VOLUME(1, 1)),
                 "holds boxes of several functions: keep one of them"},
                {STATE(FUNCTION(BOX(1) RANGE) VOLUME(1, 1) VOLUME(1, 1)),
                 "several volumes use a function of two numbers: keep one"},
                {STATE(FUNCTION(PROPERTY("Boxes", ELEMENT(0, 20)) RANGE) VOLUME(1, 1)),
                 "the function's Boxes or Range are incomplete: save the state anew"}};
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
      cmocka_unit_test(boxes_are_gaussians),
      cmocka_unit_test(boxes_are_laid_over_the_volume),
      cmocka_unit_test(refusals_say_what),
  };
  return cmocka_run_group_tests(tests, make_file, remove_file);
}
