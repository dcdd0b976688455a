/* label/enclosed.h - the level at which a smooth field encloses a given volume. */
#ifndef HL_LABEL_ENCLOSED_H
#define HL_LABEL_ENCLOSED_H

#include "label/filter.h"

enum { HL_ENCLOSED_MEASURES = 4 };

/* A field whose surface's volume is measured. */
typedef struct label_enclosed {
  const label_field *field;                 /* coefficients of the B-spline */
  double (*measures)[HL_ENCLOSED_MEASURES]; /* [size z]; room */
  double wanted;                            /* the volume; voxels */
  float level;                              /* found: near 1/2 */
  double slope; /* found: the mean length of the gradient at the surface, per voxel */
} label_enclosed;

/* Finds the level and the slope. */
void hl_label_enclose(hl_pool *pool, label_enclosed *enclosed);

#endif
