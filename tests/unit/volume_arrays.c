/* tests/unit/volume_arrays.c - which array and component of a file is read, which warnings are given, and the
 * other options of loading. */
#include "volume_files.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "core/context.h"

typedef struct told {
  int warnings;
  char last[1000];
} told;

static void on_log(void *user_data, hl_log_level level, const char *message) {
  told *t = user_data;
  if (level != HL_LOG_WARNING) return;
  t->warnings++;
  snprintf(t->last, sizeof t->last, "%s", message);
}

/* The things that every test has: a context, and the warnings that it gave. */
static told t;
static hl_context *context;

static int begin(void **state) {
  (void)state;
  hl_context_options options;
  hl_context_options_defaults(&options);
  options.user_data = &t;
  options.log = on_log;
  t = (told){0};
  return hl_context_create(&options, &context, NULL) == HL_OK ? 0 : -1;
}

static int end(void **state) {
  (void)state;
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
  return 0;
}

static hl_volume_load_options load_options(const char *array, int component) {
  hl_volume_load_options options;
  hl_volume_load_options_defaults(&options);
  options.array = array;
  options.component = component;
  return options;
}

static hl_volume_load_options options_of(const byte_buffer *file, const char *array, int component) {
  hl_volume_load_options options = load_options(array, component);
  options.bytes = file->data;
  options.byte_count = file->length;
  return options;
}

/* Loads a file's content from memory. */
static hl_volume *load(const byte_buffer *file, const char *array, int component, hl_error *error) {
  hl_volume_load_options options = options_of(file, array, component);
  hl_volume *volume = NULL;
  hl_status status = hl_volume_load_with(context, "memory", &options, &volume, error);
  assert_true((status == HL_OK) == (volume != NULL));
  return volume;
}

static const char two_arrays[] =
    "<VTKFile type=\"ImageData\"><ImageData WholeExtent=\"0 1 0 1 0 1\"><PointData Scalars=\"b\">"
    "<DataArray type=\"UInt8\" Name=\"a\">1 2 3 4 5 6 7 8</DataArray><DataArray type=\"Int16\" Name=\"b\">9 "
    "10 11 12 13 14 15 16"
    "</DataArray><DataArray type=\"Float32\" Name=\"v\" NumberOfComponents=\"3\">3 4 0 0 0 1 0 0 2 0 0 3 0 0 "
    "4 0 0 5 0 0 6 2 3 6"
    "</DataArray></PointData></ImageData></VTKFile>";

static void test_arrays_are_chosen_by_name(void **state) {
  (void)state;
  byte_buffer file = {.length = 0};
  add(&file, two_arrays, strlen(two_arrays));
  hl_error error = {0};
  hl_volume *volume = load(&file, NULL, HL_COMPONENT_DEFAULT, &error); /* the active one */
  assert_true(hl_volume_value(volume, 0, 0, 0) == 9);
  assert_int_equal(t.warnings, 1);
  assert_non_null(strstr(t.last, "of 3 arrays, b is taken"));
  assert_non_null(strstr(t.last, "a; b; v (3 components)"));
  hl_volume_array array = {.struct_size = sizeof array};
  assert_int_equal(hl_volume_array_count(volume), 3);
  assert_int_equal(hl_volume_get_array(volume, 1, &array), HL_OK);
  assert_true(array.chosen && strcmp(array.name, "b") == 0 && array.type == HL_VOXEL_I16 &&
              array.component == 0);
  assert_int_equal(hl_volume_get_array(volume, 2, &array), HL_OK);
  assert_true(!array.chosen && array.components == 3 && array.type == HL_VOXEL_F32 && !array.of_cells);
  assert_int_equal(hl_volume_get_array(volume, 3, &array), HL_ERROR_ARGUMENT);
  hl_volume_release(volume);
  volume = load(&file, "a", HL_COMPONENT_DEFAULT, &error);
  assert_true(hl_volume_value(volume, 1, 1, 1) == 8);
  hl_volume_release(volume);
  assert_int_equal(t.warnings, 1); /* no warning about an array that was named */
  assert_null(load(&file, "c", HL_COMPONENT_DEFAULT, &error));
  assert_int_equal(error.code, HL_ERROR_INPUT);
  assert_non_null(strstr(error.message, "no array \"c\": there is a; b; v (3 components)"));
}

