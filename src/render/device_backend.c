/* render/device_backend.c - a GPU as a back end: chooses the device, tests it, and makes the sweeps of plans
 * with it. */
#include "render/device_backend.h"

#include <stdio.h>
#include <string.h>

#include "core/context.h"
#include "core/memory.h"
#include "render/device_plan.h"
#include "render/device_reasons.h"
#include "render/device_trial.h"
#include "render/maximum.h"

void hl_device_forget(hl_renderer *renderer) {
  if (renderer->device.gpu != NULL) hl_gpu_forget(renderer->device.gpu);
}

void hl_device_release(hl_renderer *renderer) {
  hl_gpu_close(renderer->device.gpu);
  renderer->device.gpu = NULL;
}

/* Lets the processors make all frames from now on. reason: may be a text of the device, which is released
 * after it is copied. */
static void give_up(hl_renderer *renderer, const char *reason) {
  snprintf(renderer->device.problem, sizeof renderer->device.problem, "%.390s", reason);
  hl_device_release(renderer);
}

/* The name of the device that should make the renderer's frames. Returns null if the processors make them. */
static const char *wanted_device(const hl_renderer *renderer) {
  return renderer->device.wanted[0] != '\0' ? renderer->device.wanted : renderer->context->options.device;
}

bool hl_device_choose(hl_renderer *renderer, const char *device) {
  if (device == NULL) device = "";
  if (strlen(device) >= sizeof renderer->device.wanted) return false;
  hl_device_release(renderer);
  renderer->device.tried = false;
  renderer->device.problem[0] = '\0';
  snprintf(renderer->device.wanted, sizeof renderer->device.wanted, "%s", device);
  return true;
}

/* Opens the device that the renderer wants, and tests it. This is done once. */
static void open_device(hl_renderer *renderer) {
  const char *wanted = wanted_device(renderer);
  char problem[GPU_PROBLEM_BYTES] = "";
  if (renderer->device.tried) return;
  renderer->device.tried = true;
  renderer->device.gpu = hl_gpu_open(renderer->context, wanted, renderer->context->options.cache_folder,
                                     problem);
  if (renderer->device.gpu != NULL && hl_device_passes(renderer, strcmp(wanted, "auto") == 0, problem))
    return;
  give_up(renderer, problem);
  if (strcmp(wanted, "auto") != 0)
    hl_log(renderer->context, HL_LOG_WARNING, "the processors make the pictures: %s",
           renderer->device.problem);
}

/* Returns whether a device should make the renderer's frames. */
static bool wants_device(const hl_renderer *renderer) {
  const char *wanted = wanted_device(renderer);
  return wanted != NULL && strcmp(wanted, "cpu") != 0;
}

static hl_status prepare(hl_renderer *renderer, const frame_plan *plan, const frame_target *target,
                         hl_error *error) {
  (void)target;
  if (!wants_device(renderer)) return hl_fail(error, HL_ERROR_UNSUPPORTED, "%s", "");
  const char *reason = hl_reason_for_processors(plan);
  if (reason == NULL) open_device(renderer);
  if (reason == NULL && renderer->device.gpu == NULL) reason = renderer->device.problem;
  if (reason != NULL) return hl_fail(error, HL_ERROR_UNSUPPORTED, "%s", reason);
  gpu_volume volumes[PLAN_VOLUMES];
  hl_volumes_for_device(plan, volumes);
  if (hl_gpu_prepare(renderer->device.gpu, volumes, plan->volumes.count)) return HL_OK;
  give_up(renderer, hl_gpu_problem(renderer->device.gpu));
  return hl_fail(error, HL_ERROR_UNSUPPORTED, "%s", renderer->device.problem);
}

/* Makes a sweep on the device and brings its pixels to the target. */
static hl_status make_sweep(hl_renderer *renderer, const planned_sweep *planned, float *pixels,
                            hl_render_statistics *statistics, hl_error *error) {
  hl_gpu *gpu = renderer->device.gpu;
  gpu_times times = {0};
  if (!hl_gpu_run(gpu, &planned->sweep) || !hl_gpu_read(gpu, &planned->sweep, pixels, &times))
    return hl_fail(error, HL_ERROR_UNSUPPORTED, "%s", hl_gpu_problem(gpu));
  statistics->sheets += planned->plan.sheets;
  statistics->samples_shaded += times.samples;
  statistics->device_launches += times.launches;
  statistics->seconds_device += times.milliseconds * 1e-3;
  return HL_OK;
}

static hl_status run(hl_renderer *renderer, const frame_plan *plan, int index, frame_target *target,
                     hl_render_statistics *statistics, hl_error *error) {
  hl_context *context = renderer->context;
  const sweep_means means = {context, renderer->pool, &renderer->cache.reserve,
                             hl_hot_functions(context->options.instruction_set)};
  const sweep_plan *of = &plan->sweeps.list[index];
  float *pixels = hl_frame_target_pixels(target, plan, index);
  /* The processors search for hidden matter. Samples of this search do not count as samples of the device. */
  const uint64_t samples = statistics->samples_shaded;
  planned_sweep planned = {0};
  int32_t *shown_from = NULL;
  hl_status status = hl_find_hidden(&means, plan, of, pixels, &shown_from, statistics, error);
  statistics->samples_shaded = samples;
  if (status == HL_OK) status = hl_plan_sweep(&means, plan, of, shown_from, &planned, error);
  if (status == HL_OK) status = make_sweep(renderer, &planned, pixels, statistics, error);
  if (status == HL_OK && target->maximum.values != NULL)
    hl_maximum_take(&target->maximum, renderer->pool, pixels);
  hl_plan_release(context, &planned);
  hl_release(context, shown_from);
  if (status != HL_OK) give_up(renderer, error->message);
  return status;
}

static hl_status read(hl_renderer *renderer, const frame_plan *plan, frame_target *target,
                      hl_render_statistics *statistics, hl_error *error) {
  (void)plan, (void)target, (void)error;
  snprintf(statistics->device, sizeof statistics->device, "%s",
           hl_gpu_device(renderer->device.gpu)->info.name);
  return HL_OK;
}

const backend hl_device_backend = {.prepare = prepare, .run = run, .read = read};
