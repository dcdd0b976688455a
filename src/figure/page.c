/* figure/page.c - draws a figure's panels, through cairo, on pixels, PDF or SVG.
 *
 * In: the figure, checked. Out: a picture, or the bytes of a file. The unit of length is always the point.
 * Pictures are drawn into their rectangles as 8-bit sRGB. A picture whose pixels are as large as the page's
 * pixels is not resampled. Cairo allocates its surfaces outside of the context's memory. */
#include "figure/page.h"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <errno.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "figure/overlay.h"
#include "image/format.h"
#include "image/srgb.h"

static const double points_per_millimetre = POINTS_PER_INCH / MILLIMETRES_PER_INCH;

/* ---- a picture as a surface ---- */

static const cairo_user_data_key_t bytes_key;

typedef struct page_bytes {
  hl_context *context;
  unsigned char *bytes;
} page_bytes;

static void release_bytes(void *data) {
  page_bytes *owned = data;
  hl_context *context = owned->context;
  hl_release(context, owned->bytes);
  hl_release(context, owned);
}

/* Turns a row of R, G, B, A into cairo's format: 32-bit words with alpha in the highest byte, and colours
 * that are multiplied by alpha. */
static void to_cairo(unsigned char *row, int width) {
  for (int x = 0; x < width; x++, row += 4) {
    uint32_t alpha = row[3], word = alpha << 24;
    for (int c = 0; c < 3; c++) word |= (row[c] * alpha + 127) / 255 << (16 - 8 * c);
    memcpy(row, &word, sizeof word);
  }
}

/* Makes a cairo surface of a panel's picture. If the panel has no scene, transparent parts of its picture
 * show the page's background. */
static hl_status make_surface(hl_context *context, const hl_figure *figure, const hl_figure_panel *panel,
                              cairo_surface_t **surface, hl_error *error) {
  const int width = hl_image_width(panel->image), height = hl_image_height(panel->image);
  const size_t stride = 4 * (size_t)width, size = stride * (size_t)height;
  hl_image_write_options options;
  hl_scene_write_options(panel->scene, &options);
  if (panel->scene == NULL) {
    options.background_transparent = figure->background_transparent;
    memcpy(options.background, figure->background, sizeof options.background);
  }
  page_bytes *owned = hl_allocate(context, 1, sizeof *owned);
  unsigned char *bytes = hl_allocate(context, size, 1);
  hl_status status = owned != NULL && bytes != NULL ? HL_OK
                                                    : hl_fail_memory(error, size, "a figure's picture");
  if (status == HL_OK) status = hl_image_to_srgb8(panel->image, &options, bytes, stride, error);
  if (status != HL_OK) {
    hl_release(context, owned);
    hl_release(context, bytes);
    return status;
  }
  for (int y = 0; y < height; y++) to_cairo(bytes + (size_t)y * stride, width);
  *owned = (page_bytes){context, bytes};
  *surface = cairo_image_surface_create_for_data(bytes, CAIRO_FORMAT_ARGB32, width, height, (int)stride);
  if (cairo_surface_set_user_data(*surface, &bytes_key, owned, release_bytes) == CAIRO_STATUS_SUCCESS)
    return HL_OK;
  cairo_surface_destroy(*surface);
  release_bytes(owned);
  return hl_fail_memory(error, size, "a figure's picture");
}

/* ---- panels ---- */

static hl_rectangle rectangle_of(const hl_figure_panel *panel) {
  return (hl_rectangle){panel->left * points_per_millimetre, panel->top * points_per_millimetre,
                        panel->width * points_per_millimetre, panel->height * points_per_millimetre};
}

/* Moves a rectangle's edges to borders between the device's pixels. */
static void snap(cairo_t *cairo, hl_rectangle *place) {
  double right = place->left + place->width, bottom = place->top + place->height;
  cairo_user_to_device(cairo, &place->left, &place->top);
  cairo_user_to_device(cairo, &right, &bottom);
  place->left = round(place->left);
  place->top = round(place->top);
  place->width = fmax(1, round(right) - place->left);
  place->height = fmax(1, round(bottom) - place->top);
}

