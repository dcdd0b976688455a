/* volume/unsmoothed.h - the voxels of a smoothed volume as they were before.
 *
 * A picture shows smoothed voxels, and a person who measures wants the file's values. Both volumes in memory
 * would take up to twice the memory of one. The unsmoothed voxels are looked at plane by plane, and so they
 * lie in a scratch file (store/pages.h), of which only the pages that a plane crosses are in memory. */
#ifndef HL_VOLUME_UNSMOOTHED_H
#define HL_VOLUME_UNSMOOTHED_H

#include "volume/volume.h"

/* Where the context keeps unsmoothed voxels, keeps those of `volume` for hl_volume_unsmoothed(). If `volume`
 * is a smoothed volume itself, the voxels that it keeps are kept. If the scratch file cannot be made, and
 * where the library does not own the voxels, `volume` is retained. Fails only if cancelled. */
hl_status hl_volume_keep_unsmoothed(hl_volume *smoothed, hl_volume *volume, hl_error *error);

#endif
