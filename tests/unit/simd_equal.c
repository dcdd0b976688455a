/* unit/simd_equal.c - every hot function on every instruction set that the machine has: the scalar table's
 * bits.
 *
 *     simd_equal [--time]
 *
 * Inputs are random, salted with zeros, ones, huge, tiny and non-finite numbers. --time prints nanoseconds of
 * processor time a call, the least of some runs. */
#define _GNU_SOURCE
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

#include "core/context.h"
#include "label/row_functions.h"
#include "plan/shown_values.h"
#include "render/surface_samples.h"
#include "shadow_cascade/cascade_field.h"
#include "shadow_sublights/sublight_field.h"
#include "sheet_bench.h"

enum {
  ROUNDS = 40,
  SETS = 4, /* x86's, or Arm's one */
  TIMED = 100,
  TIMED_RUNS = 5,
  FIELD = 256 /* floats a row and rows, margins included */
};

typedef struct contender {
  const hot_functions *hot;
  const char *name;
} contender;

/* The instruction sets to hold against the scalar one. */
static int contenders(contender list[SETS]) {
  int count = 0;
  for (int set = HL_INSTRUCTION_SET_AVX2; set <= HL_INSTRUCTION_SET_AVX512_VBMI; set++)
    if (hl_cpu_has_instruction_set((hl_instruction_set)set))
      list[count++] = (contender){hl_hot_functions((hl_instruction_set)set),
                                  hl_instruction_set_name((hl_instruction_set)set)};
  return count;
}

static bool timing;

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return (double)t.tv_sec * 1e9 + (double)t.tv_nsec;
}

/* ---- inputs ---- */

static float random_between(uint32_t *seed, double low, double high) {
  return (float)(low + (high - low) * bench_random(seed));
}

/* One number in eight is an edge case. */
static float salted(uint32_t *seed, double low, double high) {
  static const float edges[] = {0, -0.0f, 1, -1, 1e-30f, 3e38f, 1e-42f, 0.5f};
  if (bench_random(seed) < 0.125) return edges[(int)(8 * bench_random(seed))];
  return random_between(seed, low, high);
}

static void fill_salted(float *values, size_t count, uint32_t *seed, double low, double high) {
  for (size_t i = 0; i < count; i++) values[i] = salted(seed, low, high);
}

/* ---- running one function by its name ---- */

/* A call with all that it reads and writes: outputs are compared byte by byte. */
typedef struct trial {
  void (*call)(const hot_functions *hot, void *state);
  void *state;
  void *output;
  size_t size;
} trial;

static void compare(const char *function, const trial *trial) {
  contender list[SETS];
  int count = contenders(list);
  unsigned char *before = malloc(trial->size), *expected = malloc(trial->size);
  assert_true(before != NULL && expected != NULL);
  memcpy(before, trial->output, trial->size);
  trial->call(&hl_hot_scalar, trial->state);
  memcpy(expected, trial->output, trial->size);
  for (int i = 0; i < count; i++) {
    memcpy(trial->output, before, trial->size);
    trial->call(list[i].hot, trial->state);
    if (memcmp(expected, trial->output, trial->size) != 0)
      fail_msg("%s: %s differs from scalar", function, list[i].name);
  }
  free(before);
  free(expected);
}

static void time_one(const char *function, const trial *trial, const hot_functions *hot, const char *name) {
  double least = HUGE_VAL;
  for (int run = 0; run < TIMED_RUNS; run++) {
    double start = now();
    for (int i = 0; i < TIMED; i++) trial->call(hot, trial->state);
    least = fmin(least, (now() - start) / TIMED);
  }
  print_message("# %-24s %-8s %9.0f ns\n", function, name, least);
}

static void try_it(const char *function, const trial *trial, int round) {
  compare(function, trial);
  if (!timing || round != 0) return;
  contender list[SETS];
  int count = contenders(list);
  time_one(function, trial, &hl_hot_scalar, "scalar");
  for (int i = 0; i < count; i++) time_one(function, trial, list[i].hot, list[i].name);
}

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

