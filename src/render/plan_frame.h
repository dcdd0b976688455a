/* render/plan_frame.h - makes the plan of a frame, from a scene in frame space and from what the renderer
 * keeps. */
#ifndef HL_RENDER_PLAN_FRAME_H
#define HL_RENDER_PLAN_FRAME_H

#include "plan/frame_plan.h"
#include "render/renderer_state.h"

/* Makes the plan of a frame whose volumes and isosurfaces are prepared. Brings up to date the other things
 * that the renderer keeps: surfaces, scattered light, the sky, phase tables. plan: must be zeros; borrows
 * from `framed` and the renderer until the frame ends; must be released after an error, too. */
hl_status hl_plan_frame(hl_renderer *renderer, const framed_scene *framed, const frame_request *request,
                        frame_plan *plan, hl_error *error);

#endif
