/* json/meshes.c - the meshes of a scene from JSON. */
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "json/parts.h"
#include "json/settings.h"

static const char *const other_keys[] = {"name", "file", "transform", "material", NULL};

static bool same_text(const char *a, const char *b) {
  return a == NULL || b == NULL ? a == b : strcmp(a, b) == 0;
}

/* The mesh of the scene that `like` names, or of an earlier mesh of this scene; null: none. */
static hl_mesh *known_mesh(const hl_json_reader *reader, const hl_mesh_shelf *shelf, const char *path) {
  for (size_t m = 0; m < shelf->count; m++)
    if (same_text(shelf->meshes[m].file, path)) return shelf->meshes[m].mesh;
  for (size_t m = 0; reader->like != NULL && m < reader->like->mesh_count; m++)
    if (same_text(reader->like->meshes[m].file, path)) return reader->like->meshes[m].mesh;
  return NULL;
}

/* Loads the file, or takes its mesh from those that are known. *mesh then owns path and mesh. */
static hl_status load(hl_json_reader *reader, const hl_mesh_shelf *shelf, char *path, hl_scene_mesh *mesh) {
  hl_mesh *known = known_mesh(reader, shelf, path);
  mesh->file = path;
  if (known != NULL) {
    hl_mesh_retain(known);
    mesh->mesh = known;
    return HL_OK;
  }
  if (reader->like != NULL)
    return hl_json_fail(reader, HL_ERROR_INPUT, "file",
                        "\"%.200s\" is no mesh of the open scene: open it anew", path);
  hl_status status = hl_mesh_load(reader->context, path, &mesh->mesh, reader->error);
  if (status == HL_OK) return HL_OK;
  hl_json_enter(reader, "file");
  return hl_json_prefix(reader, reader->place);
}

static hl_status read_mesh(hl_json_reader *reader, const json_t *value, const hl_mesh_shelf *shelf,
                           hl_scene_mesh *mesh) {
  const char *file = NULL;
  hl_scene_mesh_defaults(mesh);
  hl_status status = hl_json_settings_object(reader, value, HL_SETTINGS_MESH, -1, other_keys);
  if (status == HL_OK) status = hl_json_text(reader, value, "name", &mesh->name);
  if (status == HL_OK) status = hl_json_text(reader, value, "file", &file);
  if (status == HL_OK && (file == NULL || file[0] == 0))
    status = hl_json_fail(reader, HL_ERROR_INPUT, "file", "is missing: name the mesh's file");
  if (status == HL_OK)
    status = hl_json_read_transform(reader, json_object_get(value, "transform"), HL_SETTINGS_MESH, mesh);
  if (status == HL_OK)
    status = hl_json_settings_member(reader, json_object_get(value, "material"), "material",
                                     HL_SETTINGS_MATERIAL, &mesh->material);
  if (status == HL_OK) status = hl_json_settings(reader, value, HL_SETTINGS_MESH, 0, mesh);
  if (status != HL_OK) return status;
  char *path = hl_json_path(reader, file);
  if (path == NULL) return hl_fail_memory(reader->error, strlen(file) + 1, "a path");
  return load(reader, shelf, path, mesh);
}

hl_status hl_json_read_meshes(hl_json_reader *reader, const json_t *value, hl_mesh_shelf *shelf) {
  if (value == NULL) return HL_OK;
  size_t mark = hl_json_enter(reader, "meshes");
  hl_status status = hl_json_array(reader, value, 0, HL_LIMIT_MESHES);
  if (status != HL_OK) return status;
  shelf->meshes = hl_allocate_zeroed(reader->context, json_array_size(value), sizeof *shelf->meshes);
  if (shelf->meshes == NULL)
    return hl_fail_memory(reader->error, json_array_size(value) * sizeof *shelf->meshes, "a scene's meshes");
  for (size_t m = 0; m < json_array_size(value); m++) {
    size_t inner = hl_json_enter_index(reader, m);
    hl_scene_mesh *mesh = &shelf->meshes[m];
    status = read_mesh(reader, json_array_get(value, m), shelf, mesh);
    shelf->count = m + 1;
    if (status != HL_OK) return status;
    hl_json_leave(reader, inner);
  }
  hl_json_leave(reader, mark);
  return HL_OK;
}

void hl_json_release_meshes(hl_context *context, hl_mesh_shelf *shelf) {
  for (size_t m = 0; m < shelf->count; m++) {
    hl_release(context, (void *)shelf->meshes[m].file);
    hl_mesh_release(shelf->meshes[m].mesh);
  }
  hl_release(context, shelf->meshes);
}
