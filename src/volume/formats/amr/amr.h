/* volume/formats/amr/amr.h - makes volumes of adaptive grids, whose cells lie in patches at levels of
 * refinement.
 *
 * Files and callers number the levels from 0, which is the coarsest. Each level has an index space of its
 * own: cell i of a level covers the cells i ratio .. i ratio + ratio - 1 of the next finer level. */
#ifndef HL_VOLUME_AMR_H
#define HL_VOLUME_AMR_H

#include "bricks/patches.h"
#include "volume/volume.h"

enum { HL_AMR_LEVELS_MOST = BRICK_LEVELS_LIMIT };

/* The shape of an adaptive grid. */
typedef struct hl_amr_shape {
  int levels;                    /* 1 .. HL_AMR_LEVELS_MOST */
  int ratio[HL_AMR_LEVELS_MOST]; /* for each level but the finest, the number of cells of the next finer level
                                  * along a cell's edge; a power of two */
  ptrdiff_t first[3];            /* index of the first cell of level 0 in the domain */
  size_t count[3];               /* cells of level 0 in the domain */
  double origin[3];              /* in the world: the corner of the domain with the least coordinates */
  double spacing[3];             /* in the world: lengths of the edges of a cell of level 0 */
} hl_amr_shape;

typedef struct hl_amr {
  hl_context *context;
  hl_amr_shape shape;
  int lattice_level[HL_AMR_LEVELS_MOST]; /* for each level, its number in patches.h, where levels count from
                                          * the finest */
  hl_patches *patches;                   /* owned */
  const char *subject;                   /* borrowed; starts error lines */
} hl_amr;

/* Checks the shape. *amr is all zeros after a failure. */
hl_status hl_amr_begin(hl_context *context, const hl_amr_shape *shape, const char *subject, hl_amr *amr,
                       hl_error *error);

/* Adds a patch, which consists of the cells first .. first + count - 1 of a level. values:
 * [count[2]][count[1]][count[0]], x fastest. */
hl_status hl_amr_add(hl_amr *amr, int level, const ptrdiff_t first[3], const size_t count[3],
                     const float *values, hl_error *error);

/* Sets the size in the world of a finest cell, which is the size of the volume's voxels. If all numbers are
 * 0, the size is not changed. */
void hl_amr_set_spacing(hl_amr *amr, const double spacing[3]);

/* Makes the volume. The volume's voxels have the size of the finest level's cells. */
hl_status hl_amr_finish(hl_amr *amr, hl_volume **volume, hl_error *error);
void hl_amr_close(hl_amr *amr);

#endif
