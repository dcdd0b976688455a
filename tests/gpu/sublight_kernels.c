/* gpu/sublight_kernels.c - the kernels' passes of sub-lights, compiled as C17, give the bytes of the
 * processors' functions (shadow_sublights/sublight_lanes.h, shadow_sublights/sublights.c). */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "shadow_sublights/sublight_lanes.h"
#include "shadow_sublights/sublights.h"

/* The kernels' names are those of the processors' functions in places. */
#define sublight_tile  device_sublight_tile
#define dot3           device_dot3
#define cross3         device_cross3
#define row_of_vector  device_row_of_vector
#define row_of_point   device_row_of_point
#define linear_in_view device_linear_in_view

#define SUBLIGHTS       1
#define OUTSIDE         1
#define CHANNELS        1
#define PLANES_OF_SHEET 2
#include "gpu/kernels/sublights.h"
#undef sublight_tile

enum {
  SLAB_X = 5,
  SLAB_Y = 4,
  SLAB_TILES = SLAB_X * SLAB_Y,
  MARGIN = 48,
  SLAB_STRIDE = SLAB_X * TILE + 2 * MARGIN,
  SLAB_PLANE = SLAB_STRIDE * (SLAB_Y * TILE + 2 * MARGIN),
  ORIGIN = MARGIN * SLAB_STRIDE + MARGIN,
  OWN_X = 4,
  OWN_Y = 3,
  OWN_TILES = OWN_X * OWN_Y,
  STRIDE = (OWN_X + 2) * TILE, /* of the processors' planes: a tile on either side */
  OWN_STRIDE = OWN_X * TILE,
  OWN_PLANE = OWN_TILES * TILE * TILE,
  MARKS = 2 * SLAB_TILES + SLAB_TILES + 3 * OWN_TILES,
  ROUNDS = 300
};

static uint32_t next_bits(uint64_t *state) {
  *state = *state * 6364136223846793005u + 1442695040888963407u;
  return (uint32_t)(*state >> 32);
}
static float next_fraction(uint64_t *state) { return (float)(next_bits(state) >> 8) * 0x1p-24f; }
static float next_between(uint64_t *state, float low, float high) {
  return low + (high - low) * next_fraction(state);
}

/* A slab and its copies, and a sub-light, as the processors and as a device keep them. */
static struct {
  float slab[2][SLAB_PLANE], moved[2][MOVED_COPIES][SLAB_PLANE];
  slab_rows rows[SLAB_TILES];
  bool touched[SLAB_TILES];
  sublight_pixel pixels[2][STRIDE * OWN_Y * TILE];
  uint16_t lit[OWN_TILES];
} own;
static struct {
  float planes[2 * SLAB_PLANE], halves[2 * MOVED_COPIES * SLAB_PLANE];
  word16 pixels[2 * OWN_PLANE];
  int marks[MARKS];
} device;

static const device_sweep plan = {.ring = 1,
                                  .sublight_count = 1,
                                  .lights = {{.tiles_x = SLAB_X,
                                              .tiles = SLAB_TILES,
                                              .stride = SLAB_STRIDE,
                                              .plane = SLAB_PLANE,
                                              .origin = ORIGIN,
                                              .sublights = 1,
                                              .sublight_tiles_x = OWN_X,
                                              .sublight_tiles_y = OWN_Y,
                                              .sublight_stride = OWN_STRIDE,
                                              .sublight_plane = OWN_PLANE}}};
static const plan_pass pass = {.first = 1, .sheet = 1, .chunk = 0};

/* Fills the slab at random: tiles of ones, tiles with few pixels below 1, and tiles full of them. */
static void fill_slab(uint64_t *seed) {
  for (int p = 0; p < 2; p++)
    for (int i = 0; i < SLAB_PLANE; i++)
      own.slab[p][i] = own.moved[p][0][i] = own.moved[p][1][i] = own.moved[p][2][i] = 1;
  memset(own.touched, 0, sizeof own.touched);
  for (int y = 0; y < SLAB_Y * TILE; y++)
    for (int x = 0; x < SLAB_X * TILE; x++) {
      const uint32_t tile = (uint32_t)(y / TILE * SLAB_X + x / TILE),
                     kind = (tile * 7 + (uint32_t)(*seed >> 60)) % 3;
      const uint32_t bits = next_bits(seed);
      if (kind == 0 || (kind == 1 && bits % 16 != 0)) continue;
      const float passing = bits % 5 == 0 ? 0 : bits % 5 == 1 ? 1 - 0x1p-18f : next_fraction(seed);
      own.slab[0][ORIGIN + y * SLAB_STRIDE + x] = passing;
      own.slab[1][ORIGIN + y * SLAB_STRIDE + x] = passing + (1 - passing) * next_fraction(seed);
      own.touched[tile] = true;
    }
  memcpy(device.planes, own.slab, sizeof device.planes);
  for (int i = 0; i < 2 * MOVED_COPIES * SLAB_PLANE; i++) device.halves[i] = 2; /* read by nobody */
  memset(device.marks, 0, sizeof device.marks);
  for (int tile = 0; tile < SLAB_TILES; tile++) device.marks[tile] = own.touched[tile];
}

