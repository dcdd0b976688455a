/* unit/simd_trials.h - hot functions on every instruction set of the machine, held to the scalar table's
 * bits.
 *
 * simd_equal.c runs the tests, which lie in simd_matter.c, simd_light.c, simd_fields.c and simd_shading.c. */
#ifndef SIMD_TRIALS_H
#define SIMD_TRIALS_H

#include <math.h>

#include "sheet_bench.h"

enum { ROUNDS = 40 };

extern bool simd_timing; /* whether the time of calls is printed */

/* A call with everything that it reads and writes. Outputs are compared byte by byte. */
typedef struct trial {
  void (*call)(const hot_functions *hot, void *state);
  void *state;
  void *output;
  size_t size;
} trial;

/* Makes a call on each instruction set, and fails where outputs differ. round: 0 may be timed. */
void try_it(const char *function, const trial *trial, int round);

/* ---- inputs ---- */

float random_between(uint32_t *seed, double low, double high);

/* A random number; one in eight is an edge case. */
float salted(uint32_t *seed, double low, double high);
void fill_salted(float *values, size_t count, uint32_t *seed, double low, double high);

/* Makes rays run along the sheets, or in no direction, in some rounds, so that positions become huge or NaN.
 */
void spoil_rays(sheet_rays *rays, int round);
sheet_rays random_rays(uint32_t *seed, int round);

/* ---- classifiers, and grids whose gradients are taken (simd_classifiers.c) ---- */

/* Classifiers of one ramp: plain, with gradient opacity, with functions of two numbers, with a mask. */
const classifier *classifier_of(int number);

/* Grids of each type of voxel, and a thin one. */
enum { GRADIENT_GRIDS = 4 };
extern bench gradient_bench[GRADIENT_GRIDS];

/* Voxels with colours of their own, within the grids' boxes. */
extern const voxel_colors colors_bench;

int open_classifier(void **unused);
int close_classifier(void **unused);

/* ---- the tests ---- */

/* simd_matter.c: bounds, bits, rows of labels, filling, coverage, ranges of bricks. */
void test_bound_rows(void **unused);
void test_bound_cells(void **unused);
void test_brick_bits(void **unused);
void test_label_rows(void **unused);
void test_fill(void **unused);
void test_coverage(void **unused);
void test_brick_ranges(void **unused);

/* simd_light.c: how light is attenuated; simd_fields.c: blurs and the cascade's products. */
void test_light(void **unused);
void test_fields(void **unused);

/* simd_shading.c: shading, maximum projections, measures, surfaces. */
void test_shade(void **unused);
void test_measure(void **unused);
void test_maximum(void **unused);
void test_surface(void **unused);
void test_shade_beside_nothing(void **unused);

/* A number of any size as a whole number of 16 bits, within its range; NaN becomes 0. */
static inline uint16_t nearest_pixel(float number) { return (uint16_t)fminf(fmaxf(number, 0), 65535); }

#endif
