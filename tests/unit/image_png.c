/* tests/unit/image_png.c - PNG: codes against the closed form, compositing, alpha, dither, and reading of
 * every kind of PNG. */
#include "image_parts.h"

#include <png.h>

static int closed_form_code(double linear, int maximum) {
  double l = fmin(fmax(linear, 0), 1);
  return (int)floor(maximum * (l <= 0.0031308 ? 12.92 * l : 1.055 * pow(l, 1 / 2.4) - 0.055) + 0.5);
}

/* The samples of a PNG file as they are stored, read by libpng without conversion. */
typedef struct png_samples {
  int width, height, depth, channels;
  int has_srgb;
  char scene[200];      /* the text chunk "halflight:scene" */
  unsigned char *bytes; /* owned; [height][width][channels] of depth / 8 bytes */
} png_samples;

static png_samples load_samples(const char *path) {
  png_samples s = {0};
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
  png_infop info = png_create_info_struct(png);
  FILE *file = fopen(path, "rb");
  assert_non_null(file);
  png_init_io(png, file);
  png_read_png(png, info, PNG_TRANSFORM_IDENTITY, NULL);
  s.width = (int)png_get_image_width(png, info);
  s.height = (int)png_get_image_height(png, info);
  s.depth = png_get_bit_depth(png, info);
  s.channels = png_get_channels(png, info);
  int intent;
  s.has_srgb = png_get_sRGB(png, info, &intent) != 0;
  png_textp texts = NULL;
  int count = png_get_text(png, info, &texts, NULL) == 0 ? 0 : png_get_text(png, info, &texts, NULL);
  for (int i = 0; i < count; i++)
    if (strcmp(texts[i].key, "halflight:scene") == 0) snprintf(s.scene, sizeof s.scene, "%s", texts[i].text);
  size_t row = png_get_rowbytes(png, info);
  s.bytes = malloc(row * (size_t)s.height);
  for (int y = 0; y < s.height; y++) memcpy(s.bytes + row * (size_t)y, png_get_rows(png, info)[y], row);
  png_destroy_read_struct(&png, &info, NULL);
  fclose(file);
  return s;
}

static int sample(const png_samples *s, int x, int y, int c) {
  size_t at = ((size_t)y * (size_t)s->width + (size_t)x) * (size_t)s->channels + (size_t)c;
  return s->depth == 8 ? s->bytes[at] : s->bytes[2 * at] << 8 | s->bytes[2 * at + 1];
}

typedef struct fixture {
  hl_context *context;
  char folder[64], path[100];
} fixture;

static fixture begin(void) {
  fixture f;
  f.context = make_context();
  make_folder(f.folder);
  snprintf(f.path, sizeof f.path, "%s/picture.png", f.folder);
  return f;
}

static void end(fixture *f) {
  assert_int_equal(count_files(f->folder), 1);
  remove_folder(f->folder);
  end_context(f->context);
}

static png_samples write_and_load(const fixture *f, const hl_image *image, int depth, double background,
                                  int transparent) {
  hl_image_write_options options;
  hl_image_write_options_defaults(&options);
  options.png_depth = depth;
  options.background_transparent = transparent;
  for (int c = 0; c < 3; c++) options.background[c] = background * (1 - 0.25 * c);
  hl_error error = {0};
  if (hl_image_write(f->context, image, f->path, &options, &error) != HL_OK) fail_msg("%s", error.message);
  return load_samples(f->path);
}

/* With 16 bits the colours are exactly those of the closed form. With 8 bits they deviate by less than a
 * code, and are exact where nothing was drawn. */
static void composites_in_linear_light(void **state) {
  (void)state;
  enum { W = 37, H = 23 };
  fixture f = begin();
  hl_image *image = make_structured(f.context, W, H);
  memset(pixel_at(image, 0, 0), 0, W * 16); /* one empty row */
  pixel_at(image, 5, 5)[1] = 7;
  pixel_at(image, 6, 5)[1] = -7;
  const int depths[] = {8, 16};
  for (int d = 0; d < 2; d++) {
    png_samples s = write_and_load(&f, image, depths[d], 0.3, 0);
    assert_true(s.has_srgb);
    assert_int_equal(s.depth, depths[d]);
    assert_int_equal(s.channels, 3);
    assert_int_equal(s.width, W);
    assert_int_equal(s.height, H);
    for (int y = 0; y < H; y++)
      for (int x = 0; x < W; x++)
        for (int c = 0; c < 3; c++) {
          const float *pixel = pixel_at(image, x, y);
          float value = pixel[c] + (1 - pixel[3]) * (float)(0.3 * (1 - 0.25 * c));
          int expected = closed_form_code(value, depths[d] == 8 ? 255 : 65535);
          assert_true(abs(sample(&s, x, y, c) - expected) <= (depths[d] == 8 && y > 0));
        }
    free(s.bytes);
  }
  hl_image_destroy(image);
  end(&f);
}

