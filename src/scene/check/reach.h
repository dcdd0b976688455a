/* scene/check/reach.h - checks that floats can hold a scene's places and lengths in units of its voxels. */
#ifndef HL_SCENE_CHECK_REACH_H
#define HL_SCENE_CHECK_REACH_H

#include "scene/check/checker.h"
#include "scene/geometry/placement.h"

/* hl_check_reach() refuses a length that is too great, and hl_check_distance() refuses a point that is too
 * far from the volumes. key: the key of the setting, which belongs to the object that `check` names. */
hl_status hl_check_reach(const hl_checker *check, const char *key, double length,
                         const hl_frame_space *space);
hl_status hl_check_distance(const hl_checker *check, const char *key, const double point[3],
                            const hl_frame_space *space);

#endif
