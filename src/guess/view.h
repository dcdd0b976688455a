/* guess/view.h - which way is up, and from which side a scene is looked at. */
#ifndef HL_GUESS_VIEW_H
#define HL_GUESS_VIEW_H

#include "core/vector.h"
#include "guess/analysis.h"
#include "scene/scene.h"

/* Turns the view to the one of the three-quarter views (azimuths 30 and 60 from each of the four axes) that
 * is widest, so that a turn needs little more room. Fails for lack of memory alone. */
hl_status hl_view_widen(const hl_scene_description *description, hl_view *view, hl_error *error);

/* The view that a scene without a camera gets. analysis: of its first volume, or null: it is made where it is
 * needed. */
hl_status hl_view_automatic(const hl_scene_description *description, const hl_data_analysis *analysis,
                            hl_view *view, hl_error *error);

/* ---- which way up a volume is, where its file cannot say. */

/* Up: an axis of the world, or its opposite. And the three-quarter view: which azimuth shows most. */
typedef struct hl_upright {
  vec3 up;
  double azimuth_deg;
} hl_upright;

/* Of a volume whose file has no anatomy. Axes that are not the grid's own are believed: z is up. Smoke comes
 * from computer graphics, where y is up. Scanned things stand on, or are cut off by, their bottom; heads and
 * vessels are mirrored left to right, never top to bottom. Else z is up. Of the four three-quarter views the
 * one is taken whose sides have the most relief, so that heads show their faces. Fails for lack of memory and
 * when cancelled. */
hl_status hl_scene_upright(const hl_scene_volume *volume, const hl_data_analysis *analysis,
                           hl_upright *upright, hl_error *error);

#endif
