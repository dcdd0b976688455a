/* unit/sublights_lit.c - the blocks of a slab that sub-lights reach, compared with a search of all blocks of
 * the sub-lights. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "shadow_sublights/sublights.h"

enum {
  SUBLIGHTS = 3,
  SUBLIGHT_TILES = 5,
  SLAB_TILES = 4,
  SLAB_BLOCKS = SLAB_TILES * 4,
  SUBLIGHT_BLOCKS = SUBLIGHT_TILES * 4
};

typedef struct lit_case {
  sublights sublights;
  sublight sublight[SUBLIGHTS];
  uint16_t flags[SUBLIGHTS][SUBLIGHT_TILES * SUBLIGHT_TILES];
  uint32_t found[SLAB_TILES * SLAB_TILES];
  uint16_t tile_lit[SLAB_TILES * SLAB_TILES];
  shadow_buffer slab;
} lit_case;

static double random_between(uint32_t *seed, double low, double high) {
  *seed = *seed * 1664525u + 1013904223u;
  return low + (high - low) * (*seed >> 8) / 16777216.0;
}

static void make_case(lit_case *c, uint32_t *seed) {
  *c = (lit_case){.sublights = {.count = SUBLIGHTS,
                                .channels = 1,
                                .tiles_x = SUBLIGHT_TILES,
                                .tiles_y = SUBLIGHT_TILES,
                                .slabs = 1},
                  .slab = {.tiles_x = SLAB_TILES, .tiles_y = SLAB_TILES}};
  c->sublights.sublight = c->sublight;
  c->sublights.found = c->found;
  c->slab.tile_lit = c->tile_lit;
  for (int i = 0; i < SUBLIGHTS; i++) {
    sublight *sublight = &c->sublight[i];
    sublight->maps.reaches = i < 2;
    sublight->lit = c->flags[i];
    for (int axis = 0; axis < 2; axis++) {
      sublight->maps.near.scale[axis] = random_between(seed, 0, 1) < 0.5
                                            ? 1
                                            : (float)random_between(seed, 0.8, 1.3);
      sublight->maps.far.scale[axis] = sublight->maps.near.scale[axis];
      sublight->maps.near.shift[axis] = (float)random_between(seed, -30, 20);
      sublight->maps.far.shift[axis] = sublight->maps.near.shift[axis] + (float)random_between(seed, -3, 3);
    }
    for (int tile = 0; tile < SUBLIGHT_TILES * SUBLIGHT_TILES; tile++)
      c->flags[i][tile] = random_between(seed, 0, 1) < 0.7
                              ? 0
                              : (uint16_t)(1u << (int)random_between(seed, 0, 15.99));
  }
}

/* Returns whether pixels of the slab, with a margin around its block, lie over a lit block of the sub-light
 * in one of its maps. */
static bool is_under(const sublight *sublight, const sublight_map *map, int x, int y, double around) {
  for (int row = 0; row < SUBLIGHT_BLOCKS; row++)
    for (int column = 0; column < SUBLIGHT_BLOCKS; column++) {
      const int sublight_block[2] = {column, row}, block[2] = {x, y};
      bool apart = (sublight->lit[row / 4 * SUBLIGHT_TILES + column / 4] >> (row % 4 * 4 + column % 4) & 1) ==
                   0;
      for (int axis = 0; axis < 2; axis++) {
        double low = (double)map->scale[axis] * (block[axis] * BLOCK - around - (double)map->shift[axis]);
        double high = (double)map->scale[axis] *
                      ((block[axis] + 1) * BLOCK + around - (double)map->shift[axis]);
        apart = apart || high < sublight_block[axis] * BLOCK || low > (sublight_block[axis] + 1) * BLOCK;
      }
      if (!apart) return true;
    }
  return false;
}

static bool is_lit(const lit_case *c, int x, int y, double around) {
  for (int i = 0; i < SUBLIGHTS; i++)
    if (c->sublight[i].maps.reaches && (is_under(&c->sublight[i], &c->sublight[i].maps.near, x, y, around) ||
                                        is_under(&c->sublight[i], &c->sublight[i].maps.far, x, y, around)))
      return true;
  return false;
}

static void test_against_all_blocks(void **state) {
  (void)state;
  uint32_t seed = 5;
  int lit = 0, dark = 0;
  for (int round = 0; round < 200; round++) {
    lit_case c;
    make_case(&c, &seed);
    for (size_t tile = 0; tile < SLAB_TILES * SLAB_TILES; tile++)
      hl_sublights_find_lit(&c.sublights, &c.slab, tile);
    for (int y = 0; y < SLAB_BLOCKS; y++)
      for (int x = 0; x < SLAB_BLOCKS; x++) {
        bool found = c.tile_lit[y / 4 * SLAB_TILES + x / 4] >> (y % 4 * 4 + x % 4) & 1;
        /* half-size pixels are made of two pixels in each direction */
        if (is_lit(&c, x, y, 1.9)) assert_true(found);
        if (found) assert_true(is_lit(&c, x, y, 12)); /* near and far are tested together, and whole blocks */
        lit += found;
        dark += !found;
      }
  }
  assert_true(lit > 5000 && dark > 5000);
}

static void test_when_it_is_found(void **state) {
  (void)state;
  uint32_t seed = 7;
  lit_case c;
  make_case(&c, &seed);
  c.sublights.slabs = 0; /* nothing was absorbed so far */
  hl_sublights_find_lit(&c.sublights, &c.slab, 0);
  assert_int_equal(c.tile_lit[0], ALL_BLOCKS);
  for (int i = 0; i < SUBLIGHTS; i++) c.sublight[i].maps.reaches = false;
  c.sublights.slabs = 1;
  hl_sublights_find_lit(&c.sublights, &c.slab, 0);
  assert_int_equal(c.tile_lit[0], 0);
  c.sublight[0].maps.comes = true; /* the blocks are found anew in the next run */
  hl_sublights_find_lit(&c.sublights, &c.slab, 0);
  assert_int_equal(c.tile_lit[0], 0);
  c.sublights.slabs = 5;
  hl_sublights_find_lit(&c.sublights, &c.slab, 0);
  assert_int_equal(c.tile_lit[0], ALL_BLOCKS);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_against_all_blocks),
                                     cmocka_unit_test(test_when_it_is_found)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