static void test_components(void **state) {
  (void)state;
  byte_buffer file = {.length = 0};
  add(&file, two_arrays, strlen(two_arrays));
  hl_error error = {0};
  for (int component = 0; component < 3; component++) {
    hl_volume *volume = load(&file, "v", component, &error);
    assert_true(hl_volume_value(volume, 1, 1, 1) == (component == 0 ? 2 : component == 1 ? 3 : 6));
    hl_volume_release(volume);
  }
  assert_int_equal(t.warnings, 0);
  hl_volume *volume = load(&file, "v", HL_COMPONENT_MAGNITUDE, &error);
  assert_true(hl_volume_value(volume, 0, 0, 0) == 5 && hl_volume_value(volume, 1, 1, 1) == 7);
  hl_volume_release(volume);
  assert_int_equal(t.warnings, 0);
  /* of three components, the magnitude is read, with a warning */
  volume = load(&file, "v", HL_COMPONENT_DEFAULT, &error);
  assert_true(hl_volume_value(volume, 0, 0, 0) == 5);
  assert_int_equal(t.warnings, 1);
  assert_non_null(strstr(t.last, "their magnitude is taken"));
  hl_volume_array array = {.struct_size = sizeof array};
  assert_int_equal(hl_volume_get_array(volume, 2, &array), HL_OK);
  assert_true(array.chosen && array.component == HL_COMPONENT_MAGNITUDE);
  hl_volume_release(volume);
  assert_null(load(&file, "v", 3, &error));
  assert_non_null(strstr(error.message, "no component 3: choose 0 to 2, or magnitude"));
  assert_null(load(&file, "a", 1, &error));
  assert_null(load(&file, "a", HL_COMPONENT_MAGNITUDE, &error));
  assert_non_null(strstr(error.message, "one component, 0"));
}

/* A series of volumes: each volume is a component. Values are scaled, and the magnitude of signed, scaled
 * values is right. */
static void test_series(void **state) {
  (void)state;
  byte_buffer file = {.length = 0};
  add_text(&file,
           "NDims = 4\nDimSize = 2 1 1 3\nElementType = MET_CHAR\nElementToIntensityFunctionSlope = 0.5\n"
           "ElementToIntensityFunctionOffset = 1\nElementDataFile = LOCAL\n");
  add(&file, (const signed char[]){2, 4, 6, -8, 10, -12}, 6);
  hl_error error = {0};
  for (int step = 0; step < 3; step++) {
    hl_volume *volume = load(&file, NULL, step, &error);
    assert_true(hl_volume_value(volume, 0, 0, 0) == 2 + 2 * step);
    hl_volume_release(volume);
  }
  assert_int_equal(t.warnings, 0);
  hl_volume *volume = load(&file, NULL, HL_COMPONENT_MAGNITUDE, &error);
  assert_true(fabs(hl_volume_value(volume, 0, 0, 0) - sqrt(4 + 16 + 36)) < 1e-6);
  assert_true(fabs(hl_volume_value(volume, 1, 0, 0) - sqrt(9 + 9 + 25)) < 1e-6);
  hl_volume_release(volume);
  volume = load(&file, NULL, HL_COMPONENT_DEFAULT, &error);
  assert_true(hl_volume_value(volume, 1, 0, 0) == 3);
  assert_int_equal(t.warnings, 1);
  assert_non_null(strstr(t.last, "a series of volumes: the first, 0, is taken"));
  hl_volume_release(volume);
}

static hl_status load_step(const byte_buffer *file, int time, int channel, int level, double *value,
                           hl_error *error) {
  hl_volume_load_options options = options_of(file, NULL, HL_COMPONENT_DEFAULT);
  options.time = time, options.channel = channel, options.level = level;
  hl_volume *volume = NULL;
  hl_status status = hl_volume_load_with(context, "memory", &options, &volume, error);
  if (status != HL_OK) return status;
  hl_volume_selection s = {.struct_size = sizeof s};
  assert_int_equal(hl_volume_get_selection(volume, &s), HL_OK);
  assert_int_equal(s.times, 3);
  assert_int_equal(s.channels, 2);
  assert_true(s.levels == 1 && s.level == 0 && s.time == (time > 0 ? time : 0) &&
              s.channel == (channel > 0 ? channel : 0));
  *value = hl_volume_value(volume, 1, 0, 0);
  hl_volume_release(volume);
  return HL_OK;
}

