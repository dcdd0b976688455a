/* render/renderer.c - hl_renderer: brings a scene up to date, lets plan_frame.h plan its frame, lets a back
 * end make the picture of the plan (backend.h), and writes the pixels (target.h). */
#include <stdio.h>
#include <string.h>

#include <halflight/render.h>

#include "core/context.h"
#include "core/door.h"
#include "core/memory.h"
#include "isosurface/isosurface.h"
#include "plan/plan_text.h"
#include "platform/clock.h"
#include "ranks/exchange.h"
#include "render/device_backend.h"
#include "render/estimate.h"
#include "render/plan_frame.h"
#include "render/prepare.h"
#include "render/sky.h"
#include "scatter/scatter.h"
#include "scene/check/check.h"
#include "scene/scene.h"
#include "surface/place_surfaces.h"

hl_status hl_renderer_create(hl_context *context, hl_renderer **renderer, hl_error *error) {
  if (context == NULL || renderer == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_renderer_create: context or renderer is null");
  *renderer = hl_allocate_zeroed(context, 1, sizeof **renderer);
  if (*renderer == NULL) return hl_fail_memory(error, sizeof **renderer, "a renderer");
  (*renderer)->context = (*renderer)->cache.reserve.context = context;
  (*renderer)->parts = 1;
  return HL_OK;
}

/* Reserves the renderer for one frame. Returns false if another frame is being made: then a callback of that
 * frame, or another thread, has asked for this one. */
static bool take(hl_renderer *renderer) { return !atomic_exchange(&renderer->busy, true); }

static hl_status fail_busy(const char *caller, hl_error *error) {
  return hl_fail(error, HL_ERROR_ARGUMENT,
                 "%s: the renderer makes a frame: callbacks and other threads need renderers of their own",
                 caller);
}

hl_status hl_renderer_share(hl_renderer *renderer, int part, int parts, hl_error *error) {
  if (renderer == NULL) return hl_fail(error, HL_ERROR_ARGUMENT, "hl_renderer_share: renderer is null");
  if (atomic_load(&renderer->busy)) return fail_busy("hl_renderer_share", error);
  if (parts < 1 || part < 0 || part >= parts)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "hl_renderer_share: part %d of %d: give 0 to parts - 1 of at least 1", part, parts);
  renderer->part = part;
  renderer->parts = parts;
  renderer->exchange = (light_exchange){0};
  return HL_OK;
}

hl_status hl_renderer_use_device(hl_renderer *renderer, const char *device, hl_error *error) {
  if (renderer == NULL) return hl_fail(error, HL_ERROR_ARGUMENT, "hl_renderer_use_device: renderer is null");
  if (atomic_load(&renderer->busy)) return fail_busy("hl_renderer_use_device", error);
  if (hl_device_choose(renderer, device)) return HL_OK;
  return hl_fail(error, HL_ERROR_ARGUMENT,
                 "hl_renderer_use_device: device: give a name of less than %zu bytes",
                 sizeof renderer->device.wanted);
}

hl_status hl_renderer_share_over_ranks(hl_renderer *renderer, hl_ranks *ranks, hl_error *error) {
  hl_status status = hl_renderer_share(renderer, hl_ranks_rank(ranks), hl_ranks_size(ranks), error);
  if (status == HL_OK) renderer->exchange = hl_ranks_exchange(ranks);
  return status;
}

static void release_volumes(hl_renderer *renderer) {
  for (size_t i = 0; i < renderer->cache.prepared_count; i++)
    hl_prepared_release(renderer->context, &renderer->cache.prepared[i]);
  hl_release(renderer->context, renderer->cache.prepared);
  hl_device_forget(renderer);
  renderer->cache.prepared = NULL;
  renderer->cache.prepared_count = 0;
}

static void release_renderer(hl_renderer *renderer) {
  hl_device_release(renderer);
  release_volumes(renderer);
  hl_renderer_release_buffers(renderer);
  hl_scatter_release(renderer->context, &renderer->cache.scattered);
  hl_sky_release(renderer->context, &renderer->cache.sky);
  hl_phase_release(renderer->context, &renderer->cache.phases);
  hl_surface_tree_release(renderer->context, &renderer->cache.contact);
  hl_surfaces_release(renderer->context, &renderer->cache.surfaces);
  hl_reserve_release(&renderer->cache.reserve);
  hl_pool_destroy(renderer->pool);
  hl_release(renderer->context, renderer);
}

