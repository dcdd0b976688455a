/* page/seen.h - finds the box of a volume outside which nothing is visible, and the smallest type of voxel
 * that holds the volume's values exactly. */
#ifndef HL_PAGE_SEEN_H
#define HL_PAGE_SEEN_H

#include <halflight/scene.h>

/* Sets in the options, which hold defaults, the box of voxels to write, and the voxel type of 8 bits if this
 * type holds all values. For a volume on which another volume's transfer function depends, the box is the
 * whole volume. */
hl_status hl_seen_part(hl_context *context, const hl_scene *scene, size_t number,
                       hl_volume_save_options *options, hl_error *error);

#endif
