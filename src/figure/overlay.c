/* figure/overlay.c - draws the overlay of one picture. Annotations and the panel's letter are drawn here;
 * each other part has a file of its own.
 *
 * All places are found before anything is drawn, by trial drawings on a recording surface, so that a figure
 * has the same places in every format. Places are found in a fixed order. First come the insets and the texts
 * whose places are stated, then the parts whose corners are stated. Then come the arrows, the bar and the
 * legend, which takes the height that is left. Texts at edges and beside marks come last. Each part keeps
 * clear of all parts before it. */
#include "figure/overlay.h"

#include <string.h>

#include "core/context.h"
#include "core/memory.h"

/* The distance from a part to the border of its ground, and the distance that texts keep; in units of the
 * letters' size. */
static const double rim = 0.4;

/* ---- measuring ---- */

/* Makes an ink that draws on a recording surface, whose drawings are not seen. Destroy trial.cairo after use.
 */
static hl_ink begin_trial(const hl_ink *ink) {
  cairo_surface_t *record = cairo_recording_surface_create(CAIRO_CONTENT_COLOR_ALPHA, NULL);
  hl_ink trial = *ink;
  trial.cairo = cairo_create(record);
  cairo_surface_destroy(record);
  return trial;
}

typedef hl_status (*draw_function)(const hl_ink *ink, const hl_overlay_place *place, hl_error *error);

/* Finds the box around the drawing of a part at its usual place. */
static hl_status find_box(const hl_ink *ink, const hl_overlay_place *place, draw_function draw,
                          hl_rectangle *box, hl_error *error) {
  hl_ink trial = begin_trial(ink);
  hl_status status = draw(&trial, place, error);
  cairo_recording_surface_ink_extents(cairo_get_target(trial.cairo), &box->left, &box->top, &box->width,
                                      &box->height);
  cairo_destroy(trial.cairo);
  return status;
}

/* ---- texts ---- */