void hl_renderer_destroy(hl_renderer *renderer) {
  if (renderer == NULL) return;
  atomic_store(&renderer->abandoned, true);
  if (take(renderer)) release_renderer(renderer);
}

static void give_back(hl_renderer *renderer) {
  atomic_store(&renderer->busy, false);
  if (atomic_load(&renderer->abandoned) && take(renderer)) release_renderer(renderer);
}

/* ---- a frame ---- */

/* Starts the threads, and allocates memory for the scene's volumes and lights. */
static hl_status make_room(hl_renderer *renderer, const hl_scene_description *scene, hl_error *error) {
  hl_context *context = renderer->context;
  if (renderer->pool == NULL || renderer->threads != scene->render.threads ||
      !hl_pool_is_own(renderer->pool)) {
    hl_pool_destroy(renderer->pool);
    renderer->pool = NULL;
    hl_status status = hl_pool_create(context, scene->render.threads, &renderer->pool, error);
    if (status != HL_OK) return status;
    renderer->threads = scene->render.threads;
  }
  if (renderer->cache.prepared_count != scene->volume_count) {
    release_volumes(renderer);
    renderer->cache.prepared = hl_allocate_zeroed(context, scene->volume_count,
                                                  sizeof *renderer->cache.prepared);
    if (renderer->cache.prepared == NULL)
      return hl_fail_memory(error, sizeof *renderer->cache.prepared, "the volumes");
    renderer->cache.prepared_count = scene->volume_count;
  }
  if (renderer->cache.buffer_count != LIGHT_SECTORS * scene->light_count) {
    hl_renderer_release_buffers(renderer);
    renderer->cache.buffers = hl_allocate_zeroed(context, LIGHT_SECTORS * scene->light_count,
                                                 sizeof *renderer->cache.buffers);
    if (renderer->cache.buffers == NULL)
      return hl_fail_memory(error, sizeof *renderer->cache.buffers, "the lights");
    renderer->cache.buffer_count = LIGHT_SECTORS * scene->light_count;
  }
  return HL_OK;
}

/* Adds the volumes' isosurfaces to the meshes. An isosurface has its volume's transform and material. */
static void add_isosurfaces(const hl_renderer *renderer, framed_scene *framed) {
  hl_scene_description *scene = &framed->scene;
  for (size_t v = 0; v < scene->volume_count; v++)
    for (size_t i = 0; i < renderer->cache.prepared[v].iso_count; i++) {
      hl_mesh *mesh = renderer->cache.prepared[v].iso[i].mesh;
      if (mesh == NULL) continue;
      framed->meshes[scene->mesh_count] = hl_scene_mesh_of_iso(&scene->volumes[v], i, mesh);
      framed->mesh_objects[scene->mesh_count++] = framed->order->volumes[v] + 1;
    }
}

static hl_status check_volumes_room(hl_renderer *renderer, const hl_scene_description *scene,
                                    const hot_functions *hot, hl_error *error) {
  hl_layout counted = {0};
  hl_prepare_count(scene, renderer->cache.prepared, hot->grid, hl_pool_threads(renderer->pool), &counted);
  return hl_renderer_check_room(renderer, counted.most, error);
}

/* Brings the scene to frame space, and its volumes and isosurfaces up to date. */
static hl_status prepare_scene(hl_renderer *renderer, const frame_request *request, framed_scene *framed,
                               hl_error *error) {
  hl_context *context = renderer->context;
  const hl_scene_description *scene = &framed->scene;
  const hot_functions *hot = hl_hot_functions(context->options.instruction_set);
  hl_status status = hl_framed_scene_create(context, request->scene, framed, error);
  if (status == HL_OK) status = make_room(renderer, scene, error);
  if (status != HL_OK) return status;
  prepared_volume *prepared = renderer->cache.prepared;
  hl_pool_resume(renderer->pool);
  hl_prepared_release_stale(context, scene, prepared);
  status = check_volumes_room(renderer, scene, hot, error);
  if (status == HL_OK)
    status = hl_prepare_volumes(context, renderer->pool, hot, scene, framed->plane_marks, prepared, error);
  if (status == HL_OK) status = hl_prepare_isosurfaces(context, renderer->pool, scene, prepared, error);
  if (status == HL_OK) add_isosurfaces(renderer, framed);
  return status;
}

