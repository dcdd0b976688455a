/* compose/camera.c - applies the options of the camera's place: "size", "view", "up", "azimuth", "elevation",
 * "roll", "zoom", "fovy" and "ortho". */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "compose/composer.h"
#include "compose/slice.h"
#include "core/context.h"
#include "core/vector.h"
#include "elementary/elementary.h"
#include "guess/cut_view.h"
#include "guess/looks.h"
#include "scene/geometry/camera.h"

static const double degree = HL_PI / 180;

static void subtract(const double a[3], const double b[3], double difference[3]) {
  for (int i = 0; i < 3; i++) difference[i] = a[i] - b[i];
}

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static double distance(const double a[3], const double b[3]) {
  double difference[3];
  subtract(a, b, difference);
  return sqrt(dot(difference, difference));
}

/* Applies --ortho and --fovy: changes the projection, but keeps the height of the world that the picture
 * shows at the target. */
static void change_projection(const hl_asked *asked, hl_camera *camera) {
  double away = distance(camera->position, camera->target);
  if (asked[HL_ASK_ORTHO].given && camera->type == HL_CAMERA_PERSPECTIVE) {
    camera->height = 2 * away * hl_tan(camera->fovy_deg * degree / 2);
    camera->type = HL_CAMERA_ORTHOGRAPHIC;
  }
  if (!asked[HL_ASK_FOVY].given) return;
  if (camera->type == HL_CAMERA_ORTHOGRAPHIC && away > 0) {
    double wanted = camera->height / (2 * hl_tan(asked[HL_ASK_FOVY].number[0] * degree / 2));
    for (int i = 0; i < 3; i++)
      camera->position[i] = camera->target[i] + (camera->position[i] - camera->target[i]) * wanted / away;
  }
  camera->type = HL_CAMERA_PERSPECTIVE;
  camera->fovy_deg = asked[HL_ASK_FOVY].number[0];
}

/* The axis of the world that a direction is nearest to, as the number 2 * axis, or 2 * axis + 1 if the
 * direction points to the axis' lower end. */
static int nearest_axis(vec3 direction) {
  const double along[3] = {direction.x, direction.y, direction.z};
  int axis = 0;
  for (int a = 1; a < 3; a++)
    if (fabs(along[a]) > fabs(along[axis])) axis = a;
  return 2 * axis + (along[axis] < 0);
}

/* The direction from the volumes to the eye. */
static vec3 towards_eye(const hl_view *view) {
  const vec3 up = vec3_of(view->up), front = vec3_of(view->front), right = vec3_cross(up, front);
  const double azimuth = view->azimuth_deg * degree, elevation = view->elevation_deg * degree;
  const vec3 level = vec3_add(vec3_scale(front, hl_cos(azimuth)), vec3_scale(right, hl_sin(azimuth)));
  return vec3_add(vec3_scale(level, hl_cos(elevation)), vec3_scale(up, hl_sin(elevation)));
}

/* If "view" asks for a side of a volume whose file does not tell the directions, logs which side of the
 * volume the picture shows. The function logs a line in two cases: if another axis than +z was taken for up,
 * and for bodies, because the supposed front of a body may be its back.
 */
static hl_status tell_of_side(const hl_composer *composer, const hl_scene_description *description,
                              const hl_view *view) {
  static const char *const axes[] = {"+x", "-x", "+y", "-y", "+z", "-z"};
  static const char *const places[] = {"x is greatest", "x is least",    "y is greatest",
                                       "y is least",    "z is greatest", "z is least"};
  static const char *const others[] = {
      [HL_SIDE_FRONT] = "back", [HL_SIDE_BACK] = "front", [HL_SIDE_LEFT] = "right", [HL_SIDE_RIGHT] = "left"};
  const hl_asked *side = &composer->asked[HL_ASK_VIEW];
  const hl_scene_volume *first = description->volume_count > 0 ? &description->volumes[0] : NULL;
  if (!composer->bare || !side->given || first == NULL || first->volume == NULL ||
      side->choice < HL_SIDE_FRONT || side->choice > HL_SIDE_BOTTOM || composer->asked[HL_ASK_UP].given ||
      composer->asked[HL_ASK_AZIMUTH].given || hl_scene_space(description) != HL_SPACE_UNKNOWN)
    return HL_OK;
  const char *place = places[nearest_axis(towards_eye(view))], *up = axes[nearest_axis(vec3_of(view->up))];
  hl_data_analysis analysis;
  hl_status status = hl_data_analyse(first->volume, &analysis, composer->error);
  if (status != HL_OK) return status;
  if (side->choice <= HL_SIDE_RIGHT && hl_is_body(first->volume, first->file, &analysis))
    hl_log(composer->context, HL_LOG_INFO,
           "the file does not tell the body's directions: --view %s is the side where %s; if it is the "
           "wrong one, give --view %s",
           side->text, place, others[side->choice]);
  else if (strcmp(up, "+z") != 0)
    hl_log(
        composer->context, HL_LOG_INFO,
        "the file does not tell which way is up: %s is taken, and --view %s is the side where %s; if it is "
        "the wrong one, give --up, as --up +z",
        up, side->text, place);
  return HL_OK;
}

