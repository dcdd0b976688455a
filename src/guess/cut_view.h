/* guess/cut_view.h - turns a view so that it shows the faces that cuts leave. */
#ifndef HL_GUESS_CUT_VIEW_H
#define HL_GUESS_CUT_VIEW_H

#include <halflight/scene.h>

/* Turns a view of a volume towards the faces that its clip box and its last `count` cuts leave. The view's
 * azimuth is an angle beside one of the four axes. Of the four azimuths with this angle, the function chooses
 * the azimuth at which the eye and the key light see the faces least obliquely. If the faces look up or down,
 * the eye goes at least 35 degrees up or down. */
void hl_view_turn_to_cuts(const hl_scene_volume *volume, size_t count, hl_view *view);

#endif
