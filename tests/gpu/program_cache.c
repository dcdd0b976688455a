/* gpu/program_cache.c - the folder in which compiled kernels are kept: which programs are found again, and
 * which are removed. */
#define _GNU_SOURCE /* mkdtemp */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "gpu/program_cache.h"

static char folder[] = "/tmp/halflight-programs-XXXXXX";

static void store(const char *key, void *bytes, size_t size) {
  hl_program_store(folder, key, &(gpu_binary){bytes, size});
}

static bool is_stored(const char *key, const void *bytes, size_t size) {
  gpu_binary found = {0};
  if (!hl_program_stored(folder, key, &found)) return false;
  const bool same = found.size == size && memcmp(found.bytes, bytes, size) == 0;
  free(found.bytes);
  return same;
}

/* A program is found only by the same driver, device name and versions, which are in its key. */
static void test_keys(void **state) {
  (void)state;
  char bytes[] = "kernels";
  store("opencl A, 1.0", bytes, sizeof bytes);
  assert_true(is_stored("opencl A, 1.0", bytes, sizeof bytes));
  assert_false(is_stored("opencl A, 1.1", bytes, sizeof bytes));
  assert_false(is_stored("opencl B, 1.0", bytes, sizeof bytes));
  store("opencl A, 1.1", bytes, sizeof bytes - 1);
  assert_true(is_stored("opencl A, 1.0", bytes, sizeof bytes));
  assert_true(is_stored("opencl A, 1.1", bytes, sizeof bytes - 1));
}

/* If all programs together exceed the limit, the oldest are removed. A program that is larger than a quarter
 * of the limit is not stored. */
static void test_limit(void **state) {
  (void)state;
  enum { SIZE = PROGRAM_CACHE_BYTES / 5, PROGRAMS = 8 };
  char key[32], *bytes = calloc(1, PROGRAM_CACHE_BYTES / 2);
  assert_non_null(bytes);
  for (int i = 0; i < PROGRAMS; i++) {
    snprintf(key, sizeof key, "program %d", i);
    store(key, bytes, SIZE);
    assert_true(is_stored(key, bytes, SIZE));
    if (i < PROGRAMS - 1) sleep(1); /* the ages of files are compared by the second */
  }
  for (int i = 0; i < PROGRAMS; i++) {
    snprintf(key, sizeof key, "program %d", i);
    assert_int_equal(is_stored(key, bytes, SIZE), i >= PROGRAMS - 4);
  }
  store("large", bytes, PROGRAM_CACHE_BYTES / 2);
  assert_false(is_stored("large", bytes, PROGRAM_CACHE_BYTES / 2));
  free(bytes);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_keys), cmocka_unit_test(test_limit)};
  char command[sizeof folder + 16];
  if (mkdtemp(folder) == NULL) return 1;
  cmocka_set_message_output(CM_OUTPUT_TAP);
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  snprintf(command, sizeof command, "rm -r %s", folder);
  return system(command) != 0 || failed;
}
