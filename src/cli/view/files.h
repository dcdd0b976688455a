/* cli/view/files.h - makes the scenes of the viewer: absolute names for their files, and the scenes of files
 * that pages open. */
#ifndef HL_CLI_VIEW_FILES_H
#define HL_CLI_VIEW_FILES_H

#include "server/server.h"

/* The longer side, in pixels, of the first picture of a volume of several resolutions. */
enum { VIEW_PREVIEW_PIXELS = 128 };

/* Replaces the names of files in a scene by absolute paths, so that the page's scene can be rendered from any
 * folder. folder: the folder from which the scene's names start; null stands for the current folder. */
hl_status view_name_absolutely(hl_context *context, const char *folder, hl_scene **scene, hl_error *error);

/* Opens a file, and makes its scene. The file may hold a scene, a mesh or a volume. context: the hl_context
 * that the scene is made with. */
hl_status view_open_file(void *context, const server_file *file, hl_scene **scene, hl_error *error);

/* Reads volumes at their next finer resolutions, as server_options.refine must do. */
hl_status view_refine_scene(void *context, const hl_scene *scene, hl_scene **finer, hl_error *error);

/* Reads what the picture of a scene sees of its volumes at the resolutions that the picture deserves, as
 * server_options.read_seen must do. */
hl_status view_read_seen(void *context, const hl_scene *scene, hl_scene **seen, hl_error *error);

#endif
