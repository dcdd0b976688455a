/* gpu/cuda_driver.c - uses GPUs by CUDA: by the driver, libcuda.so.1, and the runtime compiler nvrtc. The few
 * types, numbers and functions that are used are declared here, so that building needs no headers. */
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gpu/driver.h"

typedef int cuda_status;
typedef int cuda_device_number;
typedef void *cuda_object;
typedef unsigned long long cuda_memory;

enum { CUDA_OUT_OF_MEMORY = 2, CUDA_MAJOR = 75, CUDA_MINOR = 76 };

/* The functions that are used, by name. */
#define CUDA_FUNCTIONS                                                                               \
  CUDA_FUNCTION(cuda_status, cuInit, (unsigned))                                                     \
  CUDA_FUNCTION(cuda_status, cuDriverGetVersion, (int *))                                            \
  CUDA_FUNCTION(cuda_status, cuDeviceGetCount, (int *))                                              \
  CUDA_FUNCTION(cuda_status, cuDeviceGet, (cuda_device_number *, int))                               \
  CUDA_FUNCTION(cuda_status, cuDeviceGetName, (char *, int, cuda_device_number))                     \
  CUDA_FUNCTION(cuda_status, cuDeviceTotalMem_v2, (size_t *, cuda_device_number))                    \
  CUDA_FUNCTION(cuda_status, cuDeviceGetAttribute, (int *, int, cuda_device_number))                 \
  CUDA_FUNCTION(cuda_status, cuDevicePrimaryCtxRetain, (cuda_object *, cuda_device_number))          \
  CUDA_FUNCTION(cuda_status, cuDevicePrimaryCtxRelease_v2, (cuda_device_number))                     \
  CUDA_FUNCTION(cuda_status, cuCtxPushCurrent_v2, (cuda_object))                                     \
  CUDA_FUNCTION(cuda_status, cuCtxPopCurrent_v2, (cuda_object *))                                    \
  CUDA_FUNCTION(cuda_status, cuStreamCreate, (cuda_object *, unsigned))                              \
  CUDA_FUNCTION(cuda_status, cuStreamDestroy_v2, (cuda_object))                                      \
  CUDA_FUNCTION(cuda_status, cuStreamSynchronize, (cuda_object))                                     \
  CUDA_FUNCTION(cuda_status, cuModuleLoadData, (cuda_object *, const void *))                        \
  CUDA_FUNCTION(cuda_status, cuModuleUnload, (cuda_object))                                          \
  CUDA_FUNCTION(cuda_status, cuModuleGetFunction, (cuda_object *, cuda_object, const char *))        \
  CUDA_FUNCTION(cuda_status, cuMemAlloc_v2, (cuda_memory *, size_t))                                 \
  CUDA_FUNCTION(cuda_status, cuMemFree_v2, (cuda_memory))                                            \
  CUDA_FUNCTION(cuda_status, cuMemAllocHost_v2, (void **, size_t))                                   \
  CUDA_FUNCTION(cuda_status, cuMemFreeHost, (void *))                                                \
  CUDA_FUNCTION(cuda_status, cuMemcpyHtoDAsync_v2, (cuda_memory, const void *, size_t, cuda_object)) \
  CUDA_FUNCTION(cuda_status, cuMemcpyDtoHAsync_v2, (void *, cuda_memory, size_t, cuda_object))       \
  CUDA_FUNCTION(cuda_status, cuLaunchKernel,                                                         \
                (cuda_object, unsigned, unsigned, unsigned, unsigned, unsigned, unsigned, unsigned,  \
                 cuda_object, void **, void **))                                                     \
  CUDA_FUNCTION(cuda_status, cuEventCreate, (cuda_object *, unsigned))                               \
  CUDA_FUNCTION(cuda_status, cuEventDestroy_v2, (cuda_object))                                       \
  CUDA_FUNCTION(cuda_status, cuEventRecord, (cuda_object, cuda_object))                              \
  CUDA_FUNCTION(cuda_status, cuStreamWaitEvent, (cuda_object, cuda_object, unsigned))                \
  CUDA_FUNCTION(cuda_status, cuEventElapsedTime, (float *, cuda_object, cuda_object))                \
  CUDA_FUNCTION(cuda_status, cuGetErrorName, (cuda_status, const char **))

