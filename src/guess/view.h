/* guess/view.h - finds which direction is up in a scene, and the side from which the scene is seen. */
#ifndef HL_GUESS_VIEW_H
#define HL_GUESS_VIEW_H

#include "core/vector.h"
#include "guess/analysis.h"
#include "guess/outline.h"
#include "scene/scene.h"

/* Turns the view to the widest of the three-quarter views (azimuths 30 and 60 from each of the four axes), so
 * that a turn needs little more room. A view counts as less wide where it sees faces in which the first
 * volume's grid cuts matter off. If matter is flat, the elevation becomes higher. outline: the scene's
 * outline; if it is empty (zeros), the function finds the outline. The caller releases the outline in any
 * case. Fails only for lack of memory. */
hl_status hl_view_widen(const hl_scene_description *description, hl_outline *outline, hl_view *view,
                        hl_error *error);

/* Frames a view as hl_camera_frame_view() does, for a scene whose outline may be known. outline: as for
 * hl_view_widen(). */
hl_status hl_camera_frame_outline(const hl_scene_description *description, hl_outline *outline,
                                  const hl_view *view, double zoom, hl_camera *camera, hl_error *error);

/* The view of a scene without a camera. outline: as for hl_view_widen(); an empty outline stays empty if the
 * view does not depend on the outline. */
hl_status hl_view_automatic(const hl_scene_description *description, hl_outline *outline, hl_view *view,
                            hl_error *error);

/* ---- which way up a volume is, where its file cannot say. */

/* The way up that was guessed for a volume. up: an axis of the world, or its opposite. azimuth_deg: azimuth
 * of the three-quarter view that shows the most. */
typedef struct hl_upright {
  vec3 up;
  double azimuth_deg;
} hl_upright;

/* Finds which way is up in a volume whose file does not tell the anatomy. If the file rotates the grid in the
 * world, z is up. In smoke, which comes from computer graphics, y is up. Scanned objects have a bottom, on
 * which they stand or where a face of the grid cuts them off; up is the opposite direction. Without a bottom,
 * -y is up for objects that are symmetric only along z, as heads and vessels are from left to right;
 * otherwise z is up. The directions -y and z are reversed if the upper side of a symmetric object has more
 * relief than the lower side. The azimuth belongs to the three-quarter view whose sides have the most relief,
 * so that heads show their faces. Fails for lack of memory and when cancelled. */

hl_status hl_scene_upright(const hl_scene_volume *volume, const hl_data_analysis *analysis,
                           hl_upright *upright, hl_error *error);

#endif
