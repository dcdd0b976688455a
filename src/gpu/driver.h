/* gpu/driver.h - declares the interface by which a back end uses a system's GPUs. A driver is CUDA
 * (cuda_driver.c) or OpenCL (opencl_driver.c). Its library is loaded when a device is asked for.
 *
 * A function that fails returns false, and leaves a line of text in the device's `problem`. */
#ifndef HL_GPU_DRIVER_H
#define HL_GPU_DRIVER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { GPU_GROUP = 64 }; /* the number GROUP in gpu/kernels/dialect.h */

enum { GPU_KERNELS = 12 }; /* the greatest number of kernels of a program */

enum { GPU_NAME_BYTES = 128, GPU_PROBLEM_BYTES = 400 };

/* A device that a driver offers. */
typedef struct gpu_device_info {
  char name[GPU_NAME_BYTES];    /* for example "NVIDIA H100 80GB HBM3" */
  char version[GPU_NAME_BYTES]; /* version of the driver and the compiler */
  uint64_t memory_bytes;
  bool processor; /* whether the device is the machine's own processors (PoCL) */
} gpu_device_info;

typedef struct gpu_driver gpu_driver;

/* An open device. Only one thread at a time uses it. */
typedef struct gpu_device {
  const gpu_driver *driver;
  gpu_device_info info;
  void *state; /* owned; data of the driver */
  char problem[GPU_PROBLEM_BYTES];
} gpu_device;

/* Memory of a device. */
typedef struct gpu_buffer {
  uint64_t handle; /* 0 if there is no buffer */
  size_t bytes;
} gpu_buffer;

/* A program that the driver has loaded. */
typedef struct gpu_program {
  void *module;
  void *kernels[GPU_KERNELS]; /* the kernels, in the order of the names given to load_program() */
} gpu_program;

/* The bytes of a compiled program, which the driver can load without compiling the text again; released with
 * free(). */
typedef struct gpu_binary {
  void *bytes;
  size_t size;
} gpu_binary;

/* An argument of a kernel: a buffer, or a value of four bytes. */
typedef struct gpu_argument {
  const gpu_buffer *buffer; /* null if the argument is a value */
  uint32_t value;
} gpu_argument;

struct gpu_driver {
  const char *name; /* "cuda" or "opencl" */
  /* Loads the driver's library, at the first call only. Returns false if the system has no such library. */
  bool (*load)(void **library, char *problem);
  void (*unload)(void *library);
  /* The number of devices. */
  int (*count)(void *library);
  bool (*describe)(void *library, int index, gpu_device_info *info);
  /* library: borrowed while the device is open. */
  bool (*open)(void *library, int index, gpu_device *device);
  void (*close)(gpu_device *device);
  /* Compiles the kernels. defines: [define_count], each "NAME=VALUE". */
  bool (*compile)(gpu_device *device, const char *text, const char *const *defines, int define_count,
                  gpu_binary *binary);
  /* Loads a compiled program. names: [kernel_count], the names of its kernels. */
  bool (*load_program)(gpu_device *device, const gpu_binary *binary, const char *const *names,
                       int kernel_count, gpu_program *program);
  void (*release_program)(gpu_device *device, gpu_program *program);
  bool (*allocate)(gpu_device *device, size_t bytes, gpu_buffer *buffer);
  void (*release)(gpu_device *device, gpu_buffer *buffer);
  /* Starts a copy to a buffer. The copy may still be going on when the function returns. The caller may
   * change `from` afterwards, because the driver has made a copy of it. */
  bool (*upload)(gpu_device *device, const gpu_buffer *buffer, size_t offset, const void *from, size_t bytes);
  /* Waits for all earlier work, and copies a buffer to `to`. */
  bool (*download)(gpu_device *device, const gpu_buffer *buffer, size_t offset, void *to, size_t bytes);
  /* Launches a kernel on one of two lines. Launches of one line run one after the other; launches of
   * different lines may run at the same time. Copies belong to line 0. groups: number of groups of GPU_GROUP
   * members. */
  bool (*launch)(gpu_device *device, const gpu_program *program, int kernel, int line, uint32_t groups,
                 const gpu_argument *arguments, int argument_count);
  /* Lets the next launches of a line wait until all earlier launches of the other line have ended. */
  bool (*follow)(gpu_device *device, int line, int other);
  bool (*finish)(gpu_device *device);
  /* Marks a moment between launches. finish() then finds the milliseconds between moments 0 and 1. */
  bool (*mark)(gpu_device *device, int moment);
  double (*milliseconds)(gpu_device *device);
};

extern const gpu_driver hl_cuda_driver, hl_opencl_driver;

/* Opens the first shared library of a list of names that the system has. names: ends with null. */
void *hl_load_library(const char *const *names, char *problem);

/* Makes one line of ASCII of a driver's text: other bytes become spaces. */
void hl_gpu_make_line(char *text);

#endif
