/* figure/figure.c - implements the public functions of figures: sets defaults, checks figures, and writes
 * them to files.
 *
 * In: a figure with its pictures. Out: PDF and SVG from page.c as they are drawn; PNG and TIFF through the
 * pixels that page.c draws and the picture's own writers. */
#include <halflight/figure.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/context.h"
#include "core/door.h"
#include "core/endings.h"
#include "core/memory.h"
#include "figure/page.h"
#include "text/plain.h"

enum { MOST_PANELS = 256, MOST_SIDE_PIXELS = 32767 }; /* cairo draws no larger surfaces */

void hl_overlay_defaults(hl_overlay *overlay) {
  if (overlay != NULL) *overlay = (hl_overlay){.struct_size = sizeof *overlay};
}

void hl_figure_defaults(hl_figure *figure) {
  if (figure == NULL) return;
  *figure = (hl_figure){.struct_size = sizeof *figure,
                        .pixels_per_inch = 300,
                        .font_points = 7,
                        .font = "Sans",
                        .background = {1, 1, 1}};
}

void hl_figure_of_picture(const hl_image *image, const hl_scene *scene, double width, hl_figure *figure,
                          hl_figure_panel *panel) {
  HL_DOOR;
  if (image == NULL || figure == NULL || panel == NULL) return;
  const double wide = hl_image_width(image), high = hl_image_height(image);
  const double letter = figure->font_points * MILLIMETRES_PER_INCH / POINTS_PER_INCH;
  if (width <= 0) width = fmin(36 * letter, wide / 9 * letter);
  figure->width = width;
  figure->height = width * high / wide;
  figure->pixels_per_inch = wide * MILLIMETRES_PER_INCH / width;
  figure->panels = panel;
  figure->panel_count = 1;
  panel->image = image;
  panel->scene = scene;
  panel->left = panel->top = 0;
  panel->width = figure->width;
  panel->height = figure->height;
  hl_image_write_options options;
  hl_scene_write_options(scene, &options);
  figure->background_transparent = options.background_transparent;
  memcpy(figure->background, options.background, sizeof figure->background);
}

static hl_status check_panel(const hl_figure_panel *panel, size_t index, hl_error *error) {
  const double numbers[] = {panel->left, panel->top, panel->width, panel->height};
  if (panel->overlay.struct_size != sizeof panel->overlay)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "panel %zu: its overlay has no defaults: call hl_overlay_defaults", index + 1);
  for (int n = 0; n < 4; n++)
    if (!(fabs(numbers[n]) <= 1e5) || (n > 1 && !(numbers[n] > 0)))
      return hl_fail(error, HL_ERROR_ARGUMENT,
                     "panel %zu: its place must be finite, and its width and height above 0 mm", index + 1);
  const hl_overlay *overlay = &panel->overlay;
  const hl_corner corners[] = {overlay->scale_bar_corner, overlay->legend_corner, overlay->arrows_corner};
  for (int n = 0; n < 3; n++)
    if ((unsigned)corners[n] > HL_CORNER_LOWER_RIGHT && (n != 1 || corners[n] != HL_CORNER_BELOW))
      return hl_fail(error, HL_ERROR_ARGUMENT, "panel %zu: %d is no hl_corner", index + 1, (int)corners[n]);
  bool of_scene = overlay->scale_bar || overlay->legend || overlay->marks || overlay->axes != HL_AXES_NONE;
  for (size_t a = 0; a < overlay->annotation_count; a++) of_scene |= overlay->annotations[a].in_world != 0;
  if (of_scene && panel->scene == NULL)
    return hl_fail(
        error, HL_ERROR_ARGUMENT,
        "panel %zu: a scale bar, a legend, axes, marks and points of the world need the picture's scene",
        index + 1);
  return HL_OK;
}

static hl_status check(const hl_figure *figure, hl_error *error) {
  if (figure->struct_size != sizeof *figure)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "figure: struct_size is %zu, expected %zu: call hl_figure_defaults", figure->struct_size,
                   sizeof *figure);
  if (!(figure->width >= 1 && figure->width <= 5000 && figure->height >= 1 && figure->height <= 5000))
    return hl_fail(error, HL_ERROR_ARGUMENT, "figure: %g x %g mm: each side must be from 1 to 5000 mm",
                   figure->width, figure->height);
  if (!(figure->pixels_per_inch >= 1 && figure->pixels_per_inch <= 1e5))
    return hl_fail(error, HL_ERROR_ARGUMENT, "figure: %g pixels an inch: give 1 to 100000",
                   figure->pixels_per_inch);
  if (!(figure->font_points >= 1 && figure->font_points <= 200) || figure->font == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "figure: its letters need a font of 1 to 200 points");
  if (figure->panel_count > MOST_PANELS)
    return hl_fail(error, HL_ERROR_ARGUMENT, "figure: %zu panels: at most %d fit", figure->panel_count,
                   (int)MOST_PANELS);
  for (size_t p = 0; p < figure->panel_count; p++) {
    hl_status status = check_panel(&figure->panels[p], p, error);
    if (status != HL_OK) return status;
  }
  return HL_OK;
}

