/* unit/core_reserve.c - blocks lent again and again: which are kept, for whom, and that all are given
 * back. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <halflight/context.h>

#include "core/memory.h"

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

static uint64_t held(const hl_reserve *reserve) { return hl_context_memory_held(reserve->context); }

/* A frame that takes blocks of these sizes; the first of them. */
static void *frame(hl_reserve *reserve, size_t first, size_t second) {
  void *a = hl_reserve_take(reserve, first, 1), *b = second > 0 ? hl_reserve_take(reserve, second, 1) : NULL;
  assert_non_null(a);
  assert_ptr_not_equal(a, b);
  hl_reserve_return(reserve, b);
  hl_reserve_return(reserve, a);
  hl_reserve_end_frame(reserve);
  return a;
}

static void test_lends_again(void **state) {
  (void)state;
  hl_reserve reserve = open_reserve(true);
  void *first = frame(&reserve, LARGE, 2 * LARGE);
  assert_ptr_equal(frame(&reserve, LARGE - 5, 2 * LARGE), first); /* a little smaller */
  assert_ptr_equal(frame(&reserve, LARGE, 2 * LARGE), first);
  assert_int_equal(held(&reserve), 3 * LARGE);
  assert_ptr_equal(frame(&reserve, LARGE, 0), first); /* what a frame does not take is released */
  assert_int_equal(held(&reserve), LARGE);
  release(&reserve);
}

static void test_sizes(void **state) {
  (void)state;
  hl_reserve reserve = open_reserve(true);
  frame(&reserve, LARGE, LARGE);
  frame(&reserve, 2 * LARGE, LARGE); /* outgrown */
  assert_int_equal(held(&reserve), 3 * LARGE);
  frame(&reserve, LARGE - 1, LARGE); /* less than half of it */
  assert_int_equal(held(&reserve), 2 * LARGE - 1);
  frame(&reserve, SMALL, LARGE); /* small ones are not kept */
  assert_int_equal(held(&reserve), LARGE);
  assert_null(hl_reserve_take(&reserve, SIZE_MAX / 2, 16));
  release(&reserve);
}

static void test_more_than_it_has_places(void **state) {
  (void)state;
  hl_reserve reserve = open_reserve(true);
  void *block[RESERVE_BLOCKS + 3];
  for (int i = 0; i < RESERVE_BLOCKS + 3; i++)
    assert_non_null(block[i] = hl_reserve_take(&reserve, LARGE, 1));
  for (int i = 0; i < RESERVE_BLOCKS + 3; i++) hl_reserve_return(&reserve, block[i]);
  assert_int_equal(held(&reserve), (uint64_t)RESERVE_BLOCKS * LARGE);
  release(&reserve);
}

static void test_keeps_nothing(void **state) {
  (void)state;
  hl_reserve reserve = open_reserve(false);
  void *block = hl_reserve_take(&reserve, LARGE, 1);
  assert_non_null(block);
  hl_reserve_return(&reserve, block);
  assert_int_equal(held(&reserve), 0);
  release(&reserve);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_lends_again), cmocka_unit_test(test_sizes),
                                     cmocka_unit_test(test_more_than_it_has_places),
                                     cmocka_unit_test(test_keeps_nothing)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
