/* label/levels.h - a smooth field made to pass 1/2 at the border of what it was made from, however thin that
 * is. */
#ifndef HL_LABEL_LEVELS_H
#define HL_LABEL_LEVELS_H

#include "label/filter.h"

/* What cells of 2x2x2 voxels know of the field: sums over the border's faces of 1, of the field on them, and
 * of how far it falls across them; the field's greatest value; and whether it is thin here, 0 to 1. */
enum { HL_LEVEL_FACES, HL_LEVEL_VALUE, HL_LEVEL_FALL, HL_LEVEL_THIN, HL_LEVEL_MOST, HL_LEVEL_PLANES };

/* Room for hl_label_level(). */
typedef struct label_levels {
  float *values;  /* [HL_LEVEL_PLANES][size z][y][x] */
  size_t size[3]; /* cells along x, y, z */
} label_levels;

void hl_label_levels_size(const size_t field[3], size_t size[3]);

/* The slope per voxel that the field has at the border afterwards; on average. */
#define HL_LABEL_SLOPE 0.25f

/* Smoothing pulls a field down where what it was made from is thin: a plate's, a line's or a voxel's field
 * does not reach 1/2. But half way between the two sides of the border it has a value all the same. This
 * value, averaged over the faces between voxels inside and outside nearby, becomes 1/2, and the field's fall
 * across such a face becomes HL_LABEL_SLOPE. What is one or two voxels thin grows by a part of a voxel, so
 * that it is not lost between sheets. inside: [size z][y][x], 1 or 0. */
void hl_label_level(hl_pool *pool, const unsigned char *inside, const label_field *field,
                    const label_levels *levels);

#endif
