/* volume/formats/raw.h - finds the size and type of voxels in the name of a raw file. */
#ifndef HL_VOLUME_RAW_H
#define HL_VOLUME_RAW_H

#include "volume/io/payload.h"

/* Sets *payload to the size and type that a file's name states. The size is not checked. Returns false if the
 * name states no size and type. */
bool hl_raw_name(const char *path, hl_payload *payload);

/* The size and type of a slice's voxels, as the name of the slice or of its folder states them:
 * "512x512_uint16". */
typedef struct hl_raw_slice {
  size_t width, height;
  hl_voxel_type type;
  bool big_endian;
  size_t begin, end; /* the position of this text in the name */
} hl_raw_slice;

/* Finds the size and type that a name of `length` characters states. Returns false if the name does not state
 * size and type. */
bool hl_raw_slice_name(const char *name, size_t length, hl_raw_slice *slice);

#endif
