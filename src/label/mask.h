/* label/mask.h - makes the lattice of a mask: the factors and colours that a label map gives to another
 * volume's matter. */
#ifndef HL_LABEL_MASK_H
#define HL_LABEL_MASK_H

#include <halflight/scene.h>

#include "core/error.h"

/* Factors of extinction, 0 to 1, are stored as 16 bits with this greatest value. */
#define HL_MASK_STEPS 65535.0
/* The factor's slopes along the lattice's axes are stored as the rise from voxel to voxel, times this
 * number. */
#define HL_MASK_SLOPE_STEPS 254.0
/* The greatest number of voxels of a mask, because the bytes of its colours are numbered by 32 bits. */
#define HL_MASK_VOXELS ((size_t)1 << 29)

/* The bricks of a lattice tell where the lattice is uniform, so that frames need not read the points of
 * uniform bricks. Each brick has two words, [bk][bj][bi][2]. Along each axis, brick b covers the points from
 * HL_MASK_BRICK b to HL_MASK_BRICK (b + 1), both included. The covered points are all points between which
 * positions in the brick are interpolated. The lower 16 bits of the first word are a factor, and its other
 * bits are the flags below. The second word is a colour. */
enum {
  HL_MASK_BRICK_SHIFT = 2,
  HL_MASK_BRICK = 1 << HL_MASK_BRICK_SHIFT,
  HL_MASK_EVEN = 1 << 16, /* flag: all points of the brick have the factor of its first word and no slope */
  /* flag: all points of the brick have the colour of its second word, which is 0 if no label tints */
  HL_MASK_EVEN_COLOR = 1 << 17
};

/* Makes a mask's lattice: a volume with the map's grid, which is interpolated linearly between voxels. Its
 * values are factors of extinction. Its colours, [k][j][i][4], come from the labels that tint: the square
 * roots of linear red, green and blue, and the fraction of this colour that the matter takes, each as 0 to
 * 255. The colours are null if no label tints. The colours may be read two bytes beyond the last voxel. Its
 * slopes, [k][j][i][4], are the factor's central differences along i, j and k, times HL_MASK_SLOPE_STEPS, and
 * a 0. The lattice's bricks (mask_bricks) are made, too. The fraction of the matter that belongs to a label
 * rises from 0 to 1 over about two voxels, and is 1/2 where the label meets another label or the rest.
 * threads: 0 for one per processor. */
hl_status hl_label_mask(hl_context *context, int threads, const hl_mask *mask, hl_volume **made,
                        hl_error *error);

/* Makes the lattice of the mask that ends a volume at the walls of its mesh. wall: hl_volume.wall. */
hl_status hl_wall_mask(hl_context *context, int threads, hl_volume *wall, hl_volume **made, hl_error *error);

#endif