/* The picture's light is 2^stops times as strong, and the background's stays the same; for whole and other
 * numbers of stops, with and without alpha. */
static void exposure_multiplies_the_light(void **state) {
  (void)state;
  static const double stops[] = {0, 1, -2, 0.5, -3.7, 32, -32};
  fixture f = begin();
  hl_image *image = make_image(f.context, 1, 1);
  memcpy(pixel_at(image, 0, 0), (float[4]){0.08f, 0.03f, 0.2f, 0.5f}, 16);
  for (size_t n = 0; n < sizeof stops / sizeof *stops; n++)
    for (int transparent = 0; transparent < 2; transparent++) {
      hl_image_write_options options;
      hl_image_write_options_defaults(&options);
      options.png_depth = 16;
      options.exposure = stops[n];
      options.background_transparent = transparent;
      for (int c = 0; c < 3; c++) options.background[c] = 0.1;
      assert_int_equal(hl_image_write(f.context, image, f.path, &options, NULL), HL_OK);
      png_samples s = load_samples(f.path);
      for (int c = 0; c < 3; c++) {
        double light = (double)pixel_at(image, 0, 0)[c] * exp2(stops[n]);
        int expected = closed_form_code(transparent ? light / 0.5 : light + 0.05, 65535);
        assert_true(abs(sample(&s, 0, 0, c) - expected) <= 1); /* a float's rounding */
      }
      free(s.bytes);
    }
  hl_image_destroy(image);
  end(&f);
}

/* Numbers beyond the format's range, and numbers that are not finite. */
static void exposure_out_of_range_is_refused(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_image *image = make_image(context, 1, 1);
  const double stops[] = {32.5, -33, NAN, INFINITY};
  for (size_t n = 0; n < sizeof stops / sizeof *stops; n++) {
    hl_image_write_options options;
    hl_image_write_options_defaults(&options);
    options.exposure = stops[n];
    assert_int_equal(hl_image_write(context, image, "/tmp/unwritten.png", &options, NULL), HL_ERROR_ARGUMENT);
  }
  hl_image_destroy(image);
  end_context(context);
}

/* The tone curve maps the brightest channel m above .6, after the exposure, to 1 - .4^2 / (m - .2). The other
 * channels get the same factor. Darker light and the background stay the same. */
static void filmic_tone_bends_bright_light(void **state) {
  (void)state;
  static const float lights[][3] = {{0.59f, 0.2f, 0.01f}, {1, 0.5f, 0.25f}, {0.3f, 8, 2}, {1e30f, 1e30f, 0}};
  fixture f = begin();
  hl_image *image = make_image(f.context, 1, 1);
  for (size_t n = 0; n < sizeof lights / sizeof *lights; n++)
    for (int stops = 0; stops < 2; stops++)
      for (int transparent = 0; transparent < 2; transparent++) {
        hl_image_write_options options;
        hl_image_write_options_defaults(&options);
        options.png_depth = 16, options.exposure = stops, options.background_transparent = transparent;
        options.tone = HL_TONE_FILMIC;
        for (int c = 0; c < 3; c++) options.background[c] = 0.02;
        double light[3], brightest = 0;
        for (int c = 0; c < 3; c++) {
          light[c] = (double)lights[n][c] * (1 + stops);
          brightest = fmax(brightest, light[c]);
          pixel_at(image, 0, 0)[c] = lights[n][c];
        }
        pixel_at(image, 0, 0)[3] = 0.5f;
        assert_int_equal(hl_image_write(f.context, image, f.path, &options, NULL), HL_OK);
        png_samples s = load_samples(f.path);
        for (int c = 0; c < 3; c++) {
          double shown = light[c] * (brightest > 0.6 ? (1 - 0.16 / (brightest - 0.2)) / brightest : 1);
          int expected = closed_form_code(transparent ? shown / 0.5 : shown + 0.01, 65535);
          assert_true(abs(sample(&s, 0, 0, c) - expected) <= 1); /* a float's rounding */
        }
        free(s.bytes);
      }
  hl_image_destroy(image);
  end(&f);
}

