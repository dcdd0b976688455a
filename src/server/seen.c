/* server/seen.c - reads the voxels that pictures at rest see of volumes of several resolutions, and keeps
 * the voxels that were read last.
 *
 * An open scene has its volumes at one resolution each, which all frames share. A picture that is zoomed in
 * needs finer voxels, but only in the part of the volume that the picture sees. The finer voxels belong to
 * one view, because another view sees other voxels. The kept voxels stay valid when the light, the look or
 * the cuts of the scene change. */
#define _GNU_SOURCE
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "parts.h"
#include "start/start.h"

static bool same_numbers(const double *a, const double *b, size_t count) {
  for (size_t n = 0; n < count; n++)
    if (a[n] != b[n]) return false;
  return true;
}

static bool same_volume(const hl_scene_volume *a, const hl_scene_volume *b) {
  return a->volume == b->volume && a->scale == b->scale && same_numbers(a->axis_scale, b->axis_scale, 3) &&
         a->rotate_angle_deg == b->rotate_angle_deg && same_numbers(a->rotate_axis, b->rotate_axis, 3) &&
         same_numbers(a->translate, b->translate, 3);
}

static bool has_same_volumes(const hl_scene_description *a, const hl_scene_description *b) {
  bool same = a->volume_count == b->volume_count && a->render.compositing == b->render.compositing;
  for (size_t v = 0; same && v < a->volume_count; v++) same = same_volume(&a->volumes[v], &b->volumes[v]);
  return same;
}

/* Returns whether pictures of two scenes have the same view. */
static bool has_same_view(const hl_scene_description *a, const hl_scene_description *b) {
  const hl_camera *eye = &a->camera, *eye_b = &b->camera;
  return a->width == b->width && a->height == b->height && eye->type == eye_b->type &&
         eye->fovy_deg == eye_b->fovy_deg && eye->height == eye_b->height &&
         same_numbers(eye->position, eye_b->position, 3) && same_numbers(eye->target, eye_b->target, 3) &&
         same_numbers(eye->up, eye_b->up, 3);
}

/* Returns whether volumes have the resolutions that the picture of a scene deserves, and no voxel of them was
 * out of sight when they were read. */
static bool serves_all_views(const hl_scene_description *scene, const hl_scene_description *with) {
  hl_volume_selection read = {.struct_size = sizeof read};
  for (size_t v = 0; v < scene->volume_count; v++)
    if (hl_volume_get_selection(with->volumes[v].volume, &read) != HL_OK || read.is_part ||
        read.level != hl_volume_level_for(scene, v, &scene->camera, 1))
      return false;
  return true;
}

/* Returns whether the voxels that are kept in a place are those that the picture of a scene sees. */
static bool serves(const seen_voxels *entry, const hl_scene *scene) {
  if (entry->of == NULL) return false;
  const hl_scene_description *of = hl_scene_describe(entry->of), *d = hl_scene_describe(scene);
  return has_same_volumes(of, d) &&
         (has_same_view(of, d) || serves_all_views(d, hl_scene_describe(entry->with)));
}

static void release(seen_voxels *entry) {
  hl_scene_release(entry->of);
  hl_scene_release(entry->with);
  *entry = (seen_voxels){0};
}

/* Finds the voxels that a picture of the scene sees, and retains their scene. Returns null if they are not
 * kept. */
static hl_scene *find(server *s, const hl_scene *scene) {
  hl_scene *found = NULL;
  pthread_mutex_lock(&s->seen_lock);
  for (int n = 0; n < MOST_SEEN && found == NULL; n++) {
    seen_voxels *entry = &s->seen[n];
    if (!serves(entry, scene)) continue;
    entry->last_use = ++s->seen_uses;
    hl_scene_retain(entry->with);
    found = entry->with;
  }
  pthread_mutex_unlock(&s->seen_lock);
  return found;
}

/* Keeps voxels in the place of those whose last use is the longest time ago. */
static void keep(server *s, long long opened, hl_scene *of, hl_scene *with) {
  pthread_mutex_lock(&s->seen_lock);
  seen_voxels *place = &s->seen[0];
  for (int n = 1; n < MOST_SEEN; n++)
    if (s->seen[n].last_use < place->last_use) place = &s->seen[n];
  release(place);
  hl_scene_retain(of);
  hl_scene_retain(with);
  *place = (seen_voxels){of, with, opened, ++s->seen_uses};
  pthread_mutex_unlock(&s->seen_lock);
}

