/* tests/unit/image_exact.c - the sizes of pictures, and the formats that keep every bit: OpenEXR and NPY. */
#include "image_parts.h"

#include "image/exr.h"

static void sizes_have_limits(void **state) {
  (void)state;
  hl_context *context = make_context();
  const int bad[][2] = {{0, 5}, {5, 0}, {-1, 5}, {65536, 1}, {1, 65536}, {2147483647, 2147483647}};
  hl_image *image = NULL;
  hl_error error = {0};
  for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++)
    assert_int_equal(hl_image_create(context, bad[i][0], bad[i][1], &image, &error), HL_ERROR_ARGUMENT);
  assert_non_null(strstr(error.message, "65535"));
  assert_null(image);
  image = make_image(context, 65535, 1);
  assert_int_equal(hl_image_width(image), 65535);
  assert_int_equal(hl_image_height(image), 1);
  assert_ptr_equal(hl_image_pixels(image), hl_image_pixels_const(image));
  for (size_t i = 0; i < 65535 * 4; i++) assert_true(hl_image_pixels(image)[i] == 0);
  hl_image_destroy(image);
  hl_image_destroy(NULL);
  end_context(context);
}

static void memory_limit_is_kept(void **state) {
  (void)state;
  hl_context_options options;
  hl_context_options_defaults(&options);
  options.memory_limit = 100000;
  hl_context *context = NULL;
  hl_image *image = NULL;
  assert_int_equal(hl_context_create(&options, &context, NULL), HL_OK);
  assert_int_equal(hl_image_create(context, 100, 100, &image, NULL), HL_ERROR_MEMORY);
  assert_int_equal(hl_image_create(context, 100, 50, &image, NULL), HL_OK);
  hl_image_destroy(image);
  end_context(context);
}

/* Numbers of all kinds keep their bits: both signs, denormal, above 1, infinite, and NaN with a payload. */
static void fill_with_all_kinds(hl_image *image) {
  static const uint32_t kinds[] = {0,           0x80000000u, 1,           0x807fffffu,
                                   0x3f800001u, 0xbf000000u, 0x7f7fffffu, 0x7f800000u,
                                   0xff800000u, 0x7fc12345u, 0x42280000u};
  size_t count = (size_t)image->width * (size_t)image->height * 4;
  uint32_t random = 1;
  for (size_t i = 0; i < count; i++) {
    random = random * 1664525u + 1013904223u;
    uint32_t bits = i % 3 == 0 ? kinds[i / 3 % (sizeof kinds / sizeof kinds[0])] : random >> 2;
    memcpy(&image->pixels[i], &bits, 4);
  }
}

static void exr_and_npy_keep_every_bit(void **state) {
  (void)state;
  hl_context *context = make_context();
  char folder[64], path[100];
  make_folder(folder);
  const int sizes[][2] = {{1, 1}, {7, 5}, {1, 40}, {300, 1}, {33, 47}, {129, 64}};
  const char *names[] = {"a.exr", "a.npy", "b.EXR"};
  for (size_t s = 0; s < sizeof sizes / sizeof sizes[0]; s++)
    for (int n = 0; n < 3; n++) {
      hl_image *image = make_image(context, sizes[s][0], sizes[s][1]), *back = NULL;
      fill_with_all_kinds(image);
      hl_error error = {0};
      snprintf(path, sizeof path, "%s/%s", folder, names[n]);
      if (hl_image_write(context, image, path, NULL, &error) != HL_OK) fail_msg("%s", error.message);
      if (hl_image_read(context, path, &back, &error) != HL_OK) fail_msg("%s", error.message);
      assert_int_equal(back->width, image->width);
      assert_int_equal(back->height, image->height);
      assert_memory_equal(back->pixels, image->pixels, (size_t)image->width * (size_t)image->height * 16);
      hl_image_destroy(image);
      hl_image_destroy(back);
    }
  assert_int_equal(count_files(folder), 3);
  remove_folder(folder);
  end_context(context);
}

