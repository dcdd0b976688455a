/* page/seen.h - the part of a volume that shows anything, and the type of voxel that holds its values. */
#ifndef HL_PAGE_SEEN_H
#define HL_PAGE_SEEN_H

#include <halflight/scene.h>

/* Sets the box, and the type where 8 bits hold all values, of options that are filled with defaults. Volumes
 * that another volume's transfer function depends on stay whole. */
hl_status hl_seen_part(hl_context *context, const hl_scene *scene, size_t number,
                       hl_volume_save_options *options, hl_error *error);

#endif
