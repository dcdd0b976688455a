/* render/backend.h - a back end makes the picture of a plan: the processors, or a device.
 *
 * A renderer asks its back ends in the order of their list. The first back end that can prepare for a plan
 * makes the frame, sweep by sweep. If it fails, the next back end in the list makes the frame anew, from
 * pixels of zeros. */
#ifndef HL_RENDER_BACKEND_H
#define HL_RENDER_BACKEND_H

#include "plan/frame_plan.h"
#include "render/renderer_state.h"
#include "render/target.h"

typedef struct backend {
  /* Prepares for the frame of a plan. After a failure another back end makes the frame, and the error says
   * why this back end cannot. */
  hl_status (*prepare)(hl_renderer *renderer, const frame_plan *plan, const frame_target *target,
                       hl_error *error);
  /* Makes one sweep of the plan. It is called once for each sweep, in the order of the sweeps. */
  hl_status (*run)(hl_renderer *renderer, const frame_plan *plan, int sweep, frame_target *target,
                   hl_render_statistics *statistics, hl_error *error);
  /* Brings all pixels of the picture to the target after the last sweep. If null, the sweeps themselves bring
   * the pixels to the target. */
  hl_status (*read)(hl_renderer *renderer, const frame_plan *plan, frame_target *target,
                    hl_render_statistics *statistics, hl_error *error);
} backend;

/* All back ends, in the order in which a renderer asks them. A back end NAME is a file NAME_backend.c,
 * which defines hl_NAME_backend. The last back end can make every frame. */
#define HL_BACKENDS  \
  HL_BACKEND(device) \
  HL_BACKEND(processor)

#define HL_BACKEND(name) extern const backend hl_##name##_backend;
HL_BACKENDS
#undef HL_BACKEND

#endif