/* Runs all sweeps of a plan with a back end that is prepared. */
static hl_status run_plan(const backend *backend, hl_renderer *renderer, const frame_plan *plan,
                          frame_target *target, hl_render_statistics *statistics, hl_error *error) {
  const int sweeps = plan->frame.content.point_count > 0 ? plan->sweeps.count : 0;
  hl_status status = HL_OK;
  for (int s = 0; s < sweeps && status == HL_OK; s++)
    status = backend->run(renderer, plan, s, target, statistics, error);
  return status == HL_OK && backend->read != NULL ? backend->read(renderer, plan, target, statistics, error)
                                                  : status;
}

#define HL_BACKEND(name) &hl_##name##_backend,
static const backend *const backends[] = {HL_BACKENDS};
#undef HL_BACKEND

/* Makes the plan's picture. If a device fails, the processors make the picture, and statistics->device_reason
 * says why. */
static hl_status make_picture(hl_renderer *renderer, const frame_plan *plan, frame_target *target,
                              hl_render_statistics *statistics, hl_error *error) {
  enum { LAST = sizeof backends / sizeof *backends - 1 };
  snprintf(statistics->device, sizeof statistics->device, "cpu");
  for (int i = 0; i < LAST; i++) {
    hl_render_statistics counted = *statistics;
    hl_error why = {0};
    hl_status status = backends[i]->prepare(renderer, plan, target, &why);
    const bool runs = status == HL_OK;
    if (runs) status = run_plan(backends[i], renderer, plan, target, &counted, &why);
    if (status == HL_OK) {
      *statistics = counted;
      return HL_OK;
    }
    snprintf(statistics->device_reason, sizeof statistics->device_reason, "%.390s", why.message);
    if (runs) hl_frame_target_clear(renderer, plan, target);
  }
  hl_status status = backends[LAST]->prepare(renderer, plan, target, error);
  return status == HL_OK ? run_plan(backends[LAST], renderer, plan, target, statistics, error) : status;
}

static void count_frame(const hl_renderer *renderer, const frame_plan *plan,
                        hl_render_statistics *statistics) {
  statistics->sweeps = plan->sweeps.count;
  statistics->threads = hl_pool_threads(renderer->pool);
  statistics->instruction_set = renderer->context->options.instruction_set;
  for (int i = 0; i < plan->volumes.count; i++) {
    statistics->voxels_total += hl_volume_voxel_count(plan->volumes.list[i].volume);
    statistics->voxels_kept += renderer->cache.prepared[i].grid.kept_voxels;
  }
}

/* The data of one frame; they are released when the frame ends. */
typedef struct frame_work {
  framed_scene framed;
  frame_plan plan;
  frame_target target;
} frame_work;

static hl_status plan_frame(hl_renderer *renderer, const frame_request *request, frame_work *work,
                            hl_error *error) {
  renderer->estimate = 0;
  hl_status status = prepare_scene(renderer, request, &work->framed, error);
  return status == HL_OK ? hl_plan_frame(renderer, &work->framed, request, &work->plan, error) : status;
}

static hl_status render_frame(hl_renderer *renderer, const frame_request *request, frame_work *work,
                              hl_render_statistics *statistics, hl_error *error) {
  double start = hl_clock_seconds();
  hl_status status = plan_frame(renderer, request, work, error);
  if (status == HL_OK) status = hl_frame_target_create(renderer, request, &work->plan, &work->target, error);
  double planned = hl_clock_seconds();
  if (status == HL_OK) status = make_picture(renderer, &work->plan, &work->target, statistics, error);
  if (status != HL_OK) return status;
  hl_frame_target_write(renderer, request, &work->plan, &work->target);
  if (hl_pool_cancelled(renderer->pool))
    return hl_fail(error, HL_ERROR_CANCELLED, "cancelled while rendering");
  statistics->seconds_prepare = planned - start;
  statistics->seconds_render = hl_clock_seconds() - planned;
  count_frame(renderer, &work->plan, statistics);
  hl_progress(renderer->context, "render", 1);
  return HL_OK;
}

