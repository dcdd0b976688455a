/* tests/unit/looks_volumes.h - grids of values for the tests of looks and of brightness. */
#ifndef HL_TESTS_LOOKS_VOLUMES_H
#define HL_TESTS_LOOKS_VOLUMES_H

#include <math.h>

enum { N = 48, COUNT = N * N * N };

static float values[COUNT];

static inline double distance(int i, int j, int k, double x, double y, double z) {
  return hypot(hypot(i - x, j - y), k - z);
}

/* Sets values[] to each(i, j, k). */
static inline void fill(double (*each)(int i, int j, int k)) {
  for (int v = 0; v < COUNT; v++) values[v] = (float)each(v % N, v / N % N, v / N / N);
}

static inline double noise(int i, int j, int k) { /* -0.5..0.5 */
  unsigned state = (unsigned)((k * N + j) * N + i) * 2654435761u;
  state = (state ^ (state >> 15)) * 2246822519u;
  return (double)((state ^ (state >> 13)) & 0xffff) / 65536 - 0.5;
}

/* A body in Hounsfield units: air, skin and muscle, and a bone. */
static inline double body(int i, int j, int k) {
  double r = distance(i, j, k, 24, 23, 25), soft = 1 / (1 + exp((r - 17) / 0.6)),
         bone = 1 / (1 + exp((r - 6) / 0.6));
  return -1000 + 1040 * soft + 900 * bone + 60 * noise(i, j, k);
}

static inline double ball_of_bytes(int i, int j, int k) {
  return floor(fmax(0, fmin(255, 128 + 80 * (15 - distance(i, j, k, 24, 24, 24)))));
}

/* Labels of four regions of a ball. */
static inline double regions(int i, int j, int k) {
  if (distance(i, j, k, 24, 24, 24) > 20) return 0;
  return i < 20 ? 3 : j < 25 ? 17 : k < 24 ? 42 : 1001;
}

/* Noisy tissue in air. share: the fraction of the voxels that are much brighter, 0 to 1. */
static inline double tissue(int i, int j, int k, double share) {
  if (distance(i, j, k, 24, 24, 24) > 23) return 8 + 6 * noise(i, j, k);
  return 100 + 280 * fmin(fmax(share, 0), 1) + 40 * noise(i, j, k) + 40 * noise(k, i, j);
}

/* Three winding vessels from one side to the other. */
static inline double angiogram(int i, int j, int k) {
  double first = hypot(i - 24 - 6 * sin(0.2 * k), j - 15 - 5 * cos(0.15 * k)),
         second = hypot(j - 30 - 5 * sin(0.17 * i), k - 24 - 6 * cos(0.21 * i)),
         third = hypot(i - 12 - 0.5 * j, k - 10 - 4 * sin(0.2 * j));
  return tissue(i, j, k, 2.2 - fmin(first, fmin(second, third)));
}

/* Beads in tissue that are as bright as vessels. */
static inline double beads(int i, int j, int k) {
  return tissue(i, j, k, 3.5 - distance(i % 16, j % 16, k % 16, 8, 8, 8));
}

/* A head as in MR weighted by T1: grey matter of about 60, white matter of about 90, and bright fat around
 * them, all noisy. */
static inline double head_in_mr(int i, int j, int k) {
  double r = distance(i, j, k, 24, 24, 24), grey = 60 / (1 + exp((r - 20) / 0.5)),
         white = 30 / (1 + exp((r - 12) / 0.5)), fat = 60 * exp(-pow((r - 18) / 0.8, 2));
  return grey + white + fat + (4 + 16 * (r < 20)) * noise(i, j, k);
}

/* Three materials in air. Each needs a colour of its own, also in a scan with noise. */
static inline double three(int i, int j, int k) {
  if (distance(i, j, k, 24, 24, 24) > 20) return 10 + 4 * noise(i, j, k);
  return (i < 20 ? 60 : i < 30 ? 120 : 200) + 8 * noise(i, j, k);
}

/* A block of one material. Its faces lie along the axes and are blurred over two voxels, and these values
 * make two more peaks of the histogram. */
static inline double block(int i, int j, int k) {
  const int at[3] = {i, j, k};
  double part = 1;
  for (int a = 0; a < 3; a++) {
    const int depth = at[a] - 6 < 41 - at[a] ? at[a] - 6 : 41 - at[a];
    part *= depth < 0 ? 0 : depth == 0 ? 0.25 : depth == 1 ? 0.7 : 1;
  }
  return 10 + 200 * part + 2 * noise(i, j, k);
}

#endif
