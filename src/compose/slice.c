/* compose/slice.c - see slice.h. */
#include "compose/slice.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "compose/coordinates.h"
#include "core/context.h"
#include "core/memory.h"
#include "elementary/elementary.h"
#include "guess/analysis.h"
#include "scene/geometry/camera.h"
#include "scene/geometry/lengths.h"
#include "text/plain.h"
#include "volume/in_bricks.h"

/* The distance of a slice's sheets, in voxel edges. The picture shows the values on the first sheets behind
 * the plane. */
#define SHEET_SPACING 0.125

/* The direction from which a slice is seen. */
typedef struct slice_sight {
  int axis;                 /* number of the axis across the slice */
  double towards_eye;       /* 1 if the eye stands where the axis' coordinates are greater, else -1 */
  double up[3];             /* the direction that is up in the picture */
  hl_side side, other_side; /* the side of the volumes at which the eye stands, and the side opposite it */
} slice_sight;

/* A slice as it was typed. */
typedef struct typed_slice {
  int axis;        /* number of the axis across the slice; -1 if the text is no slice */
  bool is_of_body; /* whether a body's plane was named in place of an axis */
  const char *at;  /* the place on the axis, as text: the user's text, or "0.5" for the middle */
} typed_slice;

/* Reads AXIS or AXIS=AT. AXIS is x, y or z, or the name of one of a body's planes, because in all worlds
 * whose space is known, x goes from side to side, y from front to back and z along the body. */
static typed_slice read_slice(const char *text) {
  static const char *const planes[3] = {"sagittal", "coronal", "axial"};
  const size_t length = strcspn(text, "=");
  typed_slice slice = {.axis = length == 1 && *text >= 'x' && *text <= 'z' ? *text - 'x' : -1, .at = "0.5"};
  for (int axis = 0; axis < 3; axis++)
    if (strlen(planes[axis]) == length && strncmp(planes[axis], text, length) == 0)
      slice.axis = axis, slice.is_of_body = true;
  if (text[length] == '\0') return slice;
  hl_coordinate at;
  const char *rest = slice.at = text + length + 1;
  if (!hl_read_coordinate(&rest, &at) || !at.given || *rest != '\0') slice.axis = -1;
  return slice;
}

/* Finds the direction from which a slice across an axis is seen. In a world whose anatomical space is known,
 * slices are seen as radiologists look at them: the letters of the space's axes say at which end of the axis
 * the eye stands, and which direction is up. In other worlds the eye stands at the top, the front or the
 * right of the volumes, which "view" can name, too. */
static slice_sight find_sight(const hl_scene_description *description, int axis) {
  const char *letters = hl_space_name(hl_scene_space(description));
  const double front = letters != NULL && letters[1] == 'A' ? 1 : -1;
  if (axis == 2 && letters == NULL) return (slice_sight){2, 1, {0, 1, 0}, HL_SIDE_TOP, HL_SIDE_BOTTOM};
  if (axis == 2) return (slice_sight){2, -1, {0, front, 0}, HL_SIDE_BOTTOM, HL_SIDE_TOP};
  if (axis == 1) return (slice_sight){1, front, {0, 0, 1}, HL_SIDE_FRONT, HL_SIDE_BACK};
  if (letters == NULL) return (slice_sight){0, 1, {0, 0, 1}, HL_SIDE_RIGHT, HL_SIDE_LEFT};
  return (slice_sight){0, letters[0] == 'L' ? 1 : -1, {0, 0, 1}, HL_SIDE_LEFT, HL_SIDE_RIGHT};
}

/* The direction from which the slice of the option "slice" is seen; "view" may ask for the opposite side.
 * Seen from the opposite side, a slice across z, in a world without anatomical space, has the opposite
 * direction up, so that x still goes to the right. */
static slice_sight asked_sight(const hl_asked *asked, const hl_scene_description *description) {
  const hl_asked *view = &asked[HL_ASK_VIEW];
  slice_sight sight = find_sight(description, read_slice(asked[HL_ASK_SLICE].text).axis);
  if (!view->given || view->choice != (int)sight.other_side) return sight;
  sight.towards_eye = -sight.towards_eye;
  if (sight.axis == 2 && sight.other_side == HL_SIDE_BOTTOM) sight.up[1] = -1;
  return sight;
}

