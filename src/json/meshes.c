/* json/meshes.c - reads the meshes of a scene from JSON. */
#include <string.h>

#include <halflight/compose.h>

#include "core/file.h"
#include "core/memory.h"
#include "json/parts.h"
#include "json/settings.h"

/* The keys of a mesh that are not in the table of settings. A mesh has one source: a file, "floor", or arrays
 * of its own. */
static const char *const other_keys[] = {
    "name",   "file",        "floor",   "transform",     "material", "vertices",    "triangles", "normals",
    "colors", "face_colors", "spheres", "sphere_colors", "lines",    "line_colors", "radius",    NULL};

static bool same_text(const char *a, const char *b) {
  return a == NULL || b == NULL ? a == b : strcmp(a, b) == 0;
}

/* Finds a mesh that was already loaded from this path, for this scene or for the scene `like`. Returns null
 * if there is no such mesh. */
static hl_mesh *known_mesh(const hl_json_reader *reader, const hl_mesh_shelf *shelf, const char *path) {
  for (size_t m = 0; m < shelf->count; m++)
    if (same_text(shelf->meshes[m].file, path)) return shelf->meshes[m].mesh;
  for (size_t m = 0; reader->like != NULL && m < reader->like->mesh_count; m++)
    if (same_text(reader->like->meshes[m].file, path)) return reader->like->meshes[m].mesh;
  return NULL;
}

/* Loads a mesh from a file, or takes it from the meshes that were loaded already. *mesh then owns path and
 * mesh. */
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

static bool has_arrays(const json_t *value) {
  for (size_t n = 0; hl_json_mesh_keys[n] != NULL; n++)
    if (json_object_get(value, hl_json_mesh_keys[n]) != NULL) return true;
  return false;
}

/* Refuses a mesh that has no source, or more than one. */
static hl_status check_source(hl_json_reader *reader, const json_t *value) {
  bool file = json_object_get(value, "file") != NULL, floor = json_object_get(value, "floor") != NULL;
  int sources = file + floor + has_arrays(value);
  if (sources == 1) return HL_OK;
  return hl_json_fail(reader, HL_ERROR_INPUT, "file",
                      sources == 0
                          ? "is missing: name the mesh's file, or give vertices and triangles, spheres, "
                            "lines, or a floor"
                          : "is one of several sources: give a file, a floor, or arrays");
}

/* Reads a mesh's settings. */
static hl_status read_look(hl_json_reader *reader, const json_t *value, hl_scene_mesh *mesh) {
  if (json_object_get(value, "floor") != NULL) hl_scene_floor_defaults(mesh);
  else hl_scene_mesh_defaults(mesh);
  hl_status status = hl_json_settings_object(reader, value, HL_SETTINGS_MESH, -1, other_keys);
  if (status == HL_OK) status = hl_json_text(reader, value, "name", &mesh->name);
  if (status == HL_OK) status = check_source(reader, value);
  if (status == HL_OK)
    status = hl_json_read_transform(reader, json_object_get(value, "transform"), HL_SETTINGS_MESH, mesh);
  if (status == HL_OK)
    status = hl_json_settings_member(reader, json_object_get(value, "material"), "material",
                                     HL_SETTINGS_MATERIAL, &mesh->material);
  return status == HL_OK ? hl_json_settings(reader, value, HL_SETTINGS_MESH, 0, mesh) : status;
}

/* Reads one mesh that is no floor, and appends it to the shelf (the list of the scene's meshes). */
static hl_status read_mesh(hl_json_reader *reader, const json_t *value, hl_mesh_shelf *shelf) {
  hl_scene_mesh *mesh = &shelf->meshes[shelf->count];
  const char *file = NULL;
  hl_status status = read_look(reader, value, mesh);
  if (status == HL_OK) status = hl_json_text(reader, value, "file", &file);
  if (status == HL_OK && file != NULL && file[0] == 0)
    status = hl_json_fail(reader, HL_ERROR_INPUT, "file", "is empty: name the mesh's file");
  if (status == HL_OK && file == NULL) status = hl_json_read_mesh_arrays(reader, value, &mesh->mesh);
  if (status == HL_OK && file != NULL) {
    char *path = hl_json_path(reader, file);
    status = path != NULL ? load(reader, shelf, path, mesh)
                          : hl_fail_memory(reader->error, strlen(file) + 1, "a path");
  }
  shelf->count++;
  return status;
}

/* Reads the properties of a floor. The floor is made later. `place` is the floor's index in the list, after
 * all other meshes. */
static hl_status read_floor(hl_json_reader *reader, const json_t *value, hl_mesh_shelf *shelf, size_t place) {
  double *size = &shelf->floor_sizes[shelf->floor_count++];
  *size = json_is_true(json_object_get(value, "floor")) ? HL_FLOOR_SIZE : 0;
  hl_status status = *size > 0 ? HL_OK : hl_json_number(reader, value, "floor", size);
  if (status == HL_OK && !(*size >= 1 && *size <= 1000))
    status = hl_json_fail(reader, HL_ERROR_INPUT, "floor",
                          "is %g: give true, or the floor's width in widths of the objects on it, 1 to 1000",
                          *size);
  return status == HL_OK ? read_look(reader, value, &shelf->meshes[place]) : status;
}

hl_status hl_json_read_meshes(hl_json_reader *reader, const json_t *value, hl_mesh_shelf *shelf) {
  if (value == NULL) return HL_OK;
  size_t mark = hl_json_enter(reader, "meshes");
  hl_status status = hl_json_array(reader, value, 0, HL_LIMIT_MESHES);
  if (status != HL_OK) return status;
  size_t count = json_array_size(value), others = 0;
  shelf->meshes = hl_allocate_zeroed(reader->context, count, sizeof *shelf->meshes);
  shelf->floor_sizes = hl_allocate_zeroed(reader->context, count, sizeof *shelf->floor_sizes);
  if (shelf->meshes == NULL || shelf->floor_sizes == NULL)
    return hl_fail_memory(reader->error, count * sizeof *shelf->meshes, "a scene's meshes");
  for (size_t m = 0; m < count; m++) others += json_object_get(json_array_get(value, m), "floor") == NULL;
  for (size_t m = 0; m < count; m++) {
    size_t inner = hl_json_enter_index(reader, m);
    const json_t *item = json_array_get(value, m);
    bool floor = json_object_get(item, "floor") != NULL;
    status = floor ? read_floor(reader, item, shelf, others + shelf->floor_count)
                   : read_mesh(reader, item, shelf);
    if (status != HL_OK) return status;
    hl_json_leave(reader, inner);
  }
  hl_json_leave(reader, mark);
  return HL_OK;
}

hl_status hl_json_add_floors(hl_json_reader *reader, const hl_scene_description *scene,
                             hl_mesh_shelf *shelf) {
  const hl_scene_description standing = *scene;
  for (size_t n = 0; n < shelf->floor_count; n++) {
    hl_scene_mesh *floor = &shelf->meshes[shelf->count];
    hl_status status = hl_scene_make_floor(reader->context, &standing, NULL, shelf->floor_sizes[n],
                                           &floor->mesh, reader->error);
    if (status != HL_OK) return hl_json_prefix(reader, "/meshes");
    shelf->count++;
  }
  return HL_OK;
}

void hl_json_release_meshes(hl_context *context, hl_mesh_shelf *shelf) {
  for (size_t m = 0; m < shelf->count; m++) {
    hl_release(context, (void *)shelf->meshes[m].file);
    hl_mesh_release(shelf->meshes[m].mesh);
  }
  hl_release(context, shelf->meshes);
  hl_release(context, shelf->floor_sizes);
}
