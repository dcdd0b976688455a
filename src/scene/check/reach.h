/* scene/check/reach.h - checks that floats can hold a scene's places and lengths in units of its voxels. */
#ifndef HL_SCENE_CHECK_REACH_H
#define HL_SCENE_CHECK_REACH_H

#include "scene/check/checker.h"
#include "scene/geometry/placement.h"

/* Two checks of a setting. One refuses a length that is too great, the other a point that is too far away.
 * key: the key of the setting, which belongs to the object that `check` names. */
hl_status hl_check_reach(const hl_checker *check, const char *key, double length,
                         const hl_frame_space *space);
hl_status hl_check_distance(const hl_checker *check, const char *key, const double point[3],
                            const hl_frame_space *space);

#endif
