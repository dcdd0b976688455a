/* label/enclosed.h - the level at which a smooth field encloses a given volume. */
#ifndef HL_LABEL_ENCLOSED_H
#define HL_LABEL_ENCLOSED_H

#include "label/filter.h"

/* A field whose enclosed volume is measured. */
typedef struct label_enclosed {
  const label_field *field;                 /* holds the coefficients of the B-spline */
  double (*measures)[HL_ENCLOSED_MEASURES]; /* [size z]; working space */
  double wanted;                            /* the volume that the surface must enclose, in voxels */
  float level;                              /* result: the level, near 1/2 */
  double slope; /* result: the mean length of the gradient at the surface, per voxel edge */
} label_enclosed;

/* Finds the level and the slope. */
void hl_label_enclose(hl_pool *pool, label_enclosed *enclosed);

#endif
