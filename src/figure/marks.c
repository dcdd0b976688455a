/* figure/marks.c - draws the marks of a scene over its picture: lines, heads of arrows, texts and measures.
 *
 * Marks lie over the picture. As in the viewer, matter in front of a mark does not hide it. A mark is left
 * out if one of its points lies behind the eye. Lengths and angles are measured in the first volume's file:
 * the scene's scale, rotation and translation of that volume are undone. The unit is the unit of that file,
 * or the unit that the overlay names; if neither is known, lengths are written without a unit. */
#include <stdio.h>
#include <string.h>

#include "elementary/elementary.h"
#include "figure/overlay.h"
#include "scene/geometry/placement.h"
#include "text/plain.h"
#include "text/units.h"

enum { MEASURE_BYTES = 96 };

/* ---- measures ---- */

/* Converts a difference of two points of the scene's world in the world of the first volume's file. */
static vec3 in_file(const hl_scene_description *scene, vec3 difference) {
  affine3 to_file;
  if (scene->volume_count == 0 ||
      !affine3_invert(hl_scene_volume_file_to_world(&scene->volumes[0]), &to_file))
    return difference;
  return mat3_apply(to_file.linear, difference);
}

/* Returns the vector from one point of a mark to another point, in the world coordinates of the first
 * volume's file. */
static vec3 way_of(const hl_scene_description *scene, const hl_mark *mark, size_t from, size_t to) {
  return in_file(scene, vec3_subtract(vec3_of(mark->points[to]), vec3_of(mark->points[from])));
}

static double length_of(const hl_scene_description *scene, const hl_mark *mark) {
  double sum = 0;
  for (size_t p = 1; p < mark->point_count; p++) sum += vec3_length(way_of(scene, mark, p - 1, p));
  return sum;
}

/* The angle, in degrees, at the second of three points of a mark. */
static double angle_of(const hl_scene_description *scene, const hl_mark *mark) {
  const vec3 u = way_of(scene, mark, 1, 0), v = way_of(scene, mark, 1, 2);
  const double size = vec3_length(u) * vec3_length(v);
  return size > 0 ? 180 / HL_PI * hl_acos(fmin(fmax(vec3_dot(u, v) / size, -1), 1)) : 0;
}

/* Moves a number that lies in the middle between two decimals away from zero, so that printing rounds it as
 * the viewer's page does. decimals: digits after the point of the number's scientific form. Derived: a double
 * of this size has fewer than 80 digits, so that its decimal form is exact. */
static double past_tie(double number, int decimals) {
  char exact[120];
  hl_plain_print(exact, sizeof exact, "%.80e", number);
  const char *rest = strchr(exact, '.');
  if (rest == NULL || rest[1 + decimals] != '5') return number;
  rest += 2 + decimals;
  return rest[strspn(rest, "0")] == 'e' ? nextafter(number, INFINITY) : number;
}

/* Writes a length as the viewer's page writes numbers (shortNumber() in server/page/controls.js). */
static void write_length(double length, char text[MEASURE_BYTES]) {
  const bool plain = length >= 1e-3 && length < 1e5;
  const int decimals = plain && length >= 1000 ? 4 : 2;
  if (!(length > 0)) {
    snprintf(text, MEASURE_BYTES, "0");
    return;
  }
  hl_plain_print(text, MEASURE_BYTES, "%.*e", decimals, past_tie(length, decimals));
  if (plain) {
    hl_plain_print(text, MEASURE_BYTES, "%.10g", hl_plain_number(text, NULL));
    return;
  }
  /* the page writes exponents without leading zeros */
  char *digits = strpbrk(strchr(text, 'e'), "0123456789");
  while (digits[0] == '0' && digits[1] != '\0') memmove(digits, digits + 1, strlen(digits));
}

