/* volume/beyond.h - voxels out of sight, which are interpolated in a coarser resolution of the same data in
 * place of being read.
 *
 * In: a coarser volume, and the planes around the parts that pictures see. Out: which boxes of voxels
 * pictures see, and interpolated rows of the voxels that pictures do not see. Voxels that are seen, and
 * voxels within HL_BEYOND_REACH of them, are never interpolated. Kernels, gradients and smoothing at a seen
 * position therefore use only voxels of the file.
 */
#ifndef HL_VOLUME_BEYOND_H
#define HL_VOLUME_BEYOND_H

#include <stdint.h>

#include "volume/volume.h"

enum { HL_BEYOND_REACH = 4 }; /* distance from seen voxels, in voxels */

typedef struct hl_beyond {
  const hl_volume *coarse;    /* borrowed; the coarser volume; null if all voxels are seen */
  hl_voxel_type type;         /* type of the voxels in the file */
  const double (*seen)[4][4]; /* borrowed; [seen_count]; the four planes (a, b, c, d) around each part that is
                               * seen, in the world; a point (x, y, z) is inside a plane if a x + b y + c z +
                               * d >= 0 */
  size_t seen_count;
  affine3 grid;             /* the map from the grid's indices to the world */
  double first[3], step[3]; /* index in `coarse` = first + step * index in the grid, along each axis */
} hl_beyond;

/* Finds the rule by which the voxels of a grid are seen or interpolated. coarse: may be null. seen: [count],
 * planes in the world, borrowed as long as the rule is used. If `coarse` is a label map, or its axes are not
 * parallel to the grid's axes, *beyond becomes a rule by which every voxel is seen. */
void hl_beyond_prepare(const hl_volume *coarse, const double (*seen)[4][4], size_t count,
                       const hl_volume_description *grid, hl_beyond *beyond);

/* Returns whether any voxel of a box may be seen. */
bool hl_beyond_is_seen(const hl_beyond *beyond, const uint64_t begin[3], const uint64_t count[3]);

/* The number of floats that hl_beyond_row() needs as scratch memory. */
size_t hl_beyond_room(const hl_beyond *beyond);

/* Interpolates `count` voxels of the row (j, k), from index i on, in the coarser volume, and writes their
 * stored values (hl_voxels_store()) to row. */
void hl_beyond_row(const hl_beyond *beyond, uint64_t i, uint64_t j, uint64_t k, uint64_t count,
                   float *scratch, void *row);

#endif
