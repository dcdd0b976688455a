/* particles/kernel.h - computes the cubic spline kernel of smoothed particle hydrodynamics.
 *
 * W(q) with q = distance / h is 1 - 3/2 q^2 + 3/4 q^3 up to 1, (2 - q)^3 / 4 up to 2, and 0 beyond (J. J.
 * Monaghan, J. C. Lattanzio, 1985), times 1 / (pi h^3). Its variance along an axis is 3/10 h^2 (derived: 4/3
 * times the integral of q^4 W(q), which is 9/40). */
#ifndef HL_PARTICLES_KERNEL_H
#define HL_PARTICLES_KERNEL_H

#include <stdint.h>

/* W(q) without the factor 1 / (pi h^3). Derived: both pieces are (2 - q)^3 / 4 - (1 - q)^3, if negative bases
 * are replaced by 0. */
static inline float hl_sph_kernel(float q) {
  float outer = 2 - q, inner = 1 - q;
  outer = outer > 0 ? outer : 0;
  inner = inner > 0 ? inner : 0;
  return 0.25f * outer * outer * outer - inner * inner * inner;
}

/* The same for several distances at a time, with the same bits. Compilers do not turn a loop of the scalar
 * function into vectors, because of its conditions. */
enum { HL_SPH_KERNELS = 4 };
typedef float hl_sph_group __attribute__((vector_size(4 * HL_SPH_KERNELS)));
typedef int32_t hl_sph_masks __attribute__((vector_size(4 * HL_SPH_KERNELS)));

static inline hl_sph_group hl_sph_kernels(hl_sph_group q) {
  hl_sph_group outer = 2 - q, inner = 1 - q;
  outer = (hl_sph_group)((hl_sph_masks)outer & (outer > 0));
  inner = (hl_sph_group)((hl_sph_masks)inner & (inner > 0));
  return 0.25f * outer * outer * outer - inner * inner * inner;
}

#endif
