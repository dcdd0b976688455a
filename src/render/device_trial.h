/* render/device_trial.h - a device's trial before its first frame: its arithmetic, and a small picture. */
#ifndef HL_RENDER_DEVICE_TRIAL_H
#define HL_RENDER_DEVICE_TRIAL_H

#include "render/renderer_state.h"

/* Whether the renderer's device gives the processors' bytes. faster: the device must be faster than the
 * processors, too. problem: [GPU_PROBLEM_BYTES]; says why the device does not pass. */
bool hl_device_passes(hl_renderer *renderer, bool faster, char *problem);

#endif
