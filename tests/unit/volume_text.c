/* tests/unit/volume_text.c - numbers and words of headers, XML tags, and the decoding streams. */
#define _GNU_SOURCE
#include "volume_files.h"

#include <float.h>
#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "volume/io/decoders.h"
#include "volume/io/text.h"
#include "volume/io/xml.h"

static bool same_double(double a, double b) {
  return (isnan(a) && isnan(b)) || memcmp(&a, &b, sizeof a) == 0;
}

/* The C library rounds correctly. Each number that is accepted must agree with it to the last bit. */
static void test_numbers_are_correctly_rounded(void **unused) {
  (void)unused;
  static const char *const fixed[] = {"0",
                                      "-0",
                                      "1",
                                      "+1.5",
                                      ".5",
                                      "5.",
                                      "1e0",
                                      "1E+2",
                                      "1e-2",
                                      "123456789012345678901234567890",
                                      "9007199254740993",
                                      "9007199254740992.5",
                                      "0.1",
                                      "1e22",
                                      "1e23",
                                      "1e-22",
                                      "8.5e-23",
                                      "2.2250738585072011e-308",
                                      "4.9e-324",
                                      "2e-324",
                                      "1e400",
                                      "-1e400",
                                      "1e-400",
                                      "1e99999999999",
                                      "0.000000000000000000000000000000000000001",
                                      "179769313486231580793e289",
                                      "0e999",
                                      "00000000000000000000000000000000012.50",
                                      "nan",
                                      "-NaN",
                                      "inf",
                                      "-Infinity",
                                      "+INF"};
  for (size_t n = 0; n < sizeof fixed / sizeof *fixed; n++) {
    double value;
    assert_true(hl_text_number(fixed[n], strlen(fixed[n]), &value));
    assert_true(same_double(value, strtod(fixed[n], NULL)) || isnan(value));
    assert_true(isnan(value) == isnan(strtod(fixed[n], NULL)));
  }
  uint64_t state = 1;
  for (int n = 0; n < 20000; n++) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    uint64_t bits = n % 2 ? state : (state & 0x000fffffffffffffu) | (uint64_t)(900 + n % 250) << 52;
    double exact, value;
    memcpy(&exact, &bits, 8);
    if (!isfinite(exact)) continue;
    char text[64];
    int length = snprintf(text, sizeof text, n % 3 ? "%.17g" : "%.9g", exact);
    assert_true(hl_text_number(text, (size_t)length, &value));
    assert_true(same_double(value, strtod(text, NULL)));
  }
}

static void test_what_is_no_number(void **unused) {
  (void)unused;
  static const char *const wrong[] = {"",      "+",   "-",       ".",     "e5",    "1e",   "1e+",
                                      "1.2.3", "1,5", "0x10",    "1 ",    " 1",    "nana", "in",
                                      "1f",    "--1", "infinit", "1e5.0", "NaN(1)"};
  double value;
  for (size_t n = 0; n < sizeof wrong / sizeof *wrong; n++)
    assert_false(hl_text_number(wrong[n], strlen(wrong[n]), &value));
  char digits[HL_NUMBER_CHARACTERS + 1];
  memset(digits, '1', sizeof digits);
  assert_false(hl_text_number(digits, HL_NUMBER_CHARACTERS, &value));
  assert_true(hl_text_number(digits, HL_NUMBER_CHARACTERS - 1, &value));
}

/* In a program with the German locale, 1.5 must be read as 1.5, by both functions. */
static void test_numbers_in_another_locale(void **unused) {
  (void)unused;
  /* the locale is not installed, so that nothing can be tested */
  if (setlocale(LC_ALL, "de_DE.UTF-8") == NULL) return;
  double quick, slow;
  assert_true(hl_text_number("1.5", 3, &quick) && hl_text_number("1.50000000000000000000000", 25, &slow));
  setlocale(LC_ALL, "C");
  assert_true(quick == 1.5 && slow == 1.5);
}

static void test_lists_of_numbers(void **unused) {
  (void)unused;
  double values[3];
  size_t sizes[3];
  assert_int_equal(hl_text_numbers(" 1\t-2.5  3e1 \r", values, 3), 3);
  assert_true(values[0] == 1 && values[1] == -2.5 && values[2] == 30);
  assert_int_equal(hl_text_numbers("", values, 3), 0);
  assert_int_equal(hl_text_numbers("1 2 3 4", values, 3), -1);
  assert_int_equal(hl_text_numbers("1 b", values, 3), -1);
  assert_int_equal(hl_text_sizes("18446744073709551615 0 7", sizes, 3), 3);
  assert_true(sizes[0] == SIZE_MAX && sizes[1] == 0 && sizes[2] == 7);
  static const char *const wrong[] = {"18446744073709551616", "-1", "1.5", "1 2 3 4", "0x5", "+1"};
  for (int n = 0; n < 6; n++) assert_int_equal(hl_text_sizes(wrong[n], sizes, 3), -1);
}

