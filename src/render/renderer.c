/* render/renderer.c - hl_renderer: prepares a scene, has the frame set up (frame_work.h), runs its sweeps one
 * after the other, writes the pixels. */
#include <string.h>

#include <halflight/render.h>

#include "core/context.h"
#include "core/door.h"
#include "core/memory.h"
#include "isosurface/isosurface.h"
#include "ranks/ranks.h"
#include "render/device_frame.h"
#include "render/estimate.h"
#include "render/frame_work.h"
#include "render/maximum.h"
#include "render/picture.h"
#include "render/prepare.h"
#include "render/sky.h"
#include "scatter/scatter.h"
#include "scene/check.h"
#include "surface/place_surfaces.h"

uint64_t hl_renderer_estimate(const hl_renderer *renderer) { return renderer->estimate; }

hl_status hl_renderer_create(hl_context *context, hl_renderer **renderer, hl_error *error) {
  if (context == NULL || renderer == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_renderer_create: context or renderer is null");
  *renderer = hl_allocate_zeroed(context, 1, sizeof **renderer);
  if (*renderer == NULL) return hl_fail_memory(error, sizeof **renderer, "a renderer");
  (*renderer)->context = (*renderer)->reserve.context = context;
  (*renderer)->parts = 1;
  return HL_OK;
}

/* False if a frame is under way: a callback of its own call, or another thread, wants another one. */
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

void hl_renderer_exchange(hl_renderer *renderer, const light_exchange *exchange) {
  renderer->part = exchange->part;
  renderer->parts = exchange->parts;
  renderer->exchange = *exchange;
}

hl_status hl_renderer_use_device(hl_renderer *renderer, const char *device, hl_error *error) {
  if (renderer == NULL) return hl_fail(error, HL_ERROR_ARGUMENT, "hl_renderer_use_device: renderer is null");
  if (atomic_load(&renderer->busy)) return fail_busy("hl_renderer_use_device", error);
  if (hl_device_choose(renderer, device)) return HL_OK;
  return hl_fail(error, HL_ERROR_ARGUMENT,
                 "hl_renderer_use_device: device: give a name of less than %zu bytes",
                 sizeof renderer->device);
}

static void gather_from_ranks(void *data, const void *from, size_t bytes, void *to) {
  hl_ranks_gather(data, from, bytes, to);
}

static void send_to_ranks(void *data, const light_post *post) {
  hl_ranks_send(data, post->from, post->bytes, post->to, post->most, post->memory);
}

static void look_at_ranks(void *data, const light_post *post) { hl_ranks_look(data, post->memory); }

static void receive_from_ranks(void *data, const light_post *post) { hl_ranks_receive(data, post->memory); }

hl_status hl_renderer_share_over_ranks(hl_renderer *renderer, hl_ranks *ranks, hl_error *error) {
  hl_status status = hl_renderer_share(renderer, hl_ranks_rank(ranks), hl_ranks_size(ranks), error);
  if (status == HL_OK && hl_ranks_size(ranks) > 1)
    renderer->exchange = (light_exchange){
        .part = renderer->part,
        .parts = renderer->parts,
        .gather = gather_from_ranks,
        .data = ranks,
        .send = send_to_ranks,
        .look = look_at_ranks,
        .receive = receive_from_ranks,
        .post_bytes = 2 * (size_t)hl_ranks_size(ranks) * sizeof(mpi_handle)};
  return status;
}

static void release_volumes(hl_renderer *renderer) {
  for (size_t i = 0; i < renderer->prepared_count; i++)
    hl_prepared_release(renderer->context, &renderer->prepared[i]);
  hl_release(renderer->context, renderer->prepared);
  hl_device_forget(renderer);
  renderer->prepared = NULL;
  renderer->prepared_count = 0;
}

static void release_buffers(hl_renderer *renderer) {
  for (size_t i = 0; i < renderer->buffer_count; i++)
    hl_shadow_buffer_release(renderer->context, &renderer->buffers[i]);
  hl_release(renderer->context, renderer->buffers);
  for (int i = 0; i < FRAME_LIGHTS; i++) {
    hl_release(renderer->context, renderer->shadow_memory[i].planes);
    renderer->shadow_memory[i] = (shadow_memory){0};
  }
  renderer->buffers = NULL;
  renderer->buffer_count = 0;
}

static void release_renderer(hl_renderer *renderer) {
  hl_device_release(renderer);
  release_volumes(renderer);
  release_buffers(renderer);
  hl_scatter_release(renderer->context, &renderer->scattered);
  hl_sky_release(renderer->context, &renderer->sky);
  hl_phase_release(renderer->context, &renderer->phases);
  hl_surface_tree_release(renderer->context, &renderer->contact);
  hl_surfaces_release(renderer->context, &renderer->surfaces);
  hl_reserve_release(&renderer->reserve);
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

/* Starts the threads, and makes room for the scene's volumes and lights. */
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
  if (renderer->prepared_count != scene->volume_count) {
    release_volumes(renderer);
    renderer->prepared = hl_allocate_zeroed(context, scene->volume_count, sizeof *renderer->prepared);
    if (renderer->prepared == NULL) return hl_fail_memory(error, sizeof *renderer->prepared, "the volumes");
    renderer->prepared_count = scene->volume_count;
  }
  if (renderer->buffer_count != LIGHT_SECTORS * scene->light_count) {
    release_buffers(renderer);
    renderer->buffers = hl_allocate_zeroed(context, LIGHT_SECTORS * scene->light_count,
                                           sizeof *renderer->buffers);
    if (renderer->buffers == NULL) return hl_fail_memory(error, sizeof *renderer->buffers, "the lights");
    renderer->buffer_count = LIGHT_SECTORS * scene->light_count;
  }
  return HL_OK;
}

/* The number of channels of light attenuation: three where matter absorbs the colours differently, or where
 * an emission image's colours come from different places; else one. */
static int attenuation_channels(const hl_scene_description *scene) {
  for (size_t i = 0; i < scene->light_count; i++)
    if (hl_light_emission_colored(&scene->lights[i])) return 3;
  for (size_t i = 0; i < scene->volume_count; i++)
    if (scene->volumes[i].casts_shadow && !hl_is_grey(scene->volumes[i].attenuation_color)) return 3;
  for (size_t i = 0; i < scene->mesh_count; i++)
    if (scene->meshes[i].casts_shadow && !hl_is_grey(scene->meshes[i].attenuation_color)) return 3;
  return 1;
}

static sweep sweep_of(hl_renderer *renderer, const hl_scene_description *scene, const frame_work *work,
                      int index) {
  const frame_sweep *geometry = &work->sweeps[index];
  return (sweep){.content = {.context = renderer->context,
                             .pool = renderer->pool,
                             .reserve = &renderer->reserve,
                             .hot = hl_hot_functions(renderer->context->options.instruction_set),
                             .sheets = &geometry->sheets,
                             .volumes = renderer->prepared,
                             .grids = work->grids,
                             .volume_count = (int)scene->volume_count,
                             .kernel = hl_kernel_get(scene->render.kernel),
                             .splat = scene->render.reconstruction == HL_RECONSTRUCTION_SPLAT},
                 .scene = scene,
                 .frame = &work->frame,
                 .geometry = geometry,
                 .act = hl_is_maximum(scene) ? hl_maximum_tile : hl_light_tile,
                 .first = index == 0,
                 .layer_pixels = &work->layers,
                 .scattered = renderer->scattered.light != NULL ? &renderer->scattered : NULL,
                 .sky = renderer->sky.light.cells != NULL ? &renderer->sky.light : NULL,
                 .phases = &renderer->phases,
                 .maximum = &work->maximum,
                 .share = &work->share,
                 .measures = index == work->measuring_sweep,
                 .channels = attenuation_channels(scene),
                 .pixels = work->pixels + (size_t)index * work->tiles * TILE_PIXELS * 4};
}

/* Finds the light that is scattered more than once, where the scene asks for it. */
static hl_status scatter_light(hl_renderer *renderer, const hl_scene_description *scene,
                               const frame_work *work, uint64_t sky_mark, hl_error *error) {
  hl_context *context = renderer->context;
  if (!hl_scatter_wanted(scene)) {
    hl_scatter_release(context, &renderer->scattered);
    return HL_OK;
  }
  scatter_volume *volumes = hl_allocate(context, scene->volume_count, sizeof *volumes);
  if (volumes == NULL) return hl_fail_memory(error, scene->volume_count * sizeof *volumes, "the volumes");
  for (size_t v = 0; v < scene->volume_count; v++)
    volumes[v] = (scatter_volume){&scene->volumes[v], &work->grids[v], &renderer->prepared[v].classifier};
  const scatter_scene all = {context, renderer->pool, scene, volumes, sky_mark, work->frame.surfaces};
  hl_layout counted = {0};
  hl_scatter_count(&all, &counted);
  hl_status status = hl_renderer_check_room(renderer, counted.most, error);
  if (status == HL_OK) status = hl_scatter_update(&all, &renderer->scattered, error);
  hl_release(context, volumes);
  return status;
}

/* Bytes of shadow buffers that the renderer holds from the frame before. */
static uint64_t kept_buffers(const hl_renderer *renderer) {
  uint64_t bytes = 0;
  for (size_t i = 0; i < renderer->buffer_count; i++) bytes += renderer->buffers[i].capacity;
  for (int i = 0; i < FRAME_LIGHTS; i++) bytes += renderer->shadow_memory[i].capacity;
  return bytes;
}

/* Refuses a frame whose sweeps cannot fit, before the first sheet. The picture is allocated already. */
static hl_status check_sweeps_room(hl_renderer *renderer, const hl_scene_description *scene,
                                   const frame_work *work, hl_error *error) {
  hl_context *context = renderer->context;
  if (work->frame.point_count == 0) return HL_OK;
  vec3 *points = hl_allocate(context, (size_t)work->frame.point_count / 8 * CONTENT_POINTS + 1,
                             sizeof *points);
  sweeps_memory memory = {0};
  hl_status status = HL_OK;
  if (points == NULL) return hl_fail_memory(error, sizeof *points, "the content's corners");
  for (int s = 0; s < work->sweep_count && status == HL_OK; s++) {
    sweep counted = sweep_of(renderer, scene, work, s);
    status = hl_sweep_count_memory(&counted, points, &memory, error);
  }
  uint64_t needed = hl_sweeps_bytes(&memory), kept = kept_buffers(renderer);
  hl_release(context, points);
  if (status != HL_OK) return status;
  return hl_renderer_check_room(renderer, needed > kept ? needed - kept : 0, error);
}

static hl_status run_sweep(hl_renderer *renderer, const hl_scene_description *scene, frame_work *work,
                           int index, hl_render_statistics *statistics, hl_error *error) {
  sweep sweep = sweep_of(renderer, scene, work, index);
  hl_status status = sweep.geometry->back_to_front ? hl_sweep_find_hidden(&sweep, statistics, error) : HL_OK;
  if (status == HL_OK) status = hl_sweep_begin(&sweep, renderer->buffers, renderer->shadow_memory, error);
  if (status == HL_OK) status = hl_sweep_run(&sweep, error);
  if (status == HL_OK) hl_sweep_count(&sweep, statistics);
  hl_sweep_end(&sweep);
  hl_release(renderer->context, sweep.shown_from);
  return status;
}

static hl_status run_sweeps(hl_renderer *renderer, const hl_scene_description *scene, frame_work *work,
                            hl_render_statistics *statistics, hl_error *error) {
  hl_status status = check_sweeps_room(renderer, scene, work, error);
  for (int s = 0; s < work->sweep_count && status == HL_OK && work->frame.point_count > 0; s++)
    status = run_sweep(renderer, scene, work, s, statistics, error);
  return status;
}

static void write_picture(const frame_work *work, const frame_request *request,
                          const hl_scene_description *scene, hl_pool *pool) {
  const picture picture = {.tiles = work->pixels,
                           .sweeps = work->sweep_count,
                           .tiles_x = work->tiles_x,
                           .tiles_of_sweep = work->tiles,
                           .oversampling = work->frame.oversampling,
                           .pixels = request->pixels,
                           .row_stride = request->row_stride,
                           .width = scene->width,
                           .height = scene->height};
  if (work->in_place) hl_picture_reorder(&picture, work->tile_rows, pool);
  else hl_picture_write(&picture, pool);
}

static void write_layers(const frame_work *work, const hl_scene_description *scene, hl_pool *pool) {
  const layer_grid grid = {scene->width, scene->height, work->frame.oversampling, work->tiles_x,
                           (float)work->framed.unit};
  hl_layer_pixels_write(&work->layers, &grid, pool);
}

/* Adds the volumes' isosurfaces to the meshes. They have their volume's transform and material. */
static void add_isosurfaces(const hl_renderer *renderer, framed_scene *framed) {
  hl_scene_description *scene = &framed->scene;
  for (size_t v = 0; v < scene->volume_count; v++)
    for (size_t i = 0; i < renderer->prepared[v].iso_count; i++) {
      hl_mesh *mesh = renderer->prepared[v].iso[i].mesh;
      if (mesh == NULL) continue;
      framed->meshes[scene->mesh_count] = hl_scene_mesh_of_iso(&scene->volumes[v], i, mesh);
      framed->mesh_objects[scene->mesh_count++] = framed->order->volumes[v] + 1;
    }
}

static hl_status check_sky_room(void *data, uint64_t bytes, hl_error *error) {
  return hl_renderer_check_room(data, bytes, error);
}

static hl_status update_sky(hl_renderer *renderer, const hl_scene_description *scene, const frame_work *work,
                            const hot_functions *hot, uint64_t mark, hl_error *error) {
  const frame_sky of = {scene, renderer->prepared, work->grids, &work->frame, mark, work->share.exchange};
  return hl_frame_sky_update(renderer->context, renderer->pool, hot, &of,
                             &(sky_room){check_sky_room, renderer}, &renderer->sky, error);
}

static hl_status update_phases(hl_renderer *renderer, const hl_scene_description *scene, hl_error *error) {
  hl_layout counted = {0};
  hl_phase_count(scene, &counted);
  uint64_t bytes = counted.bytes, held = renderer->phases.bytes;
  hl_status status = bytes > held ? hl_renderer_check_room(renderer, bytes - held, error) : HL_OK;
  if (status != HL_OK) return status;
  return hl_phase_update(renderer->context, renderer->pool, scene, &renderer->phases, error);
}

static hl_status check_volumes_room(hl_renderer *renderer, const hl_scene_description *scene,
                                    const hot_functions *hot, hl_error *error) {
  hl_layout counted = {0};
  hl_prepare_count(scene, renderer->prepared, &hot->grid, hl_pool_threads(renderer->pool), &counted);
  return hl_renderer_check_room(renderer, counted.most, error);
}

static hl_status render_frame(hl_renderer *renderer, const frame_request *request, frame_work *work,
                              hl_render_statistics *statistics, hl_error *error) {
  double start = hl_clock_seconds();
  const hl_scene_description *scene = &work->framed.scene;
  hl_status status = hl_framed_scene_create(renderer->context, request->world, request->order, &work->framed,
                                            error);
  if (status == HL_OK) status = make_room(renderer, scene, error);
  if (status == HL_OK) hl_pool_resume(renderer->pool);
  renderer->estimate = 0;
  const hot_functions *hot = hl_hot_functions(renderer->context->options.instruction_set);
  if (status == HL_OK) hl_prepared_release_stale(renderer->context, scene, renderer->prepared);
  if (status == HL_OK) status = check_volumes_room(renderer, scene, hot, error);
  if (status == HL_OK)
    status = hl_prepare_volumes(renderer->context, renderer->pool, hot, scene, renderer->prepared, error);
  if (status == HL_OK)
    status = hl_prepare_isosurfaces(renderer->context, renderer->pool, scene, renderer->prepared, error);
  if (status == HL_OK) add_isosurfaces(renderer, &work->framed);
  if (status == HL_OK) status = hl_frame_work_set_up(renderer, scene, request, work, error);
  if (status == HL_OK) status = scatter_light(renderer, scene, work, request->sky_mark, error);
  if (status == HL_OK) status = update_sky(renderer, scene, work, hot, request->sky_mark, error);
  if (status == HL_OK) status = update_phases(renderer, scene, error);
  statistics->seconds_prepare = hl_clock_seconds() - start;
  start = hl_clock_seconds();
  if (status == HL_OK && !hl_make_on_device(renderer, request, work, sweep_of, statistics))
    status = run_sweeps(renderer, scene, work, statistics, error);
  if (status != HL_OK) return status;
  if (work->maximum.values != NULL)
    hl_maximum_color(&work->maximum, scene, renderer->prepared, renderer->pool, work->pixels);
  write_picture(work, request, scene, renderer->pool);
  write_layers(work, scene, renderer->pool);
  if (hl_pool_cancelled(renderer->pool))
    return hl_fail(error, HL_ERROR_CANCELLED, "cancelled while rendering");
  statistics->seconds_render = hl_clock_seconds() - start;
  statistics->sweeps = work->sweep_count;
  statistics->threads = hl_pool_threads(renderer->pool);
  statistics->instruction_set = renderer->context->options.instruction_set;
  for (size_t i = 0; i < scene->volume_count; i++) {
    statistics->voxels_total += hl_volume_voxel_count(scene->volumes[i].volume);
    statistics->voxels_kept += renderer->prepared[i].grid.kept_voxels;
  }
  hl_progress(renderer->context, "render", 1);
  return HL_OK;
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
  const frame_request request = {&scene->placed, &scene->order, scene->sky_mark, layers, pixels, row_stride};
  status = render_frame(renderer, &request, &work, &counted, error);
  hl_frame_work_release(renderer, &work);
  hl_reserve_end_frame(&renderer->reserve);
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

/* ---- how a scene wants its pictures written ---- */

void hl_scene_write_options(const hl_scene *scene, hl_image_write_options *options) {
  const hl_scene_description *description = hl_scene_describe(scene);
  hl_image_write_options_defaults(options);
  if (options == NULL || description == NULL) return;
  memcpy(options->background, description->background, sizeof options->background);
  options->background_transparent = description->background_transparent;
  options->exposure = description->exposure;
  options->tone = description->tone;
}