static void move_slab(void) {
  for (int tile = 0; tile < SLAB_TILES; tile++) {
    const int x = tile % SLAB_X, y = tile / SLAB_X, x1 = x + 1 < SLAB_X ? x + 1 : x,
              y1 = y + 1 < SLAB_Y ? y + 1 : y;
    own.rows[tile] = 0;
    if (!own.touched[tile] && !own.touched[y * SLAB_X + x1] && !own.touched[y1 * SLAB_X + x] &&
        !own.touched[y1 * SLAB_X + x1])
      continue;
    for (int p = 0; p < 2; p++) {
      half_pixel_job job = {.slab = own.slab[p] + ORIGIN, .slab_stride = SLAB_STRIDE};
      for (int i = 1; i < SLAB_COPIES; i++) job.moved[i] = own.moved[p][i - 1] + ORIGIN;
      own.rows[tile] |= half_pixel_tile(&job, x, y);
    }
  }
  for (int i = 0; i < SLAB_TILES * TILE * TILE; i++)
    make_halves(&plan, &pass, device.planes, device.halves, device.marks, i);
}

/* The copies are the same wherever a tile is marked, and ones elsewhere. */
static void test_halves(void **state) {
  (void)state;
  uint64_t seed = 3;
  for (int round = 0; round < 30; round++) {
    fill_slab(&seed);
    move_slab();
    const int *present = device.marks + SLAB_TILES;
    for (int i = 0; i < SLAB_TILES * TILE * TILE; i++) {
      const int x = i % (SLAB_X * TILE), y = i / (SLAB_X * TILE), at = ORIGIN + y * SLAB_STRIDE + x;
      for (int copy = 0; copy < 2 * MOVED_COPIES; copy++) {
        const float found = present[y / TILE * SLAB_X + x / TILE] ? device.halves[copy * SLAB_PLANE + at]
                                                                  : 1.0f;
        assert_memory_equal(&found, &own.moved[copy / MOVED_COPIES][copy % MOVED_COPIES][at], sizeof found);
      }
    }
  }
}

/* Fills a sub-light at random; the light at the outside is not less than the transmittance. */
static void fill_sublight(uint64_t *seed) {
  for (int tile = 0; tile < OWN_TILES; tile++) {
    own.lit[tile] = (uint16_t)(next_bits(seed) % 3 == 0 ? 0 : ALL_BLOCKS);
    device.marks[3 * SLAB_TILES + tile] = ~own.lit[tile] & EVERY_BLOCK;
  }
  memset(own.pixels, 0xff, sizeof own.pixels);
  for (int y = 0; y < OWN_Y * TILE; y++)
    for (int x = 0; x < OWN_STRIDE; x++) {
      const uint32_t bits = next_bits(seed), dark = (uint32_t)(x / BLOCK + y / BLOCK) % 3;
      const word16 passing = (word16)(dark == 0       ? bits % 80
                                      : bits % 3 == 0 ? 65535
                                                      : bits >> 16),
                   outside = (word16)(passing + (65535u - passing) *
                                                    (uint64_t)(dark == 0 ? 0 : next_bits(seed) >> 16) /
                                                    65536);
      own.pixels[0][y * STRIDE + TILE + x] = device.pixels[y * OWN_STRIDE + x] = passing;
      own.pixels[1][y * STRIDE + TILE + x] = device.pixels[OWN_PLANE + y * OWN_STRIDE + x] = outside;
    }
}

static sublight_job job_of(const sublight_place *place, float carry) {
  sublight_job job = {.slab_stride = SLAB_STRIDE,
                      .rows = own.rows,
                      .slab_tiles_x = SLAB_X,
                      .slab_tiles_y = SLAB_Y,
                      .place = *place,
                      .stride = STRIDE,
                      .tiles_x = OWN_X,
                      .carry = carry,
                      .channels = 1};
  job.slab[0][0] = own.slab[0] + ORIGIN;
  job.slab_outside[0][0] = own.slab[1] + ORIGIN;
  for (int i = 1; i < SLAB_COPIES; i++) {
    job.slab[0][i] = own.moved[0][i - 1] + ORIGIN;
    job.slab_outside[0][i] = own.moved[1][i - 1] + ORIGIN;
  }
  job.transmittance[0] = own.pixels[0] + TILE;
  job.outside[0] = own.pixels[1] + TILE;
  return job;
}

/* A slab that is only shifted, or scaled by little or by much. */
static sublight_place draw_place(int round, uint64_t *seed) {
  sublight_place place = {.shifted = round % 2 == 0};
  for (int axis = 0; axis < 2; axis++) {
    place.scale[axis] = round % 2 == 0   ? 1
                        : round % 8 == 1 ? next_between(seed, 0.2f, 5)
                                         : next_between(seed, 0.9f, 1.1f);
    place.shift[axis] = next_between(seed, round % 16 < 2 ? -200 : -40, round % 16 < 2 ? 200 : 60);
    if (place.shifted) place.half[axis] = (int)floorf(2 * place.shift[axis] + 0.5f);
  }
  return place;
}

