/* gpu/opencl_driver.c - uses devices by OpenCL 1.2, by its loader libOpenCL.so.1. The few types, numbers and
 * functions that are used are declared here, so that building needs no headers. */
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gpu/driver.h"

typedef void *cl_object;
typedef int32_t cl_int;
typedef uint32_t cl_uint;
typedef uint64_t cl_ulong;

enum {
  CL_DEVICE_TYPE = 0x1000,
  CL_DEVICE_SINGLE_FP_CONFIG = 0x101B,
  CL_DEVICE_GLOBAL_MEM_SIZE = 0x101F,
  CL_DEVICE_NAME = 0x102B,
  CL_DRIVER_VERSION = 0x102D,
  CL_DEVICE_VERSION = 0x102F,
  CL_DEVICE_TYPE_CPU = 2,
  CL_FP_DENORM = 1,
  CL_FP_FMA = 32,
  CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT = 128,
  CL_MEM_READ_WRITE = 1,
  CL_PROGRAM_BUILD_LOG = 0x1183,
  CL_PROGRAM_BINARY_SIZES = 0x1165,
  CL_PROGRAM_BINARIES = 0x1166,
  CL_QUEUE_PROFILING_ENABLE = 2,
  CL_PROFILING_COMMAND_START = 0x1282,
  CL_PROFILING_COMMAND_END = 0x1283,
  CL_TRUE_VALUE = 1
};
static const cl_ulong CL_DEVICE_TYPE_EVERY = 0xFFFFFFFF;

/* The functions that are used, by name. */
#define CL_FUNCTIONS                                                                                         \
  CL_FUNCTION(cl_int, clGetPlatformIDs, (cl_uint, cl_object *, cl_uint *))                                   \
  CL_FUNCTION(cl_int, clGetDeviceIDs, (cl_object, cl_ulong, cl_uint, cl_object *, cl_uint *))                \
  CL_FUNCTION(cl_int, clGetDeviceInfo, (cl_object, cl_uint, size_t, void *, size_t *))                       \
  CL_FUNCTION(cl_object, clCreateContext,                                                                    \
              (const void *, cl_uint, const cl_object *, void *, void *, cl_int *))                          \
  CL_FUNCTION(cl_int, clReleaseContext, (cl_object))                                                         \
  CL_FUNCTION(cl_object, clCreateCommandQueue, (cl_object, cl_object, cl_ulong, cl_int *))                   \
  CL_FUNCTION(cl_int, clReleaseCommandQueue, (cl_object))                                                    \
  CL_FUNCTION(cl_object, clCreateBuffer, (cl_object, cl_ulong, size_t, void *, cl_int *))                    \
  CL_FUNCTION(cl_int, clReleaseMemObject, (cl_object))                                                       \
  CL_FUNCTION(cl_object, clCreateProgramWithSource,                                                          \
              (cl_object, cl_uint, const char **, const size_t *, cl_int *))                                 \
  CL_FUNCTION(                                                                                               \
      cl_object, clCreateProgramWithBinary,                                                                  \
      (cl_object, cl_uint, const cl_object *, const size_t *, const unsigned char **, cl_int *, cl_int *))   \
  CL_FUNCTION(cl_int, clBuildProgram, (cl_object, cl_uint, const cl_object *, const char *, void *, void *)) \
  CL_FUNCTION(cl_int, clGetProgramBuildInfo, (cl_object, cl_object, cl_uint, size_t, void *, size_t *))      \
  CL_FUNCTION(cl_int, clGetProgramInfo, (cl_object, cl_uint, size_t, void *, size_t *))                      \
  CL_FUNCTION(cl_int, clReleaseProgram, (cl_object))                                                         \
  CL_FUNCTION(cl_object, clCreateKernel, (cl_object, const char *, cl_int *))                                \
  CL_FUNCTION(cl_int, clReleaseKernel, (cl_object))                                                          \
  CL_FUNCTION(cl_int, clSetKernelArg, (cl_object, cl_uint, size_t, const void *))                            \
  CL_FUNCTION(cl_int, clEnqueueNDRangeKernel,                                                                \
              (cl_object, cl_object, cl_uint, const size_t *, const size_t *, const size_t *, cl_uint,       \
               const cl_object *, cl_object *))                                                              \
  CL_FUNCTION(cl_int, clEnqueueWriteBuffer,                                                                  \
              (cl_object, cl_object, cl_uint, size_t, size_t, const void *, cl_uint, const cl_object *,      \
               cl_object *))                                                                                 \
  CL_FUNCTION(                                                                                               \
      cl_int, clEnqueueReadBuffer,                                                                           \
      (cl_object, cl_object, cl_uint, size_t, size_t, void *, cl_uint, const cl_object *, cl_object *))      \
  CL_FUNCTION(cl_int, clFinish, (cl_object))                                                                 \
  CL_FUNCTION(cl_int, clEnqueueMarkerWithWaitList, (cl_object, cl_uint, const cl_object *, cl_object *))     \
  CL_FUNCTION(cl_int, clGetEventProfilingInfo, (cl_object, cl_uint, size_t, void *, size_t *))               \
  CL_FUNCTION(cl_int, clReleaseEvent, (cl_object))

