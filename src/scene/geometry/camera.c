/* scene/geometry/camera.c - computes a camera's axes and views, turns a camera to a view, joins cameras, and
 * finds directions of lights relative to a camera. */
#include "scene/geometry/camera.h"

#include <string.h>

#include "core/door.h"
#include "elementary/elementary.h"
#include "volume/volume.h"

/* In degrees. If a view's elevation is steeper than this angle, the direction that is up in the view is too
 * close to the line of sight to serve as the camera's up. */
#define STEEP 89.5
#define LEVEL 1e-6 /* a horizon counts as level if the sine of its angle is at most this */
/* angles that follow from a camera's rounded coordinates are rounded to multiples of one degree divided by
 * this number */
#define ANGLE_STEPS 1e9
/* The greatest cosine of the angle between `up` and an axis that may be the front of a view. */
#define OBLIQUE 0.9

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

/* Sets a plane through `point`. normal: points to the side that is inside. */
static void set_plane(vec3 normal, vec3 point, double plane[4]) {
  memcpy(plane, &normal, 3 * sizeof *plane);
  plane[3] = -vec3_dot(normal, point);
}

/* Derived: in perspective a point at x to the side and z in front of the eye is seen if |x| <= t z, where t
 * is the tangent of half the picture's angle: t z - x >= 0 and t z + x >= 0. In parallel projection a point
 * is seen if |x| <= h, where h is half the picture's side. */
hl_status hl_scene_seen_part(const hl_scene_description *description, double planes[4][4]) {
  HL_DOOR;
  if (description == NULL || planes == NULL || description->width <= 0 || description->height <= 0)
    return HL_ERROR_ARGUMENT;
  const hl_camera *camera = &description->camera;
  const bool perspective = camera->type == HL_CAMERA_PERSPECTIVE;
  const double aspect = (double)description->width / description->height;
  if (perspective ? !(camera->fovy_deg > 0 && camera->fovy_deg < 180) : !(camera->height > 0))
    return HL_ERROR_ARGUMENT;
  vec3 side[2], forward;
  hl_camera_basis(camera, &side[0], &side[1], &forward);
  for (int n = 0; n < 4; n++) {
    const double tall = perspective ? hl_tan(camera->fovy_deg * HL_PI / 360) : camera->height / 2;
    const double half = n < 2 ? tall * aspect : tall;
    const vec3 inwards = vec3_scale(side[n / 2], n % 2 == 0 ? 1 : -1), eye = vec3_of(camera->position);
    if (perspective) set_plane(vec3_add(inwards, vec3_scale(forward, half)), eye, planes[n]);
    else set_plane(inwards, vec3_subtract(eye, vec3_scale(inwards, half)), planes[n]);
  }
  return HL_OK;
}

void hl_light_direction_beside(double azimuth_deg, double elevation_deg, double direction[3]) {
  HL_DOOR;
  if (direction == NULL) return;
  double azimuth = azimuth_deg * HL_PI / 180, elevation = elevation_deg * HL_PI / 180;
  direction[0] = -hl_cos(elevation) * hl_sin(azimuth);
  direction[1] = -hl_sin(elevation);
  direction[2] = -hl_cos(elevation) * hl_cos(azimuth);
}

void hl_light_direction(const hl_camera *camera, double azimuth_deg, double elevation_deg,
                        double direction[3]) {
  HL_DOOR;
  if (direction == NULL) return;
  for (int a = 0; a < 3; a++) direction[a] = 0;
  if (camera == NULL) return;
  vec3 right, up, forward;
  double beside[3];
  hl_camera_basis(camera, &right, &up, &forward);
  hl_light_direction_beside(azimuth_deg, elevation_deg, beside);
  vec3 way = vec3_scale(forward, -beside[2]);
  way = vec3_add(way, vec3_scale(right, beside[0]));
  way = vec3_add(way, vec3_scale(up, beside[1]));
  memcpy(direction, &way, sizeof way);
}

/* The first volume that tells its anatomical space and is not rotated in the scene; null if the scene has no
 * such volume. */
static const hl_volume *first_in_space(const hl_scene_description *description) {
  for (size_t v = 0; v < description->volume_count; v++)
    if (description->volumes[v].volume->space != HL_SPACE_UNKNOWN &&
        description->volumes[v].rotate_angle_deg == 0)
      return description->volumes[v].volume;
  return NULL;
}

hl_space hl_scene_space(const hl_scene_description *description) {
  const hl_volume *volume = first_in_space(description);
  return volume != NULL ? volume->space : HL_SPACE_UNKNOWN;
}

bool hl_scene_is_anatomical(const hl_scene_description *description) {
  const hl_volume *volume = first_in_space(description);
  return volume != NULL && (volume->is_anatomical || volume->space == HL_SPACE_RAS);
}

static vec3 front_of(hl_space space) { return (vec3){0, space == HL_SPACE_LPS ? -1 : 1, 0}; }
static vec3 beside(vec3 v, vec3 up) {
  return vec3_normalise(vec3_subtract(v, vec3_scale(up, vec3_dot(v, up))));
}

