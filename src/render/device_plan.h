/* render/device_plan.h - describes a sweep of a plan for a device by numbers of 32 bits (gpu/device_sweep.h).
 */
#ifndef HL_RENDER_DEVICE_PLAN_H
#define HL_RENDER_DEVICE_PLAN_H

#include "gpu/gpu.h"
#include "plan/frame_plan.h"
#include "render/device_cascade.h"
#include "render/device_paper.h"
#include "render/device_sublights.h"
#include "render/device_textures.h"
#include "render/device_volume.h"
#include "render/sweep_constants.h"

/* A sweep for a device. */
typedef struct planned_sweep {
  sweep_constants constants;
  void *memory; /* owned; the block of memory with the arrays of the constants */
  device_sweep plan;
  plan_volume volumes[PLAN_VOLUMES];
  plan_bounds *bounds; /* owned */
  gpu_sweep sweep;
  plan_rays *rays; /* owned */
  plan_cut *cuts;  /* owned; null if no volume has cuts */
  device_cascades cascades;
  known_passes passes;
  device_sublights sublights;
  device_textures textures;
} planned_sweep;

/* Describes a sweep of a plan by the numbers that a device reads. shown_from: the first visible slab of each
 * block, as in a sweep's target; borrowed. planned: release it after a failure, too. Its address must not
 * change, because its members point to each other. */
hl_status hl_plan_sweep(const sweep_means *means, const frame_plan *frame_plan, const sweep_plan *plan,
                        const int32_t *shown_from, planned_sweep *planned, hl_error *error);
void hl_plan_release(hl_context *context, planned_sweep *planned);

#endif