static void test_words(void **unused) {
  (void)unused;
  char word[5], text[] = " \t two words\r\n", shown[HL_PRINTABLE_BYTES];
  const char *cursor = " one three fourteen";
  assert_true(hl_text_word(&cursor, word, sizeof word));
  assert_string_equal(word, "one");
  assert_false(hl_text_word(&cursor, word, sizeof word)); /* the word is too long, so that it is skipped */
  assert_string_equal(cursor, " fourteen");
  assert_string_equal(hl_text_trim(text), "two words");
  assert_true(hl_text_equal("NRRD", "nrrd") && !hl_text_equal("nrrd", "nrr") &&
              hl_text_ends("a.NII", ".nii"));
  assert_true(hl_text_is_one_of("Data File", "datafile|data file") &&
              !hl_text_is_one_of("data", "datafile|data file"));
  assert_true(hl_text_is_one_of("gz", "gzip|gz") && !hl_text_is_one_of("gzi", "gzip|gz"));
  assert_string_equal(hl_text_printable(shown, "a\n\x80z"), "a??z");
  char lengthy[200];
  memset(lengthy, 'x', sizeof lengthy);
  lengthy[199] = 0;
  assert_int_equal(strlen(hl_text_printable(shown, lengthy)), HL_PRINTABLE_BYTES - 1);
}

/* ---- streams over a file with given content ---- */

typedef struct open_file {
  hl_context *context;
  char folder[FOLDER_BYTES];
  hl_stream *stream;
} open_file;

static open_file open_content(const void *content, size_t length) {
  open_file opened = {.stream = NULL};
  byte_buffer file = {.length = 0};
  char path[PATH_BYTES];
  add(&file, content, length);
  make_folder(opened.folder);
  write_file(opened.folder, "content", &file, path);
  assert_int_equal(hl_context_create(NULL, &opened.context, NULL), HL_OK);
  assert_int_equal(hl_stream_open(opened.context, path, true, &opened.stream, NULL), HL_OK);
  return opened;
}

static void close_content(open_file *opened) {
  hl_stream_close(opened->stream);
  assert_int_equal(hl_context_memory_held(opened->context), 0);
  hl_context_destroy(opened->context);
  remove_folder(opened->folder);
}

static size_t read_at_most(hl_stream *stream, char *text, size_t step) {
  size_t length = 0, count = 1;
  while (count > 0) {
    assert_int_equal(hl_stream_read(stream, text + length, step, &count, NULL), HL_OK);
    length += count;
  }
  text[length] = 0;
  return length;
}

/* The vectors of RFC 4648, section 10, also with line breaks, joined, and read in parts of any size. */
static void test_base64(void **unused) {
  (void)unused;
  static const char *const vectors[][2] = {{"", ""},
                                           {"Zg==", "f"},
                                           {"Zm8=", "fo"},
                                           {"Zm9v", "foo"},
                                           {"Zm9vYg==", "foob"},
                                           {"Zm9vYmE=", "fooba"},
                                           {"Zm9vYmFy", "foobar"},
                                           {" Z m\n9vYm\tFy\n", "foobar"},
                                           {"Zg==Zm9vYmE=Zm9v", "ffoobafoo"},
                                           {"Zm9v</DataArray>", "foo"}};
  for (size_t n = 0; n < sizeof vectors / sizeof *vectors; n++)
    for (size_t step = 1; step < 9; step++) {
      char text[64];
      open_file opened = open_content(vectors[n][0], strlen(vectors[n][0]));
      assert_int_equal(hl_stream_push_base64(&opened.stream, NULL), HL_OK);
      assert_true(hl_stream_at_most(opened.stream) >= strlen(vectors[n][1]));
      read_at_most(opened.stream, text, step);
      assert_string_equal(text, vectors[n][1]);
      assert_false(opened.stream->cut_short);
      close_content(&opened);
    }
  static const char *const wrong[] = {"Z===", "===="};
  for (int n = 0; n < 2; n++) {
    char text[8];
    size_t count;
    hl_error error = {0};
    open_file opened = open_content(wrong[n], 4);
    assert_int_equal(hl_stream_push_base64(&opened.stream, NULL), HL_OK);
    assert_int_equal(hl_stream_read(opened.stream, text, 4, &count, &error), HL_ERROR_INPUT);
    close_content(&opened);
  }
  static const char *const broken_off[] = {"Zm9vYm", "Zm9vYg=", "Zm9v=Zm9v", "Zm9vYm<"};
  for (int n = 0; n < 4; n++) {
    char text[16];
    open_file opened = open_content(broken_off[n], strlen(broken_off[n]));
    assert_int_equal(hl_stream_push_base64(&opened.stream, NULL), HL_OK);
    assert_int_equal(read_at_most(opened.stream, text, 7), 3);
    assert_true(opened.stream->cut_short);
    close_content(&opened);
  }
}

