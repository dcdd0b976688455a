/* compose/cuts.c - applies the options "cut-plane" POINT:NORMAL or AXIS=AT, "cut-box" RANGES and "cut-sphere"
 * CENTRE:RADIUS, which cut parts out of volumes. In a scene of one volume, the options' numbers are in the
 * world of the volume's file; in a scene of several volumes, they are in the scene's world. A value that
 * begins with NAME= cuts the volume NAME alone, and the value's numbers are in the world of this volume's
 * file. */
#include <math.h>
#include <string.h>

#include "compose/composer.h"
#include "compose/coordinates.h"
#include "core/context.h"
#include "text/plain.h"

/* The option that makes each type of cut. */
static const int option_of[] = {
    [HL_CUT_PLANE] = HL_ASK_CUT_PLANE, [HL_CUT_BOX] = HL_ASK_CUT_BOX, [HL_CUT_SPHERE] = HL_ASK_CUT_SPHERE};
enum { CUT_TYPES = 3 };

/* A cut as the user typed it: a plane has a point and a normal, a sphere has a centre (in `point`) and a
 * radius, and a box has ranges. */
typedef struct typed_cut {
  hl_coordinate point[3], radius;
  double normal[3];
  hl_axis_range box[3]; /* one range for each axis; a range that is not given has no ends */
} typed_cut;

static bool read_point(const char **text, hl_coordinate point[3]) {
  for (int a = 0; a < 3; a++) {
    if (!hl_read_coordinate(text, &point[a]) || !point[a].given) return false;
    if (*(*text)++ != (a < 2 ? ',' : ':')) return false;
  }
  return true;
}

static bool read_normal(const char *text, double normal[3]) {
  for (int a = 0; a < 3; a++) {
    char *rest;
    normal[a] = hl_plain_number(text, &rest);
    if (rest == text || !isfinite(normal[a]) || *rest != (a < 2 ? ',' : '\0')) return false;
    text = rest + 1;
  }
  return normal[0] != 0 || normal[1] != 0 || normal[2] != 0;
}

/* Reads a plane across an axis. The texts "x=AT" and "x=AT:" cut away the part from AT on, and "x=:AT" cuts
 * away the part before AT. The plane's point has AT as its coordinate along the axis. The point's other
 * coordinates have no effect. */
static bool read_axis_plane(const char *text, typed_cut *cut) {
  hl_axis_range away = {.axis = *text - 'x'};
  const char *at = text + 2;
  const bool alone = *text >= 'x' && *text <= 'z' && text[1] == '=' &&
                     hl_read_coordinate(&at, &away.ends[0]) && away.ends[0].given && *at == '\0';
  if (!alone && (!hl_read_range(&text, &away) || *text != '\0')) return false;
  const bool before = away.ends[1].given;
  if (before && away.ends[0].given) return false;
  cut->point[away.axis] = away.ends[before];
  cut->normal[away.axis] = before ? -1 : 1;
  return true;
}

static bool read_radius(const char *text, hl_coordinate *radius) {
  return hl_read_coordinate(&text, radius) && radius->given && radius->number > 0 && *text == '\0';
}

static bool read_cut(hl_cut_type type, const char *text, typed_cut *cut) {
  *cut = (typed_cut){0};
  if (type == HL_CUT_BOX) return hl_read_box(text, cut->box);
  if (type == HL_CUT_PLANE && strchr(text, '=') != NULL) return read_axis_plane(text, cut);
  if (!read_point(&text, cut->point)) return false;
  return type == HL_CUT_PLANE ? read_normal(text, cut->normal) : read_radius(text, &cut->radius);
}

/* Reads a cut that may begin with NAME=. Returns the part of the text after NAME=, or null if the text is no
 * cut. */
static const char *read_named_cut(hl_cut_type type, const char *text, typed_cut *cut) {
  const char *equals = strchr(text, '=');
  if (read_cut(type, text, cut)) return text;
  return equals != NULL && read_cut(type, equals + 1, cut) ? equals + 1 : NULL;
}

