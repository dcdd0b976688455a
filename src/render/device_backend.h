/* render/device_backend.h - the device that makes a renderer's frames: its choice and its end. */
#ifndef HL_RENDER_DEVICE_BACKEND_H
#define HL_RENDER_DEVICE_BACKEND_H

#include "render/backend.h"

/* Chooses the device that makes the renderer's frames from now on. Null: the device that the context names.
 * False where the name is too long. */
bool hl_device_choose(hl_renderer *renderer, const char *device);

/* Makes the device release its copy of the volume after the renderer has released the volume. */
void hl_device_forget(hl_renderer *renderer);
void hl_device_release(hl_renderer *renderer);

#endif
