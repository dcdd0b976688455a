/* gpu/cascade_kernels.c - the kernels' passes over the fields of soft lights, compiled as C17, give the bytes
 * of the processors' passes (shadow_cascade/cascade_lanes.h). */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "shadow_cascade/cascade_lanes.h"

/* The kernels' names are those of the processors' functions in places. */
#define left_and_a          device_left_and_a
#define a_and_b             device_a_and_b
#define matter_pair         device_matter_pair
#define split_matter        device_split_matter
#define store_fraction      device_store_fraction
#define chunk_transmittance device_chunk_transmittance
#define SOFT                1
#define OUTSIDE             1
#define CHANNELS            1
#define OLDER_PLANE         2
#define PLANES_OF_SHEET     3
#include "gpu/kernels/cascade.h"

enum {
  FINE_TILES = 4,
  TILES = 2,
  SIDE = TILES * TILE,
  FINE_STRIDE = FINE_TILES * TILE + PASS_MARGIN,
  STRIDE = TILES * TILE + PASS_MARGIN,
  COARSE_STRIDE = TILE + PASS_MARGIN,
  ROOM = (FINE_TILES * TILE + 3 * PASS_MARGIN) * FINE_STRIDE, /* enough memory for a field of any level */
  FIELDS = 8,
  ROUNDS = 200
};

/* The processors' and the kernels' fields, with the same content. The memory of field f begins at f ROOM. */
static word16 own[FIELDS * ROOM], other[FIELDS * ROOM];

static unsigned place(int field, int stride) {
  return (unsigned)(field * ROOM + PASS_MARGIN * stride + PASS_MARGIN);
}

static uint32_t next_bits(uint64_t *state) {
  *state = *state * 6364136223846793005u + 1442695040888963407u;
  return (uint32_t)(*state >> 32);
}

static float next_fraction(uint64_t *state) { return (float)(next_bits(state) >> 8) * 0x1p-24f; }

/* Fills the tiles of a field at random. The margins are zeros. Some pixels are 0 or 1. */
static void fill_field(int field, int tiles, int stride, uint64_t *seed) {
  memset(own + field * ROOM, 0, ROOM * sizeof *own);
  for (int y = 0; y < tiles * TILE; y++)
    for (int x = 0; x < tiles * TILE; x++) {
      const uint32_t bits = next_bits(seed);
      own[place(field, stride) + (unsigned)(y * stride + x)] = (word16)(bits % 5 == 0   ? 0
                                                                        : bits % 5 == 1 ? PASS_WHOLE
                                                                                        : bits >> 17);
    }
}

static void copy_fields(void) { memcpy(other, own, sizeof own); }
static void assert_same_fields(void) { assert_memory_equal(own, other, sizeof own); }

static plan_pass a_pass(int kind) {
  return (plan_pass){.kind = kind,
                     .tiles_x = TILES,
                     .tiles_y = TILES,
                     .stride = STRIDE,
                     .a = PASS_NOTHING,
                     .b = PASS_NOTHING,
                     .thin = PASS_NOTHING,
                     .to = place(0, STRIDE)};
}

/* The sums of fields, with and without `a` and `thin`: of one level, of a field and a finer one, and with a
 * coarser `b`. */