static hl_status draw_picture(hl_context *context, cairo_t *cairo, const hl_figure *figure,
                              const hl_figure_panel *panel, bool pixels, hl_error *error) {
  cairo_surface_t *surface = NULL;
  hl_status status = make_surface(context, figure, panel, &surface, error);
  if (status != HL_OK) return status;
  hl_rectangle place = rectangle_of(panel);
  const int width = hl_image_width(panel->image), height = hl_image_height(panel->image);
  cairo_save(cairo);
  if (pixels) {
    snap(cairo, &place);
    cairo_identity_matrix(cairo);
  }
  bool exact = pixels && place.width == width && place.height == height;
  cairo_translate(cairo, place.left, place.top);
  if (!exact) cairo_scale(cairo, place.width / width, place.height / height);
  cairo_set_source_surface(cairo, surface, 0, 0);
  /* the pixels at the picture's edges repeat beyond the edges, so that resampling leaves the edges opaque */
  if (pixels && !exact) cairo_pattern_set_extend(cairo_get_source(cairo), CAIRO_EXTEND_PAD);
  cairo_pattern_set_filter(cairo_get_source(cairo), exact ? CAIRO_FILTER_NEAREST : CAIRO_FILTER_GOOD);
  cairo_rectangle(cairo, 0, 0, width, height);
  if (exact) cairo_set_antialias(cairo, CAIRO_ANTIALIAS_NONE);
  cairo_fill(cairo);
  cairo_restore(cairo);
  cairo_surface_destroy(surface);
  return HL_OK;
}

static double luma(const double linear[3]) { /* the luma of a colour by BT.709 */
  return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2];
}

/* Finds the mean colour of a picture over a ground, in linear RGB. */
static void mean_of_picture(const hl_image *image, const double ground[3], double mean[3]) {
  const size_t count = (size_t)hl_image_width(image) * (size_t)hl_image_height(image);
  const float *pixels = hl_image_pixels_const(image);
  for (int c = 0; c < 3; c++) mean[c] = 0;
  for (size_t n = 0; n < count; n++)
    for (int c = 0; c < 3; c++)
      mean[c] +=
          fmin(fmax((double)pixels[4 * n + (size_t)c] + (1 - (double)pixels[4 * n + 3]) * ground[c], 0), 1) /
          (double)count;
}

/* Chooses white ink on a dark ground, and black ink on a bright ground. The limit is the middle of sRGB's
 * scale, which is 0.214 in linear light. The ground of a picture without a scene is its mean colour. */
static hl_ink ink_for(cairo_t *cairo, const hl_figure *figure, const hl_figure_panel *panel) {
  const double *ground = figure->background;
  double mean[3];
  bool paper = figure->background_transparent != 0;
  const bool over_picture = panel->image != NULL || paper;
  if (panel->image != NULL && panel->scene == NULL) {
    static const double white[3] = {1, 1, 1};
    mean_of_picture(panel->image, paper ? white : figure->background, mean);
    ground = mean;
    paper = false;
  }
  if (over_picture && panel->scene != NULL) {
    const hl_scene_description *scene = hl_scene_describe(panel->scene);
    paper = scene->background_transparent && paper;
    if (!scene->background_transparent) ground = scene->background;
  }
  bool dark = !paper && luma(ground) < 0.214;
  return (hl_ink){.cairo = cairo,
                  .size = figure->font_points,
                  .font = figure->font,
                  .color = dark ? 1 : 0,
                  .halo = dark ? 0 : 1};
}

static void draw_frame(const hl_ink *ink, hl_rectangle place) {
  cairo_new_path(ink->cairo);
  cairo_rectangle(ink->cairo, place.left, place.top, place.width, place.height);
  cairo_set_source_rgb(ink->cairo, ink->color, ink->color, ink->color);
  cairo_set_line_width(ink->cairo, 0.1 * ink->size);
  cairo_stroke(ink->cairo);
}

/* Draws the overlay of a panel. The overlay keeps clear of the panels that will be drawn over this panel.
 * legend_covers: as in hl_overlay_ground. */
