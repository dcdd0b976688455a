/* halflight/device.h - finds the devices that can make pictures in place of the processors: GPUs, by CUDA or
 * OpenCL.
 *
 * A context names the device for its renderers (`device` of hl_context_options). */
#ifndef HALFLIGHT_DEVICE_H
#define HALFLIGHT_DEVICE_H

#include "context.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A device that can make pictures. */
typedef struct hl_device {
  char name[128];          /* the device's name, as "NVIDIA H100 80GB HBM3" */
  char interface_name[16]; /* the interface that finds the device: "cuda" or "opencl" */
  char version[128];       /* the versions of the device's driver and of its compiler */
  uint64_t memory_bytes;
  int processor; /* non-zero if the device computes on the machine's processors; "gpu" and "auto" never choose
                  * it */
} hl_device;

/* Finds the devices of the machine. For this it loads libcuda.so.1, nvrtc and libOpenCL.so.1, as far as the
 * machine has these libraries. devices: has room for `most` devices. *count: the number of devices of the
 * machine, which may be greater than `most`. missing: [missing_bytes]; receives one line that names the
 * libraries that were not found; empty if all were found; may be null. */
HL_API HL_WARN_UNUSED hl_status hl_devices_find(hl_context *context, hl_device *devices, size_t most,
                                                size_t *count, char *missing, size_t missing_bytes,
                                                hl_error *error);

#ifdef __cplusplus
}
#endif
#endif
