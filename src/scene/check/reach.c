/* scene/check/reach.c - see check/reach.h. */
#include "scene/check/reach.h"

#include "core/vector.h"

hl_status hl_check_reach(const hl_checker *check, const char *key, double length,
                         const hl_frame_space *space) {
  if (length <= HL_LIMIT_REACH * space->unit) return HL_OK;
  return hl_fail(check->error, HL_ERROR_INPUT,
                 "%s/%s: reaches %.3g from the volumes, whose smallest voxel edge is %.3g: "
                 "use at most 1e12 times that, or a directional light or orthographic camera",
                 check->place, key, length, space->unit);
}

hl_status hl_check_distance(const hl_checker *check, const char *key, const double point[3],
                            const hl_frame_space *space) {
  return hl_check_reach(check, key, vec3_length(vec3_subtract(vec3_of(point), space->centre)), space);
}
