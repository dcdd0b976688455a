/* render/device_frame.h - frames that a GPU makes: the choice of the device, its trial, and the frame's
 * sweeps.
 */
#ifndef HL_RENDER_DEVICE_FRAME_H
#define HL_RENDER_DEVICE_FRAME_H

#include "render/frame_work.h"
#include "render/sweep.h"

/* A sweep of the frame, to be described and planned (renderer.c). */
typedef struct sweep sweep_of_frame(hl_renderer *renderer, const hl_scene_description *scene,
                                    const frame_work *work, int index);

/* Makes the frame's sweeps on the renderer's device: work->pixels. False where the processors must make them:
 * statistics->device_reason says why, and work->pixels are zeros again. */
bool hl_make_on_device(hl_renderer *renderer, const frame_request *request, frame_work *work,
                       sweep_of_frame *sweep_of, hl_render_statistics *statistics);

/* Chooses what makes the renderer's frames from now on; null: what the context names. False where the name is
 * too long. */
bool hl_device_choose(hl_renderer *renderer, const char *device);

/* The device's volume is no longer that of renderer->prepared. */
void hl_device_forget(hl_renderer *renderer);
void hl_device_release(hl_renderer *renderer);

#endif