const hl_figure_panel *hl_panel_of_strip(const hl_figure *figure) {
  for (size_t p = 0; p < figure->panel_count; p++) {
    const hl_figure_panel *panel = &figure->panels[p];
    if (panel->overlay.legend && panel->overlay.legend_corner == HL_CORNER_BELOW) return panel;
  }
  return NULL;
}

hl_status hl_figure_add_strip(hl_context *context, hl_figure *figure, hl_error *error) {
  HL_DOOR;
  if (context == NULL || figure == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_figure_add_strip: context and figure must not be null");
  const hl_figure_panel *panel = hl_panel_of_strip(figure);
  if (panel == NULL) return HL_OK;
  hl_status status = check(figure, error);
  if (status != HL_OK) return status;
  double bottom = 0, height;
  for (size_t p = 0; p < figure->panel_count; p++)
    bottom = fmax(bottom, figure->panels[p].top + figure->panels[p].height);
  status = hl_page_measure_strip(figure, panel, &height, error);
  if (status != HL_OK) return status;
  const double pixel = MILLIMETRES_PER_INCH / figure->pixels_per_inch; /* pictures keep whole pixels */
  figure->height = fmax(figure->height, ceil((bottom + height) / pixel - 1e-6) * pixel);
  return HL_OK;
}

hl_status hl_figure_clear_legend(hl_context *context, const hl_figure *figure, hl_figure_panel *panel,
                                 hl_error *error) {
  HL_DOOR;
  if (context == NULL || figure == NULL || panel == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "hl_figure_clear_legend: context, figure and panel must not be null");
  hl_overlay *overlay = &panel->overlay;
  if (!overlay->legend || overlay->legend_corner != HL_CORNER_FREE || panel->image == NULL) return HL_OK;
  if (panel < figure->panels || panel >= figure->panels + figure->panel_count)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_figure_clear_legend: the panel must be one of the figure's");
  hl_status status = check(figure, error);
  bool covers = false;
  if (status == HL_OK)
    status = hl_page_judge_legend(context, figure, (size_t)(panel - figure->panels), &covers, error);
  if (status != HL_OK || !covers) return status;
  overlay->legend_corner = HL_CORNER_BELOW;
  hl_log(
      context, HL_LOG_INFO,
      "the legend stands below the picture, where it covers nothing: --place legend=upper-right puts it into "
      "the picture");
  return HL_OK;
}

static double pixels_of(const hl_figure *figure, double length) {
  return round(length * figure->pixels_per_inch / MILLIMETRES_PER_INCH);
}

/* is_told: whether the context's log is told which parts of overlays find no room. */
static hl_status draw(hl_context *context, const hl_figure *figure, bool is_told, hl_image **image,
                      hl_error *error) {
  hl_status status = check(figure, error);
  if (status != HL_OK) return status;
  const double width = pixels_of(figure, figure->width), height = pixels_of(figure, figure->height);
  if (width < 1 || height < 1 || width > MOST_SIDE_PIXELS || height > MOST_SIDE_PIXELS)
    return hl_fail(
        error, HL_ERROR_ARGUMENT,
        "figure: %g x %g pixels: each side must be from 1 to %d: change its size or its pixels an inch",
        width, height, (int)MOST_SIDE_PIXELS);
  return hl_page_draw(context, figure, is_told, (int)width, (int)height, image, error);
}

hl_status hl_figure_draw(hl_context *context, const hl_figure *figure, hl_image **image, hl_error *error) {
  HL_DOOR;
  if (context == NULL || figure == NULL || image == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_figure_draw: context, figure and image must not be null");
  *image = NULL;
  return draw(context, figure, true, image, error);
}

hl_status hl_figure_check(hl_context *context, const hl_figure *figure, hl_error *error) {
  HL_DOOR;
  enum { COARSER = 8 };
  if (context == NULL || figure == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_figure_check: context and figure must not be null");
  size_t count = figure->panel_count;
  hl_figure trial = *figure;
  hl_figure_panel *panels = hl_allocate(context, count + 1, sizeof *panels);
  hl_image *image = NULL;
  if (panels == NULL) return hl_fail_memory(error, (count + 1) * sizeof *panels, "a figure's panels");
  for (size_t p = 0; p < count && figure->panels != NULL; p++) {
    panels[p] = figure->panels[p];
    panels[p].image = NULL;
  }
  if (figure->panels != NULL) trial.panels = panels;
  trial.pixels_per_inch = fmax(1, figure->pixels_per_inch / COARSER);
  hl_status status = draw(context, &trial, false, &image, error);
  hl_image_destroy(image);
  hl_release(context, panels);
  return status;
}

/* ---- formats ---- */

typedef enum figure_format { FORMAT_PDF, FORMAT_SVG, FORMAT_PIXELS, FORMAT_UNKNOWN } figure_format;

static figure_format format_of(const char *name) {
  static const char *const names[] = {"pdf", "svg", "png", "tif", "tiff"};
  for (size_t n = 0; n < sizeof names / sizeof *names; n++)
    if (hl_plain_equal(name, names[n])) return n < FORMAT_PIXELS ? (figure_format)n : FORMAT_PIXELS;
  return FORMAT_UNKNOWN;
}

hl_status hl_figure_get_format(size_t index, hl_file_format *format) {
  static const char *const names[] = {"PDF", "SVG"}, *const endings[] = {".pdf", ".svg"};
  if (format == NULL || format->struct_size != sizeof *format || index >= sizeof names / sizeof *names)
    return HL_ERROR_ARGUMENT;
  const char *missing = hl_page_missing();
  *format = (hl_file_format){
      .struct_size = sizeof *format, .name = names[index], .writes = missing == NULL, .missing = missing};
  hl_endings_add(format->written_endings, endings[index]);
  return HL_OK;
}

/* The options for writing the figure's pixels as a picture. */
static hl_image_write_options picture_options(const hl_figure *figure, const hl_image_write_options *given) {
  hl_image_write_options options;
  hl_image_write_options_defaults(&options);
  options.background_transparent = figure->background_transparent;
  options.pixels_per_inch = given != NULL ? given->pixels_per_inch : figure->pixels_per_inch;
  if (given != NULL) options.scene_json = given->scene_json;
  return options;
}

static hl_status write_vectors(hl_context *context, const hl_figure *figure, bool pdf, const char *path,
                               hl_error *error) {
  hl_output output;
  hl_status status = hl_output_begin(context, path, &output, error);
  if (status != HL_OK) return status;
  status = hl_page_write(figure, pdf, &output, error);
  if (status == HL_OK) status = hl_output_commit(&output, error);
  hl_output_abort(&output);
  return status;
}

hl_status hl_figure_write(hl_context *context, const hl_figure *figure, const char *path,
                          const hl_image_write_options *options, hl_error *error) {
  HL_DOOR;
  if (context == NULL || figure == NULL || path == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_figure_write: context, figure and path must not be null");
  const char *dot = strrchr(path, '.');
  figure_format format = dot != NULL ? format_of(dot + 1) : FORMAT_UNKNOWN;
  if (format == FORMAT_UNKNOWN)
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "%s: unknown format of figures: end the name in .pdf, .svg, .png or .tif", path);
  hl_status status = check(figure, error);
  if (status != HL_OK) return status;
  if (format != FORMAT_PIXELS) return write_vectors(context, figure, format == FORMAT_PDF, path, error);
  hl_image *image = NULL;
  hl_image_write_options chosen = picture_options(figure, options);
  status = hl_figure_draw(context, figure, &image, error);
  if (status == HL_OK) status = hl_image_write(context, image, path, &chosen, error);
  hl_image_destroy(image);
  return status;
}

static hl_status encode_vectors(hl_context *context, const hl_figure *figure, bool pdf, unsigned char **bytes,
                                size_t *length, hl_error *error) {
  hl_output_memory memory;
  hl_status status = hl_output_memory_begin(context, "a figure in memory", &memory, error);
  if (status != HL_OK) return status;
  status = hl_page_write(figure, pdf, &memory.output, error);
  if (memory.full) status = hl_fail_memory(error, memory.capacity, "a figure in memory");
  if (status == HL_OK) return hl_output_memory_commit(&memory, bytes, length, error);
  hl_output_memory_abort(&memory);
  return status;
}

hl_status hl_figure_encode(hl_context *context, const hl_figure *figure, const char *format_name,
                           const hl_image_write_options *options, unsigned char **bytes, size_t *length,
                           hl_error *error) {
  HL_DOOR;
  if (context == NULL || figure == NULL || format_name == NULL || bytes == NULL || length == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "hl_figure_encode: context, figure, format, bytes and length must not be null");
  *bytes = NULL;
  *length = 0;
  figure_format format = format_of(format_name);
  if (format == FORMAT_UNKNOWN)
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "hl_figure_encode: unknown format \"%.20s\": give pdf, svg, png or tif", format_name);
  hl_status status = check(figure, error);
  if (status != HL_OK) return status;
  if (format != FORMAT_PIXELS)
    return encode_vectors(context, figure, format == FORMAT_PDF, bytes, length, error);
  hl_image *image = NULL;
  hl_image_write_options chosen = picture_options(figure, options);
  status = hl_figure_draw(context, figure, &image, error);
  if (status == HL_OK) status = hl_image_encode(context, image, format_name, &chosen, bytes, length, error);
  hl_image_destroy(image);
  return status;
}
