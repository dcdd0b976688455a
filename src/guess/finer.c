/* guess/finer.c - reads the volumes of a scene at finer resolutions, where cameras see them.
 *
 * In: a scene whose volumes were read at a coarse resolution, and the cameras of its pictures. Out: the
 * volumes, or the scene, at a finer resolution. A volume is read with the options that the scene names, and
 * smoothed as a bare volume is. */
#include <halflight/resolutions.h>
#include <math.h>
#include <string.h>

#include "core/context.h"
#include "core/door.h"
#include "core/memory.h"
#include "elementary/elementary.h"
#include "guess/analysis.h"
#include "guess/for_volume.h"
#include "scene/geometry/placement.h"
#include "scene/scene.h"
#include "volume/volume.h"

/* Finds which resolution was read. Returns false if a finer resolution is not wanted, or cannot be read. */
static bool is_coarse(const hl_scene_volume *volume, hl_volume_selection *read) {
  *read = (hl_volume_selection){.struct_size = sizeof *read};
  return hl_volume_get_selection(volume->volume, read) == HL_OK && read->level > read->aim;
}

int hl_scene_is_coarse(const hl_scene_description *description) {
  HL_DOOR;
  hl_volume_selection read;
  for (size_t n = 0; description != NULL && n < description->volume_count; n++)
    if (is_coarse(&description->volumes[n], &read)) return 1;
  return 0;
}

/* ---- what cameras see ---- */

/* Brings planes from the scene's world to the world of the volume's file. Derived: n . (A p + t) + d
 * = (A' n) . p + (n . t + d), where A' is A transposed. */
static void bring_to_file(const hl_scene_volume *volume, double planes[4][4]) {
  const affine3 placed = hl_scene_volume_file_to_world(volume);
  for (int n = 0; n < 4; n++) {
    const vec3 normal = vec3_of(planes[n]);
    const vec3 brought = mat3_apply(mat3_transpose(placed.linear), normal);
    planes[n][3] += vec3_dot(normal, placed.offset);
    memcpy(planes[n], &brought, sizeof brought);
  }
}

/* Finds the planes around what each camera sees. *seen: null if all of the volume is read; owned by the
 * caller. */
static hl_status find_seen(hl_context *context, const hl_scene_description *description, size_t number,
                           const hl_camera *cameras, size_t count, double (**seen)[4][4], hl_error *error) {
  const hl_scene_volume *volume = &description->volumes[number];
  hl_data_analysis analysis;
  *seen = NULL;
  if (cameras == NULL || count == 0 || volume->label_count > 0) return HL_OK;
  hl_status status = hl_data_analyse(volume->volume, &analysis, error);
  if (status != HL_OK || hl_data_is_label_map(volume->volume, &analysis)) return status;
  hl_scene_description view = *description;
  *seen = hl_allocate(context, count, sizeof **seen);
  if (*seen == NULL) return hl_fail_memory(error, count * sizeof **seen, "what cameras see");
  for (size_t n = 0; n < count && status == HL_OK; n++) {
    view.camera = cameras[n];
    status = hl_scene_seen_part(&view, (*seen)[n]);
    if (status != HL_OK) status = hl_fail(error, status, "camera %zu: sees nothing", n);
    else bring_to_file(volume, (*seen)[n]);
  }
  return status;
}

/* ---- which resolution ---- */

/* The number of pixels of a camera's picture that the longest axis of a volume would cover at the camera's
 * target. */
static double pixels_along(const hl_scene_description *description, const hl_scene_volume *volume,
                           const hl_camera *camera) {
  const affine3 placed = hl_scene_volume_index_to_world(volume);
  const double tall = camera->type == HL_CAMERA_PERSPECTIVE
                          ? 2 * hl_tan(camera->fovy_deg * HL_PI / 360) *
                                vec3_length(vec3_subtract(vec3_of(camera->target), vec3_of(camera->position)))
                          : camera->height;
  double longest = 0;
  for (int axis = 0; axis < 3; axis++)
    longest = fmax(longest,
                   (double)volume->volume->dimension[axis] * vec3_length(mat3_column(placed.linear, axis)));
  return longest / tall * description->height;
}

