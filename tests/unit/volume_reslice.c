/* tests/unit/volume_reslice.c - planes of voxels are exact at the voxels' centres and linear between them,
 * thick if asked, at any angle, and refused if their numbers are impossible. */
#define _GNU_SOURCE
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <halflight/halflight.h>

#include "small_volume.h"

enum { WIDE = 7, TALL = 5, DEEP = 3, COUNT = WIDE * TALL * DEEP, BIG = 128 };

typedef struct bench {
  hl_context *context;
  hl_volume *volume;
} bench;

static hl_volume *make_volume(hl_context *context, hl_voxel_type type, const void *voxels) {
  return volume_of_voxels(context, WIDE, TALL, DEEP, type, voxels);
}

/* A volume whose value is 100 k + 10 j + i, so that linear interpolation is exact everywhere. */
static bench begin(void) {
  bench b = {0};
  float voxels[COUNT];
  for (int n = 0; n < COUNT; n++)
    voxels[n] = (float)(100 * (n / (WIDE * TALL)) + 10 * (n / WIDE % TALL) + n % WIDE);
  b.context = make_context();
  b.volume = make_volume(b.context, HL_VOXEL_F32, voxels);
  return b;
}

static void end(bench *b) {
  hl_volume_release(b->volume);
  hl_context_destroy(b->context);
}

static hl_reslice_options plane(size_t width, size_t height) {
  hl_reslice_options options;
  hl_reslice_options_defaults(&options);
  options.width = width;
  options.height = height;
  return options;
}

static void set(double numbers[3], double i, double j, double k) {
  numbers[0] = i, numbers[1] = j, numbers[2] = k;
}

static void planes_of_the_grid_are_its_voxels(void **state) {
  (void)state;
  bench b = begin();
  double values[COUNT];
  for (int linear = 0; linear < 2; linear++) { /* the plane i = 4, from the last slice down, rows along j */
    hl_reslice_options options = plane(TALL, DEEP);
    set(options.origin, 4, 0, DEEP - 1);
    set(options.across, 0, 1, 0);
    set(options.down, 0, 0, -1);
    options.interpolate = linear;
    assert_int_equal(hl_volume_reslice(b.volume, &options, values, NULL), HL_OK);
    for (size_t row = 0; row < DEEP; row++)
      for (size_t column = 0; column < TALL; column++)
        assert_true(values[row * TALL + column] == hl_volume_value(b.volume, 4, column, DEEP - 1 - row));
  }
  end(&b);
}

static void oblique_planes_are_linear(void **state) {
  (void)state;
  bench b = begin();
  double values[4];
  hl_reslice_options options = plane(2, 2);
  set(options.origin, 1.25, 0.5, 0.75);
  set(options.across, 0.5, 1, 0.25);
  set(options.down, 2, 0.125, -0.5);
  options.interpolate = 1;
  assert_int_equal(hl_volume_reslice(b.volume, &options, values, NULL), HL_OK);
  const double first = 75 + 5 + 1.25, across = 25 + 10 + 0.5, down = -50 + 1.25 + 2;
  const double expected[4] = {first, first + across, first + down, first + across + down};
  for (int n = 0; n < 4; n++) assert_true(fabs(values[n] - expected[n]) < 1e-12);
  options.interpolate = 0; /* the nearest point to 1.25, 0.5, 0.75 is 1, 1, 1 */
  assert_int_equal(hl_volume_reslice(b.volume, &options, values, NULL), HL_OK);
  assert_true(values[0] == 111);
  end(&b);
}

static void thick_planes_blend_their_layers(void **state) {
  (void)state;
  bench b = begin();
  const double expected[] = {[HL_BLEND_MAXIMUM] = 223, [HL_BLEND_MINIMUM] = 23, [HL_BLEND_MEAN] = 123};
  for (hl_blend blend = HL_BLEND_MAXIMUM; blend <= HL_BLEND_MEAN; blend++) {
    double value;
    hl_reslice_options options = plane(1, 1);
    options.depth = DEEP + 2; /* the layer beyond each end does not count */
    options.blend = blend;
    set(options.origin, 3, 2, -1);
    assert_int_equal(hl_volume_reslice(b.volume, &options, &value, NULL), HL_OK);
    assert_true(value == expected[blend]);
  }
  end(&b);
}

static void there_is_nothing_beside_the_grid(void **state) {
  (void)state;
  bench b = begin();
  double values[4];
  for (int linear = 0; linear < 2; linear++) {
    hl_reslice_options options = plane(4, 1);
    set(options.origin, -0.75, 0, 0);
    set(options.across, 0.25, 0, 0);
    options.interpolate = linear;
    assert_int_equal(hl_volume_reslice(b.volume, &options, values, NULL), HL_OK);
    assert_true(isnan(values[0]));
    for (int n = 1; n < 4; n++)
      assert_true(values[n] == 0); /* the range begins half a voxel before the first centre */
    set(options.origin, WIDE - 1, 0, 0);
    assert_int_equal(hl_volume_reslice(b.volume, &options, values, NULL), HL_OK);
    assert_true(values[0] == WIDE - 1 && values[1] == WIDE - 1 && isnan(values[2]));
  }
  end(&b);
}

