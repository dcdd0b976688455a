/* plan/plan_text.h - writes the plan of a frame as text. The text shows the decisions by which the frame is
 * made. */
#ifndef HL_PLAN_PLAN_TEXT_H
#define HL_PLAN_PLAN_TEXT_H

#include "plan/frame_plan.h"

/* Writes a plan as a JSON object, as halflight/render.h describes it (hl_renderer_plan); null-terminated;
 * free with hl_release(). */
hl_status hl_plan_text(hl_context *context, const frame_plan *plan, char **text, hl_error *error);

#endif
