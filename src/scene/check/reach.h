/* scene/check/reach.h - checks that floats hold places and lengths of a scene beside its voxels. */
#ifndef HL_SCENE_CHECK_REACH_H
#define HL_SCENE_CHECK_REACH_H

#include "scene/check/checker.h"
#include "scene/geometry/placement.h"

/* Refuses a length that is too great, or a point that is too far away. key: the setting's key, in the light
 * or the camera that `check` names. */
hl_status hl_check_reach(const hl_checker *check, const char *key, double length,
                         const hl_frame_space *space);
hl_status hl_check_distance(const hl_checker *check, const char *key, const double point[3],
                            const hl_frame_space *space);

#endif
