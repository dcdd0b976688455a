/* bricks/bricks.h - a field at levels: bricks of B-spline coefficients, each at the spacing that its place
 * needs.
 *
 * The lattice. Coefficient i of level l stands at x = 2^l i along each axis, in voxels of level 0. The field
 * is f(x) = sum_i c[l][i] beta(x / 2^l - i), where beta is the cubic B-spline. Every second point of level l
 * is a point of level l + 1, so the lattices nest.
 *
 * A brick of level l covers side^3 cells of its level. Brick b of an axis holds the cells b side .. b side +
 * side - 1, and stores its coefficients b side - 1 .. b side + side + 1, which are side + 3 numbers an axis.
 * Beside a coarser brick the three layers around the border are the coarser brick's coefficients, subdivided:
 * then the field has continuous second derivatives across the border (truncated hierarchical B-splines:
 * C. Giannelli, B. Juettler, H. Speleers, THB-splines, 2012).
 *
 * A volume whose field is bricks has voxels, too: the grid that its box, its framing and saved files follow.
 * Voxel (0,0,0) stands at the lattice coordinates `origin`, and voxels are one apart. The box reaches from
 * half a voxel before the first voxel to half a voxel behind the last one. So cells whose corners are the
 * lattice points have an origin of 1/2 and as many voxels as cells. A lattice that begins before the box, as
 * a sparse file's may, has an origin of some whole number. Beyond the directory's faces the values at the
 * faces go on.
 *
 * In:  the builders of fields (meshes of cells, adaptive grids, particles, sparse files) make the bricks.
 * Out: what samples a field (grid/, fill/, the reference) looks a cell's brick up in the directory. */
#ifndef HL_BRICKS_BRICKS_H
#define HL_BRICKS_BRICKS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum {
  BRICK_MARGIN = 3,       /* a brick stores this many more coefficients along an axis than it has cells along
                           * it */
  BRICK_LEVELS_LIMIT = 16 /* the most levels of a field */
};

/* The entry of one block of side^3 cells of level 0: the brick that covers the block. */
typedef struct hl_brick_entry {
  int32_t slot;   /* index into the pool; -1: all coefficients of the brick are `constant` */
  int32_t level;  /* level of the brick that covers the block */
  float constant; /* data value; set only where slot is -1 */
} hl_brick_entry;

typedef struct hl_bricks {
  int shift;           /* side = 2^shift cells */
  int levels;          /* 1 .. BRICK_LEVELS_LIMIT */
  size_t dimension[3]; /* lattice points of level 0 along x, y, z, as many as a dense volume has voxels */
  double origin[3];    /* lattice coordinates of the volume's voxel (0,0,0) along x, y, z; not negative */
  size_t directory_size[3];  /* blocks of level 0 along x, y, z; together they hold all lattice points */
  hl_brick_entry *directory; /* owned; [z][y][x], one entry for each block of level 0; a brick of level l has
                              * 2^l entries along each axis */
  float *pool;  /* owned; [slots][side + 3][side + 3][side + 3], x fastest; coefficients, data values */
  size_t slots; /* number of bricks in the pool */
} hl_bricks;

#endif