void hl_view_about(const hl_scene_description *description, vec3 given_up, hl_view *view) {
  vec3 up = vec3_normalise(given_up), x = {1, 0, 0}, y = {0, 1, 0};
  hl_space space = hl_scene_space(description);
  vec3 front = vec3_cross(beside(fabs(up.x) < OBLIQUE ? x : y, up), up);
  if (space != HL_SPACE_UNKNOWN && fabs(vec3_dot(front_of(space), up)) < OBLIQUE)
    front = beside(front_of(space), up);
  *view = (hl_view){.up = {up.x, up.y, up.z},
                    .front = {front.x, front.y, front.z},
                    .azimuth_deg = HL_VIEW_AZIMUTH,
                    .elevation_deg = HL_VIEW_ELEVATION};
}

/* The direction to the right, as seen by an eye in front of the volumes (azimuth 0). */
static vec3 right_of_front(const hl_view *view) {
  return vec3_cross(vec3_of(view->up), vec3_of(view->front));
}

/* Finds the axes of a view. At elevation 90 the picture's up is the horizontal direction in which the camera
 * looked at elevation 0, so that up never jumps. */
void hl_view_axes(const hl_view *view, vec3 *right, vec3 *up, vec3 *forward) {
  double azimuth = view->azimuth_deg * HL_PI / 180, elevation = view->elevation_deg * HL_PI / 180,
         roll = view->roll_deg * HL_PI / 180;
  vec3 top = vec3_of(view->up), aside = right_of_front(view), ahead = vec3_scale(vec3_of(view->front), -1);
  vec3 horizon = vec3_add(vec3_scale(ahead, hl_cos(azimuth)), vec3_scale(aside, -hl_sin(azimuth)));
  vec3 level = vec3_add(vec3_scale(aside, hl_cos(azimuth)), vec3_scale(ahead, hl_sin(azimuth)));
  vec3 upward = vec3_add(vec3_scale(horizon, hl_sin(elevation)), vec3_scale(top, hl_cos(elevation)));
  *forward = vec3_add(vec3_scale(horizon, hl_cos(elevation)), vec3_scale(top, -hl_sin(elevation)));
  *right = vec3_add(vec3_scale(level, hl_cos(roll)), vec3_scale(upward, hl_sin(roll)));
  *up = vec3_add(vec3_scale(upward, hl_cos(roll)), vec3_scale(level, -hl_sin(roll)));
}

void hl_camera_place(const hl_view *view, vec3 target, double distance, hl_camera *camera) {
  vec3 right, up, forward;
  hl_view_axes(view, &right, &up, &forward);
  vec3 position = vec3_subtract(target, vec3_scale(forward, distance));
  if (view->roll_deg == 0 && fabs(view->elevation_deg) < STEEP) up = vec3_of(view->up);
  memcpy(camera->target, &target, sizeof camera->target);
  memcpy(camera->position, &position, sizeof camera->position);
  memcpy(camera->up, &up, sizeof camera->up);
}

static double distance_of(const hl_camera *camera) {
  return vec3_length(vec3_subtract(vec3_of(camera->target), vec3_of(camera->position)));
}

bool hl_view_is_possible(const hl_view *view) {
  vec3 up = vec3_of(view->up), front = vec3_of(view->front);
  return fabs(vec3_length(up) - 1) < LEVEL && fabs(vec3_length(front) - 1) < LEVEL &&
         fabs(vec3_dot(up, front)) < LEVEL && isfinite(view->azimuth_deg) && isfinite(view->elevation_deg) &&
         isfinite(view->roll_deg);
}

hl_status hl_camera_turn(const hl_view *view, hl_camera *camera) {
  HL_DOOR;
  if (view == NULL || camera == NULL || !hl_view_is_possible(view)) return HL_ERROR_ARGUMENT;
  double distance = distance_of(camera);
  if (!(distance > 0 && isfinite(distance))) return HL_ERROR_ARGUMENT;
  hl_camera_place(view, vec3_of(camera->target), distance, camera);
  return HL_OK;
}

/* Finds the direction that is up for a camera. Usually this direction is the camera's up vector. If the up
 * vector is perpendicular to the line of sight and the picture is level for an axis of the world, this axis
 * takes the vector's place: the first such axis of z, y, x and their opposites. */
static vec3 upright_of(const hl_camera *camera) {
  static const vec3 axes[] = {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}, {0, 0, -1}, {0, -1, 0}, {-1, 0, 0}};
  vec3 right, up, forward, given = vec3_normalise(vec3_of(camera->up));
  if (!hl_camera_basis(camera, &right, &up, &forward)) given = up;
  if (fabs(given.x) + fabs(given.y) + fabs(given.z) == 1 || fabs(vec3_dot(given, forward)) > LEVEL)
    return given;
  for (int a = 0; a < 6; a++)
    if (fabs(vec3_dot(axes[a], right)) < LEVEL && vec3_dot(axes[a], up) > 0.01) return axes[a];
  return given;
}

static double rounded(double degrees) { return round(degrees * ANGLE_STEPS) / ANGLE_STEPS; }

