/* grid/kernel.h - describes reconstruction kernels by polynomials.
 *
 * A kernel is a symmetric one-dimensional function of the distance d in voxels. The kernel is a polynomial in
 * |d| on [0,1] (inner), and another polynomial on [1,2] (outer). A voxel's weight is the product of this
 * function along the three axes of index space. So the kernel has the right shape in the world even if voxels
 * are not cubes or axes are oblique. At every point, the weights of all voxels add up to 1: a constant volume
 * gives a constant sheet. */
#ifndef HL_GRID_KERNEL_H
#define HL_GRID_KERNEL_H

#include <stdbool.h>

#include <halflight/scene.h>

/* HL_BSPLINE_DEGREE: the degree of the cubic B-spline. HL_KERNEL_DEGREE: the greatest degree of any kernel.
 */
enum { HL_KERNEL_DEGREE = 5, HL_BSPLINE_DEGREE = 3 };

typedef struct kernel {
  const char *name;
  float support;                     /* radius in voxels: 1 or 2 */
  double variance;                   /* the kernel's variance along an axis, in squared voxels. The variance
                                      * tells how much the kernel blurs */
  float inner[HL_KERNEL_DEGREE + 1]; /* the polynomial for distances |d| in [0,1]: coefficients of a^0 ..
                                      * a^5, where a = |d| */
  float outer[HL_KERNEL_DEGREE + 1]; /* the polynomial for distances |d| in [1,2]: coefficients of a^0 ..
                                      * a^5, where a = |d| - 1 */
  int degree;                        /* the highest power with a coefficient other than zero */
  bool interpolates;                 /* whether the kernel is summed over coefficients (prefilter.h) and not
                                      * over the voxels themselves */
} kernel;

const kernel *hl_kernel_get(hl_kernel which);
double hl_kernel_value(const kernel *kernel, double distance);

#endif
