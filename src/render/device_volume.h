/* render/device_volume.h - describes the volume of a frame for a device: the arrays that are copied to the
 * device, and the volume's numbers of 32 bits (gpu/device_sweep.h). */
#ifndef HL_RENDER_DEVICE_VOLUME_H
#define HL_RENDER_DEVICE_VOLUME_H

#include "gpu/gpu.h"
#include "plan/frame_plan.h"
#include "render/slab.h"

/* The volume that the frame shows. */
gpu_volume hl_volume_for_device(const frame_plan *plan);

/* The type of a grid's voxels on a device (`storage` of plan_variant). */
int hl_device_storage(const grid *grid);

/* Describes the volume's matter and material. */
void hl_device_volume_describe(const frame_plan *plan, const shade_volume *shade, plan_volume *volume);

#endif