hl_status hl_check_cuts(const hl_asked *asked, hl_error *error) {
  static const char *const wanted[] = {
      [HL_CUT_PLANE] =
          "X,Y,Z:NX,NY,NZ: a point, in fractions of the volume's box or in its own unit (40mm), and the "
          "direction in which all is cut away (0.5,0.5,0.5:1,0,0); or a plane across an axis: x=0.5 cuts "
          "away "
          "what lies beyond it, x=:0.5 what lies before it (a part is kept by --clip x=0.2:0.5)",
      [HL_CUT_BOX] =
          "AXIS=LO:HI,...: ranges along x, y and z, each once, in fractions of the volume's box or in its "
          "own unit (x=0.5:,y=:0.5,z=40mm:)",
      [HL_CUT_SPHERE] =
          "X,Y,Z:RADIUS, in fractions of the volume's box, the radius of its longest side, or in its own "
          "unit (0.5,0.5,1:0.3)"};
  for (int type = 0; type < CUT_TYPES; type++) {
    const hl_asked *value = &asked[option_of[type]];
    typed_cut cut;
    for (int n = 0; n < value->count; n++) {
      const char *text = value->texts[n], *name = hl_option_rows[option_of[type]].name;
      if (read_named_cut((hl_cut_type)type, text, &cut) != NULL) continue;
      const hl_status status = type == HL_CUT_SPHERE ? HL_OK : hl_refuse_side(name, text, error);
      if (status != HL_OK) return status;
      return hl_fail(error, HL_ERROR_ARGUMENT, "--%s: '%.300s' is not %s", name, text, wanted[type]);
    }
  }
  return HL_OK;
}

hl_status hl_check_cut_names(const hl_composer *composer, const hl_scene_description *description) {
  hl_status status = HL_OK;
  for (int type = 0; type < CUT_TYPES; type++) {
    const hl_asked *value = &composer->asked[option_of[type]];
    typed_cut cut;
    for (int n = 0; n < value->count && status == HL_OK; n++)
      if (read_named_cut((hl_cut_type)type, value->texts[n], &cut) != value->texts[n])
        status = hl_check_volume_name(composer, (hl_ask)option_of[type], value->texts[n], description);
  }
  return status;
}

size_t hl_count_cuts(const hl_asked *asked) {
  size_t count = 0;
  for (int type = 0; type < CUT_TYPES; type++) count += (size_t)asked[option_of[type]].count;
  return count;
}

bool hl_cuts_bare_volume(const hl_composer *composer, const hl_scene_description *description) {
  return composer->bare && description->volume_count == 1 &&
         (hl_count_cuts(composer->asked) > 0 || composer->asked[HL_ASK_CLIP].given);
}

/* Places a cut. box: the box around the voxels. If the text gives no end for a side of a cut box, the cut box
 * extends beyond the voxels on this side. */
static void place_cut(const typed_cut *typed, const hl_world_box *box, hl_cut *cut) {
  const double *low = box->low, *high = box->high, metres = hl_metres_of_box(box);
  double longest = 0;
  for (int a = 0; a < 3; a++) {
    double side = high[a] - low[a];
    const hl_coordinate *ends = typed->box[a].ends;
    longest = fmax(longest, side);
    cut->point[a] = cut->center[a] = hl_coordinate_of(&typed->point[a], 0, low[a], high[a], metres);
    cut->min[a] = hl_coordinate_of(&ends[0], low[a] - side, low[a], high[a], metres);
    cut->max[a] = hl_coordinate_of(&ends[1], high[a] + side, low[a], high[a], metres);
    cut->normal[a] = typed->normal[a];
  }
  cut->radius = typed->radius.fraction ? typed->radius.number * longest
                                       : hl_length_of(&typed->radius, metres);
}

