/* gpu/gpu_program.c - compiles the kernels for a variant, and launches them. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gpu/gpu_state.h"
#include "gpu/program_cache.h"

extern const char hl_kernel_text[]; /* made by kernels/text.py */

static const char *const common_kernels[KERNEL_PASSES] = {
    "fill_floats",  "try_arithmetic", "spread_distances", "run_light",
    "find_samples", "shade_samples",  "composite_samples"};

static const char *const soft_kernels[] = {"pass_rows", "pass_fields", "pass_absorbed", "pass_refill"};
static const char *const paper_kernels[] = {"pass_below", "pass_wanted", "convolve_rows", "convolve_columns"};
static const char *const sublight_kernels[] = {"slab_halves", "run_sublights", "dark_sublights",
                                               "reached_blocks"};

enum { VARIANT_DEFINES = 25 };

static void define_variant(const plan_variant *v, char defines[VARIANT_DEFINES][40]) {
  const struct {
    const char *name;
    int value;
  } all[VARIANT_DEFINES] = {
      {"STORAGE", v->storage},   {"BSPLINE", v->bspline},   {"EYE_PERSPECTIVE", v->eye_perspective},
      {"PHONG", v->phong},       {"LIT", v->lit},           {"SHADOWED", v->shadowed},
      {"OUTSIDE", v->outside},   {"BOXED", v->boxed},       {"BACK_TO_FRONT", v->back_to_front},
      {"CHANNELS", v->channels}, {"CUTS", v->cuts},         {"BRICKS", v->bricks},
      {"STEEP", v->steep},       {"MASKED", v->masked},     {"PLANE", v->plane},
      {"COLORED", v->colored},   {"SOFT", v->soft},         {"SKY", v->sky},
      {"MAXIMUM", v->maximum},   {"PAPER", v->paper},       {"SUBLIGHTS", v->sublights},
      {"PHASES", v->phases},     {"TEXTURES", v->textures}, {"EMISSIONS", v->emissions},
      {"VOLUMES", v->volumes}};
  for (int i = 0; i < VARIANT_DEFINES; i++)
    snprintf(defines[i], sizeof defines[i], "%s=%d", all[i].name, all[i].value);
}

/* Finds the names of a variant's kernels. Returns the number of kernels. */
static int names_of_kernels(const plan_variant *variant, const char *names[KERNELS]) {
  memcpy(names, common_kernels, sizeof common_kernels);
  const char *const *of_passes = variant->soft        ? soft_kernels
                                 : variant->paper     ? paper_kernels
                                 : variant->sublights ? sublight_kernels
                                                      : NULL;
  if (of_passes == NULL) return KERNEL_PASSES;
  memcpy(names + KERNEL_PASSES, of_passes, sizeof soft_kernels);
  return KERNELS;
}

static bool compile(hl_gpu *gpu, const plan_variant *variant, gpu_program *program) {
  const gpu_driver *driver = gpu->device.driver;
  const char *names[KERNELS];
  const int kernels = names_of_kernels(variant, names);
  char words[VARIANT_DEFINES][40], key[PROGRAM_KEY_BYTES];
  const char *defines[VARIANT_DEFINES];
  gpu_binary binary = {0};
  define_variant(variant, words);
  int length = snprintf(key, sizeof key, "%s %s, %s, %016llx", driver->name, gpu->device.info.name,
                        gpu->device.info.version, (unsigned long long)hl_program_number(hl_kernel_text));
  for (int i = 0; i < VARIANT_DEFINES; i++) {
    defines[i] = words[i];
    length += snprintf(key + length, sizeof key - (size_t)length, " %s", words[i]);
  }
  bool loaded = hl_program_stored(gpu->cache_folder, key, &binary) &&
                driver->load_program(&gpu->device, &binary, names, kernels, program);
  if (!loaded) {
    free(binary.bytes);
    binary = (gpu_binary){0};
    if (!driver->compile(&gpu->device, hl_kernel_text, defines, VARIANT_DEFINES, &binary)) return false;
    hl_program_store(gpu->cache_folder, key, &binary);
    loaded = driver->load_program(&gpu->device, &binary, names, kernels, program);
  }
  free(binary.bytes);
  return loaded;
}

const gpu_program *hl_gpu_program_of(hl_gpu *gpu, const plan_variant *variant) {
  for (int i = 0; i < gpu->program_count; i++)
    if (memcmp(&gpu->programs[i].variant, variant, sizeof *variant) == 0) return &gpu->programs[i].program;
  if (gpu->program_count == MOST_VARIANTS)
    gpu->device.driver->release_program(&gpu->device, &gpu->programs[--gpu->program_count].program);
  known_program *next = &gpu->programs[gpu->program_count];
  if (!compile(gpu, variant, &next->program)) return NULL;
  next->variant = *variant;
  gpu->program_count++;
  return &next->program;
}

/* ---- launches ---- */

gpu_argument hl_gpu_memory(const hl_gpu *gpu, enum buffer_use use) {
  return (gpu_argument){.buffer = &gpu->buffers[use]};
}
gpu_argument hl_gpu_number(int value) { return (gpu_argument){.value = (uint32_t)value}; }
gpu_argument hl_gpu_number_of_float(float value) {
  gpu_argument argument = {0};
  memcpy(&argument.value, &value, sizeof value);
  return argument;
}

bool hl_gpu_launch(hl_gpu *gpu, const gpu_program *program, int kernel, int line, uint32_t groups,
                   const gpu_argument *arguments, int count) {
  gpu->launches++;
  return gpu->device.driver->launch(&gpu->device, program, kernel, line, groups, arguments, count);
}

uint32_t hl_gpu_groups(size_t members) { return (uint32_t)((members + GPU_GROUP - 1) / GPU_GROUP); }