/* Greys from black to far beyond white never become darker than the one before, and only white is clipped. */
static void filmic_tone_is_monotone(void **state) {
  (void)state;
  enum { N = 4096 };
  hl_context *context = make_context();
  hl_image *image = make_image(context, N, 1);
  uint8_t codes[2][4 * N];
  for (int x = 0; x < N; x++) {
    float light = 64.0f * (float)x * (float)x / (N * (float)N);
    memcpy(pixel_at(image, x, 0), (float[4]){light, light, light, 1}, 16);
  }
  for (int tone = HL_TONE_CLIP; tone <= HL_TONE_FILMIC; tone++) {
    hl_image_write_options options;
    hl_image_write_options_defaults(&options);
    options.tone = (hl_tone)tone;
    assert_int_equal(hl_image_to_srgb8(image, &options, codes[tone], 4 * N, NULL), HL_OK);
  }
  int darkest_of_white = 4 * (N / 8), falls = 0;
  for (int i = 0; i < 4 * N; i += 4) {
    if (i >= 4 * 8) falls += codes[1][i] + 1 < codes[1][i - 4 * 8]; /* 8 is the period of the dither */
    if (codes[0][i] < 204 && i < darkest_of_white) assert_int_equal(codes[0][i], codes[1][i]);
  }
  assert_int_equal(falls, 0);
  assert_int_equal(codes[1][0], 0);
  assert_int_equal(codes[0][darkest_of_white], 255);
  assert_true(codes[1][darkest_of_white] < 235 && codes[1][4 * N - 4] >= 253);
  hl_image_destroy(image);
  end_context(context);
}

static void tone_out_of_range_is_refused(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_image *image = make_image(context, 1, 1);
  hl_image_write_options options;
  hl_image_write_options_defaults(&options);
  options.tone = (hl_tone)2;
  assert_int_equal(hl_image_write(context, image, "/tmp/unwritten.png", &options, NULL), HL_ERROR_ARGUMENT);
  hl_image_destroy(image);
  end_context(context);
}

static void flat_backgrounds_stay_flat(void **state) {
  (void)state;
  fixture f = begin();
  hl_image *image = make_image(f.context, 16, 16);
  for (double background = 0; background < 1.2; background += 0.0371) {
    png_samples s = write_and_load(&f, image, 8, background, 0);
    for (int i = 0; i < 256; i++)
      for (int c = 0; c < 3; c++)
        assert_int_equal(sample(&s, i % 16, i / 16, c),
                         closed_form_code((float)(background * (1 - 0.25 * c)), 255));
    free(s.bytes);
  }
  hl_image_destroy(image);
  end(&f);
}

static void transparent_pictures_keep_colour_and_alpha(void **state) {
  (void)state;
  fixture f = begin();
  const float cases[][5] = {
      /* r g b a, expected linear red */
      {0, 0, 0, 0, 0},          {0.5f, 0, 0, 0, 0},        {0.25f, 0.25f, 0, 0.5f, 0.5f},
      {0.3f, 0.1f, 0, 0.1f, 1}, {1e-30f, 0, 0, 1e-20f, 0}, {0.25f, 0, 0, 1, 0.25f},
      {-1, 0, 0, 0.5f, 0},      {0.5f, 0, 0, 2, 0.25f}};
  enum { N = sizeof cases / sizeof cases[0] };
  hl_image *image = make_image(f.context, N, 1);
  for (int i = 0; i < N; i++) memcpy(pixel_at(image, i, 0), cases[i], 16);
  png_samples s = write_and_load(&f, image, 16, 0.7, 1);
  assert_int_equal(s.channels, 4);
  for (int i = 0; i < N; i++) {
    assert_int_equal(sample(&s, i, 0, 0), closed_form_code(cases[i][4], 65535));
    assert_int_equal(sample(&s, i, 0, 3), (int)(65535 * fmin(cases[i][3], 1) + 0.5));
  }
  free(s.bytes);
  hl_image_destroy(image);
  end(&f);
}

