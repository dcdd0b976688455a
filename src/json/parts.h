/* json/parts.h - reads the parts of a scene. A setting whose key is absent keeps its default. */
#ifndef HL_JSON_PARTS_H
#define HL_JSON_PARTS_H

#include <halflight/settings.h>

#include "json/read.h"
#include "json/text_writer.h"
#include "scene/check/limits.h"

/* The members of a struct into which an image is loaded. */
typedef struct hl_json_image {
  const char **file;
  const float **pixels; /* [height][width][channels]; receives the pixels */
  int *width, *height;
  int channels; /* number of channels: 3 for colours over black, 4 for premultiplied colours and alpha */
} hl_json_image;

/* Loads the image that an object's "file" names, or takes it from the reader's `like`. The image's file name
 * and pixels are owned by the caller, also after a failure. */
hl_status hl_json_load_image(hl_json_reader *reader, const json_t *value, const hl_json_image *to);

/* Reads the object "sky" of a scene. value: null if the scene has no sky. The sky's image is released by
 * hl_json_release_sky(), also after a failure. */
hl_status hl_json_read_sky(hl_json_reader *reader, const json_t *value, hl_sky *sky);
void hl_json_release_sky(hl_context *context, hl_sky *sky);

/* Reads the image that a light projects. value: null if the light has no such image. The image's pixels and
 * file name are owned by *texture. */
hl_status hl_json_read_texture(hl_json_reader *reader, const json_t *value, hl_light_texture *texture);

/* Reads the image on a light's own surface. value: null if the light has no such image. The image's pixels
 * and file name are owned by *emission. */
hl_status hl_json_read_emission(hl_json_reader *reader, const json_t *value, bool has_edges,
                                hl_light_emission *emission);

/* Reads one light. Its vertices (hl_release) and images (hl_light_images_release) are owned by *light. */
hl_status hl_json_read_light(hl_json_reader *reader, const json_t *value, hl_light *light);

/* A volume that was read for the scene. The volume is kept, so that a file that the scene names twice is read
 * only once. */
typedef struct hl_loaded_volume {
  char *source;      /* owned; the file's path, or the text of its shapes */
  const char *array; /* the options with which the file was loaded; texts are owned by the JSON tree */
  int component, time, channel, level;
  const char *series;
  double spacing[3];
  const char *file_space;
  int preview_pixels; /* see hl_volume_load_options */
  double smooth;      /* the standard deviation by which the voxels were smoothed */
  hl_volume *volume;  /* owned; the volume that was read */
} hl_loaded_volume;

/* The data that the readers of one scene's volumes share. */
typedef struct hl_volume_shelf {
  /* owned; [count]; the volumes that were read so far. There is room for one more volume whenever a volume is
   * read */
  hl_loaded_volume *loaded;
  size_t count;
  const json_t *groups; /* the groups of shapes in the scene; may be null */
  json_t *stood_in;     /* owned; for each volume whose file was absent, a copy of its JSON with the keys of
                         * its stand-in; null if no file was absent */
  hl_space space;       /* the scene's space, which is the space of the first volume that states one; later
                         * volumes are turned into it */
  bool projected;       /* whether the picture is a maximum projection */
  int threads;          /* threads for sampling shapes; 0 for one per processor */
} hl_volume_shelf;

/* Reads one volume. Its texts are borrowed from the JSON tree. Its voxels, file and shapes are borrowed from
 * the shelf. The transfer function's points are owned by *volume. */
hl_status hl_json_read_volume(hl_json_reader *reader, const json_t *value, hl_volume_shelf *shelf,
                              hl_scene_volume *volume);

/* Reads the keys "labels" and "label_table" of a volume whose voxels have been read. Labels
 * (hl_labels_release) and transfer function are owned by *volume. */
hl_status hl_json_read_labels(hl_json_reader *reader, const json_t *object, hl_scene_volume *volume);

/* Reads the labels like hl_json_read_labels(), without a transfer function. */
hl_status hl_json_read_label_list(hl_json_reader *reader, const json_t *object, hl_scene_volume *volume);

/* Puts the volumes of the reader's `like` on the shelf, which must have room for them. */
hl_status hl_json_shelve_known(hl_json_reader *reader, hl_volume_shelf *shelf);

/* The path of a file that the scene names: in the data folder for "data:...", else relative to the scene's
 * folder. Owned by the caller (hl_release); null if memory is short. */
char *hl_json_path(const hl_json_reader *reader, const char *file);

/* Reads the object "transform" of a volume or a mesh. value: null if there is no such object. kind: the table
 * of the object's keys. */
hl_status hl_json_read_transform(hl_json_reader *reader, const json_t *value, hl_setting_kind kind,
                                 void *target);

/* The meshes of one scene. Floors are the last ones in the list. The names are borrowed from the JSON
 * tree. */
