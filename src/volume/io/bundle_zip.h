/* volume/io/bundle_zip.h - makes a bundle of the files of a zip archive. */
#ifndef HL_VOLUME_BUNDLE_ZIP_H
#define HL_VOLUME_BUNDLE_ZIP_H

#include "volume/io/bundle.h"

/* Opens a zip archive, which is the file `path` or lies in the caller's memory, and reads its directory. */
hl_status hl_bundle_open_zip(hl_context *context, const char *path, const void *bytes, size_t byte_count,
                             hl_bundle *bundle, hl_error *error);

#endif
