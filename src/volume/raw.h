/* volume/raw.h - how the name of a raw file states the size and type of its voxels. */
#ifndef HL_VOLUME_RAW_H
#define HL_VOLUME_RAW_H

#include "volume/payload.h"

/* Fills *payload by the size and type, unchecked, that the name states; false if it states none. */
bool hl_raw_name(const char *path, hl_payload *payload);

#endif
