/* volume/convert.h - converts the types of files and callers to the three storage types.
 *
 * Signed integers of 8 and 16 bits: the sign bit is flipped, so that stored = value + 2^(bits - 1). The
 * volume's value_offset subtracts the added number again. Types of 32 and 64 bits: the stored value is the
 * nearest f32. Doubles beyond the range of f32 become infinite, and such voxels are transparent. */
#ifndef HL_VOLUME_CONVERT_H
#define HL_VOLUME_CONVERT_H

#include <stdbool.h>

#include "volume/volume.h"

size_t hl_voxel_type_bytes(hl_voxel_type type); /* bytes of one voxel; 0 for an unknown type */
hl_storage hl_voxel_type_storage(hl_voxel_type type);

/* The number that is added to a value of this type when it is stored: 128 for i8, 32768 for i16, 0 for all
 * other types. */
double hl_voxel_type_bias(hl_voxel_type type);

/* Converts `count` packed voxels to stored values. swap: whether the source's byte order differs from the
 * native order. source: bytes of any alignment; may be the destination if voxels and stored values have the
 * same size. */
void hl_voxels_store(hl_voxel_type type, bool swap, const void *source, size_t count, void *destination);

/* Copies a row of `count` voxels that lie stride_bytes apart into adjacent memory. */
void hl_voxels_gather(const unsigned char *source, ptrdiff_t stride_bytes, size_t voxel_bytes, size_t count,
                      unsigned char *row);

#endif
