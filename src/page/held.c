/* page/held.c - see held.h. */
#define _GNU_SOURCE
#include "page/held.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "core/context.h"
#include "core/file.h"
#include "core/memory.h"
#include "page/seen.h"
#include "platform/paths.h"
#include "volume/volume.h"

/* ---- files ---- */

/* Adds a file to the end of the list of held files. path: `held` takes over the text. */
static hl_status hold(held_scene *held, const char *stem, const char *ending, char *path, hl_error *error) {
  if (path == NULL || held->count == held->room) {
    hl_release(held->context, path);
    return hl_fail_memory(error, HELD_NAME_BYTES, "a file's name");
  }
  held_file *file = &held->files[held->count];
  snprintf(file->name, sizeof file->name, "%s%zu%.16s", stem, held->count, ending);
  file->path = path;
  held->count++;
  return HL_OK;
}

static hl_status make_folder(held_scene *held, hl_error *error) {
  const char *place = held->context->scratch_folder != NULL ? held->context->scratch_folder
                                                            : getenv("TMPDIR");
  if (held->folder != NULL) return HL_OK;
  held->folder = hl_path_join(held->context, place != NULL && *place != '\0' ? place : hl_temporary_folder(),
                              "halflight-page-XXXXXX");
  if (held->folder == NULL) return hl_fail_memory(error, 1, "a folder's name");
  if (mkdtemp(held->folder) != NULL) return HL_OK;
  hl_status status = hl_fail(error, HL_ERROR_IO, "%s: cannot make a folder: %s", held->folder,
                             strerror(errno));
  hl_release(held->context, held->folder);
  held->folder = NULL;
  return status;
}

/* Adds a file that will be written to the folder `held->folder`. The page will contain this file, too. */
static hl_status hold_new(held_scene *held, const char *stem, const char *ending, hl_error *error) {
  char name[HELD_NAME_BYTES];
  hl_status status = make_folder(held, error);
  if (status != HL_OK) return status;
  snprintf(name, sizeof name, "%s%zu%s", stem, held->count, ending);
  return hold(held, stem, ending, hl_path_join(held->context, held->folder, name), error);
}

/* Adds a file that already lies on the disk. */
static hl_status hold_as_it_is(held_scene *held, const char *stem, const char **file, hl_error *error) {
  if (*file == NULL || hl_file_kind(held->context, *file) != 'f')
    return hl_fail(error, HL_ERROR_INPUT, "%.200s: a page holds no folder, and no array, of colours: %s",
                   *file != NULL ? *file : stem, "write it to one file first");
  const char *slash = strrchr(*file, '/'), *dot = strchr(slash != NULL ? slash : *file, '.');
  hl_status status = hold(held, stem, dot != NULL ? dot : "", hl_copy_text(held->context, *file), error);
  if (status == HL_OK) *file = held->files[held->count - 1].name;
  return status;
}

/* ---- volumes ---- */

/* Writes voxels to a file, and reads the file again, so that the scene's text describes the volume that the
 * page will have. */
static hl_status write_voxels(held_scene *held, const char *stem, const hl_volume *voxels,
                              const hl_volume_save_options *options, hl_volume **read, const char **file,
                              hl_error *error) {
  hl_volume_load_options plain;
  hl_volume_load_options_defaults(&plain);
  hl_status status = hold_new(held, stem, ".nrrd", error);
  if (status != HL_OK) return status;
  const held_file *last = &held->files[held->count - 1];
  status = hl_volume_save_with(held->context, voxels, last->path, options, error);
  if (status == HL_OK) status = hl_volume_load_with(held->context, last->path, &plain, read, error);
  if (status != HL_OK) return status;
  held->made[held->made_count++] = *read;
  *file = last->name;
  return HL_OK;
}

/* Removes from the scene the options by which the volume was read from its old file. The new file has only
 * one array and one time step. */
static void forget_reading(hl_scene_volume *volume) {
  hl_scene_volume plain;
  hl_scene_volume_defaults(&plain);
  volume->array = plain.array;
  volume->series = plain.series;
  volume->component = plain.component;
  volume->time = plain.time;
  volume->channel = plain.channel;
  volume->level = plain.level;
  memcpy(volume->spacing, plain.spacing, sizeof plain.spacing);
  volume->file_space = plain.file_space;
}

static hl_status hold_volume(held_scene *held, const hl_scene *scene, size_t number, hl_error *error) {
  hl_scene_volume *volume = &held->volumes[number];
  hl_volume_save_options options;
  hl_volume_save_options_defaults(&options);
  hl_status status = HL_OK;
  if (volume->shapes == NULL && volume->volume->colors != NULL)
    status = hold_as_it_is(held, "volume", &volume->file, error);
  else if (volume->shapes == NULL) {
    status = hl_seen_part(held->context, scene, number, &options, error);
    if (status == HL_OK)
      status = write_voxels(held, "volume", volume->volume, &options, &volume->volume, &volume->file, error);
    if (status == HL_OK) forget_reading(volume);
  }
  if (status == HL_OK && volume->mask.volume != NULL) {
    status = write_voxels(held, "mask", volume->mask.volume, NULL, &volume->mask.volume, &volume->mask.file,
                          error);
    volume->mask.component = HL_COMPONENT_DEFAULT;
  }
  const hl_function_image *image = &volume->transfer_function.plane.image;
  if (status == HL_OK && image->pixels != NULL)
    status = hold_as_it_is(held, "image", &volume->transfer_function.plane.image.file, error);
  return status;
}

