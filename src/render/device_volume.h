/* render/device_volume.h - describes the volume of a frame for a device: the arrays that are copied to the
 * device, and the volume's numbers of 32 bits (gpu/device_sweep.h). */
#ifndef HL_RENDER_DEVICE_VOLUME_H
#define HL_RENDER_DEVICE_VOLUME_H

#include "gpu/gpu.h"
#include "plan/frame_plan.h"
#include "render/slab.h"

/* Describes the volumes of a frame. volumes: [plan->volumes.count], at most PLAN_VOLUMES. */
void hl_volumes_for_device(const frame_plan *plan, gpu_volume *volumes);

/* The type of a grid's voxels on a device (`storage` of plan_variant). */
int hl_device_storage(const grid *grid);

/* Describes the matter and material of all volumes. shades, volumes: [plan->volumes.count]. */
void hl_device_volumes_describe(const frame_plan *plan, const shade_volume *shades, plan_volume *volumes);

#endif
