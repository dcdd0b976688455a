/* guess/view.c - finds which way is up in a volume whose file does not say it, and makes views from a side.
 *
 * Only the default camera depends on these guesses, never a coordinate. */
#include "guess/view.h"

#include <stdlib.h>
#include <string.h>

#include "core/context.h"
#include "core/door.h"
#include "core/error.h"
#include "core/memory.h"
#include "elementary/elementary.h"
#include "guess/looks.h"
#include "guess/sample.h"
#include "guess/seen_cells.h"
#include "scene/scene.h"

#define BEND 3 /* second differences measure the relief over this distance, in places of the lattice */
/* Only the largest body counts if it has at least this fraction of all solid places. */
#define BODY_AT_LEAST 0.4
/* The side that is turned to the eye must have this number of times the relief of the opposite side. */
#define CLEARLY 1.1
/* The elevation, in degrees, of the view of bodies that the grid cuts off: about the height of their eyes, as
 * in a portrait. From higher up, a head's forehead would hide its face. */
#define PORTRAIT_ELEVATION 5

/* The objects on a coarse lattice. */
typedef struct shape {
  int size[3];           /* places of the lattice along each axis */
  unsigned char *solid;  /* owned; [size[2]][size[1]][size[0]]; 1 where an object is */
  double *area[3];       /* owned; [size[a]]; solid places in each slice across axis a */
  int first[3], last[3]; /* first and last slice of the objects along each axis, leaving out 0.2 % of the
                          * objects' places at either end */
} shape;

static bool is_oriented(const hl_volume *volume) {
  for (int a = 0; a < 3; a++) {
    vec3 axis = vec3_normalise(mat3_column(volume->index_to_world.linear, a));
    const double component[3] = {axis.x, axis.y, axis.z};
    if (component[a] < 0.999999) return true;
  }
  return false;
}

static void release(hl_context *context, shape *s) {
  for (int a = 0; a < 3; a++) hl_release(context, s->area[a]);
  hl_release(context, s->solid);
}

static bool allocate(hl_context *context, const hl_volume *volume, size_t step, shape *s) {
  size_t count = 1;
  for (int a = 0; a < 3; a++) {
    s->size[a] = (int)((volume->dimension[a] + step - 1) / step);
    count *= (size_t)s->size[a];
    s->area[a] = hl_allocate_zeroed(context, (size_t)s->size[a], sizeof(double));
  }
  s->solid = hl_allocate_zeroed(context, count, 1);
  return s->solid != NULL && s->area[0] != NULL && s->area[1] != NULL && s->area[2] != NULL;
}

/* The index of the voxel at place n of the lattice along an axis. The lattice reaches both ends of each axis:
 * its last place is at the last voxel. */
static size_t place_of(const hl_volume *volume, const shape *s, size_t step, int axis, int n) {
  return n + 1 == s->size[axis] ? volume->dimension[axis] - 1 : (size_t)n * step;
}

static size_t place_in(const shape *s, int i, int j, int k) {
  return ((size_t)k * (size_t)s->size[1] + (size_t)j) * (size_t)s->size[0] + (size_t)i;
}

static size_t places_of(const shape *s) {
  return (size_t)s->size[0] * (size_t)s->size[1] * (size_t)s->size[2];
}

/* Returns whether an object is where the volume has this value. All labels are objects. */
static bool is_solid(const hl_volume *volume, const hl_data_analysis *analysis, double value) {
  if (analysis->kind == HL_DATA_LABELS) return value != hl_data_no_label(volume, analysis);
  return analysis->direction * (value - analysis->background) > analysis->solid;
}

/* Returns whether the volume holds objects that may stand on a bottom. */
static bool holds_objects(const hl_data_analysis *analysis) {
  return analysis->kind == HL_DATA_SURFACES || analysis->kind == HL_DATA_LABELS || analysis->is_mask;
}

