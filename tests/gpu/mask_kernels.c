/* gpu/mask_kernels.c - the kernels' functions for masks, compiled as C17, give the bytes of the processors'
 * functions (fill/mask_lanes.h, render/voxel_color_lanes.h). */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "render/voxel_color_lanes.h"

static lanes mask_factor_of_lanes(const mask_lattice *lattice, lanes3 points) {
  return mask_factor(lattice, points, 0xffff);
}
static lanes depth_of_lanes(const mask_lattice *lattice, lanes3 points) {
  return depth_behind_walls(lattice, points);
}
static lanes3 mask_slope_of_lanes(const mask_lattice *lattice, lanes3 points) {
  return mask_slope(lattice, points, 0xffff);
}

/* The kernels' names are those of the processors' functions in places. */
#define mask_factor        device_mask_factor
#define mask_slope         device_mask_slope
#define depth_behind_walls device_depth_behind_walls
#define dot3               device_dot3
#define cross3             device_cross3
#define row_of_vector      device_row_of_vector
#define row_of_point       device_row_of_point
#define linear_in_view     device_linear_in_view
#include "gpu/kernels/mask.h"

enum { X = 9, Y = 6, Z = 7, POINTS = X * Y * Z, BRICKS = 3 * 2 * 2, ROUNDS = 4000 };

/* A mask of random numbers with two even bricks. Its parts are in the order that devices use. */
typedef struct made_mask {
  _Alignas(16) uint32_t bricks[BRICKS][2];
  _Alignas(16) uint16_t factors[POINTS + 1];
  _Alignas(16) signed char slopes[POINTS][4];
  _Alignas(16) unsigned char colors[POINTS][4];
} made_mask;

static uint32_t next_bits(uint64_t *state) {
  *state = *state * 6364136223846793005u + 1442695040888963407u;
  return (uint32_t)(*state >> 32);
}

static float number_between(uint64_t *state, float low, float high) {
  return low + (high - low) * ((float)(next_bits(state) >> 8) * 0x1p-24f);
}

/* Sets the points of the brick that begins at x = 0, or at x = 4: the factor is 40000 there, the slope is 0,
 * and the colour is that of `color`. */
static void make_even(made_mask *made, int brick, uint32_t color) {
  made->bricks[brick][0] = 40000 | HL_MASK_EVEN | HL_MASK_EVEN_COLOR;
  made->bricks[brick][1] = color;
  for (int z = 0; z <= HL_MASK_BRICK; z++)
    for (int y = 0; y <= HL_MASK_BRICK; y++)
      for (int x = 0; x <= HL_MASK_BRICK; x++) {
        const int at = (z * Y + y) * X + HL_MASK_BRICK * brick + x;
        made->factors[at] = 40000;
        memset(made->slopes[at], 0, sizeof made->slopes[at]);
        memcpy(made->colors[at], &color, sizeof color);
      }
}

static void make_mask(made_mask *made, uint64_t *seed) {
  memset(made, 0, sizeof *made);
  for (int i = 0; i < POINTS; i++) {
    made->factors[i] = (uint16_t)next_bits(seed);
    const uint32_t color = next_bits(seed) & (i % 3 == 0 ? 0xffffff : 0xffffffff), slope = next_bits(seed);
    memcpy(made->colors[i], &color, sizeof color);
    for (int a = 0; a < 3; a++) made->slopes[i][a] = (signed char)((int)(slope >> 8 * a & 255) - 127);
  }
  make_even(made, 0, 0);
  make_even(made, 1, 0x80402010);
}

static mask_lattice lattice_of(const made_mask *made) {
  return (mask_lattice){.factors = made->factors,
                        .colors = &made->colors[0][0],
                        .slopes = &made->slopes[0][0],
                        .bricks = (const uint32_t(*)[2])made->bricks,
                        .brick_step = {1, 3, 6},
                        .last = {X - 1, Y - 1, Z - 1},
                        .step = {1, X, X * Y},
                        .to_index = {{0.9f, 0.1f, -0.2f, 3}, {0, -0.8f, 0.3f, 2.5f}, {0.2f, 0.1f, 1.1f, 3}},
                        .scale = 1.0f / 65535,
                        .slope_scale = 1.0f / 254,
                        .rest = 0.3f};
}

static void test_masks(void **state) {
  (void)state;
  uint64_t seed = 11;
  static made_mask made;
  float decode[256];
  make_mask(&made, &seed);
  const mask_lattice lattice = lattice_of(&made);
  for (int i = 0; i < 256; i++) decode[i] = (float)(i * i) * (1.0f / (255 * 255));
  const voxel_colors tints = {.voxels = &made.colors[0][0],
                              .decode = decode,
                              .last = {X - 1, Y - 1, Z - 1},
                              .step_bytes = {4, 4 * X, 4 * X * Y}};
  plan_mask plan = {.last = {X - 1, Y - 1, Z - 1},
                    .scale = lattice.scale,
                    .offset = lattice.offset,
                    .slope_scale = lattice.slope_scale,
                    .rest = lattice.rest,
                    .faces = 1,
                    .tints = 1};
  memcpy(plan.to_index, lattice.to_index, sizeof plan.to_index);
  memcpy(plan.decode, decode, sizeof decode);
  plan.begin[MASK_FACTORS] = offsetof(made_mask, factors) / 16;
  plan.begin[MASK_SLOPES] = offsetof(made_mask, slopes) / 16;
  plan.begin[MASK_COLORS] = offsetof(made_mask, colors) / 16;
  const mask_data mask = {&plan, (const byte *)&made};
  int outside = 0, even = 0;
  for (int round = 0; round < ROUNDS; round++) {
    lanes3 points;
    for (int lane = 0; lane < 16; lane++) {
      points.x[lane] = number_between(&seed, -7, 7);
      points.y[lane] = number_between(&seed, -6, 6);
      points.z[lane] = number_between(&seed, -5, 5);
    }
    lanes color[3] = {lanes_set(0.4f), lanes_set(0.25f), lanes_set(0.9f)};
    const lanes factor = mask_factor_of_lanes(&lattice, points), depth = depth_of_lanes(&lattice, points);
    const lanes3 slope = mask_slope_of_lanes(&lattice, points);
    tint_matter(&tints, &lattice, points, 0xffff, color);
    for (int lane = 0; lane < 16; lane++) {
      const vector point = vector_of(points.x[lane], points.y[lane], points.z[lane]);
      const vector own_slope = device_mask_slope(&mask, point),
                   own_color = tinted_by_mask(&mask, point, vector_of(0.4f, 0.25f, 0.9f));
      const float own = device_mask_factor(&mask, point), own_depth = device_depth_behind_walls(&mask, point);
      const float found[8] = {own,         own_slope.x, own_slope.y, own_slope.z,
                              own_color.x, own_color.y, own_color.z, own_depth},
                  wanted[8] = {factor[lane],   slope.x[lane],  slope.y[lane],  slope.z[lane],
                               color[0][lane], color[1][lane], color[2][lane], depth[lane]};
      assert_memory_equal(found, wanted, sizeof found);
      outside += own == lattice.rest;
      even += own == 40000 * (1.0f / 65535);
    }
  }
  assert_true(outside > ROUNDS && even > ROUNDS / 4);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_masks)};
  cmocka_set_message_output(CM_OUTPUT_TAP);
  return cmocka_run_group_tests(tests, NULL, NULL);
}
