/* volume/raw.h - how the name of a raw file states the size and type of its voxels. */
#ifndef HL_VOLUME_RAW_H
#define HL_VOLUME_RAW_H

#include "volume/payload.h"

/* Fills *payload with the size and type that the name states, unchecked; false if the name states none. */
bool hl_raw_name(const char *path, hl_payload *payload);

/* What the name of a slice, or of its folder, states: "512x512_uint16". */
typedef struct hl_raw_slice {
  size_t width, height;
  hl_voxel_type type;
  bool big_endian;
  size_t begin, end; /* where in the name */
} hl_raw_slice;

/* False if the name, of so many characters, states no slice. */
bool hl_raw_slice_name(const char *name, size_t length, hl_raw_slice *slice);

#endif