/* The parts of a box that a cut reaches. */
typedef enum cut_reach { CUT_REACHES_SOME, CUT_REACHES_NONE, CUT_REACHES_ALL } cut_reach;

/* Finds the part of a box that a plane cuts away. Derived: a linear function is least and greatest at
 * corners. A plane through a face of the box, to a billionth of its sides, still reaches some of the box. */
static cut_reach reach_of_plane(const hl_cut *cut, const hl_world_box *box, double *least, double *tiny) {
  double ends[2] = {0, 0}, scale = 0;
  for (int a = 0; a < 3; a++) {
    const double at[2] = {(box->low[a] - cut->point[a]) * cut->normal[a],
                          (box->high[a] - cut->point[a]) * cut->normal[a]};
    ends[0] += fmin(at[0], at[1]), ends[1] += fmax(at[0], at[1]);
    scale += fabs(cut->normal[a]) * (box->high[a] - box->low[a]);
  }
  *least = ends[0], *tiny = 1e-9 * scale;
  return ends[0] > *tiny ? CUT_REACHES_ALL : ends[1] < -*tiny ? CUT_REACHES_NONE : CUT_REACHES_SOME;
}

/* Finds whether a cut's box or sphere meets the box. */
static cut_reach reach_of_body(const hl_cut *cut, const hl_world_box *box) {
  double squares = 0;
  for (int a = 0; a < 3; a++) {
    const bool ball = cut->type == HL_CUT_SPHERE;
    const double low = ball ? cut->center[a] : cut->min[a], high = ball ? cut->center[a] : cut->max[a];
    const double apart = fmax(fmax(box->low[a] - high, low - box->high[a]), 0);
    squares += apart * apart;
  }
  const double reach = cut->type == HL_CUT_SPHERE ? cut->radius : 0;
  return squares > reach * reach ? CUT_REACHES_NONE : CUT_REACHES_SOME;
}

/* Returns whether cut plane number n is the plane of "slice", which is the last cut plane. */
static bool is_slice(const hl_composer *composer, hl_cut_type type, int n) {
  return composer->asked[HL_ASK_SLICE].given && type == HL_CUT_PLANE &&
         n + 1 == composer->asked[HL_ASK_CUT_PLANE].count;
}

/* Warns of cuts that lie outside of the box. Refuses a slice outside of the box, or a slice that leaves
 * nothing of the box. what: the name of the thing in the box. */
static hl_status judge_cut(const hl_composer *composer, const hl_cut *cut, const hl_world_box *box,
                           const char *what, int n) {
  char place[HL_BOX_TEXT];
  double least = 0, tiny = 0;
  const cut_reach reach = cut->type == HL_CUT_PLANE ? reach_of_plane(cut, box, &least, &tiny)
                                                    : reach_of_body(cut, box);
  hl_describe_box(box, what, place);
  if (is_slice(composer, cut->type, n))
    return reach == CUT_REACHES_SOME && least < -tiny
               ? HL_OK
               : hl_fail(composer->error, HL_ERROR_ARGUMENT, "--slice: '%.200s' lies outside: %s",
                         composer->asked[HL_ASK_SLICE].text, place);
  if (reach != CUT_REACHES_SOME)
    hl_log(composer->context, HL_LOG_WARNING, "--%s '%.200s' cuts %s away: %s",
           hl_option_rows[option_of[cut->type]].name, composer->asked[option_of[cut->type]].texts[n],
           reach == CUT_REACHES_ALL ? "everything" : "nothing", place);
  return HL_OK;
}

/* The target to which the options' cuts are added: a volume or a scene. */
typedef struct cut_target {
  const hl_scene_volume *volume; /* the volume, to which the cuts that name it are added; null if the target
                                  * is a scene */
  size_t index;                  /* the volume's index */
  bool nameless;                 /* whether cuts without a name are added to the target */
} cut_target;