/* 64-bit numbers that no float holds, and voxels that are not finite. */
static void values_are_the_files_own(void **state) {
  (void)state;
  bench b = begin();
  double wide[COUNT], values[WIDE];
  for (int n = 0; n < COUNT; n++) wide[n] = n == 2 ? NAN : 614454271.0 + n;
  hl_volume *volume = make_volume(b.context, HL_VOXEL_F64, wide);
  hl_reslice_options options = plane(WIDE, 1);
  for (int linear = 0; linear < 2; linear++) {
    options.interpolate = linear;
    assert_int_equal(hl_volume_reslice(volume, &options, values, NULL), HL_OK);
    for (int n = 0; n < WIDE; n++) assert_true(n == 2 ? isnan(values[n]) : values[n] == wide[n]);
  }
  /* each point takes half of each of two voxels, and voxel number 2 has no data */
  set(options.origin, 0.5, 0, 0);
  assert_int_equal(hl_volume_reslice(volume, &options, values, NULL), HL_OK);
  assert_true(!isnan(values[0]) && isnan(values[1]) && isnan(values[2]) && !isnan(values[3]));
  hl_volume_release(volume);
  end(&b);
}

static void impossible_numbers_are_refused(void **state) {
  (void)state;
  bench b = begin();
  double value;
  const double wrong[] = {NAN, INFINITY, -INFINITY, 2e9};
  hl_error error;
  for (size_t n = 0; n < sizeof wrong / sizeof *wrong; n++)
    for (int which = 0; which < 4; which++) {
      hl_reslice_options options = plane(1, 1);
      double *numbers[] = {options.origin, options.across, options.down, options.through};
      numbers[which][n % 3] = wrong[n];
      assert_int_equal(hl_volume_reslice(b.volume, &options, &value, &error), HL_ERROR_ARGUMENT);
      assert_non_null(strstr(error.message, "1e9"));
    }
  for (int which = 0; which < 5; which++) {
    hl_reslice_options options = plane(1, 1);
    if (which < 3) (which == 0 ? &options.width : which == 1 ? &options.height : &options.depth)[0] = 0;
    if (which == 3) options.struct_size--;
    if (which == 4) options.blend = (hl_blend)4;
    assert_int_equal(hl_volume_reslice(b.volume, &options, &value, NULL), HL_ERROR_ARGUMENT);
  }
  hl_reslice_options options = plane(1, 1);
  assert_int_equal(hl_volume_reslice(NULL, &options, &value, NULL), HL_ERROR_ARGUMENT);
  assert_int_equal(hl_volume_reslice(b.volume, NULL, &value, NULL), HL_ERROR_ARGUMENT);
  assert_int_equal(hl_volume_reslice(b.volume, &options, NULL, NULL), HL_ERROR_ARGUMENT);
  end(&b);
}

static int stop_now(void *user_data) { return *(int *)user_data; }

/* A projection through many layers stops if it is cancelled. With many threads it is the same as with one. */
static void large_planes_can_be_cancelled(void **state) {
  (void)state;
  int stop = 0;
  hl_context_options host;
  hl_context_options_defaults(&host);
  host.user_data = &stop;
  host.cancelled = stop_now;
  hl_context *context = NULL;
  assert_int_equal(hl_context_create(&host, &context, NULL), HL_OK);
  unsigned char *voxels = calloc(BIG * BIG * BIG, 1);
  double *values = malloc(BIG * BIG * sizeof *values);
  assert_true(voxels != NULL && values != NULL);
  for (size_t n = 0; n < BIG * BIG; n++) voxels[n * BIG + n % BIG] = (unsigned char)(n % 251);
  hl_volume *volume = volume_of_voxels(context, BIG, BIG, BIG, HL_VOXEL_U8, voxels);
  hl_reslice_options options = plane(BIG, BIG);
  options.depth = BIG;
  set(options.across, 0, 1, 0);
  set(options.down, 0, 0, 1);
  set(options.through, 1, 0, 0);
  assert_int_equal(hl_volume_reslice(volume, &options, values, NULL), HL_OK);
  for (size_t n = 0; n < BIG * BIG; n++) assert_true(values[n] == (double)(n % 251));
  stop = 1;
  assert_int_equal(hl_volume_reslice(volume, &options, values, NULL), HL_ERROR_CANCELLED);
  hl_volume_release(volume);
  hl_context_destroy(context);
  free(values);
  free(voxels);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(planes_of_the_grid_are_its_voxels), cmocka_unit_test(oblique_planes_are_linear),
      cmocka_unit_test(thick_planes_blend_their_layers),   cmocka_unit_test(there_is_nothing_beside_the_grid),
      cmocka_unit_test(values_are_the_files_own),          cmocka_unit_test(impossible_numbers_are_refused),
      cmocka_unit_test(large_planes_can_be_cancelled),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
