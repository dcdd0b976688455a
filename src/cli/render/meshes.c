/* cli/render/meshes.c - meshes among the operands of `halflight render`: they are added to the scene of the
 * others, in colours of their own. */
#include <halflight/compose.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/input.h"
#include "render.h"

void render_part_meshes(hl_context *context, char **operands, char **meshes, char **others) {
  size_t count = 0, left = 0;
  for (size_t n = 0; operands[n] != NULL; n++) {
    if (is_mesh_file(context, operands[n])) meshes[count++] = operands[n];
    else others[left++] = operands[n];
  }
  meshes[count] = others[left] = NULL;
}

hl_status render_frame_anew(hl_scene_description *description, hl_error *error) {
  hl_view view;
  hl_status status = hl_view_of_camera(description, &view);
  return status == HL_OK ? hl_camera_frame_view(description, &view, 1, &description->camera, error) : status;
}

/* Makes a scene of the scene and more meshes. replaced: the scene's own meshes are left out. */
static hl_status add_meshes(hl_context *context, const hl_scene_mesh *added, size_t count, bool bare,
                            bool replaced, hl_scene **scene, hl_error *error) {
  hl_scene_description description = *hl_scene_describe(*scene);
  size_t before = replaced ? 0 : description.mesh_count;
  hl_scene_mesh *meshes = malloc((before + count) * sizeof *meshes);
  hl_scene *made = NULL;
  if (meshes == NULL) {
    snprintf(error->message, sizeof error->message, "out of memory: %zu meshes", before + count);
    return error->code = HL_ERROR_MEMORY;
  }
  if (before > 0) memcpy(meshes, description.meshes, before * sizeof *meshes);
  memcpy(meshes + before, added, count * sizeof *meshes);
  description.meshes = meshes;
  description.mesh_count = before + count;
  hl_status status = bare ? render_frame_anew(&description, error) : HL_OK;
  if (status == HL_OK) status = hl_scene_create(context, &description, &made, error);
  free(meshes);
  if (status != HL_OK) return status;
  hl_scene_release(*scene);
  *scene = made;
  return HL_OK;
}

/* A scene for meshes without a volume: one triangle in their place, with the usual camera and light. */
static hl_status begin_scene(hl_context *context, hl_scene **scene, hl_error *error) {
  static const char text[] =
      "{\"halflight\": 1, \"meshes\": [{\"vertices\": [[0, 0, 0], [1, 0, 0], [0, 1, 1]], "
      "\"triangles\": [[0, 1, 2]]}]}";
  return hl_scene_from_json(context, text, sizeof text - 1, NULL, "meshes", scene, error);
}

hl_status render_load_mesh(hl_context *context, const char *path, size_t index, hl_scene_mesh *mesh,
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

hl_status render_join_meshes(hl_context *context, const hl_scene_mesh *added, size_t count, bool bare,
                             hl_scene **scene, hl_error *error) {
  bool alone = *scene == NULL;
  hl_status status = alone ? begin_scene(context, scene, error) : HL_OK;
  return status == HL_OK ? add_meshes(context, added, count, bare, alone, scene, error) : status;
}

/* Loads the meshes; *count of them were, of which the caller releases each. */
static hl_status load_meshes(hl_context *context, char *const *paths, size_t first, hl_scene_mesh *added,
                             size_t *count, hl_error *error) {
  hl_status status = HL_OK;
  for (*count = 0; paths[*count] != NULL && status == HL_OK; ++*count)
    status = render_load_mesh(context, paths[*count], first + *count, &added[*count], error);
  return status;
}

int render_add_meshes(cli_host *host, char *const *paths, size_t first, bool bare, hl_scene **scene) {
  hl_scene_mesh added[MAXIMUM_OPERANDS];
  size_t count = 0;
  hl_error error = {0};
  if (paths[0] == NULL) return EXIT_CODE_OK;
  hl_status status = load_meshes(host->context, paths, first, added, &count, &error);
  if (status == HL_OK) status = render_join_meshes(host->context, added, count, bare, scene, &error);
  for (size_t m = 0; m < count; m++) hl_mesh_release(added[m].mesh);
  return status == HL_OK ? EXIT_CODE_OK : host_fail(host, PHASE_READ, status, &error);
}
