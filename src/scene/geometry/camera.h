/* scene/geometry/camera.h - finds a camera's axes, and the axes and cameras of views (hl_view). */
#ifndef HL_SCENE_GEOMETRY_CAMERA_H
#define HL_SCENE_GEOMETRY_CAMERA_H

#include <halflight/scene.h>
#include <stdbool.h>

#include "core/vector.h"

/* Finds the camera's unit axes: forward points from position to target; up is perpendicular to forward, and
 * as close to the camera's up as possible. Returns false if the camera's up lies along the line of sight. In
 * this case, z takes the place of the camera's up, or y if the line of sight is along z. */
bool hl_camera_basis(const hl_camera *camera, vec3 *right, vec3 *up, vec3 *forward);

#define HL_VIEW_AZIMUTH   30 /* azimuth of the three-quarter view, degrees */
#define HL_VIEW_ELEVATION 20

/* Finds the axes of a view's picture; unit vectors. */
void hl_view_axes(const hl_view *view, vec3 *right, vec3 *up, vec3 *forward);

/* Returns whether a view is possible: its up and front are unit vectors at a right angle, and its angles are
 * finite. */
bool hl_view_is_possible(const hl_view *view);

/* Places a camera at a distance from the target, in the direction from which a view looks. */
void hl_camera_place(const hl_view *view, vec3 target, double distance, hl_camera *camera);

/* Makes the three-quarter view in which a direction (of any length) is up. If a volume tells the anatomy, the
 * front of the view is the patient's front. */
void hl_view_about(const hl_scene_description *description, vec3 up, hl_view *view);

/* The anatomical space of the first volume that tells its space and is not rotated in the scene. */
hl_space hl_scene_space(const hl_scene_description *description);
/* Returns whether the space of hl_scene_space() surely tells the anatomy, as in files of DICOM and NIfTI. In
 * such a space, bodies stand upright along z. */
bool hl_scene_is_anatomical(const hl_scene_description *description);

#endif
