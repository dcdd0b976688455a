/* unit/simd_classifiers.c - see simd_trials.h: classifiers and grids for the tests of light and shading. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "simd_trials.h"

/* A classifier of one ramp, from a bench. */
static bench classifier_bench;
/* The same with gradient opacity. */
static classifier steep_classifier;
/* The same with functions of two numbers: of the gradient, and of another volume. */
static classifier plane_classifiers[2];
/* The same with a mask. */
static classifier masked_classifier;
const classifier *classifier_of(int number) {
  if (number % 6 == 5) return &masked_classifier;
  if (number % 6 > 2) return &plane_classifiers[number % 6 - 3];
  return number % 6 == 2 ? &steep_classifier : &classifier_bench.classifier;
}

bench gradient_bench[GRADIENT_GRIDS];

static unsigned char color_voxels[8 * 9 * 10 * 4];
static float decode_bench[256];
const voxel_colors colors_bench = {color_voxels, {7, 8, 9}, {4, 32, 288}, decode_bench};

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
                                          .scale = 1.0f / 65535,
                                          .rest = 0.5f};
  memcpy(masked_classifier.mask.to_index, to_index, sizeof to_index);
}

int open_classifier(void **unused) {
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

int close_classifier(void **unused) {
  (void)unused;
  for (int i = 0; i < GRADIENT_GRIDS; i++) bench_close(&gradient_bench[i]);
  bench_close(&classifier_bench);
  return 0;
}
