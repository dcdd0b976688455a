/* guess/framing.c - places a camera so that everything seen fills the picture and is in its middle.
 *
 * Each side of the picture is a plane through the eye. The reach of the visible voxels' outline towards each
 * side decides the position of the nearest eye that has all visible voxels in the picture. With room for
 * turning, the eye stands farther away and turns about a fixed target. */
#include <string.h>

#include "core/door.h"
#include "core/error.h"
#include "elementary/elementary.h"
#include "guess/outline.h"
#include "guess/view.h"

/* The fraction of the picture's half width or height that the visible voxels fill, as seen from one
 * direction. */
#define FILLED 0.92
/* The eye moves back to make room for turning, as long as the outline fills at least this part of the
 * picture. */
#define FILLED_LEAST 0.82
/* During a turn the outline may reach beyond the picture by this factor. The factor is so small that the
 * picture cuts off only the outline's invisible rim. */
#define OVER 1.04
/* A view replaces an earlier one if it is wider by this factor. */
#define WIDER 1.04
/* To save room, a turn may be made about a target beside the middle of the visible voxels. The target's
 * distance from the middle is at most this fraction of the picture's sides. */
#define ASIDE 0.012

/* Matter counts as flat if its height is less than this fraction of its width. Flat matter is seen from
 * higher up. */
#define FLAT           0.25
#define FLAT_ELEVATION 40 /* degrees */

enum { TURNS = 36, HALVINGS = 48, SECTIONS = 12 };

/* The framing of a view. tangent_x, tangent_y: tangents of half the picture's angles; 0 for parallel
 * projection. */
typedef struct frame_job {
  const hl_outline *outline;
  vec3 right, up, forward;
  double aspect, tangent_x, tangent_y;
} frame_job;

/* The eye's coordinates along the view's axes. half_height: half the picture's height, for parallel
 * projection, which does not use `forward`. */
typedef struct frame_place {
  double right, up, forward, half_height;
} frame_place;

static double reach(const frame_job *job, vec3 along, double tangent) {
  return hl_outline_reach(job->outline, along, job->forward, tangent);
}

/* The depth of the nearest eye that sees the outline between two opposite sides of the picture. Derived: all
 * points lie between the plane x = ex + t (z - ez) and its mirror image, so ex - t ez >= l and -ex - t ez >=
 * r, where l and r are the outline's reaches to the two sides. Together ez <= -(l + r) / (2 t), with ex = (l
 * - r) / 2. */

static double nearest_eye(const frame_job *job, vec3 along, double tangent) {
  return -(reach(job, along, tangent) + reach(job, vec3_scale(along, -1), tangent)) / 2 / tangent;
}

/* The eye's coordinate along `along`, at a given depth, that puts the outline in the middle. Derived: both
 * sides of the outline are then seen at the same tangent t, and the depth is the result of nearest_eye() for
 * t. The depth grows with t, so t is found by halving. */
static double middle_from(const frame_job *job, vec3 along, double greatest, double depth) {
  double low = 0, high = greatest;
  for (int n = 0; n < HALVINGS && greatest > 0; n++) {
    double tangent = (low + high) / 2;
    if (nearest_eye(job, along, tangent) > depth) high = tangent;
    else low = tangent;
  }
  return (reach(job, along, high) - reach(job, vec3_scale(along, -1), high)) / 2;
}

/* The nearest eye, or in parallel projection the least height, with which the outline fills the fraction
 * `filled` of the picture. */
static frame_place fit(const frame_job *job, double filled) {
  frame_place place = {0};
  if (job->tangent_y > 0) {
    double by_width = nearest_eye(job, job->right, filled * job->tangent_x),
           by_height = nearest_eye(job, job->up, filled * job->tangent_y);
    place.forward = fmin(by_width, by_height);
  } else {
    double width = reach(job, job->right, 0) + reach(job, vec3_scale(job->right, -1), 0);
    double height = reach(job, job->up, 0) + reach(job, vec3_scale(job->up, -1), 0);
    place.half_height = fmax(height, width / job->aspect) / 2 / filled;
  }
  return place;
}

static void centre(const frame_job *job, frame_place *place) {
  place->right = middle_from(job, job->right, job->tangent_x, place->forward);
  place->up = middle_from(job, job->up, job->tangent_y, place->forward);
}

static vec3 point_at(const frame_job *job, const frame_place *place, double depth) {
  return vec3_add(vec3_add(vec3_scale(job->right, place->right), vec3_scale(job->up, place->up)),
                  vec3_scale(job->forward, depth));
}

/* ---- room for turning ---- */

