/* tests/unit/image_hdr.c - Radiance pictures: known pixels in each packing, orientations, damaged files. */
#include "image_parts.h"

static const char HEADER[] = "#?RADIANCE\n# by hand\nFORMAT=32-bit_rle_rgbe\n\n";

/* A file to which bytes are appended. */
typedef struct hdr_file {
  unsigned char bytes[4096];
  size_t length;
} hdr_file;

static void put(hdr_file *file, const void *bytes, size_t count) {
  memcpy(file->bytes + file->length, bytes, count);
  file->length += count;
}

static hdr_file begin(const char *size) {
  hdr_file file = {.length = 0};
  put(&file, HEADER, sizeof HEADER - 1);
  put(&file, size, strlen(size));
  return file;
}

static hl_status decode(hl_context *context, const hdr_file *file, hl_image **image, hl_error *error) {
  /* the file lies in a block of its exact size, so that sanitizers see reads beyond it */
  unsigned char *exact = malloc(file->length + 1);
  memcpy(exact, file->bytes, file->length);
  hl_status status = hl_hdr_format.decode(context, "x.hdr", exact, file->length, image, error);
  free(exact);
  return status;
}

static void check_pixel(hl_image *image, int x, int y, float red, float green, float blue) {
  const float *pixel = pixel_at(image, x, y);
  if (pixel[0] != red || pixel[1] != green || pixel[2] != blue || pixel[3] != 1)
    fail_msg("pixel %d %d is %g %g %g %g", x, y, (double)pixel[0], (double)pixel[1], (double)pixel[2],
             (double)pixel[3]);
}

/* A channel is m 2^(e - 136). The byte 128 with the exponent 129 is 1. */
static void test_plain_pixels(void **state) {
  (void)state;
  static const unsigned char pixels[] = {128, 64, 0, 129, 255, 1, 2, 136, 1, 1, 1, 0, 3, 5, 7, 100};
  hl_context *context = make_context();
  hl_image *image = NULL;
  hdr_file file = begin("-Y 2 +X 2\n");
  put(&file, pixels, sizeof pixels);
  assert_int_equal(decode(context, &file, &image, NULL), HL_OK);
  assert_int_equal(image->width, 2);
  assert_int_equal(image->height, 2);
  check_pixel(image, 0, 0, 1, 0.5f, 0);
  check_pixel(image, 1, 0, 255, 1, 2);
  check_pixel(image, 0, 1, 0, 0, 0);
  check_pixel(image, 1, 1, 3 * 0x1p-36f, 5 * 0x1p-36f, 7 * 0x1p-36f);
  hl_image_destroy(image);
  end_context(context);
}

static void test_orientations(void **state) {
  (void)state;
  static const char *const sizes[] = {"-Y 2 +X 2\n", "+Y 2 +X 2\n", "-Y 2 -X 2\n", "+Y 2 -X 2\n"};
  hl_context *context = make_context();
  for (int i = 0; i < 4; i++) {
    hl_image *image = NULL;
    hdr_file file = begin(sizes[i]);
    for (unsigned char n = 1; n <= 4; n++) put(&file, (unsigned char[4]){n, n, n, 136}, 4);
    assert_int_equal(decode(context, &file, &image, NULL), HL_OK);
    for (int n = 0; n < 4; n++) {
      int x = n % 2 ^ (i >= 2), y = n / 2 ^ (i % 2);
      check_pixel(image, x, y, (float)(n + 1), (float)(n + 1), (float)(n + 1));
    }
    hl_image_destroy(image);
  }
  end_context(context);
}

/* The pixel (1, 1, 1, n) repeats the pixel before it n times. A second one right after it counts 256 times as
 * much. */
static void test_runs_of_pixels(void **state) {
  (void)state;
  static const unsigned char pixels[] = {9, 8, 7, 136, 1, 1, 1, 3, 1, 1, 1, 1, 4, 4, 4, 136};
  hl_context *context = make_context();
  hl_image *image = NULL;
  hdr_file file = begin("-Y 1 +X 261\n");
  put(&file, pixels, sizeof pixels);
  assert_int_equal(decode(context, &file, &image, NULL), HL_OK);
  for (int x = 0; x < 260; x++) check_pixel(image, x, 0, 9, 8, 7);
  check_pixel(image, 260, 0, 4, 4, 4);
  hl_image_destroy(image);
  end_context(context);
}