typedef struct hl_mesh_shelf {
  /* owned, with their file names and triangles; [count + floor_count]; the meshes, and after them places for
   * the floors */
  hl_scene_mesh *meshes;
  double *floor_sizes; /* owned; [floor_count]; the sizes of the floors */
  size_t count;        /* number of meshes that are made */
  size_t floor_count;  /* number of floors. They follow the other meshes in the list. They are made when the
                        * camera is known, because their place depends on the camera */
} hl_mesh_shelf;

/* Reads the array "meshes" of a scene. value: null if there is no such array. For floors, only the properties
 * are read. The shelf is released by hl_json_release_meshes(), also after a failure. */
hl_status hl_json_read_meshes(hl_json_reader *reader, const json_t *value, hl_mesh_shelf *shelf);

/* Makes the floors of a scene. They lie below its volumes and below its other meshes. shelf: the scene's
 * meshes. */
hl_status hl_json_add_floors(hl_json_reader *reader, const hl_scene_description *scene, hl_mesh_shelf *shelf);

/* Reads the arrays of a mesh that the scene itself lists: "vertices", "triangles", "spheres", "lines" and
 * their colours. *mesh is owned by the caller. */
hl_status hl_json_read_mesh_arrays(hl_json_reader *reader, const json_t *value, hl_mesh **mesh);

/* The keys of a mesh's arrays; null ends the list. */
extern const char *const hl_json_mesh_keys[];
void hl_json_release_meshes(hl_context *context, hl_mesh_shelf *shelf);

/* Reads the array "cuts" of a volume or a scene. value: null if there is no such array. *cuts is owned by the
 * caller (hl_release), also after a failure. */
hl_status hl_json_read_cuts(hl_json_reader *reader, const json_t *value, const hl_cut **cuts, size_t *count);

/* Reads the array "marks" of a scene. value: null if there is no such array. *marks is owned by the caller
 * (hl_marks_release), also after a failure. */
hl_status hl_json_read_marks(hl_json_reader *reader, const json_t *value, const hl_mark **marks,
                             size_t *count);

/* Writes the member "marks" of a scene, if the scene has marks. */
void hl_json_write_marks(hl_json_writer *w, const hl_mark *marks, size_t count);

/* Reads the array "iso" of a volume. value: null if there is no such array. The surfaces are owned by
 * *volume. */
hl_status hl_json_read_iso(hl_json_reader *reader, const json_t *value, hl_scene_volume *volume);

/* Makes a transfer function that shows nothing. Its points are owned by *function. */
hl_status hl_json_clear_function(hl_json_reader *reader, const hl_volume *volume,
                                 hl_transfer_function *function);

/* The range of values over which a transfer function spreads. */
typedef struct hl_json_range {
  bool given; /* whether a key of the function gives the range */
  double ends[2];
  hl_range_scale scale;
} hl_json_range;

/* Reads the keys "range" (numbers or percentiles) and "scale" of a transfer function. The default is the
 * volume's range. If volume is null, the default is 0 to 1, and percentiles are refused. */
hl_status hl_json_read_range(hl_json_reader *reader, const json_t *value, const hl_volume *volume,
                             hl_json_range *range);

/* The facts on which the default of a transfer function depends: the volume, and the way in which it is
 * shown. */
typedef struct hl_function_subject {
  /* the volume; null if a file holds only a function, so that functions that depend on the voxels are
   * refused */
  const hl_volume *volume;
  bool is_solid;  /* whether the volume is made of shapes; the default is then an opaque solid */
  bool projected; /* whether the picture is a maximum projection; the default is then a ramp of
                   * greys */
} hl_function_subject;

/* Reads a transfer function. If value is null, the result is the subject's default: an opaque solid, a ramp
 * of greys for a maximum projection, or else the automatic function. */
hl_status hl_json_read_transfer_function(hl_json_reader *reader, const json_t *value,
                                         hl_function_subject subject, hl_transfer_function *function);

/* Reads an array of rows of `width` numbers. *rows is owned by the caller (hl_release). */
hl_status hl_json_read_rows(hl_json_reader *reader, const json_t *object, const char *key, size_t width,
                            double **rows, size_t *count);

/* Reads the keys "second", "boxes", "polygons", "image" and "curves" of a transfer function that has
 * "second". The result is owned by *plane (hl_plane_release), also after a failure. */
hl_status hl_json_read_plane(hl_json_reader *reader, const json_t *value, hl_function_plane *plane);

/* Reads ParaView's colour map, an array of one object. The points are owned by *function. */
hl_status hl_json_read_paraview(hl_json_reader *reader, const json_t *root, hl_transfer_function *function);
/* Reads the object within ParaView's colour map: ColorSpace, HSVWrap, UseLogScale, RGBPoints and, if the
 * object has opacities, Points. */
hl_status hl_json_read_paraview_map(hl_json_reader *reader, const json_t *map,
                                    hl_transfer_function *function);

#endif