static void test_sums(void **state) {
  (void)state;
  uint64_t seed = 11;
  static const int kinds[] = {PASS_ADD, PASS_HALF, PASS_DOUBLE};
  static field_tile_function *const functions[] = {add_tile, add_half_tile, add_double_tile};
  for (int round = 0; round < ROUNDS; round++) {
    const int kind = round % 3, has_a = kind != 2 || next_bits(&seed) >> 31,
              thins = has_a && next_bits(&seed) >> 31;
    const int stride_a = kind == 1 ? FINE_STRIDE : STRIDE, stride_b = kind == 2 ? COARSE_STRIDE : stride_a;
    const int has_b = kind == 2 || next_bits(&seed) >> 31;
    fill_field(1, kind == 1 ? FINE_TILES : TILES, stride_a, &seed);
    fill_field(2, kind == 1 ? FINE_TILES : kind == 2 ? TILES / 2 : TILES, stride_b, &seed);
    fill_field(3, kind == 1 ? FINE_TILES : TILES, stride_a, &seed);
    copy_fields();
    plan_pass pass = a_pass(kinds[kind]);
    pass.stride_in = kind == 2 ? COARSE_STRIDE : FINE_STRIDE;
    if (has_a) pass.a = place(1, stride_a);
    if (has_b) pass.b = place(2, stride_b);
    if (thins) pass.thin = place(3, stride_a);
    const field_job job = {.a = has_a ? own + pass.a : NULL,
                           .b = has_b ? own + pass.b : NULL,
                           .thin = thins ? own + pass.thin : NULL,
                           .to = own + pass.to,
                           .stride_in = (size_t)pass.stride_in,
                           .stride = STRIDE,
                           .rows = ALL_ROWS};
    for (int tile = 0; tile < TILES * TILES; tile++) functions[kind](&job, tile % TILES, tile / TILES);
    for (int i = 0; i < SIDE * SIDE; i++) sum_pixel(&pass, NULL, other, NULL, i);
    assert_same_fields();
  }
}

static void test_blurs(void **state) {
  (void)state;
  uint64_t seed = 13;
  static float rows[SIDE * (SIDE + 2 * PASS_MARGIN)];
  for (int round = 0; round < ROUNDS; round++) {
    blur_box box[2 * TILES];
    plan_blur boxes[2 * TILES];
    const int has_a = next_bits(&seed) >> 31 != 0, thins = has_a && next_bits(&seed) >> 31;
    for (int i = 0; i < 2 * TILES; i++) {
      box[i] = hl_blur_box_of_variance((double)next_fraction(&seed) * (round % 2 ? 800 : 3));
      boxes[i] = (plan_blur){box[i].reach, box[i].edge, box[i].scale};
    }
    for (int field = 1; field < 4; field++) fill_field(field, TILES, STRIDE, &seed);
    copy_fields();
    plan_pass pass = a_pass(PASS_BLUR);
    pass.b = place(2, STRIDE);
    if (has_a) pass.a = place(1, STRIDE);
    if (thins) pass.thin = place(3, STRIDE);
    field_blur_job job = {.from = own + pass.b,
                          .a = has_a ? own + pass.a : NULL,
                          .thin = thins ? own + pass.thin : NULL,
                          .to = own + pass.to,
                          .stride = STRIDE,
                          .rows = ALL_ROWS};
    for (int tile = 0; tile < TILES * TILES; tile++) {
      job.u = box[tile % TILES];
      job.v = box[TILES + tile / TILES];
      field_blur_tile(&job, tile % TILES, tile / TILES);
    }
    for (int i = 0; i < SIDE * (SIDE + 2 * PASS_MARGIN); i++) blur_row(&pass, boxes, other, rows, i);
    for (int i = 0; i < SIDE * SIDE; i++) sum_pixel(&pass, boxes, other, rows, i);
    assert_same_fields();
  }
}

/* The two fields of a group. The thin field is at most the other one. */
static void fill_matter(int absorbed, int thin, uint64_t *seed) {
  fill_field(absorbed, TILES, STRIDE, seed);
  fill_field(thin, TILES, STRIDE, seed);
  for (int i = 0; i < ROOM; i++)
    if (own[thin * ROOM + i] > own[absorbed * ROOM + i]) own[thin * ROOM + i] = own[absorbed * ROOM + i];
}

