/* tests/unit/image_hostile.c - damaged PNG, OpenEXR, NPY and TIFF files: cut at every length, and changed at
 * every byte. Decoders get each file in a block of its exact size, so that a sanitizer sees any read beyond
 * it. They must return an error or a picture, keep the memory limit, and release everything. */
#include "image_parts.h"

typedef hl_status (*decoder)(hl_context *, const char *, const unsigned char *, size_t, hl_image **,
                             hl_error *);

static hl_context *make_limited_context(void) {
  hl_context_options options;
  hl_context_options_defaults(&options);
  options.memory_limit = 64 << 20;
  hl_context *context = NULL;
  assert_int_equal(hl_context_create(&options, &context, NULL), HL_OK);
  return context;
}

/* The header of any bytes is read without harm. If the picture can be read, the header's numbers are right.
 */
static void check_claim(decoder function, const unsigned char *exact, size_t length, const hl_image *image) {
  hl_image_claim claim = function == hl_png_format.decode   ? hl_png_format.claim(exact, length)
                         : function == hl_exr_format.decode ? hl_exr_format.claim(exact, length)
                         : function == hl_tif_format.decode ? hl_tif_format.claim(exact, length)
                                                            : hl_npy_format.claim(exact, length);
  if (image == NULL) return;
  assert_true(claim.known);
  assert_int_equal(claim.width, image->width);
  assert_int_equal(claim.height, image->height);
  assert_true(claim.bytes >= claim.width * claim.height / 8);
  assert_true(claim.bytes <= claim.width * claim.height * 64 + claim.height);
}

/* Returns whether the picture has the bits of `expected`; true if there is no picture. */
static bool is_picture(const hl_image *image, const hl_image *expected) {
  return image == NULL ||
         (image->width == expected->width && image->height == expected->height &&
          memcmp(image->pixels, expected->pixels,
                 (size_t)expected->width * (size_t)expected->height * 4 * sizeof(float)) == 0);
}

/* expected: the picture that the file must have if it can be read; null: any picture. */
static hl_status decode(hl_context *context, decoder function, const unsigned char *bytes, size_t length,
                        const hl_image *expected) {
  unsigned char *exact = malloc(length > 0 ? length : 1);
  memcpy(exact, bytes, length);
  hl_image *image = NULL;
  hl_error error = {0};
  uint64_t held = hl_context_memory_held(context);
  hl_status status = function(context, "damaged", exact, length, &image, &error);
  if (status == HL_OK) {
    assert_non_null(image);
    volatile float last = image->pixels[(size_t)image->width * (size_t)image->height * 4 - 1];
    (void)last;
  } else {
    assert_null(image);
    assert_int_equal(error.code, status);
    assert_non_null(strstr(error.message, "damaged"));
    assert_null(strchr(error.message, '\n'));
  }
  check_claim(function, exact, length, image);
  if (expected != NULL && !is_picture(image, expected)) fail_msg("a damaged file gives another picture");
  hl_image_destroy(image);
  assert_int_equal(hl_context_memory_held(context), held);
  free(exact);
  return status;
}

static void damage(const char *extension, decoder function, int width, int height,
                   const hl_image_write_options *options) {
  hl_context *context = make_limited_context();
  char folder[64], path[100];
  make_folder(folder);
  snprintf(path, sizeof path, "%s/a.%s", folder, extension);
  hl_image *image = make_structured(context, width, height);
  assert_int_equal(hl_image_write(context, image, path, options, NULL), HL_OK);
  hl_image_destroy(image);
  size_t length;
  unsigned char *bytes = read_bytes(context, path, &length);
  hl_image *undamaged = NULL;
  assert_int_equal(function(context, "undamaged", bytes, length, &undamaged, NULL), HL_OK);
  /* Of these formats, only PNG has checksums. A damaged file that passes them must have the right picture. */
  const hl_image *expected = function == hl_png_format.decode ? undamaged : NULL;
  assert_int_equal(decode(context, function, bytes, length, undamaged), HL_OK);
  for (size_t cut = 0; cut < length; cut++)
    assert_int_not_equal(decode(context, function, bytes, cut, expected), HL_OK);
  uint32_t random = 7;
  for (size_t at = 0; at < length; at++) {
    unsigned char old = bytes[at];
    random = random * 1664525u + 1013904223u;
    const unsigned char values[] = {(unsigned char)(old ^ 1), (unsigned char)(old ^ 0x80), 0, 0xff,
                                    (unsigned char)(random >> 24)};
    for (size_t v = 0; v < sizeof values; v++) {
      bytes[at] = values[v];
      (void)decode(context, function, bytes, length, expected);
    }
    bytes[at] = old;
  }
  hl_image_destroy(undamaged);
  hl_release(context, bytes);
  remove_folder(folder);
  end_context(context);
}

static void damaged_png(void **state) {
  (void)state;
  hl_image_write_options options;
  hl_image_write_options_defaults(&options);
  options.scene_json = "{}";
  damage("png", hl_png_format.decode, 9, 7, &options);
  options.png_depth = 16;
  options.background_transparent = 1;
  damage("png", hl_png_format.decode, 2, 2, &options);
}

