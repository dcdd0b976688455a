/* scene/view.c - views by name: from a side, with this or that up.
 *
 * In: a scene, of which anatomy or the shape of its things tells which way is up and where the front is. Out:
 * an hl_view. */
#include "scene/view.h"

#include "core/error.h"
#include "scene/upright.h"

#define OBLIQUE 0.9 /* cosine: an axis nearer to up than this is no front */

/* Anatomy holds while a volume is not turned in the scene. */
static hl_space space_of(const hl_scene_description *description) {
  for (size_t v = 0; v < description->volume_count; v++)
    if (description->volumes[v].volume->space != HL_SPACE_UNKNOWN &&
        description->volumes[v].rotate_angle_deg == 0)
      return description->volumes[v].volume->space;
  return HL_SPACE_UNKNOWN;
}

static vec3 front_of(hl_space space) { return (vec3){0, space == HL_SPACE_LPS ? -1 : 1, 0}; }
static vec3 left_of(hl_space space) { return (vec3){space == HL_SPACE_RAS ? -1 : 1, 0, 0}; }

static vec3 beside(vec3 v, vec3 up) {
  return vec3_normalise(vec3_subtract(v, vec3_scale(up, vec3_dot(v, up))));
}

void hl_view_about(const hl_scene_description *description, vec3 given_up, hl_view *view) {
  vec3 up = vec3_normalise(given_up), x = {1, 0, 0}, y = {0, 1, 0};
  hl_space space = space_of(description);
  vec3 front = vec3_cross(beside(fabs(up.x) < OBLIQUE ? x : y, up), up);
  if (space != HL_SPACE_UNKNOWN && fabs(vec3_dot(front_of(space), up)) < OBLIQUE)
    front = beside(front_of(space), up);
  *view = (hl_view){.up = {up.x, up.y, up.z},
                    .front = {front.x, front.y, front.z},
                    .azimuth_deg = HL_VIEW_AZIMUTH,
                    .elevation_deg = HL_VIEW_ELEVATION};
}

/* Who turns or moves volumes knows their way up, and so does who makes them of shapes; of several files as
 * they are, the first decides. */
static bool first_decides(const hl_scene_description *description) {
  if (description->volume_count == 1) return description->volumes[0].rotate_angle_deg == 0;
  for (size_t v = 0; v < description->volume_count; v++) {
    const hl_scene_volume *volume = &description->volumes[v];
    if (volume->shapes != NULL || volume->rotate_angle_deg != 0 ||
        vec3_length(vec3_of(volume->translate)) > 0)
      return false;
  }
  return true;
}

hl_status hl_view_automatic(const hl_scene_description *description, const hl_data_analysis *analysis,
                            hl_view *view, hl_error *error) {
  const hl_scene_volume *first = &description->volumes[0];
  hl_view_about(description, (vec3){0, 0, 1}, view);
  /* Left-posterior-superior is written for anything, grids along its axes are looked at;
   * right-anterior-superior is meant. */
  if (space_of(description) == HL_SPACE_RAS || !first_decides(description)) return HL_OK;
  hl_data_analysis made;
  hl_status status = analysis == NULL ? hl_data_analyse(first->volume, &made, error) : HL_OK;
  hl_upright upright;
  if (analysis == NULL) analysis = &made;
  if (status == HL_OK) status = hl_scene_upright(first, analysis, &upright, error);
  if (status != HL_OK) return status;
  hl_view_about(description, upright.up, view);
  view->azimuth_deg = upright.azimuth_deg;
  return analysis->kind == HL_DATA_SURFACES ? HL_OK : hl_view_widen(description, view, error);
}

/* Anatomy's left, where there is one: at the viewer's right unless the world is left-handed. */
static double azimuth_of_left(const hl_scene_description *description, const hl_view *view) {
  hl_space space = space_of(description);
  if (space == HL_SPACE_UNKNOWN) return -90;
  return vec3_dot(vec3_cross(vec3_of(view->up), vec3_of(view->front)), left_of(space)) > 0 ? 90 : -90;
}

static void look_from(const hl_scene_description *description, hl_side side, hl_view *view) {
  const double left = azimuth_of_left(description, view), isometric = atan(sqrt(0.5)) * 180 / HL_PI;
  const double azimuth[] = {
      [HL_SIDE_BACK] = 180, [HL_SIDE_LEFT] = left, [HL_SIDE_RIGHT] = -left, [HL_SIDE_ISO] = 45};
  const double elevation[] = {[HL_SIDE_TOP] = 90, [HL_SIDE_BOTTOM] = -90, [HL_SIDE_ISO] = isometric};
  if (side == HL_SIDE_AUTOMATIC) return;
  view->azimuth_deg = azimuth[side];
  view->elevation_deg = elevation[side];
}

hl_status hl_view_choose(const hl_scene_description *description, hl_side side, const double up[3],
                         hl_view *view, hl_error *error) {
  if (description == NULL || view == NULL || description->volume_count == 0 || (int)side < 0 ||
      side > HL_SIDE_ISO)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "hl_view_choose: null description or view, no volume, or no such side");
  for (size_t v = 0; v < description->volume_count; v++)
    if (description->volumes[v].volume == NULL)
      return hl_fail(error, HL_ERROR_ARGUMENT, "hl_view_choose: volume %zu is null", v);
  double length = up != NULL ? vec3_length(vec3_of(up)) : 1;
  if (!(length > 0 && isfinite(length)))
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "hl_view_choose: up has no direction: give a vector that is not 0");
  hl_status status = hl_view_automatic(description, NULL, view, error);
  if (status != HL_OK) return status;
  bool differs = up != NULL && vec3_dot(vec3_of(up), vec3_of(view->up)) < length * (1 - 1e-12);
  if (differs) hl_view_about(description, vec3_of(up), view);
  look_from(description, side, view);
  return HL_OK;
}