static void test_gzip_members_and_ends(void **unused) {
  (void)unused;
  byte_buffer file = {.length = 0};
  add_compressed(&file, (const unsigned char *)"first ", 6, true);
  add_compressed(&file, (const unsigned char *)"second", 6, true);
  size_t whole = file.length;
  add_text(&file, "garbage");
  char text[64];
  open_file opened = open_content(file.data, file.length);
  assert_int_equal(hl_stream_push_inflate(&opened.stream, NULL), HL_OK);
  assert_int_equal(read_at_most(opened.stream, text, 5), 12);
  assert_string_equal(text, "first second");
  assert_false(opened.stream->cut_short);
  close_content(&opened);
  opened = open_content(file.data, whole - 1);
  assert_int_equal(hl_stream_push_inflate(&opened.stream, NULL), HL_OK);
  assert_int_equal(read_at_most(opened.stream, text, 63), 12);
  assert_true(opened.stream->cut_short);
  close_content(&opened);
  file.data[whole - 6] ^= 1; /* the second member's check sum */
  size_t count;
  hl_error error = {0};
  opened = open_content(file.data, whole);
  assert_int_equal(hl_stream_push_inflate(&opened.stream, NULL), HL_OK);
  assert_int_equal(hl_stream_read(opened.stream, text, 20, &count, &error), HL_ERROR_INPUT);
  assert_non_null(strstr(error.message, "damaged"));
  close_content(&opened);
}

static void test_line_ends(void **unused) {
  (void)unused;
  static const struct {
    const char *content;
    const char *lines[4];
  } cases[] = {{"a\nb\n\nc", {"a", "b", "", "c"}},
               {"a\r\nb\r\n\r\nc", {"a", "b", "", "c"}},
               {"a\rb\r\rc\n", {"a", "b", "", "c\n"}},
               {"a b\nc\rd\ne\nf", {"a b", "c\rd", "e", "f"}}};
  for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
    open_file opened = open_content(cases[n].content, strlen(cases[n].content));
    char line[HL_LINE_BYTES];
    bool ended;
    for (int k = 0; k < 4; k++) {
      assert_int_equal(hl_stream_line(opened.stream, line, &ended, NULL), HL_OK);
      assert_false(ended);
      assert_string_equal(line, cases[n].lines[k]);
    }
    assert_int_equal(hl_stream_line(opened.stream, line, &ended, NULL), HL_OK);
    assert_true(ended);
    close_content(&opened);
  }
}

static void test_xml_tags(void **unused) {
  (void)unused;
  static const char content[] =
      "<?xml v='1'?> text <!-- <no> -- > --><a b=\"1 > 0\" c = 'x&lt;&amp;&quot;&apos;&gt;&#65;'>in<b/>"
      "<c d='' /></a >";
  open_file opened = open_content(content, strlen(content));
  hl_xml_tag tag;
  bool ended;
  assert_int_equal(hl_xml_next_tag(opened.stream, &tag, &ended, NULL), HL_OK);
  assert_true(tag.is_start && !tag.is_end && strcmp(tag.name, "a") == 0);
  assert_string_equal(hl_xml_attribute(&tag, "b"), "1 > 0");
  assert_string_equal(hl_xml_attribute(&tag, "c"), "x<&\"'>A");
  assert_null(hl_xml_attribute(&tag, "d"));
  assert_int_equal(hl_xml_next_tag(opened.stream, &tag, &ended, NULL), HL_OK);
  assert_true(tag.is_start && tag.is_end && strcmp(tag.name, "b") == 0);
  assert_int_equal(hl_xml_next_tag(opened.stream, &tag, &ended, NULL), HL_OK);
  assert_true(tag.is_start && tag.is_end && strcmp(hl_xml_attribute(&tag, "d"), "") == 0);
  assert_int_equal(hl_xml_next_tag(opened.stream, &tag, &ended, NULL), HL_OK);
  assert_true(!tag.is_start && tag.is_end && strcmp(tag.name, "a") == 0 && !ended);
  assert_int_equal(hl_xml_next_tag(opened.stream, &tag, &ended, NULL), HL_OK);
  assert_true(ended);
  close_content(&opened);
  static const char *const wrong[] = {"<",
                                      "<>",
                                      "< a>",
                                      "<a b>",
                                      "<a b=1>",
                                      "<a b='1>",
                                      "<a/b>",
                                      "<a b='1'c='2'>",
                                      "<!DOCTYPE a>",
                                      "<![CDATA[x]]>",
                                      "<!-- x",
                                      "<?xml",
                                      "</>",
                                      "<a b='1' /c>"};
  for (size_t n = 0; n < sizeof wrong / sizeof *wrong; n++) {
    opened = open_content(wrong[n], strlen(wrong[n]));
    hl_error error = {0};
    assert_int_equal(hl_xml_next_tag(opened.stream, &tag, &ended, &error), HL_ERROR_INPUT);
    assert_true(error.byte_offset >= 0);
    close_content(&opened);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_numbers_are_correctly_rounded),
      cmocka_unit_test(test_what_is_no_number),
      cmocka_unit_test(test_numbers_in_another_locale),
      cmocka_unit_test(test_lists_of_numbers),
      cmocka_unit_test(test_words),
      cmocka_unit_test(test_base64),
      cmocka_unit_test(test_gzip_members_and_ends),
      cmocka_unit_test(test_line_ends),
      cmocka_unit_test(test_xml_tags),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
