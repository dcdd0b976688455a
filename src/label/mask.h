/* label/mask.h - a label map as a lattice of what it makes of another volume's matter. */
#ifndef HL_LABEL_MASK_H
#define HL_LABEL_MASK_H

#include <halflight/scene.h>

#include "core/error.h"

/* What factors of extinction are stored as: 0 to 1 in 16 bits. */
#define HL_MASK_STEPS 65535.0
/* Slopes of the factor along the lattice's axes are stored as this times the rise from voxel to voxel. */
#define HL_MASK_SLOPE_STEPS 254.0
/* Masks have at most so many voxels: 32 bits number the bytes of their colours. */
#define HL_MASK_VOXELS ((size_t)1 << 29)

/* A lattice's bricks tell where it is even, so that frames need not look closer there. Each has two words,
 * [bk][bj][bi], and is about the points from HL_MASK_BRICK b to HL_MASK_BRICK (b + 1), the last included,
 * along each axis: all that positions whose cells lie in it depend on. The first word's lower 16 bits are a
 * factor, its other bits the following; the second word is a colour. */
enum {
  HL_MASK_BRICK_SHIFT = 2,
  HL_MASK_BRICK = 1 << HL_MASK_BRICK_SHIFT,
  HL_MASK_EVEN = 1 << 16,      /* all its points have this factor and no slope */
  HL_MASK_EVEN_COLOR = 1 << 17 /* all its points have this colour; 0 where no label tints */
};

/* Makes a volume of the map's grid, to be read linearly between voxels. Its values are the factors; its
 * colours, [k][j][i][4], are those of the labels that tint: the square roots of linear red, green and blue,
 * and how much of the colour the matter takes, each from 0 to 255; null where no label tints. Its voxels may
 * be read two bytes beyond the last one. Its slopes, [k][j][i][4], are the factor's central differences along
 * i, j and k, HL_MASK_SLOPE_STEPS times as large, and 0. It has mask_bricks. A label's share rises from 0 to
 * 1 over about two voxels, and is 1/2 where the label meets another or the rest. threads: 0: one per
 * processor. */
hl_status hl_label_mask(hl_context *context, int threads, const hl_mask *mask, hl_volume **made,
                        hl_error *error);

#endif