static void fill(const hl_volume *volume, const hl_data_analysis *analysis, size_t step, shape *s) {
  unsigned char *solid = s->solid;
  for (int k = 0; k < s->size[2]; k++)
    for (int j = 0; j < s->size[1]; j++)
      for (int i = 0; i < s->size[0]; i++) {
        double value = hl_volume_value_within(volume, place_of(volume, s, step, 0, i),
                                              place_of(volume, s, step, 1, j),
                                              place_of(volume, s, step, 2, k));
        *solid++ = is_solid(volume, analysis, value);
      }
}

/* Keeps only the largest connected body, so that a board beside the body, for example, does not count. If all
 * bodies are small, the function keeps all of them. */
static hl_status forget_others(hl_context *context, shape *s, hl_error *error) {
  hl_bodies bodies;
  hl_status status = hl_bodies_find(context, s->solid, s->size, &bodies, error);
  double all = 0;
  for (uint32_t b = 1; status == HL_OK && b <= bodies.count; b++) all += bodies.places[b];
  if (status == HL_OK && bodies.places[bodies.largest] >= BODY_AT_LEAST * all)
    for (size_t p = 0; p < places_of(s); p++) s->solid[p] = s->solid[p] && bodies.body[p] == bodies.largest;
  hl_bodies_release(context, &bodies);
  return status;
}

static bool measure(shape *s) {
  double total = 0;
  const unsigned char *solid = s->solid;
  for (int k = 0; k < s->size[2]; k++)
    for (int j = 0; j < s->size[1]; j++)
      for (int i = 0; i < s->size[0]; i++)
        if (*solid++) s->area[0][i]++, s->area[1][j]++, s->area[2][k]++, total++;
  for (int a = 0; a < 3; a++) {
    double sum = 0;
    int n = 0;
    while (n + 1 < s->size[a] && (sum += s->area[a][n]) <= 0.002 * total) n++;
    s->first[a] = n;
    for (sum = 0, n = s->size[a] - 1; n > 0 && (sum += s->area[a][n]) <= 0.002 * total;) n--;
    s->last[a] = n > s->first[a] ? n : s->first[a];
  }
  return total > 0;
}

/* Makes the shape of the objects on the lattice. *any: whether the volume shows any object. */
static hl_status make_shape(const hl_volume *volume, const hl_data_analysis *analysis, shape *s, bool *any,
                            hl_error *error) {
  hl_context *context = volume->context;
  size_t step = hl_lattice_step(volume->dimension, HL_LATTICE_PLACES);
  memset(s, 0, sizeof *s);
  if (!allocate(context, volume, step, s))
    return hl_fail_memory(error, (size_t)HL_LATTICE_PLACES, "a volume's outline");
  fill(volume, analysis, step, s);
  hl_status status = forget_others(context, s, error);
  *any = status == HL_OK && measure(s);
  if (status == HL_OK && hl_cancelled(context))
    status = hl_fail(error, HL_ERROR_CANCELLED, "cancelled while looking at a volume");
  return status;
}

/* The fraction of the grid's face at one end of an axis that objects cover. */
static double touch(const shape *s, int axis, int end) {
  double face = (double)s->size[(axis + 1) % 3] * s->size[(axis + 2) % 3];
  return s->area[axis][end ? s->size[axis] - 1 : 0] / face;
}

/* The bluntness of the objects at one end: the mean area of the last slices, divided by the greatest area of
 * a slice. */
static double bluntness(const shape *s, int axis, int end) {
  double greatest = 1e-9, sum = 0;
  for (int n = s->first[axis]; n <= s->last[axis]; n++) greatest = fmax(greatest, s->area[axis][n]);
  int slices = 1 + (s->last[axis] - s->first[axis]) / 32;
  for (int n = 0; n < slices; n++) sum += s->area[axis][end ? s->last[axis] - n : s->first[axis] + n];
  return sum / slices / greatest;
}

/* The similarity of the objects to their mirror image across an axis: the number of places that belong to the
 * objects and to the image, divided by the number of places that belong to the objects or to the image. */
