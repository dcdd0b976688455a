/* figure/overlay.c - draws the overlay of one picture. Annotations and the panel's letter are drawn here;
 * each other part has a file of its own. */
#include "figure/overlay.h"

/* ---- what is taken ---- */

bool hl_rectangles_meet(hl_rectangle a, hl_rectangle b) {
  return a.left < b.left + b.width && b.left < a.left + a.width && a.top < b.top + b.height &&
         b.top < a.top + a.height;
}

static bool lies_in(hl_rectangle box, hl_rectangle picture) {
  return box.left >= picture.left && box.left + box.width <= picture.left + picture.width &&
         box.top >= picture.top && box.top + box.height <= picture.top + picture.height;
}

bool hl_overlay_is_free(const hl_overlay_place *place, hl_rectangle box) {
  for (size_t n = 0; n < place->taken_count; n++)
    if (hl_rectangles_meet(place->taken[n], box)) return false;
  return lies_in(box, place->picture);
}

void hl_overlay_take(hl_overlay_place *place, hl_rectangle box) {
  if (place->taken_count < HL_MOST_TAKEN) place->taken[place->taken_count++] = box;
}

/* The distance, to the left or to the right, by which a box must be moved so that it overlaps no taken
 * rectangle. The result is 0 if the box overlaps none already, or if no such place lies within the
 * picture. */
static double way_to_clear(const hl_overlay_place *place, hl_rectangle box, bool to_left) {
  const double from = box.left;
  for (size_t turn = 0; turn <= place->taken_count; turn++) {
    size_t n = 0;
    while (n < place->taken_count && !hl_rectangles_meet(place->taken[n], box)) n++;
    if (n == place->taken_count) return turn == 0 || lies_in(box, place->picture) ? box.left - from : 0;
    const hl_rectangle taken = place->taken[n];
    box.left = to_left ? taken.left - box.width : taken.left + taken.width;
  }
  return 0;
}

/* ---- texts ---- */

/* Fills a text with the content of an annotation. circle: the radius of the ring around a point of the world;
 * 0 if the annotation has no ring. */
static hl_status lay_annotation(const hl_ink *ink, const hl_overlay_place *place, const hl_annotation *note,
                                hl_line_of_text *line, double *circle, hl_error *error) {
  const hl_rectangle picture = place->picture;
  double x = picture.left + note->at[0] * picture.width, y = picture.top + note->at[1] * picture.height;
  if (note->text == NULL || !isfinite(note->at[0] + note->at[1] + note->at[2]))
    return hl_fail(error, HL_ERROR_ARGUMENT, "annotation: it needs a text and a finite place");
  *circle = 0;
  if (note->in_world) {
    if (!hl_map_point(&place->map, vec3_of(note->at), &x, &y))
      return hl_fail(error, HL_ERROR_ARGUMENT, "annotation '%.40s': its point lies behind the eye",
                     note->text);
    *circle = 0.3 * ink->size;
  }
  *line = (hl_line_of_text){
      .text = note->text, .x = x + 2.2 * *circle, .y = y, .align_y = 0.5, .paragraphs = true};
  return HL_OK;
}

static hl_status draw_annotation(const hl_ink *ink, const hl_overlay_place *place, const hl_annotation *note,
                                 hl_error *error) {
  hl_line_of_text line;
  double circle;
  hl_status status = lay_annotation(ink, place, note, &line, &circle, error);
  if (status != HL_OK) return status;
  if (circle > 0) {
    cairo_new_path(ink->cairo);
    cairo_arc(ink->cairo, line.x - 2.2 * circle, line.y, circle, 0, 2 * HL_PI);
    hl_ink_stroke(ink, 0.1 * ink->size);
  }
  hl_ink_text(ink, &line);
  return HL_OK;
}

/* The panel's letter at the upper left, beside an inset that lies there. */
static hl_line_of_text lay_letter(const hl_ink *ink, const hl_overlay_place *place) {
  hl_line_of_text line = {.text = place->overlay->letter,
                          .x = place->picture.left + place->margin,
                          .y = place->picture.top + 0.7 * place->margin,
                          .scale = 1.4,
                          .bold = true};
  line.x += way_to_clear(place, hl_ink_box(ink, &line), false);
  return line;
}

/* Marks the places of the panel's letter and of the annotations as taken, so that no other text is drawn
 * there. */
static hl_status take_texts(const hl_ink *ink, hl_overlay_place *place, const hl_line_of_text *letter,
                            hl_error *error) {
  if (letter->text != NULL) hl_overlay_take(place, hl_ink_box(ink, letter));
  for (size_t a = 0; a < place->overlay->annotation_count; a++) {
    hl_line_of_text line;
    double circle;
    hl_status status = lay_annotation(ink, place, &place->overlay->annotations[a], &line, &circle, error);
    if (status != HL_OK) return status;
    hl_overlay_take(place, hl_ink_box(ink, &line));
  }
  return HL_OK;
}

/* ---- the ground behind parts that lie over matter ---- */

typedef hl_status (*overlay_part)(const hl_ink *ink, const hl_overlay_place *place, hl_error *error);

/* The least opacity of a black ground at which white letters have the contrast 4.5 (WCAG 2.1, 1.4.3) over a
 * white picture. Derived: (1 + 0.05) / (Y + 0.05) = 4.5 for the luminance Y = 0.183 of the sRGB grey 1 -
 * 0.534. A white ground under black letters needs less: 0.456. */
static const double ground_opacity = 0.54;

/* The least opacity that changes an 8-bit code. */
static const float seen_opacity = 0.5F / 255;

