/* figure/overlay.h - what is drawn over one picture: its parts. */
#ifndef HL_FIGURE_OVERLAY_H
#define HL_FIGURE_OVERLAY_H

#include "core/error.h"
#include "figure/ink.h"
#include "figure/map.h"

/* One panel as its overlay is drawn. */
typedef struct hl_overlay_place {
  const hl_overlay *overlay;
  const hl_scene_description *scene; /* null: none */
  hl_rectangle picture;              /* points */
  double margin;                     /* from its edges, points */
  hl_map map;                        /* of `scene` */
} hl_overlay_place;

/* Draws all of it. scene: may be null. */
hl_status hl_overlay_draw(const hl_ink *ink, const hl_overlay *overlay, const hl_scene *scene,
                          hl_rectangle picture, hl_error *error);

/* Its parts; each is drawn where the overlay has it. */
hl_status hl_overlay_bar(const hl_ink *ink, const hl_overlay_place *place, hl_error *error);
hl_status hl_overlay_legend(const hl_ink *ink, const hl_overlay_place *place, hl_error *error);
hl_status hl_overlay_axes(const hl_ink *ink, const hl_overlay_place *place, hl_error *error);

#endif