/* The bytes of a picture written to memory are those of the file. */
static void encoding_gives_the_file(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_image *image = make_structured(context, 37, 21);
  hl_error error = {0};
  char folder[64], path[100];
  make_folder(folder);
  static const char *const formats[] = {"png", "exr", "npy"};
  for (int n = 0; n < 3; n++) {
    unsigned char *encoded = NULL, *written = NULL;
    size_t encoded_bytes = 0, written_bytes = 0;
    snprintf(path, sizeof path, "%s/a.%s", folder, formats[n]);
    assert_int_equal(hl_image_write(context, image, path, NULL, &error), HL_OK);
    assert_int_equal(hl_image_encode(context, image, formats[n], NULL, &encoded, &encoded_bytes, &error),
                     HL_OK);
    assert_int_equal(hl_file_read(context, path, 1 << 20, &written, &written_bytes, &error), HL_OK);
    assert_int_equal(encoded_bytes, written_bytes);
    assert_memory_equal(encoded, written, written_bytes);
    hl_release(context, written);
    hl_bytes_release(context, encoded);
  }
  unsigned char *bytes = NULL;
  size_t length = 0;
  assert_int_equal(hl_image_encode(context, image, "jpg", NULL, &bytes, &length, &error),
                   HL_ERROR_UNSUPPORTED);
  float *layer = NULL;
  assert_int_equal(hl_image_add_layer(image, "depth", "Z", &layer, &error), HL_OK);
  assert_int_equal(hl_image_encode(context, image, "npy", NULL, &bytes, &length, &error),
                   HL_ERROR_UNSUPPORTED);
  assert_int_equal(hl_image_encode(context, NULL, "npy", NULL, &bytes, &length, &error), HL_ERROR_ARGUMENT);
  assert_null(bytes);
  hl_image_destroy(image);
  remove_folder(folder);
  end_context(context);
}

/* A picture with more channels than the library's fast store has, with other strides, and with channels
 * beside the picture's own. */
static void exr_takes_layers(void **state) {
  (void)state;
  enum { W = 19, H = 35 };
  hl_context *context = make_context();
  hl_image *image = make_structured(context, W, H), *back = NULL;
  float *depth = malloc(sizeof *depth * W * H);
  for (int i = 0; i < W * H; i++) depth[i] = (float)i;
  const hl_exr_channel channels[] = {{"R", image->pixels, 4},
                                     {"G", image->pixels + 1, 4},
                                     {"B", image->pixels + 2, 4},
                                     {"A", image->pixels + 3, 4},
                                     {"Z", depth, 1},
                                     {"shadow.Y", image->pixels + 1, 4},
                                     {"density", depth, 1}};
  char folder[64], path[100];
  make_folder(folder);
  snprintf(path, sizeof path, "%s/layers.exr", folder);
  hl_output output;
  assert_int_equal(hl_output_begin(context, path, &output, NULL), HL_OK);
  assert_int_equal(hl_exr_encode_channels(W, H, channels, 7, &output, NULL), HL_OK);
  assert_int_equal(hl_output_commit(&output, NULL), HL_OK);
  assert_int_equal(hl_image_read(context, path, &back, NULL), HL_OK);
  assert_memory_equal(back->pixels, image->pixels, W * H * 16);
  free(depth);
  hl_image_destroy(image);
  hl_image_destroy(back);
  remove_folder(folder);
  end_context(context);
}

static bool holds_text(const unsigned char *bytes, size_t length, const char *text) {
  for (size_t i = 0; i + strlen(text) < length; i++)
    if (memcmp(bytes + i, text, strlen(text) + 1) == 0) return true;
  return false;
}

/* Layers become channels of an .exr, and files beside an .npy. The picture itself reads back as without them.
 */