static double symmetry(const shape *s, int axis) {
  double both = 0, either = 0;
  int n[3];
  for (n[2] = s->first[2]; n[2] <= s->last[2]; n[2]++)
    for (n[1] = s->first[1]; n[1] <= s->last[1]; n[1]++)
      for (n[0] = s->first[0]; n[0] <= s->last[0]; n[0]++) {
        int m[3] = {n[0], n[1], n[2]};
        m[axis] = s->first[axis] + s->last[axis] - n[axis];
        int here = s->solid[place_in(s, n[0], n[1], n[2])], there = s->solid[place_in(s, m[0], m[1], m[2])];
        both += here && there;
        either += here || there;
      }
  return either > 0 ? both / either : 0;
}

/* The number of places from one end of an axis to the first solid place, in the row (u, v) of the other two
 * axes; -1 if the row has no solid place. */
static int depth_at(const shape *s, int axis, int end, int u, int v) {
  int n[3];
  n[(axis + 1) % 3] = u;
  n[(axis + 2) % 3] = v;
  for (int depth = 0; s->first[axis] + depth <= s->last[axis]; depth++) {
    n[axis] = end ? s->last[axis] - depth : s->first[axis] + depth;
    if (s->solid[place_in(s, n[0], n[1], n[2])]) return depth;
  }
  return -1;
}

/* The relief of the side at one end of an axis: the sum of the second differences of its depth. Each
 * difference is limited to 4, so that cliffs do not outweigh everything else. */
static double relief(const shape *s, int axis, int end) {
  int u_axis = (axis + 1) % 3, v_axis = (axis + 2) % 3;
  double sum = 0;
  for (int v = s->first[v_axis] + BEND; v <= s->last[v_axis] - BEND; v++)
    for (int u = s->first[u_axis] + BEND; u <= s->last[u_axis] - BEND; u++) {
      int depth = depth_at(s, axis, end, u, v);
      int across[4] = {depth_at(s, axis, end, u - BEND, v), depth_at(s, axis, end, u + BEND, v),
                       depth_at(s, axis, end, u, v - BEND), depth_at(s, axis, end, u, v + BEND)};
      for (int pair = 0; pair < 4; pair += 2)
        if (depth >= 0 && across[pair] >= 0 && across[pair + 1] >= 0)
          sum += fmin(abs(across[pair] - 2 * depth + across[pair + 1]), 4);
    }
  return sum;
}

/* The axis along which the objects are their own mirror image, as a head is from left to right; -1 if no
 * axis, or more than one, is such an axis. */
static int mirror_axis(const shape *s) {
  for (int a = 0; a < 3; a++) {
    double own = symmetry(s, a), others = fmax(symmetry(s, (a + 1) % 3), symmetry(s, (a + 2) % 3));
    if (own > 0.55 && own > 0.1 + others) return a;
  }
  return -1;
}

/* The up direction of objects without a bottom. If left and right lie along z, -y is up, because rows of
 * pictures run downwards; otherwise z is up. A head's vault is smooth, and its jaw is rough. So if objects
 * with a left and a right have clearly more relief on the upper side than on the lower side, the objects are
 * upside down.
 */
static int up_without_bottom(const shape *s) {
  const int mirror = mirror_axis(s), up = mirror == 2 ? -2 : 3, axis = abs(up) - 1;
  const bool overturned = mirror >= 0 && relief(s, axis, up > 0) > CLEARLY * relief(s, axis, up < 0);
  return overturned ? -up : up;
}

/* The axis that points up, as +-(axis + 1). The result is +3 (z) if nothing indicates another axis. */
static int up_of(const shape *s, const hl_volume *volume) {
  double extent[3], most = 0;
  int bottom = 0;
  for (int a = 0; a < 3; a++)
    extent[a] = (s->last[a] - s->first[a]) * vec3_length(mat3_column(volume->index_to_world.linear, a)) *
                (double)volume->dimension[a] / s->size[a];
  if (extent[2] > 1.4 * fmax(extent[0], extent[1])) return 3; /* a column stands upright */
  /* A face of the grid that cuts the object off is its bottom. */
  for (int a = 0; a < 3; a++)
    for (int end = 0; end < 2; end++)
      if (touch(s, a, end) > fmax(most, fmax(0.05, 4 * touch(s, a, !end)))) {
        most = touch(s, a, end);
        bottom = end ? a + 1 : -(a + 1);
      }
  if (bottom != 0) return -bottom;
  for (int a = 0; a < 3; a++) /* the object may also stand on a plate */
    for (int end = 0; end < 2; end++)
      if (bluntness(s, a, end) > fmax(most, 0.4) && bluntness(s, a, !end) < 0.1) {
        most = bluntness(s, a, end);
        bottom = end ? a + 1 : -(a + 1);
      }
  if (bottom != 0) return -bottom;
  return up_without_bottom(s);
}

