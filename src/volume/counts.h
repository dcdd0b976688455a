/* volume/counts.h - counts how often each stored value of integer voxels occurs. */
#ifndef HL_VOLUME_COUNTS_H
#define HL_VOLUME_COUNTS_H

#include "volume/volume.h"

/* The number of different stored values that a storage type has; 0 for floats, which are not counted. */
size_t hl_values_of(hl_storage storage);

/* Adds the occurrences of each of `count` stored values to counts, [hl_values_of(storage)]. Floats are not
 * counted. */
void hl_values_count(hl_storage storage, const void *voxels, size_t count, uint64_t *counts);

#endif
