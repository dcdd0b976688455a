/* render/device_reasons.h - which frames a device does not make. */
#ifndef HL_RENDER_DEVICE_REASONS_H
#define HL_RENDER_DEVICE_REASONS_H

#include "plan/frame_plan.h"

/* The reason why a device does not make a frame, as a part of a sentence: "meshes or isosurfaces". Null: a
 * device can make the frame. */
const char *hl_reason_for_processors(const frame_plan *plan);

#endif
