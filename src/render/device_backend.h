/* render/device_backend.h - chooses and releases the device that makes a renderer's frames. */
#ifndef HL_RENDER_DEVICE_BACKEND_H
#define HL_RENDER_DEVICE_BACKEND_H

#include "render/backend.h"

/* Chooses the device that makes the renderer's frames from now on. Null stands for the device that the
 * context names. Returns false if the name is too long. */
bool hl_device_choose(hl_renderer *renderer, const char *device);

/* Lets the device release its copy of the volume. Call it after the renderer has released the volume. */
void hl_device_forget(hl_renderer *renderer);
void hl_device_release(hl_renderer *renderer);

#endif
