/* volume/store/gathered.h - the whole of a label map in this process's memory.
 *
 * Labels are fields that are made of all voxels around them, and their numbers are names: neither pages nor
 * rounded values will do. A volume over ranks is therefore gathered: each rank gets a copy of all blocks,
 * with the file's own numbers. Other label maps lie in memory already. */
#ifndef HL_VOLUME_GATHERED_H
#define HL_VOLUME_GATHERED_H

#include "core/error.h"
#include "volume/volume.h"

/* Gets the volume whose voxels lie in memory: the map itself, or of a map over ranks its copy, which the map
 * keeps and owns. The first call for a map over ranks is collective, and its copy is what the later ones get.
 * HL_ERROR_UNSUPPORTED for a map in a scratch file or in bricks; HL_ERROR_MEMORY, on all ranks, where the
 * memory of one has no room. */
hl_status hl_volume_in_memory(const hl_volume *map, hl_volume **whole, hl_error *error);

#endif
