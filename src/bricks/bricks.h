/* bricks/bricks.h - describes a field in bricks: blocks of B-spline coefficients. Each brick has the spacing
 * of coefficients that its place needs.
 *
 * The lattice. Coefficient i of level l stands at x = 2^l i along each axis, in voxels of level 0. The field
 * is f(x) = sum_i c[l][i] beta(x / 2^l - i), where beta is the cubic B-spline. Every second point of level l
 * is a point of level l + 1, so the lattices nest.
 *
 * A brick of level l covers side^3 cells of its level. Brick b of an axis holds the cells b side .. b side +
 * side - 1, and stores its coefficients b side - 1 .. b side + side + 1, which are side + 3 numbers an axis.
 * Beside a coarser brick the three layers around the border are the coarser brick's coefficients, subdivided.
 * The field therefore has continuous second derivatives across the border (truncated hierarchical B-splines:
 * C. Giannelli, B. Juettler, H. Speleers, THB-splines, 2012).
 *
 * A volume whose field is bricks also has a grid of voxels, which sets the volume's box, its framing and the
 * size of saved files. Voxel (0,0,0) stands at the lattice coordinates `origin`, and the distance between
 * voxels is one. The box reaches from half a voxel before the first voxel to half a voxel behind the last
 * one. If a source's cells have their corners at the lattice points, the voxels are these cells, and the
 * origin is 1/2. If voxels stand at the lattice points, as in some sparse files, the origin is a whole
 * number. Beyond the directory's faces, the field keeps its values at the faces.
 *
 * In:  the builders of fields (meshes of cells, adaptive grids, particles, sparse files) make the bricks.
 * Out: code that samples a field (grid/, fill/, the reference) finds a cell's brick in the directory. */
#ifndef HL_BRICKS_BRICKS_H
#define HL_BRICKS_BRICKS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum {
  BRICK_MARGIN = 3,       /* number of coefficients of a brick along an axis, minus its number of cells along
                           * the axis */
  BRICK_LEVELS_LIMIT = 16 /* the most levels of a field */
};

/* An entry of the directory. Each block of side^3 cells of level 0 has one, which names the brick that covers
 * the block. */
typedef struct hl_brick_entry {
  int32_t slot;   /* index into the pool; -1: all coefficients of the brick are `constant` */
  int32_t level;  /* level of the brick that covers the block */
  float constant; /* data value; set only where slot is -1 */
} hl_brick_entry;

typedef struct hl_bricks {
  int shift;           /* side = 2^shift cells */
  int levels;          /* 1 .. BRICK_LEVELS_LIMIT */
  size_t dimension[3]; /* number of lattice points of level 0 along x, y, z; a dense volume would have this
                        * many voxels */
  double origin[3];    /* lattice coordinates of the volume's voxel (0,0,0) along x, y, z; not negative */
  size_t directory_size[3];  /* blocks of level 0 along x, y, z; together they hold all lattice points */
  hl_brick_entry *directory; /* owned; [z][y][x], one entry for each block of level 0; a brick of level l has
                              * 2^l entries along each axis */
  float *pool;  /* owned; [slots][side + 3][side + 3][side + 3], x fastest; coefficients, data values */
  size_t slots; /* number of bricks in the pool */
} hl_bricks;

#endif
