/* json/parts.h - readers of the parts of a scene. Each leaves what is absent at its default. */
#ifndef HL_JSON_PARTS_H
#define HL_JSON_PARTS_H

#include "json/read.h"

/* The image that a light projects (null: none); its pixels and file name are owned by *texture. */
hl_status hl_json_read_texture(hl_json_reader *reader, const json_t *value, hl_light_texture *texture);

/* The image on a light's own surface (null: none); its pixels and file name are owned by *emission. */
hl_status hl_json_read_emission(hl_json_reader *reader, const json_t *value, hl_light_type type,
                                hl_light_emission *emission);

/* One light, with its texture: hl_light_images_release(). */
hl_status hl_json_read_light(hl_json_reader *reader, const json_t *value, hl_light *light);

/* A volume that a scene has, found again when it is there twice. */
typedef struct hl_loaded_volume {
  char *source;      /* owned; the file's path, or the text of its shapes */
  const char *array; /* how a file was read; the tree's */
  int component, time, channel, level;
  const char *series;
  double spacing[3];
  hl_volume *volume; /* owned */
} hl_loaded_volume;

/* What the volumes of one scene share. */
typedef struct hl_volume_shelf {
  hl_loaded_volume *loaded; /* owned; [count], with room for one more whenever a volume is read */
  size_t count;
  const json_t *groups; /* of shapes; may be null */
  json_t *stood_in;     /* owned; the volumes that were read with their stand-in's keys; null: none */
  bool projected;       /* the scene shows their greatest values */
  int threads;          /* to sample shapes with; 0: one per processor */
} hl_volume_shelf;

/* One volume: texts are the tree's, except file and shapes, which are the loaded volume's source; the volume
 * is borrowed from the shelf; the transfer function's points are owned by *volume. */
hl_status hl_json_read_volume(hl_json_reader *reader, const json_t *value, hl_volume_shelf *shelf,
                              hl_scene_volume *volume);

/* What a transfer function is for: adapts to the volume (null: nothing can adapt), is solid for shapes, greys
 * for maximum projections. */
typedef struct hl_function_subject {
  const hl_volume *volume;
  bool is_solid;
  bool projected; /* by its greatest values */
} hl_function_subject;

/* value null: the subject's default, which is automatic where it is not solid. */
hl_status hl_json_read_transfer_function(hl_json_reader *reader, const json_t *value,
                                         hl_function_subject subject, hl_transfer_function *function);

#endif