/* NaN is written as black, and the other pixels stay the same. */
static void nan_is_black(void **state) {
  (void)state;
  fixture f = begin();
  hl_image *image = make_image(f.context, 4, 1);
  for (int c = 0; c < 4; c++) pixel_at(image, 1, 0)[c] = NAN;
  pixel_at(image, 2, 0)[0] = pixel_at(image, 2, 0)[3] = 1;
  for (int transparent = 0; transparent < 2; transparent++) {
    png_samples s = write_and_load(&f, image, 8, 0, transparent);
    for (int c = 0; c < s.channels; c++) assert_int_equal(sample(&s, 1, 0, c), 0);
    assert_int_equal(sample(&s, 2, 0, 0), 255);
    free(s.bytes);
  }
  hl_image_destroy(image);
  end(&f);
}

/* A dark gradient with 20 pixels for a code. The mean over 8 x 8 pixels must be nearer to the true value than
 * rounding could bring it (0.289 codes), and no code may be off by more than one. */
static void dither_removes_bands(void **state) {
  (void)state;
  enum { W = 400, H = 16 };
  fixture f = begin();
  hl_image *image = make_image(f.context, W, H);
  for (int y = 0; y < H; y++)
    for (int x = 0; x < W; x++) {
      double code = 20 + x / 20.0, encoded = code / 255, linear = pow((encoded + 0.055) / 1.055, 2.4);
      for (int c = 0; c < 4; c++) pixel_at(image, x, y)[c] = c < 3 ? (float)linear : 1;
    }
  png_samples s = write_and_load(&f, image, 8, 0, 0);
  double square = 0;
  for (int x = 0; x < W; x += 8) {
    double sum = 0;
    for (int i = 0; i < 64; i++) {
      int code = sample(&s, x + i % 8, i / 8, 0);
      assert_true(fabs(code - (20 + (x + i % 8) / 20.0)) < 1);
      /* greys stay grey, and the pattern of the dither repeats */
      assert_int_equal(code, sample(&s, x + i % 8, 8 + i / 8, 2));
      sum += code - (20 + (x + i % 8) / 20.0);
    }
    square += sum / 64 * sum / 64;
  }
  assert_true(sqrt(square / (W / 8)) < 0.04);
  free(s.bytes);
  hl_image_destroy(image);
  end(&f);
}

/* Reading and writing again gives the same bytes, so that the dither does not accumulate. */
static void rewriting_keeps_codes(void **state) {
  (void)state;
  fixture f = begin();
  hl_image *image = make_structured(f.context, 64, 64), *back = NULL;
  const int depths[] = {8, 16};
  for (int d = 0; d < 2; d++) {
    png_samples first = write_and_load(&f, image, depths[d], 0.2, 0);
    assert_int_equal(hl_image_read(f.context, f.path, &back, NULL), HL_OK);
    png_samples second = write_and_load(&f, back, depths[d], 0, 0);
    assert_memory_equal(first.bytes, second.bytes, 64 * 64 * 3 * depths[d] / 8);
    hl_image_destroy(back);
    free(first.bytes);
    free(second.bytes);
  }
  hl_image_destroy(image);
  end(&f);
}

static void scene_is_stored(void **state) {
  (void)state;
  fixture f = begin();
  hl_image *image = make_image(f.context, 2, 2);
  hl_image_write_options options;
  hl_image_write_options_defaults(&options);
  options.scene_json = "{\"halflight\": 1, \"name\": \"Bl\xc3\xa4tter\"}";
  assert_int_equal(hl_image_write(f.context, image, f.path, &options, NULL), HL_OK);
  png_samples s = load_samples(f.path);
  assert_string_equal(s.scene, options.scene_json);
  free(s.bytes);
  options.scene_json = NULL;
  assert_int_equal(hl_image_write(f.context, image, f.path, &options, NULL), HL_OK);
  s = load_samples(f.path);
  assert_string_equal(s.scene, "");
  free(s.bytes);
  hl_image_destroy(image);
  end(&f);
}

/* ---- PNG files of other programs ---- */

enum { OTHER_WIDTH = 13, OTHER_HEIGHT = 9 };

/* The value of sample c of the pixel at (x, y), for a depth. */
static int other_sample(int x, int y, int c, int depth) {
  return (x * 7 + y * 31 + c * 101) * 257 & ((1 << depth) - 1);
}

static const png_color palette[4] = {{255, 0, 10}, {20, 255, 30}, {40, 50, 255}, {128, 128, 128}};
static const png_byte palette_alpha[2] = {0, 51};