static void pictures_hold_layers(void **state) {
  (void)state;
  enum { W = 19, H = 35 };
  hl_context *context = make_context();
  hl_image *image = make_structured(context, W, H), *back = NULL;
  float *key = NULL, *depth = NULL;
  assert_int_equal(hl_image_add_layer(image, "key", "RGB", &key, NULL), HL_OK);
  assert_int_equal(hl_image_add_layer(image, "depth_mean", "Z", &depth, NULL), HL_OK);
  for (int i = 0; i < 3 * W * H; i++) {
    assert_true(key[i] == 0);
    key[i] = (float)i;
  }
  for (int i = 0; i < W * H; i++) depth[i] = i == 7 ? INFINITY : (float)i / 3;
  char folder[64], path[100];
  make_folder(folder);
  snprintf(path, sizeof path, "%s/a.exr", folder);
  assert_int_equal(hl_image_write(context, image, path, NULL, NULL), HL_OK);
  size_t length;
  unsigned char *bytes = read_bytes(context, path, &length);
  static const char *const channels[] = {"A", "B", "G", "R", "key.R", "key.G", "key.B", "depth_mean.Z"};
  for (size_t i = 0; i < 8; i++) assert_true(holds_text(bytes, length, channels[i]));
  assert_false(holds_text(bytes, length, "depth_mean.R"));
  hl_release(context, bytes);
  assert_int_equal(hl_image_read(context, path, &back, NULL), HL_OK);
  assert_memory_equal(back->pixels, image->pixels, W * H * 16);
  hl_image_destroy(back);
  snprintf(path, sizeof path, "%s/a.npy", folder);
  assert_int_equal(hl_image_write(context, image, path, NULL, NULL), HL_OK);
  assert_int_equal(count_files(folder), 4);
  snprintf(path, sizeof path, "%s/a-key.npy", folder);
  assert_int_equal(hl_image_read(context, path, &back, NULL), HL_OK);
  for (int i = 0; i < W * H; i++) assert_memory_equal(back->pixels + 4 * i, key + 3 * i, 12);
  hl_image_destroy(back);
  snprintf(path, sizeof path, "%s/a-depth_mean.npy", folder);
  assert_int_equal(hl_image_read(context, path, &back, NULL), HL_OK);
  for (int i = 0; i < W * H; i++) assert_true(back->pixels[4 * i] == depth[i]);
  hl_image_destroy(back);
  hl_image_destroy(image);
  remove_folder(folder);
  end_context(context);
}

/* ---- OpenEXR files of other programs: built by hand from the format's description ---- */

typedef struct bytes {
  unsigned char data[4096];
  size_t length;
} bytes;

static void put(bytes *b, const void *data, size_t length) {
  assert_true(b->length + length <= sizeof b->data);
  memcpy(b->data + b->length, data, length);
  b->length += length;
}

static void put_int(bytes *b, uint64_t value, size_t size) {
  for (size_t i = 0; i < size; i++) put(b, &(unsigned char){(unsigned char)(value >> 8 * i)}, 1);
}

static void put_text(bytes *b, const char *text) { put(b, text, strlen(text) + 1); }

static void put_attribute(bytes *b, const char *name, const char *type, uint32_t size) {
  put_text(b, name);
  put_text(b, type);
  put_int(b, size, 4);
}

/* Makes a header for width x height pixels whose data window begins at (x, y). channels: names of one letter;
 * all have the type pixel_type (0 integer, 1 half, 2 float). */
static void put_exr_header(bytes *b, const char *channels, int pixel_type, int sampling, int compression,
                           int x, int y, int width, int height) {
  put_int(b, 20000630, 4);
  put_int(b, 2, 4);
  put_attribute(b, "channels", "chlist", (uint32_t)strlen(channels) * 18 + 1);
  for (const char *c = channels; *c != 0; c++) {
    put_text(b, (char[]){*c, 0});
    put_int(b, (uint64_t)pixel_type, 4);
    put_int(b, 0, 4);
    put_int(b, (uint64_t)sampling, 4);
    put_int(b, (uint64_t)sampling, 4);
  }
  put_int(b, 0, 1);
  put_attribute(b, "compression", "compression", 1);
  put_int(b, (uint64_t)compression, 1);
  const char *windows[] = {"dataWindow", "displayWindow"};
  for (int w = 0; w < 2; w++) {
    put_attribute(b, windows[w], "box2i", 16);
    put_int(b, (uint32_t)x, 4);
    put_int(b, (uint32_t)y, 4);
    put_int(b, (uint32_t)(x + width - 1), 4);
    put_int(b, (uint32_t)(y + height - 1), 4);
  }
  put_attribute(b, "lineOrder", "lineOrder", 1);
  put_int(b, 0, 1);
  const uint32_t one = 0x3f800000;
  put_attribute(b, "pixelAspectRatio", "float", 4);
  put_int(b, one, 4);
  put_attribute(b, "screenWindowCenter", "v2f", 8);
  put_int(b, 0, 8);
  put_attribute(b, "screenWindowWidth", "float", 4);
  put_int(b, one, 4);
  put_int(b, 0, 1);
}

