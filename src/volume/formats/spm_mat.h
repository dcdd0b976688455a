/* volume/formats/spm_mat.h - where SPM keeps the place of an ANALYZE volume: NAME.mat beside NAME.hdr. */
#ifndef HL_VOLUME_SPM_MAT_H
#define HL_VOLUME_SPM_MAT_H

#include "core/error.h"
#include "volume/volume.h"

/* Reads the place of the volume whose header has this path, and puts axes and origin into the grid (x to the
 * right, y to the front, z up). False, with the grid as it was, if there is no such file, or none that is
 * read; of the latter, a warning tells. */
bool hl_spm_mat_place(hl_context *context, const char *header_path, hl_volume_description *grid);

#endif
