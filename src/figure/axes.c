/* figure/axes.c - draws the directions of the world: arrows, usually at the lower right, or letters at the
 * picture's edges.
 *
 * If a volume's file states the orientation of a body, the letters are the letters of anatomy: R and L for
 * the body's right and left, A and P for its front and back, S and I for the directions of its head and
 * feet. */
#include <string.h>

#include "elementary/elementary.h"
#include "figure/overlay.h"
#include "scene/geometry/camera.h"

/* The names of the two ends of each of the world's axes: [axis][end]; end 0 is the negative end, end 1 the
 * positive end. */
typedef const char *axis_names[3][2];

static const axis_names *names_of(hl_space space) {
  static const axis_names plain = {{"\u2212x", "x"}, {"\u2212y", "y"}, {"\u2212z", "z"}};
  static const axis_names ras = {{"L", "R"}, {"P", "A"}, {"I", "S"}},
                          lps = {{"R", "L"}, {"A", "P"}, {"I", "S"}},
                          las = {{"R", "L"}, {"P", "A"}, {"I", "S"}};
  switch (space) {
    case HL_SPACE_RAS: return &ras;
    case HL_SPACE_LPS: return &lps;
    case HL_SPACE_LAS: return &las;
    default: return &plain;
  }
}

/* An axis of the world as the picture shows it: its components to the right, up, and towards the eye. */
static vec3 seen(const hl_map *map, int axis) {
  vec3 unit = {axis == 0, axis == 1, axis == 2};
  return (vec3){vec3_dot(unit, map->right), vec3_dot(unit, map->up), -vec3_dot(unit, map->forward)};
}

/* ---- arrows ---- */

/* Lengths in the drawing of the axes, in units of the letters' size. */
static const double arrow_length = 2.1, letter_room = 1.1;

/* Draws an arrow with a filled head, from (from_x, from_y) along (x, y). */
static void draw_arrow(const hl_ink *ink, double from_x, double from_y, double x, double y) {
  const double length = hl_hypot(x, y), head = fmin(0.5 * ink->size, length);
  cairo_new_path(ink->cairo);
  cairo_move_to(ink->cairo, from_x, from_y);
  cairo_line_to(ink->cairo, from_x + x, from_y + y);
  if (length > 0.2 * ink->size) {
    double ux = x / length * head, uy = y / length * head;
    cairo_move_to(ink->cairo, from_x + x - ux - 0.4 * uy, from_y + y - uy + 0.4 * ux);
    cairo_line_to(ink->cairo, from_x + x, from_y + y);
    cairo_line_to(ink->cairo, from_x + x - ux + 0.4 * uy, from_y + y - uy - 0.4 * ux);
  }
  hl_ink_stroke(ink, 0.11 * ink->size);
}

static void draw_arrows(const hl_ink *ink, const hl_overlay_place *place) {
  const axis_names *names = names_of(hl_scene_space(place->scene));
  const double length = arrow_length * ink->size, room = (arrow_length + letter_room) * ink->size;
  const double x = place->picture.left + place->picture.width - place->margin - room;
  const double y = place->picture.top + place->picture.height - place->margin - room;
  int order[3] = {0, 1, 2}; /* the indices of the axes; the axis that points farthest away from the eye comes
                             * first */
  for (int a = 0; a < 2; a++)
    for (int b = 0; b < 2; b++)
      if (seen(&place->map, order[b]).z > seen(&place->map, order[b + 1]).z) {
        int later = order[b];
        order[b] = order[b + 1];
        order[b + 1] = later;
      }
  for (int a = 0; a < 3; a++) {
    vec3 way = seen(&place->map, order[a]);
    draw_arrow(ink, x, y, length * way.x, -length * way.y);
    double flat = hl_hypot(way.x, way.y), out = length * flat + 0.65 * ink->size;
    double ux = flat > 1e-6 ? way.x / flat : 0.7, uy = flat > 1e-6 ? way.y / flat : 0.7;
    hl_ink_text(ink, &(hl_line_of_text){.text = (*names)[order[a]][1],
                                        .x = x + out * ux,
                                        .y = y - out * uy,
                                        .align_x = 0.5,
                                        .align_y = 0.5});
  }
}

/* ---- letters ---- */

/* Names a direction in the picture by the one or two axes of the volume that run along it. An axis is named
 * if the direction's component along it is at least 0.4; the axis with the greater component comes first. */
static void name_direction(const hl_overlay_place *place, const axis_names *names, vec3 way, char name[8]) {
  double part[3] = {way.x, way.y, way.z};
  name[0] = '\0';
  for (int turn = 0; turn < 2; turn++) {
    int greatest = 0;
    for (int axis = 1; axis < 3; axis++)
      if (fabs(part[axis]) > fabs(part[greatest])) greatest = axis;
    if (fabs(part[greatest]) < 0.4) break;
    strncat(name, (*names)[greatest][part[greatest] > 0], 3);
    part[greatest] = 0;
  }
  (void)place;
}

/* Moves a text along the picture's edge, from its middle to the nearest place that keeps clear of other
 * drawings. If there is no such place, the text stays. along_x: the edge is the upper or the lower one. */
static void slide_clear(const hl_ink *ink, const hl_overlay_place *place, bool along_x,
                        hl_line_of_text *line) {
  const double length = along_x ? place->picture.width : place->picture.height;
  double *at = along_x ? &line->x : &line->y;
  const double middle = *at;
  hl_search search = {.taken = &place->taken, .rim = 0.4 * ink->size, .unit = 1};
  double best = middle;
  for (double way = 0; way < 0.4 * length; way += 0.5 * ink->size)
    for (int side = -1; side <= 1; side += 2) {
      *at = middle + side * way;
      if (hl_search_try(&search, hl_ink_box(ink, line), way)) best = *at;
    }
  *at = best;
}

static hl_status draw_letters(const hl_ink *ink, const hl_overlay_place *place, hl_error *error) {
  hl_space space = hl_scene_space(place->scene);
  if (space == HL_SPACE_UNKNOWN)
    return hl_fail(
        error, HL_ERROR_ARGUMENT,
        "axes: letters need the body's directions, and the file does not tell them: state them, as --space "
        "RAS, or give arrows");
  const axis_names *names = names_of(space);
  const hl_rectangle picture = place->picture;
  const vec3 right = place->map.right, up = place->map.up;
  const struct {
    vec3 way;
    double x, y;
  } edges[4] = {{right, 1, 0.5}, {vec3_scale(right, -1), 0, 0.5}, {up, 0.5, 0}, {vec3_scale(up, -1), 0.5, 1}};
  for (int edge = 0; edge < 4; edge++) {
    char name[8];
    name_direction(place, names, edges[edge].way, name);
    hl_line_of_text line = {
        .text = name,
        .x = picture.left + place->margin + edges[edge].x * (picture.width - 2 * place->margin),
        .y = picture.top + place->margin + edges[edge].y * (picture.height - 2 * place->margin),
        .align_x = edges[edge].x,
        .align_y = edges[edge].y,
        .scale = 1.2,
        .gap = 0.12}; /* "RA" would touch */
    slide_clear(ink, place, edges[edge].x == 0.5, &line);
    hl_ink_text(ink, &line);
  }
  return HL_OK;
}

hl_status hl_overlay_axes(const hl_ink *ink, const hl_overlay_place *place, hl_error *error) {
  if (place->overlay->axes == HL_AXES_LETTERS) return draw_letters(ink, place, error);
  draw_arrows(ink, place);
  return HL_OK;
}