/* The least distance of the eye from the target with which the whole outline stays in the picture; in
 * parallel projection, the least half height. Derived: for a side of the picture with tangent t, a point at x
 * and z from the target needs x <= t (distance + z). */
static double needed(const frame_job *job, vec3 target) {
  const vec3 along[4] = {job->right, vec3_scale(job->right, -1), job->up, vec3_scale(job->up, -1)};
  double most = 0;
  for (int side = 0; side < 4; side++) {
    double tangent = side < 2 ? job->tangent_x : job->tangent_y;
    double beyond = reach(job, along[side], tangent) - vec3_dot(target, along[side]) +
                    tangent * vec3_dot(target, job->forward);
    most = fmax(most, tangent > 0 ? beyond / tangent : beyond / (side < 2 ? job->aspect : 1));
  }
  return most;
}

static void look(frame_job *job, const hl_view *view) {
  hl_view_axes(view, &job->right, &job->up, &job->forward);
}

/* The least distance, or half height, that keeps the outline in the picture at all azimuths of a turn (see
 * needed()). */
static double needed_in_a_turn(const frame_job *job, const hl_view *view, vec3 target) {
  frame_job turned = *job;
  hl_view at = *view;
  double most = 0;
  for (int n = 0; n < TURNS; n++) {
    at.azimuth_deg = view->azimuth_deg + 360.0 * n / TURNS;
    look(&turned, &at);
    most = fmax(most, needed(&turned, target));
  }
  return most;
}

static double radius_about(const hl_outline *outline, vec3 target) {
  double greatest = 0;
  for (size_t n = 0; n < outline->count; n++)
    greatest = fmax(greatest, vec3_length(vec3_subtract(outline->point[n], target)) + outline->radius[n]);
  return greatest;
}

/* The least distance, or half height, that keeps the outline in the picture for all directions of view (see
 * needed()). */
static double needed_at_all(const frame_job *job, vec3 target) {
  double radius = radius_about(job->outline, target), tangent = fmin(job->tangent_x, job->tangent_y);
  return tangent > 0 ? radius * sqrt(1 + 1 / (tangent * tangent)) /* radius over the sine */
                     : radius / fmin(1, job->aspect);
}

/* The distance of the eye from a target at this depth; in parallel projection, half the picture's height. */
static double room_of(const frame_job *job, const frame_place *place, double depth) {
  return job->tangent_y > 0 ? depth - place->forward : place->half_height;
}

/* Moves the target along one axis to the place where a turn needs the least room. The room that a turn needs
 * is a maximum of linear functions and therefore convex, so that a golden-section search finds its minimum.
 */
static void improve(const frame_job *job, const hl_view *view, vec3 along, double reach_each_way,
                    vec3 *target) {
  const double ratio = (sqrt(5) - 1) / 2;
  double low = -reach_each_way, high = reach_each_way;
  for (int n = 0; n < SECTIONS; n++) {
    double a = high - ratio * (high - low), b = low + ratio * (high - low);
    bool lower = needed_in_a_turn(job, view, vec3_add(*target, vec3_scale(along, a))) <
                 needed_in_a_turn(job, view, vec3_add(*target, vec3_scale(along, b)));
    if (lower) high = b;
    else low = a;
  }
  *target = vec3_add(*target, vec3_scale(along, (low + high) / 2));
}

/* Moves the eye back to make room for turning. The function moves the target to the place where a turn needs
 * the least room: to any depth, but only a little to the side. few: the job with a thinned outline, which is
 * faster. Returns the target's depth. */
static double make_room(const frame_job *job, const frame_job *few, const hl_view *view, frame_place *place) {
  const frame_place tight = *place, loose = fit(job, FILLED_LEAST);
  double depth = (reach(job, job->forward, 0) - reach(job, vec3_scale(job->forward, -1), 0)) / 2;
  /* Seen from above or below, the object turns about the line of sight. The target's depth then does not
   * change the room that a turn needs. */
  bool depth_matters = fabs(vec3_dot(job->forward, vec3_normalise(vec3_of(view->up)))) < 1 - 1e-9;
  /* the loop repeats, because the middle depends slightly on the eye's distance */
  for (int round = 0; round < 3; round++) {
    centre(job, place);
    double room = room_of(job, place, depth),
           height = 2 * (job->tangent_y > 0 ? room * job->tangent_y : room);
    vec3 target = point_at(job, place, depth);
    if (depth_matters) improve(few, view, job->forward, radius_about(job->outline, target), &target);
    improve(few, view, job->right, ASIDE * height * job->aspect, &target);
    improve(few, view, job->up, ASIDE * height, &target);
    if (depth_matters) improve(few, view, job->forward, radius_about(job->outline, target) / 4, &target);
    depth = vec3_dot(target, job->forward);
    double turn = needed_in_a_turn(job, view, target), enough = room_of(job, &loose, depth);
    room = fmax(fmax(room_of(job, &tight, depth), turn / OVER), fmin(enough, needed_at_all(job, target)));
    *place = (frame_place){vec3_dot(target, job->right), vec3_dot(target, job->up), depth - room, room};
  }
  return depth;
}

