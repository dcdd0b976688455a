/* start/joined.c - see joined.h. */
#include "joined.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <halflight/compose.h>

/* Gives a grey blue to meshes that have the first standard colour, because volumes and their isosurfaces have
 * the first standard colour. */
static void set_apart(hl_scene_mesh *meshes, size_t count) {
  static const double grey_blue[3] = {0.24, 0.33, 0.45};
  double first[3];
  hl_surface_color(0, first);
  for (size_t m = 0; m < count; m++)
    if (memcmp(meshes[m].color, first, sizeof first) == 0)
      memcpy(meshes[m].color, grey_blue, sizeof grey_blue);
}

/* Replaces *scene by a copy with more meshes. */
static hl_status add_meshes(hl_context *context, const hl_scene_mesh *added, size_t count, bool bare,
                            hl_scene **scene, hl_error *error) {
  hl_scene_description description = *hl_scene_describe(*scene);
  const size_t before = description.mesh_count;
  hl_scene_mesh *meshes = malloc((before + count) * sizeof *meshes);
  hl_scene *made = NULL;
  if (meshes == NULL) {
    snprintf(error->message, sizeof error->message, "out of memory: %zu meshes", before + count);
    return error->code = HL_ERROR_MEMORY;
  }
  if (before > 0) memcpy(meshes, description.meshes, before * sizeof *meshes);
  memcpy(meshes + before, added, count * sizeof *meshes);
  if (bare && description.volume_count > 0) set_apart(meshes + before, count);
  description.meshes = meshes;
  description.mesh_count = before + count;
  hl_status status = bare ? hl_camera_reframe(&description, &description.camera, error) : HL_OK;
  if (status == HL_OK) status = hl_scene_create(context, &description, &made, error);
  free(meshes);
  if (status != HL_OK) return status;
  hl_scene_release(*scene);
  *scene = made;
  return HL_OK;
}

hl_status load_mesh(hl_context *context, const char *path, size_t index, hl_scene_mesh *mesh,
                    hl_error *error) {
  hl_scene_mesh_defaults(mesh);
  mesh->file = path;
  hl_status status = hl_mesh_load(context, path, &mesh->mesh, error);
  const hl_mesh_description *d = status == HL_OK ? hl_mesh_describe(mesh->mesh) : NULL;
  bool own = d != NULL && (d->colors != NULL || d->face_colors != NULL || d->sphere_colors != NULL);
  hl_surface_color(index, mesh->color);
  for (int c = 0; c < 3 && own; c++) mesh->color[c] = 1;
  return status;
}

hl_status join_meshes(hl_context *context, const hl_scene_mesh *added, size_t count, bool bare,
                      hl_scene **scene, hl_error *error) {
  return *scene == NULL ? hl_scene_for_meshes(context, added, count, scene, error)
                        : add_meshes(context, added, count, bare, scene, error);
}

/* ---- scenes ---- */

/* Adds meshes to a scene. A mesh with the first standard colour gets the standard colour of its place in the
 * list. */
static hl_status join_colored(hl_context *context, const hl_scene_mesh *meshes, size_t count,
                              hl_scene **scene, hl_error *error) {
  const size_t before = hl_scene_describe(*scene)->mesh_count;
  double first[3];
  hl_surface_color(0, first);
  hl_scene_mesh *added = malloc(count * sizeof *added + 1);
  if (added == NULL) {
    snprintf(error->message, sizeof error->message, "out of memory for %zu meshes", count);
    return HL_ERROR_MEMORY;
  }
  for (size_t m = 0; m < count; m++) {
    added[m] = meshes[m];
    if (memcmp(added[m].color, first, sizeof first) == 0) hl_surface_color(before + m, added[m].color);
  }
  hl_status status = join_meshes(context, added, count, true, scene, error);
  free(added);
  return status;
}

/* Replaces *scene by a scene with the volumes of both scenes, and with the light and all other settings of
 * the first. */
static hl_status join_volumes(hl_context *context, hl_scene *base, hl_scene *added, hl_scene **scene,
                              hl_error *error) {
  const hl_scene_description *before = hl_scene_describe(base);
  hl_scene *both[] = {base, added}, *made = NULL;
  if (before->volume_count > 0) {
    hl_status status = hl_scene_join(context, both, 2, &made, error);
    if (status != HL_OK) return status;
  }
  hl_scene_description description = *hl_scene_describe(made != NULL ? made : added);
  hl_scene_description joined = *before;
  joined.volumes = description.volumes;
  joined.volume_count = description.volume_count;
  joined.render.sheet_spacing = description.render.sheet_spacing;
  hl_status status = hl_camera_reframe(&joined, &joined.camera, error);
  if (status == HL_OK) status = hl_scene_create(context, &joined, scene, error);
  hl_scene_release(made);
  return status;
}

hl_status join_scenes(hl_context *context, hl_scene *base, hl_scene *added, hl_scene **scene,
                      hl_error *error) {
  const hl_scene_description *d = hl_scene_describe(added);
  hl_status status = HL_OK;
  *scene = NULL;
  if (hl_scene_describe(base)->render.compositing == HL_COMPOSITING_MAXIMUM && d->mesh_count > 0) {
    snprintf(error->message, sizeof error->message,
             "a maximum projection shows no meshes: choose another look first");
    return HL_ERROR_INPUT;
  }
  if (d->volume_count > 0) status = join_volumes(context, base, added, scene, error);
  else hl_scene_retain(*scene = base);
  if (status == HL_OK && d->mesh_count > 0)
    status = join_colored(context, d->meshes, d->mesh_count, scene, error);
  if (status == HL_OK) return HL_OK;
  hl_scene_release(*scene);
  *scene = NULL;
  return status;
}