hl_status hl_check_slice(const hl_asked *asked, hl_error *error) {
  static const hl_ask excluded[] = {HL_ASK_LOOK, HL_ASK_THRESHOLD, HL_ASK_ISO,
                                    HL_ASK_UP,   HL_ASK_FLOOR,     HL_ASK_OUTLINE};
  static const hl_side sides[3][2] = {
      {HL_SIDE_LEFT, HL_SIDE_RIGHT}, {HL_SIDE_FRONT, HL_SIDE_BACK}, {HL_SIDE_BOTTOM, HL_SIDE_TOP}};
  static const char *const names[3] = {"left or right", "front or back", "bottom or top"};
  const hl_asked *slice = &asked[HL_ASK_SLICE], *view = &asked[HL_ASK_VIEW];
  if (!slice->given) return HL_OK;
  const int axis = read_slice(slice->text).axis;
  if (axis < 0)
    return hl_fail(
        error, HL_ERROR_ARGUMENT,
        "--slice: '%.200s' is not AXIS=AT: x, y, z, axial, coronal or sagittal, and a fraction from "
        "0 to 1 (z=0.5), or a coordinate in the file's world with its unit (z=40mm; u is the file's "
        "own unit, whatever it is)",
        slice->text);
  for (size_t n = 0; n < sizeof excluded / sizeof *excluded; n++)
    if (asked[excluded[n]].given)
      return hl_fail(error, HL_ERROR_ARGUMENT, "--slice and --%s exclude each other: give one of them",
                     hl_option_rows[excluded[n]].name);
  if (view->given && view->choice != (int)sides[axis][0] && view->choice != (int)sides[axis][1])
    return hl_fail(error, HL_ERROR_ARGUMENT, "--slice %.200s is seen from one of its sides: --view %s",
                   slice->text, names[axis]);
  return HL_OK;
}

static void choose(hl_asked *asked, int choice) {
  if (asked->given) return;
  asked->given = asked->chosen = true;
  asked->choice = choice;
}

size_t hl_count_values(const hl_scene_description *description) {
  size_t values = 0;
  for (size_t v = 0; v < description->volume_count; v++) values += description->volumes[v].label_count == 0;
  return values;
}

static bool shows_labels(const hl_scene_description *description, const hl_asked *asked) {
  return asked[HL_ASK_LABELS].given || asked[HL_ASK_MASK].given || asked[HL_ASK_SHOW].given ||
         hl_count_values(description) < description->volume_count;
}

static bool shows_levels(const hl_scene_description *description) {
  bool found = false;
  for (size_t v = 0; v < description->volume_count; v++)
    found |= hl_volume_has_levels(description->volumes[v].volume);
  return found;
}

hl_status hl_expand_slice(const hl_scene_description *description, hl_asked *asked, char *plane,
                          hl_error *error) {
  hl_asked *planes = &asked[HL_ASK_CUT_PLANE], *spacing = &asked[HL_ASK_SHEET_SPACING];
  if (!asked[HL_ASK_SLICE].given) return HL_OK;
  if (planes->count == HL_ASK_MOST_TEXTS)
    return hl_fail(error, HL_ERROR_ARGUMENT, "--slice: there is no room for one more --cut-plane");
  const typed_slice slice = read_slice(asked[HL_ASK_SLICE].text);
  const bool measured = slice.at[strspn(slice.at, "+-.0123456789")] != '\0'; /* whether the place is a length,
                                                                              * and not a fraction */
  const bool unitless = measured && !asked[HL_ASK_UNIT].given && !(hl_scene_world_metres(description) > 0);
  if (slice.is_of_body && hl_scene_space(description) == HL_SPACE_UNKNOWN)
    return hl_fail(
        error, HL_ERROR_ARGUMENT,
        "--slice: '%.200s': the file does not tell the body's directions%s: state them, as --space RAS, "
        "or give an axis, as --slice %c=%.60s%s",
        asked[HL_ASK_SLICE].text, unitless ? ", nor its unit of lengths" : "", 'x' + slice.axis, slice.at,
        unitless ? " --unit mm" : "");
  const slice_sight sight = asked_sight(asked, description);
  /* "z=AT" cuts away all matter from AT on, and "z=:AT" all matter before AT */
  snprintf(plane, HL_SLICE_TEXT, "%c=%s%.*s", 'x' + sight.axis, sight.towards_eye > 0 ? "" : ":",
           HL_SLICE_TEXT - 4, slice.at);
  planes->given = true;
  planes->text = planes->texts[planes->count++] = plane;
  asked[HL_ASK_ORTHO].given |= !asked[HL_ASK_FOVY].given;
  asked[HL_ASK_WHOLE].given = true;
  choose(&asked[HL_ASK_SHADING], HL_SHADING_FLAT);
  if (!spacing->given) *spacing = (hl_asked){.given = true, .number = {SHEET_SPACING}};
  if (!shows_labels(description, asked) && !shows_levels(description))
    choose(&asked[HL_ASK_KERNEL], HL_KERNEL_LINEAR);
  return HL_OK;
}

