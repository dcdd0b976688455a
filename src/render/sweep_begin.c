/* render/sweep_begin.c - begins a sweep (steps 1 to 4): makes its views, sorts voxels, allocates memory and
 * fills shadow buffers with full light. */
#include <math.h>
#include <string.h>

#include <halflight/render.h>

#include "core/memory.h"
#include "core/sheet_constants.h"
#include "grid/faces.h"
#include "platform/clock.h"
#include "render/light_reads.h"
#include "render/maximum.h"
#include "render/sweep_layers.h"
#include "render/sweep_surfaces.h"

/* Opens the blocks of the picture that belong to this sweep's part. Blocks outside the picture and blocks of
 * other parts are closed. */
void hl_sweep_open(sweep *sweep) {
  for (size_t tile = 0; tile < sweep->frame_plan->picture.tiles; tile++) {
    uint32_t open = 0;
    int x0 = hl_tile_x(sweep, tile) * TILE, y0 = hl_tile_y(sweep, tile) * TILE;
    for (int block = 0; block < TILE_BLOCKS; block++) {
      int x = x0 + block % 4 * BLOCK, y = y0 + block / 4 * BLOCK;
      if (x < sweep->frame->width && y < sweep->frame->height) open |= 1u << block;
    }
    if (!hl_share_has(sweep->share, hl_tile_x(sweep, tile), hl_tile_y(sweep, tile))) open = 0;
    sweep->arrays.open[tile] = (uint16_t)open;
  }
}

static void end_light(const sweep *sweep, sweep_light *light) {
  hl_context *context = sweep->content.context;
  hl_view_sheets_end(&light->sheets);
  hl_light_texture_release(context, &light->texture);
  hl_light_shadow_end(&light->shadow);
  hl_release(context, light->reads);
}

/* ---- how long stretches are ---- */

/* A stretch has LONGEST_STRETCH slabs if nothing limits it (measured: docs/laboratory/threads.md). The planes
 * that all lights of a frame keep for a stretch take at most RING_BYTES. With one thread, no thread waits for
 * another, so the work on picture and lights alternates slab by slab. */
enum { LONGEST_STRETCH = 8 };
static const uint64_t RING_BYTES = 64 << 20;

/* Decides how many slabs a stretch has, and how many sheets the lights' buffers keep. */
static void choose_stretch(sweep *sweep) {
  int wanted = sweep->frame_plan->settings.slabs_at_once, stretch = wanted > 0 ? wanted : LONGEST_STRETCH;
  uint64_t bytes = 0, budget = RING_BYTES * (uint64_t)sweep->geometry->light_count /
                               (uint64_t)(sweep->frame->light_count > 0 ? sweep->frame->light_count : 1);
  for (int i = 0; i < sweep->geometry->light_count; i++) {
    const light_shadow *shadow = &sweep->lights[i].shadow;
    if (shadow->method == NULL) continue;
    const shadow_buffer_size size = hl_light_shadow_buffer_size(shadow, 1);
    bytes += hl_shadow_sheet_bytes(&size);
    if (!hl_runs_in_stretches(shadow->method)) stretch = 1;
  }
  if (wanted == 0 && hl_pool_threads(sweep->content.pool) == 1) stretch = 1;
  while (wanted == 0 && stretch > 1 && (2 * (uint64_t)stretch + 1) * bytes > budget) stretch--;
  sweep->content.stretch = stretch;
  sweep->loop.ring = stretch == 1 ? 1 : 2 * stretch + 1;
}

