/* tests/unit/zarr_shards.c - ranges of a shard's chunks: joined where gaps are narrow, and never so many that
 * the process runs out of descriptors. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "volume/formats/zarr/shard.h"

enum { WIDE = 1 << 20 }; /* a gap that takes longer to read than a request takes */

static void narrow_gaps_are_read_over(void **state) {
  hl_fetch_range ranges[] = {{3 * WIDE, 10}, {0, 100}, {150, 50}, {100, 20}, {3 * WIDE + 5, 5}};
  (void)state;
  assert_int_equal(hl_zarr_spans_join(ranges, 5), 2);
  assert_int_equal(ranges[0].begin, 0);
  assert_int_equal(ranges[0].count, 200);
  assert_int_equal(ranges[1].begin, 3 * WIDE);
  assert_int_equal(ranges[1].count, 10);
  assert_int_equal(hl_zarr_spans_join(ranges, 0), 0);
}

static int falling(const void *a, const void *b) {
  const uint64_t *first = a, *second = b;
  return *first > *second ? -1 : *first < *second;
}

/* If there are too many chunks far apart, the ranges with the narrowest gaps between them are joined. */
static void the_widest_gaps_stay(void **state) {
  enum { CHUNKS = 2000, BYTES = 100 };
  hl_fetch_range ranges[CHUNKS];
  uint64_t gaps[CHUNKS - 1], place = 0, bytes = 0;
  (void)state;
  for (uint64_t n = 0; n < CHUNKS; n++) {
    ranges[CHUNKS - 1 - n] = (hl_fetch_range){place, BYTES};
    uint64_t gap = WIDE + n * 7919 % CHUNKS;
    if (n + 1 < CHUNKS) gaps[n] = gap, place += BYTES + gap;
  }
  qsort(gaps, CHUNKS - 1, sizeof *gaps, falling);
  uint64_t expected = place + BYTES;
  for (size_t n = 0; n + 1 < HL_ZARR_SPANS_MOST; n++) expected -= gaps[n];
  assert_int_equal(hl_zarr_spans_join(ranges, CHUNKS), HL_ZARR_SPANS_MOST);
  for (size_t n = 0; n < HL_ZARR_SPANS_MOST; n++) bytes += ranges[n].count;
  assert_int_equal(bytes, expected);
  assert_int_equal(ranges[0].begin, 0);
  assert_int_equal(ranges[HL_ZARR_SPANS_MOST - 1].begin + ranges[HL_ZARR_SPANS_MOST - 1].count,
                   place + BYTES);
}

/* Of equal gaps, the first stay as long as there may be more ranges. */
static void equal_gaps_stay_where_they_may(void **state) {
  enum { CHUNKS = HL_ZARR_SPANS_MOST + 3 };
  hl_fetch_range ranges[CHUNKS];
  (void)state;
  for (size_t n = 0; n < CHUNKS; n++) ranges[n] = (hl_fetch_range){n * WIDE, 100};
  assert_int_equal(hl_zarr_spans_join(ranges, CHUNKS), HL_ZARR_SPANS_MOST);
  assert_int_equal(ranges[0].count, 100);
  assert_int_equal(ranges[HL_ZARR_SPANS_MOST - 1].count, 3 * WIDE + 100);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(narrow_gaps_are_read_over),
                                     cmocka_unit_test(the_widest_gaps_stay),
                                     cmocka_unit_test(equal_gaps_stay_where_they_may)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