static hl_status draw_overlay(hl_context *context, const hl_figure *figure, size_t index, const hl_ink *ink,
                              bool is_told, bool *legend_covers, hl_error *error) {
  const hl_figure_panel *panel = &figure->panels[index];
  const hl_rectangle picture = rectangle_of(panel);
  hl_rectangle insets[HL_MOST_TAKEN];
  size_t count = 0;
  for (size_t p = index + 1; p < figure->panel_count && count < HL_MOST_TAKEN; p++) {
    const hl_rectangle other = rectangle_of(&figure->panels[p]);
    if (hl_rectangles_meet(picture, other)) insets[count++] = other;
  }
  const hl_overlay_ground ground = {.context = context,
                                    .scene = panel->scene,
                                    .matter = panel->matter != NULL ? panel->matter : panel->image,
                                    .picture = picture,
                                    .insets = insets,
                                    .inset_count = count,
                                    .panel = figure->panel_count > 1 ? index + 1 : 0,
                                    .is_told = is_told,
                                    .legend_covers = legend_covers};
  return hl_overlay_draw(ink, &panel->overlay, &ground, error);
}

hl_status hl_page_judge_legend(hl_context *context, const hl_figure *figure, size_t index, bool *covers,
                               hl_error *error) {
  const hl_ink ink = {.size = figure->font_points, .font = figure->font};
  return draw_overlay(context, figure, index, &ink, false, covers, error);
}

/* The strip of the page below all panels. */
static hl_rectangle strip_of(const hl_figure *figure) {
  double top = 0;
  for (size_t p = 0; p < figure->panel_count; p++) {
    const hl_rectangle panel = rectangle_of(&figure->panels[p]);
    top = fmax(top, panel.top + panel.height);
  }
  return (hl_rectangle){0, top, figure->width * points_per_millimetre,
                        figure->height * points_per_millimetre - top};
}

hl_status hl_page_measure_strip(const hl_figure *figure, const hl_figure_panel *panel, double *height,
                                hl_error *error) {
  const hl_ink ink = {.size = figure->font_points, .font = figure->font};
  hl_status status = hl_overlay_strip(&ink, &panel->overlay, panel->scene, strip_of(figure), false, height,
                                      error);
  *height /= points_per_millimetre;
  return status;
}

/* Draws the legend that lies below all panels, if a panel has such a legend. */
static hl_status draw_strip(const hl_figure *figure, cairo_t *cairo, hl_error *error) {
  static const hl_figure_panel paper = {0};
  const hl_figure_panel *panel = hl_panel_of_strip(figure);
  const hl_ink ink = ink_for(cairo, figure, &paper);
  double height;
  if (panel == NULL) return HL_OK;
  return hl_overlay_strip(&ink, &panel->overlay, panel->scene, strip_of(figure), true, &height, error);
}

static hl_status draw_panels(hl_context *context, const hl_figure *figure, cairo_t *cairo, bool pixels,
                             bool is_told, hl_error *error) {
  if (!figure->background_transparent) {
    hl_ink_source(cairo, figure->background, 1);
    cairo_paint(cairo);
  }
  hl_status status = HL_OK;
  for (size_t p = 0; status == HL_OK && p < figure->panel_count; p++) {
    const hl_figure_panel *panel = &figure->panels[p];
    if (panel->image != NULL) status = draw_picture(context, cairo, figure, panel, pixels, error);
    hl_ink ink = ink_for(cairo, figure, panel);
    if (panel->frame) draw_frame(&ink, rectangle_of(panel));
    if (status == HL_OK) status = draw_overlay(context, figure, p, &ink, is_told, NULL, error);
  }
  if (status == HL_OK) status = draw_strip(figure, cairo, error);
  if (status == HL_OK && cairo_status(cairo) != CAIRO_STATUS_SUCCESS)
    status = hl_fail(error, HL_ERROR_INTERNAL, "figure: cairo says: %s",
                     cairo_status_to_string(cairo_status(cairo)));
  return status;
}

