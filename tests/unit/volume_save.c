/* tests/unit/volume_save.c - volumes that are saved and loaded again have the same values, type and place. */
#define _GNU_SOURCE
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "small_volume.h"

static char folder[] = "/tmp/halflight-save-XXXXXX";

static int make_folder(void **state) {
  (void)state;
  return mkdtemp(folder) != NULL ? 0 : -1;
}
static int remove_folder(void **state) {
  (void)state;
  return rmdir(folder);
}

static const char *place(const char *name) {
  static char path[300];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  return path;
}

/* 5 x 4 x 3 voxels of a type, on a grid that is oblique and left-handed. */
static hl_volume *make_volume(hl_context *context, hl_voxel_type type, double scale) {
  unsigned char bytes[60 * 8];
  for (size_t n = 0; n < sizeof bytes; n++) bytes[n] = (unsigned char)(37 * n + n / 7);
  if (type == HL_VOXEL_F32)
    for (int n = 0; n < 60; n++) {
      float value = n == 7 ? NAN : (float)(n - 30) / 7;
      memcpy(bytes + 4 * n, &value, 4);
    }
  hl_volume_description d = describe_voxels(5, 4, 3, type, bytes);
  d.value_scale = scale;
  d.value_offset = scale - 1;
  const double axes[3][3] = {{0.3, 0.1, 0}, {0, 1 / 3.0, 0.25}, {0.1, 0, -2}},
               origin[3] = {-1e-3, 7, 1 / 7.0};
  memcpy(d.axis, axes, sizeof axes);
  memcpy(d.origin, origin, sizeof origin);
  return create_volume(context, &d);
}

static void assert_same(const hl_volume *a, const hl_volume *b, bool with_place) {
  assert_memory_equal(a->dimension, b->dimension, sizeof a->dimension);
  if (with_place) assert_memory_equal(&a->index_to_world, &b->index_to_world, sizeof a->index_to_world);
  for (size_t k = 0; k < 3; k++)
    for (size_t j = 0; j < 4; j++)
      for (size_t i = 0; i < 5; i++) {
        double x = hl_volume_value(a, i, j, k), y = hl_volume_value(b, i, j, k);
        if (isnan(x)) assert_true(isnan(y));
        else assert_true(fabs(x) >= 0x1p24 && a->exact != NULL ? x == y : (float)x == (float)y);
      }
}

static void values_and_place_survive(void **state) {
  (void)state;
  hl_context *context = make_context();
  for (int type = HL_VOXEL_U8; type <= HL_VOXEL_F32; type++)
    for (int scaled = 0; scaled < 2; scaled++) {
      hl_volume *volume = make_volume(context, (hl_voxel_type)type, scaled ? 0.25 : 1), *again = NULL;
      hl_error error = {0};
      if (hl_volume_save(context, volume, place("a.nrrd"), &error) != HL_OK) fail_msg("%s", error.message);
      if (hl_volume_load(context, place("a.nrrd"), &again, &error) != HL_OK) fail_msg("%s", error.message);
      assert_same(volume, again, true);
      hl_voxel_type scaled_type = volume->exact != NULL ? HL_VOXEL_F64 : HL_VOXEL_F32;
      assert_int_equal(again->type, scaled ? scaled_type : (hl_voxel_type)type);
      char name[80];
      snprintf(name, sizeof name, "a_5x4x3_%s.raw%s", hl_voxel_type_name(again->type), scaled ? ".gz" : "");
      hl_volume_release(again);
      assert_int_equal(hl_volume_save(context, volume, place(name), &error), HL_OK);
      assert_int_equal(hl_volume_load(context, place(name), &again, &error), HL_OK);
      assert_same(volume, again, false);
      unlink(place(name));
      hl_volume_release(again);
      hl_volume_release(volume);
    }
  unlink(place("a.nrrd"));
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

static void impossible_names_are_refused(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_volume *volume = make_volume(context, HL_VOXEL_U8, 1);
  static const char *const names[] = {"a.png", "a.mhd", "a.raw", "a_5x4x3_uint16.raw", "a_5x4x4_uint8.raw",
                                      ".nrrd"};
  for (size_t n = 0; n < sizeof names / sizeof *names; n++) {
    hl_error error = {0};
    assert_int_equal(hl_volume_save(context, volume, names[n], &error), HL_ERROR_ARGUMENT);
    assert_memory_equal(error.message, names[n], strlen(names[n]));
    assert_int_not_equal(access(names[n], F_OK), 0);
  }
  hl_error error = {0};
  assert_int_equal(hl_volume_save(context, volume, "/no such folder/a.nrrd", &error), HL_ERROR_IO);
  hl_volume_release(volume);
  hl_context_destroy(context);
}

/* The mean of two labels would be a third one. So a voxel of a shrunk label map has the most common label of
 * its box. */
static void labels_keep_their_numbers(void **state) {
  (void)state;
  hl_context *context = make_context();
  static const int16_t voxels[2][2][4] = {{{1, 5, 7, 3}, {5, 9, 3, 7}}, {{1, 5, 7, 3}, {9, 0, 3, 7}}};
  hl_volume *volume = volume_of_voxels(context, 4, 2, 2, HL_VOXEL_I16, voxels), *again = NULL;
  hl_volume_save_options options;
  hl_volume_save_options_defaults(&options);
  options.shrink = 2;
  options.labels = 1;
  assert_int_equal(hl_volume_save_with(context, volume, place("b.nrrd"), &options, NULL), HL_OK);
  assert_int_equal(hl_volume_load(context, place("b.nrrd"), &again, NULL), HL_OK);
  assert_true(hl_volume_value(again, 0, 0, 0) == 5); /* three of eight */
  assert_true(hl_volume_value(again, 1, 0, 0) == 7); /* of four 7 and four 3, the first is taken */
  options.shrink = 65;
  assert_int_equal(hl_volume_save_with(context, volume, place("b.nrrd"), &options, NULL), HL_ERROR_ARGUMENT);
  unlink(place("b.nrrd"));
  hl_volume_release(again);
  hl_volume_release(volume);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(values_and_place_survive),
                                     cmocka_unit_test(labels_keep_their_numbers),
                                     cmocka_unit_test(impossible_names_are_refused)};
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