bool hl_slice_view(const hl_composer *composer, const hl_scene_description *description, hl_view *view) {
  if (!composer->asked[HL_ASK_SLICE].given) return false;
  const slice_sight sight = asked_sight(composer->asked, description);
  *view = (hl_view){0};
  view->front[sight.axis] = sight.towards_eye;
  memcpy(view->up, sight.up, sizeof view->up);
  return true;
}

bool hl_slice_range(const hl_volume *volume, char text[HL_SLICE_TEXT]) {
  static const double soft_tissue[2] = {-160, 240};
  const bool asked = volume->window[0] < volume->window[1];
  if (!asked && !hl_is_hounsfield(volume)) return false;
  const double *range = asked ? volume->window : soft_tissue;
  hl_plain_print(text, HL_SLICE_TEXT, "%.17g,%.17g", range[0], range[1]);
  return true;
}

hl_status hl_make_slice_opaque(const hl_composer *composer, const hl_scene_volume *volume,
                               hl_transfer_function *function) {
  enum { POINTS = 2 };
  static const double opaque = 0.999;
  hl_volume_info info = {.struct_size = sizeof info};
  if (hl_volume_get_info(volume->volume, &info) != HL_OK)
    return hl_fail(composer->error, HL_ERROR_INTERNAL, "--slice: the volume is not known");
  hl_opacity_point *points = hl_reallocate(composer->context, (void *)function->opacity, POINTS,
                                           sizeof *points);
  if (points == NULL) return hl_fail_memory(composer->error, POINTS * sizeof *points, "a transfer function");
  points[0] = (hl_opacity_point){info.range[0], opaque};
  points[1] = (hl_opacity_point){fmax(info.range[1], nextafter(info.range[0], INFINITY)), opaque};
  function->opacity = points;
  function->opacity_count = POINTS;
  function->gradient_opacity_count = 0;
  function->unit_distance = fmin(fmin(info.spacing[0], info.spacing[1]), info.spacing[2]) / 2 *
                            fabs(volume->scale);
  return HL_OK;
}

size_t hl_slice_layer(const hl_composer *composer, const hl_scene_description *description, size_t index) {
  bool mapped = false;
  size_t before = 0, values = 0;
  for (size_t v = 0; v < description->volume_count; v++) {
    if (description->volumes[v].label_count > 0) continue;
    mapped |= values > 0 && hl_has_colormap(composer, description, v);
    before += v < index;
    values++;
  }
  return mapped ? before + 1 : 0;
}

/* Derived: where several volumes have matter at one place, their colours are mixed in proportion to their
 * extinctions. A layer of a slice has `denser` times the extinction of the layer under it. The colour of the
 * picture then differs from the colour of the uppermost layer by a ten-thousandth at most. */
void hl_lay_slice_over(size_t below, hl_transfer_function *function) {
  static const double denser = 1e4;
  hl_opacity_point *points = (hl_opacity_point *)function->opacity;
  if (function->color_count > 1) {
    points[1] = (hl_opacity_point){function->color[0].value, points[0].opacity};
    points[0] = (hl_opacity_point){nextafter(points[1].value, -INFINITY), 0};
  }
  for (size_t n = 0; n < below; n++) function->unit_distance /= denser;
}

/* Derived: where n volumes are equally opaque, the picture has the mean of their colours; n times the mean is
 * their sum. */
void hl_compose_slice(const hl_composer *composer, hl_scene_description *description) {
  if (!composer->asked[HL_ASK_SLICE].given || !composer->bare) return;
  for (int c = 0; c < 3; c++) description->background[c] = 0;
  const size_t values = hl_count_values(description);
  if (values > 1 && hl_slice_layer(composer, description, 0) == 0)
    description->exposure = hl_log2((double)values);
}
