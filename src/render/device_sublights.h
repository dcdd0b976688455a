/* render/device_sublights.h - prepares the sub-lights of a sweep for a device. */
#ifndef HL_RENDER_DEVICE_SUBLIGHTS_H
#define HL_RENDER_DEVICE_SUBLIGHTS_H

#include "render/device_passes.h"
#include "shadow_sublights/sublights.h"

/* What a device reads of the sub-lights of all lights of a sweep; the arrays are owned. */
typedef struct device_sublights {
  plan_sublight *list;         /* [count] */
  plan_sublight_place *places; /* [sheets][count] */
  plan_sublight_maps *maps;    /* [runs][count] */
} device_sublights;

/* Returns whether sub-lights make a light's shadows. */
bool hl_has_sublights(const light_shadow *shadow);

/* Returns whether a light's sub-lights are weighed by the image that the light shows on its surface. */
bool hl_weigh_sublights(const light_shadow *shadow);

/* The number of bytes of a light's sub-lights at one sheet. planes: the number of planes of a sheet. */
size_t hl_device_sublight_bytes(const light_shadow *shadow, size_t planes);

/* Describes the sub-lights of a sweep, and the passes that attenuate their buffers. plan: its lights get the
 * members of sub-lights. rays: the rays of the plan, whose member `chunk` is set for lights with sub-lights
 * to the number of the run of slabs. */
hl_status hl_device_sublights_begin(hl_context *context, const sweep_plan *of, device_sweep *plan,
                                    plan_rays *rays, device_sublights *sublights, known_passes *passes,
                                    gpu_sweep *sweep, hl_error *error);
void hl_device_sublights_release(hl_context *context, device_sublights *sublights);

#endif
