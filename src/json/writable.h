/* json/writable.h - tests whether a text can describe a scene. */
#ifndef HL_JSON_WRITABLE_H
#define HL_JSON_WRITABLE_H

#include <halflight/scene.h>

/* Refuses scenes that a text cannot describe, because they have voxels or pixels without a file, or names
 * that are not UTF-8. */
hl_status hl_json_check_writable(const hl_scene_description *description, hl_error *error);

#endif