enum { MOST_DEVICES = 16 };

typedef struct opencl_library {
  void *handle;
#define CL_FUNCTION(type, name, parameters) type(*name) parameters;
  CL_FUNCTIONS
#undef CL_FUNCTION
  cl_object devices[MOST_DEVICES];
  int device_count;
} opencl_library;

typedef struct opencl_device {
  const opencl_library *api;
  cl_object device, context, queue;
  cl_object moments[2];
} opencl_device;

static bool find_functions(opencl_library *api) {
#define CL_FUNCTION(type, name, parameters)         \
  *(void **)&api->name = dlsym(api->handle, #name); \
  if (api->name == NULL) return false;
  CL_FUNCTIONS
#undef CL_FUNCTION
  return true;
}

static void find_devices(opencl_library *api) {
  cl_object platforms[MOST_DEVICES];
  cl_uint platform_count = 0;
  if (api->clGetPlatformIDs(MOST_DEVICES, platforms, &platform_count) != 0) return;
  if (platform_count > MOST_DEVICES) platform_count = MOST_DEVICES;
  for (cl_uint p = 0; p < platform_count; p++) {
    cl_uint count = 0, room = (cl_uint)(MOST_DEVICES - api->device_count);
    if (room == 0) return;
    if (api->clGetDeviceIDs(platforms[p], CL_DEVICE_TYPE_EVERY, room, api->devices + api->device_count,
                            &count) != 0)
      continue;
    api->device_count += (int)(count < room ? count : room);
  }
}

static bool load_opencl(void **library, char *problem) {
  static const char *const names[] = {"libOpenCL.so.1", NULL};
  void *handle = hl_load_library(names, problem);
  if (handle == NULL) return false;
  opencl_library *api = calloc(1, sizeof *api);
  if (api != NULL) api->handle = handle;
  if (api == NULL || !find_functions(api)) {
    snprintf(problem, GPU_PROBLEM_BYTES, "libOpenCL.so.1 has not the functions of OpenCL 1.2");
    free(api);
    dlclose(handle);
    return false;
  }
  find_devices(api);
  *library = api;
  return true;
}

/* Releases the table of functions. The library itself stays loaded, because drivers start threads that go on
 * running in the library. */
static void unload_opencl(void *library) { free(library); }

static int count_opencl(void *library) { return ((const opencl_library *)library)->device_count; }

static bool describe_opencl(void *library, int index, gpu_device_info *info) {
  const opencl_library *api = library;
  cl_object device = api->devices[index];
  char version[64] = "", driver[64] = "";
  cl_ulong type = 0, memory = 0;
  memset(info, 0, sizeof *info);
  if (api->clGetDeviceInfo(device, CL_DEVICE_NAME, sizeof info->name - 1, info->name, NULL) != 0)
    return false;
  api->clGetDeviceInfo(device, CL_DEVICE_VERSION, sizeof version - 1, version, NULL);
  api->clGetDeviceInfo(device, CL_DRIVER_VERSION, sizeof driver - 1, driver, NULL);
  api->clGetDeviceInfo(device, CL_DEVICE_TYPE, sizeof type, &type, NULL);
  api->clGetDeviceInfo(device, CL_DEVICE_GLOBAL_MEM_SIZE, sizeof memory, &memory, NULL);
  snprintf(info->version, sizeof info->version, "%s, %s", version, driver);
  info->memory_bytes = memory;
  info->processor = (type & CL_DEVICE_TYPE_CPU) != 0;
  return true;
}

static bool fails(gpu_device *device, cl_int code, const char *what) {
  if (code == 0) return false;
  if (code == -4 || code == -6)
    snprintf(device->problem, sizeof device->problem, "%s has no memory left", device->info.name);
  else
    snprintf(device->problem, sizeof device->problem, "%s: %s failed with OpenCL's error %d",
             device->info.name, what, (int)code);
  return true;
}

static void close_opencl(gpu_device *device) {
  opencl_device *state = device->state;
  if (state == NULL) return;
  for (int i = 0; i < 2; i++)
    if (state->moments[i] != NULL) state->api->clReleaseEvent(state->moments[i]);
  if (state->queue != NULL) state->api->clReleaseCommandQueue(state->queue);
  if (state->context != NULL) state->api->clReleaseContext(state->context);
  free(state);
  device->state = NULL;
}

static bool open_opencl(void *library, int index, gpu_device *device) {
  opencl_library *api = library;
  opencl_device *state = calloc(1, sizeof *state);
  cl_ulong abilities = 0;
  cl_int code = 0;
  device->state = state;
  if (state == NULL) return snprintf(device->problem, sizeof device->problem, "no memory is left"), false;
  state->api = api;
  state->device = api->devices[index];
  const cl_ulong needed = CL_FP_DENORM | CL_FP_FMA | CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT;
  api->clGetDeviceInfo(state->device, CL_DEVICE_SINGLE_FP_CONFIG, sizeof abilities, &abilities, NULL);
  if ((abilities & needed) != needed) {
    snprintf(device->problem, sizeof device->problem,
             "%s does not round divisions and roots of floats, or has no fused products and no subnormal "
             "floats: its pictures would differ",
             device->info.name);
    close_opencl(device);
    return false;
  }
  state->context = api->clCreateContext(NULL, 1, &state->device, NULL, NULL, &code);
  if (!fails(device, code, "opening")) {
    state->queue = api->clCreateCommandQueue(state->context, state->device, CL_QUEUE_PROFILING_ENABLE, &code);
    if (!fails(device, code, "opening")) return true;
  }
  close_opencl(device);
  return false;
}

static bool keep_binary(gpu_device *device, cl_object program, gpu_binary *binary) {
  const opencl_library *api = ((opencl_device *)device->state)->api;
  size_t size = 0;
  if (fails(device, api->clGetProgramInfo(program, CL_PROGRAM_BINARY_SIZES, sizeof size, &size, NULL),
            "compiling"))
    return false;
  unsigned char *bytes = malloc(size > 0 ? size : 1);
  if (bytes == NULL) return snprintf(device->problem, sizeof device->problem, "no memory is left"), false;
  if (fails(device, api->clGetProgramInfo(program, CL_PROGRAM_BINARIES, sizeof bytes, &bytes, NULL),
            "compiling")) {
    free(bytes);
    return false;
  }
  *binary = (gpu_binary){bytes, size};
  return true;
}

static bool compile_opencl(gpu_device *device, const char *text, const char *const *defines, int define_count,
                           gpu_binary *binary) {
  const opencl_device *state = device->state;
  const opencl_library *api = state->api;
  char options[1000] = "-cl-std=CL1.2 -cl-fp32-correctly-rounded-divide-sqrt";
  for (int i = 0; i < define_count; i++) {
    size_t used = strlen(options);
    snprintf(options + used, sizeof options - used, " -D%s", defines[i]);
  }
  cl_int code;
  cl_object program = api->clCreateProgramWithSource(state->context, 1, &text, NULL, &code);
  if (fails(device, code, "compiling")) return false;
  code = api->clBuildProgram(program, 1, &state->device, options, NULL, NULL);
  if (code != 0) {
    char log[300] = "";
    api->clGetProgramBuildInfo(program, state->device, CL_PROGRAM_BUILD_LOG, sizeof log - 1, log, NULL);
    hl_gpu_make_line(log);
    snprintf(device->problem, sizeof device->problem, "%.60s does not compile the kernels: %.250s",
             device->info.name, log);
  }
  bool compiled = code == 0 && keep_binary(device, program, binary);
  api->clReleaseProgram(program);
  return compiled;
}

static void release_opencl_program(gpu_device *device, gpu_program *program) {
  const opencl_library *api = ((opencl_device *)device->state)->api;
  for (size_t i = 0; i < sizeof program->kernels / sizeof *program->kernels; i++)
    if (program->kernels[i] != NULL) api->clReleaseKernel(program->kernels[i]);
  if (program->module != NULL) api->clReleaseProgram(program->module);
  memset(program, 0, sizeof *program);
}

static bool load_opencl_program(gpu_device *device, const gpu_binary *binary, const char *const *names,
                                int kernel_count, gpu_program *program) {
  const opencl_device *state = device->state;
  const opencl_library *api = state->api;
  const unsigned char *bytes = binary->bytes;
  cl_int code, of_binary;
  memset(program, 0, sizeof *program);
  program->module = api->clCreateProgramWithBinary(state->context, 1, &state->device, &binary->size, &bytes,
                                                   &of_binary, &code);
  bool failed = fails(device, code, "loading the kernels") ||
                fails(device, api->clBuildProgram(program->module, 1, &state->device, "", NULL, NULL),
                      "loading the kernels");
  for (int i = 0; i < kernel_count && !failed; i++) {
    program->kernels[i] = api->clCreateKernel(program->module, names[i], &code);
    failed = fails(device, code, "loading the kernels");
  }
  if (failed) release_opencl_program(device, program);
  return !failed;
}

static bool allocate_opencl(gpu_device *device, size_t bytes, gpu_buffer *buffer) {
  const opencl_device *state = device->state;
  cl_int code;
  cl_object memory = state->api->clCreateBuffer(state->context, CL_MEM_READ_WRITE, bytes, NULL, &code);
  *buffer = (gpu_buffer){(uint64_t)(uintptr_t)memory, bytes};
  return !fails(device, code, "taking memory");
}

static void release_opencl(gpu_device *device, gpu_buffer *buffer) {
  const opencl_device *state = device->state;
  if (buffer->handle != 0) state->api->clReleaseMemObject((cl_object)(uintptr_t)buffer->handle);
  *buffer = (gpu_buffer){0};
}

static bool upload_opencl(gpu_device *device, const gpu_buffer *buffer, size_t offset, const void *from,
                          size_t bytes) {
  const opencl_device *state = device->state;
  return !fails(device,
                state->api->clEnqueueWriteBuffer(state->queue, (cl_object)(uintptr_t)buffer->handle,
                                                 CL_TRUE_VALUE, offset, bytes, from, 0, NULL, NULL),
                "writing memory");
}

static bool download_opencl(gpu_device *device, const gpu_buffer *buffer, size_t offset, void *to,
                            size_t bytes) {
  const opencl_device *state = device->state;
  return !fails(device,
                state->api->clEnqueueReadBuffer(state->queue, (cl_object)(uintptr_t)buffer->handle,
                                                CL_TRUE_VALUE, offset, bytes, to, 0, NULL, NULL),
                "reading memory");
}

/* OpenCL uses a single in-order queue for both lines. */
static bool launch_opencl(gpu_device *device, const gpu_program *program, int kernel, int line,
                          uint32_t groups, const gpu_argument *arguments, int argument_count) {
  (void)line;
  const opencl_device *state = device->state;
  const opencl_library *api = state->api;
  cl_object function = program->kernels[kernel];
  for (int i = 0; i < argument_count; i++) {
    cl_object memory = arguments[i].buffer == NULL ? NULL : (cl_object)(uintptr_t)arguments[i].buffer->handle;
    cl_int code = arguments[i].buffer == NULL
                      ? api->clSetKernelArg(function, (cl_uint)i, sizeof(uint32_t), &arguments[i].value)
                      : api->clSetKernelArg(function, (cl_uint)i, sizeof memory, &memory);
    if (fails(device, code, "starting a kernel")) return false;
  }
  const size_t members = (size_t)groups * GPU_GROUP, group = GPU_GROUP;
  return !fails(device,
                api->clEnqueueNDRangeKernel(state->queue, function, 1, NULL, &members, &group, 0, NULL, NULL),
                "starting a kernel");
}

static bool follow_opencl(gpu_device *device, int line, int other) {
  (void)device;
  (void)line;
  (void)other;
  return true;
}

static bool finish_opencl(gpu_device *device) {
  const opencl_device *state = device->state;
  return !fails(device, state->api->clFinish(state->queue), "running the kernels");
}

static bool mark_opencl(gpu_device *device, int moment) {
  opencl_device *state = device->state;
  if (state->moments[moment] != NULL) state->api->clReleaseEvent(state->moments[moment]);
  return !fails(device,
                state->api->clEnqueueMarkerWithWaitList(state->queue, 0, NULL, &state->moments[moment]),
                "reading the clock");
}

static double milliseconds_opencl(gpu_device *device) {
  const opencl_device *state = device->state;
  cl_ulong at[2] = {0, 0};
  for (int i = 0; i < 2; i++)
    state->api->clGetEventProfilingInfo(state->moments[i], CL_PROFILING_COMMAND_END, sizeof at[i], &at[i],
                                        NULL);
  return (double)(at[1] - at[0]) * 1e-6;
}

const gpu_driver hl_opencl_driver = {.name = "opencl",
                                     .load = load_opencl,
                                     .unload = unload_opencl,
                                     .count = count_opencl,
                                     .describe = describe_opencl,
                                     .open = open_opencl,
                                     .close = close_opencl,
                                     .compile = compile_opencl,
                                     .load_program = load_opencl_program,
                                     .release_program = release_opencl_program,
                                     .allocate = allocate_opencl,
                                     .release = release_opencl,
                                     .upload = upload_opencl,
                                     .download = download_opencl,
                                     .launch = launch_opencl,
                                     .follow = follow_opencl,
                                     .finish = finish_opencl,
                                     .mark = mark_opencl,
                                     .milliseconds = milliseconds_opencl};