hl_line_of_text hl_overlay_beside(const hl_ink *ink, const hl_taken *taken, hl_line_of_text text,
                                  double apart) {
  static const double sides[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
  const double x = text.x, y = text.y;
  hl_search search = {.taken = taken, .unit = 1};
  for (int turn = 0; turn <= 4; turn++) {
    const double *side =
        sides[turn % 4]; /* the last turn takes the usual side again, because no side is free */
    text.x = x + apart * side[0];
    text.y = y + apart * side[1];
    text.align_x = (1 - side[0]) / 2;
    text.align_y = (1 - side[1]) / 2;
    if (hl_search_try(&search, hl_ink_box(ink, &text), turn)) break;
  }
  return text;
}

/* The radius of the ring around a point of the world, and the distance from the point to its text; points. */
static double ring_of(const hl_ink *ink) { return 0.3 * ink->size; }
static double apart_of(const hl_ink *ink) { return 2.2 * ring_of(ink); }

/* The ways in which an annotation gets its place: from a place in the picture that the annotation states,
 * from a point of the world that it states, or automatically if it states neither. */
typedef enum place_kind { STATED, FREE, AT_POINT, PLACE_KINDS } place_kind;

static place_kind kind_of(const hl_annotation *note) {
  return note->in_world ? AT_POINT : isnan(note->at[0]) ? FREE : STATED;
}

/* Finds the text of the n-th annotation without a place: at the upper left, below the annotations before
 * it, or further down if the place is taken. */
static hl_line_of_text lay_free(const hl_ink *ink, const hl_overlay_place *place, const char *text, int n) {
  static const double left = 0.03, top = 0.05;
  const hl_rectangle picture = place->picture;
  hl_line_of_text line = {.text = text,
                          .x = picture.left + left * picture.width,
                          .y = picture.top + top * (1 + n) * picture.height,
                          .align_y = 0.5,
                          .paragraphs = true};
  hl_search search = {.taken = &place->taken, .unit = 1};
  hl_rectangle usual = hl_ink_box(ink, &line), lowest = usual;
  lowest.top = picture.top + picture.height - usual.height;
  hl_search_edge(&search, usual, lowest, 0.25 * ink->size);
  if (search.found) line.y += search.box.top - usual.top;
  return line;
}

/* Finds the text of an annotation, at the place or the point that the annotation states. */
static hl_status lay_annotation(const hl_overlay_place *place, const hl_annotation *note,
                                hl_line_of_text *line, hl_error *error) {
  const hl_rectangle picture = place->picture;
  double x = picture.left + note->at[0] * picture.width, y = picture.top + note->at[1] * picture.height;
  if (note->text == NULL || !isfinite(note->at[0] + note->at[1] + note->at[2]))
    return hl_fail(error, HL_ERROR_ARGUMENT, "annotation: it needs a text and a finite place");
  if (note->in_world && !hl_map_point(&place->map, vec3_of(note->at), &x, &y))
    return hl_fail(error, HL_ERROR_ARGUMENT, "annotation '%.40s': its point lies behind the eye", note->text);
  *line = (hl_line_of_text){.text = note->text, .x = x, .y = y, .align_y = 0.5, .paragraphs = true};
  return HL_OK;
}

/* Finds the texts of all annotations, first of annotations with a stated place in the picture. The texts of
 * other annotations keep clear of the texts with a stated place. lines: [annotation_count]. */
static hl_status place_annotations(const hl_ink *ink, hl_overlay_place *place, hl_line_of_text *lines,
                                   hl_error *error) {
  const hl_overlay *overlay = place->overlay;
  const double ring = ring_of(ink);
  hl_status status = HL_OK;
  int free_count = 0;
  for (place_kind kind = STATED; kind < PLACE_KINDS; kind++)
    for (size_t a = 0; a < overlay->annotation_count && status == HL_OK; a++) {
      const hl_annotation *note = &overlay->annotations[a];
      if (kind_of(note) != kind) continue;
      if (kind == FREE && note->text != NULL) lines[a] = lay_free(ink, place, note->text, free_count++);
      else status = lay_annotation(place, note, &lines[a], error);
      if (status != HL_OK) break;
      if (kind == AT_POINT) {
        const hl_rectangle point = {lines[a].x, lines[a].y, 0, 0};
        lines[a] = hl_overlay_beside(ink, &place->taken, lines[a], apart_of(ink));
        hl_take(&place->taken, hl_rectangle_widened(point, ring));
      }
      hl_take(&place->taken, hl_ink_box(ink, &lines[a]));
    }
  return status;
}

static void draw_annotation(const hl_ink *ink, const hl_overlay_place *place, const hl_annotation *note,
                            const hl_line_of_text *line) {
  double x, y;
  if (note->in_world && hl_map_point(&place->map, vec3_of(note->at), &x, &y)) {
    cairo_new_path(ink->cairo);
    cairo_arc(ink->cairo, x, y, ring_of(ink), 0, 2 * HL_PI);
    hl_ink_stroke(ink, 0.1 * ink->size);
  }
  hl_ink_text(ink, line);
}

/* Finds the place of the panel's letter: at the upper left, or beside an inset if the inset lies at the upper
 * left. */
static hl_line_of_text place_letter(const hl_ink *ink, hl_overlay_place *place) {
  hl_line_of_text line = {.text = place->overlay->letter,
                          .x = place->picture.left + place->margin,
                          .y = place->picture.top + 0.7 * place->margin,
                          .scale = 1.4,
                          .bold = true};
  hl_search search = {.taken = &place->taken, .unit = 1};
  hl_rectangle usual = hl_ink_box(ink, &line), other = usual;
  other.left = place->picture.left + place->picture.width - place->margin - usual.width;
  hl_search_edge(&search, usual, other, 0.5 * ink->size);
  if (search.found) line.x += search.box.left - usual.left;
  hl_take(&place->taken, hl_ink_box(ink, &line));
  return line;
}

/* ---- parts with corners ---- */

/* A part of the overlay that is placed in a corner: the part is drawn at its usual place and moved from there
 * to the place that was found. */
typedef struct corner_part {
  const char *name;
  draw_function draw;
  bool wanted;
  hl_corner usual, asked;
  bool is_placed;
  hl_rectangle box; /* where the part lies before it is moved */
  double x, y;      /* the way by which the part is moved, in points */
  double covered;   /* the area of the picture's matter that the part covers, in points squared */
  size_t left_out;  /* the number of a legend's rows that find no room */
} corner_part;

static bool is_right(hl_corner corner) {
  return corner == HL_CORNER_UPPER_RIGHT || corner == HL_CORNER_LOWER_RIGHT;
}

static bool is_lower(hl_corner corner) {
  return corner == HL_CORNER_LOWER_LEFT || corner == HL_CORNER_LOWER_RIGHT;
}

/* Searches for the place of a part: the stated corner, whatever lies there, or, if no corner is stated, the
 * best place along the picture's edges. box: the part at its usual place. unit: as in hl_search. */
static hl_search find_place(const hl_ink *ink, const hl_overlay_place *place, const hl_cover *cover,
                            const corner_part *part, hl_rectangle box, double unit) {
  const hl_taken nothing = {.picture = place->picture};
  hl_search search = {.taken = &place->taken, .cover = cover, .rim = rim * ink->size, .unit = unit};
  if (part->asked == HL_CORNER_FREE) {
    hl_search_edges(&search, box, 0.5 * ink->size);
    return search;
  }
  search.taken = &nothing;
  search.cover = NULL;
  hl_search_try(&search,
                hl_rectangle_in_corner(box, place->picture, is_right(part->asked) != is_right(part->usual),
                                       is_lower(part->asked) != is_lower(part->usual)),
                0);
  search.taken = &place->taken;
  return search;
}

/* Returns the unit in which covered areas are counted: a twentieth of the part's own area. */
static double unit_of(hl_rectangle box) { return fmax(box.width * box.height / 20, 1e-3); }

/* Gives a part the place that a search has found. box: the part at its usual place. */
static void give_place(corner_part *part, hl_rectangle box, const hl_search *search) {
  part->is_placed = true;
  part->box = box;
  part->x = search->box.left - box.left;
  part->y = search->box.top - box.top;
  part->covered = search->covered * search->unit;
}

/* Returns the greatest height of a part at one side of the picture, if the part is as wide as a given box. */
static double height_at(const hl_ink *ink, const hl_overlay_place *place, hl_rectangle box, bool other_side) {
  const double around = place->margin - rim * ink->size;
  if (other_side) box = hl_rectangle_in_corner(box, place->picture, true, false);
  hl_rectangle column = hl_rectangle_widened(box, rim * ink->size);
  column.top = place->picture.top + around;
  column.height = place->picture.height - 2 * around;
  return hl_free_height(&place->taken, column) - 2 * rim * ink->size;
}

/* The shapes that a legend may have, the usual shape first. widths: the greatest widths of titles and rows;
 * strips: the greatest heights of strips; in units of the letters' size. */
static const double widths[] = {1e3, 12, 9, 7}, strips[] = {9, 5.5};
enum { WIDTHS = sizeof widths / sizeof *widths, STRIPS = sizeof strips / sizeof *strips };

/* Returns the n-th shape of a legend with a given height. */
static hl_legend_shape shape_of(double height, int n, const hl_ink *ink) {
  return (hl_legend_shape){.height = height,
                           .width = widths[n % WIDTHS] * ink->size,
                           .strip_height = strips[n / WIDTHS] * ink->size};
}

/* Finds the best of the shapes of the legend, all of one height, and its place: the shape that leaves out
 * the fewest rows; among these shapes, the shape that covers the least area; among these, the first shape.
 * whole: the box of the legend if it may use the whole height of the picture. */
static hl_status shape_legend(const hl_ink *ink, hl_overlay_place *place, const hl_cover *cover,
                              corner_part *part, hl_rectangle whole, double height, hl_error *error) {
  hl_legend_shape best_shape = {0};
  hl_search best = {0};
  size_t best_left_out = 0, left_out = 0, left_out_first = 0;
  place->rows_left_out = &left_out;
  hl_status status = HL_OK;
  for (int n = 0; n < WIDTHS * STRIPS && status == HL_OK; n++) {
    hl_rectangle box;
    if (n % WIDTHS > 0 && left_out_first > 0) continue; /* narrower rows leave out no less */
    place->legend = shape_of(height, n, ink);
    status = find_box(ink, place, part->draw, &box, error);
    if (status != HL_OK) break;
    if (n % WIDTHS == 0) left_out_first = left_out;
    const hl_search found = find_place(ink, place, cover, part, box, unit_of(whole));
    const bool is_better = left_out != best_left_out ? left_out < best_left_out
                                                     : found.covered < best.covered;
    if (!found.found || (best.found && !is_better)) continue;
    give_place(part, box, &found);
    best = found;
    best_left_out = part->left_out = left_out;
    best_shape = place->legend;
  }
  place->rows_left_out = NULL;
  place->legend = best_shape;
  return status;
}

/* Places the legend. The legend gets the height of the free room at its usual side of the picture. The
 * opposite side is taken if only that side has room for a place, or for the whole legend. */
static hl_status place_legend(const hl_ink *ink, hl_overlay_place *place, const hl_cover *cover,
                              corner_part *part, hl_error *error) {
  const bool across = part->asked != HL_CORNER_FREE && is_right(part->asked) != is_right(part->usual);
  hl_rectangle whole;
  size_t left_out = 0;
  place->rows_left_out = &left_out;
  place->legend = shape_of(place->picture.height - 2 * place->margin, 0, ink);
  hl_status status = find_box(ink, place, part->draw, &whole, error);
  place->rows_left_out = NULL;
  if (status != HL_OK) return status;
  const double heights[2] = {height_at(ink, place, whole, across), height_at(ink, place, whole, !across)};
  const bool turned = part->asked == HL_CORNER_FREE && left_out == 0 && heights[0] < whole.height &&
                      heights[1] >= whole.height;
  for (int side = 0; side < 2 && status == HL_OK && !part->is_placed; side++)
    status = shape_legend(ink, place, cover, part, whole, heights[(side == 1) != turned], error);
  return status;
}

static hl_status place_part(const hl_ink *ink, hl_overlay_place *place, const hl_cover *cover,
                            corner_part *part, hl_error *error) {
  hl_status status;
  if (part->draw == hl_overlay_legend) {
    status = place_legend(ink, place, cover, part, error);
  } else {
    hl_rectangle box;
    status = find_box(ink, place, part->draw, &box, error);
    if (status != HL_OK) return status;
    const hl_search found = find_place(ink, place, cover, part, box, unit_of(box));
    if (found.found) give_place(part, box, &found);
  }
  if (part->is_placed) {
    hl_rectangle moved = hl_rectangle_widened(part->box, rim * ink->size);
    moved.left += part->x;
    moved.top += part->y;
    hl_take(&place->taken, moved);
  }
  return status;
}

enum { PARTS = 3, LEGEND = 2 };

/* Places all parts in one order: first the parts whose corners are stated. legend_first: whether the legend
 * is placed before the other parts. */
static hl_status place_in_order(const hl_ink *ink, hl_overlay_place *place, const hl_cover *cover,
                                corner_part parts[PARTS], bool legend_first, hl_error *error) {
  hl_status status = HL_OK;
  for (int asked = 1; asked >= 0; asked--)
    for (int n = 0; n < PARTS && status == HL_OK; n++) {
      corner_part *part = &parts[(n + (legend_first ? LEGEND : 0)) % PARTS];
      if (part->wanted && (part->asked != HL_CORNER_FREE) == asked)
        status = place_part(ink, place, cover, part, error);
    }
  return status;
}

/* Returns the cost of the places of all parts: the covered area, and a high cost for each part that is left
 * out. */
static double cost_of(const corner_part parts[PARTS]) {
  double cost = 0;
  for (int n = 0; n < PARTS; n++) cost += parts[n].wanted && !parts[n].is_placed ? 1e12 : parts[n].covered;
  return cost;
}

/* Tries two orders of placing the parts, and keeps the order in which the parts cover less. A legend that
 * is placed first has more places to choose from; a legend that is placed last is lower. */
static hl_status place_parts(const hl_ink *ink, hl_overlay_place *place, const hl_cover *cover,
                             corner_part parts[PARTS], hl_error *error) {
  hl_overlay_place first_place = *place;
  corner_part first_parts[PARTS];
  memcpy(first_parts, parts, sizeof first_parts);
  hl_status status = place_in_order(ink, place, cover, parts, false, error);
  if (status != HL_OK || cost_of(parts) == 0 || !parts[LEGEND].wanted) return status;
  status = place_in_order(ink, &first_place, cover, first_parts, true, error);
  if (status != HL_OK || cost_of(first_parts) >= cost_of(parts)) return status;
  *place = first_place;
  memcpy(parts, first_parts, sizeof first_parts);
  return HL_OK;
}

/* ---- drawing ---- */

/* The least opacity of a black ground at which white letters have the contrast 4.5 (WCAG 2.1, 1.4.3) over a
 * white picture. Derived: (1 + 0.05) / (Y + 0.05) = 4.5 for the luminance Y = 0.183 of the sRGB grey 1 -
 * 0.534. A white ground under black letters needs less: 0.456. */
static const double ground_opacity = 0.54;

/* Fills a box with round corners. */
static void draw_ground(const hl_ink *ink, hl_rectangle box) {
  const double round = 0.4 * ink->size, quarter = HL_PI / 2;
  const double right = box.left + box.width - round, bottom = box.top + box.height - round;
  cairo_new_path(ink->cairo);
  cairo_arc(ink->cairo, box.left + round, box.top + round, round, 2 * quarter, 3 * quarter);
  cairo_arc(ink->cairo, right, box.top + round, round, 3 * quarter, 4 * quarter);
  cairo_arc(ink->cairo, right, bottom, round, 0, quarter);
  cairo_arc(ink->cairo, box.left + round, bottom, round, quarter, 2 * quarter);
  cairo_close_path(ink->cairo);
  cairo_set_source_rgba(ink->cairo, ink->halo, ink->halo, ink->halo, ground_opacity);
  cairo_fill(ink->cairo);
}

/* Draws a part, on a ground where matter lies behind it. */
static hl_status draw_part(const hl_ink *ink, const hl_overlay_place *place, const hl_cover *cover,
                           const corner_part *part, hl_error *error) {
  const hl_rectangle box = hl_rectangle_widened(part->box, rim * ink->size);
  hl_rectangle moved = box;
  moved.left += part->x;
  moved.top += part->y;
  cairo_save(ink->cairo);
  cairo_translate(ink->cairo, part->x, part->y);
  if (hl_cover_in(cover, place->picture, moved) > 0) draw_ground(ink, box);
  hl_status status = part->draw(ink, place, error);
  cairo_restore(ink->cairo);
  return status;
}

/* Tells the context's log which parts, and how many rows of the legend, are left out because there is no
 * room. */
static void tell_left_out(const hl_overlay_ground *ground, const corner_part parts[PARTS]) {
  char panel[40] = "";
  if (ground->panel > 0) snprintf(panel, sizeof panel, "panel %zu: ", ground->panel);
  for (int n = 0; n < PARTS && ground->is_told; n++)
    if (parts[n].wanted && !parts[n].is_placed)
      hl_log(
          ground->context, HL_LOG_WARNING,
          "%sthe %s finds no room in the picture and is left out: smaller letters or a larger picture make "
          "room",
          panel, parts[n].name);
  const corner_part *legend = &parts[LEGEND];
  if (ground->is_told && legend->is_placed && legend->left_out > 0 && legend->asked == HL_CORNER_FREE)
    hl_log(
        ground->context, HL_LOG_INFO,
        "%sthe legend has no room for %zu rows: --place legend=below shows all in a strip below the picture",
        panel, legend->left_out);
}

/* Draws all parts at the places that are found. lines: [annotation_count]; the texts of annotations. */
static hl_status draw_all(const hl_ink *ink, const hl_overlay_place *place, const hl_cover *cover,
                          const corner_part parts[PARTS], const hl_line_of_text *lines,
                          const hl_line_of_text *letter, hl_error *error) {
  const hl_overlay *overlay = place->overlay;
  hl_status status = overlay->marks ? hl_overlay_marks(ink, place, error) : HL_OK;
  for (int n = 0; n < PARTS && status == HL_OK; n++)
    if (parts[n].is_placed) status = draw_part(ink, place, cover, &parts[n], error);
  if (status == HL_OK && overlay->axes == HL_AXES_LETTERS) status = hl_overlay_axes(ink, place, error);
  for (size_t a = 0; status == HL_OK && a < overlay->annotation_count; a++)
    draw_annotation(ink, place, &overlay->annotations[a], &lines[a]);
  if (status == HL_OK && letter->text != NULL) hl_ink_text(ink, letter);
  return status;
}

/* Finds all places, and then draws. lines: [annotation_count]; room for the texts of annotations. */
static hl_status place_and_draw(const hl_ink *ink, hl_overlay_place *place, const hl_cover *cover,
                                const hl_overlay_ground *ground, hl_line_of_text *lines, hl_error *error) {
  const hl_overlay *overlay = place->overlay;
  corner_part parts[PARTS] = {{.name = "picture of the axes",
                               .draw = hl_overlay_axes,
                               .wanted = overlay->axes == HL_AXES_ARROWS,
                               .usual = HL_CORNER_LOWER_RIGHT,
                               .asked = overlay->arrows_corner},
                              {.name = "scale bar",
                               .draw = hl_overlay_bar,
                               .wanted = overlay->scale_bar,
                               .usual = HL_CORNER_LOWER_LEFT,
                               .asked = overlay->scale_bar_corner},
                              {.name = "legend",
                               .draw = hl_overlay_legend,
                               .wanted = overlay->legend && overlay->legend_corner != HL_CORNER_BELOW,
                               .usual = HL_CORNER_UPPER_RIGHT,
                               .asked = overlay->legend_corner}};
  hl_ink trial = begin_trial(ink);
  hl_line_of_text letter = {0};
  if (overlay->letter != NULL) letter = place_letter(&trial, place);
  hl_status status = place_annotations(&trial, place, lines, error);
  if (status == HL_OK) status = place_parts(&trial, place, cover, parts, error);
  cairo_destroy(trial.cairo);
  if (ground->legend_covers != NULL) {
    const corner_part *legend = &parts[LEGEND];
    *ground->legend_covers = !legend->is_placed || legend->left_out > 0 ||
                             legend->covered >= unit_of(legend->box);
    return status;
  }
  if (status == HL_OK) tell_left_out(ground, parts);
  if (status == HL_OK) status = draw_all(ink, place, cover, parts, lines, &letter, error);
  return status;
}

hl_status hl_overlay_draw(const hl_ink *ink, const hl_overlay *overlay, const hl_overlay_ground *ground,
                          hl_error *error) {
  const hl_rectangle picture = ground->picture;
  hl_overlay_place place = {.overlay = overlay,
                            .scene = hl_scene_describe(ground->scene),
                            .picture = picture,
                            .taken.picture = picture,
                            .margin = fmin(ink->size, 0.06 * fmin(picture.width, picture.height))};
  if (place.scene != NULL) place.map = hl_map_of(&place.scene->camera, picture);
  for (size_t n = 0; n < ground->inset_count; n++) hl_take(&place.taken, ground->insets[n]);
  const size_t count = overlay->annotation_count;
  hl_cover cover = {0};
  hl_line_of_text *lines = hl_allocate(ground->context, count + 1, sizeof *lines);
  hl_status status = lines != NULL ? HL_OK
                                   : hl_fail_memory(error, (count + 1) * sizeof *lines, "a figure's texts");
  if (status == HL_OK) status = hl_cover_measure(ground->context, ground->matter, &cover, error);
  if (status == HL_OK) status = place_and_draw(ink, &place, &cover, ground, lines, error);
  hl_cover_release(&cover);
  hl_release(ground->context, lines);
  return status;
}

/* ---- a strip of the page ---- */

/* The greatest width of the rows of a legend in columns (a long word may make a row wider), and the
 * greatest height of the legend's strips of colours; in units of the letters' size. */
static const double column_width = 16, column_strip = 5;

hl_status hl_overlay_strip(const hl_ink *ink, const hl_overlay *overlay, const hl_scene *scene,
                           hl_rectangle strip, bool draws, double *height, hl_error *error) {
  const double size = ink->size, line = 0.7 * size;
  hl_overlay_place place = {
      .overlay = overlay,
      .scene = hl_scene_describe(scene),
      .picture = strip,
      .margin = size,
      .legend = {.width = column_width * size, .strip_height = column_strip * size, .in_columns = true}};
  hl_rectangle box = {0};
  hl_status status;
  do {
    /* A legend with higher columns has fewer columns. The columns' height grows line by line until the
     * columns fit into the strip, or until one column holds all rows. */
    place.legend.height += line;
    status = find_box(ink, &place, hl_overlay_legend, &box, error);
  } while (status == HL_OK && box.left + box.width > strip.left + strip.width - place.margin &&
           place.legend.height < box.height + 2 * place.legend.strip_height);
  place.legend.height = fmax(place.legend.height, box.height); /* no column is lower than the least height */
  if (status == HL_OK) status = find_box(ink, &place, hl_overlay_legend, &box, error);
  *height = box.height + 2 * place.margin;
  return status == HL_OK && draws ? hl_overlay_legend(ink, &place, error) : status;
}
