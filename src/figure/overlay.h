/* figure/overlay.h - draws the parts of the overlay over one picture. */
#ifndef HL_FIGURE_OVERLAY_H
#define HL_FIGURE_OVERLAY_H

#include "core/error.h"
#include "figure/ink.h"
#include "figure/map.h"

enum { HL_MOST_TAKEN = 128 };

/* The picture over which an overlay is drawn, and its place on the page. */
typedef struct hl_overlay_place {
  const hl_overlay *overlay;
  const hl_scene_description *scene; /* the scene that the picture shows; null if it is not known */
  hl_rectangle picture;              /* the rectangle of the picture on the page, points */
  double margin;                     /* the distance of the overlay from the picture's edges, points */
  hl_map map;                        /* the map from points of `scene` to places on the page */
  hl_rectangle taken[HL_MOST_TAKEN]; /* [taken_count]; rectangles on the page that texts keep clear of:
                                      * insets, and parts of the overlay whose places are already known */
  size_t taken_count;
} hl_overlay_place;

/* Draws the whole overlay over a picture. scene: may be null. image: the picture. If it shows matter behind
 * the bar, the legend or the arrows, a ground is drawn between the matter and the part. If image is null, no
 * ground is drawn. insets: [inset_count]; rectangles on the page that will lie over the picture. The parts of
 * the overlay that have corners move sideways to where no inset covers them. */
hl_status hl_overlay_draw(const hl_ink *ink, const hl_overlay *overlay, const hl_scene *scene,
                          const hl_image *image, hl_rectangle picture, const hl_rectangle *insets,
                          size_t inset_count, hl_error *error);

/* Returns whether two rectangles overlap. */
bool hl_rectangles_meet(hl_rectangle a, hl_rectangle b);
/* Returns whether a rectangle lies within the picture and overlaps no taken rectangle. */
bool hl_overlay_is_free(const hl_overlay_place *place, hl_rectangle box);
/* Adds a rectangle to the taken rectangles. */
void hl_overlay_take(hl_overlay_place *place, hl_rectangle box);

/* The height, from the picture's lower margin, that the arrows of the axes take; points. */
double hl_overlay_arrows_height(const hl_ink *ink);

/* Functions that each draw one part of the overlay, if the overlay has this part. */
hl_status hl_overlay_bar(const hl_ink *ink, const hl_overlay_place *place, hl_error *error);
hl_status hl_overlay_legend(const hl_ink *ink, const hl_overlay_place *place, hl_error *error);
hl_status hl_overlay_axes(const hl_ink *ink, const hl_overlay_place *place, hl_error *error);
/* The texts of marks keep clear of the rectangles that are taken, and of each other. */
hl_status hl_overlay_marks(const hl_ink *ink, const hl_overlay_place *place, hl_error *error);

#endif