/* NIfTI: the fourth axis is time, the fifth channels. */
static void test_times_and_channels(void **state) {
  (void)state;
  byte_buffer file = {.length = 0};
  unsigned char header[352] = {
      [0] = 348 & 255, [1] = 348 >> 8, [40] = 5, [42] = 2,    [44] = 1, [46] = 1, [48] = 3,
      [50] = 2,        [70] = 2,       [72] = 8, [344] = 'n', '+',      '1'};
  memcpy(header + 108, (const unsigned char[]){0, 0, 0xb0, 0x43}, 4); /* vox_offset: 352 */
  add(&file, header, sizeof header);
  for (int n = 0; n < 2 * 3 * 2; n++) add_integer(&file, (uint64_t)n, 1, false);
  hl_error error = {0};
  double value = 0;
  for (int time = 0; time < 3; time++)
    for (int channel = 0; channel < 2; channel++) {
      assert_int_equal(load_step(&file, time, channel, HL_INDEX_DEFAULT, &value, &error), HL_OK);
      assert_true(value == 1 + 2 * (time + 3 * channel));
    }
  assert_int_equal(t.warnings, 0);
  assert_int_equal(load_step(&file, HL_INDEX_DEFAULT, 1, 0, &value, &error), HL_OK);
  assert_true(value == 7);
  assert_int_equal(load_step(&file, -1, -1, -1, &value, &error), HL_OK);
  assert_true(value == 1 && t.warnings == 1);
  assert_non_null(strstr(t.last, "(--time)"));
  assert_int_equal(load_step(&file, 3, 0, 0, &value, &error), HL_ERROR_INPUT);
  assert_non_null(strstr(error.message, "there is no time 3: choose 0 to 2"));
  assert_int_equal(load_step(&file, 0, 2, 0, &value, &error), HL_ERROR_INPUT);
  assert_non_null(strstr(error.message, "there is no channel 2: choose 0 to 1"));
  assert_int_equal(load_step(&file, 0, 0, 1, &value, &error), HL_ERROR_INPUT);
  assert_non_null(strstr(error.message, "there is no level 1: the file has one, 0"));
  assert_int_equal(load_step(&file, -2, 0, 0, &value, &error), HL_ERROR_ARGUMENT);
  hl_volume_load_options options = options_of(&file, NULL, 1);
  options.time = 1;
  hl_volume *volume = NULL;
  assert_int_equal(hl_volume_load_with(context, "memory", &options, &volume, &error), HL_ERROR_INPUT);
  assert_non_null(strstr(error.message, "leave \"component\" (--component) out"));
}

/* There are more values than a stage holds, in blocks that are read and in blocks that are skipped. */
static void test_large_components(void **state) {
  (void)state;
  enum { W = 300, H = 300, STEPS = 4 };
  unsigned char *bytes = malloc(200 + STEPS * W * H);
  for (int side_by_side = 0; side_by_side < 2; side_by_side++) {
    int head = sprintf((char *)bytes, "NRRD0004\ntype: uint8\nencoding: raw\ndimension: 4\n%s\n\n",
                       side_by_side ? "sizes: 4 300 150 2\nkinds: vector domain domain domain"
                                    : "sizes: 300 150 2 4\nkinds: domain domain domain time");
    for (int c = 0; c < STEPS; c++)
      for (int n = 0; n < W * H; n++)
        bytes[head + (side_by_side ? STEPS * n + c : c * W * H + n)] = (unsigned char)(n * 7 + n / 255 +
                                                                                       50 * c);
    for (int c = 0; c < STEPS; c++) {
      hl_volume_load_options options = load_options(NULL, c);
      options.bytes = bytes;
      options.byte_count = (size_t)head + STEPS * W * H;
      hl_volume *volume = NULL;
      assert_int_equal(hl_volume_load_with(context, "memory", &options, &volume, NULL), HL_OK);
      for (size_t n = 0; n < W * H; n += 97)
        assert_true(hl_volume_value(volume, n % W, n / W % (H / 2), n / W / (H / 2)) ==
                    (unsigned char)(n * 7 + n / 255 + 50 * (size_t)c));
      hl_volume_release(volume);
    }
  }
  free(bytes);
}