static int axis_of(vec3 v, int *end) {
  int axis = fabs(v.x) > 0.5 ? 0 : fabs(v.y) > 0.5 ? 1 : 2;
  *end = v.x + v.y + v.z > 0;
  return axis;
}

/* Returns true if the side of the objects that v points to has clearly less relief than the opposite side. */
static bool opposite_shows_more(const shape *s, vec3 v) {
  int end, axis = axis_of(v, &end);
  return relief(s, axis, !end) > CLEARLY * relief(s, axis, end);
}

/* The three-quarter azimuth that shows the sides with most relief. up must be an axis. */
static double best_azimuth(const shape *s, const hl_view *view) {
  vec3 front = vec3_of(view->front), right = vec3_cross(vec3_of(view->up), front);
  double azimuth = opposite_shows_more(s, front) ? 180 - HL_VIEW_AZIMUTH : HL_VIEW_AZIMUTH;
  return opposite_shows_more(s, right) ? -azimuth : azimuth;
}

static vec3 axis_along(int up) {
  vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  return vec3_scale(axes[abs(up) - 1], up < 0 ? -1 : 1);
}

hl_status hl_scene_upright(const hl_scene_volume *volume, const hl_data_analysis *analysis,
                           hl_upright *upright, hl_error *error) {
  bool oriented = is_oriented(volume->volume), any = false;
  *upright = (hl_upright){axis_along(analysis->kind == HL_DATA_MEDIUM && !oriented ? 2 : 3), HL_VIEW_AZIMUTH};
  if (oriented || !holds_objects(analysis)) return HL_OK;
  shape s;
  hl_status status = make_shape(volume->volume, analysis, &s, &any, error);
  if (status == HL_OK && any) {
    const hl_scene_description alone = {.volumes = volume, .volume_count = 1};
    hl_view view;
    upright->up = axis_along(up_of(&s, volume->volume));
    hl_view_about(&alone, upright->up, &view);
    upright->azimuth_deg = best_azimuth(&s, &view);
  }
  release(volume->volume->context, &s);
  return status;
}

/* ---- views from a side ---- */

static vec3 left_of(hl_space space) { return (vec3){space == HL_SPACE_RAS ? -1 : 1, 0, 0}; }

/* Returns true if the first volume decides which way is up: the first volume is the only one and the scene
 * does not rotate it, or no volume is made of shapes, rotated or moved by the scene. In other scenes z counts
 * as up. */
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

hl_status hl_view_automatic(const hl_scene_description *description, hl_outline *outline, hl_view *view,
                            hl_error *error) {
  hl_view_about(description, (vec3){0, 0, 1}, view);
  if (description->volume_count == 0) return HL_OK;
  const hl_scene_volume *first = &description->volumes[0];
  hl_data_analysis analysis;
  hl_status status = hl_data_analyse(first->volume, &analysis, error);
  if (status != HL_OK) return status;
  /* Programs write the space left-posterior-superior for data of any kind, so that the space tells the
   * anatomy only in DICOM files. */
  const bool decides = !hl_scene_is_anatomical(description) && first_decides(description);
  if (decides) {
    hl_upright upright;
    status = hl_scene_upright(first, &analysis, &upright, error);
    if (status != HL_OK) return status;
    hl_view_about(description, upright.up, view);
    view->azimuth_deg = upright.azimuth_deg;
  }
  if (hl_is_body(first->volume, first->file, &analysis) && hl_data_is_cut_off(&analysis))
    view->elevation_deg = PORTRAIT_ELEVATION;
  return decides && !holds_objects(&analysis) ? hl_view_widen(description, outline, view, error) : HL_OK;
}