/* The coarsest resolution that has a voxel for each pixel of the cameras' pictures. If the scene's volume has
 * enough voxels, its own resolution is returned. */
static int level_for_pixels(const hl_scene_description *description, const hl_scene_volume *volume,
                            const hl_camera *cameras, size_t count, int level) {
  const hl_resolutions *known = &volume->volume->resolutions;
  double pixels = 0;
  for (size_t n = 0; n < count; n++) pixels = fmax(pixels, pixels_along(description, volume, &cameras[n]));
  while (level > known->finest && level < HL_RESOLUTIONS_MOST && (double)known->longest[level] < pixels)
    level--;
  return level;
}

int hl_volume_level_for(const hl_scene_description *description, size_t number, const hl_camera *cameras,
                        size_t camera_count) {
  HL_DOOR;
  if (description == NULL || cameras == NULL || number >= description->volume_count) return HL_INDEX_DEFAULT;
  const hl_scene_volume *volume = &description->volumes[number];
  const int level = volume->volume->selection.level;
  if (volume->volume->resolutions.is_chosen || volume->label_count > 0 || volume->volume->says_labels)
    return level;
  return level_for_pixels(description, volume, cameras, camera_count, level);
}

/* Finds the resolution at which a volume is to be read. Returns false if the volume has this resolution
 * already. */
static bool find_level(const hl_scene_description *description, size_t number, const hl_camera *cameras,
                       size_t count, hl_finer which, hl_volume_selection *read) {
  const bool is_coarser = is_coarse(&description->volumes[number], read);
  if (which != HL_FINER_PIXELS) return is_coarser;
  read->aim = hl_volume_level_for(description, number, cameras, count);
  return read->level > read->aim;
}

/* ---- one volume ---- */

/* Finds the options with which a volume is read again, at the resolution read->aim or at the next finer
 * one. */
static void find_options(const hl_scene_volume *volume, const hl_volume_selection *read, bool by_step,
                         hl_volume_load_options *options) {
  hl_volume_load_options_defaults(options);
  options->array = volume->array;
  options->series = volume->series;
  options->component = volume->component;
  memcpy(options->spacing, volume->spacing, sizeof options->spacing);
  options->file_space = volume->file_space;
  options->space = volume->volume->space;
  options->level = read->aim;
  if (read->times > 1) options->time = read->time;
  if (read->channels > 1) options->channel = read->channel;
  if (!by_step) return;
  /* the next finer resolution is the coarsest one that has more voxels */
  for (int axis = 0; axis < 3; axis++)
    if (volume->volume->dimension[axis] >= (size_t)options->preview_pixels)
      options->preview_pixels = (int)volume->volume->dimension[axis] + 1;
}

/* Replaces a finer volume by a smoothed volume, if the coarse volume was smoothed, or if the voxels need
 * smoothing and are not shown as a maximum projection. */
static hl_status smooth(const hl_scene_volume *volume, bool projected, hl_volume **finer, hl_error *error) {
  hl_volume *smoothed = NULL;
  hl_status status = volume->volume->smoothing > 0
                         ? hl_volume_smooth(*finer, volume->volume->smoothing, &smoothed, error)
                     : projected || atomic_load(&volume->volume->smoothing_chosen)
                         ? HL_OK
                         : hl_smooth_where_needed(*finer, volume->file, &smoothed, error);
  if (status == HL_OK && smoothed == NULL) return HL_OK;
  hl_volume_release(*finer);
  *finer = smoothed;
  return status;
}

