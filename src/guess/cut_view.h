/* guess/cut_view.h - turns a view so that it shows the faces that cuts leave. */
#ifndef HL_GUESS_CUT_VIEW_H
#define HL_GUESS_CUT_VIEW_H

#include <halflight/scene.h>

/* Turns a view of a volume towards the faces that its clip box and its last `count` cuts leave. The view goes
 * to the azimuth, among those that stand by its own angle beside one of the four axes, and to the elevation,
 * its own or 35 degrees up or down, from which the faces are seen least obliquely. It stays where no other
 * one shows more of the faces. */
void hl_view_turn_to_cuts(const hl_scene_volume *volume, size_t count, hl_view *view);

#endif
