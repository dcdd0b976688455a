/* compose/composer.h - declares the state of one call of hl_scene_compose(), and the functions that the files
 * of src/compose share. */
#ifndef HL_COMPOSE_COMPOSER_H
#define HL_COMPOSE_COMPOSER_H

#include "compose/asked.h"
#include "core/error.h"

/* The state of one call. */
typedef struct hl_composer {
  hl_context *context;
  const hl_asked *asked; /* [HL_ASK_COUNT] */
  unsigned flags;        /* members of hl_compose_flag */
  bool bare;             /* whether HL_COMPOSE_BARE is among the flags */
  hl_error *error;       /* may be null */
} hl_composer;

/* Converts the status of a failed call to HL_ERROR_ARGUMENT if it blames a file, because the options have
 * caused the failure. */
static inline hl_status hl_blame_options(hl_status status) {
  return status == HL_ERROR_INPUT ? HL_ERROR_ARGUMENT : status;
}

/* ---- functions.c: transfer functions ---- */

/* Returns true if the options replace or change the volumes' transfer functions. */
bool hl_asks_for_functions(const hl_asked *asked);

/* The transfer function of volume number `index` with the options applied. color: the colour of the function
 * if no "colormap" is given for the volume; may be null. The caller owns the function's points, also after a
 * failure. range: the values that "range" gives the volume; 0 and 0 if "range" gives the volume none. */
hl_status hl_compose_function(const hl_composer *composer, const hl_scene_description *description,
                              size_t index, const char *color, hl_transfer_function *function,
                              double range[2]);

/* The colormap that a text names, without regard to upper and lower case; null if the text names no colormap.
 */
const char *hl_find_colormap(const char *text);

/* Fails because an option names a colormap that does not exist. The error offers the colormap with the
 * nearest name. */
hl_status hl_refuse_colormap(const char *option, const char *name, hl_error *error);

/* Refuses "tf", "colormap", "range", "threshold" and "iso" with a NAME= that no volume has. */
hl_status hl_check_volume_names(const hl_composer *composer, const hl_scene_description *description);

/* Returns whether an option's value, which may begin with NAME=, is for volume number `index`. *rest: the
 * text after NAME=. */
bool hl_text_is_for(const hl_composer *composer, const char *text, const hl_scene_volume *volume,
                    size_t index, const char **rest);

/* Refuses a value of an option with a NAME= that no volume has. */
hl_status hl_check_volume_name(const hl_composer *composer, hl_ask option, const char *text,
                               const hl_scene_description *description);

/* Returns whether a value NAME=COLOR of "colormap" is for a mesh. */
bool hl_colors_meshes(const hl_composer *composer, const hl_scene_description *description);

/* Gives meshes the colours that "colormap" NAME=COLOR asks for. meshes: [description->mesh_count]. */
hl_status hl_color_meshes(const hl_composer *composer, const hl_scene_description *description,
                          hl_scene_mesh *meshes);

/* The value of an option for one volume. The option may be given several times, and the last value for the
 * volume counts. Null if no value is for the volume. */
const char *hl_text_for(const hl_composer *composer, hl_ask option, const hl_scene_volume *volume,
                        size_t index);

/* Returns whether "colormap" gives volume number `index` a colormap, and not a single colour. */
bool hl_has_colormap(const hl_composer *composer, const hl_scene_description *description, size_t index);

/* Returns whether options about values do not apply to volume number `index` unless they name it: the volume
 * is a label map beside volumes of values, and no "tf", "colormap", "range", "threshold" or "iso" names the
 * volume. */
bool hl_is_left_out(const hl_composer *composer, const hl_scene_description *description, size_t index);

/* ---- face_window.c ---- */

/* Finds whether "range" is the window of a volume's cut faces. "range" is this window if options cut a bare
 * scanned body that has the look of a surface, and no option gives the volume another function or other
 * colours. */
hl_status hl_windows_faces(const hl_composer *composer, const hl_scene_description *description, size_t index,
                           bool *windows);

/* Makes the values behind a body's surface grey, from black at window[0] to white at window[1]. The surface
 * keeps its colours, and all values keep their opacity. */
hl_status hl_window_faces(const hl_composer *composer, const hl_volume *volume, const double window[2],
                          hl_transfer_function *function);

/* ---- see_through.c ---- */

/* In a bare scene of channels, makes those channels translucent that hide another channel from the camera. In
 * a bare scene of label maps, makes matter of a translucent look so thin that the camera sees the labels in
 * the matter. Logs a line for each changed volume. If options choose opacities, the function changes nothing.
 * *changed: owned by the caller; the scene's volumes, which may have changed; null if the function changes
 * nothing. */
hl_status hl_see_through(const hl_composer *composer, hl_scene_description *scene, hl_scene_volume **changed);

/* ---- isosurfaces.c ---- */

/* Refuses values of "iso" that cannot be read. */
hl_status hl_check_isosurfaces(const hl_asked *iso, hl_error *error);

/* The number of surfaces that the values of "iso" ask for. */
size_t hl_count_isosurfaces(const hl_asked *iso);