/* ---- cameras ---- */

/* Begins to frame a view. outline: if it is empty (zeros), this function finds the outline. */
static hl_status begin(const hl_scene_description *description, double zoom, const hl_camera *camera,
                       hl_outline *outline, frame_job *job, hl_error *error) {
  bool perspective = camera->type == HL_CAMERA_PERSPECTIVE, possible = zoom >= 1e-6 && zoom <= 1e6;
  possible = possible && description->volume_count + description->mesh_count > 0 && description->width > 0 &&
             description->height > 0;
  possible = possible && (!perspective || (camera->fovy_deg > 0 && camera->fovy_deg < 180));
  for (size_t n = 0; n < description->volume_count; n++)
    possible = possible && description->volumes[n].volume != NULL;
  for (size_t n = 0; n < description->mesh_count; n++)
    possible = possible && description->meshes[n].mesh != NULL;
  if (!possible)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "a camera cannot be framed without a volume or a mesh, or with such a zoom, picture or "
                   "field of view");
  job->outline = outline;
  job->aspect = (double)description->width / description->height;
  job->tangent_y = perspective ? hl_tan(camera->fovy_deg * HL_PI / 360) : 0;
  job->tangent_x = job->tangent_y * job->aspect;
  return outline->context != NULL ? HL_OK : hl_outline_find(description, outline, error);
}

/* The eye's distance from the target. In parallel projection the distance does not change the picture, and
 * the eye is placed well in front of the outline. */
static double distance_to(const frame_job *job, const frame_place *place, double depth, double extent,
                          double zoom) {
  double wide = fmax(place->half_height, place->half_height * job->aspect);
  return job->tangent_y > 0 ? fmax(depth - place->forward, 1e-6 * extent) / zoom : extent / 2 + 2 * wide;
}

hl_status hl_camera_frame_outline(const hl_scene_description *description, hl_outline *outline,
                                  const hl_view *view, double zoom, hl_camera *camera, hl_error *error) {
  hl_outline thinned = {0};
  frame_job job;
  hl_status status = begin(description, zoom, camera, outline, &job, error);
  if (status == HL_OK) status = hl_outline_thin(outline, &thinned, error);
  if (status == HL_OK) {
    look(&job, view);
    frame_place place = fit(&job, FILLED);
    frame_job few = job;
    few.outline = &thinned;
    double depth = make_room(&job, &few, view, &place);
    vec3 target = point_at(&job, &place, depth);
    if (camera->type == HL_CAMERA_ORTHOGRAPHIC) camera->height = 2 * place.half_height / zoom;
    hl_camera_place(view, target, distance_to(&job, &place, depth, 2 * radius_about(outline, target), zoom),
                    camera);
  }
  hl_outline_release(&thinned);
  return status;
}

hl_status hl_camera_frame_view(const hl_scene_description *description, const hl_view *view, double zoom,
                               hl_camera *camera, hl_error *error) {
  HL_DOOR;
  if (description == NULL || view == NULL || camera == NULL || !hl_view_is_possible(view))
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "hl_camera_frame_view: null description or camera, or an impossible view");
  hl_outline outline = {0};
  hl_status status = hl_camera_frame_outline(description, &outline, view, zoom, camera, error);
  hl_outline_release(&outline);
  return status;
}

hl_status hl_camera_reframe(const hl_scene_description *description, hl_camera *camera, hl_error *error) {
  HL_DOOR;
  hl_view view;
  hl_status status = description != NULL ? hl_view_of_camera(description, &view) : HL_ERROR_ARGUMENT;
  if (status != HL_OK)
    return hl_fail(error, status, "hl_camera_reframe: null description, or a camera without a direction");
  return hl_camera_frame_view(description, &view, 1, camera, error);
}

/* The height of the outline along the view's up, divided by the smaller of its two widths. */
static double flatness(const hl_outline *outline, const hl_view *view) {
  const vec3 up = vec3_of(view->up), front = vec3_of(view->front), side = vec3_cross(up, front);
  const vec3 along[3] = {up, front, side};
  double extent[3];
  for (int a = 0; a < 3; a++)
    extent[a] = hl_outline_reach(outline, along[a], up, 0) +
                hl_outline_reach(outline, vec3_scale(along[a], -1), up, 0);
  return extent[0] / fmin(extent[1], extent[2]);
}

