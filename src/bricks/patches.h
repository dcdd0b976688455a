/* bricks/patches.h - converts adaptive grids, which are patches of cells at levels of refinement, to a field
 * in bricks.
 *
 * A cell's value is the mean over the cell. The field's coefficients stand at the corners of cells, because
 * every corner of a coarse cell is a corner of a finer cell, too. A coefficient is a weighted mean of the
 * cells around its corner. If finer patches cover a cell, its value is the mean of the finer cells. Beyond a
 * domain's faces the values of the cells along the faces continue.
 *
 * In:  boxes of cells with values (readers of files, arrays of callers). Out: hl_bricks whose level 0 is the
 * finest level of refinement. */
#ifndef HL_BRICKS_PATCHES_H
#define HL_BRICKS_PATCHES_H

#include "bricks/build.h"

/* All cells that have values, at all levels. They lie in blocks of 8^3 cells, which are made when a patch
 * needs them. */
typedef struct hl_patches hl_patches;

/* Makes an empty set. levels: number of levels of the lattice. Level 0 has the finest cells, and each next
 * level has cells twice as wide. domain: the number of cells of level 0 along x, y, z; a multiple of
 * 2^(levels - 1). */
hl_status hl_patches_create(hl_context *context, int levels, const size_t domain[3], hl_patches **patches,
                            hl_error *error);
void hl_patches_destroy(hl_patches *patches); /* patches may be null */

/* Sets the values of cells first .. first + count - 1 of a level, which must lie within the domain. values:
 * [count[2]][count[1]][count[0]], x fastest. A later patch of the same level overwrites an earlier one. A
 * value that is not finite leaves its cell as it was. subject: starts error lines. */
hl_status hl_patches_add(hl_patches *patches, int level, const size_t first[3], const size_t count[3],
                         const float *values, const char *subject, hl_error *error);

/* Makes the field. *bricks is empty on failure. Its origin is {.5, .5, .5}, so that the voxels are the cells
 * of level 0. Where no patch has a value, the field is NaN. *difference: the greatest difference between a
 * cell's value and the mean of the field over the cell. Cells that finer cells cover, and cells in which the
 * field is NaN somewhere, are not compared; NaN if no cell is compared. Call the function only once: it
 * overwrites coarser cells by means of finer ones, so that a second call would make another field. */
hl_status hl_patches_build(hl_patches *patches, hl_pool *pool, const char *subject, hl_bricks *bricks,
                           double *difference, hl_error *error);

/* Copies the cells of level 0 to `values`, [domain z][domain y][domain x]: NaN where there is no value. */
void hl_patches_copy(const hl_patches *patches, float *values);

#endif