static void test_spacing_takes_the_place_of_the_files(void **state) {
  (void)state;
  byte_buffer file = {.length = 0};
  add_text(&file,
           "NRRD0004\ntype: uint8\nencoding: raw\ndimension: 3\nsizes: 2 1 1\n"
           "space directions: (0,3,0) (1,0,0) (0,0,1)\nspace origin: (5,6,7)\n\n12");
  hl_volume_load_options options = options_of(&file, NULL, HL_COMPONENT_DEFAULT);
  options.spacing[0] = 0.5, options.spacing[1] = 2, options.spacing[2] = 4;
  hl_volume *volume = NULL;
  hl_volume_info info = {.struct_size = sizeof info};
  assert_int_equal(hl_volume_load_with(context, "memory", &options, &volume, NULL), HL_OK);
  assert_int_equal(hl_volume_get_info(volume, &info), HL_OK);
  for (int axis = 0; axis < 3; axis++) assert_true(info.spacing[axis] == options.spacing[axis]);
  assert_true(info.direction[1][0] == 1 && info.origin[0] == 5 && info.origin[2] == 7);
  hl_volume_release(volume);
  hl_error error = {0};
  for (int fault = 0; fault < 3; fault++) {
    options.spacing[1] = fault == 0 ? 0 : fault == 1 ? -1 : INFINITY;
    assert_int_equal(hl_volume_load_with(context, "memory", &options, &volume, &error), HL_ERROR_ARGUMENT);
    assert_non_null(strstr(error.message, "spacing[1]"));
  }
  options.struct_size = 8;
  assert_int_equal(hl_volume_load_with(context, "memory", &options, &volume, &error), HL_ERROR_ARGUMENT);
}

/* MRC: voxels of four bits, complex numbers, a cell of other angles, and headers that are refused. */
static void test_mrc(void **state) {
  (void)state;
  byte_buffer file = {.length = 1024};
  static const unsigned char words[] = {3, 0, 0, 0, 2, 0, 0, 0, 1, 0, 0, 0, 101, 0, 0, 0};
  static const float cell[6] = {6, 4, 5, 90, 120, 60};
  memset(file.data, 0, 1024);
  memcpy(file.data, words, sizeof words);
  memcpy(file.data + 28, (const int32_t[]){3, 2, 1}, 12);
  memcpy(file.data + 40, cell, sizeof cell);
  memcpy(file.data + 208, "MAP ", 4);
  add(&file, (const unsigned char[]){0x21, 0xf3, 0x54, 0x06}, 4);
  hl_error error = {0};
  hl_volume *volume = load(&file, NULL, HL_COMPONENT_DEFAULT, &error);
  static const double values[6] = {1, 2, 3, 4, 5, 6};
  for (size_t n = 0; n < 6; n++) assert_true(hl_volume_value(volume, n % 3, n / 3, 0) == values[n]);
  hl_volume_info info = {.struct_size = sizeof info};
  assert_int_equal(hl_volume_get_info(volume, &info), HL_OK);
  double dot[3] = {0};
  for (int axis = 0; axis < 3; axis++) {
    assert_true(fabs(info.spacing[axis] - (axis == 2 ? 5 : 2)) < 1e-12);
    for (int row = 0; row < 3; row++)
      dot[axis] += info.direction[row][(axis + 1) % 3] * info.direction[row][(axis + 2) % 3];
  }
  /* alpha is the angle of b and c, beta of c and a, gamma of a and b */
  assert_true(fabs(dot[0]) < 1e-12 && fabs(dot[1] + 0.5) < 1e-12 && fabs(dot[2] - 0.5) < 1e-12);
  assert_true(info.direction[1][0] == 0 && info.direction[2][0] == 0 && info.direction[2][1] == 0);
  hl_volume_release(volume);
  file.data[12] = 3; /* pairs of 16 bits */
  file.length = 1024;
  for (int n = 0; n < 6; n++) add(&file, (const int16_t[]){(int16_t)(3 * n), (int16_t)(-4 * n)}, 4);
  volume = load(&file, NULL, HL_COMPONENT_DEFAULT, &error);
  assert_true(hl_volume_value(volume, 2, 1, 0) == 25);
  hl_volume_release(volume);
  volume = load(&file, NULL, 1, &error);
  assert_true(hl_volume_value(volume, 2, 1, 0) == -20);
  hl_volume_release(volume);
  file.data[56] = file.data[60] = 0, file.data[58] = 52, file.data[59] = 67; /* beta 180: flat */
  assert_null(load(&file, NULL, 1, &error));
  assert_int_equal(error.code, HL_ERROR_INPUT);
  file.data[95] = 0x80;
  file.data[58] = file.data[59] = 0;
  assert_null(load(&file, NULL, 1, &error));
  assert_non_null(strstr(error.message, "extended header"));
}

