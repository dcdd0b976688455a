/* label/levels.h - moves a smooth field's level so that the field is 1/2 at the label's border, however thin
 * the label is. */
#ifndef HL_LABEL_LEVELS_H
#define HL_LABEL_LEVELS_H

#include "label/filter.h"

/* The planes of values that cells of 2x2x2 voxels hold. FACES, VALUE and FALL are sums over the border's
 * faces: of 1, of the field on them, and of the field's fall across them. MOST is the field's greatest value.
 * THIN, 0 to 1, says whether the field is thin here. */
enum { HL_LEVEL_FACES, HL_LEVEL_VALUE, HL_LEVEL_FALL, HL_LEVEL_THIN, HL_LEVEL_MOST, HL_LEVEL_PLANES };

/* Working space of hl_label_level(). */
typedef struct label_levels {
  float *values;  /* [HL_LEVEL_PLANES][size z][y][x] */
  size_t size[3]; /* cells along x, y, z */
} label_levels;

void hl_label_levels_size(const size_t field[3], size_t size[3]);

/* The mean slope per voxel that the field has at the border after hl_label_level(). */
#define HL_LABEL_SLOPE 0.25f

/* Moves a field's level. Smoothing pulls the field down where the label is thin: the field of a plate, a line
 * or a voxel does not reach 1/2. Yet half way between the two sides of the border the field has some value.
 * This value, averaged over the nearby faces between voxels inside and outside, becomes 1/2, and the field's
 * fall across such a face becomes HL_LABEL_SLOPE. Labels one or two voxels thin grow by a part of a voxel, so
 * that they are not lost between sheets. inside: [size z][y][x], 1 or 0. */
void hl_label_level(hl_pool *pool, const unsigned char *inside, const label_field *field,
                    const label_levels *levels);

#endif