/* Logs from which side the picture shows the top or the bottom of a volume, or a slice across z. Other
 * programs show some of these pictures as their mirror images. */
static void tell_of_mirror(const hl_composer *composer, const hl_scene_description *description,
                           const hl_view *view) {
  const hl_asked *asked = composer->asked, *side = &asked[HL_ASK_VIEW];
  const bool slice = asked[HL_ASK_SLICE].given, of_body = hl_scene_space(description) != HL_SPACE_UNKNOWN;
  const int from = nearest_axis(towards_eye(view)); /* 4: from the side of the greatest z; 5: from the side of
                                                     * the least z */
  if (!composer->bare || from < 4 || (!slice && (!side->given || !of_body)) || asked[HL_ASK_UP].given ||
      asked[HL_ASK_AZIMUTH].given || asked[HL_ASK_ELEVATION].given || asked[HL_ASK_ROLL].given)
    return;
  const bool above = from == 4;
  if (of_body)
    hl_log(composer->context, HL_LOG_INFO,
           "seen from the %s: the body's right is at the picture's %s, its front at the top; --axes "
           "letters writes the directions, and --view %s is the other side",
           above ? "head" : "feet, as in radiology", above ? "right" : "left", above ? "bottom" : "top");
  else
    hl_log(composer->context, HL_LOG_INFO,
           "seen from the %s, as by --view %s: x goes to the right and y %s; --view %s is the other side",
           above ? "top" : "bottom", above ? "top" : "bottom", above ? "up" : "down, as a picture's rows do",
           above ? "bottom" : "top");
}

/* Returns whether the view turns to the faces of cuts: the options cut a bare volume, and no option chooses
 * the view. */
static bool turns_to_cuts(const hl_composer *composer, const hl_scene_description *description) {
  const hl_asked *asked = composer->asked;
  return hl_cuts_bare_volume(composer, description) && !asked[HL_ASK_VIEW].given &&
         !asked[HL_ASK_AZIMUTH].given && !asked[HL_ASK_ELEVATION].given;
}

/* Finds the view to change: the view that "slice", "view" and "up" ask for. Without these options, the view
 * is the view of the scene's camera, or for a bare volume the automatic view. */
static hl_status choose_view(const hl_composer *composer, const hl_scene_description *description,
                             hl_view *view) {
  const hl_asked *asked = composer->asked, *up = &asked[HL_ASK_UP];
  if (hl_slice_view(composer, description, view)) return HL_OK;
  if (!composer->bare && !up->given && !asked[HL_ASK_VIEW].given) {
    if (hl_view_of_camera(description, view) == HL_OK) return HL_OK;
    return hl_fail(composer->error, HL_ERROR_ARGUMENT,
                   "the scene's camera looks nowhere: mend its position, target or up");
  }
  double vector[3];
  for (int axis = 0; axis < 3; axis++)
    vector[axis] = !up->chosen ? up->number[axis] : up->choice / 2 != axis ? 0 : up->choice % 2 ? -1 : 1;
  hl_side side = asked[HL_ASK_VIEW].given ? (hl_side)asked[HL_ASK_VIEW].choice : HL_SIDE_AUTOMATIC;
  if (up->given && vector[0] == 0 && vector[1] == 0 && vector[2] == 0)
    return hl_fail(composer->error, HL_ERROR_ARGUMENT,
                   "--up: '%.200s' has no direction: give an axis, as +z, or a vector that is not 0",
                   up->text);
  hl_status status = hl_blame_options(
      hl_view_choose(description, side, up->given ? vector : NULL, view, composer->error));
  if (status == HL_OK) status = tell_of_side(composer, description, view);
  if (status == HL_OK && turns_to_cuts(composer, description))
    hl_view_turn_to_cuts(&description->volumes[0], hl_count_cuts(asked), view);
  return status;
}

/* Sets the angles that options give. Returns false if the options do not change the view. */
static bool turn_view(const hl_asked *asked, hl_view *view) {
  const hl_view before = *view;
  if (asked[HL_ASK_AZIMUTH].given) view->azimuth_deg = asked[HL_ASK_AZIMUTH].number[0];
  if (asked[HL_ASK_ELEVATION].given) view->elevation_deg = asked[HL_ASK_ELEVATION].number[0];
  if (asked[HL_ASK_ROLL].given) view->roll_deg = asked[HL_ASK_ROLL].number[0];
  return view->azimuth_deg != before.azimuth_deg || view->elevation_deg != before.elevation_deg ||
         view->roll_deg != before.roll_deg;
}