/* Writes uncompressed lines with the samples value(line, channel, column). */
static void put_exr_lines(bytes *b, int channel_count, int sample_bytes, int y, int width, int height,
                          uint32_t (*value)(int, int, int)) {
  size_t line_bytes = (size_t)(channel_count * width * sample_bytes), first = b->length + 8 * (size_t)height;
  for (int line = 0; line < height; line++) put_int(b, first + (size_t)line * (line_bytes + 8), 8);
  for (int line = 0; line < height; line++) {
    put_int(b, (uint32_t)(y + line), 4);
    put_int(b, line_bytes, 4);
    for (int c = 0; c < channel_count; c++)
      for (int x = 0; x < width; x++) put_int(b, value(line, c, x), (size_t)sample_bytes);
  }
}

/* Half floats -2, -1, -0.5 ..., one for each exponent, whose floats are seen to be exact. */
static uint32_t half_value(int line, int channel, int x) {
  return (uint32_t)(0x3c00 + 0x400 * (channel + line - 1)) | (x % 2 ? 0x8000u : 0u);
}

static void exr_halves_and_offsets_are_read(void **state) {
  (void)state;
  hl_context *context = make_context();
  bytes b = {.length = 0};
  put_exr_header(&b, "BGR", 1, 1, 0, -3, 7, 5, 3);
  put_exr_lines(&b, 3, 2, 7, 5, 3, half_value);
  hl_image *image = NULL;
  hl_error error = {0};
  if (hl_exr_format.decode(context, "half.exr", b.data, b.length, &image, &error) != HL_OK)
    fail_msg("%s", error.message);
  assert_int_equal(image->width, 5);
  assert_int_equal(image->height, 3);
  for (int y = 0; y < 3; y++)
    for (int x = 0; x < 5; x++) {
      const float *pixel = pixel_at(image, x, y), sign = x % 2 ? -1.0f : 1.0f;
      for (int c = 0; c < 3; c++) assert_true(pixel[2 - c] == sign * ldexpf(1, c + y - 1));
      assert_true(pixel[3] == 1);
    }
  hl_image_destroy(image);
  end_context(context);
}

static uint32_t count_value(int line, int channel, int x) {
  return (uint32_t)(100 * channel + 10 * line + x);
}

static void exr_grey_and_integers_are_read(void **state) {
  (void)state;
  hl_context *context = make_context();
  bytes b = {.length = 0};
  put_exr_header(&b, "AYZ", 0, 1, 0, 0, 0, 4, 2);
  put_exr_lines(&b, 3, 4, 0, 4, 2, count_value);
  hl_image *image = NULL;
  hl_error error = {0};
  if (hl_exr_format.decode(context, "grey.exr", b.data, b.length, &image, &error) != HL_OK)
    fail_msg("%s", error.message);
  for (int y = 0; y < 2; y++)
    for (int x = 0; x < 4; x++) {
      const float *pixel = pixel_at(image, x, y);
      for (int c = 0; c < 3; c++) assert_true(pixel[c] == (float)(100 + 10 * y + x));
      assert_true(pixel[3] == (float)(10 * y + x));
    }
  hl_image_destroy(image);
  end_context(context);
}