#define NVRTC_FUNCTIONS                                                                                     \
  CUDA_FUNCTION(int, nvrtcVersion, (int *, int *))                                                          \
  CUDA_FUNCTION(int, nvrtcCreateProgram,                                                                    \
                (cuda_object *, const char *, const char *, int, const char *const *, const char *const *)) \
  CUDA_FUNCTION(int, nvrtcCompileProgram, (cuda_object, int, const char *const *))                          \
  CUDA_FUNCTION(int, nvrtcGetCUBINSize, (cuda_object, size_t *))                                            \
  CUDA_FUNCTION(int, nvrtcGetCUBIN, (cuda_object, char *))                                                  \
  CUDA_FUNCTION(int, nvrtcGetProgramLogSize, (cuda_object, size_t *))                                       \
  CUDA_FUNCTION(int, nvrtcGetProgramLog, (cuda_object, char *))                                             \
  CUDA_FUNCTION(int, nvrtcDestroyProgram, (cuda_object *))

typedef struct cuda_library {
  void *handle, *compiler;
#define CUDA_FUNCTION(type, name, parameters) type(*name) parameters;
  CUDA_FUNCTIONS
  NVRTC_FUNCTIONS
#undef CUDA_FUNCTION
} cuda_library;

typedef struct cuda_device {
  const cuda_library *api;
  cuda_device_number number;
  int architecture;                                        /* ten times the device's compute capability: 90
                                                            * stands for 9.0 */
  cuda_object context, streams[2], moments[2], reached[2]; /* reached: events, one for each stream */
  void *stage; /* owned; pinned memory through which downloads pass, because downloads into other memory are
                * slow */
  size_t stage_bytes;
} cuda_device;

