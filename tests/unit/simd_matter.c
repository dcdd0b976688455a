/* unit/simd_matter.c - see simd_trials.h: bounds, bits, rows of labels, filling, coverage, ranges of bricks.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/context.h"
#include "label/row_functions.h"
#include "simd_trials.h"

/* ---- bounds of rows ---- */

typedef struct bound_state {
  int storage;
  const void *rows[9];
  int row_count;
  size_t count;
  float out[2][600];
} bound_state;

static void call_bound_rows(const hot_functions *hot, void *state) {
  bound_state *s = state;
  hot->grid->rows[s->storage](s->rows, s->row_count, s->count, s->out[0], s->out[1]);
}

void test_bound_rows(void **unused) {
  (void)unused;
  static float data[9][600];
  uint32_t seed = 3;
  static const char *const names[] = {"bound_rows_u8", "bound_rows_u16", "bound_rows_f32"};
  for (int storage = 0; storage < 3; storage++)
    for (int round = 0; round < ROUNDS; round++) {
      static bound_state state;
      state = (bound_state){.storage = storage,
                            .row_count = 1 + round % 9,
                            .count = round == 0 ? 600 : 1 + (size_t)(599 * bench_random(&seed))};
      fill_salted(&data[0][0], 9 * 600, &seed, -5, 5); /* read as bytes and halves too */
      for (int r = 0; r < 9; r++) state.rows[r] = data[r];
      trial trial = {call_bound_rows, &state, state.out, sizeof state.out};
      try_it(names[storage], &trial, round);
    }
}

typedef struct cells_state {
  hl_storage storage;
  float row[600], padded[606];
  const float *low[CELL_TAPS], *high[CELL_TAPS];
  int count, smooth;
  float out[4][304];
} cells_state;

static void call_bound_cells(const hot_functions *hot, void *state) {
  cells_state *s = state;
  hot->grid->along(s->storage, s->row, s->count, s->smooth, s->padded, s->out[0], s->out[1]);
  hot->grid->across(s->low, s->high, (size_t)s->count / 2, s->smooth, s->out[2], s->out[3]);
}

void test_bound_cells(void **unused) {
  (void)unused;
  static float data[CELL_TAPS][600];
  static cells_state state;
  uint32_t seed = 4;
  for (int round = 0; round < 3 * ROUNDS; round++) {
    state.storage = (hl_storage)(round % 3);
    state.count = round < 3 ? 600 : 1 + (int)(599 * bench_random(&seed));
    state.smooth = round / 3 % 2 == 0;
    fill_salted(state.row, 600, &seed, -5, 5);
    fill_salted(&data[0][0], CELL_TAPS * 600, &seed, -5, 5);
    for (int tap = 0; tap < CELL_TAPS; tap++) state.low[tap] = state.high[tap] = data[tap];
    trial trial = {call_bound_cells, &state, state.out, sizeof state.out};
    try_it("bound_cells", &trial, round);
  }
}

typedef struct bits_state {
  grid grid;
  int32_t brick[3];
  float sign, level;
  uint64_t out;
} bits_state;

static void call_brick_bits(const hot_functions *hot, void *state) {
  bits_state *s = state;
  s->out = hot->grid->brick_bits(&s->grid, s->brick, s->sign, s->level);
}

void test_brick_bits(void **unused) {
  (void)unused;
  static const char *const names[] = {"brick_bits u8", "brick_bits u16", "brick_bits f32"};
  static float voxels[16 * 13 * 17];
  static bits_state state;
  uint32_t seed = 6;
  for (int round = 0; round < 12 * ROUNDS; round++) {
    fill_salted(voxels, 16 * 13 * 17, &seed, -5, 5);
    state.grid = (grid){.voxels = voxels, .storage = (hl_storage)(round % 3), .dimension = {16, 13, 17}};
    if (round % 4 == 3) state.grid.dimension[round / 4 % 3] = 1 + round % 5;
    for (int axis = 0; axis < 3; axis++)
      state.brick[axis] =
          round < 3 ? 1 : (int32_t)(bench_random(&seed) * (state.grid.dimension[axis] / HL_BRICK_CELLS + 1));
    state.sign = round % 2 ? 1 : -1;
    state.level = state.sign * (round % 3 == 0 ? 128.0f : round % 3 == 1 ? 32768.0f : 0.5f);
    trial trial = {call_brick_bits, &state, &state.out, sizeof state.out};
    try_it(names[round % 3], &trial, round / 3);
  }
}

/* ---- rows of labels' occupancies ---- */

