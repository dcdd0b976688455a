/* figure/overlay.c - draws the overlay of one picture. Annotations and the panel's letter are drawn here;
 * each other part has a file of its own. */
#include "figure/overlay.h"

static hl_status draw_annotation(const hl_ink *ink, const hl_overlay_place *place, const hl_annotation *note,
                                 hl_error *error) {
  const hl_rectangle picture = place->picture;
  double x = picture.left + note->at[0] * picture.width, y = picture.top + note->at[1] * picture.height;
  if (note->text == NULL || !isfinite(note->at[0] + note->at[1] + note->at[2]))
    return hl_fail(error, HL_ERROR_ARGUMENT, "annotation: it needs a text and a finite place");
  hl_line_of_text line = {.text = note->text, .align_y = 0.5, .paragraphs = true};
  if (note->in_world) {
    if (!hl_map_point(&place->map, vec3_of(note->at), &x, &y))
      return hl_fail(error, HL_ERROR_ARGUMENT, "annotation '%.40s': its point lies behind the eye",
                     note->text);
    const double radius = 0.3 * ink->size;
    cairo_new_path(ink->cairo);
    cairo_arc(ink->cairo, x, y, radius, 0, 2 * HL_PI);
    hl_ink_stroke(ink, 0.1 * ink->size);
    line.x = x + 2.2 * radius;
  } else {
    line.x = x;
  }
  line.y = y;
  hl_ink_text(ink, &line);
  return HL_OK;
}

static void draw_letter(const hl_ink *ink, const hl_overlay_place *place) {
  if (place->overlay->letter == NULL) return;
  hl_ink_text(ink, &(hl_line_of_text){.text = place->overlay->letter,
                                      .x = place->picture.left + place->margin,
                                      .y = place->picture.top + 0.7 * place->margin,
                                      .scale = 1.4,
                                      .bold = true});
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

/* Draws a part that is alone in a corner of the picture. If matter lies behind the part, draws a ground below
 * it. */
static hl_status draw_part(const hl_ink *ink, const hl_overlay_place *place, const hl_image *image,
                           overlay_part part, hl_error *error) {
  const double rim = 0.4 * ink->size;
  hl_rectangle box;
  if (image != NULL) {
    hl_status status = find_box(ink, place, part, &box, error);
    if (status != HL_OK) return status;
    box = (hl_rectangle){box.left - rim, box.top - rim, box.width + 2 * rim, box.height + 2 * rim};
    if (shows_matter(image, place->picture, box)) draw_ground(ink, box);
  }
  return part(ink, place, error);
}

hl_status hl_overlay_draw(const hl_ink *ink, const hl_overlay *overlay, const hl_scene *scene,
                          const hl_image *image, hl_rectangle picture, hl_error *error) {
  hl_overlay_place place = {.overlay = overlay,
                            .scene = hl_scene_describe(scene),
                            .picture = picture,
                            .margin = fmin(ink->size, 0.06 * fmin(picture.width, picture.height))};
  if (place.scene != NULL) place.map = hl_map_of(&place.scene->camera, picture);
  hl_status status = overlay->marks ? hl_overlay_marks(ink, &place, error) : HL_OK;
  if (status == HL_OK && overlay->legend) status = draw_part(ink, &place, image, hl_overlay_legend, error);
  if (status == HL_OK && overlay->axes == HL_AXES_LETTERS) status = hl_overlay_axes(ink, &place, error);
  if (status == HL_OK && overlay->axes == HL_AXES_ARROWS)
    status = draw_part(ink, &place, image, hl_overlay_axes, error);
  if (status == HL_OK && overlay->scale_bar) status = draw_part(ink, &place, image, hl_overlay_bar, error);
  for (size_t a = 0; status == HL_OK && a < overlay->annotation_count; a++)
    status = draw_annotation(ink, &place, &overlay->annotations[a], error);
  if (status == HL_OK) draw_letter(ink, &place);
  return status;
}
