/* volume/store/gathered.h - the whole of a label map in this process's memory.
 *
 * Labels are fields that are made of all voxels around them, and their numbers are names: neither pages nor
 * rounded values will do. A volume over ranks is therefore gathered: each rank gets a copy of all blocks,
 * with the file's own numbers. Other label maps lie in memory already. */
#ifndef HL_VOLUME_GATHERED_H
#define HL_VOLUME_GATHERED_H

#include "core/error.h"
#include "volume/volume.h"

/* Gets a volume whose voxels lie in memory: the map itself, or for a map over ranks a copy, which the map
 * keeps and owns. The first call for a map over ranks is collective and makes the copy; later calls get the
 * same copy. HL_ERROR_UNSUPPORTED for a map in a scratch file or in bricks; HL_ERROR_MEMORY, on all ranks,
 * where one rank has no room for the copy. */
hl_status hl_volume_in_memory(const hl_volume *map, hl_volume **whole, hl_error *error);

#endif
