/* unit/cascade_reads.c - the rows of tiles that a cascade's passes read, compared with a search of every
 * pixel within reach. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "shadow_cascade/cascade_reads.h"

enum { TILES_X = 13, TILES_Y = 9, SHEETS = 3, WORDS = (TILES_X * TILES_Y + 63) / 64 };

static bool is_read(const uint64_t *by_sheet, int first, int last, int x, int y) {
  int tile = y * TILES_X + x;
  for (int sheet = first; sheet <= last; sheet++)
    if (by_sheet[sheet * WORDS + tile / 64] >> tile % 64 & 1) return true;
  return false;
}

/* Returns whether a tile that is read has a pixel in the rectangle of the buffer's pixels, ends included. */
static bool any_read(const uint64_t *by_sheet, int first, int last, int left, int top, int right,
                     int bottom) {
  for (int y = 0; y < TILES_Y; y++)
    for (int x = 0; x < TILES_X; x++)
      if (x * TILE <= right && (x + 1) * TILE > left && y * TILE <= bottom && (y + 1) * TILE > top &&
          is_read(by_sheet, first, last, x, y))
        return true;
  return false;
}

static void check_tile(const cascade_reads *reads, const uint64_t *by_sheet, int first, int last, int scale,
                       int reach, int x, int y) {
  /* sideways, whole tiles of the buffer count */
  int left = (x * scale - (reach + TILE - 1) / TILE) * TILE,
      right = ((x + 1) * scale + (reach + TILE - 1) / TILE) * TILE - 1;
  tile_rows wanted = {TILE, 0};
  for (int row = 0; row < TILE; row += BLOCK) {
    int top = (y * TILE + row) * scale - reach, bottom = (y * TILE + row + BLOCK) * scale - 1 + reach;
    if (!any_read(by_sheet, first, last, left, top, right, bottom)) continue;
    if (wanted.end == 0) wanted.first = row;
    wanted.end = row + BLOCK;
  }
  const read_row read = hl_cascade_read_row(reads, scale, y, reach);
  assert_int_equal(hl_cascade_is_read(&read, &read.all, x), wanted.end > 0);
  if (wanted.end == 0) return;
  tile_rows rows = hl_cascade_rows_read(&read, x);
  assert_int_equal(rows.first, wanted.first);
  assert_int_equal(rows.end, wanted.end);
}

static void test_rows_within_reach(void **state) {
  (void)state;
  uint64_t by_sheet[SHEETS * WORDS];
  uint32_t before[(TILES_X + 1) * (TILES_Y + 1)];
  cascade_reads reads = {TILES_X, TILES_Y, before};
  const occupancy occupancy = {
      .tiles_x = TILES_X, .tiles_y = TILES_Y, .sheets = SHEETS, .tile_words = WORDS, .by_sheet = by_sheet};
  const int reaches[] = {0, 1, 4, 15, 16, 17, 40, 300};
  srand(7);
  for (int round = 0; round < 40; round++) {
    memset(by_sheet, 0, sizeof by_sheet);
    for (int i = 0; i < round; i++) {
      int tile = rand() % (TILES_X * TILES_Y);
      by_sheet[rand() % SHEETS * WORDS + tile / 64] |= (uint64_t)1 << tile % 64;
    }
    int first = round % 2, last = 1 + round % 3 / 2;
    hl_cascade_reads_find(&reads, &occupancy, NULL, first, last);
    for (int scale = 1; scale <= 8; scale *= 2)
      for (size_t i = 0; i < sizeof reaches / sizeof reaches[0]; i++)
        for (int y = 0; y * scale < TILES_Y; y++)
          for (int x = 0; x * scale < TILES_X; x++)
            check_tile(&reads, by_sheet, first, last, scale, reaches[i], x, y);
  }
}

static void test_everywhere(void **state) {
  (void)state;
  const cascade_reads reads = {TILES_X, TILES_Y, NULL};
  const read_row read = hl_cascade_read_row(&reads, 1, 3, READ_EVERYWHERE);
  tile_rows rows = hl_cascade_rows_read(&read, 5);
  assert_int_equal(rows.first, 0);
  assert_int_equal(rows.end, TILE);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_rows_within_reach),
                                     cmocka_unit_test(test_everywhere)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
