/* tests/unit/volume_create.c - volumes from memory: storage, strides, statistics, checks, and when voxels are
 * released. */
#include <stdlib.h>
#include <string.h>

#include "small_volume.h"
#include "volume/convert.h"

static hl_volume_info info_of(const hl_volume *volume) {
  hl_volume_info info = {.struct_size = sizeof info};
  assert_int_equal(hl_volume_get_info(volume, &info), HL_OK);
  return info;
}

/* Writes value number n of the series -3, -2, ... as the type has it; unsigned types start at 0. */
static double write_value(hl_voxel_type type, size_t n, unsigned char *place) {
  int value = (int)n - 3;
  switch (type) {
    case HL_VOXEL_U8: {
      uint8_t v = (uint8_t)n;
      memcpy(place, &v, 1);
      return v;
    }
    case HL_VOXEL_I8: {
      int8_t v = (int8_t)value;
      memcpy(place, &v, 1);
      return v;
    }
    case HL_VOXEL_U16: {
      uint16_t v = (uint16_t)(n * 2000);
      memcpy(place, &v, 2);
      return v;
    }
    case HL_VOXEL_I16: {
      int16_t v = (int16_t)(value * 1000);
      memcpy(place, &v, 2);
      return v;
    }
    case HL_VOXEL_U32: {
      uint32_t v = (uint32_t)n * 100000;
      memcpy(place, &v, 4);
      return v;
    }
    case HL_VOXEL_I32: {
      int32_t v = value * 100000;
      memcpy(place, &v, 4);
      return v;
    }
    case HL_VOXEL_F32: {
      float v = (float)value * 0.25f;
      memcpy(place, &v, 4);
      return (double)v;
    }
    case HL_VOXEL_U64: {
      uint64_t v = (uint64_t)n << 50;
      memcpy(place, &v, 8);
      return (double)v;
    }
    case HL_VOXEL_I64: {
      int64_t v = value * ((int64_t)1 << 50);
      memcpy(place, &v, 8);
      return (double)v;
    }
    case HL_VOXEL_F16: { /* a whole number: sign, exponent + 15, ten bits of fraction */
      int size = abs(value), exponent = 0;
      while (size >> (exponent + 1) != 0) exponent++;
      unsigned bits = size == 0
                          ? 0
                          : (unsigned)(exponent + 15) << 10 | ((unsigned)size << 10 >> exponent & 0x3ff);
      uint16_t v = (uint16_t)(bits | (value < 0 ? 0x8000u : 0));
      memcpy(place, &v, 2);
      return value;
    }
    case HL_VOXEL_F64: {
      double v = value * 0.125;
      memcpy(place, &v, 8);
      return v;
    }
  }
  return 0;
}

enum { NI = 4, NJ = 3, NK = 2, COUNT = NI * NJ * NK };

