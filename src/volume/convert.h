/* volume/convert.h - converts the types of files and callers to the three storage types.
 *
 * signed integers   sign bit flipped: stored = value + 2^(bits-1), undone by the volume's value_offset 32 and
 * 64 bit      nearest f32; doubles beyond its range become infinite (transparent) */
#ifndef HL_VOLUME_CONVERT_H
#define HL_VOLUME_CONVERT_H

#include <stdbool.h>

#include "volume/volume.h"

size_t hl_voxel_type_bytes(hl_voxel_type type); /* 0 for an unknown type */
hl_storage hl_voxel_type_storage(hl_voxel_type type);

/* The difference of a stored value and the value: 128 for i8, 32768 for i16, else 0. */
double hl_voxel_type_bias(hl_voxel_type type);

/* Converts `count` packed voxels. swap: whether they are in the other byte order. source: needs no alignment,
 * and may be the destination itself if both types have the same size. */
void hl_voxels_store(hl_voxel_type type, bool swap, const void *source, size_t count, void *destination);

/* Gathers one row of `count` voxels of the given size that lie stride_bytes apart. */
void hl_voxels_gather(const unsigned char *source, ptrdiff_t stride_bytes, size_t voxel_bytes, size_t count,
                      unsigned char *row);

#endif