void seen_forget(server *s, long long opened) {
  pthread_mutex_lock(&s->seen_lock);
  for (int n = 0; n < MOST_SEEN; n++)
    if (s->seen[n].of != NULL && (opened < 0 || s->seen[n].opened == opened)) release(&s->seen[n]);
  pthread_mutex_unlock(&s->seen_lock);
}

/* Returns whether an open scene is still read from coarse to fine. While a scene is still read from coarse to
 * fine, frames show the resolutions that were read so far. */
static bool is_refining(server *s, long long number) {
  server_opened *opened = opened_enter(s, number);
  const bool refining = opened == NULL || atomic_load(&opened->refining);
  if (opened != NULL) opened_leave(s, opened);
  return refining;
}

/* Returns whether the picture of a scene deserves a finer resolution of any volume. */
static bool deserves_more(const hl_scene_description *d) {
  hl_volume_selection read = {.struct_size = sizeof read};
  for (size_t v = 0; v < d->volume_count; v++)
    if (hl_volume_get_selection(d->volumes[v].volume, &read) == HL_OK &&
        hl_volume_level_for(d, v, &d->camera, 1) < read.level)
      return true;
  return false;
}

hl_status seen_read(server *s, long long opened, hl_scene *scene, hl_scene **seen, hl_error *error) {
  *seen = NULL;
  if (s->options.read_seen == NULL || is_refining(s, opened) || !deserves_more(hl_scene_describe(scene)))
    return HL_OK;
  *seen = find(s, scene);
  if (*seen != NULL) return HL_OK;
  work_enters(STAGE_VOXELS);
  hl_status status = s->options.read_seen(s->options.files_data, scene, seen, error);
  if (status == HL_OK && *seen != NULL) keep(s, opened, scene, *seen);
  return status;
}

hl_status seen_take(server *s, const hl_scene *seen, hl_scene **scene, hl_error *error) {
  hl_scene_description d = *hl_scene_describe(*scene);
  const hl_scene_description *with = hl_scene_describe(seen);
  hl_scene_volume *volumes = malloc(d.volume_count * sizeof *volumes);
  if (volumes == NULL) {
    snprintf(error->message, sizeof error->message, "out of memory for a list of volumes");
    return error->code = HL_ERROR_MEMORY;
  }
  for (size_t v = 0; v < d.volume_count; v++) {
    volumes[v] = d.volumes[v];
    volumes[v].volume = with->volumes[v].volume;
    volumes[v].level = with->volumes[v].level;
  }
  d.volumes = volumes;
  hl_scene *taken = NULL;
  hl_status status = hl_scene_create(s->options.context, &d, &taken, error);
  free(volumes);
  if (status != HL_OK) return status;
  hl_scene_release(*scene);
  *scene = taken;
  return HL_OK;
}

void seen_describe(const hl_scene *seen, const char *problem, char *text, size_t size) {
  const hl_scene_description *d = seen != NULL ? hl_scene_describe(seen) : NULL;
  char *json = NULL;
  size_t length = 0;
  FILE *out = open_memstream(&json, &length);
  text[0] = '\0';
  if (out == NULL) return;
  fprintf(out, "{\"problem\":");
  char shortened[500];
  snprintf(shortened, sizeof shortened, "%s", problem);
  put_json_text(out, shortened);
  fprintf(out, ",\"volumes\":[");
  for (size_t v = 0; d != NULL && v < d->volume_count; v++) {
    size_t chunks, absent = hl_volume_absent_chunks(d->volumes[v].volume, &chunks);
    fprintf(out, "%s{\"level\":%d,\"absent_chunks\":[%zu,%zu]}", v > 0 ? "," : "", d->volumes[v].level,
            absent, chunks);
  }
  fprintf(out, "]}");
  const bool failed = ferror(out) != 0;
  if (fclose(out) == 0 && !failed && length < size) memcpy(text, json, length + 1);
  else if (seen != NULL) seen_describe(NULL, problem, text, size);
  free(json);
}