void hl_sweep_set_up(sweep *sweep, const sweep_means *means, const frame_plan *frame_plan,
                     const sweep_plan *plan, const sweep_target *target) {
  const plan_volumes *volumes = &frame_plan->volumes;
  *sweep = (struct sweep){
      .frame_plan = frame_plan,
      .plan = plan,
      .geometry = plan->geometry,
      .frame = &frame_plan->frame,
      .share = &frame_plan->picture.share,
      .content = {.context = means->context,
                  .pool = means->pool,
                  .reserve = means->reserve,
                  .hot = means->hot,
                  .sheets = &plan->geometry->sheets,
                  .volumes = volumes->list,
                  .grids = volumes->grids,
                  .volume_count = volumes->count,
                  .kernel = volumes->kernel,
                  .splat = volumes->splat},
      .target = *target,
      .act = {.run = hl_is_maximum(&frame_plan->settings) ? hl_maximum_tile : hl_light_tile}};
  for (int i = 0; i < plan->geometry->light_count; i++) {
    sweep->lights[i] = (sweep_light){.source = plan->lights[i].source, .shadow = plan->lights[i].shadow};
    sweep->lights[i].shadow.state = NULL; /* the plan has this state */
  }
  choose_stretch(sweep);
}

/* ---- memory ---- */

/* Counts the memory that begin_light() takes. */
static void count_light(sweep *sweep, int index, sweeps_memory *memory) {
  const light_shadow *shadow = &sweep->lights[index].shadow;
  hl_layout *passing = &memory->passing;
  if (shadow->method == NULL) return;
  const shadow_buffer_size size = hl_light_shadow_buffer_size(shadow, sweep->loop.ring);
  const shadow_layouts of_method = sweep->plan->lights[index].memory;
  hl_shadow_buffer_count(&size, &memory->buffers);
  if (of_method.kept.bytes > memory->kept[index]) memory->kept[index] = of_method.kept.bytes;
  hl_layout_take(passing, of_method.passing.bytes, 1);
  hl_layout_take(passing, 1, shadow->method->state_bytes);
  hl_layout_take(passing, (size_t)sweep->loop.ring, sizeof *shadow->lookups);
  hl_view_sheets_count(&sweep->content, &shadow->plan.view, shadow->plan.spare, passing);
}

/* The number of tiles of the picture, and of the buffers of the lights that cast shadows and are planned. */
static size_t count_tasks(const sweep *sweep) {
  size_t tasks = sweep->frame_plan->picture.tiles;
  for (int i = 0; i < sweep->geometry->light_count; i++)
    if (sweep->lights[i].shadow.method != NULL) tasks += hl_view_tiles(&sweep->lights[i].shadow.plan.view);
  return tasks;
}

static void lay_out(sweep *sweep, hl_layout *layout) {
  size_t threads = (size_t)hl_pool_threads(sweep->content.pool);
  size_t volumes = (size_t)sweep->content.volume_count, places = threads * volumes;
  sweep->arrays.open = hl_layout_take(layout, sweep->frame_plan->picture.tiles, sizeof *sweep->arrays.open);
  sweep->arrays.tasks = hl_layout_take(layout, count_tasks(sweep), sizeof *sweep->arrays.tasks);
  size_t stretch = (size_t)sweep->content.stretch, lights = (size_t)sweep->geometry->light_count;
  sweep->arrays.slab_shades = hl_layout_take(layout, stretch, sizeof *sweep->arrays.slab_shades);
  sweep->arrays.slab_attenuates = hl_layout_take(layout, lights * stretch,
                                                 sizeof *sweep->arrays.slab_attenuates);
  sweep->arrays.shade_patches = hl_layout_take(layout, places, sizeof *sweep->arrays.shade_patches);
  sweep->arrays.scratch = hl_layout_take(layout, places, SHADE_SCRATCH_BYTES);
  sweep->arrays.scratch_volumes = hl_layout_take(layout, places, sizeof *sweep->arrays.scratch_volumes);
  hl_sweep_constants_lay_out(sweep->frame_plan, &sweep->constants, layout);
  sweep->arrays.counts = hl_layout_take(layout, threads, sizeof *sweep->arrays.counts);
}

void hl_sweep_count_memory(sweep *sweep, sweeps_memory *memory) {
  hl_layout *passing = &memory->passing;
  hl_view_sheets_count(&sweep->content, &sweep->frame->eye, PIXEL_TO_SPARE, passing);
  if (sweep->geometry->back_to_front)
    hl_layout_take(passing, sweep->frame_plan->picture.tiles * TILE_BLOCKS, sizeof *sweep->target.shown_from);
  for (int i = 0; i < sweep->geometry->light_count; i++) count_light(sweep, i, memory);
  lay_out(sweep, passing);
  hl_sweep_layers_count(sweep, passing);
  hl_light_reads_count(sweep, passing);
  hl_sweep_surfaces_count(sweep, passing);
  hl_layout_give_back(passing, 0);
}

