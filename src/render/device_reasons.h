/* render/device_reasons.h - finds the reason why a device cannot make a frame. */
#ifndef HL_RENDER_DEVICE_REASONS_H
#define HL_RENDER_DEVICE_REASONS_H

#include "plan/frame_plan.h"

/* Returns the reason why a device cannot make a frame, as a part of a sentence, such as "meshes or
 * isosurfaces". Returns null if a device can make the frame. */
const char *hl_reason_for_processors(const frame_plan *plan);

#endif
