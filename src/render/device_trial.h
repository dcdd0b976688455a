/* render/device_trial.h - tests a device before its first frame: tests its arithmetic, and compares a small
 * picture. */
#ifndef HL_RENDER_DEVICE_TRIAL_H
#define HL_RENDER_DEVICE_TRIAL_H

#include "render/renderer_state.h"

/* Returns whether the renderer's device gives the same bytes as the processors. faster: the device must also
 * be faster than the processors. problem: [GPU_PROBLEM_BYTES]; receives the reason why the device fails the
 * test. */
bool hl_device_passes(hl_renderer *renderer, bool faster, char *problem);

#endif