/* ---- begin and end ---- */

static hl_status begin_light(sweep *sweep, int index, shadow_buffer *buffer, shadow_memory *memory,
                             hl_error *error) {
  const sheet_content *content = &sweep->content;
  const texture_use use = hl_texture_use(sweep->frame);
  const light_shadow *planned = &sweep->plan->lights[index].shadow;
  const shadow_means means = {content->pool, content->reserve, content->hot->shadow};
  sweep_light *light = &sweep->lights[index];
  light_shadow *shadow = &light->shadow;
  hl_status status = hl_light_texture_create(content->context, light->source, &use, &light->texture, error);
  if (status != HL_OK || planned->method == NULL) return status;
  status = hl_light_shadow_begin(shadow, planned, &means, sweep->loop.ring, buffer, memory, error);
  if (status == HL_OK)
    status = hl_view_sheets_begin(content, &shadow->plan.view, true, shadow->plan.spare, &light->sheets,
                                  error);
  return status;
}

static hl_status allocate(sweep *sweep, hl_error *error) {
  hl_layout layout = {0};
  while (hl_layout_pass(&layout, sweep->content.context)) lay_out(sweep, &layout);
  sweep->arrays.memory = layout.base;
  if (layout.base == NULL) return hl_fail_memory(error, layout.bytes, "the sheet loop");
  memset(sweep->arrays.counts, 0,
         (size_t)hl_pool_threads(sweep->content.pool) * sizeof *sweep->arrays.counts);
  return HL_OK;
}

/* Connects a light's texture and shadow buffer to the constants of all slabs. */
static void connect_light(sweep *sweep, int index) {
  const light_shadow *shadow = &sweep->lights[index].shadow;
  shade_light *light = &sweep->constants.lights[index];
  light->texture = sweep->lights[index].texture;
  if (shadow->buffer == NULL) return;
  light->channels = shadow->buffer->channels;
  light->lookups = shadow->lookups;
  light->sublights = shadow->sublights;
  light->sublight_count = shadow->sublight_count;
  sweep->constants.attenuate[index].stride = shadow->buffer->stride;
}

/* If a ray of a light rises by less than this fraction of its length, it counts as running along the
 * sheets. */
static const double LEAST_CLIMB = 0.05;

/* The least rise, per unit of length, of a light's rays within the content. All directions within some angle
 * of the normal form a cone, so the ray with the least rise leads to one of the content's corners. */
static double least_climb(const sweep *sweep, const light_source *source) {
  vec3 normal = sweep->geometry->sheets.normal;
  if (source->parallel) return vec3_dot(source->direction, normal);
  double least = 1;
  for (int i = 0; i < sweep->frame->content.point_count; i++)
    least = fmin(
        least,
        vec3_dot(vec3_normalise(vec3_subtract(sweep->frame->content.points[i], source->position)), normal));
  return least;
}

static double longest_way(const sweep *sweep) {
  double least = 1;
  for (int i = 0; i < sweep->geometry->light_count; i++)
    if (sweep->lights[i].shadow.method != NULL)
      least = fmin(least, least_climb(sweep, sweep->lights[i].source));
  return least < LEAST_CLIMB ? INFINITY : sweep->geometry->sheets.spacing / least;
}

/* The distance within which faces that cut volumes decide which matter is a surface for the lights. */
static double reach_of_faces(const sweep *sweep) {
  double greatest = 0;
  for (int g = 0; g < sweep->content.volume_count; g++)
    greatest = fmax(greatest, hl_smallest_edge(&sweep->content.grids[g]));
  return (double)FACE_VOXELS * greatest;
}

