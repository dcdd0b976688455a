/* volume/formats/spm_mat.h - reads the file NAME.mat beside NAME.hdr, in which SPM stores the map from
 * indices to the world of an ANALYZE volume. */
#ifndef HL_VOLUME_SPM_MAT_H
#define HL_VOLUME_SPM_MAT_H

#include "core/error.h"
#include "volume/volume.h"

/* Reads the .mat file beside a volume's header, and sets the axes and the origin of the volume's grid (x to
 * the right, y to the front, z up). If the .mat file does not exist, the function returns false and does not
 * change the grid. If the file cannot be read, the function warns, returns false and does not change the
 * grid. */
bool hl_spm_mat_place(hl_context *context, const char *header_path, hl_volume_description *grid);

#endif
