/* volume/store/glimpse.h - the few voxels of a volume larger than memory that automatic choices look at
 * (guess/).
 *
 * The voxels lie far apart, on lattices. Reading them from a scratch file would mean a pass over the whole
 * file each time. They are therefore kept in memory while the volume is stored. */
#ifndef HL_VOLUME_GLIMPSE_H
#define HL_VOLUME_GLIMPSE_H

#include "volume/volume.h"

/* The greatest numbers of voxels of a lattice, and of a lattice on a face of the grid. */
#define HL_LATTICE_PLACES 5e5
#define HL_BORDER_PLACES  (HL_LATTICE_PLACES / 12)
/* Limits for cells that are examined by whole rows along x, one row for each cell. HL_CELL_PLACES: the
 * greatest number of cells of such a lattice. HL_ROW_VOXELS: the number of voxels in all the rows,
 * approximately. */
#define HL_CELL_PLACES 1e6
#define HL_ROW_VOXELS  6e6

/* The step, along each axis, with which a lattice takes at most `most` voxels of a grid. At least 1. */
size_t hl_lattice_step(const size_t dimension[3], double most);

/* The step of lattices on the grid's faces: the greatest that any face needs. */
size_t hl_border_step(const size_t dimension[3]);

/* The step, along y and z, of the rows that are examined. */
size_t hl_row_step(const size_t dimension[3]);

typedef struct hl_glimpse hl_glimpse;

/* Makes an empty glimpse. *glimpse is owned by the caller; null if it would take more than `most` bytes.
 * False if memory is short. */
bool hl_glimpse_create(hl_context *context, const size_t dimension[3], hl_storage storage, uint64_t most,
                       hl_glimpse **glimpse);
void hl_glimpse_release(hl_glimpse *glimpse); /* null is allowed */

/* Keeps those values that a glimpse needs, among `count` stored values from number `first` on ([k][j][i]).
 * Several threads may store different voxels at once. */
void hl_glimpse_store(hl_glimpse *glimpse, size_t first, size_t count, const void *values);

/* The stored value of a voxel; null if it is not kept. */
const void *hl_glimpse_voxel(const hl_glimpse *glimpse, size_t i, size_t j, size_t k);

/* A row of stored values; null if the row is not kept as a whole. */
const void *hl_glimpse_row(const hl_glimpse *glimpse, size_t j, size_t k);

#endif
