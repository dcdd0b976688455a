/* volume/raw.h - how the name of a raw file states the size and type of its voxels. */
#ifndef HL_VOLUME_RAW_H
#define HL_VOLUME_RAW_H

#include "volume/payload.h"

/* Fills *payload with the size and type that the name states, unchecked; false if the name states none. */
bool hl_raw_name(const char *path, hl_payload *payload);

#endif
