/* gpu/failing_opencl.c - a loader of OpenCL that lets calls fail. It hands all calls on to the loader that
 * OPENCL_LIBRARY names. OPENCL_FAILS, "FUNCTION NUMBER ERROR", lets a function fail with an error of OpenCL
 * from the call with a given number on, from 1. With the error 0, clEnqueueReadBuffer spoils what it reads
 * instead. */
#include <dlfcn.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#pragma GCC visibility push(default) /* functions are looked up by name, so that they need no declarations \
                                      */

typedef void *object;

static void *function(const char *name) {
  static void *library;
  if (library == NULL) library = dlopen(getenv("OPENCL_LIBRARY"), RTLD_NOW | RTLD_LOCAL);
  return library == NULL ? NULL : dlsym(library, name);
}

/* Counts a call. Returns whether it fails. error: receives the error. */
static int fails(const char *name, unsigned *calls, int32_t *error) {
  char failing[64];
  unsigned first;
  const char *told = getenv("OPENCL_FAILS");
  if (told == NULL || sscanf(told, "%63s %u %d", failing, &first, error) != 3) return 0;
  return strcmp(failing, name) == 0 && ++*calls >= first;
}

#define PASS_ON(name, parameters, arguments)                      \
  int32_t name parameters;                                        \
  int32_t name parameters {                                       \
    static unsigned calls;                                        \
    int32_t error, (*real)parameters;                             \
    *(void **)&real = function(#name);                            \
    if (fails(#name, &calls, &error) && error != 0) return error; \
    return real arguments;                                        \
  }
#define PASS_ON_MAKER(name, parameters, arguments)                        \
  object name parameters;                                                 \
  object name parameters {                                                \
    static unsigned calls;                                                \
    int32_t error;                                                        \
    object(*real) parameters;                                             \
    *(void **)&real = function(#name);                                    \
    if (fails(#name, &calls, &error)) return *code = error, (object)NULL; \
    return real arguments;                                                \
  }

PASS_ON(clGetPlatformIDs, (uint32_t a, object *b, uint32_t *c), (a, b, c))
PASS_ON(clGetDeviceIDs, (object a, uint64_t b, uint32_t c, object *d, uint32_t *e), (a, b, c, d, e))
PASS_ON(clGetDeviceInfo, (object a, uint32_t b, size_t c, void *d, size_t *e), (a, b, c, d, e))
PASS_ON(clGetProgramBuildInfo, (object a, object b, uint32_t c, size_t d, void *e, size_t *f),
        (a, b, c, d, e, f))
PASS_ON(clGetProgramInfo, (object a, uint32_t b, size_t c, void *d, size_t *e), (a, b, c, d, e))
PASS_ON(clGetEventProfilingInfo, (object a, uint32_t b, size_t c, void *d, size_t *e), (a, b, c, d, e))
PASS_ON(clReleaseContext, (object a), (a))
PASS_ON(clReleaseCommandQueue, (object a), (a))
PASS_ON(clReleaseMemObject, (object a), (a))
PASS_ON(clReleaseProgram, (object a), (a))
PASS_ON(clReleaseKernel, (object a), (a))
PASS_ON(clReleaseEvent, (object a), (a))
PASS_ON(clFinish, (object a), (a))
PASS_ON(clBuildProgram, (object a, uint32_t b, const object *c, const char *d, void *e, void *f),
        (a, b, c, d, e, f))
PASS_ON(clSetKernelArg, (object a, uint32_t b, size_t c, const void *d), (a, b, c, d))
PASS_ON(clEnqueueNDRangeKernel,
        (object a, object b, uint32_t c, const size_t *d, const size_t *e, const size_t *f, uint32_t g,
         const object *h, object *i),
        (a, b, c, d, e, f, g, h, i))
PASS_ON(clEnqueueWriteBuffer,
        (object a, object b, uint32_t c, size_t d, size_t e, const void *f, uint32_t g, const object *h,
         object *i),
        (a, b, c, d, e, f, g, h, i))
PASS_ON(clEnqueueMarkerWithWaitList, (object a, uint32_t b, const object *c, object *d), (a, b, c, d))
PASS_ON_MAKER(clCreateContext, (const void *a, uint32_t b, const object *c, void *d, void *e, int32_t *code),
              (a, b, c, d, e, code))
PASS_ON_MAKER(clCreateCommandQueue, (object a, object b, uint64_t c, int32_t *code), (a, b, c, code))
PASS_ON_MAKER(clCreateBuffer, (object a, uint64_t b, size_t c, void *d, int32_t *code), (a, b, c, d, code))
PASS_ON_MAKER(clCreateProgramWithSource,
              (object a, uint32_t b, const char **c, const size_t *d, int32_t *code), (a, b, c, d, code))
PASS_ON_MAKER(clCreateProgramWithBinary,
              (object a, uint32_t b, const object *c, const size_t *d, const unsigned char **e, int32_t *f,
               int32_t *code),
              (a, b, c, d, e, f, code))
PASS_ON_MAKER(clCreateKernel, (object a, const char *b, int32_t *code), (a, b, code))

int32_t clEnqueueReadBuffer(object a, object b, uint32_t c, size_t d, size_t bytes, void *to, uint32_t g,
                            const object *h, object *i);
int32_t clEnqueueReadBuffer(object a, object b, uint32_t c, size_t d, size_t bytes, void *to, uint32_t g,
                            const object *h, object *i) {
  static unsigned calls;
  int32_t error = 0,
          (*real)(object, object, uint32_t, size_t, size_t, void *, uint32_t, const object *, object *);
  *(void **)&real = function("clEnqueueReadBuffer");
  const int failing = fails("clEnqueueReadBuffer", &calls, &error);
  if (failing && error != 0) return error;
  const int32_t code = real(a, b, c, d, bytes, to, g, h, i);
  if (failing && bytes > 0) ((unsigned char *)to)[bytes / 2] ^= 1;
  return code;
}
