/* tests/unit/volume_colors.c - colours of voxels that are read from files: their codes, and the values from
 * which opacity follows. */
#include "volume_files.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/context.h"
#include "volume/volume.h"

static hl_status load(hl_context *context, const byte_buffer *file, int component, hl_volume **volume,
                      hl_error *error) {
  hl_volume_load_options options;
  hl_volume_load_options_defaults(&options);
  options.component = component;
  options.bytes = file->data;
  options.byte_count = file->length;
  return hl_volume_load_with(context, "memory", &options, volume, error);
}

static hl_volume *loaded(hl_context *context, const byte_buffer *file, int component) {
  hl_volume *volume = NULL;
  hl_error error = {0};
  if (load(context, file, component, &volume, &error) != HL_OK) fail_msg("%s", error.message);
  return volume;
}

/* Two voxels of NRRD. kinds: of the axis of components. last: whether it is the last axis. */
static byte_buffer nrrd(const char *type, const char *kind, int components, bool last, const char *values) {
  byte_buffer file = {.length = 0};
  char header[400];
  snprintf(header, sizeof header, "NRRD0004\ntype: %s\ndimension: 4\nencoding: text\n", type);
  add_text(&file, "%s", header);
  if (last)
    snprintf(header, sizeof header, "sizes: 2 1 1 %d\nkinds: domain domain domain %s\n\n", components, kind);
  else
    snprintf(header, sizeof header, "sizes: %d 2 1 1\nkinds: %s domain domain domain\n\n", components, kind);
  add_text(&file, "%s", header);
  add_text(&file, "%s", values);
  return file;
}

static void assert_voxel(const hl_volume *volume, size_t i, double value, const unsigned char color[4]) {
  assert_true(hl_volume_value(volume, i, 0, 0) == value);
  assert_memory_equal(volume->colors + 4 * i, color, 4);
}

/* (54 * 200 + 183 * 100 + 19 * 50 + 128) / 256 = 117.9; black has the least weight. */
static void test_opacity_of_rgb_is_its_luminance(void **state) {
  (void)state;
  hl_context *context = NULL;
  assert_int_equal(hl_context_create(NULL, &context, NULL), HL_OK);
  for (int last = 0; last < 2; last++) {
    byte_buffer file = nrrd("uint8", "RGB-color", 3, last,
                            last ? "200 0\n100 0\n50 0\n" : "200 100 50\n0 0 0\n");
    hl_volume *volume = loaded(context, &file, HL_COMPONENT_DEFAULT);
    assert_voxel(volume, 0, 117, (unsigned char[4]){200, 100, 50, 117});
    assert_voxel(volume, 1, 0, (unsigned char[4]){0, 0, 0, 1});
    assert_int_equal(volume->component, HL_COMPONENT_LUMINANCE);
    hl_volume_release(volume);
    volume = loaded(context, &file, 1);
    assert_true(hl_volume_value(volume, 0, 0, 0) == 100 && volume->colors == NULL);
    hl_volume_release(volume);
  }
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

static void test_opacity_of_rgba_is_its_alpha(void **state) {
  (void)state;
  hl_context *context = NULL;
  assert_int_equal(hl_context_create(NULL, &context, NULL), HL_OK);
  byte_buffer file = nrrd("uint8", "RGBA-color", 4, false, "200 100 50 9\n1 2 3 0\n");
  hl_volume *volume = loaded(context, &file, HL_COMPONENT_DEFAULT);
  assert_voxel(volume, 0, 9, (unsigned char[4]){200, 100, 50, 9});
  assert_voxel(volume, 1, 0, (unsigned char[4]){1, 2, 3, 1});
  assert_int_equal(volume->component, HL_COMPONENT_COLOR);
  hl_volume_release(volume);
  volume = loaded(context, &file, HL_COMPONENT_LUMINANCE);
  assert_voxel(volume, 0, 117, (unsigned char[4]){200, 100, 50, 117});
  hl_volume_release(volume);
  file = nrrd("uint8", "RGBA-color", 4, false, "200 100 50 255\n1 2 3 255\n"); /* which tells nothing */
  volume = loaded(context, &file, HL_COMPONENT_DEFAULT);
  assert_voxel(volume, 0, 117, (unsigned char[4]){200, 100, 50, 117});
  hl_volume_release(volume);
  hl_context_destroy(context);
}

/* 65535 becomes 255, and the values are the file's */
static void test_sixteen_bits_become_eight(void **state) {
  (void)state;
  hl_context *context = NULL;
  assert_int_equal(hl_context_create(NULL, &context, NULL), HL_OK);
  byte_buffer file = nrrd("uint16", "RGBA-color", 4, false, "65535 32768 128 25700\n129 0 0 0\n");
  hl_volume *volume = loaded(context, &file, HL_COMPONENT_DEFAULT);
  assert_voxel(volume, 0, 25700, (unsigned char[4]){255, 128, 0, 100});
  assert_voxel(volume, 1, 0, (unsigned char[4]){1, 0, 0, 1});
  hl_volume_release(volume);
  hl_context_destroy(context);
}

/* Vectors are colours if the caller says so. Floats and vectors of two components never are. */
static void test_colors_where_asked(void **state) {
  (void)state;
  hl_context *context = NULL;
  hl_error error = {0};
  assert_int_equal(hl_context_create(NULL, &context, NULL), HL_OK);
  byte_buffer file = nrrd("uint8", "vector", 3, false, "200 100 50\n0 0 0\n");
  hl_volume *volume = loaded(context, &file, HL_COMPONENT_DEFAULT);
  assert_true(volume->colors == NULL && fabs(hl_volume_value(volume, 0, 0, 0) - sqrt(52500)) < 1e-4);
  hl_volume_release(volume);
  volume = loaded(context, &file, HL_COMPONENT_COLOR);
  assert_voxel(volume, 0, 117, (unsigned char[4]){200, 100, 50, 117});
  hl_volume_release(volume);
  file = nrrd("float", "RGB-color", 3, false, "1 2 3\n0 0 0\n");
  assert_int_equal(load(context, &file, HL_COMPONENT_COLOR, &volume, &error), HL_ERROR_UNSUPPORTED);
  assert_string_equal(
      error.message,
      "memory: 3 components of float32 are not read as colours: these are 3 or 4 of uint8 or uint16: choose "
      "another by \"component\" (--component)");
  file = nrrd("uint8", "2-vector", 2, false, "1 2\n0 0\n");
  assert_int_equal(load(context, &file, HL_COMPONENT_LUMINANCE, &volume, &error), HL_ERROR_UNSUPPORTED);
  hl_context_destroy(context);
}

static void test_names_of_components(void **state) {
  (void)state;
  for (int component = HL_COMPONENT_MAGNITUDE; component >= HL_COMPONENT_LUMINANCE; component--)
    assert_int_equal(hl_component_of_name(hl_component_name(component)), component);
  assert_null(hl_component_name(HL_COMPONENT_DEFAULT));
  assert_null(hl_component_name(3));
  assert_int_equal(hl_component_of_name("colour"), HL_COMPONENT_DEFAULT);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_opacity_of_rgb_is_its_luminance),
      cmocka_unit_test(test_opacity_of_rgba_is_its_alpha),
      cmocka_unit_test(test_sixteen_bits_become_eight),
      cmocka_unit_test(test_colors_where_asked),
      cmocka_unit_test(test_names_of_components),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