static bool find_functions(cuda_library *api) {
#define CUDA_FUNCTION(type, name, parameters) \
  *(void **)&api->name = dlsym(from, #name);  \
  if (api->name == NULL) return false;
  void *from = api->handle;
  CUDA_FUNCTIONS
  from = api->compiler;
  NVRTC_FUNCTIONS
#undef CUDA_FUNCTION
  return true;
}

static void unload_cuda(void *library) {
  cuda_library *api = library;
  if (api->compiler != NULL) dlclose(api->compiler);
  if (api->handle != NULL) dlclose(api->handle);
  free(api);
}

static bool load_cuda(void **library, char *problem) {
  static const char *const drivers[] = {"libcuda.so.1", NULL};
  static const char *const compilers[] = {"libnvrtc.so.13", "libnvrtc.so.12", "libnvrtc.so", NULL};
  cuda_library *api = calloc(1, sizeof *api);
  if (api == NULL) return snprintf(problem, GPU_PROBLEM_BYTES, "no memory is left"), false;
  api->handle = hl_load_library(drivers, problem);
  if (api->handle != NULL) api->compiler = hl_load_library(compilers, problem);
  bool found = api->compiler != NULL;
  if (found && !find_functions(api)) {
    snprintf(problem, GPU_PROBLEM_BYTES, "libcuda.so.1 or nvrtc is older than CUDA 11.1");
    found = false;
  }
  if (found && api->cuInit(0) != 0) {
    snprintf(problem, GPU_PROBLEM_BYTES, "CUDA does not start: no NVIDIA device answers");
    found = false;
  }
  if (found) *library = api;
  else unload_cuda(api);
  return found;
}

static int count_cuda(void *library) {
  const cuda_library *api = library;
  int count = 0;
  return api->cuDeviceGetCount(&count) == 0 ? count : 0;
}

static bool describe_cuda(void *library, int index, gpu_device_info *info) {
  const cuda_library *api = library;
  cuda_device_number number;
  int driver = 0, major = 0, minor = 0, capability[2] = {0, 0};
  size_t memory = 0;
  memset(info, 0, sizeof *info);
  if (api->cuDeviceGet(&number, index) != 0 ||
      api->cuDeviceGetName(info->name, (int)sizeof info->name, number) != 0)
    return false;
  api->cuDriverGetVersion(&driver);
  api->nvrtcVersion(&major, &minor);
  api->cuDeviceTotalMem_v2(&memory, number);
  api->cuDeviceGetAttribute(&capability[0], CUDA_MAJOR, number);
  api->cuDeviceGetAttribute(&capability[1], CUDA_MINOR, number);
  snprintf(info->version, sizeof info->version, "CUDA %d.%d, nvrtc %d.%d, compute capability %d.%d",
           driver / 1000, driver % 1000 / 10, major, minor, capability[0], capability[1]);
  info->memory_bytes = memory;
  return true;
}

static bool fails(gpu_device *device, cuda_status code, const char *what) {
  const cuda_device *state = device->state;
  const char *name = NULL;
  if (code == 0) return false;
  state->api->cuGetErrorName(code, &name);
  if (code == CUDA_OUT_OF_MEMORY)
    snprintf(device->problem, sizeof device->problem, "%s has no memory left", device->info.name);
  else
    snprintf(device->problem, sizeof device->problem, "%s: %s failed with %s", device->info.name, what,
             name == NULL ? "an unknown error" : name);
  return true;
}

/* Makes the device's context current in the calling thread, for the time of one call. */
static bool enter(gpu_device *device) {
  cuda_device *state = device->state;
  return !fails(device, state->api->cuCtxPushCurrent_v2(state->context), "entering");
}
static bool leave(gpu_device *device, cuda_status code, const char *what) {
  cuda_device *state = device->state;
  cuda_object context;
  bool failed = fails(device, code, what);
  state->api->cuCtxPopCurrent_v2(&context);
  return !failed;
}

static void close_cuda(gpu_device *device) {
  cuda_device *state = device->state;
  if (state == NULL) return;
  if (state->context != NULL && enter(device)) {
    for (int i = 0; i < 2; i++) {
      if (state->moments[i] != NULL) state->api->cuEventDestroy_v2(state->moments[i]);
      if (state->reached[i] != NULL) state->api->cuEventDestroy_v2(state->reached[i]);
      if (state->streams[i] != NULL) state->api->cuStreamDestroy_v2(state->streams[i]);
    }
    if (state->stage != NULL) state->api->cuMemFreeHost(state->stage);
    (void)leave(device, 0, "closing");
  }
  if (state->context != NULL) state->api->cuDevicePrimaryCtxRelease_v2(state->number);
  free(state);
  device->state = NULL;
}

static bool open_cuda(void *library, int index, gpu_device *device) {
  const cuda_library *api = library;
  cuda_device *state = calloc(1, sizeof *state);
  int capability[2] = {0, 0};
  device->state = state;
  if (state == NULL) return snprintf(device->problem, sizeof device->problem, "no memory is left"), false;
  state->api = api;
  bool failed = fails(device, api->cuDeviceGet(&state->number, index), "opening") ||
                fails(device, api->cuDevicePrimaryCtxRetain(&state->context, state->number), "opening");
  if (!failed) {
    api->cuDeviceGetAttribute(&capability[0], CUDA_MAJOR, state->number);
    api->cuDeviceGetAttribute(&capability[1], CUDA_MINOR, state->number);
    state->architecture = capability[0] * 10 + capability[1];
    failed = !enter(device);
  }
  if (!failed) {
    cuda_status code = 0;
    for (int i = 0; i < 2 && code == 0; i++) {
      code = api->cuStreamCreate(&state->streams[i], 1); /* flag: the stream waits for no other stream */
      if (code == 0) code = api->cuEventCreate(&state->moments[i], 0);
      if (code == 0) code = api->cuEventCreate(&state->reached[i], 2); /* flag: the event has no time */
    }
    failed = !leave(device, code, "opening");
  }
  if (failed) close_cuda(device);
  return !failed;
}

static void tell_of_log(gpu_device *device, const cuda_library *api, cuda_object program) {
  size_t size = 0;
  char *log = api->nvrtcGetProgramLogSize(program, &size) == 0 ? calloc(1, size + 1) : NULL;
  if (log != NULL) api->nvrtcGetProgramLog(program, log);
  if (log != NULL) hl_gpu_make_line(log);
  snprintf(device->problem, sizeof device->problem, "nvrtc does not compile the kernels: %.300s",
           log == NULL ? "" : log);
  free(log);
}

static bool compile_cuda(gpu_device *device, const char *text, const char *const *defines, int define_count,
                         gpu_binary *binary) {
  const cuda_device *state = device->state;
  const cuda_library *api = state->api;
  enum { OPTIONS = 5, MOST_DEFINES = 24 };
  char words[MOST_DEFINES][64], architecture[40];
  const char *options[OPTIONS + MOST_DEFINES] = {architecture, "--fmad=false", "--prec-div=true",
                                                 "--prec-sqrt=true", "--ftz=false"};
  snprintf(architecture, sizeof architecture, "--gpu-architecture=sm_%d", state->architecture);
  for (int i = 0; i < define_count && i < MOST_DEFINES; i++) {
    snprintf(words[i], sizeof words[i], "-D%s", defines[i]);
    options[OPTIONS + i] = words[i];
  }
  cuda_object program = NULL;
  if (api->nvrtcCreateProgram(&program, text, "halflight.cu", 0, NULL, NULL) != 0)
    return snprintf(device->problem, sizeof device->problem, "nvrtc does not start"), false;
  bool compiled = api->nvrtcCompileProgram(program, OPTIONS + define_count, options) == 0;
  size_t size = 0;
  if (!compiled) tell_of_log(device, api, program);
  if (compiled) {
    compiled = api->nvrtcGetCUBINSize(program, &size) == 0 && size > 0;
    binary->bytes = compiled ? malloc(size) : NULL;
    binary->size = size;
    compiled = binary->bytes != NULL && api->nvrtcGetCUBIN(program, binary->bytes) == 0;
    if (!compiled) {
      free(binary->bytes);
      binary->bytes = NULL;
      snprintf(device->problem, sizeof device->problem, "nvrtc gives no code for %s", architecture);
    }
  }
  api->nvrtcDestroyProgram(&program);
  return compiled;
}

static void release_cuda_program(gpu_device *device, gpu_program *program) {
  const cuda_device *state = device->state;
  if (program->module != NULL && enter(device)) {
    state->api->cuModuleUnload(program->module);
    (void)leave(device, 0, "closing");
  }
  memset(program, 0, sizeof *program);
}

static bool load_cuda_program(gpu_device *device, const gpu_binary *binary, const char *const *names,
                              int kernel_count, gpu_program *program) {
  const cuda_library *api = ((cuda_device *)device->state)->api;
  memset(program, 0, sizeof *program);
  if (!enter(device)) return false;
  cuda_status code = api->cuModuleLoadData(&program->module, binary->bytes);
  for (int i = 0; i < kernel_count && code == 0; i++)
    code = api->cuModuleGetFunction(&program->kernels[i], program->module, names[i]);
  if (leave(device, code, "loading the kernels")) return true;
  release_cuda_program(device, program);
  return false;
}

static bool allocate_cuda(gpu_device *device, size_t bytes, gpu_buffer *buffer) {
  const cuda_device *state = device->state;
  cuda_memory memory = 0;
  if (!enter(device)) return false;
  bool done = leave(device, state->api->cuMemAlloc_v2(&memory, bytes), "taking memory");
  *buffer = (gpu_buffer){memory, bytes};
  return done;
}

static void release_cuda(gpu_device *device, gpu_buffer *buffer) {
  const cuda_device *state = device->state;
  if (buffer->handle != 0 && enter(device))
    (void)leave(device, state->api->cuMemFree_v2(buffer->handle), "giving memory back");
  *buffer = (gpu_buffer){0};
}

/* memory that is not pinned may be changed afterwards: CUDA copies it to a buffer of its own before it
 * returns */
static bool upload_cuda(gpu_device *device, const gpu_buffer *buffer, size_t offset, const void *from,
                        size_t bytes) {
  const cuda_device *state = device->state;
  if (!enter(device)) return false;
  return leave(device,
               state->api->cuMemcpyHtoDAsync_v2(buffer->handle + offset, from, bytes, state->streams[0]),
               "writing memory");
}

static bool download_cuda(gpu_device *device, const gpu_buffer *buffer, size_t offset, void *to,
                          size_t bytes) {
  cuda_device *state = device->state;
  cuda_status code = 0;
  if (!enter(device)) return false;
  if (state->stage_bytes < bytes) {
    if (state->stage != NULL) state->api->cuMemFreeHost(state->stage);
    state->stage = NULL;
    state->stage_bytes = 0;
    code = state->api->cuMemAllocHost_v2(&state->stage, bytes);
    if (code == 0) state->stage_bytes = bytes;
  }
  if (code == 0)
    code = state->api->cuMemcpyDtoHAsync_v2(state->stage, buffer->handle + offset, bytes, state->streams[0]);
  if (code == 0) code = state->api->cuStreamSynchronize(state->streams[0]);
  if (!leave(device, code, "reading memory")) return false;
  memcpy(to, state->stage, bytes);
  return true;
}

static bool launch_cuda(gpu_device *device, const gpu_program *program, int kernel, int line, uint32_t groups,
                        const gpu_argument *arguments, int argument_count) {
  const cuda_device *state = device->state;
  enum { MOST_ARGUMENTS = 24 };
  cuda_memory memory[MOST_ARGUMENTS];
  uint32_t values[MOST_ARGUMENTS];
  void *parameters[MOST_ARGUMENTS];
  for (int i = 0; i < argument_count; i++) {
    memory[i] = arguments[i].buffer == NULL ? 0 : arguments[i].buffer->handle;
    values[i] = arguments[i].value;
    parameters[i] = arguments[i].buffer == NULL ? (void *)&values[i] : (void *)&memory[i];
  }
  if (!enter(device)) return false;
  return leave(device,
               state->api->cuLaunchKernel(program->kernels[kernel], groups, 1, 1, GPU_GROUP, 1, 1, 0,
                                          state->streams[line], parameters, NULL),
               "starting a kernel");
}

static bool follow_cuda(gpu_device *device, int line, int other) {
  const cuda_device *state = device->state;
  if (!enter(device)) return false;
  cuda_status code = state->api->cuEventRecord(state->reached[other], state->streams[other]);
  if (code == 0) code = state->api->cuStreamWaitEvent(state->streams[line], state->reached[other], 0);
  return leave(device, code, "ordering the kernels");
}

static bool finish_cuda(gpu_device *device) {
  const cuda_device *state = device->state;
  if (!enter(device)) return false;
  return leave(device, state->api->cuStreamSynchronize(state->streams[0]), "running the kernels");
}

static bool mark_cuda(gpu_device *device, int moment) {
  const cuda_device *state = device->state;
  if (!enter(device)) return false;
  return leave(device, state->api->cuEventRecord(state->moments[moment], state->streams[0]),
               "reading the clock");
}

static double milliseconds_cuda(gpu_device *device) {
  const cuda_device *state = device->state;
  float milliseconds = 0;
  if (!enter(device)) return 0;
  cuda_status code = state->api->cuEventElapsedTime(&milliseconds, state->moments[0], state->moments[1]);
  return leave(device, code, "reading the clock") ? (double)milliseconds : 0;
}

const gpu_driver hl_cuda_driver = {.name = "cuda",
                                   .load = load_cuda,
                                   .unload = unload_cuda,
                                   .count = count_cuda,
                                   .describe = describe_cuda,
                                   .open = open_cuda,
                                   .close = close_cuda,
                                   .compile = compile_cuda,
                                   .load_program = load_cuda_program,
                                   .release_program = release_cuda_program,
                                   .allocate = allocate_cuda,
                                   .release = release_cuda,
                                   .upload = upload_cuda,
                                   .download = download_cuda,
                                   .launch = launch_cuda,
                                   .follow = follow_cuda,
                                   .finish = finish_cuda,
                                   .mark = mark_cuda,
                                   .milliseconds = milliseconds_cuda};
