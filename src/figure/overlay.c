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

hl_status hl_overlay_draw(const hl_ink *ink, const hl_overlay *overlay, const hl_scene *scene,
                          hl_rectangle picture, hl_error *error) {
  hl_overlay_place place = {.overlay = overlay,
                            .scene = hl_scene_describe(scene),
                            .picture = picture,
                            .margin = fmin(ink->size, 0.06 * fmin(picture.width, picture.height))};
  if (place.scene != NULL) place.map = hl_map_of(&place.scene->camera, picture);
  hl_status status = overlay->marks ? hl_overlay_marks(ink, &place, error) : HL_OK;
  if (status == HL_OK && overlay->legend) status = hl_overlay_legend(ink, &place, error);
  if (status == HL_OK && overlay->axes != HL_AXES_NONE) status = hl_overlay_axes(ink, &place, error);
  if (status == HL_OK && overlay->scale_bar) status = hl_overlay_bar(ink, &place, error);
  for (size_t a = 0; status == HL_OK && a < overlay->annotation_count; a++)
    status = draw_annotation(ink, &place, &overlay->annotations[a], error);
  if (status == HL_OK) draw_letter(ink, &place);
  return status;
}
