/* volume/unsmoothed.h - keeps the voxels of a smoothed volume as they were before the smoothing.
 *
 * A picture shows the smoothed voxels, but a person who measures wants the file's values. The smoothed and
 * the unsmoothed volume together would take up to twice the memory. Since only planes of the unsmoothed
 * voxels are shown, these voxels are kept in a scratch file (store/pages.h), of which only the pages that a
 * plane crosses are in memory. */
#ifndef HL_VOLUME_UNSMOOTHED_H
#define HL_VOLUME_UNSMOOTHED_H

#include "volume/volume.h"

/* Keeps the voxels of `volume` for hl_volume_unsmoothed(), if the context keeps unsmoothed voxels. If
 * `volume` is itself a smoothed volume, the unsmoothed voxels that `volume` keeps are kept instead. If the
 * scratch file cannot be made, or if the library does not own the voxels, `volume` itself is retained. Fails
 * only if cancelled. */
hl_status hl_volume_keep_unsmoothed(hl_volume *smoothed, hl_volume *volume, hl_error *error);

#endif
