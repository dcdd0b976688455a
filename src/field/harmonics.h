/* field/harmonics.h - real spherical harmonics up to the second degree. */
#ifndef HL_FIELD_HARMONICS_H
#define HL_FIELD_HARMONICS_H

#include "core/vector.h"
#include "field/field.h"

/* The factors of the harmonics, which have unit norm over the sphere. */
#define HARMONIC_0  0.28209479177387814 /* 1 / sqrt(4 pi) */
#define HARMONIC_1  0.48860251190291992 /* sqrt(3 / (4 pi)) x, y, z */
#define HARMONIC_2  1.09254843059207907 /* sqrt(15 / (4 pi)) x y, y z, z x */
#define HARMONIC_20 0.31539156525252000 /* sqrt(5 / (16 pi)) (3 z^2 - 1) */
#define HARMONIC_22 0.54627421529603953 /* sqrt(15 / (16 pi)) (x^2 - y^2) */

static inline void hl_harmonics(vec3 d, double harmonics[FIELD_HARMONICS]) {
  harmonics[0] = HARMONIC_0;
  harmonics[1] = HARMONIC_1 * d.x;
  harmonics[2] = HARMONIC_1 * d.y;
  harmonics[3] = HARMONIC_1 * d.z;
  harmonics[4] = HARMONIC_2 * d.x * d.y;
  harmonics[5] = HARMONIC_2 * d.y * d.z;
  harmonics[6] = HARMONIC_2 * d.z * d.x;
  harmonics[7] = HARMONIC_20 * (3 * d.z * d.z - 1);
  harmonics[8] = HARMONIC_22 * (d.x * d.x - d.y * d.y);
}

#endif