static void test_split(void **state) {
  (void)state;
  uint64_t seed = 17;
  for (int round = 0; round < ROUNDS; round++) {
    fill_matter(1, 2, &seed);
    copy_fields();
    plan_pass pass = a_pass(PASS_SPLIT);
    /* the first of the parts replaces the field, and the others are added */
    pass.a = pass.to = place(1, STRIDE);
    pass.thin = pass.to_thin = place(2, STRIDE);
    pass.second = place(3, STRIDE);
    pass.second_thin = place(4, STRIDE);
    pass.late = next_fraction(&seed);
    const split_job job = {own + pass.a,
                           own + pass.thin,
                           {own + pass.to, own + pass.second},
                           {own + pass.to_thin, own + pass.second_thin},
                           STRIDE,
                           pass.late};
    for (int tile = 0; tile < TILES * TILES; tile++) (void)split_tile(&job, tile % TILES, tile / TILES);
    for (int i = 0; i < SIDE * SIDE; i++) split_pixel(&pass, other, i);
    assert_same_fields();
  }
}

/* A light's buffer, as the processors keep it and as a device keeps it. */
static struct {
  float at_start[STRIDE * SIDE], moment[STRIDE * SIDE],
      plane[3][STRIDE * SIDE]; /* the planes T, Y and older; their rows are STRIDE apart */
  float soft[TILES * TILES * 512], light[TILES * TILES * 3 * 256], planes[3][STRIDE * SIDE];
  int touched[TILES * TILES], changed[TILES * TILES * 256];
  byte marks[TILES * TILES];
} kept;

static const device_sweep plan = {
    .ring = 1,
    .lights = {{.tiles_x = TILES, .tiles = TILES * TILES, .stride = STRIDE, .plane = STRIDE * SIDE}}};

static void fill_buffer(const plan_pass *pass, uint64_t *seed) {
  for (int i = 0; i < SIDE * SIDE; i++) {
    const light_place at = place_of_member(&plan, pass, i);
    const uint32_t bits = next_bits(seed);
    float before = bits % 4 == 0 ? 1.0f : bits % 4 == 1 ? next_fraction(seed) * 0x1p-9f : next_fraction(seed);
    float start = 1.0f - before, now = (1.0f - start) * (bits % 8 < 4 ? 1.0f : next_fraction(seed));
    const float numbers[] = {now, now + (1.0f - now) * next_fraction(seed), next_fraction(seed)};
    kept.at_start[at.at] = kept.soft[at.tile * 512 + 256 + at.member] = start;
    kept.moment[at.at] = kept.soft[at.tile * 512 + at.member] = (1.0f - start - now) * next_fraction(seed) *
                                                                2;
    for (int p = 0; p < 3; p++) {
      kept.plane[p][at.at] = kept.light[(at.tile * 3 + p) * 256 + at.member] = numbers[p];
      kept.planes[p][at.at] = 2; /* read by nobody */
    }
  }
}

/* The light that a chunk's slabs absorbed goes to two groups. In every second round most rows absorbed
 * nothing. */
