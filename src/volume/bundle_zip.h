/* volume/bundle_zip.h - functions that bundle.c and bundle_zip.c need of each other. */
#ifndef HL_VOLUME_BUNDLE_ZIP_H
#define HL_VOLUME_BUNDLE_ZIP_H

#include "volume/bundle.h"

/* Copies the entry and its name. */
hl_status hl_bundle_add(hl_bundle *bundle, hl_bundle_entry entry, hl_error *error);
void hl_bundle_sort(hl_bundle *bundle);

hl_status hl_zip_entry_open(const hl_bundle *bundle, const hl_bundle_entry *entry, bool quiet,
                            hl_source **source, hl_error *error);

#endif
