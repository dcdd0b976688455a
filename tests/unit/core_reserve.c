/* unit/core_reserve.c - blocks of memory that are lent repeatedly: which blocks are kept, and for whom, and
 * that all are released. Blocks of many arrays, which one function counts and hands out. */
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

/* A frame takes blocks of these sizes. Returns the first of them. */
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
  assert_ptr_equal(frame(&reserve, LARGE, 0), first); /* blocks that a frame does not take are released */
  assert_int_equal(held(&reserve), LARGE);
  release(&reserve);
}

static void test_sizes(void **state) {
  (void)state;
  hl_reserve reserve = open_reserve(true);
  frame(&reserve, LARGE, LARGE);
  frame(&reserve, 2 * LARGE, LARGE); /* outgrown */
  assert_int_equal(held(&reserve), 3 * LARGE);
  frame(&reserve, LARGE - 1, LARGE); /* less than half of the block */
  assert_int_equal(held(&reserve), 2 * LARGE - 1);
  frame(&reserve, SMALL, LARGE); /* small blocks are not kept */
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

/* ---- layouts ---- */

typedef struct arrays {
  char *first;
  double *second;
} arrays;

static void lay_out(arrays *arrays, hl_layout *layout) {
  arrays->first = hl_layout_take(layout, 65, 1);
  arrays->second = hl_layout_take(layout, 3, sizeof *arrays->second);
}

/* The block is as large as its arrays together. Each array takes a multiple of 64 bytes, and arrays do not
 * overlap. */
static void test_lays_out(void **state) {
  (void)state;
  hl_reserve reserve = open_reserve(false);
  hl_layout counted = {0}, layout = {0};
  arrays arrays;
  lay_out(&arrays, &counted);
  assert_null(arrays.first);
  assert_int_equal(counted.bytes, 128 + 64);
  int passes = 0;
  for (; hl_layout_pass(&layout, reserve.context); passes++) lay_out(&arrays, &layout);
  assert_int_equal(passes, 2);
  assert_int_equal(held(&reserve), counted.bytes);
  assert_int_equal(layout.bytes, counted.bytes);
  assert_ptr_equal(arrays.first, layout.base);
  assert_ptr_equal(arrays.second, layout.base + 128);
  hl_release(reserve.context, layout.base);
  release(&reserve);
}

/* Memory that is given back counts only if nothing that is taken later is larger. */
static void test_gives_back(void **state) {
  (void)state;
  hl_layout layout = {0};
  hl_layout_take(&layout, 64, 1);
  const size_t kept = layout.bytes;
  hl_layout_take(&layout, 640, 1);
  hl_layout_give_back(&layout, kept);
  hl_layout_take(&layout, 64, 3);
  assert_int_equal(layout.bytes, 256);
  assert_int_equal(layout.most, 704);
}

/* If arrays are larger when they are handed out than when they were counted, they are not handed out. */
static void test_refuses_another_size(void **state) {
  (void)state;
  hl_reserve reserve = open_reserve(false);
  hl_layout layout = {0};
  for (int pass = 1; hl_layout_pass(&layout, reserve.context); pass++)
    hl_layout_take(&layout, (size_t)pass * 64, 1);
  assert_null(layout.base);
  release(&reserve);
}

static void test_refuses_overflow(void **state) {
  (void)state;
  hl_reserve reserve = open_reserve(false);
  hl_layout layout = {0};
  int passes = 0;
  for (; hl_layout_pass(&layout, reserve.context); passes++) {
    hl_layout_take(&layout, SIZE_MAX / 2, 3);
    hl_layout_give_back(&layout, 0);
    hl_layout_take(&layout, 1, 1);
  }
  assert_int_equal(passes, 1);
  assert_null(layout.base);
  assert_int_equal(layout.most, SIZE_MAX);
  release(&reserve);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_lends_again),
                                     cmocka_unit_test(test_sizes),
                                     cmocka_unit_test(test_more_than_it_has_places),
                                     cmocka_unit_test(test_keeps_nothing),
                                     cmocka_unit_test(test_lays_out),
                                     cmocka_unit_test(test_gives_back),
                                     cmocka_unit_test(test_refuses_another_size),
                                     cmocka_unit_test(test_refuses_overflow)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
