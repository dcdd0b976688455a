/* unit/simd_trials.c - see simd_trials.h: runs and compares, random inputs. */
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
#include "simd_trials.h"

enum {
  SETS = 4, /* an instruction set of x86, or of Arm */
  TIMED = 100,
  TIMED_RUNS = 5
};

typedef struct contender {
  const hot_functions *hot;
  const char *name;
} contender;

/* The instruction sets that are compared with the scalar one. */
static int contenders(contender list[SETS]) {
  int count = 0;
  for (int set = HL_INSTRUCTION_SET_AVX2; set <= HL_INSTRUCTION_SET_AVX512_VBMI; set++)
    if (hl_cpu_has_instruction_set((hl_instruction_set)set))
      list[count++] = (contender){hl_hot_functions((hl_instruction_set)set),
                                  hl_instruction_set_name((hl_instruction_set)set)};
  return count;
}

bool simd_timing;

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return (double)t.tv_sec * 1e9 + (double)t.tv_nsec;
}

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

void try_it(const char *function, const trial *trial, int round) {
  compare(function, trial);
  if (!simd_timing || round != 0) return;
  contender list[SETS];
  int count = contenders(list);
  time_one(function, trial, &hl_hot_scalar, "scalar");
  for (int i = 0; i < count; i++) time_one(function, trial, list[i].hot, list[i].name);
}

/* ---- inputs ---- */

float random_between(uint32_t *seed, double low, double high) {
  return (float)(low + (high - low) * bench_random(seed));
}

/* One number in eight is an edge case. */
float salted(uint32_t *seed, double low, double high) {
  static const float edges[] = {0, -0.0f, 1, -1, 1e-30f, 3e38f, 1e-42f, 0.5f};
  if (bench_random(seed) < 0.125) return edges[(int)(8 * bench_random(seed))];
  return random_between(seed, low, high);
}

void fill_salted(float *values, size_t count, uint32_t *seed, double low, double high) {
  for (size_t i = 0; i < count; i++) values[i] = salted(seed, low, high);
}

/* Rays that run along the sheets, or in no direction, so that positions become huge or NaN. */
void spoil_rays(sheet_rays *rays, int round) {
  if (round % 8 == 5) rays->h0 = rays->hu = rays->hv = 0;
  if (round % 8 == 6) rays->w0[round % 3] = NAN;
  if (round % 8 == 7) rays->wu[round % 3] = 3e37f;
}

sheet_rays random_rays(uint32_t *seed, int round) {
  sheet_rays rays = {.perspective = round % 2};
  for (float *at = rays.base; at <= &rays.step; at++) *at = random_between(seed, -2, 2);
  spoil_rays(&rays, round);
  return rays;
}