static void composite_own(const sublight_job *job) {
  unsigned char touched[OWN_X];
  for (int y = 0; y < OWN_Y; y++) {
    if (job->place.shifted) sublight_row(job, y, 0, SLAB_X - 1, own.lit + y * OWN_X, touched);
    for (int x = 0; x < OWN_X && !job->place.shifted; x++)
      if (own.lit[y * OWN_X + x] != 0) sublight_tile(job, x, y);
  }
}

static void assert_same_pixels(void) {
  for (int p = 0; p < 2; p++)
    for (int y = 0; y < OWN_Y * TILE; y++)
      assert_memory_equal(own.pixels[p] + y * STRIDE + TILE, device.pixels + p * OWN_PLANE + y * OWN_STRIDE,
                          OWN_STRIDE * sizeof(word16));
}

static void test_composite(void **state) {
  (void)state;
  uint64_t seed = 5;
  int changed = 0;
  for (int round = 0; round < ROUNDS; round++) {
    fill_slab(&seed);
    move_slab();
    fill_sublight(&seed);
    const sublight_place place = draw_place(round, &seed);
    const sublight_job job = job_of(&place, next_between(&seed, 0.01f, 0.99f));
    const plan_sublight_place places[2] = {{0},
                                           {.reaches = 1,
                                            .shifted = place.shifted,
                                            .scale = {place.scale[0], place.scale[1]},
                                            .shift = {place.shift[0], place.shift[1]},
                                            .halves = {place.half[0], place.half[1]},
                                            .carry = job.carry}};
    static word16 before[2 * OWN_PLANE];
    memcpy(before, device.pixels, sizeof before);
    composite_own(&job);
    for (int i = 0; i < OWN_PLANE; i++)
      composite_sublights(&plan, &pass, places, device.planes, device.halves, device.pixels, device.marks, i);
    assert_same_pixels();
    changed += memcmp(before, device.pixels, sizeof before) != 0;
    for (int tile = 0; tile < OWN_TILES; tile++) {
      const uint32_t lit = sublight_lit(&job, tile % OWN_X, tile / OWN_X, own.lit[tile]);
      find_dark(&plan, &pass, places, device.pixels, device.marks, tile);
      assert_int_equal(~device.marks[3 * SLAB_TILES + tile] & EVERY_BLOCK, lit);
    }
    assert_same_pixels();
  }
  assert_true(changed > ROUNDS / 2);
}

/* The blocks of the next slabs that a sub-light reaches. */
static void test_reached(void **state) {
  (void)state;
  uint64_t seed = 7;
  int some = 0;
  for (int round = 0; round < ROUNDS; round++) {
    sublight one = {.lit = own.lit};
    uint32_t found[SLAB_TILES] = {0};
    uint16_t tile_lit[SLAB_TILES];
    sublights all = {
        .count = 1, .tiles_x = OWN_X, .tiles_y = OWN_Y, .slabs = 1, .sublight = &one, .found = found};
    shadow_buffer slab = {.tiles_x = SLAB_X, .tiles_y = SLAB_Y, .tile_lit = tile_lit};
    const sublight_place near = draw_place(round, &seed), far = draw_place(round, &seed);
    one.maps = (sublight_maps){.reaches = round % 7 != 0, .comes = round % 14 == 0};
    for (int axis = 0; axis < 2; axis++) {
      one.maps.near.scale[axis] = 1 / near.scale[axis];
      one.maps.near.shift[axis] = near.shift[axis];
      one.maps.far.scale[axis] = 1 / far.scale[axis];
      one.maps.far.shift[axis] = round % 3 == 0 ? far.shift[axis] : near.shift[axis] + 1.7f;
    }
    const sublight_maps *m = &one.maps;
    const plan_sublight_maps maps = {m->reaches,
                                     m->comes,
                                     {m->near.scale[0], m->near.scale[1]},
                                     {m->near.shift[0], m->near.shift[1]},
                                     {m->far.scale[0], m->far.scale[1]},
                                     {m->far.shift[0], m->far.shift[1]}};
    for (int tile = 0; tile < OWN_TILES; tile++) {
      const uint32_t bits = next_bits(&seed);
      own.lit[tile] = (uint16_t)(bits % 4 == 0 ? 0 : bits % 4 == 1 ? ALL_BLOCKS : bits >> 16);
      device.marks[3 * SLAB_TILES + tile] = ~own.lit[tile] & EVERY_BLOCK;
    }
    for (int tile = 0; tile < SLAB_TILES; tile++) {
      int which;
      hl_sublights_find_lit(&all, &slab, (size_t)tile);
      assert_int_equal(blocks_reached(&plan, &pass, &maps, device.marks, tile, &which), tile_lit[tile]);
      assert_int_equal(which, tile);
      some += tile_lit[tile] != 0 && tile_lit[tile] != ALL_BLOCKS;
    }
  }
  assert_true(some > ROUNDS);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_halves), cmocka_unit_test(test_composite),
                                     cmocka_unit_test(test_reached)};
  cmocka_set_message_output(CM_OUTPUT_TAP);
  return cmocka_run_group_tests(tests, NULL, NULL);
}
