/* volume/store/gathered.h - makes all voxels of a volume, such as a label map, available in one array.
 *
 * The field of a label is made of all voxels around it, so that voxels must be in memory. The numbers of
 * labels must not be rounded, because they identify the labels. Therefore a label map over ranks is gathered:
 * each rank gets a copy of all blocks, with the file's own numbers. Voxels of sparse pages are copied into
 * one array. All other label maps in memory are in one array already. */
#ifndef HL_VOLUME_GATHERED_H
#define HL_VOLUME_GATHERED_H

#include "core/error.h"
#include "volume/volume.h"

/* Returns whether all voxels are in this process's memory: in one array, or in sparse pages. */
bool hl_volume_is_in_memory(const hl_volume *volume);

/* Gets a volume whose voxels are in one array in memory. The result is the map itself or, for a map over
 * ranks or in sparse pages, a copy that the map owns. The first call makes the copy. For a map over ranks,
 * all ranks must make the first call. Later calls for a map return the same copy. Returns
 * HL_ERROR_UNSUPPORTED for a map in a scratch file or in bricks, and HL_ERROR_MEMORY, on all ranks, if one
 * rank has no room for the copy. */
hl_status hl_volume_in_memory(const hl_volume *map, hl_volume **whole, hl_error *error);

#endif
