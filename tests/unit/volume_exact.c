/* tests/unit/volume_exact.c - whole numbers above 2^24 keep their values: in memory, in files and as labels.
 */
#define _GNU_SOURCE
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <halflight/scene.h>

#include "small_volume.h"
#include "volume/convert.h"
#include "volume/exact.h"
#include "volume/store/pages.h"

enum { SIDE = 4, COUNT = SIDE * SIDE * SIDE };

static char folder[] = "/tmp/halflight-exact-XXXXXX";

static int make_folder(void **state) {
  (void)state;
  return mkdtemp(folder) != NULL ? 0 : -1;
}
static int remove_folder(void **state) {
  (void)state;
  return rmdir(folder);
}

static hl_volume *make_volume(hl_context *context, hl_voxel_type type, const void *voxels) {
  return volume_of_voxels(context, SIDE, SIDE, SIDE, type, voxels);
}

/* Neighbouring whole numbers that become the same float, of each type. */
static void fill(hl_voxel_type type, unsigned char bytes[8 * COUNT]) {
  for (size_t n = 0; n < COUNT; n++) {
    int64_t wide = (n % 3 == 0 ? 0 : 720575940621039145 + (int64_t)n), narrow = 614454270 + (int64_t)n;
    uint64_t whole = UINT64_MAX - n;
    uint32_t word = (uint32_t)(n % 3 == 0 ? 5 : 4294967200u + n);
    int32_t signed_word = (int32_t)(n % 2 == 0 ? -narrow : narrow);
    double real = (double)(n % 3 == 0 ? 3 : narrow);
    switch (type) {
      case HL_VOXEL_U32: memcpy(bytes + 4 * n, &word, 4); break;
      case HL_VOXEL_I32: memcpy(bytes + 4 * n, &signed_word, 4); break;
      case HL_VOXEL_U64: memcpy(bytes + 8 * n, &whole, 8); break;
      case HL_VOXEL_I64: memcpy(bytes + 8 * n, &wide, 8); break;
      default: memcpy(bytes + 8 * n, &real, 8); break;
    }
  }
}

static const hl_voxel_type wide_types[] = {HL_VOXEL_U32, HL_VOXEL_I32, HL_VOXEL_U64, HL_VOXEL_I64,
                                           HL_VOXEL_F64};

