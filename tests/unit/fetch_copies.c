/* tests/unit/fetch_copies.c - copies of servers' files: one is found by its URL alone, and the oldest make
 * room. */
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

enum { BYTES = 1000 };

static char folder[64];

static void make_copy(const char *url) {
  char path[COPIES_PATH_BYTES];
  unsigned char bytes[BYTES];
  hl_error error = {0};
  hl_fetched_file file;
  memset(bytes, url[0], sizeof bytes);
  assert_int_equal(copies_begin(folder, path, &error), HL_OK);
  int descriptor = open(path, O_WRONLY);
  assert_int_equal(write(descriptor, bytes, sizeof bytes), BYTES);
  close(descriptor);
  assert_int_equal(copies_keep(folder, url, "If-None-Match: \"1\"", path, &file, &error), HL_OK);
  assert_int_equal(file.size, BYTES);
  close(file.descriptor);
}

static bool has_copy(const char *url) {
  char condition[FETCH_CONDITION_BYTES];
  unsigned char byte = 0;
  hl_fetched_file file;
  copies_find(folder, url, &file, condition);
  if (file.descriptor < 0) return false;
  assert_int_equal(file.size, BYTES);
  assert_string_equal(condition, "If-None-Match: \"1\"");
  assert_int_equal(pread(file.descriptor, &byte, 1, BYTES - 1), 1);
  assert_int_equal(byte, url[0]);
  close(file.descriptor);
  return true;
}

/* Dates every copy in the folder, so that copies made later are newer. */
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

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(the_oldest_make_room),
                                     cmocka_unit_test(a_copy_of_another_url_is_not_taken)};
  strcpy(folder, "/tmp/halflight-copies-XXXXXX");
  if (mkdtemp(folder) == NULL) return 1;
  int failed = cmocka_run_group_tests(tests, NULL, NULL);
  char command[100];
  snprintf(command, sizeof command, "rm -r %s", folder);
  return system(command) != 0 || failed != 0;
}
