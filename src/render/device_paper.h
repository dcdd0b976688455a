/* render/device_paper.h - makes the paper's soft shadows on a device: finds the sheets at which the buffers
 * of lights are convolved, and the passes that convolve them (gpu/kernels/paper.h). */
#ifndef HL_RENDER_DEVICE_PAPER_H
#define HL_RENDER_DEVICE_PAPER_H

#include "render/device_passes.h"

/* Returns whether a light's buffer is convolved. */
bool hl_is_convolved(const light_shadow *shadow);

/* Finds the convolutions of a sweep, and describes them in `sweep`. planned: the sweep's numbers, which have
 * the lights' buffers; the function sets the places of the planes between the two directions of
 * convolutions. passes: must be zeros before; release them after a failure, too; their address must not
 * change. */
hl_status hl_device_paper_begin(hl_context *context, const sweep_plan *plan, device_sweep *planned,
                                known_passes *passes, gpu_sweep *sweep, hl_error *error);

#endif
