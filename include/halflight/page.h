/* halflight/page.h - writes a scene as a page: one HTML file that holds the viewer, the scene and its data. A
 * browser opens the page from a disk. The reader can move the camera and the lights. */
#ifndef HALFLIGHT_PAGE_H
#define HALFLIGHT_PAGE_H

#include "scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Writes a scene as a page. viewer: the path of halflight.html, the viewer's page without a scene, which
 * scripts/web makes (docs/web.md). title: UTF-8, the page's title. path: the file to write, which appears
 * whole or not at all. Volumes are cut to the box of visible voxels and a few voxels around it. Their voxels
 * are stored in 8 bits if 8 bits hold all values. Volumes with colours of their own, and images, are stored
 * as the bytes of their files; if such a file is missing, the error is HL_ERROR_INPUT. */
HL_API HL_WARN_UNUSED hl_status hl_scene_write_page(hl_context *context, const hl_scene *scene,
                                                    const char *viewer, const char *title, const char *path,
                                                    hl_error *error);

#ifdef __cplusplus
}
#endif
#endif
