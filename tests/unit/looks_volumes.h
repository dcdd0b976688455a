/* tests/unit/looks_volumes.h - grids of values for the tests of looks and of brightness. */
#ifndef HL_TESTS_LOOKS_VOLUMES_H
#define HL_TESTS_LOOKS_VOLUMES_H

#include <math.h>

enum { N = 48, COUNT = N * N * N };

static float values[COUNT];

static inline double distance(int i, int j, int k, double x, double y, double z) {
  return hypot(hypot(i - x, j - y), k - z);
}

/* values[] = each(i, j, k) */
static inline void fill(double (*each)(int i, int j, int k)) {
  for (int v = 0; v < COUNT; v++) values[v] = (float)each(v % N, v / N % N, v / N / N);
}

static inline double noise(int i, int j, int k) { /* -0.5..0.5 */
  unsigned state = (unsigned)((k * N + j) * N + i) * 2654435761u;
  state = (state ^ (state >> 15)) * 2246822519u;
  return (double)((state ^ (state >> 13)) & 0xffff) / 65536 - 0.5;
}

/* A body in Hounsfield units: air, skin and muscle, a bone. */
static inline double body(int i, int j, int k) {
  double r = distance(i, j, k, 24, 23, 25), soft = 1 / (1 + exp((r - 17) / 0.6)),
         bone = 1 / (1 + exp((r - 6) / 0.6));
  return -1000 + 1040 * soft + 900 * bone + 60 * noise(i, j, k);
}

static inline double ball_of_bytes(int i, int j, int k) {
  return floor(fmax(0, fmin(255, 128 + 80 * (15 - distance(i, j, k, 24, 24, 24)))));
}

#endif
