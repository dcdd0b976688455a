/* json/writable.h - which scenes a text can describe. */
#ifndef HL_JSON_WRITABLE_H
#define HL_JSON_WRITABLE_H

#include <halflight/scene.h>

/* Refuses scenes that a text cannot describe: voxels or pixels without a file, names that are not UTF-8. */
hl_status hl_json_check_writable(const hl_scene_description *description, hl_error *error);

#endif