static void exr_of_other_kinds_is_refused(void **state) {
  (void)state;
  hl_context *context = make_context();
  const struct {
    const char *channels;
    int sampling, compression, width, height;
    hl_status status;
    const char *word;
  } cases[] = {{"BGR", 2, 0, 4, 2, HL_ERROR_UNSUPPORTED, "subsampled"},
               {"GR", 1, 0, 4, 2, HL_ERROR_UNSUPPORTED, "channels R, G"},
               {"GRY", 1, 0, 4, 2, HL_ERROR_UNSUPPORTED, "channels R, G"},
               {"BGR", 1, 6, 4, 2, HL_ERROR_UNSUPPORTED, "ZIP"},
               {"BGR", 1, 8, 4, 2, HL_ERROR_UNSUPPORTED, "ZIP"},
               {"BGR", 1, 3, 60000, 60000, HL_ERROR_INPUT, "60000"},
               {"BGR", 1, 3, 70000, 2, HL_ERROR_INPUT, "exr"}};
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    bytes b = {.length = 0};
    put_exr_header(&b, cases[i].channels, 2, cases[i].sampling, cases[i].compression, 0, 0, cases[i].width,
                   cases[i].height);
    if (cases[i].width == 4) put_exr_lines(&b, (int)strlen(cases[i].channels), 4, 0, 4, 2, count_value);
    hl_image *image = NULL;
    hl_error error = {0};
    hl_status status = hl_exr_format.decode(context, "x.exr", b.data, b.length, &image, &error);
    if (status != cases[i].status || strstr(error.message, cases[i].word) == NULL)
      fail_msg("case %zu: status %d: %s", i, status, error.message);
  }
  assert_true(hl_context_memory_peak(context) < 1 << 20);
  end_context(context);
}

/* ---- NPY of other shapes ---- */

static hl_status decode_npy(hl_context *context, int version, const char *header, const void *data,
                            size_t length, hl_image **image, hl_error *error) {
  bytes b = {.length = 0};
  put(&b, "\x93NUMPY", 6);
  put_int(&b, (uint64_t)version, 2);
  put_int(&b, strlen(header), version == 1 ? 2 : 4);
  put(&b, header, strlen(header));
  put(&b, data, length);
  *image = NULL;
  return hl_npy_format.decode(context, "x.npy", b.data, b.length, image, error);
}