hl_status hl_view_of_camera(const hl_scene_description *description, hl_view *view) {
  HL_DOOR;
  if (description == NULL || view == NULL) return HL_ERROR_ARGUMENT;
  const hl_camera *camera = &description->camera;
  double distance = distance_of(camera);
  if (!(distance > 0 && isfinite(distance) && isfinite(vec3_length(vec3_of(camera->up)))))
    return HL_ERROR_ARGUMENT;
  hl_view_about(description, upright_of(camera), view);
  vec3 eye = vec3_subtract(vec3_of(camera->position), vec3_of(camera->target));
  double across = vec3_dot(eye, right_of_front(view)), near = vec3_dot(eye, vec3_of(view->front));
  view->elevation_deg = rounded(hl_atan2(vec3_dot(eye, vec3_of(view->up)), hl_hypot(across, near)) * 180 /
                                HL_PI);
  view->azimuth_deg = rounded(hl_atan2(across, near) * 180 / HL_PI);
  return HL_OK;
}

/* ---- joining cameras ---- */

/* The two borders of a picture along one of the picture's axes, at the depth 0 of the world. */
typedef struct borders {
  double low, high;
} borders;

static void widen(borders *all, borders one) {
  all->low = fmin(all->low, one.low);
  all->high = fmax(all->high, one.high);
}

static bool are_equal(borders a, borders b) { return a.low == b.low && a.high == b.high; }

/* Finds the two borders of a picture along one axis. Derived: let f be the depth of the eye, and t the
 * tangent of half the angle of view. At a depth z the picture reaches t (z - f) to both sides of the eye. At
 * the depth 0, this reach is half = -t f, which may be negative. In parallel projection, half is the same at
 * all depths. */
static borders borders_of(double eye, double half) { return (borders){eye - half, eye + half}; }

static bool look_alike(const hl_camera *a, const hl_camera *b) {
  const double rounding = 1e-9;
  vec3 right[2], up[2], forward[2];
  hl_camera_basis(a, &right[0], &up[0], &forward[0]);
  hl_camera_basis(b, &right[1], &up[1], &forward[1]);
  return a->type == b->type && (a->type != HL_CAMERA_PERSPECTIVE || a->fovy_deg == b->fovy_deg) &&
         vec3_length(vec3_subtract(forward[0], forward[1])) < rounding &&
         vec3_length(vec3_subtract(up[0], up[1])) < rounding;
}

static bool can_join(const hl_camera *cameras, size_t count, double aspect) {
  bool possible = cameras != NULL && count > 0 && aspect > 0 && isfinite(aspect);
  for (size_t n = 0; possible && n < count; n++) {
    const double distance = distance_of(&cameras[n]);
    possible = distance > 0 && isfinite(distance) && look_alike(&cameras[0], &cameras[n]);
  }
  return possible &&
         (cameras[0].type != HL_CAMERA_PERSPECTIVE || (cameras[0].fovy_deg > 0 && cameras[0].fovy_deg < 180));
}

hl_status hl_camera_join(const hl_camera *cameras, size_t count, double aspect, hl_camera *joined) {
  HL_DOOR;
  if (joined == NULL || !can_join(cameras, count, aspect)) return HL_ERROR_ARGUMENT;
  const hl_camera *first = &cameras[0];
  const bool perspective = first->type == HL_CAMERA_PERSPECTIVE;
  const double tangent = perspective ? hl_tan(first->fovy_deg * HL_PI / 360) : 0;
  const borders none = {INFINITY, -INFINITY};
  borders across = none, along = none, own_across = none, own_along = none;
  double depth = INFINITY;
  vec3 right, up, forward;
  hl_camera_basis(first, &right, &up, &forward);
  for (size_t n = 0; n < count; n++) {
    const vec3 eye = vec3_of(cameras[n].position);
    const double eye_depth = vec3_dot(eye, forward),
                 half = perspective ? -tangent * eye_depth : cameras[n].height / 2;
    widen(&across, borders_of(vec3_dot(eye, right), half * aspect));
    widen(&along, borders_of(vec3_dot(eye, up), half));
    depth = fmin(depth, eye_depth);
    if (n == 0) own_across = across, own_along = along;
  }
  const hl_camera same = *first;
  *joined = same;
  if (are_equal(across, own_across) && are_equal(along, own_along) &&
      (perspective || depth == vec3_dot(vec3_of(same.position), forward)))
    return HL_OK;
  const double width = across.high - across.low, height = along.high - along.low;
  if (perspective) depth = -fmax(width / aspect, height) / (2 * tangent);
  else joined->height = fmax(width / aspect, height);
  const vec3 middle = vec3_add(vec3_scale(right, (across.low + across.high) / 2),
                               vec3_scale(up, (along.low + along.high) / 2));
  const vec3 position = vec3_add(middle, vec3_scale(forward, depth)),
             target = vec3_add(middle, vec3_scale(forward, vec3_dot(vec3_of(same.target), forward)));
  memcpy(joined->position, &position, sizeof joined->position);
  memcpy(joined->target, &target, sizeof joined->target);
  return HL_OK;
}
