/* label/levels.h - changes a smooth field so that it is 1/2 at the label's border, even if the label is
 * thin. */
#ifndef HL_LABEL_LEVELS_H
#define HL_LABEL_LEVELS_H

#include "label/filter.h"

/* The planes of values by which a field's level is moved. Each plane has one value for each cell of 2x2x2
 * voxels. HL_LEVEL_FACES: the number of the border's faces, where each face counts twice, once from each
 * side. HL_LEVEL_VALUE: the sum of the field on these faces. HL_LEVEL_FALL: the sum of the field's fall
 * across these faces. HL_LEVEL_VOXELS: the number of the label's voxels. HL_LEVEL_THIN: the number of the
 * label's voxels in its parts that are one voxel thin. */
enum { HL_LEVEL_FACES, HL_LEVEL_VALUE, HL_LEVEL_FALL, HL_LEVEL_VOXELS, HL_LEVEL_THIN, HL_LEVEL_PLANES };

/* Working space of hl_label_level(). */
typedef struct label_levels {
  float *values;  /* [HL_LEVEL_PLANES][size[2]][size[1]][size[0]]; the planes, one after the other */
  size_t size[3]; /* number of cells along x, y and z */
} label_levels;

void hl_label_levels_size(const size_t field[3], size_t size[3]);

/* The mean slope of a field at the label's border after hl_label_level(), per voxel. */
#define HL_LABEL_SLOPE 0.25f

/* Moves a field's level. Smoothing lowers the field in thin labels, so that the field of a plate, a line or a
 * voxel does not reach 1/2 anywhere. So at each place, the function changes the field linearly: the mean of
 * the field's values on the nearby faces between voxels inside and outside becomes 1/2, and the field's mean
 * fall across these faces becomes HL_LABEL_SLOPE. Parts that are one voxel thin grow by a fraction of a
 * voxel, so that sheets do not miss these parts. inside: [size z][y][x], 1 or 0. */
void hl_label_level(hl_pool *pool, const unsigned char *inside, const label_field *field,
                    const label_levels *levels);

#endif