/* The unit in which the lengths of marks are written; null if it is not known. */
static const char *unit_of(const hl_overlay_place *place) {
  const hl_scene_description *scene = place->scene;
  const char *name = place->overlay->world_unit;
  if (name == NULL && scene->volume_count > 0) name = hl_volume_unit(scene->volumes[0].volume);
  const hl_unit *unit = name != NULL ? hl_unit_find(name) : NULL;
  return unit != NULL ? unit->symbol : name;
}

/* Writes the text of the length or the angle that a mark measures; "" if this kind of mark measures
 * nothing. */
static void write_measure(const hl_overlay_place *place, const hl_mark *mark, char text[MEASURE_BYTES]) {
  text[0] = '\0';
  if (mark->kind == HL_MARK_ANGLE) {
    const double angle = angle_of(place->scene, mark);
    hl_plain_print(text, MEASURE_BYTES, "%.1f\u00b0", angle);
  } else if (mark->kind == HL_MARK_RULER || mark->kind == HL_MARK_LINE) {
    const char *unit = unit_of(place);
    write_length(length_of(place->scene, mark), text);
    const size_t used = strlen(text);
    if (unit != NULL) snprintf(text + used, MEASURE_BYTES - used, " %.60s", unit);
  }
}

/* ---- drawing ---- */

typedef struct point_on_page {
  double x, y; /* the place on the page, in points */
} point_on_page;

/* Adds the head of an arrow to the current path. */
static void add_head(const hl_ink *ink, point_on_page from, point_on_page tip) {
  const double far = hl_hypot(tip.x - from.x, tip.y - from.y), head = 0.8 * ink->size;
  if (!(far > 0)) return;
  const double x = (tip.x - from.x) / far * head, y = (tip.y - from.y) / far * head;
  cairo_move_to(ink->cairo, tip.x - x - y / 2, tip.y - y + x / 2);
  cairo_line_to(ink->cairo, tip.x, tip.y);
  cairo_line_to(ink->cairo, tip.x - x + y / 2, tip.y - y - x / 2);
}

/* The place at which the text of a mark begins: the middle of a ruler, the corner of an angle, the start of
 * an arrow, or the last point of any other mark. */
static point_on_page anchor_of(const hl_mark *mark, const point_on_page first[3], point_on_page last) {
  switch (mark->kind) {
    case HL_MARK_RULER: return (point_on_page){(first[0].x + first[1].x) / 2, (first[0].y + first[1].y) / 2};
    case HL_MARK_ANGLE: return first[1];
    case HL_MARK_ARROW: return first[0];
    default: return last;
  }
}

/* Returns whether a ruler's line rises to the right on the page. If so, the ruler's text is written below the
 * line, and if not, above the line, so that the text covers neither the line nor its end. */
static bool rises(const hl_mark *mark, const point_on_page first[3]) {
  return mark->kind == HL_MARK_RULER && (first[1].x - first[0].x) * (first[1].y - first[0].y) < 0;
}

/* One place of a caption. far: its distance from the usual place, in lines. A ruler's caption begins at the
 * ruler on the side that rises() names, and ends at the ruler on the opposite side. */
static hl_line_of_text try_caption(const hl_ink *ink, const char *caption, point_on_page at, bool below,
                                   bool left, int far) {
  const double way = (0.4 + 1.3 * far) * ink->size;
  return (hl_line_of_text){.text = caption,
                           .x = at.x + (left ? -0.7 : 0.7) * ink->size,
                           .y = at.y + (below ? way : -way),
                           .align_x = left ? 1 : 0,
                           .align_y = below ? 0 : 1};
}

/* Places a caption beside a mark: below or above the mark's anchor, and to the right or to the left of it.
 * The caption of a ruler may also stand beside other points of the ruler's line. The first free place is
 * chosen for the caption. If no place is free, the caption stands at its usual place. */
