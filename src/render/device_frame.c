/* render/device_frame.c - see device_frame.h. */
#include "render/device_frame.h"

#include <stdio.h>
#include <string.h>

#include "core/context.h"
#include "core/memory.h"
#include "render/device_trial.h"
#include "render/plan_frame.h"

void hl_device_forget(hl_renderer *renderer) {
  if (renderer->gpu != NULL) hl_gpu_forget(renderer->gpu);
}

void hl_device_release(hl_renderer *renderer) {
  hl_gpu_close(renderer->gpu);
  renderer->gpu = NULL;
}

/* From now on the processors make the frames. */
static void give_up(hl_renderer *renderer, const char *reason) {
  hl_device_release(renderer);
  snprintf(renderer->device_problem, sizeof renderer->device_problem, "%.390s", reason);
}

/* What makes the renderer's frames; null: the processors. */
static const char *wanted_device(const hl_renderer *renderer) {
  return renderer->device[0] != '\0' ? renderer->device : renderer->context->options.device;
}

bool hl_device_choose(hl_renderer *renderer, const char *device) {
  if (device == NULL) device = "";
  if (strlen(device) >= sizeof renderer->device) return false;
  hl_device_release(renderer);
  renderer->device_tried = false;
  renderer->device_problem[0] = '\0';
  snprintf(renderer->device, sizeof renderer->device, "%s", device);
  return true;
}

/* Opens the device that is wanted, and tries it, once. */
static void open_device(hl_renderer *renderer) {
  const char *wanted = wanted_device(renderer);
  char problem[GPU_PROBLEM_BYTES] = "";
  if (renderer->device_tried) return;
  renderer->device_tried = true;
  renderer->gpu = hl_gpu_open(renderer->context, wanted, renderer->context->options.cache_folder, problem);
  if (renderer->gpu != NULL && hl_device_passes(renderer, strcmp(wanted, "auto") == 0, problem)) return;
  give_up(renderer, problem);
  if (strcmp(wanted, "auto") != 0)
    hl_log(renderer->context, HL_LOG_WARNING, "the processors make the pictures: %s",
           renderer->device_problem);
}

static bool run_sweep(hl_renderer *renderer, const hl_scene_description *scene, frame_work *work, int index,
                      sweep_of_frame *sweep_of, gpu_times *times, hl_render_statistics *statistics,
                      hl_error *error) {
  struct sweep sweep = sweep_of(renderer, scene, work, index);
  planned_sweep planned = {0};
  hl_status status = sweep.geometry->back_to_front ? hl_sweep_find_hidden(&sweep, statistics, error) : HL_OK;
  if (status == HL_OK) status = hl_sweep_describe(&sweep, error);
  if (status == HL_OK) status = hl_plan_sweep(&sweep, &planned, error);
  bool done = status == HL_OK;
  if (done && !(hl_gpu_run(renderer->gpu, &planned.sweep) &&
                hl_gpu_read(renderer->gpu, &planned.sweep, sweep.pixels, times))) {
    hl_fail(error, HL_ERROR_UNSUPPORTED, "%s", hl_gpu_problem(renderer->gpu));
    done = false;
  }
  statistics->sheets += planned.plan.sheets;
  hl_plan_release(renderer->context, &planned);
  hl_sweep_end(&sweep);
  hl_release(renderer->context, sweep.shown_from);
  return done;
}

bool hl_make_on_device(hl_renderer *renderer, const frame_request *request, frame_work *work,
                       sweep_of_frame *sweep_of, hl_render_statistics *statistics) {
  const char *wanted = wanted_device(renderer);
  const hl_scene_description *scene = &work->framed.scene;
  hl_render_statistics of_frame = *statistics;
  hl_error error = {0};
  snprintf(statistics->device, sizeof statistics->device, "cpu");
  if (wanted == NULL || strcmp(wanted, "cpu") == 0) return false;
  const char *reason = hl_reason_for_processors(renderer, request, work);
  if (reason == NULL) open_device(renderer);
  if (reason == NULL && renderer->gpu == NULL) reason = renderer->device_problem;
  if (reason != NULL) {
    snprintf(statistics->device_reason, sizeof statistics->device_reason, "%s", reason);
    return false;
  }
  const gpu_volume volume = hl_volume_for_device(&renderer->prepared[0]);
  gpu_times times = {0};
  bool done = hl_gpu_prepare(renderer->gpu, &volume);
  if (!done) hl_fail(&error, HL_ERROR_UNSUPPORTED, "%s", hl_gpu_problem(renderer->gpu));
  for (int s = 0; s < work->sweep_count && done; s++)
    done = run_sweep(renderer, scene, work, s, sweep_of, &times, &of_frame, &error);
  if (!done) {
    give_up(renderer, error.message);
    snprintf(statistics->device_reason, sizeof statistics->device_reason, "%s", renderer->device_problem);
    hl_pool_clear(renderer->pool, work->pixels,
                  (size_t)work->sweep_count * work->tiles * TILE_PIXELS * 4 * sizeof *work->pixels);
    return false;
  }
  *statistics = of_frame;
  snprintf(statistics->device, sizeof statistics->device, "%s", hl_gpu_device(renderer->gpu)->info.name);
  statistics->samples_shaded = times.samples;
  statistics->device_launches = times.launches;
  statistics->seconds_device = times.milliseconds * 1e-3;
  return true;
}
