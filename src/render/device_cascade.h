/* render/device_cascade.h - makes soft shadows on a device: finds the chunks of soft lights, and records the
 * passes that bring the lights' buffers from chunk to chunk. */
#ifndef HL_RENDER_DEVICE_CASCADE_H
#define HL_RENDER_DEVICE_CASCADE_H

#include "gpu/gpu.h"
#include "render/sweep.h"
#include "shadow_cascade/cascade.h"

/* A soft light of a sweep. */
typedef struct device_soft_light {
  int light;           /* the index, among the sweep's lights, of the light that casts these shadows */
  light_shadow shadow; /* a copy of the planned shadow; it owns `state` */
  void *passing;       /* owned; the method's memory that lasts until the sweep ends */
  occupancy occupancy; /* the occupancy of the light's view */
  cascade_slab *slabs; /* owned; [sheets] */
  size_t first_pixel;  /* the places of the light's levels among the pixels of all fields */
} device_soft_light;

/* Passes that are recorded for a device. The arrays are owned, and grow when they are full. */
typedef struct device_passes {
  plan_pass *list;
  plan_blur *boxes;
  unsigned char *marks;
  size_t count, capacity, box_count, box_capacity, mark_count, mark_capacity;
  bool failed; /* whether memory was short, or the device failed */
} device_passes;

typedef struct device_cascades {
  hl_context *context;
  device_soft_light *lights; /* owned; [count] */
  int count;
  unsigned char *ends; /* owned; [sheets] */
  device_passes passes;
} device_cascades;

/* Returns whether a light's shadows are made in chunks. */
bool hl_is_chunked(const light_shadow *shadow);

/* Prepares the soft lights of a sweep, and describes them in `sweep`. The member `plan` of the sweep must
 * have the lights. rays: the rays of the plan, whose members for soft lights are set. cascades: must be zeros
 * before; release it after a failure, too; its address must not change. */
hl_status hl_device_cascades_begin(const sweep_means *means, const frame_plan *frame_plan,
                                   const sweep_plan *plan, plan_rays *rays, device_cascades *cascades,
                                   gpu_sweep *sweep, hl_error *error);
void hl_device_cascades_release(device_cascades *cascades);

#endif
