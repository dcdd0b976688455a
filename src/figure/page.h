/* figure/page.h - draws a figure on a surface of cairo: pixels, PDF or SVG. */
#ifndef HL_FIGURE_PAGE_H
#define HL_FIGURE_PAGE_H

#include <halflight/figure.h>
#include <stdbool.h>

#include "core/file.h"

#define MILLIMETRES_PER_INCH 25.4
#define POINTS_PER_INCH      72.0

/* Draws a figure as width x height pixels. is_told: whether the context's log is told which parts of overlays
 * find no room. *image is owned by the caller. */
hl_status hl_page_draw(hl_context *context, const hl_figure *figure, bool is_told, int width, int height,
                       hl_image **image, hl_error *error);

/* Writes a figure as PDF, or as SVG, to output->file. */
hl_status hl_page_write(const hl_figure *figure, bool pdf, hl_output *output, hl_error *error);

/* Finds the height of the strip below the pictures that holds the legend of a panel, in millimetres. panel:
 * a panel whose legend has the corner HL_CORNER_BELOW. */
hl_status hl_page_measure_strip(const hl_figure *figure, const hl_figure_panel *panel, double *height,
                                hl_error *error);

/* Finds whether the legend of a panel covers matter that the picture shows, at any place that the legend may
 * have. */
hl_status hl_page_judge_legend(hl_context *context, const hl_figure *figure, size_t index, bool *covers,
                               hl_error *error);

/* Returns the first panel that has its legend below all pictures; null if no panel has such a legend. */
const hl_figure_panel *hl_panel_of_strip(const hl_figure *figure);

/* The names of the drawing libraries that the build lacks, such as "cairo and pango"; null if the build lacks
 * none. */
const char *hl_page_missing(void);

#endif
