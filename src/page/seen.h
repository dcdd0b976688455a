/* page/seen.h - the box of a volume outside which nothing is visible, and the smallest type of voxel that
 * holds its values exactly. */
#ifndef HL_PAGE_SEEN_H
#define HL_PAGE_SEEN_H

#include <halflight/scene.h>

/* Sets the box, and the type where 8 bits hold all values, of options that are filled with defaults. Volumes
 * that another volume's transfer function depends on stay whole. */
hl_status hl_seen_part(hl_context *context, const hl_scene *scene, size_t number,
                       hl_volume_save_options *options, hl_error *error);

#endif
