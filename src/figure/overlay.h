/* figure/overlay.h - draws the parts of the overlay over one picture. */
#ifndef HL_FIGURE_OVERLAY_H
#define HL_FIGURE_OVERLAY_H

#include "core/error.h"
#include "figure/ink.h"
#include "figure/map.h"

/* The picture over which an overlay is drawn, and its place on the page. */
typedef struct hl_overlay_place {
  const hl_overlay *overlay;
  const hl_scene_description *scene; /* the scene that the picture shows; null if it is not known */
  hl_rectangle picture;              /* the rectangle of the picture on the page, points */
  double margin;                     /* the distance of the overlay from the picture's edges, points */
  hl_map map;                        /* the map from points of `scene` to places on the page */
} hl_overlay_place;

/* Draws the whole overlay over a picture. scene: may be null. image: the picture. If it shows matter behind
 * the bar, the legend or the arrows, a ground is drawn between the matter and the part. If image is null, no
 * ground is drawn. */
hl_status hl_overlay_draw(const hl_ink *ink, const hl_overlay *overlay, const hl_scene *scene,
                          const hl_image *image, hl_rectangle picture, hl_error *error);

/* The height, from the picture's lower margin, that the arrows of the axes take; points. */
double hl_overlay_arrows_height(const hl_ink *ink);

/* Functions that each draw one part of the overlay, if the overlay has this part. */
hl_status hl_overlay_bar(const hl_ink *ink, const hl_overlay_place *place, hl_error *error);
hl_status hl_overlay_legend(const hl_ink *ink, const hl_overlay_place *place, hl_error *error);
hl_status hl_overlay_axes(const hl_ink *ink, const hl_overlay_place *place, hl_error *error);
hl_status hl_overlay_marks(const hl_ink *ink, const hl_overlay_place *place, hl_error *error);

#endif
