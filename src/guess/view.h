/* guess/view.h - which way is up, and the side from which a scene is seen. */
#ifndef HL_GUESS_VIEW_H
#define HL_GUESS_VIEW_H

#include "core/vector.h"
#include "guess/analysis.h"
#include "guess/outline.h"
#include "scene/scene.h"

/* Turns the view to the one of the three-quarter views (azimuths 30 and 60 from each of the four axes) that
 * is widest, so that a turn needs little more room. Flat matter is seen from higher up. outline: the scene's
 * outline; empty (zeros) means that it is found here. The caller releases it in any case. Fails only for lack
 * of memory. */
hl_status hl_view_widen(const hl_scene_description *description, hl_outline *outline, hl_view *view,
                        hl_error *error);

/* Does hl_camera_frame_view() for a scene whose outline may be known. outline: as for hl_view_widen(). */
hl_status hl_camera_frame_outline(const hl_scene_description *description, hl_outline *outline,
                                  const hl_view *view, double zoom, hl_camera *camera, hl_error *error);

/* The view that a scene without a camera gets. outline: as for hl_view_widen(); it stays empty where it is
 * not needed. */
hl_status hl_view_automatic(const hl_scene_description *description, hl_outline *outline, hl_view *view,
                            hl_error *error);

/* ---- which way up a volume is, where its file cannot say. */

/* The way up that was guessed for a volume. up: an axis of the world, or its opposite. azimuth_deg: azimuth
 * of the three-quarter view that shows most. */
typedef struct hl_upright {
  vec3 up;
  double azimuth_deg;
} hl_upright;

/* Finds which way is up in a volume whose file has no anatomy. Where the file turns the grid against the
 * world, z is up. In smoke, which comes from computer graphics, y is up. Scanned objects stand on their
 * bottom, or a face of the grid cuts them off there: the opposite way is up. Without a bottom, y points down
 * for objects that are symmetric only along z, as heads and vessels are from left to right. Otherwise z is
 * up. Both are turned over where the upper side of a symmetric object has more relief than the lower one.
 * The azimuth belongs to the three-quarter view whose sides have the most relief, so that heads show
 * their faces. Fails for lack of memory and when cancelled. */

hl_status hl_scene_upright(const hl_scene_volume *volume, const hl_data_analysis *analysis,
                           hl_upright *upright, hl_error *error);

#endif
