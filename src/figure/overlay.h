/* figure/overlay.h - draws the parts of the overlay over one picture. */
#ifndef HL_FIGURE_OVERLAY_H
#define HL_FIGURE_OVERLAY_H

#include "core/error.h"
#include "figure/ink.h"
#include "figure/places.h"

/* The picture over which an overlay is drawn, and its place on the page. */
typedef struct hl_overlay_place {
  const hl_overlay *overlay;
  const hl_scene_description *scene; /* the scene that the picture shows; null if it is not known */
  hl_rectangle picture;              /* the rectangle of the picture on the page, points */
  double margin;                     /* the distance of the overlay from the picture's edges, points */
  hl_map map;                        /* the map from points of `scene` to places on the page */
  hl_taken taken;                    /* insets, and parts of the overlay whose places are already known */
  struct hl_legend_shape {
    double height;       /* the greatest height of the legend, points */
    double width;        /* the greatest width of its titles and rows, points, if their words allow it */
    double strip_height; /* the greatest height of a strip of colours, points */
    bool in_columns; /* whether the legend fills columns from the picture's left, each of the legend's height
                      */
  } legend;
  size_t *rows_left_out; /* takes the number of rows that the legend has no room for; may be null */
} hl_overlay_place;

typedef struct hl_legend_shape hl_legend_shape;

/* The picture and its surroundings over which hl_overlay_draw() draws an overlay. */
typedef struct hl_overlay_ground {
  hl_context *context;
  const hl_scene *scene;  /* may be null */
  const hl_image *matter; /* shows where the picture has matter. The overlay keeps clear of the matter, and
                           * parts over matter get a ground. If null, the picture has no matter */
  hl_rectangle picture;   /* the rectangle of the picture on the page, points */
  const hl_rectangle *insets; /* [inset_count]; rectangles on the page that will lie over the picture */
  size_t inset_count;
  size_t panel;        /* the panel's number, which messages name; 0 if the page has no other panel */
  bool is_told;        /* whether the context's log is told which parts find no room */
  bool *legend_covers; /* if not null, nothing is drawn, and *legend_covers is set to whether the legend has
                        * no place, has no room for all rows, or has a twentieth of its area over the
                        * picture's matter */
} hl_overlay_ground;

/* Draws the whole overlay over a picture. */
hl_status hl_overlay_draw(const hl_ink *ink, const hl_overlay *overlay, const hl_overlay_ground *ground,
                          hl_error *error);

/* Finds the least height of a strip of the page, as wide as `strip`, that holds an overlay's legend in
 * columns, and draws the legend there if `draws` is set. *height: points. */
hl_status hl_overlay_strip(const hl_ink *ink, const hl_overlay *overlay, const hl_scene *scene,
                           hl_rectangle strip, bool draws, double *height, hl_error *error);

/* Places a text beside a point on the page: to the right of it (the usual place), to the left, below or
 * above. The first place that keeps clear of other drawings is chosen; if all places are taken, the usual
 * place. apart: the distance from the point, points. */
hl_line_of_text hl_overlay_beside(const hl_ink *ink, const hl_taken *taken, hl_line_of_text text,
                                  double apart);

/* Functions that each draw one part of the overlay, if the overlay has this part, at its usual place. */
hl_status hl_overlay_bar(const hl_ink *ink, const hl_overlay_place *place, hl_error *error);
hl_status hl_overlay_legend(const hl_ink *ink, const hl_overlay_place *place, hl_error *error);
hl_status hl_overlay_axes(const hl_ink *ink, const hl_overlay_place *place, hl_error *error);
/* The texts of marks keep clear of the rectangles that are taken, and of each other. */
hl_status hl_overlay_marks(const hl_ink *ink, const hl_overlay_place *place, hl_error *error);

#endif
