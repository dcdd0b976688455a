/* json/parts.h - readers of a scene's parts. A key that is absent keeps its default. */
#ifndef HL_JSON_PARTS_H
#define HL_JSON_PARTS_H

#include <halflight/settings.h>

#include "json/read.h"
#include "scene/limits.h"

/* The fields that an image is loaded into. */
typedef struct hl_json_image {
  const char **file;
  const float **pixels; /* [height][width][channels] */
  int *width, *height;
  int channels; /* 3: colours over black; 4: premultiplied colours and alpha */
} hl_json_image;

/* Loads the image that an object's "file" names, or takes it from the reader's `like`. Its file's name and
 * pixels are owned by the caller, after a failure too. */
hl_status hl_json_load_image(hl_json_reader *reader, const json_t *value, const hl_json_image *to);

/* The object "sky" (null: none). Its image is released by hl_json_release_sky(), after a failure too. */
hl_status hl_json_read_sky(hl_json_reader *reader, const json_t *value, hl_sky *sky);
void hl_json_release_sky(hl_context *context, hl_sky *sky);

/* The image that a light projects (null: none); its pixels and file name are owned by *texture. */
hl_status hl_json_read_texture(hl_json_reader *reader, const json_t *value, hl_light_texture *texture);

/* The image on a light's own surface (null: none); its pixels and file name are owned by *emission. */
hl_status hl_json_read_emission(hl_json_reader *reader, const json_t *value, hl_light_type type,
                                hl_light_emission *emission);

/* One light. Its vertices (hl_release) and images (hl_light_images_release) are owned by *light. */
hl_status hl_json_read_light(hl_json_reader *reader, const json_t *value, hl_light *light);

/* A volume that was read for the scene, kept so that a volume that is named twice is read once. */
typedef struct hl_loaded_volume {
  char *source;      /* owned; the file's path, or the text of its shapes */
  const char *array; /* the options for loading the file; texts owned by the JSON tree */
  int component, time, channel, level;
  const char *series;
  double spacing[3];
  hl_volume *volume; /* owned */
} hl_loaded_volume;

/* Data that the volumes of one scene share. */
typedef struct hl_volume_shelf {
  hl_loaded_volume *loaded; /* owned; [count], with room for one more whenever a volume is read */
  size_t count;
  const json_t *groups; /* of shapes; may be null */
  json_t *stood_in; /* owned; volumes whose file was absent, with the keys of their stand-ins; null: none */
  hl_space space;   /* of the first volume that tells one: the scene's; later volumes are turned into it */
  bool projected;   /* the picture is a maximum projection */
  int threads;      /* for sampling shapes; 0: one per processor */
} hl_volume_shelf;

/* Reads one volume. Its texts are borrowed from the JSON tree, its voxels, file and shapes from the shelf;
 * the transfer function's points are owned by *volume. */
hl_status hl_json_read_volume(hl_json_reader *reader, const json_t *value, hl_volume_shelf *shelf,
                              hl_scene_volume *volume);

/* The keys "labels" and "label_table" of a volume whose voxels are read; its labels (hl_labels_release) and
 * transfer function are owned by *volume. */
hl_status hl_json_read_labels(hl_json_reader *reader, const json_t *object, hl_scene_volume *volume);

/* The same without a transfer function. */
hl_status hl_json_read_label_list(hl_json_reader *reader, const json_t *object, hl_scene_volume *volume);

/* Puts the volumes of the reader's `like` on the shelf, which has room for them. */
hl_status hl_json_shelve_known(hl_json_reader *reader, hl_volume_shelf *shelf);

/* The path of a file that the scene names: in the data folder for "data:...", else relative to the scene's
 * folder. Owned by the caller (hl_release); null without memory. */
char *hl_json_path(const hl_json_reader *reader, const char *file);

