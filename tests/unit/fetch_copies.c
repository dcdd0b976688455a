/* tests/unit/fetch_copies.c - copies of servers' files. A copy is found by its URL alone, and the oldest
 * copies make room for new ones. Parts of files: what is requested, and which answers are right. */
#define _GNU_SOURCE
#include <fcntl.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "fetch/copies.h"
#include "fetch/ranges.h"

enum { BYTES = 1000 };

static char folder[64];

static void make_copy(const char *url) {
  char path[COPIES_PATH_BYTES];
  unsigned char bytes[BYTES];
  hl_error error = {0};
  hl_fetched_file file = {.size = BYTES, .begin = 7, .whole = 2 * BYTES};
  memset(bytes, url[0], sizeof bytes);
  assert_int_equal(copies_begin(folder, path, &error), HL_OK);
  int descriptor = open(path, O_WRONLY);
  assert_int_equal(write(descriptor, bytes, sizeof bytes), BYTES);
  close(descriptor);
  assert_int_equal(copies_keep(folder, url, "If-None-Match: \"1\"", path, &file, &error), HL_OK);
  assert_true(file.descriptor >= 0);
  close(file.descriptor);
}

static bool has_copy(const char *url) {
  char condition[FETCH_CONDITION_BYTES];
  unsigned char byte = 0;
  hl_fetched_file file;
  copies_find(folder, url, &file, condition);
  if (file.descriptor < 0) return false;
  assert_int_equal(file.size, BYTES);
  assert_int_equal(file.begin, 7);
  assert_int_equal(file.whole, 2 * BYTES);
  assert_string_equal(condition, "If-None-Match: \"1\"");
  assert_int_equal(pread(file.descriptor, &byte, 1, BYTES - 1), 1);
  assert_int_equal(byte, url[0]);
  close(file.descriptor);
  return true;
}

/* Gives every copy in the folder an old date, so that copies made later are newer. */
static void date_copies(time_t when) {
  char command[200];
  snprintf(command, sizeof command, "touch -d @%lld %s/*", (long long)when, folder);
  assert_int_equal(system(command), 0);
}

static void the_oldest_make_room(void **state) {
  hl_error error = {0};
  (void)state;
  assert_int_equal(copies_open(folder, 1 << 20, &error), HL_OK);
  make_copy("a");
  make_copy("b");
  date_copies(1000000000);
  make_copy("c");
  copies_touch(folder, "a");
  assert_true(has_copy("a") && has_copy("b") && has_copy("c") && !has_copy("d"));
  assert_int_equal(copies_open(folder, 5 * BYTES / 2, &error), HL_OK);
  assert_true(has_copy("a") && !has_copy("b") && has_copy("c"));
  assert_int_equal(copies_open(folder, 0, &error), HL_OK);
  assert_false(has_copy("a") || has_copy("c"));
}

/* The name of a copy does not prove its URL. */
static void a_copy_of_another_url_is_not_taken(void **state) {
  char command[300];
  (void)state;
  make_copy("a");
  snprintf(command, sizeof command, "for f in %s/*; do mv $f %s/kept; done", folder, folder);
  assert_int_equal(system(command), 0);
  make_copy("b");
  snprintf(command, sizeof command, "for f in %s/[!k]*; do mv %s/kept $f; done", folder, folder);
  assert_int_equal(system(command), 0);
  assert_false(has_copy("b"));
}

static void parts_are_asked_for(void **state) {
  static const struct {
    hl_fetch_range range;
    const char *text; /* null: there are no such bytes */
  } cases[] = {{{0, 1}, "0-0"},
               {{10, 20}, "10-29"},
               {{UINT64_MAX, 36}, "-36"},
               {{5, 0}, ""},
               {{UINT64_MAX - 1, 2}, "18446744073709551614-18446744073709551615"},
               {{UINT64_MAX - 1, 3}, NULL}};
  char text[RANGE_BYTES];
  (void)state;
  for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
    assert_true(range_write(&cases[n].range, text) == (cases[n].text != NULL));
    if (cases[n].text != NULL) assert_string_equal(text, cases[n].text);
  }
}

static bool answers(uint64_t begin, uint64_t count, const char *content_range, hl_fetched_file *file) {
  const hl_fetch_range range = {begin, count};
  *file = (hl_fetched_file){.descriptor = -1};
  return range_is_answered(&range, content_range, file);
}

static void only_the_wanted_part_is_an_answer(void **state) {
  static const char *const wrong[] = {
      "",
      "bytes 11-30/100",
      "bytes 10-28/100",
      "bytes 10-30/100",
      "bytes 10-29/*",
      "bytes */100",
      "bytes 10-29/29",
      "items 10-29/100",
      "bytes 10-29",
      "bytes 10-29/100 ",
      "bytes -10-29/100",
      "bytes 10-29/99999999999999999999999",
  };
  hl_fetched_file file;
  (void)state;
  assert_true(answers(10, 20, "bytes 10-29/100", &file));
  assert_int_equal(file.begin, 10);
  assert_int_equal(file.size, 20);
  assert_int_equal(file.whole, 100);
  for (size_t n = 0; n < sizeof wrong / sizeof *wrong; n++) assert_false(answers(10, 20, wrong[n], &file));
  assert_true(answers(UINT64_MAX, 20, "bytes 80-99/100", &file));
  assert_int_equal(file.begin, 80);
  assert_true(answers(UINT64_MAX, 20, "bytes 0-9/10", &file)); /* the file is shorter than the part */
  assert_int_equal(file.size, 10);
  assert_false(answers(UINT64_MAX, 20, "bytes 79-98/100", &file));
  assert_false(answers(UINT64_MAX, 20, "bytes 81-99/100", &file));
  assert_false(answers(UINT64_MAX, 20, "bytes 1-9/10", &file));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_oldest_make_room), cmocka_unit_test(a_copy_of_another_url_is_not_taken),
      cmocka_unit_test(parts_are_asked_for), cmocka_unit_test(only_the_wanted_part_is_an_answer)};
  strcpy(folder, "/tmp/halflight-copies-XXXXXX");
  if (mkdtemp(folder) == NULL) return 1;
  int failed = cmocka_run_group_tests(tests, NULL, NULL);
  char command[100];
  snprintf(command, sizeof command, "rm -r %s", folder);
  return system(command) != 0 || failed != 0;
}