/* All bytes come back from a file, also of numbers that doubles cannot hold. */
static void numbers_survive_files(void **state) {
  (void)state;
  static const char *const endings[] = {"nrrd", "nii", "mha", "vti"};
  hl_context *context = make_context();
  for (size_t t = 0; t < sizeof wide_types / sizeof *wide_types; t++)
    for (size_t e = 0; e < sizeof endings / sizeof *endings; e++) {
      unsigned char bytes[8 * COUNT] = {0};
      char path[200];
      hl_error error = {0};
      hl_volume *again = NULL;
      fill(wide_types[t], bytes);
      hl_volume *volume = make_volume(context, wide_types[t], bytes);
      snprintf(path, sizeof path, "%s/a.%s", folder, endings[e]);
      if (hl_volume_save(context, volume, path, &error) != HL_OK) fail_msg("%s", error.message);
      if (hl_volume_load(context, path, &again, &error) != HL_OK) fail_msg("%s", error.message);
      assert_int_equal(again->type, wide_types[t]);
      assert_non_null(again->exact);
      assert_memory_equal(again->exact, bytes, COUNT * (t < 2 ? 4 : 8));
      assert_true(again->minimum == volume->minimum && again->maximum == volume->maximum);
      unlink(path);
      hl_volume_release(again);
      hl_volume_release(volume);
    }
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

static void values_and_range_are_exact(void **state) {
  (void)state;
  hl_context *context = make_context();
  int32_t voxels[2 * COUNT]; /* room for numbers of 64 bits, which fill() may write */
  fill(HL_VOXEL_I32, (unsigned char *)voxels);
  hl_volume *volume = make_volume(context, HL_VOXEL_I32, voxels);
  hl_volume_info info = {.struct_size = sizeof info};
  double sum = 0;
  for (size_t n = 0; n < COUNT; n++) {
    assert_true(hl_volume_value(volume, n % SIDE, n / SIDE % SIDE, n / SIDE / SIDE) == voxels[n]);
    sum += voxels[n];
  }
  assert_int_equal(hl_volume_get_info(volume, &info), HL_OK);
  assert_true(info.range[0] == -614454332 && info.range[1] == 614454333);
  assert_true(info.mean == sum / COUNT);
  hl_volume_release(volume);
  hl_context_destroy(context);
}

/* Numbers that floats hold need no second copy. */
static int by_value(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* The percentiles are those of sorted numbers, to the last bit of a double, also if all numbers become the
 * same float. */
static void percentiles_are_exact(void **state) {
  (void)state;
  static const double percents[] = {0, 1, 12.5, 50, 61.9, 99, 100};
  enum { PERCENTS = sizeof percents / sizeof *percents };
  hl_context *context = make_context();
  for (size_t t = 0; t < sizeof wide_types / sizeof *wide_types; t++) {
    unsigned char bytes[8 * COUNT] = {0};
    double sorted[COUNT], found[PERCENTS];
    fill(wide_types[t], bytes);
    hl_volume *volume = make_volume(context, wide_types[t], bytes);
    for (size_t n = 0; n < COUNT; n++) sorted[n] = hl_exact_number(wide_types[t], bytes, n);
    qsort(sorted, COUNT, sizeof *sorted, by_value);
    assert_int_equal(hl_volume_percentiles(volume, percents, PERCENTS, found, NULL), HL_OK);
    for (size_t p = 0; p < PERCENTS; p++) {
      double place = percents[p] / 100 * (COUNT - 1);
      size_t rank = (size_t)place, after = rank + 1 < COUNT ? rank + 1 : rank;
      double wanted = sorted[rank] + (place - (double)rank) * (sorted[after] - sorted[rank]);
      assert_true(found[p] == wanted);
    }
    hl_volume_release(volume);
  }
  hl_context_destroy(context);
}

static void small_numbers_take_no_memory(void **state) {
  (void)state;
  hl_context *context = make_context();
  uint32_t voxels[COUNT];
  double reals[COUNT];
  for (uint32_t n = 0; n < COUNT; n++) voxels[n] = n % 2 == 0 ? 1u << 24 : 0x80000000u + (n << 8);
  for (uint32_t n = 0; n < COUNT; n++) reals[n] = n / 10.0;
  hl_volume *volume = make_volume(context, HL_VOXEL_U32, voxels),
            *fractions = make_volume(context, HL_VOXEL_F64, reals);
  assert_null(volume->exact);
  assert_null(fractions->exact);
  hl_volume_release(volume);
  hl_volume_release(fractions);
  hl_context_destroy(context);
}

static void neighbouring_ids_are_two_labels(void **state) {
  (void)state;
  hl_context *context = make_context();
  uint32_t voxels[COUNT];
  for (uint32_t n = 0; n < COUNT; n++) voxels[n] = n < COUNT / 4 ? 0 : 614454277 + (n & 1);
  hl_volume *map = make_volume(context, HL_VOXEL_U32, voxels);
  hl_label *labels = NULL;
  size_t count = 0;
  assert_int_equal(hl_labels_of_volume(context, map, NULL, &labels, &count, NULL), HL_OK);
  assert_int_equal(count, 2);
  assert_true(labels[0].value == 614454277 && labels[1].value == 614454278);
  hl_labels_release(context, labels);
  hl_volume_release(map);
  hl_context_destroy(context);
}

enum { LARGE = 112, LARGE_COUNT = LARGE * LARGE * LARGE };

/* Some slices have great numbers, and others small ones. */
static void fill_large(hl_voxel_type type, unsigned char *bytes) {
  size_t each = type == HL_VOXEL_U32 ? 4 : 8;
  for (size_t n = 0; n < LARGE_COUNT; n++) {
    bool great = n / (LARGE * LARGE) % 3 == 1 && n % 5 != 0;
    uint32_t word = (uint32_t)(great ? 614454277 + n % 7 : n % 1000);
    int64_t wide = great ? INT64_C(720575940621039145) - (int64_t)n : (int64_t)(n % 1000) - 500;
    double real = great ? 123456789.25 + (double)n : (double)(n % 1000);
    memcpy(bytes + each * n,
           type == HL_VOXEL_U32   ? (void *)&word
           : type == HL_VOXEL_I64 ? (void *)&wide
                                  : (void *)&real,
           each);
  }
}

static void write_file(const char *path, const void *bytes, size_t count) {
  FILE *file = fopen(path, "wb");
  assert_non_null(file);
  assert_int_equal(fwrite(bytes, 1, count, file), count);
  assert_int_equal(fclose(file), 0);
}

static void check_file(const char *path, const void *bytes, size_t count) {
  unsigned char *found = malloc(count + 1);
  FILE *file = fopen(path, "rb");
  assert_non_null(file);
  assert_int_equal(fread(found, 1, count + 1, file), count);
  fclose(file);
  assert_memory_equal(found, bytes, count);
  free(found);
}

/* If memory has no room for a volume's exact numbers, they are in a second scratch file. */
static void numbers_larger_than_memory_are_exact(void **state) {
  (void)state;
  static const hl_voxel_type types[] = {HL_VOXEL_U32, HL_VOXEL_I64, HL_VOXEL_F64};
  static const char *const names[] = {"uint32", "int64", "float64"};
  static const double percents[] = {0, 33, 80.1, 99, 100};
  unsigned char *bytes = malloc(8 * (size_t)LARGE_COUNT);
  double *sorted = malloc(LARGE_COUNT * sizeof *sorted), found[5];
  for (size_t t = 0; t < 3; t++) {
    size_t each = hl_voxel_type_bytes(types[t]);
    char path[200], again[200];
    hl_context_options options;
    hl_context_options_defaults(&options);
    options.memory_limit = 6 << 20;
    options.scratch_folder = "/tmp";
    hl_context *context = NULL;
    hl_volume *volume = NULL;
    hl_error error = {0};
    assert_int_equal(hl_context_create(&options, &context, NULL), HL_OK);
    fill_large(types[t], bytes);
    snprintf(path, sizeof path, "%s/a_%dx%dx%d_%s.raw", folder, LARGE, LARGE, LARGE, names[t]);
    snprintf(again, sizeof again, "%s/b_%dx%dx%d_%s.raw", folder, LARGE, LARGE, LARGE, names[t]);
    write_file(path, bytes, each * LARGE_COUNT);
    if (hl_volume_load(context, path, &volume, &error) != HL_OK) fail_msg("%s", error.message);
    assert_non_null(volume->pages);
    assert_true(hl_volume_is_exact(volume));
    for (size_t n = 0; n < LARGE_COUNT; n++) sorted[n] = hl_exact_number(types[t], bytes, n);
    for (size_t n = 0; n < LARGE_COUNT; n += 4799)
      assert_true(hl_volume_value(volume, n % LARGE, n / LARGE % LARGE, n / LARGE / LARGE) == sorted[n]);
    qsort(sorted, LARGE_COUNT, sizeof *sorted, by_value);
    assert_true(volume->minimum == sorted[0] && volume->maximum == sorted[LARGE_COUNT - 1]);
    assert_int_equal(hl_volume_percentiles(volume, percents, 5, found, NULL), HL_OK);
    for (size_t p = 0; p < 5; p++) {
      double place = percents[p] / 100 * (LARGE_COUNT - 1);
      size_t rank = (size_t)place, after = rank + 1 < LARGE_COUNT ? rank + 1 : rank;
      assert_true(found[p] == sorted[rank] + (place - (double)rank) * (sorted[after] - sorted[rank]));
    }
    if (hl_volume_save(context, volume, again, &error) != HL_OK) fail_msg("%s", error.message);
    check_file(again, bytes, each * LARGE_COUNT);
    hl_volume_release(volume);
    assert_int_equal(hl_context_memory_held(context), 0);
    assert_true(hl_context_memory_peak(context) <= options.memory_limit);
    hl_context_destroy(context);
    unlink(path);
    unlink(again);
  }
  free(sorted);
  free(bytes);
}

/* Two neighbouring numbers that become the same double: as labels, in a scene's text, in a shrunk volume, and
 * as the range. */
static void ids_above_doubles_stay_apart(void **state) {
  (void)state;
  enum { EDGE = 8 };
  static const int64_t ids[2] = {INT64_C(720575940621039145), INT64_C(720575940621039146)};
  hl_context *context = make_context();
  for (int sign = -1; sign <= 1; sign += 2) {
    int64_t voxels[EDGE * EDGE * EDGE], least = sign * ids[sign > 0 ? 0 : 1];
    for (int n = 0; n < EDGE * EDGE * EDGE; n++)
      voxels[n] = n < EDGE * EDGE * 2 ? 0 : sign * ids[n >= EDGE * EDGE * 4];
    const hl_voxel_type type = sign > 0 ? HL_VOXEL_U64 : HL_VOXEL_I64;
    hl_volume *map = volume_of_voxels(context, EDGE, EDGE, EDGE, type, voxels), *small = NULL;
    hl_label *labels = NULL;
    size_t count = 0;
    assert_int_equal(hl_labels_of_volume(context, map, NULL, &labels, &count, NULL), HL_OK);
    assert_int_equal(count, 2);
    assert_true(labels[0].value == least && labels[1].value == least + 1);
    assert_true(memcmp(labels[0].color, labels[1].color, sizeof labels[0].color) != 0);
    char text[HL_NUMBER_TEXT_BYTES], wanted[32];
    assert_int_equal(hl_volume_write_range(map, 0, text), HL_OK);
    assert_string_equal(text, sign > 0 ? "0" : "-720575940621039146");
    assert_int_equal(hl_volume_write_range(map, 1, text), HL_OK);
    assert_string_equal(text, sign > 0 ? "720575940621039146" : "0");
    int is_map = 0;
    assert_int_equal(hl_volume_is_label_map(context, map, &is_map, NULL), HL_OK);
    assert_true(is_map);

    hl_scene *scene = NULL;
    char *json = NULL;
    assert_int_equal(hl_scene_for_volume(context, map, "ids.nrrd", &scene, NULL), HL_OK);
    assert_int_equal(hl_scene_describe(scene)->volumes[0].label_count, 2);
    assert_int_equal(hl_scene_to_json(context, scene, &json, NULL), HL_OK);
    snprintf(wanted, sizeof wanted, "%lld", (long long)least);
    assert_non_null(strstr(json, wanted));
    hl_scene_release(scene);
    hl_text_release(context, json);

    char path[] = "/tmp/halflight-ids-XXXXXX.nrrd";
    int file = mkstemps(path, 5);
    assert_true(file >= 0 && close(file) == 0);
    hl_volume_save_options saving;
    hl_volume_save_options_defaults(&saving);
    saving.shrink = 2;
    saving.labels = 1;
    assert_int_equal(hl_volume_save_with(context, map, path, &saving, NULL), HL_OK);
    assert_int_equal(hl_volume_load(context, path, &small, NULL), HL_OK);
    hl_labels_release(context, labels);
    assert_int_equal(hl_labels_of_volume(context, small, NULL, &labels, &count, NULL), HL_OK);
    assert_int_equal(count, 2);
    assert_true(labels[0].value == least && labels[1].value == least + 1);
    unlink(path);
    hl_labels_release(context, labels);
    hl_volume_release(small);
    hl_volume_release(map);
  }
  hl_context_destroy(context);
}

/* A label's number must fit 64 bits with a sign. Other numbers are refused, and the volume is drawn by its
 * values. */
static void numbers_beyond_labels_are_refused(void **state) {
  (void)state;
  hl_context *context = make_context();
  uint64_t voxels[COUNT];
  for (size_t n = 0; n < COUNT; n++) voxels[n] = n < COUNT / 2 ? 7 : UINT64_MAX;
  hl_volume *map = make_volume(context, HL_VOXEL_U64, voxels);
  hl_label *labels = NULL;
  size_t count = 0;
  hl_error error;
  int is_map = 1;
  char text[HL_NUMBER_TEXT_BYTES];
  assert_int_equal(hl_labels_of_volume(context, map, NULL, &labels, &count, &error), HL_ERROR_INPUT);
  assert_non_null(strstr(error.message, "64 bits with a sign"));
  assert_int_equal(hl_volume_is_label_map(context, map, &is_map, NULL), HL_OK);
  assert_false(is_map);
  assert_int_equal(hl_volume_write_range(map, 1, text), HL_OK);
  assert_string_equal(text, "18446744073709551615");
  hl_volume_release(map);
  hl_context_destroy(context);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(numbers_survive_files),
                                     cmocka_unit_test(values_and_range_are_exact),
                                     cmocka_unit_test(percentiles_are_exact),
                                     cmocka_unit_test(small_numbers_take_no_memory),
                                     cmocka_unit_test(neighbouring_ids_are_two_labels),
                                     cmocka_unit_test(ids_above_doubles_stay_apart),
                                     cmocka_unit_test(numbers_beyond_labels_are_refused),
                                     cmocka_unit_test(numbers_larger_than_memory_are_exact)};
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
