/* figure/map.c - finds the places on the page of points of a scene's world.
 *
 * Derived from the camera's definition: the height of an orthographic picture is camera->height units of the
 * world; the height of a perspective picture, at the depth d, is 2 d tan(fovy / 2) units. */
#include "figure/map.h"

#include "elementary/elementary.h"
#include "scene/geometry/camera.h"

hl_map hl_map_of(const hl_camera *camera, hl_rectangle picture) {
  hl_map map = {.eye = vec3_of(camera->position),
                .center_x = picture.left + picture.width / 2,
                .center_y = picture.top + picture.height / 2,
                .perspective = camera->type == HL_CAMERA_PERSPECTIVE};
  hl_camera_basis(camera, &map.right, &map.up, &map.forward);
  double seen = map.perspective ? 2 * hl_tan(camera->fovy_deg * HL_PI / 360) : camera->height;
  map.scale = picture.height / seen;
  map.target_depth = vec3_length(vec3_subtract(vec3_of(camera->target), map.eye));
  return map;
}

double hl_map_scale(const hl_map *map, double depth) {
  return map->perspective ? map->scale / depth : map->scale;
}

bool hl_map_point(const hl_map *map, vec3 world, double *x, double *y) {
  vec3 from_eye = vec3_subtract(world, map->eye);
  double depth = vec3_dot(from_eye, map->forward);
  if (map->perspective && !(depth > 0)) return false;
  double scale = hl_map_scale(map, depth);
  *x = map->center_x + scale * vec3_dot(from_eye, map->right);
  *y = map->center_y - scale * vec3_dot(from_eye, map->up);
  return true;
}