/* Finds the box around the drawing of a part, by drawing the part on a recording surface. */
static hl_status find_box(const hl_ink *ink, const hl_overlay_place *place, overlay_part part,
                          hl_rectangle *box, hl_error *error) {
  cairo_surface_t *record = cairo_recording_surface_create(CAIRO_CONTENT_COLOR_ALPHA, NULL);
  hl_ink trial = *ink;
  trial.cairo = cairo_create(record);
  hl_status status = part(&trial, place, error);
  cairo_destroy(trial.cairo);
  cairo_recording_surface_ink_extents(record, &box->left, &box->top, &box->width, &box->height);
  cairo_surface_destroy(record);
  return status;
}

/* The number of a picture's pixel at a place, from 0 to `count`; part: the place, from 0 to 1. */
static int pixel_at(double part, int count) { return (int)fmin(fmax(floor(part * count), 0), count); }

/* Returns whether the picture shows matter in a box on the page. */
static bool shows_matter(const hl_image *image, hl_rectangle picture, hl_rectangle box) {
  const int width = hl_image_width(image), height = hl_image_height(image);
  const float *pixels = hl_image_pixels_const(image);
  const double left = (box.left - picture.left) / picture.width,
               top = (box.top - picture.top) / picture.height;
  const int first = pixel_at(left, width), last = pixel_at(left + box.width / picture.width, width - 1);
  const int end = pixel_at(top + box.height / picture.height, height - 1);
  for (int y = pixel_at(top, height); y <= end; y++)
    for (int x = first; x <= last; x++)
      if (pixels[4 * ((size_t)y * (size_t)width + (size_t)x) + 3] >= seen_opacity) return true;
  return false;
}

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

/* A part that has a corner of the picture to itself. */
typedef struct corner_part {
  overlay_part draw;
  bool wanted, right; /* right: the corner lies at the picture's right side */
  hl_rectangle box;   /* where the part lies, before it is moved, with a rim */
  double way;         /* the way to the right that the part is moved by, points */
} corner_part;

/* Finds the place of a part, beside what is taken. */
static hl_status settle_part(const hl_ink *ink, const hl_overlay_place *place, corner_part *part,
                             hl_error *error) {
  const double rim = 0.4 * ink->size;
  hl_status status = find_box(ink, place, part->draw, &part->box, error);
  if (status != HL_OK) return status;
  part->box = (hl_rectangle){part->box.left - rim, part->box.top - rim, part->box.width + 2 * rim,
                             part->box.height + 2 * rim};
  part->way = way_to_clear(place, part->box, part->right);
  return HL_OK;
}

static hl_rectangle moved_box(const corner_part *part) {
  hl_rectangle box = part->box;
  box.left += part->way;
  return box;
}

/* Draws a part, on a ground where matter lies behind it. */
static hl_status draw_part(const hl_ink *ink, const hl_overlay_place *place, const hl_image *image,
                           const corner_part *part, hl_error *error) {
  cairo_save(ink->cairo);
  cairo_translate(ink->cairo, part->way, 0);
  if (image != NULL && shows_matter(image, place->picture, moved_box(part))) draw_ground(ink, part->box);
  hl_status status = part->draw(ink, place, error);
  cairo_restore(ink->cairo);
  return status;
}

hl_status hl_overlay_draw(const hl_ink *ink, const hl_overlay *overlay, const hl_scene *scene,
                          const hl_image *image, hl_rectangle picture, const hl_rectangle *insets,
                          size_t inset_count, hl_error *error) {
  hl_overlay_place place = {.overlay = overlay,
                            .scene = hl_scene_describe(scene),
                            .picture = picture,
                            .margin = fmin(ink->size, 0.06 * fmin(picture.width, picture.height))};
  if (place.scene != NULL) place.map = hl_map_of(&place.scene->camera, picture);
  corner_part parts[] = {
      {.draw = hl_overlay_legend, .wanted = overlay->legend, .right = true},
      {.draw = hl_overlay_bar, .wanted = overlay->scale_bar},
      {.draw = hl_overlay_axes, .wanted = overlay->axes == HL_AXES_ARROWS, .right = true},
  };
  const size_t count = sizeof parts / sizeof *parts;
  hl_status status = HL_OK;
  for (size_t n = 0; n < inset_count; n++) hl_overlay_take(&place, insets[n]);
  hl_line_of_text letter = {0};
  if (overlay->letter != NULL) letter = lay_letter(ink, &place);
  for (size_t n = 0; n < count && status == HL_OK; n++)
    if (parts[n].wanted) status = settle_part(ink, &place, &parts[n], error);
  for (size_t n = 0; n < count && status == HL_OK; n++)
    if (parts[n].wanted) hl_overlay_take(&place, moved_box(&parts[n]));
  if (status == HL_OK) status = take_texts(ink, &place, &letter, error);
  if (status == HL_OK && overlay->marks) status = hl_overlay_marks(ink, &place, error);
  for (size_t n = 0; n < count && status == HL_OK; n++)
    if (parts[n].wanted) status = draw_part(ink, &place, image, &parts[n], error);
  if (status == HL_OK && overlay->axes == HL_AXES_LETTERS) status = hl_overlay_axes(ink, &place, error);
  for (size_t a = 0; status == HL_OK && a < overlay->annotation_count; a++)
    status = draw_annotation(ink, &place, &overlay->annotations[a], error);
  if (status == HL_OK && letter.text != NULL) hl_ink_text(ink, &letter);
  return status;
}
