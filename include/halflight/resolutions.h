/* halflight/resolutions.h - reads the volumes of a scene anew, as fine as its pictures show them, and only
 * where its pictures see them.
 *
 * A file may hold a volume in several resolutions (OME-Zarr). A picture that is zoomed in deserves a fine
 * resolution, but sees only a part of the volume. The part follows from the camera, and the camera frames
 * what the voxels show. So a caller reads the volumes at a coarse resolution first
 * (hl_volume_load_options.preview_pixels), makes the scene, and then calls hl_scene_read_finer(). A scene
 * that a file describes is read by hl_scene_load_coarse(). */
#ifndef HALFLIGHT_RESOLUTIONS_H
#define HALFLIGHT_RESOLUTIONS_H

#include "scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Returns whether any volume of the scene was read at a coarser resolution than the one that its options for
 * reading ask for (hl_volume_selection). */
HL_API int hl_scene_is_coarse(const hl_scene_description *description);

/* Which finer resolution of a volume is read. */
typedef enum hl_finer {
  HL_FINER_ASKED = 0,  /* the resolution that the options for reading ask for (hl_volume_selection.aim) */
  HL_FINER_NEXT = 1,   /* the next finer resolution, at most as fine as HL_FINER_ASKED */
  HL_FINER_PIXELS = 2, /* the coarsest resolution that has a voxel for each pixel of the cameras' pictures at
                        * the cameras' targets, if it is finer than the scene's resolution. It is at most as
                        * fine as the finest resolution that is read where none is named
                        * (HL_INDEX_DEFAULT). If the caller has named the resolution of the scene's volume,
                        * or the volume is a label map, no resolution is read */
} hl_finer;

/* Reads volume number `number` of a scene at a finer resolution, with the options that the scene names. path:
 * the volume's file; null stands for the file that the scene names. cameras: [camera_count], the cameras of
 * the pictures that will be made, which have the description's size; with null, the volume is read whole.
 * Chunks of a store that no camera sees are not read: their voxels are interpolated in the volume that the
 * scene has. Label maps are read whole, since numbers between two labels are other labels. which: the
 * resolution to read; HL_FINER_PIXELS needs cameras. The volume is smoothed as the scene's volume was; if the
 * scene's volume was not smoothed, the finer one is smoothed where hl_scene_for_volume() would smooth it.
 * *finer is owned by the caller (release it); it is null if the volume has the wanted resolution already, or
 * if no file is named. */
HL_API HL_WARN_UNUSED hl_status hl_volume_read_finer(hl_context *context, const char *path,
                                                     const hl_scene_description *description, size_t number,
                                                     const hl_camera *cameras, size_t camera_count,
                                                     hl_finer which, hl_volume **finer, hl_error *error);

/* Returns the resolution of volume number `number` of a scene that HL_FINER_PIXELS reads for these cameras;
 * the resolution that the volume has if none is read. cameras: [camera_count]. If an argument is null or
 * there is no such volume, the result is HL_INDEX_DEFAULT. */
HL_API int hl_volume_level_for(const hl_scene_description *description, size_t number,
                               const hl_camera *cameras, size_t camera_count);

/* Reads a scene as hl_scene_load() does, but volumes of several resolutions at a coarse one, for a first
 * picture whose longer side has preview_pixels pixels; hl_volume_selection.aim is the resolution that the
 * scene names. Volumes are read at once at that resolution if anything in the scene is found by their voxels:
 * the camera, a transfer function without points of its own or over percentiles, labels, scraps, or a mask.
 */
HL_API HL_WARN_UNUSED hl_status hl_scene_load_coarse(hl_context *context, const char *path,
                                                     int preview_pixels, hl_scene **scene, hl_error *error);

/* Reads a scene's text, which is as for hl_scene_from_json(), as hl_scene_load_coarse() reads a file. */
HL_API HL_WARN_UNUSED hl_status hl_scene_from_json_coarse(hl_context *context, const char *text,
                                                          size_t length, const char *base_folder,
                                                          const char *name, int preview_pixels,
                                                          hl_scene **scene, hl_error *error);

/* Makes a scene that differs from `scene` only in its volumes, which hl_volume_read_finer() reads at the
 * resolutions that their options ask for. Label maps get the labels of their finer voxels. *finer is owned by
 * the caller (release it); if no volume is coarse, it is the scene itself, retained. */
HL_API HL_WARN_UNUSED hl_status hl_scene_read_finer(hl_context *context, hl_scene *scene,
                                                    const hl_camera *cameras, size_t camera_count,
                                                    hl_scene **finer, hl_error *error);

#ifdef __cplusplus
}
#endif
#endif
