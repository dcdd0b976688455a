/* halflight/device.h - the devices that can make pictures besides the processors: GPUs, by CUDA or OpenCL.
 *
 * A context names the device for its renderers (`device` of hl_context_options). */
#ifndef HALFLIGHT_DEVICE_H
#define HALFLIGHT_DEVICE_H

#include "context.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct hl_device {
  char name[128];          /* "NVIDIA H100 80GB HBM3" */
  char interface_name[16]; /* "cuda", "opencl" */
  char version[128];       /* the versions of the driver and of the compiler */
  uint64_t memory_bytes;
  int processor; /* non-zero: the device computes on the machine's processors; "gpu" and "auto" never
                  * choose it */
} hl_device;

/* Finds the machine's devices: loads libcuda.so.1 and nvrtc, and libOpenCL.so.1, if the machine has them.
 * devices: room for `most` of them; *count: the number of devices of the machine, which may be greater than
 * `most`. missing: [missing_bytes]; one line that says which libraries were not found, empty if all were; may
 * be null. */
HL_API HL_WARN_UNUSED hl_status hl_devices_find(hl_context *context, hl_device *devices, size_t most,
                                                size_t *count, char *missing, size_t missing_bytes,
                                                hl_error *error);

#ifdef __cplusplus
}
#endif
#endif