static hl_line_of_text lay_caption(const hl_ink *ink, const hl_overlay_place *place, const char *caption,
                                   const hl_mark *mark, const point_on_page first[3], point_on_page anchor) {
  static const double along[] = {0, -0.25, 0.25, -0.45,
                                 0.45}; /* distances from the anchor, as fractions of the ruler's length */
  enum { MOST_FAR = 4 };
  const bool ruler = mark->kind == HL_MARK_RULER, below = rises(mark, first);
  const int points = ruler ? (int)(sizeof along / sizeof *along) : 1, turns = ruler ? 2 : 4;
  hl_search search = {.taken = &place->taken, .unit = 1};
  for (int n = 0; n < MOST_FAR * points * turns; n++) {
    const int turn = n % turns, point = n / turns % points;
    const bool other = turn % 2 == 1;
    point_on_page at = anchor;
    if (ruler)
      at.x += along[point] * (first[1].x - first[0].x), at.y += along[point] * (first[1].y - first[0].y);
    const hl_line_of_text line = try_caption(ink, caption, at, below != other, ruler ? other : turn >= 2,
                                             n / turns / points);
    if (hl_search_try(&search, hl_ink_box(ink, &line), n)) return line;
  }
  return try_caption(ink, caption, anchor, below, false, 0);
}

static void draw_caption(const hl_ink *ink, hl_overlay_place *place, const hl_mark *mark,
                         const point_on_page first[3], point_on_page at) {
  char measure[MEASURE_BYTES];
  write_measure(place, mark, measure);
  const char *text = mark->text != NULL ? mark->text : "", *between = *text && *measure ? ": " : "";
  char *caption = g_strconcat(text, between, measure, NULL);
  if (*caption) {
    const hl_line_of_text line = lay_caption(ink, place, caption, mark, first, at);
    hl_ink_text(ink, &line);
    hl_take(&place->taken, hl_ink_box(ink, &line));
  }
  g_free(caption);
}

/* Draws the path of a mark; the path of a text is a dot. Returns false if a point lies behind the eye;
 * nothing is drawn then. */
static bool draw_path(const hl_ink *ink, const hl_map *map, const hl_mark *mark, point_on_page first[3],
                      point_on_page *last) {
  cairo_new_path(ink->cairo);
  for (size_t p = 0; p < mark->point_count; p++) {
    if (!hl_map_point(map, vec3_of(mark->points[p]), &last->x, &last->y)) {
      cairo_new_path(ink->cairo);
      return false;
    }
    if (p < 3) first[p] = *last;
    if (p == 0) cairo_move_to(ink->cairo, last->x, last->y);
    else cairo_line_to(ink->cairo, last->x, last->y);
  }
  if (mark->kind == HL_MARK_ARROW) add_head(ink, first[0], first[1]);
  /* a line of the length 0 becomes a round dot */
  if (mark->kind == HL_MARK_TEXT) cairo_line_to(ink->cairo, last->x, last->y);
  hl_ink_stroke(ink, (mark->kind == HL_MARK_TEXT ? 0.35 : 0.14) * ink->size);
  return true;
}

hl_status hl_overlay_marks(const hl_ink *ink, const hl_overlay_place *place, hl_error *error) {
  const hl_scene_description *scene = place->scene;
  const hl_rectangle picture = place->picture;
  hl_overlay_place own = *place; /* a copy of the place, to which the places of the captions are added */
  if (scene->mark_count == 0)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "marks: the scene has none: measure by --ruler X,Y,Z:X,Y,Z or in `halflight view`, or "
                   "give the scene \"marks\"");
  cairo_save(ink->cairo);
  cairo_rectangle(ink->cairo, picture.left, picture.top, picture.width, picture.height);
  cairo_clip(ink->cairo);
  for (size_t m = 0; m < scene->mark_count; m++) {
    point_on_page first[3] = {{0, 0}}, last = {0, 0};
    if (draw_path(ink, &place->map, &scene->marks[m], first, &last))
      draw_caption(ink, &own, &scene->marks[m], first, anchor_of(&scene->marks[m], first, last));
  }
  cairo_restore(ink->cairo);
  return HL_OK;
}