static void test_bound_rows(void **unused) {
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

static void test_bound_cells(void **unused) {
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

static void test_brick_bits(void **unused) {
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

/* The table is no part of the renderer's. */
static void test_label_rows(void **unused) {
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

/* Rays that run along the sheets, or nowhere: positions become huge or NaN. */
static void spoil_rays(sheet_rays *rays, int round) {
  if (round % 8 == 5) rays->h0 = rays->hu = rays->hv = 0;
  if (round % 8 == 6) rays->w0[round % 3] = NAN;
  if (round % 8 == 7) rays->wu[round % 3] = 3e37f;
}

/* Of a third of the bricks no cell shows, of a third all do. */
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
                                      5); /* blocks as wide as a window or as two bricks, and wider */
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

static void test_fill(void **unused) {
  (void)unused;
  for (int storage = 0; storage < 3; storage++) {
    check_fill((size_t[3]){13, 11, 12}, (hl_storage)storage, 17);
    check_fill((size_t[3]){5, 13, 9}, (hl_storage)storage, 19);
    check_fill((size_t[3]){10, 8, 6}, (hl_storage)storage, 20); /* a window's slices, or fewer */
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

static void test_coverage(void **unused) {
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

static void test_brick_ranges(void **unused) {
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

/* ---- light ---- */

/* A classifier of one ramp, from a bench. */
static bench classifier_bench;
/* The same with gradient opacity. */
static classifier steep_classifier;
/* The same with functions of two numbers: of the gradient, and of another volume. */
static classifier plane_classifiers[2];
/* The same with a mask. */
static classifier masked_classifier;
static const classifier *classifier_of(int number) {
  if (number % 6 == 5) return &masked_classifier;
  if (number % 6 > 2) return &plane_classifiers[number % 6 - 3];
  return number % 6 == 2 ? &steep_classifier : &classifier_bench.classifier;
}

/* Grids whose gradients are taken: of each type of voxel, and a thin one. */
enum { GRADIENT_GRIDS = 4 };
static bench gradient_bench[GRADIENT_GRIDS];

/* Voxels with colours of their own, within the grids' boxes. */
static unsigned char color_voxels[8 * 9 * 10 * 4];
static float decode_bench[256];
static const voxel_colors colors_bench = {color_voxels, {7, 8, 9}, {4, 32, 288}, decode_bench};

static void set_up_colors(void) {
  uint32_t seed = 12;
  for (size_t n = 0; n < sizeof color_voxels; n++)
    color_voxels[n] = (unsigned char)(n % 4 == 3 ? 1 + 254 * bench_random(&seed) : 255 * bench_random(&seed));
  for (int code = 0; code < 256; code++) decode_bench[code] = (float)(code * code) / 65025;
}

static void open_gradient_grids(void) {
  static float voxels[9 * 10 * 11];
  uint32_t seed = 7;
  for (size_t i = 0; i < 9 * 10 * 11; i++)
    voxels[i] = random_between(&seed, 0, 1); /* read as bytes and halves too */
  set_up_colors();
  for (int i = 0; i < GRADIENT_GRIDS; i++)
    bench_open(&gradient_bench[i], (size_t[3]){9, 10, i == 3 ? 3 : 11},
               i == 3 ? HL_STORAGE_F32 : (hl_storage)i, voxels,
               mat3_from_columns((vec3){1, 0, 0}, (vec3){0, 1, 0}, (vec3){0, 0, 1}));
}

static void open_planes(void) {
  enum { COUNT = (PLANE_ROWS + 1) * PLANE_STRIDE };
  static float sums[COUNT][4], color[COUNT][4];
  uint32_t seed = 9;
  for (size_t i = 0; i < COUNT; i++) {
    float before = i > 0 ? 1 : 0;
    sums[i][0] = random_between(&seed, 0, 2);
    sums[i][1] = before * sums[i > 0 ? i - 1 : 0][1] + sums[i][0];
    sums[i][2] = random_between(&seed, 0, 2);
    sums[i][3] = random_between(&seed, 0, 2);
    for (int c = 0; c < 4; c++)
      color[i][c] = before * color[i > 0 ? i - 1 : 0][c] + random_between(&seed, 0, c == 3 ? 1.0f : 0.7f);
  }
  for (int k = 0; k < 2; k++) {
    plane_table *plane = &plane_classifiers[k].plane;
    plane_classifiers[k] = classifier_bench.classifier;
    *plane = (plane_table){.sums = sums,
                           .color = color,
                           .column_scale = (float)PLANE_COLUMNS / CLASSIFIER_ENTRIES,
                           .column_offset = 1,
                           .row_scale = 60,
                           .row_offset = 2,
                           .even_before = PLANE_COLUMNS / 3,
                           .axis = k == 0 ? HL_SECOND_GRADIENT : HL_SECOND_VOLUME};
    if (k == 1) hl_plane_table_set_second(plane, NULL, &gradient_bench[1].grid);
  }
}

/* A mask of 8 x 9 x 10 points; a third of its bricks is even, a third of one colour. */
static void open_mask(void) {
  static uint16_t factors[8 * 9 * 10 + 1];
  static signed char slopes[8 * 9 * 10 * 4];
  static uint32_t bricks[2 * 3 * 3][2];
  static const float to_index[3][4] = {{0.9f, 0.1f, 0, 4}, {-0.1f, 0.8f, 0.2f, 5}, {0, -0.2f, 1.1f, 6}};
  uint32_t seed = 15;
  for (int i = 0; i < 8 * 9 * 10; i++) factors[i] = (uint16_t)(65535 * bench_random(&seed));
  for (int i = 0; i < 8 * 9 * 10 * 4; i++) slopes[i] = (signed char)(254 * bench_random(&seed) - 127);
  for (int b = 0; b < 2 * 3 * 3; b++) {
    bricks[b][0] = (uint32_t)(b % 2 ? 65535 : 65535 * bench_random(&seed));
    if (bench_random(&seed) < 0.33) bricks[b][0] |= HL_MASK_EVEN;
    if (bench_random(&seed) < 0.33) bricks[b][0] |= HL_MASK_EVEN_COLOR;
    bricks[b][1] = (uint32_t)(b % 3 ? 4294967295.0 * bench_random(&seed) : 0);
  }
  masked_classifier = classifier_bench.classifier;
  masked_classifier.mask = (mask_lattice){.factors = factors,
                                          .colors = color_voxels,
                                          .slopes = slopes,
                                          .bricks = (const uint32_t(*)[2])bricks,
                                          .brick_step = {1, 2, 6},
                                          .last = {7, 8, 9},
                                          .step = {1, 8, 72},
                                          .rest = 0.5f};
  memcpy(masked_classifier.mask.to_index, to_index, sizeof to_index);
}

static int open_classifier(void **unused) {
  (void)unused;
  open_gradient_grids();
  static const hl_opacity_point ramp[] = {{0, 0}, {0.3, 0}, {0.5, 0.8}, {1, 0.99}};
  static const float voxels[] = {0, 1, 0.2f, 0.7f, 0.4f, 0.9f, 0.1f, 0.6f};
  bench_open(&classifier_bench, (size_t[3]){2, 2, 2}, HL_STORAGE_F32, voxels,
             mat3_from_columns((vec3){1, 0, 0}, (vec3){0, 1, 0}, (vec3){0, 0, 1}));
  bench_show(&classifier_bench, ramp, 4);
  static float steepness[STEEPNESS_ENTRIES + 2];
  uint32_t seed = 7;
  fill_salted(steepness, STEEPNESS_ENTRIES + 2, &seed, 0, 1);
  steep_classifier = classifier_bench.classifier;
  steep_classifier.steepness = steepness;
  steep_classifier.steepness_scale = 900;
  open_planes();
  open_mask();
  return 0;
}

static int close_classifier(void **unused) {
  (void)unused;
  for (int i = 0; i < GRADIENT_GRIDS; i++) bench_close(&gradient_bench[i]);
  bench_close(&classifier_bench);
  return 0;
}

static sheet_rays random_rays(uint32_t *seed, int round) {
  sheet_rays rays = {.perspective = round % 2};
  for (float *at = rays.base; at <= &rays.step; at++) *at = random_between(seed, -2, 2);
  spoil_rays(&rays, round);
  return rays;
}

typedef struct attenuate_state {
  attenuate_job job;
  attenuate_volume volumes[2];
  float density[2][4][TILE_PIXELS];
  struct {
    float field[3 * HL_CHANNELS][TILE][TILE];
    attenuated_blocks blocks;
    uint32_t lit;
  } out;
} attenuate_state;

static void call_attenuate(const hot_functions *hot, void *state) {
  attenuate_state *s = state;
  s->out.blocks = hot->shadow->attenuate(&s->job, 1, 1);
}

static void call_lit_blocks(const hot_functions *hot, void *state) {
  attenuate_state *s = state;
  s->out.lit = hot->shadow->lit_blocks((const float *const *)s->job.transmittance, s->job.channels, TILE);
}

static void set_up_attenuate(attenuate_state *s, uint32_t *seed, int round) {
  memset(s, 0, sizeof *s);
  s->job = (attenuate_job){.rays = random_rays(seed, round),
                           .path = 1,
                           .height = 1,
                           .spacing = 0.5f,
                           .volumes = s->volumes,
                           .volume_count = 1 + round % 2,
                           .channels = round % 3 ? 3 : 1,
                           .stride = TILE,
                           .moment_stride = TILE,
                           .position = 0.7f};
  for (int c = 0; c < HL_CHANNELS; c++) {
    s->job.transmittance[c] = &s->out.field[c][0][0];
    s->job.moment[c] = round % 4 ? &s->out.field[HL_CHANNELS + c][0][0] : NULL;
    s->job.outside[c] = round % 5 ? &s->out.field[2 * HL_CHANNELS + c][0][0] : NULL;
  }
  for (int v = 0; v < 2; v++) {
    fill_salted(s->density[v][0], 2 * TILE_PIXELS, seed, -0.1, 1.1);
    fill_salted(s->density[v][2], 2 * TILE_PIXELS, seed, 0, 2);
    if (round % 8 == 3) s->density[v][0][v] = NAN;
    static const float to_index[3][4] = {{0.4f, 0.1f, 0, 3}, {0, 0.3f, 0.1f, 2}, {0.1f, 0, 0.5f, 4}};
    s->volumes[v] = (attenuate_volume){
        .classifier = classifier_of(round + v),
        .density = s->density[v][0],
        .before = s->density[v][1],
        .enter = v == round % 3 ? s->density[v][2] : NULL,
        .leave = v == round % 3 ? s->density[v][3] : NULL,
        .blocks = round == 0 ? ALL_BLOCKS : (uint32_t)(65536 * bench_random(seed)),
        .surface = (round + v) % 3 != 0,
        .voxel = 0.9f,
        .weight = {0, 0.5f, 1},
        .uncut = round % 5 == 4,
        .grid = &gradient_bench[(round + v) % GRADIENT_GRIDS].grid,
        .kernel = hl_kernel_get((hl_kernel)(round % 3)),
        .to_index = to_index};
  }
  for (int c = 0; c < 3 * HL_CHANNELS; c++) {
    fill_salted(&s->out.field[c][0][0], TILE_PIXELS, seed, 0, 1);
    for (int i = 0; i < TILE_PIXELS && round % 2; i++) (&s->out.field[c][0][0])[i] *= 1e-3f; /* around dark */
  }
}

static void test_light(void **unused) {
  (void)unused;
  static attenuate_state state;
  uint32_t seed = 11;
  for (int round = 0; round < 2 * ROUNDS; round++) {
    set_up_attenuate(&state, &seed, round);
    trial attenuate = {call_attenuate, &state, &state.out, sizeof state.out};
    trial lit = {call_lit_blocks, &state, &state.out, sizeof state.out};
    try_it("attenuate_tile", &attenuate, round);
    try_it("lit_blocks_tile", &lit, round);
  }
}

/* ---- fields: blurs and the cascade's products ---- */

typedef struct field_state {
  int which;
  blur_job blur;
  field_job field;
  absorbed_job absorbed;
  split_job part;
  sublight_job sublight, dark; /* few of the other's pixels are light */
  half_pixel_job half_pixel;
  slab_rows rows[16];
  uint16_t lit[4];
  field_blur_job field_blur;
  refill_job left;
  emission_job image;
  field_emission_job field_image;
  ptrdiff_t offset[40];
  float a[FIELD][FIELD], b[FIELD][FIELD];
  field_pixel lacking[FIELD][FIELD], thin[FIELD][FIELD]; /* whole numbers of a and b */
  sublight_pixel shade[FIELD][FIELD];
  struct {
    float pixels[FIELD][FIELD];
    field_pixel lacking[FIELD][FIELD];
    sublight_pixel outside[FIELD][FIELD];
    int lit;
    unsigned char touched[4];
  } out;
} field_state;

static void call_field(const hot_functions *hot, void *state) {
  field_state *s = state;
  if (s->which == 0) hot->shadow->blur.rows(&s->blur, 1, 1);
  if (s->which == 1) hot->shadow->blur.columns(&s->blur, 1, 1);
  if (s->which == 2) s->out.lit = hot->shadow->cascade->add(&s->field, 1, 1);
  if (s->which == 3) s->out.lit = hot->shadow->cascade->add_half(&s->field, 1, 1);
  if (s->which == 4) s->out.lit = hot->shadow->cascade->add_double(&s->field, 1, 1);
  if (s->which == 5) s->out.lit = hot->shadow->cascade->blur_add(&s->field_blur, 1, 1);
  if (s->which == 6) hot->shadow->cascade->refill(&s->left, 1, 1);
  if (s->which == 7) s->out.lit = (int)hot->shadow->cascade->absorbed(&s->absorbed, 1, 1);
  if (s->which == 8) s->out.lit = hot->shadow->sublights->composite(&s->sublight, 1, 1);
  if (s->which == 13) {
    slab_rows rows = hot->shadow->sublights->half_pixel(&s->half_pixel, 1, 1);
    s->out.lit = (int)(rows ^ rows >> 32);
  }
  if (s->which == 14) hot->shadow->sublights->composite_row(&s->sublight, 1, 0, 3, s->lit, s->out.touched);
  if (s->which == 15) s->out.lit = (int)hot->shadow->sublights->lit(&s->dark, 1, 1, s->lit[1]);
  if (s->which == 9) s->out.lit = hot->shadow->cascade->double_tile(&s->field, 1, 1);
  if (s->which == 10) hot->shadow->blur.emission(&s->image, 1, 1);
  if (s->which == 12) s->out.lit = (int)hot->shadow->cascade->split(&s->part, 1, 1);
  if (s->which == 11) s->out.lit = hot->shadow->cascade->emission_add(&s->field_image, 1, 1);
}

/* Marks of surfaces in the dark (shadow/attenuate.h) in every seventh pixel; where the chunk began with no
 * light, `absorbed_at_start` is 1 at every other of them. */
static void mark_dark(float *pixels, float *absorbed_at_start, uint32_t *seed) {
  for (int i = 0; i < FIELD * TILE; i += 7) {
    pixels[i] = -DARK_MARK * random_between(seed, 0, 1);
    if (i % 2) absorbed_at_start[i] = 1;
  }
}

/* Surfaces that take all light, in pieces of forty pixels. */
static void mark_opaque(float *pixels) {
  for (int i = 0; i < FIELD * TILE; i++)
    if (i / 40 % 2) pixels[i] = -LEAST_MARK;
}

static void test_fields(void **unused) {
  (void)unused;
  static const char *const names[] = {
      "blur_rows_tile",  "blur_columns_tile", "add_tile",      "add_half_tile",
      "add_double_tile", "field_blur_tile",   "refill_tile",   "absorbed_tile",
      "sublight_tile",   "double_tile",       "emission_tile", "field_emission_tile",
      "split_tile",      "half_pixel_tile",   "sublight_row",  "sublight_lit"};
  static field_state s;
  uint32_t seed = 23;
  enum { MARGIN = 100 };
  for (int round = 0; round < ROUNDS; round++) {
    fill_salted(&s.a[0][0], FIELD * FIELD, &seed, 0, 1);
    fill_salted(&s.b[0][0], FIELD * FIELD, &seed, 0, 1);
    for (int i = 0; i < FIELD * FIELD; i++) {
      (&s.lacking[0][0])[i] = (field_pixel)((&s.a[0][0])[i] * (round % 4 ? FIELD_ONE : 65535));
      (&s.thin[0][0])[i] = (field_pixel)((&s.b[0][0])[i] * FIELD_ONE);
    }
    field_pixel *lacking = &s.lacking[MARGIN][MARGIN], *thin = &s.thin[MARGIN][MARGIN],
                *out = &s.out.lacking[MARGIN][MARGIN];
    s.blur = (blur_job){&s.a[MARGIN][MARGIN], &s.out.pixels[MARGIN][MARGIN], FIELD, FIELD,
                        hl_blur_box(random_between(&seed, 1, round % 5 ? 30 : 150))};
    s.field = (field_job){lacking, thin, out, FIELD, FIELD, round % 2 ? thin + 3 * FIELD : NULL, ALL_ROWS};
    /* what both read and write: the light in pixels, what was lacked and the older light in rows below */
    s.left = (refill_job){.absorbed = lacking,
                          .absorbed_at_start = &s.out.pixels[MARGIN + 2 * TILE][MARGIN],
                          .to = &s.out.pixels[MARGIN][MARGIN],
                          .older = &s.out.pixels[MARGIN + 4 * TILE][MARGIN],
                          .outside = round % 3 ? &s.out.pixels[MARGIN + 4 * TILE][MARGIN + 2 * TILE] : NULL,
                          .stride = FIELD,
                          .stride_to = FIELD,
                          .kept = round & 1,
                          .again = round >> 1 & 1};
    s.absorbed = (absorbed_job){&s.a[MARGIN][MARGIN],
                                &s.b[MARGIN][MARGIN],
                                &s.out.pixels[MARGIN][MARGIN],
                                0.8f,
                                round % 3 ? lacking : NULL,
                                out + 16 * FIELD,
                                out + 32 * FIELD,
                                out + 48 * FIELD,
                                out + 64 * FIELD,
                                FIELD,
                                FIELD,
                                round % (GREATEST_EDGE + 1)};
    s.part = (split_job){lacking,
                         thin,
                         {out, out + 16 * FIELD},
                         {out + 32 * FIELD, out + 48 * FIELD},
                         FIELD,
                         random_between(&seed, 0, 1)};
    s.field_blur = (field_blur_job){lacking,
                                    round % 3 ? thin : NULL,
                                    round % 2 ? thin + 3 * FIELD : NULL,
                                    out,
                                    FIELD,
                                    hl_blur_box(random_between(&seed, 1, 90)),
                                    hl_blur_box(random_between(&seed, 1, 2 * BLUR_GREATEST_REACH)),
                                    ALL_ROWS};
    s.sublight = (sublight_job){.slab_stride = FIELD,
                                .slab_width = 60,
                                .slab_height = 50,
                                .stride = FIELD,
                                .rows = s.rows,
                                .slab_tiles_x = 4,
                                .slab_tiles_y = 4,
                                .tiles_x = 4,
                                .carry = random_between(&seed, 0.01f, 0.99f),
                                .channels = 1 + 2 * (round % 2)};
    for (int axis = 0; axis < 2; axis++) {
      s.sublight.scale[axis] = round % 3 == 0 ? 1
                                              : random_between(&seed, round % 3 == 1 ? 0.8f : 0.3f,
                                                               round % 3 == 1 ? 1.25f : 3);
      s.sublight.shift[axis] = random_between(&seed, -20, 20);
      s.sublight.half[axis] = (int)(2 * s.sublight.shift[axis]);
    }
    for (int c = 0; c < HL_CHANNELS; c++) {
      for (int i = 0; i < SLAB_COPIES; i++) s.sublight.slab[c][i] = &s.a[MARGIN + c][MARGIN + 5 * i];
      s.sublight.transmittance[c] = out;
      if (round % 4 == 3) continue;
      for (int i = 0; i < SLAB_COPIES; i++)
        s.sublight.slab_outside[c][i] = &s.a[MARGIN + c + 3][MARGIN + 5 * i + 1];
      s.sublight.outside[c] = &s.out.outside[MARGIN][MARGIN];
    }
    s.dark = s.sublight;
    for (int c = 0; c < HL_CHANNELS; c++) s.dark.transmittance[c] = &s.shade[0][0], s.dark.outside[c] = NULL;
    for (int i = 0; i < FIELD * FIELD; i++)
      (&s.shade[0][0])[i] = random_between(&seed, 0, 1) < 0.95f
                                ? 0
                                : (sublight_pixel)random_between(&seed, 60, 68);
    for (int i = 0; i < 16; i++) s.rows[i] = (uint64_t)random_between(&seed, 0, 65535) * 0x1000100010001u;
    for (int i = 0; i < 4; i++)
      s.lit[i] = random_between(&seed, 0, 1) < 0.3f ? 0 : (uint16_t)random_between(&seed, 1, 65535);
    s.half_pixel = (half_pixel_job){.slab = &s.a[MARGIN][MARGIN], .slab_stride = FIELD};
    for (int i = 1; i < SLAB_COPIES; i++) s.half_pixel.moved[i] = &s.out.pixels[MARGIN + 16 * i][MARGIN];
    s.image = (emission_job){.from = &s.a[MARGIN][MARGIN],
                             .to = &s.out.pixels[MARGIN][MARGIN],
                             .stride = FIELD,
                             .count = 1 + round % 40,
                             .offset = s.offset,
                             .weight = &s.b[MARGIN + 30][MARGIN]};
    s.field_image = (field_emission_job){.from = lacking,
                                         .thin = thin,
                                         .to = out,
                                         .stride = FIELD,
                                         .count = 1 + round % 40,
                                         .offset = s.offset,
                                         .weight = &s.b[MARGIN + 30][MARGIN]};
    for (int i = 0; i < 40; i++)
      s.offset[i] = (ptrdiff_t)random_between(&seed, -20, 20) * FIELD +
                    (ptrdiff_t)random_between(&seed, -20, 20);
    for (s.which = 0; s.which < 16; s.which++) {
      if (s.which == 6) mark_dark(s.left.to, s.left.absorbed_at_start, &seed);
      if (s.which == 7) {
        mark_dark(&s.b[MARGIN][MARGIN], &s.a[MARGIN][MARGIN], &seed);
        mark_opaque(&s.b[MARGIN][MARGIN]);
      }
      trial trial = {call_field, &s, &s.out, sizeof s.out};
      try_it(names[s.which], &trial, round);
    }
  }
}

/* ---- shading ---- */

typedef struct shade_state {
  shade_job job;
  shade_volume volumes[2];
  shade_patch patches[2];
  int patch_count, covers;
  shade_light lights[3];
  shadow_lookup lookups[3];
  sublight_lookup sublights[3][3];
  uint32_t blocks;
  float density[4][TILE_PIXELS];
  float cut[2][TILE_PIXELS];
  float buffer[HL_CHANNELS][64][64];
  sublight_pixel left[HL_CHANNELS][64][64]; /* whole numbers of buffer */
  struct {
    float pixels[4 * TILE_PIXELS];
    uint64_t samples;
    uint32_t open;
  } out;
  float scattered_light[12 * 60];
  scatter_field scattered;
  phase_table phase;
} shade_state;

/* The state's only tile. */
static tile_slab tile_of(const shade_state *s, void *scratch) {
  return (tile_slab){
      .patches = s->patches, .patch_count = s->patch_count, .blocks = s->blocks, .scratch = scratch};
}

static void call_shade(const hot_functions *hot, void *state) {
  shade_state *s = state;
  s->out.samples = 0;
  _Alignas(64) unsigned char scratch[2 * SHADE_SCRATCH_BYTES];
  shade_tile_function *function = s->covers ? hot->render->cover : hot->render->shade;
  const tile_slab tile = tile_of(s, scratch);
  s->out.open = function(&s->job, &tile, s->out.pixels, &s->out.samples);
}

/* steepest: pixels that places lie apart at most, for each unit. */
static shadow_map random_map(uint32_t *seed, double steepest) {
  shadow_map map = {.stride = 64, .width = 60, .height = 50};
  for (int row = 0; row < 3; row++)
    for (int column = 0; column < 4; column++)
      map.rows[row][column] = random_between(seed, -steepest, steepest);
  map.rows[0][3] = 10;
  map.rows[1][3] = map.rows[2][3] = 250;
  return map;
}

static void set_up_lights(shade_state *s, uint32_t *seed, int round) {
  fill_salted(&s->buffer[0][0][0], sizeof s->buffer / 4, seed, 0, 1);
  for (int i = 0; i < HL_CHANNELS * 64 * 64; i++)
    (&s->left[0][0][0])[i] = (sublight_pixel)((&s->buffer[0][0][0])[i] * SUBLIGHT_ONE);
  for (int i = 0; i < 3; i++) {
    shade_light *light = &s->lights[i];
    vec3 towards = bench_random_direction(seed);
    *light = (shade_light){.parallel = (round + i) % 2,
                           .towards = {(float)towards.x, (float)towards.y, (float)towards.z},
                           .position = {3, -2, (float)i},
                           .color = {1, 0.5f, salted(seed, 0, 1)},
                           .inverse_square = i == 1,
                           .shadowed = i < 2,
                           .path = 0.7f,
                           .number = i,
                           .lookups = &s->lookups[i],
                           .sublights = s->sublights[i],
                           .sublight_count = round % 4,
                           .channels = s->job.channels,
                           .parallel_row = (round + i) % 4 < 2 ? i : -1,
                           .nearest = round % 5 == 4,
                           .cubic = round / 4 % 2};
    light->caps.count = light->parallel ? 0 : (round + i) % 5;
    for (int part = 0; part < light->caps.count; part++)
      light->caps.cap[part] = (light_cap){{3 + (float)part, salted(seed, -2, 2), 1},
                                          {1, 2, 0.5f, 0.3f, -0.2f, 0.1f}};
    s->lookups[i].map = random_map(seed, 9);
    s->lookups[i].young = 0.3f;
    for (int c = 0; c < HL_CHANNELS; c++) {
      s->lookups[i].transmittance[c] = &s->buffer[c][2][2];
      s->lookups[i].outside[c] = &s->buffer[c][6][5];
      s->lookups[i].older[c] = round % 2 ? &s->buffer[c][9][7] : NULL;
    }
    for (int part = 0; part < 3; part++) {
      s->sublights[i][part] = (sublight_lookup){.map = random_map(seed, part == 0 ? 9 : 2),
                                                .weight = {1, 0.7f, salted(seed, 0, 1)}};
      for (int c = 0; c < HL_CHANNELS; c++) {
        s->sublights[i][part].transmittance[c] = &s->left[c][2][2];
        s->sublights[i][part].outside[c] = &s->left[c][4][7];
      }
    }
    if (round % 4 == 3) light->cone = (light_cone){{-light->towards[0], 0.6f, -light->towards[2]}, 0.3f, 4};
    if ((round + i) % 3 == 0) {
      light->texture = (light_texture){
          .pixels = &s->buffer[0][0][0], .width = 1 + round % 30, .height = 20, .sharpness = {1, 2.5f}};
      for (int row = 0; row < 3; row++)
        for (int column = 0; column < 4; column++)
          light->texture.map[row][column] = random_between(seed, -1, 9);
      light->texture.level_count = round % 4;
      light->texture.first = 0.05f;
      light->texture.edge[0] = 0.3f;
      light->texture.parallel = round % 2;
      light->texture.beyond[i] = 1;
      for (int l = 0; l < light->texture.level_count; l++)
        light->texture.level[l] = (texture_level){
            &s->buffer[0][0][0] + 99 * l, 20 + l, 15, {0.7f, 1}, {2.5f, 3}};
    }
  }
}

/* A plane, a box and a sphere across the volumes. */
static const shade_cut cuts_bench[] = {
    {HL_CUT_PLANE, 0, {{0.6f, 0.3f, 0.7f, -2}, {0}, {0}}},
    {HL_CUT_BOX, 0, {{0.3f, 0.02f, 0, 0.1f}, {0, 0.25f, 0.03f, 0.2f}, {-0.02f, 0, 0.3f, 0}}},
    {HL_CUT_SPHERE, 1, {{0.2f, 0, 0, 0.1f}, {0, 0.2f, 0, 0}, {0, 0, 0.2f, 0.1f}}}};

static void set_up_shade(shade_state *s, uint32_t *seed, int round) {
  memset(s, 0, sizeof *s);
  s->job = (shade_job){.rays = random_rays(seed, round),
                       .through = {0.1f, 0.2f, 0.5f},
                       .towards_eye = {0, 0.6f, -0.8f},
                       .normal = {0, 0, 1},
                       .path = 0.6f,
                       .height = 1,
                       .spacing = 0.5f,
                       .back_to_front = round % 4 == 2,
                       .lights = s->lights,
                       .light_count = round % 4,
                       .ambient = {0.1f, 0.2f, 0},
                       .emission = 1,
                       .channels = round % 3 ? 3 : 1};
  s->patch_count = 1 + round % 2;
  fill_salted(s->scattered_light, sizeof s->scattered_light / sizeof(float), seed, 0, 2);
  s->scattered = (scatter_field){.nodes = {{4, 3, 5}, {-1, -2, 0.5f}, 2.5f},
                                 .light = s->scattered_light,
                                 .flux = round % 2 ? s->scattered_light + 180 : NULL,
                                 .channels = round % 3 ? 3 : 1};
  s->job.scattered = round % 5 ? &s->scattered : NULL;
  if (round == 0) s->job.light_count = 2;
  static float near_passing[3 * HL_CHANNELS][TILE_PIXELS];
  fill_salted(near_passing[0], sizeof near_passing / sizeof(float), seed, 0, 1);
  if (round % 3 == 2) s->job.near_passing = (const float(*)[TILE_PIXELS])near_passing;
  static float phase_rows[3][PHASE_COLUMNS], phase_caps[PHASE_CAPS][PHASE_COLUMNS][2];
  fill_salted(phase_rows[0], sizeof phase_rows / sizeof(float), seed, 0.1, 2);
  fill_salted(&phase_caps[0][0][0], sizeof phase_caps / sizeof(float), seed, 0.1, 2);
  s->phase = (phase_table){0.7, 9, phase_caps, phase_rows};
  set_up_lights(s, seed, round);
  for (int v = 0; v < 2; v++) {
    const classifier *classifier = classifier_of(round / 2 + v);
    int masked = classifier->mask.factors != NULL;
    fill_salted(s->density[2 * v], 2 * TILE_PIXELS, seed, -0.1, 1.1);
    if (round % 8 == 3) s->density[2 * v][20] = NAN;
    s->volumes[v] = (shade_volume){classifier,
                                   &gradient_bench[(round + v) % GRADIENT_GRIDS].grid,
                                   hl_kernel_get((hl_kernel)(round % 3)),
                                   (round + v) % 2,
                                   (round + v) % 7 != 6,
                                   v == 0,
                                   (round + v) % 6 != 5,
                                   round % 9 == 7,
                                   round % 4 ? 0.9f : 20,
                                   0.5f,
                                   0.8f,
                                   0.3f,
                                   25,
                                   round % 3 ? 0.4f : 0,
                                   {1, 0.5f, 0},
                                   {{0.9f, 0.1f, 0, 4}, {-0.1f, 0.8f, 0.2f, 5}, {0, -0.2f, 1.1f, 6}},
                                   {-0.5f, -0.5f, -0.5f},
                                   {8.5f, 9.5f, 10.5f},
                                   {{-1, 0}, {0, -1}, {-1, -1}},
                                   round % 4 == 3,
                                   NULL,
                                   v,
                                   round % 3 == 1 ? -0.7f : round % 3 * 0.4f,
                                   round / 3 % 4 || round % 3 != 1 ? &s->phase : NULL, /* a sky needs it */
                                   round / 3 % 4 ? &s->phase : NULL,
                                   (round + v) % 3 == 1 ? colors_bench : (voxel_colors){.voxels = NULL},
                                   {0.9f, 0.8f, 1},
                                   round % 4 == 1,
                                   round % 4 < 2,
                                   cuts_bench,
                                   round % 3 == 1 ? 3 : 0,
                                   round % 6 == 1 ? 3 : 0,
                                   round % 2,
                                   masked,
                                   masked && round % 5 > 1 ? colors_bench : (voxel_colors){.voxels = NULL},
                                   v + 1};
    s->patches[v] = (shade_patch){&s->volumes[v],
                                  s->density[2 * v],
                                  s->density[2 * v + 1],
                                  round == 0 ? ALL_BLOCKS : (uint32_t)(65536 * bench_random(seed)),
                                  v == round % 3 ? s->cut[0] : NULL,
                                  v == round % 3 ? s->cut[1] : NULL,
                                  round % 5 == 4};
  }
  fill_salted(s->cut[0], TILE_PIXELS, seed, 0, 1);
  fill_salted(s->cut[1], TILE_PIXELS, seed, 0.5, 2);
  for (int i = 0; i < 4 * TILE_PIXELS; i++)
    s->out.pixels[i] = random_between(seed, 0, round % 5 ? 1 : 1.0005);
  s->blocks = round == 0 ? ALL_BLOCKS : (uint32_t)(65536 * bench_random(seed));
}

/* What is measured takes more floats a pixel than a colour. */
typedef struct measure_state {
  shade_state shade;
  struct {
    float pixels[MEASURES * TILE_PIXELS];
    uint32_t open;
  } out;
} measure_state;

static void call_measure(const hot_functions *hot, void *state) {
  measure_state *s = state;
  uint64_t samples = 0;
  _Alignas(64) unsigned char scratch[2 * SHADE_SCRATCH_BYTES];
  const tile_slab tile = tile_of(&s->shade, scratch);
  s->out.open = hot->render->measure(&s->shade.job, &tile, s->out.pixels, &samples);
}

static void test_measure(void **unused) {
  (void)unused;
  static measure_state state;
  uint32_t seed = 53;
  int marked = 0;
  for (int round = 0; round < 4 * ROUNDS; round++) {
    set_up_shade(&state.shade, &seed, round);
    state.shade.job.back_to_front = 0; /* measured front to back only */
    for (int i = 0; i < MEASURES * TILE_PIXELS; i++) {
      int row = i / BLOCK_PIXELS % MEASURES;
      /* alpha on both sides of the 0.01 from which on a ray has met something */
      state.out.pixels[i] = row == MEASURE_ALPHA         ? random_between(&seed, 0, i % 2 ? 1 : 0.012)
                            : row == MEASURE_DEPTH_FIRST ? INFINITY
                                                         : random_between(&seed, -9, 9);
    }
    trial trial = {call_measure, &state, &state.out, sizeof state.out};
    try_it("measure_tile", &trial, round);
    for (int i = 0; i < MEASURES * TILE_PIXELS; i++)
      marked += i / BLOCK_PIXELS % MEASURES == MEASURE_DEPTH_FIRST && isfinite(state.out.pixels[i]);
  }
  assert_true(marked > ROUNDS);
}

static void test_shade(void **unused) {
  (void)unused;
  static shade_state state;
  uint32_t seed = 41;
  for (int round = 0; round < 4 * ROUNDS; round++) {
    set_up_shade(&state, &seed, round);
    trial trial = {call_shade, &state, &state.out, sizeof state.out};
    try_it("shade_tile", &trial, round);
    state.covers = 1;
    try_it("cover_tile", &trial, round);
  }
}

typedef struct maximum_state {
  shade_state shade;
  float shown[CLASSIFIER_ENTRIES + 2][4];
  struct {
    float values[2 * MAXIMUM_ROWS * TILE_PIXELS];
    uint64_t samples;
    uint32_t open;
  } out;
} maximum_state;

static void call_maximum(const hot_functions *hot, void *state) {
  maximum_state *s = state;
  s->out.samples = 0;
  const tile_slab tile = tile_of(&s->shade, NULL);
  s->out.open = hot->render->maximum(&s->shade.job, &tile, s->out.values, &s->out.samples);
}

static void test_maximum(void **unused) {
  (void)unused;
  static maximum_state state;
  uint32_t seed = 47;
  for (int round = 0; round < 4 * ROUNDS; round++) {
    set_up_shade(&state.shade, &seed, round);
    state.shade.job.sheet = 7;
    for (int v = 0; v < 2; v++) state.shade.volumes[v].shown = (const float(*)[4])state.shown;
    for (int entry = 0; entry < CLASSIFIER_ENTRIES + 2; entry++) {
      double from = entry + random_between(&seed, -0.2, 1.2);
      state.shown[entry][SHOWN_FROM] = (float)from;
      state.shown[entry][SHOWN_TO] = (float)(from + 0.5);
      state.shown[entry][SHOWN_BELOW] = entry % 7 == 0 ? -1 : (float)entry - 1;
    }
    for (int i = 0; i < 2 * MAXIMUM_ROWS * TILE_PIXELS; i++)
      state.out.values[i] = i / TILE_PIXELS % MAXIMUM_ROWS == MAXIMUM_SHEET
                                ? (i % 3 ? 6 : -1)
                                : random_between(&seed, -1, CLASSIFIER_ENTRIES);
    trial trial = {call_maximum, &state, &state.out, sizeof state.out};
    try_it("maximum_tile", &trial, round);
  }
}

/* ---- surfaces ---- */

enum { SKY_CELLS = 4 * 3 * 5 };

typedef struct surface_state {
  shade_state shade; /* its job, with lights */
  sky_light sky;
  _Alignas(64) int16_t sky_cells[SKY_CELLS * SKY_CELL];
  surface_samples out;
} surface_state;

static void call_surface(const hot_functions *hot, void *state) {
  surface_state *s = state;
  hot->render->surface(&s->shade.job, &s->out);
}

static void set_unit_vectors(float to[3][SURFACE_SAMPLES], uint32_t *seed) {
  for (int i = 0; i < SURFACE_SAMPLES; i++) {
    vec3 unit = bench_random_direction(seed);
    to[0][i] = (float)unit.x, to[1][i] = (float)unit.y, to[2][i] = (float)unit.z;
  }
}

static void set_up_surface(surface_state *s, uint32_t *seed, int round) {
  surface_samples *out = &s->out;
  set_up_shade(&s->shade, seed, round);
  for (int i = 0; i < SKY_CELLS * SKY_CELL; i++) {
    bool passing = i % SKY_CELL == SKY_PASSING || i % SKY_CELL == SKY_PASSING + 1, whole = i % 7 == 0;
    float number = whole ? SKY_MOST : random_between(seed, passing ? 0 : -SKY_MOST, SKY_MOST);
    s->sky_cells[i] = (int16_t)(i % 5 == 0 && !passing ? -number : number);
  }
  s->sky = (sky_light){.cells = s->sky_cells,
                       .row_numbers = 4 * SKY_CELL,
                       .stored_unit = {1e-4f, 2e-4f, 3e-4f},
                       .count = {4, 3, 5},
                       .low = {-3, -2, -1},
                       .inverse_cell = 0.5f,
                       .cell = 2,
                       .lift = 1,
                       .channels = round % 3 ? 3 : 1,
                       .color = {0.9f, 1, 0.4f}};
  fill_salted(&s->sky.open[0][0], 3 * FIELD_HARMONICS, seed, 0, 1);
  s->shade.job.sky = round % 3 == 1 ? NULL : &s->sky;
  fill_salted(&out->position[0][0], 3 * SURFACE_SAMPLES, seed, -2, 4);
  set_unit_vectors(out->normal, seed);
  set_unit_vectors(out->towards_eye, seed);
  for (int axis = 0; axis < 3; axis++) out->normal[axis][round % SURFACE_SAMPLES] = 0; /* black */
  fill_salted(&out->color[0][0], 3 * SURFACE_SAMPLES, seed, 0, 1);
  out->ambient = 0.2f, out->diffuse = 0.8f, out->specular = 0.3f, out->shininess = 25, out->emission = 0.1f;
  out->even = round % 2 ? 0.4f : 0;
  for (int c = 0; c < 3; c++) out->behind[c] = random_between(seed, 0, 1);
  out->receives_shadow = round % 5 != 4;
}

static void test_surface(void **unused) {
  (void)unused;
  static surface_state state;
  uint32_t seed = 59;
  int lit = 0;
  for (int round = 0; round < 4 * ROUNDS; round++) {
    set_up_surface(&state, &seed, round);
    trial trial = {call_surface, &state, &state.out, sizeof state.out};
    try_it("shade_surface", &trial, round);
    for (int i = 0; i < SURFACE_SAMPLES; i++) lit += state.out.lit[1][i] > 0.1f;
  }
  assert_true(lit > SURFACE_SAMPLES * ROUNDS);
}

/* One volume has code of its own: a second one that has nothing in the tile changes nothing, rounding
 * apart. */
static void test_shade_beside_nothing(void **unused) {
  (void)unused;
  static shade_state alone, beside;
  uint32_t seed = 43;
  int lit = 0;
  for (int round = 0; round < 4 * ROUNDS; round += 2) {
    set_up_shade(&alone, &seed, round);
    for (int i = 0; i < 3; i++) alone.lights[i].nearest = 0; /* a rounding apart is another pixel there */
    beside = alone;
    beside.job.lights = beside.lights;
    beside.patch_count = 2;
    beside.patches[1].blocks = 0;
    call_shade(&hl_hot_scalar, &alone);
    call_shade(&hl_hot_scalar, &beside);
    assert_int_equal(alone.out.open, beside.out.open);
    assert_int_equal(alone.out.samples, beside.out.samples);
    lit += alone.out.samples > 0;
    for (int i = 0; i < 4 * TILE_PIXELS; i++) {
      float pixel = alone.out.pixels[i];
      if (isfinite(pixel)) assert_float_equal(beside.out.pixels[i], pixel, 1e-4f * (1 + fabsf(pixel)));
    }
  }
  assert_true(lit > ROUNDS);
}

int main(int argc, char **argv) {
  timing = argc > 1 && strcmp(argv[1], "--time") == 0;
  if (hl_cpu_best_instruction_set() == HL_INSTRUCTION_SET_SCALAR) {
    puts("1..0 # SKIP this processor has the scalar instruction set alone");
    return 0;
  }
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_bound_rows),   cmocka_unit_test(test_bound_cells),
      cmocka_unit_test(test_brick_bits),   cmocka_unit_test(test_label_rows),
      cmocka_unit_test(test_fill),         cmocka_unit_test(test_coverage),
      cmocka_unit_test(test_brick_ranges), cmocka_unit_test(test_light),
      cmocka_unit_test(test_fields),       cmocka_unit_test(test_shade),
      cmocka_unit_test(test_measure),      cmocka_unit_test(test_maximum),
      cmocka_unit_test(test_surface),      cmocka_unit_test(test_shade_beside_nothing),
  };
  return cmocka_run_group_tests_name("simd_equal", tests, open_classifier, close_classifier);
}
