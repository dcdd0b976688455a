/* render/device_textures.h - prepares the images that the lights of a sweep project for a device. */
#ifndef HL_RENDER_DEVICE_TEXTURES_H
#define HL_RENDER_DEVICE_TEXTURES_H

#include "gpu/gpu.h"
#include "light/light_texture.h"
#include "plan/frame_plan.h"

/* What a device reads of the images of all lights of a sweep; all arrays are owned. */
typedef struct device_textures {
  light_texture *made; /* [count]; the lights' images, as the processors use them */
  plan_texture *list;  /* [count] */
  gpu_pixels *parts;   /* [count][1 + TEXTURE_LEVELS]; the parts that are used come first */
  size_t count;
} device_textures;

/* Returns whether a light of a sweep projects an image. */
bool hl_project_images(const sweep_plan *plan);

/* Makes and describes the images of a sweep's lights. textures: release it after a failure, too. */
hl_status hl_device_textures_begin(hl_context *context, const frame_plan *frame_plan, const sweep_plan *plan,
                                   device_textures *textures, gpu_sweep *sweep, hl_error *error);
void hl_device_textures_release(hl_context *context, device_textures *textures);

#endif
