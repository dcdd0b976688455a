/* render/plan_frame.h - a sweep as plain data for a device (gpu/frame_plan.h), and which frames a device can
 * make. */
#ifndef HL_RENDER_PLAN_FRAME_H
#define HL_RENDER_PLAN_FRAME_H

#include "gpu/gpu.h"
#include "render/frame_work.h"
#include "render/sweep.h"

/* Why a device does not make a frame, whose work is set up: a part of a sentence, "its meshes are not there
 * yet". Null: it does. */
const char *hl_reason_for_processors(const hl_renderer *renderer, const frame_request *request,
                                     const frame_work *work);

/* The volume that the frame shows. */
gpu_volume hl_volume_for_device(const prepared_volume *prepared);

/* A planned sweep. */
typedef struct planned_sweep {
  frame_plan plan;
  gpu_sweep sweep;
  plan_rays *rays; /* owned */
} planned_sweep;

/* sweep: after hl_sweep_describe(). planned: release it after a failure, too; it must not move. */
hl_status hl_plan_sweep(const sweep *sweep, planned_sweep *planned, hl_error *error);
void hl_plan_release(hl_context *context, planned_sweep *planned);

#endif
