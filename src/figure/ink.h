/* figure/ink.h - draws texts, lines and fills over a picture. Each has a halo, so that it can be seen on a
 * ground of any colour. */
#ifndef HL_FIGURE_INK_H
#define HL_FIGURE_INK_H

#include <pango/pangocairo.h>
#include <stdbool.h>

#include "figure/map.h"

typedef struct hl_ink {
  cairo_t *cairo;     /* borrowed; the surface on which everything is drawn; its unit of length is the
                       * point */
  double size;        /* size of letters, points */
  const char *font;   /* the name of the font; borrowed */
  double color, halo; /* greys of the ink and of its halo, sRGB: 0 is black, 1 is white */
} hl_ink;

/* A text to draw. */
typedef struct hl_line_of_text {
  const char *text;
  double x, y;             /* the text's position on the page, points */
  double align_x, align_y; /* the part of the text that lies at (x, y): 0 for its left or top edge, 1 for its
                            * right or bottom edge, and a number between for a place between the edges */
  double scale;            /* a factor on the size of letters; 0 counts as 1 */
  double gap;              /* added between letters, in units of their size; default 0 */
  bool bold;
  bool paragraphs; /* whether a line break begins a new line; if not, a line break is drawn as a character */
  /* the greatest width of a line, points; a longer line is cut and ends in "..."; 0 if lines may have any
   * width */
  double wide_most;
  int lines_most; /* if above 1, a text that is wider than wide_most is broken between words into lines, at
                   * most this number of them, before it is cut */
} hl_line_of_text;

void hl_ink_text(const hl_ink *ink, const hl_line_of_text *line);
/* The rectangle on the page that a text takes. */
hl_rectangle hl_ink_box(const hl_ink *ink, const hl_line_of_text *line);
/* The width and height that a text takes, points. */
void hl_ink_measure(const hl_ink *ink, const hl_line_of_text *line, double *width, double *height);

/* Fills a rectangle with the ink. */
void hl_ink_bar(const hl_ink *ink, hl_rectangle bar);

/* Draws a line along the current path, with a halo. width: points. */
void hl_ink_stroke(const hl_ink *ink, double width);

/* Sets a colour, linear RGB, as cairo's source. */
void hl_ink_source(cairo_t *cairo, const double linear[3], double alpha);

#endif
