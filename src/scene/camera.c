/* scene/camera.c - the camera's axes, a camera that frames what can be seen, and lights placed as seen by it.
 *
 * Framing: seen along a fixed direction, each side of the picture is a plane through the eye, so the nearest
 * eye that has every visible voxel inside all four planes follows from four maxima over the voxels. Of each
 * row of voxels only the first and the last visible one can be extreme.
 */
#include <string.h>

#include "scene/scene.h"
#include "scene/upright.h"

#define FILLED 0.92                  /* of the picture's half width or height */
#define FAINT 0.02                   /* of the greatest opacity: fainter voxels need not be in the picture */
#define TABLE 4096                   /* equal steps over the volume's range */
#define VOXELS_EXAMINED 40e6         /* of one volume: larger ones are sampled by rows */

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

/* What framing learns about the visible points; x, y, z are world units along right, up and forward. */
typedef struct extent {
  vec3 right, up, forward;      /* unit, world */
  double tangent_x, tangent_y;  /* half the picture's width and height at distance 1; 0: parallel */
  double side[4];               /* greatest x - z tx, -x - z tx, y - z ty, -y - z ty */
  double near, far;             /* along forward */
  bool any;
} extent;

static void extent_add(extent *e, vec3 p, double radius) {
  double x = vec3_dot(p, e->right), y = vec3_dot(p, e->up), z = vec3_dot(p, e->forward);
  double reach_x = radius * sqrt(1 + e->tangent_x * e->tangent_x);
  double reach_y = radius * sqrt(1 + e->tangent_y * e->tangent_y);
  e->side[0] = fmax(e->side[0], x - z * e->tangent_x + reach_x);
  e->side[1] = fmax(e->side[1], -x - z * e->tangent_x + reach_x);
  e->side[2] = fmax(e->side[2], y - z * e->tangent_y + reach_y);
  e->side[3] = fmax(e->side[3], -y - z * e->tangent_y + reach_y);
  e->near = fmin(e->near, z - radius);
  e->far = fmax(e->far, z + radius);
  e->any = true;
}

/* Which values count as visible: a table over the volume's range, exact where a step has both kinds. */
typedef struct visibility {
  const hl_transfer_function *function;
  double low, scale, threshold;
  unsigned char kind[TABLE]; /* 0: none, 1: all, 2: ask the function */
} visibility;

static double greatest_opacity(const hl_transfer_function *function, double low, double high) {
  double greatest =
      fmax(hl_transfer_function_opacity(function, low), hl_transfer_function_opacity(function, high));
  for (size_t p = 0; p < function->opacity_count; p++)
    if (function->opacity[p].value >= low && function->opacity[p].value <= high)
      greatest = fmax(greatest, function->opacity[p].opacity);
  return greatest;
}

/* False if nothing of the volume can be seen. */
static bool visibility_make(const hl_scene_volume *volume, visibility *visible) {
  const hl_volume *v = volume->volume;
  const hl_transfer_function *function = &volume->transfer_function;
  double greatest = greatest_opacity(function, v->minimum, v->maximum), range = v->maximum - v->minimum;
  if (!(greatest > 0)) return false;
  visible->function = function;
  visible->low = v->minimum;
  visible->scale = range > 0 ? TABLE / range : 0;
  visible->threshold = FAINT * greatest;
  memset(visible->kind, 2, sizeof visible->kind);
  size_t point = 0;
  for (int t = 0; t < TABLE; t++) { /* steps without a point inside are linear: their ends decide */
    double a = v->minimum + range * t / TABLE, b = v->minimum + range * (t + 1) / TABLE;
    while (point < function->opacity_count && function->opacity[point].value < a) point++;
    if (point < function->opacity_count && function->opacity[point].value <= b) continue;
    bool at_a = hl_transfer_function_opacity(function, a) >= visible->threshold;
    if (at_a == (hl_transfer_function_opacity(function, b) >= visible->threshold)) visible->kind[t] = at_a;
  }
  return true;
}

static bool is_visible(const visibility *visible, double value) {
  if (!isfinite(value)) return false;
  double t = (value - visible->low) * visible->scale;
  int kind = visible->kind[t < 0 ? 0 : t >= TABLE ? TABLE - 1 : (int)t];
  return kind == 2 ? hl_transfer_function_opacity(visible->function, value) >= visible->threshold : kind;
}

static double stored_value(const hl_volume *volume, size_t index) {
  double stored;
  if (volume->storage == HL_STORAGE_U8) stored = ((const unsigned char *)volume->voxels)[index];
  else if (volume->storage == HL_STORAGE_U16) stored = ((const uint16_t *)volume->voxels)[index];
  else stored = (double)((const float *)volume->voxels)[index];
  return volume->value_scale * stored + volume->value_offset;
}