static hl_status begin_views(sweep *sweep, shadow_buffer *buffers, shadow_memory *memory, hl_error *error) {
  hl_status status = hl_view_sheets_begin(&sweep->content, &sweep->frame->eye, false, PIXEL_TO_SPARE,
                                          &sweep->image, error);
  for (int i = 0; i < sweep->geometry->light_count && status == HL_OK; i++)
    status = begin_light(sweep, i, &buffers[sweep->geometry->light[i]], &memory[i], error);
  return status;
}

hl_status hl_sweep_begin(sweep *sweep, shadow_buffer *buffers, shadow_memory *memory, hl_error *error) {
  double start = hl_clock_seconds();
  hl_status status = begin_views(sweep, buffers, memory, error);
  if (status == HL_OK) status = allocate(sweep, error);
  if (status != HL_OK) return status;
  hl_sweep_open(sweep);
  hl_sweep_constants_find(sweep->frame_plan, sweep->plan, &sweep->constants);
  for (int i = 0; i < sweep->geometry->light_count; i++) connect_light(sweep, i);
  sweep->image.beside = longest_way(sweep);
  for (int i = 0; i < sweep->geometry->light_count; i++) {
    const shadow_buffer *buffer = sweep->lights[i].shadow.buffer;
    if (buffer != NULL && buffer->has_outside) sweep->lights[i].sheets.beside = reach_of_faces(sweep);
  }
  status = hl_sweep_layers_begin(sweep, error);
  if (status == HL_OK) status = hl_sweep_surfaces_begin(sweep, error);
  if (status == HL_OK) status = hl_light_reads_find(sweep, error);
  if (status == HL_OK) status = hl_sweep_surfaces_begin_lights(sweep, error);
  if (status == HL_OK) status = hl_light_reads_find_owned(sweep, error);
  sweep->loop.times.seconds_sort = hl_clock_seconds() - start;
  return status;
}

void hl_sweep_end(sweep *sweep) {
  hl_context *context = sweep->content.context;
  hl_sweep_layers_end(sweep);
  hl_sweep_surfaces_end(sweep);
  for (int i = 0; i < FRAME_LIGHTS; i++) end_light(sweep, &sweep->lights[i]);
  hl_view_sheets_end(&sweep->image);
  hl_release(context, sweep->arrays.memory);
}

/* ---- the counts of work ---- */

void hl_sweep_count(const sweep *sweep, hl_render_statistics *statistics) {
  double fill = 0, shade = 0, light = 0, composite = 0;
  for (int i = 0; i < hl_pool_threads(sweep->content.pool); i++) {
    statistics->samples_shaded += sweep->arrays.counts[i].samples;
    statistics->tiles_filled_image += sweep->arrays.counts[i].filled_image;
    statistics->tiles_filled_light += sweep->arrays.counts[i].filled_light;
    statistics->tiles_skipped_image += sweep->arrays.counts[i].skipped_image;
    statistics->tiles_skipped_light += sweep->arrays.counts[i].skipped_light;
    statistics->pixels_filled_image += sweep->arrays.counts[i].pixels_image;
    statistics->pixels_filled_light += sweep->arrays.counts[i].pixels_light;
    statistics->pixels_skipped_image += sweep->arrays.counts[i].pixels_skipped_image;
    statistics->pixels_skipped_light += sweep->arrays.counts[i].pixels_skipped_light;
    fill += sweep->arrays.counts[i].seconds_fill;
    shade += sweep->arrays.counts[i].seconds_shade;
    light += sweep->arrays.counts[i].seconds_light;
    composite += sweep->arrays.counts[i].seconds_composite;
  }
  if (sweep->act.purpose == SWEEP_PICTURE) statistics->sheets += sweep->geometry->sheets.count;
  statistics->seconds_sort += sweep->loop.times.seconds_sort;
  double all = fill + shade + light, share = all > 0 ? sweep->loop.times.seconds_tiles / all : 0;
  statistics->seconds_fill_image += fill * share;
  statistics->seconds_shade += shade * share;
  statistics->seconds_fill_light += light * share;
  statistics->seconds_composite_light += composite * share;
  statistics->waits += sweep->loop.times.waits;
  statistics->seconds_soften += sweep->loop.times.seconds_soften;
}