/* ---- images ---- */

/* Writes pixels as NumPy's .npy, version 1.0: a header of 128 bytes, and floats. */
static hl_status write_pixels(held_scene *held, const float *pixels, int width, int height, const char **file,
                              hl_error *error) {
  hl_status status = hold_new(held, "image", ".npy", error);
  if (status != HL_OK) return status;
  const held_file *last = &held->files[held->count - 1];
  hl_output output = {0};
  status = hl_output_begin(held->context, last->path, &output, error);
  if (status != HL_OK) return status;
  char header[129];
  int length = snprintf(header + 10, sizeof header - 10,
                        "{'descr': '<f4', 'fortran_order': False, 'shape': (%d, %d, 3), }", height, width);
  memcpy(header, "\x93NUMPY\x01\x00\x76\x00", 10);
  memset(header + 10 + length, ' ', (size_t)(117 - length));
  header[127] = '\n';
  fwrite(header, 1, 128, output.file);
  fwrite(pixels, sizeof *pixels, 3 * (size_t)width * (size_t)height, output.file);
  *file = last->name;
  return hl_output_commit(&output, error);
}

static hl_status hold_image(held_scene *held, const float *pixels, int width, int height, const char **file,
                            hl_error *error) {
  if (pixels == NULL) return HL_OK;
  if (*file != NULL && hl_file_kind(held->context, *file) == 'f')
    return hold_as_it_is(held, "image", file, error);
  return write_pixels(held, pixels, width, height, file, error);
}

static hl_status hold_images(held_scene *held, hl_scene_description *d, hl_error *error) {
  hl_status status = hold_image(held, d->sky.pixels, d->sky.width, d->sky.height, &d->sky.file, error);
  for (size_t n = 0; n < d->light_count && status == HL_OK; n++) {
    hl_light_texture *texture = &held->lights[n].texture;
    hl_light_emission *emission = &held->lights[n].emission;
    status = hold_image(held, texture->pixels, texture->width, texture->height, &texture->file, error);
    if (status == HL_OK)
      status = hold_image(held, emission->pixels, emission->width, emission->height, &emission->file, error);
  }
  return status;
}

/* ---- all steps together ---- */

static hl_status begin(held_scene *held, const hl_scene_description *d, hl_error *error) {
  held->room = 3 * d->volume_count + 2 * d->light_count + 1;
  held->files = hl_allocate_zeroed(held->context, held->room, sizeof *held->files);
  held->volumes = hl_allocate_zeroed(held->context, d->volume_count, sizeof *held->volumes);
  held->lights = hl_allocate_zeroed(held->context, d->light_count, sizeof *held->lights);
  held->made = hl_allocate_zeroed(held->context, 2 * d->volume_count, sizeof(hl_volume *));
  if (held->files == NULL || held->volumes == NULL || held->lights == NULL || held->made == NULL)
    return hl_fail_memory(error, held->room * sizeof *held->files, "a page's list of files");
  if (d->volume_count > 0) memcpy(held->volumes, d->volumes, d->volume_count * sizeof *held->volumes);
  if (d->light_count > 0) memcpy(held->lights, d->lights, d->light_count * sizeof *held->lights);
  return HL_OK;
}

/* Makes the scene's text, which contains the scene's meshes. */
static hl_status make_text(held_scene *held, hl_scene_description *d, hl_error *error) {
  hl_scene *scene = NULL;
  hl_scene_mesh *meshes = hl_allocate_zeroed(held->context, d->mesh_count, sizeof *meshes);
  if (meshes == NULL) return hl_fail_memory(error, d->mesh_count * sizeof *meshes, "meshes");
  for (size_t n = 0; n < d->mesh_count; n++) {
    meshes[n] = d->meshes[n];
    meshes[n].file = NULL;
  }
  d->meshes = meshes;
  d->volumes = held->volumes;
  d->lights = held->lights;
  hl_status status = hl_scene_create(held->context, d, &scene, error);
  if (status == HL_OK) status = hl_scene_to_json(held->context, scene, &held->text, error);
  hl_scene_release(scene);
  hl_release(held->context, meshes);
  return status;
}

hl_status held_scene_make(hl_context *context, const hl_scene *scene, held_scene *held, hl_error *error) {
  hl_scene_description description = *hl_scene_describe(scene);
  held->context = context;
  hl_status status = begin(held, &description, error);
  for (size_t n = 0; n < description.volume_count && status == HL_OK; n++)
    status = hold_volume(held, scene, n, error);
  if (status == HL_OK) status = hold_images(held, &description, error);
  if (status == HL_OK) status = make_text(held, &description, error);
  return status;
}

void held_scene_end(held_scene *held) {
  size_t length = held->folder != NULL ? strlen(held->folder) : 0;
  for (size_t n = 0; n < held->made_count; n++) hl_volume_release(held->made[n]);
  for (size_t n = 0; n < held->count; n++) {
    if (length > 0 && strncmp(held->files[n].path, held->folder, length) == 0) unlink(held->files[n].path);
    hl_release(held->context, held->files[n].path);
  }
  if (held->folder != NULL) rmdir(held->folder);
  hl_release(held->context, held->folder);
  hl_release(held->context, held->files);
  hl_release(held->context, held->volumes);
  hl_release(held->context, held->lights);
  hl_release(held->context, held->made);
  hl_text_release(held->context, held->text);
}