typedef struct label_rows_state {
  float rows[HL_FILTER_ROWS][130], taps[HL_FILTER_REACH + 1], level;
  int reach;
  size_t count;
  struct {
    float weighed[130], crossed[130];
    int32_t whole;
  } out;
} label_rows_state;

static void call_label_rows(const label_row_functions *functions, label_rows_state *s) {
  const float *rows[HL_FILTER_ROWS];
  for (int r = 0; r < HL_FILTER_ROWS; r++) rows[r] = s->rows[r];
  const row_neighbours near = {{rows[0], rows[0] + 1, rows[0] + 2}, {rows[1], rows[2]}, {rows[3], rows[4]}};
  functions->weigh(s->taps, s->reach, rows, s->count, s->out.weighed);
  s->out.whole = functions->find_crossed(&near, s->count, s->level, s->out.crossed);
}

/* Rows of labels have a table of functions of their own, beside the renderer's. */
void test_label_rows(void **unused) {
  (void)unused;
  static label_rows_state state, expected;
  uint32_t seed = 8;
  for (int round = 0; round < 3 * ROUNDS; round++) {
    fill_salted(&state.rows[0][0], sizeof state.rows / sizeof(float), &seed, -1, 2);
    fill_salted(state.taps, HL_FILTER_REACH + 1, &seed, -1, 1);
    state.reach = (const int[]){2, 4, HL_FILTER_REACH}[round % 3];
    state.count = 1 + (size_t)(127 * bench_random(&seed));
    state.level = 0.5f;
    expected = state;
    call_label_rows(hl_label_row_functions(HL_INSTRUCTION_SET_SCALAR), &expected);
    for (int set = HL_INSTRUCTION_SET_AVX2; set <= HL_INSTRUCTION_SET_AVX512_VBMI; set++) {
      if (!hl_cpu_has_instruction_set((hl_instruction_set)set)) continue;
      call_label_rows(hl_label_row_functions((hl_instruction_set)set), &state);
      assert_memory_equal(&state.out, &expected.out, sizeof state.out);
    }
  }
}

/* ---- filling ---- */

typedef struct fill_state {
  fill_source source;
  slab_run run;
  int gather, tile_x, tile_y;
  uint32_t need, others;
  struct {
    float density[TILE_PIXELS];
    filled_blocks filled;
    relevant_blocks relevant;
  } out;
} fill_state;

static void call_fill(const hot_functions *hot, void *state) {
  fill_state *s = state;
  fill_tile_function *fill = s->gather ? hot->fill->gather : hot->fill->splat;
  hot->fill->relevant_blocks(&s->run, s->tile_x, s->tile_y, s->need % (1u << RUN_SLABS), s->need,
                             &s->out.relevant);
  s->out.filled = fill(&s->source, s->tile_x, s->tile_y, s->need, s->others, s->out.density);
}

/* In a third of the bricks no cell shows, and in a third all do. */
static void spread_bits(grid *grid, uint32_t *seed) {
  for (size_t brick = 0; brick < hl_grid_bricks(grid); brick++) {
    double kind = bench_random(seed);
    uint64_t random = (uint64_t)(4294967296.0 * bench_random(seed)) << 32 |
                      (uint64_t)(4294967296.0 * bench_random(seed));
    grid->cell_bits[brick] = kind < 0.3 ? 0 : kind < 0.6 ? UINT64_MAX : random;
  }
  grid->cell_bits_tell = true;
}

