/* guess/floor.c - makes a floor below everything that a scene shows. */
#include <math.h>

#include <halflight/compose.h>

#include "core/door.h"
#include "core/error.h"
#include "guess/outline.h"
#include "scene/geometry/placement.h"

/* Two directions along the floor: the two axes of the world that are most nearly level. */
static void level_axes(vec3 up, vec3 *u, vec3 *v) {
  vec3 axis = fabs(up.x) <= fabs(up.y) && fabs(up.x) <= fabs(up.z) ? (vec3){1, 0, 0}
              : fabs(up.y) <= fabs(up.z)                           ? (vec3){0, 1, 0}
                                                                   : (vec3){0, 0, 1};
  *u = vec3_normalise(vec3_subtract(axis, vec3_scale(up, vec3_dot(axis, up))));
  *v = vec3_cross(up, *u);
}

/* The corners of a floor under an outline, counter-clockwise as seen from above. */
static void find_corners(const hl_outline *outline, vec3 up, double size, float corners[4][3]) {
  vec3 u, v, none = {0, 0, 0};
  level_axes(up, &u, &v);
  double right = hl_outline_reach(outline, u, none, 0),
         left = hl_outline_reach(outline, vec3_scale(u, -1), none, 0),
         front = hl_outline_reach(outline, v, none, 0),
         back = hl_outline_reach(outline, vec3_scale(v, -1), none, 0),
         below = hl_outline_reach(outline, vec3_scale(up, -1), none, 0);
  double half = size * fmax(right + left, front + back) / 2;
  vec3 middle = vec3_add(vec3_scale(up, -below),
                         vec3_add(vec3_scale(u, (right - left) / 2), vec3_scale(v, (front - back) / 2)));
  for (int i = 0; i < 4; i++) {
    double a = i == 1 || i == 2 ? half : -half, b = i >= 2 ? half : -half;
    vec3_store(corners[i], vec3_add(middle, vec3_add(vec3_scale(u, a), vec3_scale(v, b))));
  }
}

hl_status hl_scene_make_floor(hl_context *context, const hl_scene_description *description,
                              const double up[3], double size, hl_mesh **mesh, hl_error *error) {
  HL_DOOR;
  static const uint32_t triangles[2][3] = {{0, 1, 2}, {0, 2, 3}};
  if (context == NULL || description == NULL || mesh == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_scene_make_floor: null context, description or mesh");
  *mesh = NULL;
  hl_view view;
  vec3 upwards = {0, 0, 0};
  if (up != NULL) upwards = vec3_normalise(vec3_of(up));
  else if (hl_view_of_camera(description, &view) == HL_OK) upwards = vec3_normalise(vec3_of(view.up));
  if (!(vec3_length(upwards) > 0.5))
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_scene_make_floor: no way is up: give one");
  if (!(size >= 1 && size <= 1000))
    return hl_fail(error, HL_ERROR_INPUT, "the floor's size is %g: give 1 to 1000 times what stands on it",
                   size);
  hl_outline outline;
  float corners[4][3];
  hl_status status = hl_outline_find(description, &outline, error);
  if (status == HL_OK) {
    find_corners(&outline, upwards, size, corners);
    hl_mesh_description floor;
    hl_mesh_description_defaults(&floor);
    floor.positions = (const float(*)[3])corners;
    floor.vertex_count = 4;
    floor.triangles = triangles;
    floor.triangle_count = 2;
    status = hl_mesh_create(context, &floor, mesh, error);
  }
  hl_outline_release(&outline);
  return status;
}
