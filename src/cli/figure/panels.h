/* cli/figure/panels.h - reads the content of a FIGURE.json of `halflight figure`: a page, and the pictures on
 * it. */
#ifndef HL_CLI_FIGURE_PANELS_H
#define HL_CLI_FIGURE_PANELS_H

#include "cli/render/render.h"

enum { FIGURE_MOST_PANELS = 64, FIGURE_LEAST_DPI = 10, FIGURE_MOST_DPI = 10000 };

/* The place of an inset in another panel. */
typedef struct figure_inset {
  int of;            /* the number of the panel in which this inset lies; -1 if the panel is no inset */
  double part;       /* the inset's width divided by the width of the panel in which it lies */
  bool right, lower; /* whether the inset lies at the right and at the lower side of that panel */
  double zoom;  /* the inset shows a place of that panel this many times as large; 0: the inset has a view
                 * of its own */
  double at[2]; /* this place, at fractions of that panel from its upper left */
} figure_inset;

/* A rectangle of the page; millimetres from its top left corner. */
typedef struct figure_place {
  double left, top, width, height;
} figure_place;

/* A picture: the command line that `halflight render` would get. */
typedef struct figure_panel {
  cli_value values[RENDER_OPTION_COUNT]; /* `words` owns their texts */
  char **words;                          /* owned; [word_count]; options and inputs as a command line */
  size_t word_count;
  char *operands[MAXIMUM_OPERANDS + 1]; /* null after the last */
  char *letter;                         /* owned; null if there is none */
  double aspect;                        /* width divided by height; 0 stands for the scene's proportions */
  figure_inset inset;
  bool bare;
  char size_text[RENDER_SIZE_TEXT]; /* text of --size */
  hl_scene *scene;                  /* owned; null if the panel's input is a picture without a scene */
  hl_image *image;                  /* owned */
  cli_overlay overlay;
  figure_place place;
} figure_panel;

typedef struct figure_page {
  struct json_t *json;  /* owned; the figure as it was read; null after a failure */
  figure_panel *panels; /* owned; [count] */
  int count;
  double width, gap; /* millimetres */
  double pixels_per_inch, font_points;
  int columns;
  double background[3];
  bool transparent;
  bool share_camera, share_light, share_function; /* whether the panel shares these properties of the first
                                                   * panel */
} figure_page;

/* Reads the file, or the figure that a PNG of `halflight figure` carries. Call figure_page_release() even
 * after a failure. Returns the exit code. */
int figure_page_read(const char *path, figure_page *page);
void figure_page_release(figure_page *page);

/* The figure as JSON, with the page's pixels per inch, for a picture that carries it; owned by the caller
 * (free); null if memory is short. */
char *figure_page_text(const figure_page *page);

/* Returns whether a picture's file carries a figure. */
bool figure_is_in_picture(const char *path);

#endif