static void check_fill(const size_t n[3], hl_storage storage, uint32_t seed) {
  static const char *const names[2][3] = {{"splat_tile u8", "splat_tile u16", "splat_tile f32"},
                                          {"gather_tile u8", "gather_tile u16", "gather_tile f32"}};
  static float voxels[2048];
  size_t count = n[0] * n[1] * n[2];
  fill_salted(voxels, count, &seed, -3, 3);
  for (size_t i = 0; i < count; i++) voxels[i] = fabsf(voxels[i]) > 1e30f ? 1 : voxels[i];
  bench bench;
  bench_open(&bench, n, storage, voxels, bench_oblique_axes());
  for (int round = 0; round < ROUNDS; round++) {
    vec3 direction = bench_random_direction(&seed), normal = bench_random_normal(direction, &seed);
    hl_kernel which = (hl_kernel)(round % 3);
    double pixel = round % 9 == 8
                       ? 3
                       : 0.3 + 0.2 * (round / 3 %
                                      5); /* blocks as wide as a window or as two bricks, and wider ones */
    bench_look(&bench, direction, normal, pixel, round % 2 ? 12 : 0, which);
    spread_bits(&bench.grid, &seed);
    for (int gather = 0; gather < 2; gather++) {
      static fill_state state;
      state = (fill_state){.source = bench_source(&bench, which, round % 5),
                           .run = bench_run(&bench, 0.5),
                           .gather = gather,
                           .tile_x = round == 0 ? 1 : round % 3,
                           .tile_y = round == 0 ? 1 : round / 3 % 3,
                           .need = round % 4 ? ALL_BLOCKS : (uint32_t)(65536 * bench_random(&seed))};
      if (round == 0) state.need = ALL_BLOCKS;
      if (round % 2 == 1)
        state.need &= (uint32_t)(65536 * bench_random(&seed)), state.others = ALL_BLOCKS & ~state.need;
      spoil_rays(&state.source.rays, round);
      spoil_rays(&state.run.rays[round / 8 % (RUN_SLABS + 1)], round);
      trial trial = {call_fill, &state, &state.out, sizeof state.out};
      try_it(names[gather][storage], &trial, round);
    }
  }
  bench_close(&bench);
}

void test_fill(void **unused) {
  (void)unused;
  for (int storage = 0; storage < 3; storage++) {
    check_fill((size_t[3]){13, 11, 12}, (hl_storage)storage, 17);
    check_fill((size_t[3]){5, 13, 9}, (hl_storage)storage, 19);
    check_fill((size_t[3]){10, 8, 6}, (hl_storage)storage, 20); /* all slices of a window, or fewer */
    check_fill((size_t[3]){8, 9, 5}, (hl_storage)storage, 21);
    check_fill((size_t[3]){1, 7, 3}, (hl_storage)storage, 18);
  }
}

/* ---- coverage ---- */

typedef struct coverage_state {
  box_rays rays;
  float out[2][TILE_PIXELS];
} coverage_state;

static void call_coverage(const hot_functions *hot, void *state) {
  coverage_state *s = state;
  hot->view->coverage(&s->rays, 1, 2, s->out[0], s->out[1]);
}

void test_coverage(void **unused) {
  (void)unused;
  uint32_t seed = 5;
  for (int round = 0; round < 4 * ROUNDS; round++) {
    static coverage_state state;
    state.rays.least = round % 2 ? 0.0f : -1e30f;
    for (float *at = state.rays.start; at < state.rays.low; at++) *at = salted(&seed, -2, 2);
    for (int a = 0; a < 3; a++) {
      state.rays.low[a] = random_between(&seed, -9, 0);
      state.rays.high[a] = random_between(&seed, 0, 9);
    }
    if (round % 16 == 15) state.rays.start[round % 3] = NAN;
    trial trial = {call_coverage, &state, state.out, sizeof state.out};
    try_it("coverage_tile", &trial, round);
  }
}

/* ---- where bricks lie ---- */

typedef struct ranges_state {
  brick_view view;
  grid grid;
  int32_t place[3][BRICKS_AT_ONCE];
  brick_ranges out;
} ranges_state;

static void call_ranges(const hot_functions *hot, void *state) {
  ranges_state *s = state;
  hot->view->brick_ranges(&s->view, &s->grid, (const int32_t(*)[BRICKS_AT_ONCE])s->place, &s->out);
}

void test_brick_ranges(void **unused) {
  (void)unused;
  uint32_t seed = 21;
  for (int round = 0; round < 4 * ROUNDS; round++) {
    static ranges_state state;
    fill_salted(&state.view.view[0][0], 12, &seed, -2, 2);
    fill_salted(state.view.height, 4, &seed, -2, 2);
    state.view.spare = random_between(&seed, 0, 1);
    for (int i = 0; i < 3; i++) {
      state.view.middle[i] = random_between(&seed, 0, 30);
      state.grid.dimension[i] = 1 + (int32_t)(60 * bench_random(&seed));
      state.view.first[i] = (int32_t)(4 * bench_random(&seed));
      state.view.last[i] = state.view.first[i] + (int32_t)(40 * bench_random(&seed));
      for (int brick = 0; brick < BRICKS_AT_ONCE; brick++)
        state.place[i][brick] = (int32_t)(bench_random(&seed) *
                                          (state.grid.dimension[i] / HL_BRICK_CELLS + 1));
    }
    if (round % 16 == 15) state.view.view[round % 3][0] = NAN;
    trial trial = {call_ranges, &state, &state.out, sizeof state.out};
    try_it("brick_ranges", &trial, round);
  }
}
