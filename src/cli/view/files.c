/* cli/view/files.c - see files.h. */
#define _GNU_SOURCE
#include "files.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/input.h"
#include "cli/output.h"
#include "start/joined.h"
#include "text/plain.h"

/* ---- names ---- */

/* The absolute path of a file, owned by the caller. A text that names no file is copied as it is. */
static char *absolute_path(const char *file) {
  char *path = strncmp(file, "/dev/", 5) == 0 ? NULL : realpath(file, NULL);
  return path != NULL ? path : strdup(file);
}

/* The absolute path of a file in a folder, owned by the caller. */
static char *path_below(const char *folder, const char *file) {
  char *path = NULL;
  if (strcmp(file, ".") == 0) return strdup(folder);
  return asprintf(&path, "%s/%s", strcmp(folder, "/") == 0 ? "" : folder, file) >= 0 ? path : NULL;
}

enum { MOST_PATHS = 1024 };

/* The absolute paths of a description's files. The description borrows them. */
typedef struct path_list {
  const char *folder; /* the folder to which relative names are relative; null stands for the current
                       * folder */
  char *paths[MOST_PATHS];
  size_t count;
} path_list;

static bool make_absolute(const char **file, path_list *list) {
  if (*file == NULL) return true;
  if (list->count == MOST_PATHS) return false;
  char *path = list->folder != NULL ? path_below(list->folder, *file) : absolute_path(*file);
  if (path == NULL) return false;
  list->paths[list->count] = path;
  *file = list->paths[list->count++];
  return true;
}

hl_status view_name_absolutely(hl_context *context, const char *folder, hl_scene **scene, hl_error *error) {
  hl_scene_description d = *hl_scene_describe(*scene);
  hl_scene_volume *volumes = malloc(d.volume_count * sizeof *volumes + 1);
  hl_light *lights = malloc(d.light_count * sizeof *lights + 1);
  hl_scene_mesh *meshes = malloc(d.mesh_count * sizeof *meshes + 1);
  path_list *list = calloc(1, sizeof *list);
  bool good = volumes != NULL && lights != NULL && meshes != NULL && list != NULL;
  if (good) list->folder = folder;
  for (size_t v = 0; good && v < d.volume_count; v++) {
    volumes[v] = d.volumes[v];
    good = make_absolute(&volumes[v].file, list) && make_absolute(&volumes[v].mask.file, list) &&
           make_absolute(&volumes[v].transfer_function.plane.image.file, list);
  }
  for (size_t l = 0; good && l < d.light_count; l++) {
    lights[l] = d.lights[l];
    good = make_absolute(&lights[l].texture.file, list) && make_absolute(&lights[l].emission.file, list);
  }
  for (size_t m = 0; good && m < d.mesh_count; m++) {
    meshes[m] = d.meshes[m];
    good = make_absolute(&meshes[m].file, list);
  }
  good = good && make_absolute(&d.sky.file, list);
  d.volumes = volumes;
  d.meshes = meshes;
  d.lights = lights;
  hl_scene *named = NULL;
  hl_status status = good ? hl_scene_create(context, &d, &named, error) : HL_ERROR_MEMORY;
  if (!good) snprintf(error->message, sizeof error->message, "out of memory for the scene's paths");
  if (status == HL_OK) {
    hl_scene_release(*scene);
    *scene = named;
  }
  for (size_t p = 0; list != NULL && p < list->count; p++) free(list->paths[p]);
  free(list);
  free(meshes);
  free(lights);
  free(volumes);
  return status;
}

/* ---- files that pages open ---- */

/* A volume of several resolutions is read like the volumes of the command line. A dropped file is read at its
 * finest resolution at once, because it does not exist any more when finer resolutions could be read. */
static hl_status for_volume(hl_context *context, const server_file *file, const char *path, hl_scene **scene,
                            hl_error *error) {
  hl_volume *volume = NULL;
  hl_volume_load_options options;
  hl_volume_load_options_defaults(&options);
  options.pixels = input_picture_side();
  options.series = file->series;
  if (file->folder != NULL) options.preview_pixels = VIEW_PREVIEW_PIXELS;
  hl_status status = hl_volume_load_with(file->confined, file->name, &options, &volume, error);
  if (status == HL_OK) status = hl_scene_for_volume(context, volume, path, scene, error);
  if (status == HL_OK) status = input_name_scene(context, &options, scene, error);
  hl_volume_release(volume);
  return status;
}

static hl_status for_mesh(hl_context *context, const server_file *file, const char *path, hl_scene **scene,
                          hl_error *error) {
  hl_scene_mesh mesh;
  hl_status status = load_mesh(file->confined, file->name, 0, &mesh, error);
  mesh.file = path;
  if (status == HL_OK) status = join_meshes(context, &mesh, 1, true, scene, error);
  hl_mesh_release(mesh.mesh);
  return status;
}

