/* cli/view/files.h - the scenes of the viewer: with names that hold in any folder, of files that pages open,
 * and with files that pages add to what is open. */
#ifndef HL_CLI_VIEW_FILES_H
#define HL_CLI_VIEW_FILES_H

#include "server/server.h"

/* Gives the scene absolute paths, so that the page's scene can be rendered from any folder. folder: where its
 * names begin; null: in the current folder. */
hl_status view_name_absolutely(hl_context *context, const char *folder, hl_scene **scene, hl_error *error);

/* The scene of a file: a scene, a mesh or a volume. context: a hl_context, of the scene. */
hl_status view_open_file(void *context, const server_file *file, hl_scene **scene, hl_error *error);

/* One scene of both: the volumes and meshes of the first, and after them those of the second. Light,
 * background and settings are those of the first scene; its camera keeps its direction and frames all.
 * context: a hl_context, of the new scene. */
hl_status view_join(void *context, hl_scene *base, hl_scene *added, hl_scene **scene, hl_error *error);

#endif