static void damaged_exr(void **state) {
  (void)state;
  damage("exr", hl_exr_format.decode, 9, 7, NULL);
  damage("exr", hl_exr_format.decode, 3, 40, NULL);
}

static void damaged_npy(void **state) {
  (void)state;
  damage("npy", hl_npy_format.decode, 5, 4, NULL);
}

static void damaged_tiff(void **state) {
  (void)state;
  hl_image_write_options options;
  hl_image_write_options_defaults(&options);
  if (hl_tif_format.decode == NULL) skip();
  damage("tif", hl_tif_format.decode, 9, 7, &options);
  options.png_depth = 16;
  options.background_transparent = 1;
  damage("tif", hl_tif_format.decode, 3, 4, &options);
}

/* PNG's checksums hide the rest of the decoder from damage. Here they are made right after each change. */
static uint32_t crc_of(const unsigned char *bytes, size_t length) {
  uint32_t crc = 0xffffffffu;
  for (size_t i = 0; i < length; i++) {
    crc ^= bytes[i];
    for (int bit = 0; bit < 8; bit++) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
  }
  return ~crc;
}

static uint32_t big_endian(const unsigned char *b) {
  return (uint32_t)b[0] << 24 | (uint32_t)b[1] << 16 | (uint32_t)b[2] << 8 | b[3];
}

static void mend_checksums(unsigned char *bytes, size_t length) {
  for (size_t at = 8; at + 12 <= length;) {
    size_t data = big_endian(bytes + at);
    if (data > length - at - 12) return;
    uint32_t crc = crc_of(bytes + at + 4, data + 4);
    for (int i = 0; i < 4; i++) bytes[at + 8 + data + (size_t)i] = (unsigned char)(crc >> (24 - 8 * i));
    at += data + 12;
  }
}

static void damaged_png_with_right_checksums(void **state) {
  (void)state;
  hl_context *context = make_limited_context();
  char folder[64], path[100];
  make_folder(folder);
  snprintf(path, sizeof path, "%s/a.png", folder);
  hl_image *image = make_structured(context, 9, 7);
  assert_int_equal(hl_image_write(context, image, path, NULL, NULL), HL_OK);
  hl_image_destroy(image);
  size_t length;
  unsigned char *bytes = read_bytes(context, path, &length), *changed = malloc(length);
  const unsigned char *found = memmem(bytes, length, "IDAT", 4);
  assert_non_null(found);
  size_t data = (size_t)(found + 4 - bytes), data_length = big_endian(found - 4);
  hl_image *expected = NULL;
  assert_int_equal(hl_png_format.decode(context, path, bytes, length, &expected, NULL), HL_OK);
  memcpy(changed, bytes, length);
  mend_checksums(changed, length);
  assert_memory_equal(changed, bytes, length);
  for (size_t at = 8; at < length; at++)
    for (int value = 0; value < 256; value += at < 60 ? 1 : 17) {
      memcpy(changed, bytes, length);
      changed[at] = (unsigned char)value;
      mend_checksums(changed, length);
      /* After the change, the header may have another size or kind of pixels. libpng does not check zlib's
       * own checksum once it has all rows, so that the compressed data may be of another picture. */
      bool of_header = at >= 8 && at < 33, of_pixels = at >= data && at < data + data_length;
      decode(context, hl_png_format.decode, changed, length, of_header || of_pixels ? NULL : expected);
    }
  free(changed);
  hl_image_destroy(expected);
  hl_release(context, bytes);
  remove_folder(folder);
  end_context(context);
}

/* A file of a few bytes that claims the greatest picture is refused before memory for its pixels is
 * allocated. */
static void claims_are_held_against_the_bytes(void **state) {
  (void)state;
  hl_context *context = make_context();
  unsigned char png[] = {0x89, 'P', 'N', 'G',  '\r', '\n', 0x1a, '\n', 0,    0,   0,   13, 'I', 'H', 'D',
                         'R',  0,   0,   0xff, 0xff, 0,    0,    0xff, 0xff, 8,   6,   0,  0,   0,   0,
                         0,    0,   0,   0,    0,    0,    0,    'I',  'D',  'A', 'T', 0,  0,   0,   0};
  mend_checksums(png, sizeof png);
  hl_image *image = NULL;
  hl_error error = {0};
  assert_int_equal(hl_png_format.decode(context, "bomb.png", png, sizeof png, &image, &error),
                   HL_ERROR_INPUT);
  assert_non_null(strstr(error.message, "can hold"));
  assert_true(hl_context_memory_peak(context) < 1 << 20);
  end_context(context);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(damaged_png),
                                     cmocka_unit_test(damaged_exr),
                                     cmocka_unit_test(damaged_npy),
                                     cmocka_unit_test(damaged_tiff),
                                     cmocka_unit_test(damaged_png_with_right_checksums),
                                     cmocka_unit_test(claims_are_held_against_the_bytes)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