/* Each type, scaled, with any strides. The values come back, and the statistics follow from them. */
static void check_type(hl_voxel_type type, const ptrdiff_t stride_voxels[3], size_t first, double scale,
                       double shift) {
  hl_context *context = make_context();
  size_t bytes = hl_voxel_type_bytes(type);
  unsigned char *block = calloc(8 * COUNT, bytes);
  double expected[COUNT], sum = 0, low = INFINITY, high = -INFINITY;
  hl_volume_description description = describe_voxels(NI, NJ, NK, type, block + first * bytes);
  for (int axis = 0; axis < 3; axis++)
    description.stride_bytes[axis] = stride_voxels[axis] * (ptrdiff_t)bytes;
  for (size_t n = 0; n < COUNT; n++) {
    ptrdiff_t i = (ptrdiff_t)(n % NI), j = (ptrdiff_t)(n / NI % NJ), k = (ptrdiff_t)(n / NI / NJ);
    ptrdiff_t place = (ptrdiff_t)first + i * stride_voxels[0] + j * stride_voxels[1] + k * stride_voxels[2];
    expected[n] = scale * write_value(type, n, block + place * (ptrdiff_t)bytes) + shift;
    sum += expected[n];
    low = fmin(low, expected[n]);
    high = fmax(high, expected[n]);
  }
  description.value_scale = scale;
  description.value_offset = shift;
  hl_volume *volume = NULL;
  assert_int_equal(hl_volume_create(context, &description, &volume, NULL), HL_OK);
  free(block);
  for (size_t n = 0; n < COUNT; n++)
    assert_near(hl_volume_value(volume, n % NI, n / NI % NJ, n / NI / NJ), expected[n], 1e-9);
  hl_volume_info info = info_of(volume);
  assert_int_equal(info.type, type);
  assert_near(info.range[0], low, 1e-9);
  assert_near(info.range[1], high, 1e-9);
  assert_near(info.mean, sum / COUNT, 1e-12 * (high - low));
  assert_int_equal(info.nonfinite_count, 0);
  uint64_t counted = 0;
  for (int bin = 0; bin < HL_HISTOGRAM_BINS; bin++) counted += info.histogram[bin];
  assert_int_equal(counted, COUNT);
  assert_int_equal(info.histogram[0], 1); /* the values are all different and equally spaced */
  assert_int_equal(info.histogram[255], 1);
  hl_volume_release(volume);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

static void test_types_and_strides(void **state) {
  (void)state;
  const ptrdiff_t packed[3] = {1, NI, NI * NJ}, spread[3] = {2, 2 * NI, 2 * NI * NJ},
                  transposed[3] = {NJ * NK, NK, 1};
  const ptrdiff_t backwards[3] = {-1, -NI, -NI * NJ};
  for (int type = HL_VOXEL_U8; type <= HL_VOXEL_F16; type++) {
    check_type((hl_voxel_type)type, packed, 0, 1, 0);
    check_type((hl_voxel_type)type, packed, 0, -0.5, 7);
    check_type((hl_voxel_type)type, spread, 5, 1, 0);
    check_type((hl_voxel_type)type, transposed, 0, 2, -3);
    check_type((hl_voxel_type)type, backwards, COUNT - 1, 1, 0);
  }
}

static void test_extremes_of_each_type(void **state) {
  (void)state;
  hl_context *context = make_context();
  const int8_t i8[2] = {INT8_MIN, INT8_MAX};
  const int16_t i16[2] = {INT16_MIN, INT16_MAX};
  const uint16_t u16[2] = {0, UINT16_MAX};
  const int32_t i32[2] = {INT32_MIN, INT32_MAX};
  const uint32_t u32[2] = {0, UINT32_MAX};
  const struct {
    hl_voxel_type type;
    const void *voxels;
    double low, high;
  } cases[] = {{HL_VOXEL_I8, i8, -128, 127},
               {HL_VOXEL_I16, i16, -32768, 32767},
               {HL_VOXEL_U16, u16, 0, 65535},
               {HL_VOXEL_I32, i32, INT32_MIN, INT32_MAX},
               {HL_VOXEL_U32, u32, 0, UINT32_MAX}};
  for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
    hl_volume_description description = describe_voxels(2, 1, 1, cases[n].type, cases[n].voxels);
    hl_volume *volume = NULL;
    assert_int_equal(hl_volume_create(context, &description, &volume, NULL), HL_OK);
    assert_true(hl_volume_value(volume, 0, 0, 0) == cases[n].low);
    assert_true(hl_volume_value(volume, 1, 0, 0) == cases[n].high);
    hl_volume_release(volume);
  }
  hl_context_destroy(context);
}