/* Gives volume number `index` the surfaces of "iso". If no option sets the volume's transfer function, the
 * function becomes transparent; its points belong to the caller. surfaces: an array with room for all
 * surfaces of "iso"; the volume borrows it. */
hl_status hl_compose_isosurfaces(const hl_composer *composer, size_t index, hl_scene_volume *volume,
                                 hl_isosurface *surfaces);

/* ---- clip.c and cuts.c: parts of a volume ---- */

hl_status hl_check_clip(const hl_asked *clip, hl_error *error);

/* Clips volume number `index` by the values of "clip" that are for it. alone: whether the scene has no other
 * volume.
 */
hl_status hl_compose_clip(const hl_composer *composer, hl_scene_volume *volume, size_t index, bool alone);

/* Refuses values of "clip" with a NAME= that no volume has. */
hl_status hl_check_clip_names(const hl_composer *composer, const hl_scene_description *description);

hl_status hl_check_cuts(const hl_asked *asked, hl_error *error);

/* Refuses cuts with a NAME= that no volume has. */
hl_status hl_check_cut_names(const hl_composer *composer, const hl_scene_description *description);

/* The number of cuts that the options ask for. */
size_t hl_count_cuts(const hl_asked *asked);

/* Returns whether the options cut a bare volume. */
bool hl_cuts_bare_volume(const hl_composer *composer, const hl_scene_description *description);

/* Adds the options' cuts that name volume number `index` to the volume's own cuts. alone: whether the scene
 * has no other volume; cuts without a name then cut this volume. cuts: an array with room for the volume's
 * own cuts and the options' cuts; the volume borrows it. */
hl_status hl_compose_cuts(const hl_composer *composer, hl_scene_volume *volume, size_t index, bool alone,
                          hl_cut *cuts);

/* Finds the box around all volumes in the scene's world, which has the unit of the first volume. The scene
 * must have a volume. */
struct hl_world_box;
hl_status hl_scene_world_box(const hl_composer *composer, const hl_scene_description *scene,
                             struct hl_world_box *box);

/* Adds the options' cuts without a name to a scene's own cuts, which cut all volumes. Numbers without a unit
 * are fractions of the edges of the box around all volumes. cuts: an array with room for the scene's own cuts
 * and the options' cuts; the scene borrows it. */
hl_status hl_compose_scene_cuts(const hl_composer *composer, hl_scene_description *scene, hl_cut *cuts);

/* ---- box_outline.c ---- */

/* Makes the mesh of "outline": the edges of the boxes of all volumes as tubes. *mesh is owned by the
 * caller. */
hl_status hl_make_box_outline(const hl_composer *composer, const hl_scene_description *description,
                              hl_mesh **mesh);

/* Fills a mesh of a scene with the look of an outline: grey in any light, without shadows, and left whole by
 * cuts. */
void hl_box_outline_defaults(hl_scene_mesh *outline);

/* ---- sky.c ---- */

hl_status hl_check_sky(const hl_asked *sky, hl_error *error);

/* Gives the scene the sky that "sky" asks for. If the scene had no sky, the new sky's zenith is the camera's
 * up. *pixels: the pixels of the sky's image, if it has one; the description borrows them, and the caller
 * releases them. */
hl_status hl_compose_sky(const hl_composer *composer, hl_scene_description *description, float **pixels);

/* ---- camera.c ---- */

/* Places the camera. seen: whether the visible part of the volumes has changed; if so, the camera of a bare
 * volume frames the volumes anew. added: the number of meshes that options have added, at the end of the
 * scene's meshes. The camera frames added meshes, too, but the automatic view is chosen without them. */
hl_status hl_compose_camera(const hl_composer *composer, bool seen, size_t added,
                            hl_scene_description *description);

/* ---- values.c ---- */

/* Turns a bare label map back into a volume of values, if options ask for its values. *scene: a new scene of
 * the description; null if options ask for the values of no label map. */
hl_status hl_compose_values(const hl_composer *composer, const hl_scene_description *description,
                            hl_scene **scene);

/* ---- rest.c ---- */

/* Converts hl_mask.rest, which "show" gives as a fraction of opacity, to a factor of extinction. */
void hl_compose_rest(hl_scene_volume *volume);

/* ---- labels.c ---- */

/* Returns whether hl_compose_labels() changes the scene: options ask for a label map, or the only volume is a
 * bare label map that is one of several layers in its file. */
bool hl_asks_for_labels(const hl_composer *composer, const hl_scene_description *description);

/* Replaces *scene by a scene that also has the label map of "labels" or the mask of "mask", or in which the
 * bare volume is shown as a label map. */
hl_status hl_compose_labels(const hl_composer *composer, hl_scene **scene);

/* ---- hidden.c ---- */

/* Logs if matter hides labels of a label map that "labels" adds from the scene's camera. */
hl_status hl_tell_of_hidden_labels(const hl_composer *composer, const hl_scene_description *scene);

/* ---- idle.c ---- */

/* Logs the options that were given but change nothing. */
void hl_warn_of_idle_options(const hl_composer *composer, const hl_scene_description *description);

#endif
