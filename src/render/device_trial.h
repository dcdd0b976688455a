/* render/device_trial.h - a device's trial before its first frame: its arithmetic, and a small picture. */
#ifndef HL_RENDER_DEVICE_TRIAL_H
#define HL_RENDER_DEVICE_TRIAL_H

#include "render/renderer_state.h"

/* Whether the renderer's device gives the processors' bytes. faster: and whether it is faster than they are.
 * problem: [GPU_PROBLEM_BYTES]; why not. */
bool hl_device_passes(hl_renderer *renderer, bool faster, char *problem);

#endif
