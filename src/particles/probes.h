/* particles/probes.h - computes the exact sums of the particles' kernels at a few places. A field that was
 * made of the particles is compared with these sums.
 *
 * In: particles and the plan of their field. Out: places, and sums there. The places are the positions of
 * some particles, taken evenly from the set's order. So regions with many particles have many places. */
#ifndef HL_PARTICLES_PROBES_H
#define HL_PARTICLES_PROBES_H

#include "particles/particles.h"

enum { HL_PARTICLE_PROBES = 4096 }; /* the most places */

typedef struct hl_particle_probes {
  size_t count;
  uint32_t (*place)[3]; /* owned; [count]; in the units of the set */
  double (*point)[3];   /* owned; [count]; lattice coordinates of level 0 */
} hl_particle_probes;

/* Chooses the places. They must be released also after a failure, which is for lack of memory. */
hl_status hl_particle_probes_choose(hl_context *context, const hl_particle_set *set,
                                    const hl_particle_lattice *lattice, const char *subject,
                                    hl_particle_probes *probes, hl_error *error);
void hl_particle_probes_release(hl_context *context, hl_particle_probes *probes);

/* Adds up, at each place, weight W(r / h) / (pi h^3) over all particles, with the kernel W of kernel.h, the
 * distance r to the particle and the particle's own smoothing length h. weights: [set->count], in the set's
 * order; if null, each weight is 1. sums: [count]; the same with any number of threads. */
hl_status hl_particle_probes_sum(hl_context *context, hl_pool *pool, const hl_particle_set *set,
                                 const float *weights, const hl_particle_plan *plan,
                                 const hl_particle_probes *probes, const char *subject, double *sums,
                                 hl_error *error);

#endif
