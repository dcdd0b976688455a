/* gpu/devices.c - lists the machine's devices (halflight/device.h). */
#include <halflight/device.h>

#include <stdio.h>

#include "core/door.h"
#include "core/error.h"
#include "gpu/gpu.h"

typedef struct device_list {
  hl_device *devices;
  size_t most, count;
} device_list;

static bool add_device(void *data, const gpu_driver *driver, void *library, int index,
                       const gpu_device_info *info) {
  (void)library;
  (void)index;
  device_list *list = data;
  if (list->count < list->most) {
    hl_device *device = &list->devices[list->count];
    *device = (hl_device){.memory_bytes = info->memory_bytes, .processor = info->processor};
    snprintf(device->name, sizeof device->name, "%s", info->name);
    snprintf(device->interface_name, sizeof device->interface_name, "%s", driver->name);
    snprintf(device->version, sizeof device->version, "%s", info->version);
  }
  list->count++;
  return true;
}

hl_status hl_devices_find(hl_context *context, hl_device *devices, size_t most, size_t *count, char *missing,
                          size_t missing_bytes, hl_error *error) {
  HL_DOOR;
  device_list list = {devices, most, 0};
  char problem[GPU_PROBLEM_BYTES];
  if (context == NULL || count == NULL || devices == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_devices_find: context, devices or count is null");
  hl_gpu_find(NULL, add_device, &list, problem);
  *count = list.count;
  if (missing != NULL && missing_bytes > 0) snprintf(missing, missing_bytes, "%s", problem);
  return HL_OK;
}