/* The object "transform" (null: none) of a volume or a mesh; kind: the table that its keys are in. */
hl_status hl_json_read_transform(hl_json_reader *reader, const json_t *value, hl_setting_kind kind,
                                 void *target);

/* The meshes that are read for one scene, floors last. Their names are borrowed from the JSON tree. */
typedef struct hl_mesh_shelf {
  hl_scene_mesh *meshes; /* owned, with their files and triangles; [count + floor_count] */
  double *floor_sizes;   /* owned; [floor_count] */
  size_t count;          /* that are made */
  size_t floor_count; /* that are not made yet: their place depends on the camera; they follow the others */
} hl_mesh_shelf;

/* The array "meshes" (null: none), but for its floors. The shelf is released by hl_json_release_meshes(),
 * after a failure too. */
hl_status hl_json_read_meshes(hl_json_reader *reader, const json_t *value, hl_mesh_shelf *shelf);

/* Makes the floors, below the scene's volumes and the shelf's other meshes. */
hl_status hl_json_add_floors(hl_json_reader *reader, const hl_scene_description *scene, hl_mesh_shelf *shelf);

/* The arrays of a mesh that a scene gives itself: "vertices", "triangles", "spheres", "lines" and their
 * colours. *mesh is owned by the caller. */
hl_status hl_json_read_mesh_arrays(hl_json_reader *reader, const json_t *value, hl_mesh **mesh);

/* The keys of these arrays; ends with null. */
extern const char *const hl_json_mesh_keys[];
void hl_json_release_meshes(hl_context *context, hl_mesh_shelf *shelf);

/* The array "cuts" (null: none) of a volume or a scene; *cuts is owned by the caller (hl_release), after a
 * failure too. */
hl_status hl_json_read_cuts(hl_json_reader *reader, const json_t *value, const hl_cut **cuts, size_t *count);

/* The array "iso" (null: none) of a volume; the surfaces are owned by *volume. */
hl_status hl_json_read_iso(hl_json_reader *reader, const json_t *value, hl_scene_volume *volume);

/* A transfer function that shows nothing. Its points are owned by *function. */
hl_status hl_json_clear_function(hl_json_reader *reader, const hl_volume *volume,
                                 hl_transfer_function *function);

/* The values that a transfer function spreads over. */
typedef struct hl_json_range {
  bool given; /* by at least one of its keys */
  double ends[2];
  hl_range_scale scale;
} hl_json_range;

/* The keys "range", of numbers and percentiles, and "scale" of a transfer function. Default: the range of the
 * volume; volume null: 0 to 1, and percentiles are refused. */
hl_status hl_json_read_range(hl_json_reader *reader, const json_t *value, const hl_volume *volume,
                             hl_json_range *range);

/* The volume that a transfer function is read for. */
typedef struct hl_function_subject {
  const hl_volume *volume; /* null: a file of its own; functions that depend on the voxels are refused */
  bool is_solid;           /* made of shapes: the default is an opaque solid */
  bool projected;          /* in a maximum projection: the default is a ramp of greys */
} hl_function_subject;

/* value null: the subject's default; automatic where it is neither solid nor projected. */
hl_status hl_json_read_transfer_function(hl_json_reader *reader, const json_t *value,
                                         hl_function_subject subject, hl_transfer_function *function);

/* The keys "second", "boxes", "polygons" and "image" of a transfer function that has the first of them. What
 * it makes is owned by *plane (hl_plane_release), after a failure, too. */
hl_status hl_json_read_plane(hl_json_reader *reader, const json_t *value, hl_function_plane *plane);

/* ParaView's colour map: an array of one object. The points are owned by *function. */
hl_status hl_json_read_paraview(hl_json_reader *reader, const json_t *root, hl_transfer_function *function);
/* The object within: ColorSpace, HSVWrap, UseLogScale, RGBPoints and, where it has opacities, Points. */
hl_status hl_json_read_paraview_map(hl_json_reader *reader, const json_t *map,
                                    hl_transfer_function *function);

#endif
