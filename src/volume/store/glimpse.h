/* volume/store/glimpse.h - describes the glimpse of a volume larger than memory: the voxels that automatic
 * choices (guess/) need.
 *
 * The glimpse has few voxels, which lie far apart, on lattices. Reading the glimpse's voxels from a scratch
 * file would take a pass over the whole file. Therefore the voxels of the glimpse are copied to memory when
 * the volume is stored. */
#ifndef HL_VOLUME_GLIMPSE_H
#define HL_VOLUME_GLIMPSE_H

#include "volume/volume.h"

/* The greatest number of voxels of a lattice, and of a lattice that lies on one face of the grid. */
#define HL_LATTICE_PLACES 5e5
#define HL_BORDER_PLACES  (HL_LATTICE_PLACES / 12)
/* Limits for lattices of whole rows along x, which have one row for each cell that is examined.
 * HL_CELL_PLACES: the greatest number of cells. HL_ROW_VOXELS: the number of voxels in all rows together,
 * approximately. */
#define HL_CELL_PLACES 1e6
#define HL_ROW_VOXELS  6e6

/* The distance between a lattice's voxels along each axis, at least 1. With the returned distance, a lattice
 * has at most `most` voxels. */
size_t hl_lattice_step(const size_t dimension[3], double most);

/* The distance between the voxels of lattices on the grid's faces. All faces have the same distance, which is
 * the greatest distance that any face requires. */
size_t hl_border_step(const size_t dimension[3]);

/* The distance along y and z, in voxels, between the rows along x that a lattice keeps. */
size_t hl_row_step(const size_t dimension[3]);

typedef struct hl_glimpse hl_glimpse;

/* Makes an empty glimpse. *glimpse is owned by the caller. *glimpse is null if the glimpse would take more
 * than `most` bytes. Returns false if memory is short. */
bool hl_glimpse_create(hl_context *context, const size_t dimension[3], hl_storage storage, uint64_t most,
                       hl_glimpse **glimpse);
void hl_glimpse_release(hl_glimpse *glimpse); /* null is allowed */

/* Keeps the voxels that the glimpse needs, out of `count` stored values from number `first` on ([k][j][i]).
 * Several threads may store different voxels at the same time. */
void hl_glimpse_store(hl_glimpse *glimpse, size_t first, size_t count, const void *values);

/* The stored value of a voxel; null if the glimpse does not keep the voxel. */
const void *hl_glimpse_voxel(const hl_glimpse *glimpse, size_t i, size_t j, size_t k);

/* The stored values of row (j, k); null if the glimpse does not keep the whole row. */
const void *hl_glimpse_row(const hl_glimpse *glimpse, size_t j, size_t k);

#endif