/* IEEE 754 binary16: subnormal, normal, greatest, negative, infinite. */
static void test_values_of_half_floats(void **state) {
  (void)state;
  static const struct {
    unsigned bits;
    double value;
  } halves[] = {{0x0001, 0x1p-24},  {0x03ff, 0x3ffp-24}, {0x0400, 0x1p-14}, {0x3c00, 1},
                {0x7bff, 65504},    {0xc000, -2},        {0x8000, 0},       {0x3555, 0.333251953125},
                {0x7c00, INFINITY}, {0x7e00, NAN}};
  enum { COUNT = sizeof halves / sizeof *halves };
  byte_buffer file = {.length = 0};
  for (int n = 0; n < COUNT; n++) add_integer(&file, halves[n].bits, 2, false);
  hl_volume_load_options options = options_of(&file, NULL, HL_COMPONENT_DEFAULT);
  hl_volume *volume = NULL;
  assert_int_equal(hl_volume_load_with(context, "h_10x1x1_float16.raw", &options, &volume, NULL), HL_OK);
  for (size_t n = 0; n < COUNT; n++) {
    double value = hl_volume_value(volume, n, 0, 0);
    assert_true(isfinite(halves[n].value) ? value == halves[n].value : isnan(value));
  }
  hl_volume_release(volume);
}

/* A pipe is read once, up to the first array of one component or to the array that was named. */
static void test_a_pipe_is_read_once(void **state) {
  (void)state;
  static const char vtk[] =
      "# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 1 1\nPOINT_DATA 2\n"
      "VECTORS v float\n3 4 0 1 2 2\nSCALARS p short\nLOOKUP_TABLE default\n7 8\n"
      "SCALARS q short\nLOOKUP_TABLE default\n9 10\n";
  static const struct {
    const char *array;
    double first;
  } wanted[] = {{NULL, 7}, {"q", 9}, {"v", 5}};
  for (size_t n = 0; n < 3; n++) {
    int ends[2];
    char path[40];
    assert_int_equal(pipe(ends), 0);
    assert_int_equal(write(ends[1], vtk, sizeof vtk - 1), sizeof vtk - 1);
    close(ends[1]);
    snprintf(path, sizeof path, "/dev/fd/%d", ends[0]);
    hl_volume_load_options options = load_options(wanted[n].array, HL_COMPONENT_DEFAULT);
    hl_volume *volume = NULL;
    hl_error error = {0};
    if (hl_volume_load_with(context, path, &options, &volume, &error) != HL_OK) fail_msg("%s", error.message);
    assert_true(hl_volume_value(volume, 0, 0, 0) == wanted[n].first);
    hl_volume_release(volume);
    close(ends[0]);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test_setup_teardown(test_arrays_are_chosen_by_name, begin, end),
      cmocka_unit_test_setup_teardown(test_components, begin, end),
      cmocka_unit_test_setup_teardown(test_series, begin, end),
      cmocka_unit_test_setup_teardown(test_times_and_channels, begin, end),
      cmocka_unit_test_setup_teardown(test_large_components, begin, end),
      cmocka_unit_test_setup_teardown(test_spacing_takes_the_place_of_the_files, begin, end),
      cmocka_unit_test_setup_teardown(test_mrc, begin, end),
      cmocka_unit_test_setup_teardown(test_values_of_half_floats, begin, end),
      cmocka_unit_test_setup_teardown(test_a_pipe_is_read_once, begin, end)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