/* The azimuth of a view from the left: from the body's left where the file tells the anatomy, otherwise from
 * the viewer's left. */
static double azimuth_of_left(const hl_scene_description *description, const hl_view *view) {
  hl_space space = hl_scene_space(description);
  if (space == HL_SPACE_UNKNOWN) return -90;
  return vec3_dot(vec3_cross(vec3_of(view->up), vec3_of(view->front)), left_of(space)) > 0 ? 90 : -90;
}

/* Finds the azimuth of the front, in degrees. For most volumes the azimuth is 0. A scanned body whose file
 * does not tell the anatomy has its face on the side with more relief, which the automatic view shows. If the
 * automatic view shows the back of the grid, the azimuth is 180. */
static hl_status find_front(const hl_scene_description *description, const hl_view *automatic,
                            double *azimuth_deg, hl_error *error) {
  *azimuth_deg = 0;
  if (description->volume_count == 0 || fabs(automatic->azimuth_deg) < 90) return HL_OK;
  const hl_scene_volume *first = &description->volumes[0];
  hl_data_analysis analysis;
  hl_status status = hl_data_analyse(first->volume, &analysis, error);
  if (status == HL_OK && hl_is_body(first->volume, first->file, &analysis)) *azimuth_deg = 180;
  return status;
}

/* Returns whether the view's up is the direction to a body's head, as the volume's file tells. */
static bool stands_on_feet(const hl_scene_description *description, const hl_view *view) {
  return hl_scene_space(description) != HL_SPACE_UNKNOWN && view->up[2] > 0.999;
}

/* Turns a view to a side. front: the azimuth of the front, 0 or 180 degrees. Seen from its head or from its
 * feet, a body has its front at the picture's upper edge, as in atlases. The top of another volume is seen as
 * by somebody who stands before the volume and bends over it. */
static void look_from(const hl_scene_description *description, hl_side side, double front, hl_view *view) {
  const double left = azimuth_of_left(description, view), isometric = hl_atan(sqrt(0.5)) * 180 / HL_PI;
  const double azimuth[] = {[HL_SIDE_BACK] = 180,
                            [HL_SIDE_LEFT] = left,
                            [HL_SIDE_RIGHT] = -left,
                            [HL_SIDE_ISO] = 45,
                            [HL_SIDE_TOP] = stands_on_feet(description, view) ? 180 : 0};
  const double elevation[] = {[HL_SIDE_TOP] = 90, [HL_SIDE_BOTTOM] = -90, [HL_SIDE_ISO] = isometric};
  if (side == HL_SIDE_AUTOMATIC) return;
  view->azimuth_deg = azimuth[side] - (azimuth[side] > 0 ? front : -front);
  view->elevation_deg = elevation[side];
}

hl_status hl_view_choose(const hl_scene_description *description, hl_side side, const double up[3],
                         hl_view *view, hl_error *error) {
  HL_DOOR;
  if (description == NULL || view == NULL || description->volume_count + description->mesh_count == 0 ||
      (int)side < 0 || side > HL_SIDE_ISO)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "hl_view_choose: null description or view, no volume and no mesh, or no such side");
  for (size_t v = 0; v < description->volume_count; v++)
    if (description->volumes[v].volume == NULL)
      return hl_fail(error, HL_ERROR_ARGUMENT, "hl_view_choose: volume %zu is null", v);
  double length = up != NULL ? vec3_length(vec3_of(up)) : 1;
  if (!(length > 0 && isfinite(length)))
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "hl_view_choose: up has no direction: give a vector that is not 0");
  hl_outline outline = {0};
  hl_status status = hl_view_automatic(description, &outline, view, error);
  hl_outline_release(&outline);
  if (status != HL_OK) return status;
  double front = 0;
  bool differs = up != NULL && vec3_dot(vec3_of(up), vec3_of(view->up)) < length * (1 - 1e-12);
  if (differs) hl_view_about(description, vec3_of(up), view);
  else status = find_front(description, view, &front, error);
  look_from(description, side, front, view);
  return status;
}