static void npy_of_other_shapes_is_read(void **state) {
  (void)state;
  hl_context *context = make_context();
  const float floats[12] = {0.5f, -1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
  const double doubles[12] = {0.5, -1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
  const struct {
    int version, channels;
    size_t value;
    const char *header;
  } cases[] = {{1, 1, 4, "{'descr': '<f4', 'fortran_order': False, 'shape': (3, 4), }"},
               {1, 1, 8, "{\"shape\":(3,4,1),\"descr\":\"<f8\",\"fortran_order\":False}"},
               {2, 3, 4, "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 2, 3), }   \n"},
               {3, 4, 8, "{ 'fortran_order' : False , 'shape' : ( 3 , 1 , 4 , ) , 'descr' : '<f8' }"}};
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    hl_image *image = NULL;
    hl_error error = {0};
    const void *data = cases[i].value == 4 ? (const void *)floats : (const void *)doubles;
    if (decode_npy(context, cases[i].version, cases[i].header, data, 12 * cases[i].value, &image, &error) !=
        HL_OK)
      fail_msg("%s", error.message);
    int n = cases[i].channels;
    assert_int_equal(image->width * image->height * n, 12);
    for (int p = 0; p < 12 / n; p++)
      for (int c = 0; c < 4; c++)
        assert_true(image->pixels[4 * p + c] == (c == 3 && n < 4 ? 1 : floats[p * n + (n == 1 ? 0 : c)]));
    hl_image_destroy(image);
  }
  end_context(context);
}

static void npy_of_other_kinds_is_refused(void **state) {
  (void)state;
  hl_context *context = make_context();
  const struct {
    const char *header;
    hl_status status;
    const char *word;
  } cases[] = {
      {"{'descr': '>f4', 'fortran_order': False, 'shape': (3, 4), }", HL_ERROR_UNSUPPORTED, "astype"},
      {"{'descr': '<i4', 'fortran_order': False, 'shape': (3, 4), }", HL_ERROR_UNSUPPORTED, "'<i4'"},
      {"{'descr': '<f4', 'fortran_order': True, 'shape': (3, 4), }", HL_ERROR_UNSUPPORTED,
       "ascontiguousarray"},
      {"{'descr': '<f4', 'fortran_order': False, 'shape': (12,), }", HL_ERROR_UNSUPPORTED, "1 dimensions"},
      {"{'descr': '<f4', 'fortran_order': False, 'shape': (3, 2, 2), }", HL_ERROR_UNSUPPORTED, "1, 3 or 4"},
      {"{'descr': '<f4', 'fortran_order': False, 'shape': (1, 1, 3, 4), }", HL_ERROR_UNSUPPORTED,
       "4 dimensions"},
      {"{'descr': '<f4', 'fortran_order': False, 'shape': (3, 5), }", HL_ERROR_INPUT, "expected 60"},
      {"{'descr': '<f4', 'fortran_order': False, 'shape': (3, 3), }", HL_ERROR_INPUT, "expected 36"},
      {"{'descr': '<f4', 'fortran_order': False, 'shape': (0, 4), }", HL_ERROR_INPUT, "expected 0"},
      {"{'descr': '<f4', 'fortran_order': False, 'shape': (300000, 4), }", HL_ERROR_INPUT, "65535"},
      {"{'descr': '<f4', 'fortran_order': False, 'shape': (99999999999999999999, 4), }", HL_ERROR_INPUT,
       "count"},
      {"{'descr': '<f4', 'fortran_order': False, 'shape': (65535, 65535, 4), }", HL_ERROR_INPUT,
       "68717379600"},
      {"{'descr': '<f4', 'fortran_order': False, 'shape': (3 4), }", HL_ERROR_INPUT, "','"},
      {"{'descr': '<f4', 'fortran_order': False}", HL_ERROR_INPUT, "shape"},
      {"{'descr': '<f4', 'fortran_order': Maybe, 'shape': (3, 4)}", HL_ERROR_INPUT, "True or False"},
      {"{'descr': '<f4', 'order': False, 'shape': (3, 4)}", HL_ERROR_INPUT, "keys"},
      {"{'descr': '<f4', 'shape': (3, 4), 'shape': (3, 4), 'fortran_order': False}", HL_ERROR_INPUT, "keys"},
      {"{'descr': [('a', '<f4')], 'fortran_order': False, 'shape': (3, 4)}", HL_ERROR_INPUT, "type"},
      {"{'descr': '<f4', 'fortran_order': False, 'shape': (3, 4)", HL_ERROR_INPUT, "'}'"},
      {"{'descr", HL_ERROR_INPUT, "key"},
      {"", HL_ERROR_INPUT, "'{'"}};
  const float data[12] = {0};
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    hl_image *image = NULL;
    hl_error error = {0};
    hl_status status = decode_npy(context, 1, cases[i].header, data, sizeof data, &image, &error);
    if (status != cases[i].status || strstr(error.message, cases[i].word) == NULL)
      fail_msg("case %zu: status %d: %s", i, status, error.message);
    if (status == HL_ERROR_INPUT && strstr(error.message, "65535") == NULL)
      assert_true(error.byte_offset >= 10);
  }
  end_context(context);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(sizes_have_limits),
                                     cmocka_unit_test(memory_limit_is_kept),
                                     cmocka_unit_test(exr_and_npy_keep_every_bit),
                                     cmocka_unit_test(encoding_gives_the_file),
                                     cmocka_unit_test(exr_takes_layers),
                                     cmocka_unit_test(pictures_hold_layers),
                                     cmocka_unit_test(exr_halves_and_offsets_are_read),
                                     cmocka_unit_test(exr_grey_and_integers_are_read),
                                     cmocka_unit_test(exr_of_other_kinds_is_refused),
                                     cmocka_unit_test(npy_of_other_shapes_is_read),
                                     cmocka_unit_test(npy_of_other_kinds_is_refused)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
