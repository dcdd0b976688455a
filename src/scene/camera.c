/* scene/camera.c - the camera's axes, a camera that frames what can be seen, and lights placed as seen by it. */
#include <string.h>

#include "scene/extent.h"
#include "scene/upright.h"

#define FILLED 0.92 /* of the picture's half width or height */

bool hl_camera_basis(const hl_camera *camera, vec3 *right, vec3 *up, vec3 *forward) {
  vec3 sight = vec3_subtract(vec3_of(camera->target), vec3_of(camera->position));
  vec3 given = vec3_normalise(vec3_of(camera->up));
  *forward = vec3_length(sight) > 0 ? vec3_normalise(sight) : (vec3){0, 1, 0};
  vec3 sideways = vec3_cross(*forward, given);
  bool useful = vec3_length(sideways) > 1e-6;
  if (!useful) {
    given = fabs(forward->z) < 0.999 ? (vec3){0, 0, 1} : (vec3){0, 1, 0};
    sideways = vec3_cross(*forward, given);
  }
  *right = vec3_normalise(sideways);
  *up = vec3_cross(*right, *forward);
  return useful;
}

void hl_light_direction(const hl_camera *camera, double azimuth_deg, double elevation_deg,
                        double direction[3]) {
  if (direction == NULL) return;
  for (int a = 0; a < 3; a++) direction[a] = 0;
  if (camera == NULL) return;
  vec3 right, up, forward;
  hl_camera_basis(camera, &right, &up, &forward);
  double azimuth = azimuth_deg * HL_PI / 180, elevation = elevation_deg * HL_PI / 180;
  vec3 to_light = vec3_scale(forward, -cos(elevation) * cos(azimuth));
  to_light = vec3_add(to_light, vec3_scale(right, cos(elevation) * sin(azimuth)));
  to_light = vec3_add(to_light, vec3_scale(up, sin(elevation)));
  direction[0] = -to_light.x;
  direction[1] = -to_light.y;
  direction[2] = -to_light.z;
}

/* Derived: the plane x = ex + tx (z - ez) and its three mirrors hold every point, so ex - tx ez >= l and -ex - tx ez >= r,
 * the bounds on the left and right; together ez <= -(l + r) / (2 tx), with ex = (l - r) / 2. */
static void place_camera(const extent *e, double aspect, double zoom, hl_camera *camera) {
  const double *bound = e->bound;
  double x = (bound[EXTENT_LEFT] - bound[EXTENT_RIGHT]) / 2, y = (bound[EXTENT_BOTTOM] - bound[EXTENT_TOP]) / 2;
  double near = -bound[EXTENT_NEAR], far = bound[EXTENT_FAR], middle = (near + far) / 2, distance;
  double half_width = (bound[EXTENT_LEFT] + bound[EXTENT_RIGHT]) / 2, half_height = (bound[EXTENT_BOTTOM] + bound[EXTENT_TOP]) / 2;
  if (camera->type == HL_CAMERA_ORTHOGRAPHIC) {
    double half = fmax(half_height, half_width / aspect);
    camera->height = 2 * half / FILLED / zoom;
    distance = (far - near) / 2 + 2 * fmax(half, half * aspect);
  } else {
    double eye = fmin(-half_width / e->tangent_x, -half_height / e->tangent_y);
    distance = fmax(middle - eye, 1e-6 * (far - near)) / zoom;
  }
  vec3 target =
      vec3_add(vec3_add(vec3_scale(e->right, x), vec3_scale(e->up, y)), vec3_scale(e->forward, middle));
  vec3 position = vec3_subtract(target, vec3_scale(e->forward, distance));
  memcpy(camera->target, &target, sizeof camera->target);
  memcpy(camera->position, &position, sizeof camera->position);
  memcpy(camera->up, &e->up, sizeof camera->up);
}

/* At azimuth 0 and elevation 0 the picture's axes are upright's; positive azimuth turns the eye to the right.
 * At elevation 90 the picture's up is where forward pointed on the horizon, so that up never jumps. */
static void set_axes(extent *e, hl_upright upright, double azimuth_deg, double elevation_deg) {
  double azimuth = azimuth_deg * HL_PI / 180, elevation = elevation_deg * HL_PI / 180;
  vec3 ahead = vec3_cross(upright.up, upright.right);
  vec3 horizon = vec3_add(vec3_scale(ahead, cos(azimuth)), vec3_scale(upright.right, -sin(azimuth)));
  e->right = vec3_add(vec3_scale(upright.right, cos(azimuth)), vec3_scale(ahead, sin(azimuth)));
  e->forward = vec3_add(vec3_scale(horizon, cos(elevation)), vec3_scale(upright.up, -sin(elevation)));
  e->up = vec3_add(vec3_scale(horizon, sin(elevation)), vec3_scale(upright.up, cos(elevation)));
}

/* Fits the camera to what is visible along axes that are already in *e. */
static hl_status fit(const hl_scene_description *description, double zoom, extent *e, hl_camera *camera) {
  if (description->volume_count == 0 || description->width < 1 || description->height < 1 ||
      !(zoom >= 1e-6 && zoom <= 1e6))
    return HL_ERROR_ARGUMENT;
  bool perspective = camera->type == HL_CAMERA_PERSPECTIVE;
  if (perspective && !(camera->fovy_deg > 0 && camera->fovy_deg < 180)) return HL_ERROR_ARGUMENT;
  for (size_t n = 0; n < description->volume_count; n++)
    if (description->volumes[n].volume == NULL) return HL_ERROR_ARGUMENT;
  double aspect = (double)description->width / description->height;
  for (int b = 0; b < EXTENT_BOUNDS; b++) e->bound[b] = -INFINITY;
  e->tangent_y = perspective ? FILLED * tan(camera->fovy_deg * HL_PI / 360) : 0;
  e->tangent_x = e->tangent_y * aspect;
  hl_extent_add_scene(e, description);
  place_camera(e, aspect, zoom, camera);
  return HL_OK;
}

hl_status hl_camera_frame_upright(const hl_scene_description *description, hl_upright upright,
                                  double azimuth_deg, double elevation_deg, double zoom, hl_camera *camera) {
  extent e;
  set_axes(&e, upright, azimuth_deg, elevation_deg);
  return fit(description, zoom, &e, camera);
}

hl_status hl_camera_frame(const hl_scene_description *description, double azimuth_deg, double elevation_deg,
                          double zoom, hl_camera *camera) {
  if (description == NULL || camera == NULL || !isfinite(azimuth_deg) || !isfinite(elevation_deg))
    return HL_ERROR_ARGUMENT;
  hl_upright upright = {{0, 0, 1}, {1, 0, 0}, 0};
  return hl_camera_frame_upright(description, upright, azimuth_deg, elevation_deg, zoom, camera);
}

hl_status hl_camera_fit(const hl_scene_description *description, double zoom, hl_camera *camera) {
  if (description == NULL || camera == NULL) return HL_ERROR_ARGUMENT;
  double distance = vec3_length(vec3_subtract(vec3_of(camera->target), vec3_of(camera->position)));
  if (!(distance > 0 && isfinite(distance) && isfinite(vec3_length(vec3_of(camera->up)))))
    return HL_ERROR_ARGUMENT;
  extent e;
  hl_camera_basis(camera, &e.right, &e.up, &e.forward);
  return fit(description, zoom, &e, camera);
}
