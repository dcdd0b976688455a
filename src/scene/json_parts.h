/* scene/json_parts.h - readers of the parts of a scene. Each leaves what is absent at its default. */
#ifndef HL_SCENE_JSON_PARTS_H
#define HL_SCENE_JSON_PARTS_H

#include "scene/json_read.h"

/* The camera (null: absent) of a description whose image and volumes are known: what is absent is framed. */
hl_status hl_json_read_camera(hl_json_reader *reader, const json_t *value, hl_scene_description *description);

/* The image that a light projects (null: none); its pixels and file name are owned by *texture. */
hl_status hl_json_read_texture(hl_json_reader *reader, const json_t *value, hl_light_texture *texture);

/* One light, with its texture: hl_light_texture_release(). */
hl_status hl_json_read_light(hl_json_reader *reader, const json_t *value, hl_light *light);

/* A volume that a scene names by file, found again when it is named twice. */
typedef struct hl_loaded_volume {
  char *path;        /* owned */
  hl_volume *volume; /* owned */
} hl_loaded_volume;

/* One volume: texts are the tree's, except file, which is the loaded volume's path; the volume is borrowed
 * from loaded[0 .. *loaded_count), which has room for one more; the transfer function's points are owned by
 * *volume. */
hl_status hl_json_read_volume(hl_json_reader *reader, const json_t *value, hl_loaded_volume *loaded,
                              size_t *loaded_count, hl_scene_volume *volume);

/* A transfer function for a volume (null: not known, so nothing can adapt to it). value null: automatic. */
hl_status hl_json_read_transfer_function(hl_json_reader *reader, const json_t *value, const hl_volume *volume,
                                         hl_transfer_function *function);

hl_status hl_json_read_render(hl_json_reader *reader, const json_t *value, hl_render_settings *render);

#endif
