/* unit/core_reserve.c - blocks lent again and again: which are kept, for whom, and that all are given back. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <halflight/context.h>

#include "core/reserve.h"

enum { LARGE = 1 << 20, SMALL = 100 };

static hl_reserve open_reserve(bool keeps) {
  hl_reserve reserve = {.keeps = keeps};
  assert_int_equal(hl_context_create(NULL, &reserve.context, NULL), HL_OK);
  return reserve;
}

static void release(hl_reserve *reserve) {
  hl_reserve_release(reserve);
  assert_int_equal(hl_context_memory_held(reserve->context), 0);
  hl_context_destroy(reserve->context);
}

static void test_lends_again(void **state) {
  (void)state;
  hl_reserve reserve = open_reserve(true);
  void *first = hl_reserve_take(&reserve, LARGE, 1), *second = hl_reserve_take(&reserve, LARGE, 1);
  assert_non_null(first);
  assert_ptr_not_equal(first, second);
  hl_reserve_return(&reserve, first);
  assert_ptr_equal(hl_reserve_take(&reserve, LARGE - 5, 1), first); /* a little smaller */
  hl_reserve_return(&reserve, second);
  hl_reserve_return(&reserve, first);
  hl_reserve_return(&reserve, NULL);
  assert_int_equal(hl_context_memory_held(reserve.context), 2 * LARGE);
  release(&reserve);
}

static void test_size(void **state) {
  (void)state;
  hl_reserve reserve = open_reserve(true);
  hl_reserve_return(&reserve, hl_reserve_take(&reserve, LARGE, 1));
  void *half = hl_reserve_take(&reserve, LARGE / 2 - 1, 1); /* less than half of what is idle: a block of its own */
  assert_int_equal(hl_context_memory_held(reserve.context), LARGE + LARGE / 2 - 1);
  hl_reserve_return(&reserve, hl_reserve_take(&reserve, 2 * LARGE, 1)); /* outgrows what is idle */
  assert_int_equal(hl_context_memory_held(reserve.context), 2 * LARGE + LARGE / 2 - 1);
  hl_reserve_return(&reserve, half);
  hl_reserve_return(&reserve, hl_reserve_take(&reserve, SMALL, 1)); /* small ones are not kept */
  assert_int_equal(hl_context_memory_held(reserve.context), 2 * LARGE + LARGE / 2 - 1);
  assert_null(hl_reserve_take(&reserve, SIZE_MAX / 2, 16));
  release(&reserve);
}

static void test_trim(void **state) {
  (void)state;
  hl_reserve reserve = open_reserve(true);
  void *lent = hl_reserve_take(&reserve, LARGE, 1);
  hl_reserve_return(&reserve, hl_reserve_take(&reserve, 4 * LARGE, 1));
  hl_reserve_trim(&reserve); /* both were taken since the beginning */
  assert_int_equal(hl_context_memory_held(reserve.context), 5 * LARGE);
  hl_reserve_trim(&reserve); /* and what is lent still is */
  assert_int_equal(hl_context_memory_held(reserve.context), LARGE);
  hl_reserve_return(&reserve, lent);
  release(&reserve);
}

static void test_more_than_it_has_places(void **state) {
  (void)state;
  hl_reserve reserve = open_reserve(true);
  void *block[RESERVE_BLOCKS + 3];
  for (int i = 0; i < RESERVE_BLOCKS + 3; i++) assert_non_null(block[i] = hl_reserve_take(&reserve, LARGE, 1));
  for (int i = 0; i < RESERVE_BLOCKS + 3; i++) hl_reserve_return(&reserve, block[i]);
  assert_int_equal(hl_context_memory_held(reserve.context), (uint64_t)RESERVE_BLOCKS * LARGE);
  release(&reserve);
}

static void test_keeps_nothing(void **state) {
  (void)state;
  hl_reserve reserve = open_reserve(false);
  void *block = hl_reserve_take(&reserve, LARGE, 1);
  assert_non_null(block);
  hl_reserve_return(&reserve, block);
  assert_int_equal(hl_context_memory_held(reserve.context), 0);
  release(&reserve);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_lends_again), cmocka_unit_test(test_size), cmocka_unit_test(test_trim),
                                     cmocka_unit_test(test_more_than_it_has_places),
                                     cmocka_unit_test(test_keeps_nothing)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
