/* start/joined.h - adds meshes, or the content of another scene, to a scene. */
#ifndef HL_START_JOINED_H
#define HL_START_JOINED_H

#include <stdbool.h>

#include <halflight/scene.h>

/* Loads a mesh. Its colour is hl_surface_color(index), or white if the file states colours. The caller
 * releases mesh->mesh. */
hl_status load_mesh(hl_context *context, const char *path, size_t index, hl_scene_mesh *mesh,
                    hl_error *error);

/* Adds meshes to a scene. If *scene is null, makes a scene for the meshes. bare: whether the camera is moved
 * so that it frames the meshes, too. */
hl_status join_meshes(hl_context *context, const hl_scene_mesh *added, size_t count, bool bare,
                      hl_scene **scene, hl_error *error);

/* Makes one scene of two: the volumes and meshes of the first scene, and after them the volumes and meshes of
 * the second scene. Light, background and settings are taken from the first scene. The camera of the first
 * scene keeps its direction, and is moved so that it frames everything. */
hl_status join_scenes(hl_context *context, hl_scene *base, hl_scene *added, hl_scene **scene,
                      hl_error *error);

#endif
