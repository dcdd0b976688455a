/* page/seen.h - finds the box of a volume outside which nothing is visible, and the smallest type of voxel
 * that holds the volume's values exactly. */
#ifndef HL_PAGE_SEEN_H
#define HL_PAGE_SEEN_H

#include <halflight/scene.h>

/* Sets in the options, which are filled with defaults, the box that is written, and the type if 8 bits hold
 * all values. A volume that another volume's transfer function depends on stays whole. */
hl_status hl_seen_part(hl_context *context, const hl_scene *scene, size_t number,
                       hl_volume_save_options *options, hl_error *error);

#endif
