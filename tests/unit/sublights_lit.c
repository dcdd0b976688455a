/* unit/sublights_lit.c - the blocks of a slab that parts of a light reach, against every one of the parts'
 * blocks looked at. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "shadow_sublights/sublights.h"

enum {
  PARTS = 3,
  PART_TILES = 5,
  SLAB_TILES = 4,
  SLAB_BLOCKS = SLAB_TILES * 4,
  PART_BLOCKS = PART_TILES * 4
};

typedef struct lit_case {
  sublights sublights;
  sublight parts[PARTS];
  uint16_t flags[PARTS][PART_TILES * PART_TILES];
  uint32_t found[SLAB_TILES * SLAB_TILES];
  uint16_t tile_lit[SLAB_TILES * SLAB_TILES];
  shadow_buffer slab;
} lit_case;

static double random_between(uint32_t *seed, double low, double high) {
  *seed = *seed * 1664525u + 1013904223u;
  return low + (high - low) * (*seed >> 8) / 16777216.0;
}

static void make_case(lit_case *c, uint32_t *seed) {
  *c = (lit_case){
      .sublights = {.count = PARTS, .channels = 1, .tiles_x = PART_TILES, .tiles_y = PART_TILES, .slabs = 1},
      .slab = {.tiles_x = SLAB_TILES, .tiles_y = SLAB_TILES}};
  c->sublights.parts = c->parts;
  c->sublights.found = c->found;
  c->slab.tile_lit = c->tile_lit;
  for (int i = 0; i < PARTS; i++) {
    sublight *part = &c->parts[i];
    part->reaches = i < 2;
    part->lit = c->flags[i];
    for (int axis = 0; axis < 2; axis++) {
      part->near.scale[axis] = random_between(seed, 0, 1) < 0.5 ? 1 : random_between(seed, 0.8, 1.3);
      part->far.scale[axis] = part->near.scale[axis];
      part->near.shift[axis] = random_between(seed, -30, 20);
      part->far.shift[axis] = part->near.shift[axis] + random_between(seed, -3, 3);
    }
    for (int tile = 0; tile < PART_TILES * PART_TILES; tile++)
      c->flags[i][tile] = random_between(seed, 0, 1) < 0.7
                              ? 0
                              : (uint16_t)(1u << (int)random_between(seed, 0, 15.99));
  }
}

/* Whether pixels of the slab, some more around its block, lie over a lit block of the part at one of its
 * places. */
static bool is_under(const sublight *part, const part_place *place, int x, int y, double around) {
  for (int row = 0; row < PART_BLOCKS; row++)
    for (int column = 0; column < PART_BLOCKS; column++) {
      const int part_block[2] = {column, row}, block[2] = {x, y};
      bool apart = (part->lit[row / 4 * PART_TILES + column / 4] >> (row % 4 * 4 + column % 4) & 1) == 0;
      for (int axis = 0; axis < 2; axis++) {
        double low = place->scale[axis] * (block[axis] * BLOCK - around - place->shift[axis]);
        double high = place->scale[axis] * ((block[axis] + 1) * BLOCK + around - place->shift[axis]);
        apart = apart || high < part_block[axis] * BLOCK || low > (part_block[axis] + 1) * BLOCK;
      }
      if (!apart) return true;
    }
  return false;
}

static bool is_lit(const lit_case *c, int x, int y, double around) {
  for (int i = 0; i < PARTS; i++)
    if (c->parts[i].reaches && (is_under(&c->parts[i], &c->parts[i].near, x, y, around) ||
                                is_under(&c->parts[i], &c->parts[i].far, x, y, around)))
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
        if (is_lit(&c, x, y, 1.9)) assert_true(found); /* half pixels are made of two on either side */
        if (found) assert_true(is_lit(&c, x, y, 12));  /* near and far together, and whole blocks */
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
  c.sublights.slabs = 0; /* nothing was taken yet */
  hl_sublights_find_lit(&c.sublights, &c.slab, 0);
  assert_int_equal(c.tile_lit[0], ALL_BLOCKS);
  for (int i = 0; i < PARTS; i++) c.parts[i].reaches = false;
  c.sublights.slabs = 1;
  hl_sublights_find_lit(&c.sublights, &c.slab, 0);
  assert_int_equal(c.tile_lit[0], 0);
  c.parts[0].comes = true; /* found anew with the next run only */
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
