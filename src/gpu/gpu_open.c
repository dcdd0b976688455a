/* gpu/gpu_open.c - finds devices, and opens and closes them. */
#include <stdio.h>
#include <string.h>

#include <dlfcn.h>

#include "gpu/gpu_state.h"

const gpu_device *hl_gpu_device(const hl_gpu *gpu) { return &gpu->device; }
const char *hl_gpu_problem(const hl_gpu *gpu) { return gpu->device.problem; }

/* ---- finding and opening devices ---- */

static const gpu_driver *const drivers[] = {&hl_cuda_driver, &hl_opencl_driver};
enum { DRIVERS = sizeof drivers / sizeof *drivers };

void *hl_load_library(const char *const *names, char *problem) {
  for (; *names != NULL; names++) {
    void *library = dlopen(*names, RTLD_NOW | RTLD_LOCAL);
    if (library != NULL) return library;
    if (problem[0] != '\0') continue;
    snprintf(problem, GPU_PROBLEM_BYTES, "there is no %s", *names);
  }
  return NULL;
}

void hl_gpu_make_line(char *text) {
  for (; *text != '\0'; text++)
    if (*text < ' ' || *text > '~') *text = ' ';
}

static bool find_of_driver(const gpu_driver *driver, gpu_found *found, void *data, char *problem) {
  void *library;
  gpu_device_info info;
  if (!driver->load(&library, problem)) return true;
  bool goes_on = true;
  for (int i = 0; i < driver->count(library) && goes_on; i++)
    if (driver->describe(library, i, &info)) goes_on = found(data, driver, library, i, &info);
  if (goes_on) driver->unload(library); /* if the device was not opened, the caller keeps the library open */
  return goes_on;
}

void hl_gpu_find(const char *driver, gpu_found *found, void *data, char *problem) {
  char of_driver[DRIVERS][GPU_PROBLEM_BYTES] = {{0}};
  bool goes_on = true;
  size_t used = 0;
  problem[0] = '\0';
  for (int d = 0; d < DRIVERS && goes_on; d++)
    if (driver == NULL || strcmp(driver, drivers[d]->name) == 0)
      goes_on = find_of_driver(drivers[d], found, data, of_driver[d]);
  for (int d = 0; d < DRIVERS; d++)
    if (of_driver[d][0] != '\0' && used < GPU_PROBLEM_BYTES)
      used += (size_t)snprintf(problem + used, GPU_PROBLEM_BYTES - used, "%s%s", used > 0 ? "; " : "",
                               of_driver[d]);
}

/* The name that is searched for, and the device that was opened. */
typedef struct gpu_search {
  const char *wanted;
  gpu_device device;
  void *opened;
  bool met;
} gpu_search;

/* Converts an ASCII letter to a small letter, independently of the locale. */
static char small_letter(char c) { return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c; }

static bool has_word(const char *text, const char *word) {
  for (; *text != '\0'; text++) {
    size_t i = 0;
    while (word[i] != '\0' && small_letter(text[i]) == small_letter(word[i])) i++;
    if (word[i] == '\0') return true;
  }
  return false;
}

static bool is_wanted(const char *wanted, const gpu_driver *driver, const gpu_device_info *info) {
  if (strcmp(wanted, "gpu") == 0 || strcmp(wanted, "auto") == 0) return !info->processor;
  return strcmp(wanted, driver->name) == 0 || has_word(info->name, wanted);
}

static bool open_if_wanted(void *data, const gpu_driver *driver, void *library, int index,
                           const gpu_device_info *info) {
  gpu_search *search = data;
  if (!is_wanted(search->wanted, driver, info)) return true;
  search->met = true;
  search->device.driver = driver;
  search->device.info = *info;
  search->opened = library;
  return !driver->open(library, index, &search->device);
}

hl_gpu *hl_gpu_open(hl_context *context, const char *wanted, const char *cache_folder, char *problem) {
  gpu_search search = {.wanted = wanted};
  char missing[GPU_PROBLEM_BYTES];
  hl_gpu_find(NULL, open_if_wanted, &search, missing);
  if (search.device.state == NULL) {
    if (search.met) snprintf(problem, GPU_PROBLEM_BYTES, "%s", search.device.problem);
    else
      snprintf(problem, GPU_PROBLEM_BYTES, "no device answers to \"%.60s\"%s%.300s", wanted,
               missing[0] != '\0' ? ": " : "", missing);
    return NULL;
  }
  hl_gpu *gpu = hl_allocate_zeroed(context, 1, sizeof *gpu);
  if (gpu == NULL) {
    search.device.driver->close(&search.device);
    snprintf(problem, GPU_PROBLEM_BYTES, "no memory is left");
    return NULL;
  }
  gpu->context = context;
  gpu->library = search.opened;
  gpu->device = search.device;
  gpu->cache_folder = cache_folder;
  return gpu;
}

void hl_gpu_close(hl_gpu *gpu) {
  if (gpu == NULL) return;
  const gpu_driver *driver = gpu->device.driver;
  for (int i = 0; i < gpu->program_count; i++)
    driver->release_program(&gpu->device, &gpu->programs[i].program);
  for (int i = 0; i < BUFFERS; i++) driver->release(&gpu->device, &gpu->buffers[i]);
  driver->close(&gpu->device);
  driver->unload(gpu->library);
  hl_release(gpu->context, gpu);
}