static void test_borrowed_voxels_are_not_copied(void **state) {
  (void)state;
  hl_context *context = make_context();
  _Alignas(8) static const uint16_t voxels[8] = {1, 2, 3, 4, 5, 6, 7, 8};
  hl_volume_description description = describe_voxels(2, 2, 2, HL_VOXEL_U16, voxels);
  description.borrow = 1;
  hl_volume *volume = NULL;
  assert_int_equal(hl_volume_create(context, &description, &volume, NULL), HL_OK);
  assert_ptr_equal(volume->voxels, voxels);
  assert_null(volume->owned_voxels);
  hl_volume_release(volume);
  description.type = HL_VOXEL_I16; /* voxels of another layout must be copied, and be right */
  assert_int_equal(hl_volume_create(context, &description, &volume, NULL), HL_OK);
  assert_ptr_not_equal(volume->voxels, voxels);
  assert_true(hl_volume_value(volume, 1, 1, 1) == 8);
  hl_volume_release(volume);
  description.type = HL_VOXEL_U16; /* misaligned: copied */
  description.dimensions[0] = 1;
  description.voxels = (const char *)voxels + 1;
  assert_int_equal(hl_volume_create(context, &description, &volume, NULL), HL_OK);
  assert_non_null(volume->owned_voxels);
  hl_volume_release(volume);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* A box that is cut out of a larger array. It is borrowed if its rows are packed. The statistics and values
 * are those of the box. */
static void check_cut_box(hl_context *context, hl_voxel_type type, const void *whole, size_t bytes) {
  enum { X = 7, Y = 5, Z = 6 };
  hl_volume_description description = describe_voxels(4, 3, 2, type,
                                                      (const char *)whole + bytes * ((2 * Y + 1) * X + 2));
  description.borrow = 1;
  const ptrdiff_t stride[3] = {(ptrdiff_t)bytes, (ptrdiff_t)bytes * X, (ptrdiff_t)bytes * X * Y * 2};
  memcpy(description.stride_bytes, stride, sizeof stride);
  hl_volume *volume = NULL, *copy = NULL;
  assert_int_equal(hl_volume_create(context, &description, &volume, NULL), HL_OK);
  assert_ptr_equal(volume->voxels, description.voxels);
  for (size_t n = 0; n < 24; n++) {
    size_t i = n % 4, j = n / 4 % 3, k = n / 12;
    assert_true(hl_volume_value(volume, i, j, k) == (double)(((2 + 2 * k) * Y + 1 + j) * X + 2 + i));
  }
  description.borrow = 0;
  assert_int_equal(hl_volume_create(context, &description, &copy, NULL), HL_OK);
  assert_ptr_equal(copy->voxels, copy->owned_voxels);
  assert_true(volume->minimum == 79 && volume->maximum == copy->maximum && volume->mean == copy->mean);
  assert_memory_equal(volume->histogram, copy->histogram, sizeof copy->histogram);
  hl_volume_release(copy);
  hl_volume_release(volume);
}

static void test_rows_that_lie_apart_are_borrowed(void **state) {
  (void)state;
  hl_context *context = make_context();
  static uint8_t bytes[210];
  static uint16_t shorts[210];
  static float floats[210];
  for (int n = 0; n < 210; n++) bytes[n] = (uint8_t)n, shorts[n] = (uint16_t)n, floats[n] = (float)n;
  check_cut_box(context, HL_VOXEL_U8, bytes, 1);
  check_cut_box(context, HL_VOXEL_U16, shorts, 2);
  check_cut_box(context, HL_VOXEL_F32, floats, 4);
  /* Arrays with steps along a row, slices that overlap, or slices in falling order are copied. */
  const ptrdiff_t others[][3] = {{2, 14, 70}, {1, 7, 7}, {1, 7, 0}, {1, 35, 7}, {1, 7, -35}};
  for (size_t n = 0; n < sizeof others / sizeof *others; n++) {
    hl_volume_description description = describe_voxels(3, 2, 2, HL_VOXEL_U8, bytes + 100);
    description.borrow = 1;
    memcpy(description.stride_bytes, others[n], sizeof others[n]);
    hl_volume *volume = NULL;
    assert_int_equal(hl_volume_create(context, &description, &volume, NULL), HL_OK);
    assert_ptr_equal(volume->voxels, volume->owned_voxels);
    assert_true(hl_volume_value(volume, 2, 1, 1) ==
                (double)(100 + 2 * others[n][0] + others[n][1] + others[n][2]));
    hl_volume_release(volume);
  }
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

static void count_release(void *release_data, const void *voxels) {
  (void)voxels;
  ++*(int *)release_data;
}

/* Voxels are released once: with the last reference; at once if they were copied; never if the call failed.
 */
static void test_borrowed_voxels_are_given_back(void **state) {
  (void)state;
  hl_context *context = make_context();
  _Alignas(8) static const uint16_t voxels[8] = {1, 2, 3, 4, 5, 6, 7, 8};
  int released = 0;
  hl_volume_description description = describe_voxels(2, 2, 2, HL_VOXEL_U16, voxels);
  description.borrow = 1;
  description.release = count_release;
  description.release_data = &released;
  hl_volume *volume = NULL;
  assert_int_equal(hl_volume_create(context, &description, &volume, NULL), HL_OK);
  hl_volume_retain(volume);
  hl_volume_release(volume);
  assert_int_equal(released, 0);
  hl_volume_release(volume);
  assert_int_equal(released, 1);
  description.type = HL_VOXEL_I16; /* copied */
  assert_int_equal(hl_volume_create(context, &description, &volume, NULL), HL_OK);
  assert_int_equal(released, 2);
  hl_volume_release(volume);
  assert_int_equal(released, 2);
  description.value_scale = 0; /* refused */
  assert_int_equal(hl_volume_create(context, &description, &volume, NULL), HL_ERROR_ARGUMENT);
  assert_int_equal(released, 2);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

static void test_nonfinite_voxels(void **state) {
  (void)state;
  hl_context *context = make_context();
  float voxels[19];
  for (int n = 0; n < 19; n++) voxels[n] = (float)n;
  voxels[0] = NAN;
  voxels[9] = INFINITY;
  voxels[18] = -INFINITY;
  hl_volume_description description = describe_voxels(19, 1, 1, HL_VOXEL_F32, voxels);
  hl_volume *volume = NULL;
  assert_int_equal(hl_volume_create(context, &description, &volume, NULL), HL_OK);
  hl_volume_info info = info_of(volume);
  assert_int_equal(info.nonfinite_count, 3);
  assert_true(info.range[0] == 1 && info.range[1] == 17);
  assert_near(info.mean, (17 * 18 / 2 - 9) / 16.0, 1e-12);
  for (int bin = 1; bin < 17; bin++) assert_int_equal(info.histogram[(bin - 1) * 16], bin != 9);
  assert_int_equal(info.histogram[255], 1);
  assert_true(isnan(hl_volume_value(volume, 0, 0, 0)) && isnan(hl_volume_value(volume, 9, 0, 0)));
  assert_true(isnan(hl_volume_value(volume, 19, 0, 0)) && isnan(hl_volume_value(volume, 0, 1, 0)));
  hl_volume_release(volume);
  const double all[3] = {NAN, 1e300, -INFINITY}; /* 1e300 is beyond f32 */
  description = describe_voxels(3, 1, 1, HL_VOXEL_F64, all);
  assert_int_equal(hl_volume_create(context, &description, &volume, NULL), HL_OK);
  info = info_of(volume);
  assert_int_equal(info.nonfinite_count, 3);
  assert_true(info.range[0] == 0 && info.range[1] == 0 && info.mean == 0);
  hl_volume_release(volume);
  hl_context_destroy(context);
}

static void test_constant_volume(void **state) {
  (void)state;
  hl_context *context = make_context();
  for (int type = HL_VOXEL_U8; type <= HL_VOXEL_F16; type++) {
    unsigned char voxels[27 * 8];
    size_t bytes = hl_voxel_type_bytes((hl_voxel_type)type);
    double value = 0;
    for (size_t n = 0; n < 27; n++) value = write_value((hl_voxel_type)type, 7, voxels + n * bytes);
    hl_volume_description description = describe_voxels(3, 3, 3, (hl_voxel_type)type, voxels);
    hl_volume *volume = NULL;
    assert_int_equal(hl_volume_create(context, &description, &volume, NULL), HL_OK);
    hl_volume_info info = info_of(volume);
    assert_true(info.range[0] == value && info.range[1] == value && info.mean == value);
    assert_int_equal(info.histogram[0], 27);
    hl_volume_release(volume);
  }
  hl_context_destroy(context);
}

/* The bins of the histogram of u8 data from 0 to 255 are its values, mirrored if the scale is negative. */
static void test_histogram_bins(void **state) {
  (void)state;
  hl_context *context = make_context();
  static uint8_t voxels[256 * 257 / 2];
  size_t used = 0;
  for (int value = 0; value < 256; value++)
    for (int n = 0; n <= value; n++) voxels[used++] = (uint8_t)value;
  hl_volume_description description = describe_voxels(used, 1, 1, HL_VOXEL_U8, voxels);
  for (int sign = 1; sign >= -1; sign -= 2) {
    description.value_scale = sign * 3;
    hl_volume *volume = NULL;
    assert_int_equal(hl_volume_create(context, &description, &volume, NULL), HL_OK);
    hl_volume_info info = info_of(volume);
    for (int bin = 0; bin < 256; bin++) assert_int_equal(info.histogram[bin], sign > 0 ? bin + 1 : 256 - bin);
    hl_volume_release(volume);
  }
  hl_context_destroy(context);
}

static void test_place_in_the_world(void **state) {
  (void)state;
  hl_context *context = make_context();
  const uint8_t voxels[8] = {0};
  hl_volume_description description = describe_voxels(2, 2, 2, HL_VOXEL_U8, voxels);
  const double axes[3][3] = {{0, 3, 4}, {-2, 0, 0}, {0, 0, 7}}; /* oblique and right-handed */
  memcpy(description.axis, axes, sizeof axes);
  description.origin[1] = -5;
  hl_volume *volume = NULL;
  for (int sign = 1; sign >= -1; sign -= 2) {
    description.axis[2][2] = 7 * sign;
    assert_int_equal(hl_volume_create(context, &description, &volume, NULL), HL_OK);
    hl_volume_info info = info_of(volume);
    assert_true(info.spacing[0] == 5 && info.spacing[1] == 2 && info.spacing[2] == 7);
    assert_true(info.direction[1][0] == 0.6 && info.direction[2][0] == 0.8 && info.direction[0][1] == -1);
    assert_true(info.direction[2][2] == sign && info.origin[1] == -5);
    vec3 world = affine3_apply(volume->index_to_world, (vec3){1, 1, 1});
    assert_true(world.x == -2 && world.y == -2 && world.z == 4 + 7 * sign);
    hl_volume_release(volume);
  }
  hl_context_destroy(context);
}

static void test_impossible_descriptions(void **state) {
  (void)state;
  hl_context *context = make_context();
  const uint8_t voxels[8] = {0};
  hl_volume *volume = NULL;
  for (int fault = 0; fault < 14; fault++) {
    hl_volume_description description = describe_voxels(2, 2, 2, HL_VOXEL_U8, voxels);
    switch (fault) {
      case 0: description.dimensions[1] = 0; break;
      case 1: description.dimensions[2] = SIZE_MAX; break;
      case 2:
        for (int axis = 0; axis < 3; axis++) description.dimensions[axis] = INT32_MAX;
        break;
      case 3: description.type = (hl_voxel_type)0; break;
      case 4: description.type = (hl_voxel_type)12; break;
      case 5: description.axis[1][1] = 0; break;
      case 6: description.axis[1][1] = NAN; break;
      case 7: memcpy(description.axis[2], description.axis[0], sizeof description.axis[0]); break;
      case 8: description.origin[0] = INFINITY; break;
      case 9: description.value_scale = 0; break;
      case 10: description.value_offset = NAN; break;
      case 11: description.voxels = NULL; break;
      case 12: description.struct_size--; break;
      default: description.type = (hl_voxel_type)-1; break;
    }
    hl_error error = {0};
    assert_int_equal(hl_volume_create(context, &description, &volume, &error), HL_ERROR_ARGUMENT);
    assert_null(volume);
    assert_int_equal(error.code, HL_ERROR_ARGUMENT);
    assert_true(strlen(error.message) > 20 && strchr(error.message, '\n') == NULL);
  }
  assert_int_equal(hl_volume_create(NULL, NULL, &volume, NULL), HL_ERROR_ARGUMENT);
  assert_int_equal(hl_volume_get_info(NULL, NULL), HL_ERROR_ARGUMENT);
  assert_true(isnan(hl_volume_value(NULL, 0, 0, 0)));
  hl_volume_release(NULL);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

static void test_memory_limit_and_counting(void **state) {
  (void)state;
  hl_context_options options;
  hl_context_options_defaults(&options);
  options.memory_limit = 100000;
  hl_context *context = NULL;
  assert_int_equal(hl_context_create(&options, &context, NULL), HL_OK);
  unsigned char *voxels = calloc(200000, 1);
  hl_volume_description description = describe_voxels(100, 100, 20, HL_VOXEL_I8, voxels);
  hl_volume *volume = NULL;
  assert_int_equal(hl_volume_create(context, &description, &volume, NULL), HL_ERROR_MEMORY);
  assert_null(volume);
  assert_int_equal(hl_context_memory_held(context), 0);
  description.dimensions[2] = 2;
  assert_int_equal(hl_volume_create(context, &description, &volume, NULL), HL_OK);
  hl_volume_retain(volume);
  hl_volume_release(volume);
  assert_true(hl_volume_value(volume, 0, 0, 0) == 0);
  hl_volume_release(volume);
  assert_int_equal(hl_context_memory_held(context), 0);
  free(voxels);
  hl_context_destroy(context);
}

/* Bytes in the other order give the same volume, also in place and at odd addresses. */
static void test_byte_order(void **state) {
  (void)state;
  for (int t = HL_VOXEL_U8; t <= HL_VOXEL_F16; t++) {
    hl_voxel_type type = (hl_voxel_type)t;
    size_t bytes = hl_voxel_type_bytes(type);
    unsigned char native[8 * 5 + 1], swapped[8 * 5 + 1], from_native[40], from_swapped[40];
    for (size_t n = 0; n < 5; n++) {
      write_value(type, n, native + 1 + n * bytes);
      for (size_t b = 0; b < bytes; b++) swapped[1 + n * bytes + b] = native[1 + n * bytes + bytes - 1 - b];
    }
    hl_voxels_store(type, false, native + 1, 5, from_native);
    hl_voxels_store(type, true, swapped + 1, 5, from_swapped);
    size_t stored = 5 * hl_storage_bytes(hl_voxel_type_storage(type));
    assert_memory_equal(from_native, from_swapped, stored);
    if (stored != 5 * bytes) continue;
    hl_voxels_store(type, true, swapped + 1, 5, swapped + 1);
    assert_memory_equal(from_native, swapped + 1, stored);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_types_and_strides),
      cmocka_unit_test(test_extremes_of_each_type),
      cmocka_unit_test(test_borrowed_voxels_are_not_copied),
      cmocka_unit_test(test_rows_that_lie_apart_are_borrowed),
      cmocka_unit_test(test_borrowed_voxels_are_given_back),
      cmocka_unit_test(test_nonfinite_voxels),
      cmocka_unit_test(test_constant_volume),
      cmocka_unit_test(test_histogram_bins),
      cmocka_unit_test(test_place_in_the_world),
      cmocka_unit_test(test_impossible_descriptions),
      cmocka_unit_test(test_memory_limit_and_counting),
      cmocka_unit_test(test_byte_order),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
