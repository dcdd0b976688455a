/* render/device_passes.h - collects the passes over the buffers of lights that are known before a sweep. */
#ifndef HL_RENDER_DEVICE_PASSES_H
#define HL_RENDER_DEVICE_PASSES_H

#include "gpu/gpu.h"
#include "plan/frame_plan.h"

/* The passes of a sweep, in the order of its sheets. */
typedef struct known_passes {
  hl_context *context;
  gpu_passes passes;   /* the lists below */
  plan_pass *list;     /* owned; [most] */
  plan_blur *boxes;    /* owned; [most] */
  int32_t *first;      /* owned; [sheets + 1]; the first pass of each sheet */
  unsigned char *ends; /* owned; [sheets]; 1 where the buffer of some light changes as a whole */
  size_t most;
} known_passes;

/* Allocates the arrays, and describes them in `sweep`. most: the greatest number of passes. */
hl_status hl_known_passes_begin(hl_context *context, int sheets, size_t most, known_passes *passes,
                                gpu_sweep *sweep, hl_error *error);
/* Adds a pass. There must be room for it. */
void hl_known_passes_add(known_passes *passes, plan_pass pass);
/* Adds a box. Returns its number. */
unsigned hl_known_passes_add_box(known_passes *passes, plan_blur box);
void hl_known_passes_release(known_passes *passes);

#endif