/* The matter in the faces of the first volume's grid that are turned to the eye, 0 to 3: the sum of each
 * face's share times the cosine between the face and the eye. */
static double seen_of_faces(const hl_scene_volume *volume, const double share[6], vec3 forward) {
  const affine3 placement = hl_scene_volume_index_to_world(volume);
  double seen = 0;
  for (int face = 0; face < 6; face++) {
    const vec3 axis = vec3_normalise(mat3_column(placement.linear, face / 2));
    seen += share[face] * fmax((face % 2 ? -1 : 1) * vec3_dot(axis, forward), 0);
  }
  return seen;
}

hl_status hl_view_widen(const hl_scene_description *description, hl_outline *outline, hl_view *view,
                        hl_error *error) {
  /* The three-quarter views to try are the given view turned by these multiples of HL_VIEW_AZIMUTH. */
  static const double turns[] = {0, -2, 4, 2, 1, -3, 5, 3};
  const hl_camera usual = {.type = HL_CAMERA_PERSPECTIVE, .fovy_deg = 30};
  hl_scene_description square = *description;
  square.width = square.height = 1;
  const hl_view given = *view;
  frame_job job;
  hl_status status = begin(&square, 1, &usual, outline, &job, error);
  double most = 0;
  if (status == HL_OK && flatness(outline, view) < FLAT) view->elevation_deg = FLAT_ELEVATION;
  for (size_t n = 0; status == HL_OK && n < sizeof turns / sizeof *turns; n++) {
    hl_view at = given;
    at.azimuth_deg += turns[n] * HL_VIEW_AZIMUTH;
    look(&job, &at);
    const double wide = (reach(&job, job.right, 0) + reach(&job, vec3_scale(job.right, -1), 0)) /
                        (1 + seen_of_faces(&description->volumes[0], outline->share, job.forward));
    if (wide <= WIDER * most) continue;
    most = wide;
    view->azimuth_deg = at.azimuth_deg;
  }
  return status;
}

/* Places the camera without room for turning. *job holds the camera's axes already. */
static void place_tightly(const frame_job *job, double zoom, hl_camera *camera) {
  double near = -reach(job, vec3_scale(job->forward, -1), 0), far = reach(job, job->forward, 0),
         depth = (near + far) / 2;
  frame_place place = fit(job, FILLED);
  centre(job, &place);
  vec3 target = point_at(job, &place, depth);
  vec3 position = vec3_subtract(target,
                                vec3_scale(job->forward, distance_to(job, &place, depth, far - near, zoom)));
  if (camera->type == HL_CAMERA_ORTHOGRAPHIC) camera->height = 2 * place.half_height / zoom;
  memcpy(camera->target, &target, sizeof camera->target);
  memcpy(camera->position, &position, sizeof camera->position);
  memcpy(camera->up, &job->up, sizeof camera->up);
}

hl_status hl_camera_frame(const hl_scene_description *description, double azimuth_deg, double elevation_deg,
                          double zoom, hl_camera *camera) {
  HL_DOOR;
  if (description == NULL || camera == NULL || !isfinite(azimuth_deg) || !isfinite(elevation_deg))
    return HL_ERROR_ARGUMENT;
  const hl_view view = {{0, 0, 1}, {0, -1, 0}, azimuth_deg, elevation_deg, 0};
  hl_outline outline = {0};
  frame_job job;
  hl_status status = begin(description, zoom, camera, &outline, &job, NULL);
  look(&job, &view);
  if (status == HL_OK) place_tightly(&job, zoom, camera);
  hl_outline_release(&outline);
  return status;
}

hl_status hl_camera_fit(const hl_scene_description *description, double zoom, hl_camera *camera) {
  HL_DOOR;
  if (description == NULL || camera == NULL) return HL_ERROR_ARGUMENT;
  double distance = vec3_length(vec3_subtract(vec3_of(camera->target), vec3_of(camera->position)));
  if (!(distance > 0 && isfinite(distance) && isfinite(vec3_length(vec3_of(camera->up)))))
    return HL_ERROR_ARGUMENT;
  hl_outline outline = {0};
  frame_job job;
  hl_status status = begin(description, zoom, camera, &outline, &job, NULL);
  hl_camera_basis(camera, &job.right, &job.up, &job.forward);
  if (status == HL_OK) place_tightly(&job, zoom, camera);
  hl_outline_release(&outline);
  return status;
}