/* Ten pixels, of which each channel is packed by itself: two equal reds and eight others; one green; falling
 * blues; one exponent. */
static hdr_file in_runs(void) {
  static const unsigned char row[] = {2,   2, 0,  10, 130, 5, 8, 1, 2, 3, 4, 5, 6, 7,   8,
                                      138, 6, 10, 9,  8,   7, 6, 5, 4, 3, 2, 1, 0, 138, 136};
  hdr_file file = begin("-Y 3 +X 10\n");
  for (int y = 0; y < 3; y++) put(&file, row, sizeof row);
  return file;
}

static void test_runs_of_bytes(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_image *image = NULL;
  hdr_file file = in_runs();
  assert_int_equal(decode(context, &file, &image, NULL), HL_OK);
  for (int y = 0; y < 3; y++)
    for (int x = 0; x < 10; x++) check_pixel(image, x, y, x < 2 ? 5 : (float)(x - 1), 6, (float)(9 - x));
  hl_image_claim claim = hl_hdr_format.claim(file.bytes, file.length);
  assert_true(claim.known && claim.width == 10 && claim.height == 3);
  hl_image_destroy(image);
  end_context(context);
}

/* A file that is cut at any length is refused. A file with any byte changed is read or refused. No memory is
 * left. */
static void test_damaged(void **state) {
  (void)state;
  hl_context *context = make_context();
  const hdr_file whole = in_runs();
  for (size_t at = 0; at < whole.length; at++)
    for (int value = -1; value < 256; value += at < 64 ? 1 : 5) {
      hl_image *image = NULL;
      hl_error error = {0};
      hdr_file file = whole;
      if (value < 0) file.length = at;
      else file.bytes[at] = (unsigned char)value;
      hl_status status = decode(context, &file, &image, &error);
      assert_true(value >= 0 || status != HL_OK);
      assert_true((status == HL_OK) == (image != NULL));
      assert_true(status == HL_OK || strncmp(error.message, "x.hdr: ", 7) == 0);
      hl_image_destroy(image);
      assert_int_equal(hl_context_memory_held(context), 0);
    }
  end_context(context);
}

/* A file of a few bytes that claims a large picture gets no memory for it. */
static void test_claims_too_much(void **state) {
  (void)state;
  static const char *const sizes[] = {"-Y 30000 +X 30000\n", "-Y 99999999999 +X 3\n", "-Y 0 +X 3\n",
                                      "-Y -5 +X 3\n",        "+X 3 +Y 3\n",           "-Y 3\n"};
  hl_context *context = make_context();
  for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
    hl_image *image = NULL;
    hl_error error = {0};
    hdr_file file = begin(sizes[i]);
    put(&file, (unsigned char[4]){1, 2, 3, 4}, 4);
    assert_int_not_equal(decode(context, &file, &image, &error), HL_OK);
    assert_true(hl_context_memory_peak(context) < 1 << 20);
  }
  end_context(context);
}

/* The format is found by the first bytes under any name, and is never written. */
static void test_files(void **state) {
  (void)state;
  hl_context *context = make_context();
  char folder[64], path[100];
  make_folder(folder);
  snprintf(path, sizeof path, "%s/a.png", folder);
  hdr_file file = in_runs();
  write_bytes(path, file.bytes, file.length);
  hl_image *image = NULL;
  hl_error error = {0};
  assert_int_equal(hl_image_read(context, path, &image, &error), HL_OK);
  snprintf(path, sizeof path, "%s/a.hdr", folder);
  assert_int_equal(hl_image_write(context, image, path, NULL, &error), HL_ERROR_UNSUPPORTED);
  hl_image_destroy(image);
  remove_folder(folder);
  end_context(context);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_plain_pixels),   cmocka_unit_test(test_orientations),
      cmocka_unit_test(test_runs_of_pixels), cmocka_unit_test(test_runs_of_bytes),
      cmocka_unit_test(test_damaged),        cmocka_unit_test(test_claims_too_much),
      cmocka_unit_test(test_files),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
