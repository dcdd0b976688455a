/* scene/view.h - which way a scene is looked at: the inside of hl_view. */
#ifndef HL_SCENE_VIEW_H
#define HL_SCENE_VIEW_H

#include "scene/automatic.h"
#include "scene/scene.h"

#define HL_VIEW_AZIMUTH   30 /* of the three-quarter view, degrees */
#define HL_VIEW_ELEVATION 20

/* The picture's axes; unit. */
void hl_view_axes(const hl_view *view, vec3 *right, vec3 *up, vec3 *forward);

/* False where up and front are not unit vectors at a right angle, or an angle is not finite. */
bool hl_view_is_possible(const hl_view *view);

/* A camera so far from the target, looking as the view says. */
void hl_camera_place(const hl_view *view, vec3 target, double distance, hl_camera *camera);

/* The three-quarter view with this direction (of no set length) up: the front is the body's where a volume
 * has anatomy. */
void hl_view_about(const hl_scene_description *description, vec3 up, hl_view *view);

/* Turns the view to the one of the three-quarter views (azimuths 30 and 60 from each of the four axes) that
 * is widest, so that a turn needs little more room. Fails for lack of memory alone. */
hl_status hl_view_widen(const hl_scene_description *description, hl_view *view, hl_error *error);

/* The view that a scene without a camera gets. analysis: of its first volume, or null: it is made where it is
 * needed. */
hl_status hl_view_automatic(const hl_scene_description *description, const hl_data_analysis *analysis,
                            hl_view *view, hl_error *error);

#endif