static bool takes(const hl_composer *composer, const cut_target *target, const char *text, bool named) {
  const char *rest;
  if (!named) return target->nameless;
  return target->volume != NULL && hl_text_is_for(composer, text, target->volume, target->index, &rest);
}

/* Adds the options' cuts that are for the target. Fractions in the options become coordinates in the box. */
static hl_status add_cuts(const hl_composer *composer, const cut_target *target, const hl_world_box *box,
                          hl_cut *cuts, size_t *count) {
  const char *what = target->volume != NULL ? "volume" : "scene";
  hl_status status = HL_OK;
  for (int type = 0; type < CUT_TYPES; type++)
    for (int n = 0; n < composer->asked[option_of[type]].count && status == HL_OK; n++) {
      const char *text = composer->asked[option_of[type]].texts[n];
      hl_cut *cut = &cuts[*count];
      typed_cut typed;
      const char *read = read_named_cut((hl_cut_type)type, text, &typed);
      /* hl_check_cuts() has refused a text that cannot be read. */
      if (read == NULL || !takes(composer, target, text, read != text)) continue;
      hl_cut_defaults(cut);
      cut->type = (hl_cut_type)type;
      place_cut(&typed, box, cut);
      status = judge_cut(composer, cut, box, what, n);
      ++*count;
    }
  return status;
}

static const char *given_unit(const hl_composer *composer) { return composer->asked[HL_ASK_UNIT].text; }

/* Extends a box in the scene's world so that it contains the box of a volume. The scene's world has the unit
 * of its first volume. */
static hl_status extend_box(const hl_composer *composer, const hl_scene_volume *volume, bool first,
                            hl_world_box *box) {
  hl_world_box own;
  if (!hl_world_box_of(volume->volume, given_unit(composer), &own))
    return hl_fail(composer->error, HL_ERROR_INTERNAL, "--cut-plane: the volume's place is not known");
  if (first) box->unit = own.unit;
  for (int corner = 0; corner < 8; corner++) {
    double p[3];
    for (int a = 0; a < 3; a++) p[a] = corner >> a & 1 ? own.high[a] : own.low[a];
    hl_scene_volume_place_point(volume, p);
    for (int a = 0; a < 3; a++)
      box->low[a] = fmin(box->low[a], p[a]), box->high[a] = fmax(box->high[a], p[a]);
  }
  return HL_OK;
}

hl_status hl_compose_cuts(const hl_composer *composer, hl_scene_volume *volume, size_t index, bool alone,
                          hl_cut *cuts) {
  const cut_target target = {volume, index, alone};
  hl_world_box box;
  size_t count = volume->cut_count;
  if (!hl_world_box_of(volume->volume, given_unit(composer), &box))
    return hl_fail(composer->error, HL_ERROR_INTERNAL, "--cut-plane: the volume's place is not known");
  if (count > 0) memcpy(cuts, volume->cuts, count * sizeof *cuts);
  const hl_status status = add_cuts(composer, &target, &box, cuts, &count);
  volume->cuts = cuts;
  volume->cut_count = count;
  return status;
}

hl_status hl_scene_world_box(const hl_composer *composer, const hl_scene_description *scene,
                             hl_world_box *box) {
  hl_status status = HL_OK;
  *box = (hl_world_box){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}, NULL};
  for (size_t v = 0; v < scene->volume_count && status == HL_OK; v++)
    status = extend_box(composer, &scene->volumes[v], v == 0, box);
  return status;
}

hl_status hl_compose_scene_cuts(const hl_composer *composer, hl_scene_description *scene, hl_cut *cuts) {
  const cut_target target = {.nameless = true};
  hl_world_box box;
  size_t count = scene->cut_count;
  hl_status status = hl_scene_world_box(composer, scene, &box);
  if (status != HL_OK) return status;
  if (count > 0) memcpy(cuts, scene->cuts, count * sizeof *cuts);
  status = add_cuts(composer, &target, &box, cuts, &count);
  scene->cuts = cuts;
  scene->cut_count = count;
  return status;
}
