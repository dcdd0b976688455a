/* volume/formats/particles/difference.h - computes the greatest difference between a volume of particles and
 * the exact sum of the particles' kernels. */
#ifndef HL_VOLUME_FORMATS_PARTICLES_DIFFERENCE_H
#define HL_VOLUME_FORMATS_PARTICLES_DIFFERENCE_H

#include "particles/probes.h"
#include "volume/volume.h"

/* The exact values of the quantity that the volume shows. */
typedef struct hl_particle_truth {
  hl_particle_probes probes;
  double *values; /* owned; [probes.count] */
} hl_particle_truth;

void hl_particle_truth_release(hl_context *context, hl_particle_truth *truth);

/* Computes the greatest difference between the field and the exact values at the probes' positions, and
 * stores the difference in the volume for hl_volume_get_field_error(). The field is a cubic B-spline whose
 * coefficients are the volume's voxels, or its bricks. */
void hl_particle_truth_compare(const hl_particle_truth *truth, hl_volume *volume);

#endif