static void release_work(hl_renderer *renderer, frame_work *work) {
  hl_frame_target_release(renderer, &work->target);
  hl_frame_plan_release(renderer->context, &work->plan);
  hl_framed_scene_release(renderer->context, &work->framed);
  hl_reserve_end_frame(&renderer->cache.reserve);
}

static hl_status check_request(const hl_renderer *renderer, const hl_scene *scene, const float *pixels,
                               size_t row_stride, const hl_layers *layers,
                               const hl_render_statistics *statistics, hl_error *error) {
  if (renderer == NULL || scene == NULL || pixels == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_renderer_render: renderer, scene or pixels is null");
  const hl_scene_description *description = hl_scene_describe(scene);
  if (row_stride < 4 * (size_t)description->width)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "hl_renderer_render: row_stride is %zu, a row of %d pixels has %zu floats", row_stride,
                   description->width, 4 * (size_t)description->width);
  if (statistics != NULL && statistics->struct_size != sizeof *statistics)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "hl_renderer_render: statistics->struct_size is %zu, expected %zu",
                   statistics->struct_size, sizeof *statistics);
  if (layers != NULL && renderer->parts > 1)
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "hl_renderer_render_layers: part %d of %d of a picture has no layers", renderer->part,
                   renderer->parts);
  return hl_layers_check(layers, description, error);
}

hl_status hl_renderer_render_layers(hl_renderer *renderer, const hl_scene *scene, float *pixels,
                                    size_t row_stride, const hl_layers *layers,
                                    hl_render_statistics *statistics, hl_error *error) {
  HL_DOOR;
  hl_status status = check_request(renderer, scene, pixels, row_stride, layers, statistics, error);
  if (status != HL_OK) return status;
  if (!take(renderer)) return fail_busy("hl_renderer_render", error);
  hl_render_statistics counted = {.struct_size = sizeof counted};
  frame_work work = {0};
  const frame_request request = {scene, layers, pixels, row_stride};
  status = render_frame(renderer, &request, &work, &counted, error);
  release_work(renderer, &work);
  if (status == HL_OK && statistics != NULL) *statistics = counted;
  if (status == HL_OK && renderer->parts <= 1) status = hl_scene_show_sky(scene, pixels, row_stride, error);
  give_back(renderer);
  return status;
}

hl_status hl_renderer_render(hl_renderer *renderer, const hl_scene *scene, float *pixels, size_t row_stride,
                             hl_render_statistics *statistics, hl_error *error) {
  HL_DOOR;
  return hl_renderer_render_layers(renderer, scene, pixels, row_stride, NULL, statistics, error);
}

hl_status hl_renderer_plan(hl_renderer *renderer, const hl_scene *scene, char **text, hl_error *error) {
  HL_DOOR;
  if (renderer == NULL || scene == NULL || text == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_renderer_plan: renderer, scene or text is null");
  *text = NULL;
  if (!take(renderer)) return fail_busy("hl_renderer_plan", error);
  frame_work work = {0};
  const frame_request request = {.scene = scene};
  hl_status status = plan_frame(renderer, &request, &work, error);
  if (status == HL_OK) status = hl_plan_text(renderer->context, &work.plan, text, error);
  release_work(renderer, &work);
  give_back(renderer);
  return status;
}

/* ---- how a scene wants its pictures written ---- */

void hl_scene_write_options(const hl_scene *scene, hl_image_write_options *options) {
  const hl_scene_description *description = hl_scene_describe(scene);
  hl_image_write_options_defaults(options);
  if (options == NULL || description == NULL) return;
  memcpy(options->background, description->background, sizeof options->background);
  options->background_transparent = description->background_transparent;
  options->exposure = description->exposure;
  options->tone = description->tone;
  options->field_errors = scene->field_errors;
}