/* Writes the option that cuts away the other side: "y=:0.5" for "y=0.5", and the reverse. For planes that are
 * written in another way, writes a general word. */
static void write_other_side(const char *typed, char *text, size_t size) {
  const bool is_short = strchr("xyz", typed[0]) != NULL && typed[0] != '\0' && typed[1] == '=';
  if (!is_short) snprintf(text, size, "with the opposite normal");
  else if (typed[2] == ':') snprintf(text, size, "%c=%.60s", typed[0], typed + 3);
  else snprintf(text, size, "%c=:%.60s", typed[0], typed + 2);
}

/* Logs that the faces of all planes that cut a bare volume look away from the eye, where options have chosen
 * the view. */
static void tell_of_hidden_faces(const hl_composer *composer, const hl_scene_description *description) {
  const hl_asked *asked = composer->asked, *planes = &asked[HL_ASK_CUT_PLANE];
  const hl_camera *camera = &description->camera;
  const size_t count = hl_count_cuts(asked);
  if (!hl_cuts_bare_volume(composer, description) || asked[HL_ASK_SLICE].given || !planes->given ||
      (size_t)planes->count != count || asked[HL_ASK_CLIP].given || turns_to_cuts(composer, description))
    return;
  const hl_scene_volume *volume = &description->volumes[0];
  if (volume->cut_count < count) return;
  for (size_t n = volume->cut_count - count; n < volume->cut_count; n++) {
    double to_eye[3];
    const bool parallel = camera->type == HL_CAMERA_ORTHOGRAPHIC;
    subtract(camera->position, parallel ? camera->target : volume->cuts[n].point, to_eye);
    if (dot(volume->cuts[n].normal, to_eye) > 0) return;
  }
  char other[80];
  write_other_side(planes->texts[0], other, sizeof other);
  hl_log(composer->context, HL_LOG_INFO,
         "the faces of the cut look away from the eye: --cut-plane %s cuts away the other side", other);
}

/* Places the camera. It frames the volumes before it is turned, so that all frames of a turn have the same
 * target and distance. */
static hl_status place(const hl_composer *composer, bool framed, size_t added,
                       hl_scene_description *description) {
  const hl_asked *asked = composer->asked;
  hl_view view;
  hl_scene_description without = *description;
  without.mesh_count -= added;
  hl_status status = choose_view(composer, &without, &view);
  if (status != HL_OK) return status;
  tell_of_mirror(composer, &without, &view);
  if (composer->bare && (composer->flags & HL_COMPOSE_SKY) == 0)
    memcpy(description->sky.up, view.up, sizeof view.up);
  double zoom = asked[HL_ASK_ZOOM].given ? asked[HL_ASK_ZOOM].number[0] : 1;
  if (framed) status = hl_camera_frame_view(description, &view, zoom, &description->camera, composer->error);
  if (status == HL_ERROR_MEMORY) return status;
  if (status == HL_OK && turn_view(asked, &view)) status = hl_camera_turn(&view, &description->camera);
  if (status == HL_OK) tell_of_hidden_faces(composer, description);
  if (status == HL_OK) return HL_OK;
  return hl_fail(
      composer->error, HL_ERROR_ARGUMENT,
      "--view, --up, --azimuth, --elevation, --roll, --zoom: no visible volume to frame: place the "
      "camera in the scene");
}

hl_status hl_compose_camera(const hl_composer *composer, bool seen, size_t added,
                            hl_scene_description *description) {
  const hl_asked *asked = composer->asked;
  if (asked[HL_ASK_SIZE].given) {
    description->width = (int)asked[HL_ASK_SIZE].number[0];
    description->height = (int)asked[HL_ASK_SIZE].number[1];
  }
  if ((composer->flags & HL_COMPOSE_CAMERA) != 0) return HL_OK;
  change_projection(asked, &description->camera);
  bool turned = asked[HL_ASK_AZIMUTH].given || asked[HL_ASK_ELEVATION].given || asked[HL_ASK_ROLL].given;
  bool reshaped = asked[HL_ASK_SIZE].given || asked[HL_ASK_FOVY].given || asked[HL_ASK_ORTHO].given;
  bool framed = asked[HL_ASK_ZOOM].given || asked[HL_ASK_VIEW].given || asked[HL_ASK_UP].given ||
                asked[HL_ASK_SLICE].given || (composer->bare && (reshaped || seen)) ||
                turns_to_cuts(composer, description);
  if (turned || framed) return place(composer, framed, added, description);
  bool taken_in = composer->bare && (composer->flags & HL_COMPOSE_MESHES) != 0;
  return taken_in ? hl_camera_reframe(description, &description->camera, composer->error) : HL_OK;
}