/* Index range along axis a of the voxels whose centres are inside the volume's box; empty: *first > *last. */
static void box_range(const hl_scene_volume *volume, int a, ptrdiff_t *first, ptrdiff_t *last) {
  double low[3], high[3];
  hl_scene_volume_box(volume, low, high);
  *first = (ptrdiff_t)ceil(fmax(low[a], 0));
  *last = (ptrdiff_t)floor(fmin(high[a], (double)volume->volume->dimension[a] - 1));
}

static void extent_add_voxels(extent *e, const hl_scene_volume *volume, const visibility *visible) {
  const hl_volume *v = volume->volume;
  affine3 placement = hl_scene_volume_index_to_world(volume);
  vec3 diagonal = {vec3_length(mat3_column(placement.linear, 0)),
                   vec3_length(mat3_column(placement.linear, 1)),
                   vec3_length(mat3_column(placement.linear, 2))};
  double radius = 0.5 * vec3_length(diagonal);
  ptrdiff_t first[3], last[3];
  for (int a = 0; a < 3; a++) box_range(volume, a, &first[a], &last[a]);
  ptrdiff_t stride = (ptrdiff_t)ceil(sqrt((double)hl_volume_voxel_count(v) / VOXELS_EXAMINED));
  for (ptrdiff_t k = first[2]; k <= last[2]; k += stride)
    for (ptrdiff_t j = first[1]; j <= last[1]; j += stride) {
      size_t row = ((size_t)k * v->dimension[1] + (size_t)j) * v->dimension[0];
      ptrdiff_t left = first[0], right = last[0];
      while (left <= right && !is_visible(visible, stored_value(v, row + (size_t)left))) left++;
      if (left > right) continue;
      while (!is_visible(visible, stored_value(v, row + (size_t)right))) right--;
      extent_add(e, affine3_apply(placement, (vec3){(double)left, (double)j, (double)k}), radius);
      extent_add(e, affine3_apply(placement, (vec3){(double)right, (double)j, (double)k}), radius);
    }
}

static void extent_add_box(extent *e, const hl_scene_volume *volume) {
  affine3 placement = hl_scene_volume_index_to_world(volume);
  double low[3], high[3];
  hl_scene_volume_box(volume, low, high);
  for (int corner = 0; corner < 8; corner++) {
    vec3 index = {corner & 1 ? high[0] : low[0], corner & 2 ? high[1] : low[1],
                  corner & 4 ? high[2] : low[2]};
    extent_add(e, affine3_apply(placement, index), 0);
  }
}

static void extent_add_scene(extent *e, const hl_scene_description *description) {
  for (size_t n = 0; n < description->volume_count; n++) {
    const hl_scene_volume *volume = &description->volumes[n];
    visibility visible;
    if (volume->visible && visibility_make(volume, &visible)) extent_add_voxels(e, volume, &visible);
  }
  bool nothing = !e->any;
  for (size_t n = 0; nothing && n < description->volume_count; n++)
    extent_add_box(e, &description->volumes[n]);
}

/* Derived: the plane x = ex + tx (z - ez) and its three mirrors hold every point, so ex - tx ez >= side[0]
 * and -ex - tx ez >= side[1]; together ez <= -(side[0] + side[1]) / (2 tx), with ex = (side[0] - side[1])
 * / 2. */
static void place_camera(const extent *e, double aspect, double zoom, hl_camera *camera) {
  double x = (e->side[0] - e->side[1]) / 2, y = (e->side[2] - e->side[3]) / 2,
         middle = (e->near + e->far) / 2;
  double half_width = (e->side[0] + e->side[1]) / 2, half_height = (e->side[2] + e->side[3]) / 2, distance;
  if (camera->type == HL_CAMERA_ORTHOGRAPHIC) {
    double half = fmax(half_height, half_width / aspect);
    camera->height = 2 * half / FILLED / zoom;
    distance = (e->far - e->near) / 2 + 2 * fmax(half, half * aspect);
  } else {
    double eye = fmin(-half_width / e->tangent_x, -half_height / e->tangent_y);
    distance = fmax(middle - eye, 1e-6 * (e->far - e->near)) / zoom;
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
  for (int side = 0; side < 4; side++) e->side[side] = -INFINITY;
  e->near = INFINITY;
  e->far = -INFINITY;
  e->tangent_y = perspective ? FILLED * tan(camera->fovy_deg * HL_PI / 360) : 0;
  e->tangent_x = e->tangent_y * aspect;
  extent_add_scene(e, description);
  place_camera(e, aspect, zoom, camera);
  return HL_OK;
}

hl_status hl_camera_frame_upright(const hl_scene_description *description, hl_upright upright,
                                  double azimuth_deg, double elevation_deg, double zoom, hl_camera *camera) {
  extent e = {.any = false};
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
  extent e = {.any = false};
  hl_camera_basis(camera, &e.right, &e.up, &e.forward);
  return fit(description, zoom, &e, camera);
}
