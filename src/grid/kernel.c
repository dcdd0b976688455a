/* grid/kernel.c - defines the kernels' polynomials. */
#include "grid/kernel.h"

#include <math.h>

/* Cubic B-spline, where d is the distance: on [0,1] its value is 2/3 - a^2 + a^3/2 with a = |d|; on [1,2] its
 * value is (2-|d|)^3/6 = (1-a)^3/6 with a = |d|-1. */
static const kernel bspline = {
    .name = "bspline",
    .support = 2,
    .variance = 1.0 / 3,
    .inner = {2.0f / 3, 0, -1, 0.5f},
    .outer = {1.0f / 6, -0.5f, 0.5f, -1.0f / 6},
    .degree = HL_BSPLINE_DEGREE,
};

/* The interpolating kernel: the cubic B-spline, which is summed over coefficients. The coefficients are
 * chosen so that the sum passes through the voxels' values. */
static const kernel interpolating = {
    .name = "interpolating",
    .support = 2,
    .variance = 1.0 / 3,
    .inner = {2.0f / 3, 0, -1, 0.5f},
    .outer = {1.0f / 6, -0.5f, 0.5f, -1.0f / 6},
    .degree = HL_BSPLINE_DEGREE,
    .interpolates = true,
};

/* The Gaussian exp(-2 d^2), cut at 2. The Gaussian is divided by the sum of its values at the four voxels
 * around a point, so that the four weights add up to 1. Derived: the sum depends only on the fractional part
 * of d. The coefficients are a least-squares fit of degree 5, constrained to sum to 1, to be continuous and
 * to end at 0; the error is at most 2.7e-4. */
static const kernel gaussian = {
    .name = "gaussian",
    .support = 2,
    .variance = 0.25,
    .inner = {0.7870132844753958f, -0.01760350297774177f, -1.1233938540871382f, -1.1401834855116038f,
              2.7579365590793836f, -1.1572756441131011f},
    .outer = {0.106493357314156f, -0.4287671073145578f, 0.7067149093879059f, -0.5995274685644574f,
              0.26830881674134155f, -0.053222506219492066f},
    .degree = 5,
};

/* The kernel of linear interpolation: 1 - |d|, where d is the distance. */
static const kernel linear = {
    .name = "linear",
    .support = 1,
    .variance = 1.0 / 6,
    .inner = {1, -1},
    .outer = {0},
    .degree = 1,
};

const kernel *hl_kernel_get(hl_kernel which) {
  switch (which) {
    case HL_KERNEL_GAUSSIAN: return &gaussian;
    case HL_KERNEL_LINEAR: return &linear;
    case HL_KERNEL_INTERPOLATING: return &interpolating;
    case HL_KERNEL_BSPLINE: break;
  }
  return &bspline;
}

double hl_kernel_value(const kernel *kernel, double distance) {
  double a = fabs(distance), sum = 0;
  if (a >= kernel->support) return 0;
  const float *piece = a < 1 ? kernel->inner : kernel->outer;
  if (a >= 1) a -= 1;
  for (int power = HL_KERNEL_DEGREE; power >= 0; power--) sum = sum * a + piece[power];
  return sum;
}
