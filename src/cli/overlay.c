/* cli/overlay.c - writes pictures to files, with their overlays. */
#define _GNU_SOURCE
#include "overlay.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "text/stem.h"

static bool is_vectors(const char *path) {
  return has_extension(path, ".pdf") || has_extension(path, ".svg");
}

double overlay_unit(const char *name) {
  static const struct {
    const char *name;
    double millimetres;
  } units[] = {{"mm", 1}, {"cm", 10}, {"in", MILLIMETRES_PER_INCH}, {"pt", MILLIMETRES_PER_INCH / 72}};
  for (size_t u = 0; u < sizeof units / sizeof *units; u++)
    if (strcmp(name, units[u].name) == 0) return units[u].millimetres;
  return 0;
}

void overlay_release(cli_overlay *overlay) {
  for (int n = 0; n < MAXIMUM_REPEATS; n++) free(overlay->texts[n]);
}

bool overlay_is_any(const cli_overlay *overlay) {
  return overlay->drawn || overlay->width > 0 || overlay->pixels_per_inch > 0;
}

static void hold(hl_corner *corner, hl_corner usual) {
  if (*corner == HL_CORNER_FREE) *corner = usual;
}

void overlay_hold(cli_overlay *overlay) {
  hold(&overlay->overlay.legend_corner, HL_CORNER_UPPER_RIGHT);
  hold(&overlay->overlay.scale_bar_corner, HL_CORNER_LOWER_LEFT);
  hold(&overlay->overlay.arrows_corner, HL_CORNER_LOWER_RIGHT);
}

/* Replaces the words for a picture's number and for its file's name in a text. The caller owns the new text,
 * which is null if memory is short. */
static char *fill_text(const char *text, int number, const char *file) {
  size_t length = 0;
  const char *begin = file != NULL ? hl_stem(file, &length) : NULL;
  char *stem = begin != NULL ? strndup(begin, length) : NULL;
  char *filled = begin == NULL || stem != NULL ? output_fill(text, (output_words){stem, number, false})
                                               : NULL;
  free(stem);
  return filled;
}

bool overlay_for_picture(const cli_overlay *overlay, int number, const char *file, cli_overlay *copy) {
  *copy = *overlay;
  memset(copy->texts, 0, sizeof copy->texts);
  copy->overlay.annotations = copy->notes;
  for (size_t n = 0; n < overlay->overlay.annotation_count; n++) {
    copy->notes[n].text = copy->texts[n] = fill_text(overlay->notes[n].text, number, file);
    if (copy->texts[n] == NULL) return false;
  }
  return true;
}

/* Describes the page that the picture fills, with the strip of a legend below it. */
static hl_status make_figure(hl_context *context, const cli_overlay *overlay, const hl_image *image,
                             const hl_scene *scene, hl_figure *figure, hl_figure_panel *panel,
                             hl_error *error) {
  double width = overlay->width;
  if (width == 0 && overlay->pixels_per_inch > 0)
    width = hl_image_width(image) * MILLIMETRES_PER_INCH / overlay->pixels_per_inch;
  hl_figure_defaults(figure);
  *panel = (hl_figure_panel){0};
  hl_overlay_defaults(&panel->overlay);
  hl_figure_of_picture(image, scene, width, figure, panel);
  if (overlay->font_points > 0) figure->font_points = overlay->font_points;
  panel->overlay = overlay->overlay;
  hl_status status = hl_figure_clear_legend(context, figure, panel, error);
  return status == HL_OK ? hl_figure_add_strip(context, figure, error) : status;
}

hl_status overlay_check_scene(hl_context *context, const cli_overlay *overlay, const hl_scene *scene,
                              hl_error *error) {
  const hl_scene_description *description = hl_scene_describe(scene);
  hl_figure figure;
  hl_figure_panel panel;
  hl_image *trial = NULL;
  if (!overlay->drawn) return HL_OK;
  hl_status status = hl_image_create(context, description->width, description->height, &trial, error);
  if (status == HL_OK) status = make_figure(context, overlay, trial, scene, &figure, &panel, error);
  if (status == HL_OK) status = hl_figure_check(context, &figure, error);
  hl_image_destroy(trial);
  return status;
}

/* Begins to write a picture's file: describes its page, and sets the physical size that a file of pixels
 * states. *draws: false if the picture is written as it is, without a figure. */
static hl_status begin(hl_context *context, const cli_overlay *overlay, const hl_image *image,
                       const hl_scene *scene, bool vectors, hl_image_write_options *options, bool *draws,
                       hl_figure *figure, hl_figure_panel *panel, hl_error *error) {
  *draws = overlay != NULL && (overlay->drawn || vectors);
  if (overlay == NULL) return HL_OK;
  hl_status status = make_figure(context, overlay, image, scene, figure, panel, error);
  figure->background_transparent = options->background_transparent;
  if (overlay->pixels_per_inch > 0) options->pixels_per_inch = overlay->pixels_per_inch;
  else options->pixels_per_inch = overlay->width > 0 ? figure->pixels_per_inch : 0;
  return status;
}

hl_status overlay_write(hl_context *context, const cli_overlay *overlay, const hl_image *image,
                        const hl_scene *scene, const char *path, hl_image_write_options *options,
                        hl_error *error) {
  hl_figure figure;
  hl_figure_panel panel;
  bool draws;
  hl_status status = begin(context, overlay, image, scene, is_vectors(path), options, &draws, &figure, &panel,
                           error);
  if (status != HL_OK) return status;
  return draws ? hl_figure_write(context, &figure, path, options, error)
               : hl_image_write(context, image, path, options, error);
}

hl_status overlay_encode(hl_context *context, const cli_overlay *overlay, const hl_image *image,
                         const hl_scene *scene, const char *format, hl_image_write_options *options,
                         unsigned char **bytes, size_t *length, hl_error *error) {
  hl_figure figure;
  hl_figure_panel panel;
  bool draws, vectors = strcmp(format, "pdf") == 0 || strcmp(format, "svg") == 0;
  hl_status status = begin(context, overlay, image, scene, vectors, options, &draws, &figure, &panel, error);
  if (status != HL_OK) return status;
  return draws ? hl_figure_encode(context, &figure, format, options, bytes, length, error)
               : hl_image_encode(context, image, format, options, bytes, length, error);
}
