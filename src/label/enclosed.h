/* label/enclosed.h - finds the level at which a smooth field encloses a given volume. */
#ifndef HL_LABEL_ENCLOSED_H
#define HL_LABEL_ENCLOSED_H

#include "label/filter.h"

/* A field whose enclosed volume is measured. */
typedef struct label_enclosed {
  const label_field *field;                 /* the field, as coefficients of the B-spline */
  double (*measures)[HL_ENCLOSED_MEASURES]; /* [size z]; memory for the sums of each slice */
  double wanted;                            /* the volume that the surface must enclose, in voxels */
  float level;                              /* result: the level at which the field's surface encloses the
                                             * wanted volume, near 1/2 */
  double slope; /* result: the mean length of the gradient at the surface, per voxel edge */
} label_enclosed;

/* Finds the level at which a field encloses the wanted volume, and the mean slope of the field at this level.
 */
void hl_label_enclose(hl_pool *pool, label_enclosed *enclosed);

#endif
