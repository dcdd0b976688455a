/* field/harmonics.h - computes real spherical harmonics up to the second degree. */
#ifndef HL_FIELD_HARMONICS_H
#define HL_FIELD_HARMONICS_H

#include "core/sheet_constants.h"
#include "core/vector.h"

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