static void write_other(const char *path, int type, int depth, int interlace, int with_key) {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
  png_infop info = png_create_info_struct(png);
  FILE *file = fopen(path, "wb");
  assert_non_null(file);
  png_init_io(png, file);
  png_set_IHDR(png, info, OTHER_WIDTH, OTHER_HEIGHT, depth, type, interlace, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  if (type == PNG_COLOR_TYPE_PALETTE) png_set_PLTE(png, info, palette, 4);
  if (type == PNG_COLOR_TYPE_PALETTE && with_key) png_set_tRNS(png, info, palette_alpha, 2, NULL);
  png_color_16 key = {0};
  key.gray = key.red = (png_uint_16)other_sample(3, 2, 0, depth);
  key.green = (png_uint_16)other_sample(3, 2, 1, depth);
  key.blue = (png_uint_16)other_sample(3, 2, 2, depth);
  if (type != PNG_COLOR_TYPE_PALETTE && with_key) png_set_tRNS(png, info, NULL, 0, &key);
  png_set_gAMA(png, info, 0.9); /* readers must not use this exponent */
  png_write_info(png, info);
  size_t row_bytes = png_get_rowbytes(png, info);
  png_bytep rows[OTHER_HEIGHT];
  for (int y = 0; y < OTHER_HEIGHT; y++) {
    rows[y] = calloc(row_bytes, 1);
    int channels = png_get_channels(png, info);
    for (int i = 0; i < OTHER_WIDTH * channels; i++) {
      int value = other_sample(i / channels, y, i % channels, depth);
      if (depth == 16) rows[y][2 * i] = (png_byte)(value >> 8);
      if (depth == 16) rows[y][2 * i + 1] = (png_byte)(value & 255);
      else rows[y][i * depth / 8] |= (png_byte)(value << (8 - depth - i * depth % 8));
    }
  }
  png_write_image(png, rows);
  png_write_end(png, NULL);
  for (int y = 0; y < OTHER_HEIGHT; y++) free(rows[y]);
  png_destroy_write_struct(&png, &info);
  fclose(file);
}

/* The colour, without premultiplication and encoded, and the alpha that the file has; from 0 to 1. */
static void other_pixel(int x, int y, int type, int depth, int with_key, double rgba[4]) {
  double maximum = (1 << depth) - 1;
  int s[4];
  for (int c = 0; c < 4; c++) s[c] = other_sample(x, y, c, depth);
  bool keyed = true;
  int colours = type == PNG_COLOR_TYPE_RGB || type == PNG_COLOR_TYPE_RGB_ALPHA ? 3 : 1;
  for (int c = 0; c < 3; c++) rgba[c] = s[colours == 3 ? c : 0] / maximum;
  for (int c = 0; c < colours; c++) keyed = keyed && s[c] == other_sample(3, 2, c, depth);
  rgba[3] = with_key && keyed ? 0 : 1;
  if (type & PNG_COLOR_MASK_ALPHA) rgba[3] = s[colours] / maximum;
  if (type != PNG_COLOR_TYPE_PALETTE) return;
  const png_color entry = palette[s[0] & 3];
  rgba[0] = entry.red / 255.0;
  rgba[1] = entry.green / 255.0;
  rgba[2] = entry.blue / 255.0;
  rgba[3] = with_key && (s[0] & 3) < 2 ? palette_alpha[s[0] & 3] / 255.0 : 1;
}

static void every_kind_is_read(void **state) {
  (void)state;
  fixture f = begin();
  const struct {
    int type, depth, with_key;
  } cases[] = {
      {PNG_COLOR_TYPE_GRAY, 1, 0},      {PNG_COLOR_TYPE_GRAY, 2, 1},       {PNG_COLOR_TYPE_GRAY, 4, 0},
      {PNG_COLOR_TYPE_GRAY, 8, 1},      {PNG_COLOR_TYPE_GRAY, 16, 1},      {PNG_COLOR_TYPE_RGB, 8, 0},
      {PNG_COLOR_TYPE_RGB, 8, 1},       {PNG_COLOR_TYPE_RGB, 16, 1},       {PNG_COLOR_TYPE_PALETTE, 2, 0},
      {PNG_COLOR_TYPE_PALETTE, 2, 1},   {PNG_COLOR_TYPE_GRAY_ALPHA, 8, 0}, {PNG_COLOR_TYPE_GRAY_ALPHA, 16, 0},
      {PNG_COLOR_TYPE_RGB_ALPHA, 8, 0}, {PNG_COLOR_TYPE_RGB_ALPHA, 16, 0}};
  for (size_t i = 0; i < 2 * (sizeof cases / sizeof cases[0]); i++) {
    int type = cases[i / 2].type, depth = cases[i / 2].depth, with_key = cases[i / 2].with_key;
    write_other(f.path, type, depth, i % 2 ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, with_key);
    hl_image *image = NULL;
    hl_error error = {0};
    if (hl_image_read(f.context, f.path, &image, &error) != HL_OK) fail_msg("case %zu: %s", i, error.message);
    assert_int_equal(image->width, OTHER_WIDTH);
    assert_int_equal(image->height, OTHER_HEIGHT);
    for (int y = 0; y < OTHER_HEIGHT; y++)
      for (int x = 0; x < OTHER_WIDTH; x++) {
        double rgba[4];
        other_pixel(x, y, type, depth, with_key, rgba);
        for (int c = 0; c < 4; c++) {
          double linear = rgba[c] <= 0.04045 ? rgba[c] / 12.92 : pow((rgba[c] + 0.055) / 1.055, 2.4);
          double expected = c == 3 ? rgba[3] : linear * rgba[3];
          if (fabs(pixel_at(image, x, y)[c] - expected) > 2e-7)
            fail_msg("case %zu, pixel %d %d %d: %g, expected %g", i, x, y, c, pixel_at(image, x, y)[c],
                     expected);
        }
      }
    hl_image_destroy(image);
  }
  end(&f);
}

/* The bytes for a toolkit are those of an 8-bit PNG, with alpha 255 over a background. The bytes between rows
 * stay the same. */
static void bytes_are_those_of_a_png(void **unused) {
  (void)unused;
  enum { WIDTH = 37, HEIGHT = 19, STRIDE = 4 * WIDTH + 12 };
  static uint8_t bytes[HEIGHT][STRIDE];
  fixture f = begin();
  hl_image *image = NULL;
  assert_int_equal(hl_image_create(f.context, WIDTH, HEIGHT, &image, NULL), HL_OK);
  float *pixel = hl_image_pixels(image);
  for (int i = WIDTH; i < WIDTH * HEIGHT; i++) /* the first row stays empty */
    for (int c = 0; c < 4; c++) pixel[4 * i + c] = (float)(i * (c + 1) % 997) / 997 * (c < 3 ? 0.4f : 1.0f);
  for (int transparent = 0; transparent < 2; transparent++) {
    hl_image_write_options options;
    hl_image_write_options_defaults(&options);
    options.background[1] = 0.3;
    options.exposure = 0.5;
    options.background_transparent = transparent;
    memset(bytes, 77, sizeof bytes);
    assert_int_equal(hl_image_to_srgb8(image, &options, bytes[0], STRIDE, NULL), HL_OK);
    assert_int_equal(hl_image_write(f.context, image, f.path, &options, NULL), HL_OK);
    png_samples s = load_samples(f.path);
    for (int y = 0; y < HEIGHT; y++)
      for (int x = 0; x < WIDTH; x++)
        for (int c = 0; c < 4; c++)
          assert_int_equal(bytes[y][4 * x + c], c < s.channels ? sample(&s, x, y, c) : 255);
    for (int y = 0; y < HEIGHT; y++)
      for (int i = 4 * WIDTH; i < STRIDE; i++) assert_int_equal(bytes[y][i], 77);
    free(s.bytes);
  }
  hl_error error = {0};
  assert_int_equal(hl_image_to_srgb8(image, NULL, bytes[0], 4 * WIDTH - 1, &error), HL_ERROR_ARGUMENT);
  assert_string_equal(error.message,
                      "hl_image_to_srgb8: row_stride is 147, expected 4 x width = 148 at least");
  hl_image_destroy(image);
  end(&f);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(composites_in_linear_light),
                                     cmocka_unit_test(exposure_multiplies_the_light),
                                     cmocka_unit_test(exposure_out_of_range_is_refused),
                                     cmocka_unit_test(filmic_tone_bends_bright_light),
                                     cmocka_unit_test(filmic_tone_is_monotone),
                                     cmocka_unit_test(tone_out_of_range_is_refused),
                                     cmocka_unit_test(flat_backgrounds_stay_flat),
                                     cmocka_unit_test(transparent_pictures_keep_colour_and_alpha),
                                     cmocka_unit_test(nan_is_black),
                                     cmocka_unit_test(dither_removes_bands),
                                     cmocka_unit_test(rewriting_keeps_codes),
                                     cmocka_unit_test(scene_is_stored),
                                     cmocka_unit_test(every_kind_is_read),
                                     cmocka_unit_test(bytes_are_those_of_a_png)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
