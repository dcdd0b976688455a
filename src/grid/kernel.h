/* grid/kernel.h - reconstruction kernels as data.
 *
 * A kernel is a symmetric one-dimensional function of the distance d in voxels, a polynomial in |d| on
 * [0,1] (inner) and on [1,2] (outer); the kernel of a voxel is the product of three, in index space, so
 * that anisotropic and oblique grids get the right shape in the world. Every kernel sums to 1 over the
 * lattice at every phase: a constant volume gives a constant sheet. */
#ifndef HL_GRID_KERNEL_H
#define HL_GRID_KERNEL_H

#include <halflight/scene.h>

enum { HL_KERNEL_DEGREE = 5, HL_BSPLINE_DEGREE = 3 /* the cubic B-spline's, and no other kernel's */ };

typedef struct kernel {
  const char *name;
  float support;                     /* radius in voxels: 1 or 2 */
  double variance;                   /* per axis, voxels^2: how much it blurs */
  float inner[HL_KERNEL_DEGREE + 1]; /* coefficients of a^0 .. a^5, a = |d| in [0,1] */
  float outer[HL_KERNEL_DEGREE + 1]; /* the same with a = |d| - 1 in [0,1] */
  int degree;                        /* the highest non-zero power */
} kernel;

const kernel *hl_kernel_get(hl_kernel which);
double hl_kernel_value(const kernel *kernel, double distance);

#endif