/* If an error names the folder that was opened as ".", replaces this by the folder's own name. */
static void name_folder(const server_file *file, hl_error *error) {
  const char *slash = file->folder != NULL ? strrchr(file->folder, '/') : NULL;
  char rest[sizeof error->message];
  if (slash == NULL || strcmp(file->name, ".") != 0 || error->message[0] != '.' ||
      strchr(":/", error->message[1]) == NULL)
    return;
  snprintf(rest, sizeof rest, "%s", error->message + 1);
  snprintf(error->message, sizeof error->message, "%.300s%.600s", slash + 1, rest);
}

hl_status view_open_file(void *user_data, const server_file *file, hl_scene **scene, hl_error *error) {
  hl_context *context = user_data;
  if (has_extension(file->name, ".json")) {
    hl_status status = hl_scene_load(file->confined, file->name, scene, error);
    return status == HL_OK && file->folder != NULL ? view_name_absolutely(context, file->folder, scene, error)
                                                   : status;
  }
  char *path = file->folder != NULL ? path_below(file->folder, file->name) : strdup(file->name);
  if (path == NULL) {
    snprintf(error->message, sizeof error->message, "out of memory for a path");
    return HL_ERROR_MEMORY;
  }
  *scene = NULL;
  hl_status status = is_mesh_file(file->confined, file->name) ? for_mesh(context, file, path, scene, error)
                                                              : for_volume(context, file, path, scene, error);
  if (status != HL_OK) name_folder(file, error);
  free(path);
  return status;
}

/* ---- finer resolutions ---- */

/* Reads a scene's volume at a finer resolution, from its absolute path. Nothing outside of the file's folder
 * is read, as when a page opens the file. *finer: null if the volume has the wanted resolution already. */
static hl_status read_finer(hl_context *context, const hl_scene_description *scene, size_t number,
                            hl_finer which, hl_volume **finer, hl_error *error) {
  hl_context *confined = NULL;
  const char *path = scene->volumes[number].file;
  const hl_camera *camera = which == HL_FINER_PIXELS ? &scene->camera : NULL;
  const size_t cameras = camera != NULL;
  if (path == NULL) return HL_OK;
  if (hl_plain_is_url(path))
    return hl_volume_read_finer(context, path, scene, number, camera, cameras, which, finer, error);
  if (path[0] != '/') return HL_OK; /* the file was dropped on the page, and does not exist any more */
  const char *name = base_name(path);
  char *folder = strndup(path, (size_t)(name - path));
  if (folder == NULL) {
    snprintf(error->message, sizeof error->message, "out of memory for a path");
    return HL_ERROR_MEMORY;
  }
  hl_status status = hl_context_confine(context, folder, &confined, error);
  if (status == HL_OK)
    status = hl_volume_read_finer(confined, name, scene, number, camera, cameras, which, finer, error);
  hl_context_destroy(confined);
  free(folder);
  return status;
}

static int level_of(const hl_volume *volume) {
  hl_volume_selection read = {.struct_size = sizeof read};
  return hl_volume_get_selection(volume, &read) == HL_OK ? read.level : HL_INDEX_DEFAULT;
}

/* Makes a scene whose volumes are read at finer resolutions. *finer: null if no volume was read. */
static hl_status refine_scene(hl_context *context, const hl_scene *scene, hl_finer which, hl_scene **finer,
                              hl_error *error) {
  hl_scene_description d = *hl_scene_describe(scene);
  hl_scene_volume *volumes = malloc(d.volume_count * sizeof *volumes + 1);
  hl_volume **read = calloc(d.volume_count + 1, sizeof *read);
  bool any = false;
  hl_status status = volumes != NULL && read != NULL ? HL_OK : HL_ERROR_MEMORY;
  if (status != HL_OK) snprintf(error->message, sizeof error->message, "out of memory for a list of volumes");
  for (size_t v = 0; status == HL_OK && v < d.volume_count; v++) {
    volumes[v] = d.volumes[v];
    status = read_finer(context, hl_scene_describe(scene), v, which, &read[v], error);
    any = any || read[v] != NULL;
    if (read[v] != NULL) volumes[v].volume = read[v];
    if (read[v] != NULL && which == HL_FINER_PIXELS) volumes[v].level = level_of(read[v]);
  }
  d.volumes = volumes;
  if (status == HL_OK && any) status = hl_scene_create(context, &d, finer, error);
  for (size_t v = 0; read != NULL && v < d.volume_count; v++) hl_volume_release(read[v]);
  free(read);
  free(volumes);
  return status;
}

hl_status view_refine_scene(void *user_data, const hl_scene *scene, hl_scene **finer, hl_error *error) {
  return refine_scene(user_data, scene, HL_FINER_NEXT, finer, error);
}

hl_status view_read_seen(void *user_data, const hl_scene *scene, hl_scene **seen, hl_error *error) {
  return refine_scene(user_data, scene, HL_FINER_PIXELS, seen, error);
}
