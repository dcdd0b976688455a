/* gpu/driver.h - what a back end needs of a system's GPU interface: CUDA (cuda_driver.c) or OpenCL
 * (opencl_driver.c), loaded when a device is asked for.
 *
 * Functions that can fail return false and leave a line in the device's `problem`. */
#ifndef HL_GPU_DRIVER_H
#define HL_GPU_DRIVER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { GPU_GROUP = 64 }; /* GROUP of gpu/kernels/dialect.h */

enum { GPU_NAME_BYTES = 128, GPU_PROBLEM_BYTES = 400 };

/* A device that a driver offers. */
typedef struct gpu_device_info {
  char name[GPU_NAME_BYTES];    /* "NVIDIA H100 80GB HBM3" */
  char version[GPU_NAME_BYTES]; /* of the driver and the compiler */
  uint64_t memory_bytes;
  bool processor; /* it computes on the machine's own processors (PoCL) */
} gpu_device_info;

typedef struct gpu_driver gpu_driver;

/* An open device. One thread at a time uses it. */
typedef struct gpu_device {
  const gpu_driver *driver;
  gpu_device_info info;
  void *state; /* owned; the driver's */
  char problem[GPU_PROBLEM_BYTES];
} gpu_device;

/* Memory of a device. */
typedef struct gpu_buffer {
  uint64_t handle; /* 0: none */
  size_t bytes;
} gpu_buffer;

/* A compiled program. binary: what the driver loads next time in place of the text. */
typedef struct gpu_program {
  void *module;
  void *kernels[8]; /* in the order of the names */
} gpu_program;

/* The bytes of a compiled program; released with free(). */
typedef struct gpu_binary {
  void *bytes;
  size_t size;
} gpu_binary;

/* An argument of a kernel: a buffer, or a value of four bytes. */
typedef struct gpu_argument {
  const gpu_buffer *buffer; /* null: a value */
  uint32_t value;
} gpu_argument;

struct gpu_driver {
  const char *name; /* "cuda", "opencl" */
  /* Loads the system's library once. False where there is none. */
  bool (*load)(void **library, char *problem);
  void (*unload)(void *library);
  /* How many devices there are. */
  int (*count)(void *library);
  bool (*describe)(void *library, int index, gpu_device_info *info);
  /* library: borrowed while the device is open. */
  bool (*open)(void *library, int index, gpu_device *device);
  void (*close)(gpu_device *device);
  /* defines: "NAME=VALUE", [define_count]. names: of kernels, [kernel_count]. */
  bool (*compile)(gpu_device *device, const char *text, const char *const *defines, int define_count,
                  gpu_binary *binary);
  bool (*load_program)(gpu_device *device, const gpu_binary *binary, const char *const *names,
                       int kernel_count, gpu_program *program);
  void (*release_program)(gpu_device *device, gpu_program *program);
  bool (*allocate)(gpu_device *device, size_t bytes, gpu_buffer *buffer);
  void (*release)(gpu_device *device, gpu_buffer *buffer);
  /* The copy may run on after the return, from a copy of `from` that the driver made. */
  bool (*upload)(gpu_device *device, const gpu_buffer *buffer, size_t offset, const void *from, size_t bytes);
  /* Waits for all work before. */
  bool (*download)(gpu_device *device, const gpu_buffer *buffer, size_t offset, void *to, size_t bytes);
  /* Launches of one line run one after the other; those of the two lines may run at the same time. Copies are
   * of line 0. groups: of GPU_GROUP members. */
  bool (*launch)(gpu_device *device, const gpu_program *program, int kernel, int line, uint32_t groups,
                 const gpu_argument *arguments, int argument_count);
  /* What is launched in a line from now on begins when all that was launched in the other has ended. */
  bool (*follow)(gpu_device *device, int line, int other);
  bool (*finish)(gpu_device *device);
  /* Marks a moment between launches; after finish(), the milliseconds between moments 0 and 1. */
  bool (*mark)(gpu_device *device, int moment);
  double (*milliseconds)(gpu_device *device);
};

extern const gpu_driver hl_cuda_driver, hl_opencl_driver;

/* Opens the first of some shared libraries that is there. names: ends with null. */
void *hl_load_library(const char *const *names, char *problem);

#endif
