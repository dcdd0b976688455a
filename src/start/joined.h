/* start/joined.h - files that are added to a scene: meshes, and all that another scene holds. */
#ifndef HL_START_JOINED_H
#define HL_START_JOINED_H

#include <stdbool.h>

#include <halflight/scene.h>

/* Loads a mesh. It has the colour that hl_surface_color() gives for `index`, or white if it has colours of
 * its own. The caller releases mesh->mesh. */
hl_status load_mesh(hl_context *context, const char *path, size_t index, hl_scene_mesh *mesh,
                    hl_error *error);

/* Adds meshes to a scene; where *scene is null, makes a scene for them. bare: whether the camera is to frame
 * the meshes, too. */
hl_status join_meshes(hl_context *context, const hl_scene_mesh *added, size_t count, bool bare,
                      hl_scene **scene, hl_error *error);

/* Moves the camera along its direction and zooms so that everything in the scene now fits into the picture.
 */
hl_status frame_anew(hl_scene_description *description, hl_error *error);

/* Makes one scene of two: the volumes and meshes of the first scene, and after them the volumes and meshes
 * of the second. Light, background and settings come from the first scene, whose camera keeps its direction
 * and frames everything. */
hl_status join_scenes(hl_context *context, hl_scene *base, hl_scene *added, hl_scene **scene,
                      hl_error *error);

#endif
