/* tests/unit/image_scene_text.c - the scene that a PNG file carries, and what the file's header tells. */
#include "image_parts.h"

#include <zlib.h>

#include <halflight/scene.h>

static void put_32(unsigned char *to, unsigned long value) {
  for (int n = 0; n < 4; n++) to[n] = (unsigned char)(value >> (24 - 8 * n));
}

/* A PNG's mark and one chunk; its length. */
static size_t make_chunk(unsigned char *file, const char *type, const void *body, size_t length) {
  memcpy(file, "\x89PNG\r\n\x1a\n", 8);
  put_32(file + 8, length);
  memcpy(file + 12, type, 4);
  memcpy(file + 16, body, length);
  put_32(file + 16 + length, crc32(0, file + 12, (unsigned)length + 4));
  return 20 + length;
}

static void scenes_are_found(void **state) {
  (void)state;
  static const char key[] = "halflight:scene", text[] = "{\"halflight\": 1}";
  hl_context *context = make_context();
  unsigned char packed[200], body[400], file[500];
  uLongf packed_bytes = sizeof packed;
  assert_int_equal(compress(packed, &packed_bytes, (const unsigned char *)text, strlen(text)), Z_OK);
  for (int kind = 0; kind < 4; kind++) {
    static const char *const types[] = {"tEXt", "zTXt", "iTXt", "iTXt"};
    static const char between[4][6] = {"", {0}, {0, 0, 'd', 'e', 0, 0}, {1, 0, 0, 'x', 0}};
    static const size_t between_bytes[] = {0, 1, 6, 5};
    size_t length = sizeof key;
    memcpy(body, key, sizeof key);
    memcpy(body + length, between[kind], between_bytes[kind]);
    length += between_bytes[kind];
    bool is_packed = kind == 1 || kind == 3;
    memcpy(body + length, is_packed ? packed : (const unsigned char *)text,
           is_packed ? packed_bytes : strlen(text));
    length = make_chunk(file, types[kind], body, length + (is_packed ? packed_bytes : strlen(text)));
    char *found = NULL;
    hl_error error = {0};
    assert_int_equal(hl_image_find_scene(context, "a.png", file, length, &found, &error), HL_OK);
    assert_string_equal(found, text);
    hl_text_release(context, found);
    for (size_t cut = 0; cut < length; cut++) {
      assert_int_equal(hl_image_find_scene(context, "a.png", file, cut, &found, &error), HL_ERROR_INPUT);
      assert_null(found);
      assert_true(strlen(error.message) > 20);
    }
    for (size_t place = 0; place < length; place++) {
      /* the checksum covers the chunk without its mark and length */
      file[place] ^= 0x15;
      assert_int_equal(hl_image_find_scene(context, "a.png", file, length, &found, &error), HL_ERROR_INPUT);
      file[place] ^= 0x15;
    }
  }
  end_context(context);
}

/* A file's header has its size, channels and bits. The colours of a palette have 8 bits. */
static void files_say_what_they_are(void **state) {
  (void)state;
  static const struct {
    unsigned char type, depth;
    int channels, bits;
  } cases[] = {{0, 16, 1, 16}, {2, 8, 3, 8}, {3, 2, 3, 8}, {4, 8, 2, 8}, {6, 16, 4, 16}};
  unsigned char file[33] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n', 0, 0, 0, 13,
                            'I',  'H', 'D', 'R', 0,    0,    2,    0x80, 0, 0, 1, 0xe0};
  hl_image_about about = {.struct_size = sizeof about};
  hl_error error = {0};
  for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
    file[24] = cases[n].depth, file[25] = cases[n].type;
    assert_int_equal(hl_image_get_about("a.png", file, sizeof file, &about, &error), HL_OK);
    assert_string_equal(about.format, "PNG");
    assert_true(about.width == 640 && about.height == 480 && !about.has_scene);
    assert_true(about.channels == cases[n].channels && about.bits == cases[n].bits);
  }
  for (size_t cut = 0; cut < 26; cut++)
    assert_int_equal(hl_image_get_about("a.png", file, cut, &about, &error), HL_ERROR_INPUT);
  assert_int_equal(hl_image_get_about("a", "no picture", 10, &about, &error), HL_ERROR_UNSUPPORTED);
  about.struct_size = 1;
  assert_int_equal(hl_image_get_about("a.png", file, sizeof file, &about, &error), HL_ERROR_ARGUMENT);
}

/* Compressed text that is longer than the limit when it is unpacked, and data that are no compressed text. */
static void scenes_have_limits(void **state) {
  (void)state;
  hl_context *context = make_context();
  enum { LARGE = 40 << 20 };
  unsigned char *zeros = calloc(LARGE, 1), *body = malloc(1 << 20), *file = malloc(1 << 20);
  memcpy(body, "halflight:scene\0\0", 17);
  uLongf packed_bytes = (1 << 20) - 100;
  assert_int_equal(compress(body + 17, &packed_bytes, zeros, LARGE), Z_OK);
  size_t length = make_chunk(file, "zTXt", body, 17 + packed_bytes);
  char *found = NULL;
  hl_error error = {0};
  assert_int_equal(hl_image_find_scene(context, "a.png", file, length, &found, &error), HL_ERROR_INPUT);
  assert_non_null(strstr(error.message, "more than"));
  length = make_chunk(file, "zTXt", "halflight:scene\0\0not zlib", 26);
  assert_int_equal(hl_image_find_scene(context, "a.png", file, length, &found, &error), HL_ERROR_INPUT);
  assert_non_null(strstr(error.message, "damaged"));
  free(zeros);
  free(body);
  free(file);
  end_context(context);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(scenes_are_found),
                                     cmocka_unit_test(files_say_what_they_are),
                                     cmocka_unit_test(scenes_have_limits)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