static void test_absorbed(void **state) {
  (void)state;
  uint64_t seed = 19;
  for (int round = 0; round < ROUNDS; round++) {
    plan_pass pass = a_pass(PASS_ABSORB);
    pass.to_thin = place(1, STRIDE);
    pass.second = place(2, STRIDE);
    pass.second_thin = place(3, STRIDE);
    pass.length = 0.1f + 2 * next_fraction(&seed);
    fill_matter(0, 1, &seed);
    fill_matter(2, 3, &seed);
    fill_buffer(&pass, &seed);
    copy_fields();
    const absorbed_job job = {.absorbed_at_start = kept.at_start,
                              .now = kept.plane[0],
                              .moment = kept.moment,
                              .length = pass.length,
                              .start_absorbed = own + pass.to,
                              .start_thin = own + pass.to_thin,
                              .end_absorbed = own + pass.second,
                              .end_thin = own + pass.second_thin,
                              .stride = STRIDE,
                              .stride_now = STRIDE};
    for (int row = 0; row < SIDE; row++)
      for (int x = 0; x < SIDE && round % 2 && next_bits(&seed) % 3; x++) {
        const light_place at = place_of_member(
            &plan, &pass, (x / TILE + row / TILE * TILES) * 256 + row % TILE * TILE + x % TILE);
        kept.plane[0][at.at] = kept.light[at.tile * 3 * 256 + at.member] = 1.0f - kept.at_start[at.at];
      }
    for (int tile = 0; tile < TILES * TILES; tile++) (void)absorbed_tile(&job, tile % TILES, tile / TILES);
    for (int row = 0; row < SIDE * TILES; row++) {
      float before[TILE], taken[TILE];
      int any = 0;
      for (int x = 0; x < TILE; x++) {
        const light_place at = place_of_member(&plan, &pass, row * TILE + x);
        before[x] = 1.0f - kept.soft[at.tile * 512 + 256 + at.member];
        taken[x] = greater(before[x] - greater(kept.light[at.tile * 3 * 256 + at.member], 0.0f), 0.0f);
        any = any || taken[x] > 0.0f;
      }
      for (int x = 0; x < TILE; x++) {
        const light_place at = place_of_member(&plan, &pass, row * TILE + x);
        absorb_pixel(&pass, other, at.at, before[x], taken[x], &kept.soft[at.tile * 512 + at.member], any);
        assert_memory_equal(&kept.soft[at.tile * 512 + at.member], &kept.moment[at.at], sizeof(float));
      }
    }
    assert_same_fields();
  }
}

static void test_refill(void **state) {
  (void)state;
  uint64_t seed = 23;
  for (int round = 0; round < ROUNDS; round++) {
    plan_pass pass = a_pass(PASS_REFILL);
    pass.a = place(0, STRIDE);
    pass.chunk = 3;
    pass.sheet = 7;
    fill_field(0, TILES, STRIDE, &seed);
    fill_buffer(&pass, &seed);
    copy_fields();
    for (int tile = 0; tile < TILES * TILES; tile++) {
      const uint32_t bits = next_bits(&seed);
      kept.touched[tile] = bits & 1 ? 3 : 2;
      kept.marks[tile] = (byte)(bits >> 1 & (MARK_READ | MARK_AGAIN));
      const refill_job job = {.absorbed = own + pass.a,
                              .absorbed_at_start = kept.at_start,
                              .to = kept.plane[0],
                              .older = kept.plane[2],
                              .outside = kept.plane[1],
                              .stride = STRIDE,
                              .stride_to = STRIDE,
                              .kept = bits & 1,
                              .again = (kept.marks[tile] & MARK_AGAIN) != 0};
      if (kept.marks[tile] & MARK_READ) refill_tile(&job, tile % TILES, tile / TILES);
    }
    for (int i = 0; i < SIDE * SIDE; i++)
      refill_pixel(&plan, &pass, kept.marks, other, &kept.planes[0][0], kept.light, kept.soft, kept.touched,
                   kept.changed, i);
    for (int i = 0; i < SIDE * SIDE; i++) {
      const light_place at = place_of_member(&plan, &pass, i);
      const int read = (kept.marks[at.tile] & MARK_READ) != 0;
      const float unread = 2;
      assert_memory_equal(&kept.soft[at.tile * 512 + 256 + at.member], &kept.at_start[at.at], sizeof(float));
      for (int p = 0; p < 3; p++) {
        assert_memory_equal(&kept.light[(at.tile * 3 + p) * 256 + at.member], &kept.plane[p][at.at],
                            sizeof(float));
        assert_memory_equal(&kept.planes[p][at.at], read ? &kept.plane[p][at.at] : &unread, sizeof(float));
      }
    }
    assert_same_fields();
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_sums), cmocka_unit_test(test_blurs),
                                     cmocka_unit_test(test_split), cmocka_unit_test(test_absorbed),
                                     cmocka_unit_test(test_refill)};
  (void)blur_rows_tile, (void)blur_columns_tile, (void)double_tile, (void)emission_tile,
      (void)field_emission_tile;
  cmocka_set_message_output(CM_OUTPUT_TAP);
  return cmocka_run_group_tests(tests, NULL, NULL);
}
