/* volume/glimpse.h - the few voxels of a volume larger than memory that automatic choices look at (guess/).
 *
 * They lie on lattices, far apart: read from a scratch file, they would cost a pass over the whole of it each
 * time. So they are kept in memory while the volume is stored. */
#ifndef HL_VOLUME_GLIMPSE_H
#define HL_VOLUME_GLIMPSE_H

#include "volume/volume.h"

#define HL_LATTICE_PLACES 5e5                      /* the most voxels of a lattice */
#define HL_BORDER_PLACES  (HL_LATTICE_PLACES / 12) /* the most voxels of a lattice on a face of the grid */
#define HL_CELL_PLACES    1e6 /* the most cells of a lattice of which each is looked at by rows */
#define HL_ROW_VOXELS     6e6 /* about; of rows along x that are looked at, where each cell has one */

/* The step along each axis with which a lattice takes at most `most` voxels of a grid; at least 1. */
size_t hl_lattice_step(const size_t dimension[3], double most);

/* The step of lattices on the grid's faces: the greatest that a face needs. */
size_t hl_border_step(const size_t dimension[3]);

/* The step, along y and z, of the rows that are looked at. */
size_t hl_row_step(const size_t dimension[3]);

typedef struct hl_glimpse hl_glimpse;

/* *glimpse: owned by the caller; null where it would take more than `most` bytes. False: out of memory. */
bool hl_glimpse_create(hl_context *context, const size_t dimension[3], hl_storage storage, uint64_t most,
                       hl_glimpse **glimpse);
void hl_glimpse_release(hl_glimpse *glimpse); /* null is allowed */

/* Keeps what it needs of `count` stored values, those from number `first` on ([k][j][i]). Several threads may
 * store different voxels at once. */
void hl_glimpse_store(hl_glimpse *glimpse, size_t first, size_t count, const void *values);

/* The stored value of a voxel, or null: it is not kept. */
const void *hl_glimpse_voxel(const hl_glimpse *glimpse, size_t i, size_t j, size_t k);

/* A row of stored values, or null: it is not kept as a whole. */
const void *hl_glimpse_row(const hl_glimpse *glimpse, size_t j, size_t k);

#endif