/* ---- pixels ---- */

static void from_cairo(const unsigned char *row, int width, const float linear[256], float *pixel) {
  for (int x = 0; x < width; x++, row += 4, pixel += 4) {
    uint32_t word;
    memcpy(&word, row, sizeof word);
    uint32_t alpha = word >> 24;
    for (int c = 0; c < 3; c++) {
      uint32_t code = word >> (16 - 8 * c) & 0xff;
      uint32_t unassociated = alpha > 0 ? (code * 255 + alpha / 2) / alpha : 0;
      pixel[c] = linear[unassociated > 255 ? 255 : unassociated] * (float)alpha / 255;
    }
    pixel[3] = (float)alpha / 255;
  }
}

static hl_status to_image(hl_context *context, cairo_surface_t *surface, hl_image **image, hl_error *error) {
  const int width = cairo_image_surface_get_width(surface), height = cairo_image_surface_get_height(surface);
  hl_status status = hl_image_create(context, width, height, image, error);
  if (status != HL_OK) return status;
  float linear[256];
  for (int code = 0; code < 256; code++) linear[code] = (float)hl_srgb_decode((double)code / 255);
  cairo_surface_flush(surface);
  const unsigned char *row = cairo_image_surface_get_data(surface);
  float *pixels = hl_image_pixels(*image);
  for (int y = 0; y < height;
       y++, row += cairo_image_surface_get_stride(surface), pixels += 4 * (size_t)width)
    from_cairo(row, width, linear, pixels);
  return HL_OK;
}

hl_status hl_page_draw(hl_context *context, const hl_figure *figure, bool is_told, int width, int height,
                       hl_image **image, hl_error *error) {
  cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_ARGB32, width, height);
  cairo_t *cairo = cairo_create(surface);
  hl_status status = cairo_status(cairo) == CAIRO_STATUS_SUCCESS
                         ? HL_OK
                         : hl_fail_memory(error, 4 * (size_t)width * (size_t)height, "a figure's pixels");
  cairo_scale(cairo, width / (figure->width * points_per_millimetre),
              height / (figure->height * points_per_millimetre));
  if (status == HL_OK) status = draw_panels(context, figure, cairo, true, is_told, error);
  if (status == HL_OK) status = to_image(context, surface, image, error);
  cairo_destroy(cairo);
  cairo_surface_destroy(surface);
  return status;
}

/* ---- files of vectors ---- */

static cairo_status_t on_write(void *closure, const unsigned char *bytes, unsigned length) {
  FILE *file = closure;
  return fwrite(bytes, 1, length, file) == length ? CAIRO_STATUS_SUCCESS : CAIRO_STATUS_WRITE_ERROR;
}

hl_status hl_page_write(const hl_figure *figure, bool pdf, hl_output *output, hl_error *error) {
  const double width = figure->width * points_per_millimetre, height = figure->height * points_per_millimetre;
  cairo_surface_t *surface = pdf ? cairo_pdf_surface_create_for_stream(on_write, output->file, width, height)
                                 : cairo_svg_surface_create_for_stream(on_write, output->file, width, height);
  if (pdf) {
    cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATOR, "Halflight");
    /* the file gets no time of creation, so that a figure has the same bytes whenever it is made */
    cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATE_DATE, "");
  }
  cairo_t *cairo = cairo_create(surface);
  hl_status status = draw_panels(output->context, figure, cairo, false, true, error);
  cairo_destroy(cairo);
  errno = 0;
  cairo_surface_finish(surface);
  cairo_status_t finished = cairo_surface_status(surface);
  cairo_surface_destroy(surface);
  if (status == HL_OK && finished == CAIRO_STATUS_WRITE_ERROR) return hl_fail_write(error, output, errno);
  if (status == HL_OK && finished != CAIRO_STATUS_SUCCESS)
    status = hl_fail(error, HL_ERROR_INTERNAL, "%s: cannot write: cairo says: %s", output->path,
                     cairo_status_to_string(finished));
  return status;
}

const char *hl_page_missing(void) { return NULL; }
