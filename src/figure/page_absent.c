/* figure/page_absent.c - refuses to draw figures. Builds without cairo and pango have this file in place of
 * page.c. */
#include "figure/page.h"

static hl_status refuse(hl_error *error) {
  return hl_fail(error, HL_ERROR_UNSUPPORTED,
                 "this build draws no figures: install cairo and pango, and build with -Dfigures=enabled");
}

hl_status hl_page_draw(hl_context *context, const hl_figure *figure, bool is_told, int width, int height,
                       hl_image **image, hl_error *error) {
  (void)context, (void)figure, (void)is_told, (void)width, (void)height, (void)image;
  return refuse(error);
}

hl_status hl_page_write(const hl_figure *figure, bool pdf, hl_output *output, hl_error *error) {
  (void)figure, (void)pdf, (void)output;
  return refuse(error);
}

hl_status hl_page_measure_strip(const hl_figure *figure, const hl_figure_panel *panel, double *height,
                                hl_error *error) {
  (void)figure, (void)panel, (void)height;
  return refuse(error);
}

hl_status hl_page_judge_legend(hl_context *context, const hl_figure *figure, size_t index, bool *covers,
                               hl_error *error) {
  (void)context, (void)figure, (void)index, (void)covers;
  return refuse(error);
}

const char *hl_page_missing(void) { return "cairo and pango"; }
