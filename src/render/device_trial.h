/* render/device_trial.h - the test of a device before its first frame: of its arithmetic, and of a small
 * picture. */
#ifndef HL_RENDER_DEVICE_TRIAL_H
#define HL_RENDER_DEVICE_TRIAL_H

#include "render/renderer_state.h"

/* Whether the renderer's device gives the same bytes as the processors. faster: the device must also be
 * faster than the processors. problem: [GPU_PROBLEM_BYTES]; says why the device fails the test. */
bool hl_device_passes(hl_renderer *renderer, bool faster, char *problem);

#endif