hl_status hl_volume_read_finer(hl_context *context, const char *path, const hl_scene_description *description,
                               size_t number, const hl_camera *cameras, size_t camera_count, hl_finer which,
                               hl_volume **finer, hl_error *error) {
  HL_DOOR;
  if (context == NULL || description == NULL || finer == NULL || number >= description->volume_count ||
      (which == HL_FINER_PIXELS && (cameras == NULL || camera_count == 0)))
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "hl_volume_read_finer: null context, description or finer, no such volume, or no camera");
  const hl_scene_volume *volume = &description->volumes[number];
  hl_volume_selection read;
  hl_volume_load_options options;
  double(*seen)[4][4] = NULL;
  *finer = NULL;
  if (path == NULL) path = volume->file;
  if (path == NULL || !find_level(description, number, cameras, camera_count, which, &read)) return HL_OK;
  hl_status status = find_seen(context, description, number, cameras, camera_count, &seen, error);
  if (status == HL_OK) {
    find_options(volume, &read, which == HL_FINER_NEXT, &options);
    options.seen = (const double(*)[4][4])seen;
    options.seen_count = seen != NULL ? camera_count : 0;
    options.coarse = seen != NULL ? volume->volume : NULL;
    status = hl_volume_load_with(context, path, &options, finer, error);
  }
  hl_release(context, seen);
  if (status == HL_OK) {
    const bool is_part = (*finer)->resolutions.is_part;
    (*finer)->resolutions = volume->volume->resolutions;
    (*finer)->resolutions.is_part = is_part;
    atomic_store(&(*finer)->smoothing_chosen, atomic_load(&volume->volume->smoothing_chosen));
  }
  const bool projected = description->render.compositing == HL_COMPOSITING_MAXIMUM;
  return status == HL_OK ? smooth(volume, projected, finer, error) : status;
}

/* ---- a scene ---- */

/* A scene's volumes at finer resolutions, with their labels. */
typedef struct finer_volumes {
  hl_scene_volume *volumes; /* owned; [count] */
  hl_volume **read;         /* owned; [count] */
  hl_label **labels;        /* owned; [count] */
  size_t count;
} finer_volumes;

static hl_status read_each(hl_context *context, const hl_scene_description *description,
                           const hl_camera *cameras, size_t camera_count, finer_volumes *found,
                           hl_error *error) {
  hl_status status = HL_OK;
  for (size_t n = 0; n < found->count && status == HL_OK; n++) {
    hl_scene_volume *volume = &found->volumes[n];
    *volume = description->volumes[n];
    status = hl_volume_read_finer(context, NULL, description, n, cameras, camera_count, HL_FINER_ASKED,
                                  &found->read[n], error);
    if (status != HL_OK || found->read[n] == NULL) continue;
    volume->volume = found->read[n];
    if (volume->label_count == 0) continue;
    status = hl_labels_of_volume(context, volume->volume, NULL, &found->labels[n], &volume->label_count,
                                 error);
    volume->labels = found->labels[n];
  }
  return status;
}

static void release(hl_context *context, finer_volumes *found) {
  for (size_t n = 0; n < found->count; n++) {
    if (found->read != NULL) hl_volume_release(found->read[n]);
    if (found->labels != NULL) hl_labels_release(context, found->labels[n]);
  }
  hl_release(context, found->volumes);
  hl_release(context, found->read);
  hl_release(context, found->labels);
}

hl_status hl_scene_read_finer(hl_context *context, hl_scene *scene, const hl_camera *cameras,
                              size_t camera_count, hl_scene **finer, hl_error *error) {
  HL_DOOR;
  if (context == NULL || scene == NULL || finer == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_scene_read_finer: null context, scene or finer");
  hl_scene_description description = *hl_scene_describe(scene);
  *finer = NULL;
  if (!hl_scene_is_coarse(&description)) {
    hl_scene_retain(scene);
    *finer = scene;
    return HL_OK;
  }
  const size_t count = description.volume_count;
  finer_volumes found = {.count = count,
                         .volumes = hl_allocate_zeroed(context, count, sizeof *found.volumes),
                         .read = hl_allocate_zeroed(context, count, sizeof *found.read),
                         .labels = hl_allocate_zeroed(context, count, sizeof *found.labels)};
  hl_status status = found.volumes != NULL && found.read != NULL && found.labels != NULL
                         ? read_each(context, &description, cameras, camera_count, &found, error)
                         : hl_fail_memory(error, count * sizeof *found.volumes, "finer volumes");
  description.volumes = found.volumes;
  if (status == HL_OK) status = hl_scene_create(context, &description, finer, error);
  release(context, &found);
  return status;
}
