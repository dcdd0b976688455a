/* render/sweep_begin.c - steps 1 to 4: views, sorting, memory, full light. */
#define _POSIX_C_SOURCE 200809L /* clock_gettime */
#include <math.h>
#include <string.h>
#include <time.h>

#include <halflight/render.h>

#include "core/memory.h"
#include "grid/relevant.h"
#include "image/srgb.h"
#include "render/light_reads.h"
#include "render/sweep_layers.h"
#include "render/sweep_surfaces.h"
#include "scene/light_kind.h"
#include "volume/colors.h"

enum { SRGB_CODES = 256 };

/* Blocks outside the picture, and those of other parts, are closed from the start. */
void hl_sweep_open(sweep *sweep) {
  for (size_t tile = 0; tile < sweep->tiles; tile++) {
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

/* seen: [seen_count] corners of what the eye sees. image: null where the light is even. */
/* Whether some volume that the eye sees has surfaces on which shadows fall. */
static bool has_surfaces(const sheet_content *content) {
  for (int v = 0; v < content->volume_count; v++) {
    const hl_scene_volume *volume = content->volumes[v].scene;
    if (volume->visible && volume->receives_shadow && volume->shading == HL_SHADING_PHONG) return true;
  }
  return false;
}

static shadow_setup setup_of_light(const sweep *sweep, const light_source *source, light_emission *emission,
                                   const vec3 *seen, int seen_count) {
  const frame *frame = sweep->frame;
  return (shadow_setup){.context = sweep->content.context,
                        .pool = sweep->content.pool,
                        .reserve = sweep->content.reserve,
                        .functions = &sweep->content.hot->shadow,
                        .settings = &sweep->scene->render,
                        .source = source,
                        .emission = emission == NULL || emission->even ? NULL : emission,
                        .sheets = &sweep->geometry->sheets,
                        .eye = &frame->eye,
                        .exchange = sweep->share->exchange,
                        .surfaces = has_surfaces(&sweep->content),
                        .channels = sweep->channels,
                        .voxel = frame->voxel,
                        .pixel = frame->pixel,
                        .middle_pixel = frame->middle_pixel,
                        .picture_pixels = (size_t)frame->width * (size_t)frame->height,
                        .seen = seen,
                        .seen_count = seen_count,
                        .content = frame->points,
                        .content_count = frame->point_count};
}

/* points: room for the corners of what the eye sees; must stay until the light's shadows have begun. */
static hl_status plan_light(sweep *sweep, int index, vec3 *points, hl_error *error) {
  sweep_light *light = &sweep->lights[index];
  light->source = &sweep->frame->lights[sweep->geometry->light[index]];
  hl_status status = hl_light_emission_create(sweep->content.context, light->source, &light->emission, error);
  if (status != HL_OK) return status;
  const shadow_setup setup = setup_of_light(sweep, light->source, light->emission, points,
                                            hl_frame_visible_points(sweep->frame, points));
  return hl_light_shadow_plan(&light->shadow, &setup, error);
}

static void end_light(const sweep *sweep, sweep_light *light) {
  hl_context *context = sweep->content.context;
  hl_view_sheets_end(&light->sheets);
  hl_light_texture_release(context, &light->texture);
  hl_release(context, light->emission);
  hl_light_shadow_end(&light->shadow);
  hl_release(context, light->reads);
}

/* ---- how long stretches are ---- */

/* A stretch has LONGEST_STRETCH slabs where nothing limits it (measured: docs/laboratory/threads.md). The
 * planes that all lights of a frame keep for a stretch take at most RING_BYTES. With one thread nobody waits,
 * and picture and lights take turns. */
enum { LONGEST_STRETCH = 8 };
static const uint64_t RING_BYTES = 64 << 20;

/* Decides how many slabs a stretch has, and how many sheets the lights' buffers keep. The lights must be
 * planned. */
static void choose_stretch(sweep *sweep) {
  int wanted = sweep->scene->render.slabs_at_once, stretch = wanted > 0 ? wanted : LONGEST_STRETCH;
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
  sweep->ring = stretch == 1 ? 1 : 2 * stretch + 1;
}

static void find_tiles(sweep *sweep) {
  sweep->tiles_x = hl_tiles(sweep->frame->width);
  sweep->tiles_y = hl_tiles(sweep->frame->height);
  sweep->tiles = (size_t)sweep->tiles_x * (size_t)sweep->tiles_y;
}

/* Counts what begin_light() takes. */
static void count_light(sweep *sweep, int index, sweeps_memory *memory) {
  sweep_light *light = &sweep->lights[index];
  light_shadow *shadow = &light->shadow;
  hl_layout *passing = &memory->passing;
  if (light->emission != NULL) hl_layout_take(passing, 1, sizeof *light->emission);
  if (shadow->method == NULL) return;
  const shadow_buffer_size size = hl_light_shadow_buffer_size(shadow, sweep->ring);
  const shadow_layouts of_method = hl_light_shadow_count(shadow);
  hl_shadow_buffer_count(&size, &memory->buffers);
  if (of_method.kept.bytes > memory->kept[index]) memory->kept[index] = of_method.kept.bytes;
  hl_layout_take(passing, of_method.passing.bytes, 1);
  hl_layout_take(passing, 1, shadow->method->state_bytes);
  hl_layout_take(passing, (size_t)sweep->ring, sizeof *shadow->lookups);
  hl_view_sheets_count(&sweep->content, &shadow->plan.view, shadow->plan.spare, passing);
}

/* The tiles of the picture and of all lights that are planned and cast shadows. */
static size_t count_tasks(const sweep *sweep) {
  size_t tasks = sweep->tiles;
  for (int i = 0; i < sweep->geometry->light_count; i++)
    if (sweep->lights[i].shadow.method != NULL) tasks += hl_view_tiles(&sweep->lights[i].shadow.plan.view);
  return tasks;
}

static void lay_out(sweep *sweep, hl_layout *layout) {
  size_t threads = (size_t)hl_pool_threads(sweep->content.pool);
  size_t volumes = (size_t)sweep->content.volume_count, places = threads * volumes;
  sweep->arrays.open = hl_layout_take(layout, sweep->tiles, sizeof *sweep->arrays.open);
  sweep->arrays.tasks = hl_layout_take(layout, count_tasks(sweep), sizeof *sweep->arrays.tasks);
  size_t stretch = (size_t)sweep->content.stretch, lights = (size_t)sweep->geometry->light_count;
  sweep->arrays.slab_shades = hl_layout_take(layout, stretch, sizeof *sweep->arrays.slab_shades);
  sweep->arrays.slab_attenuates = hl_layout_take(layout, lights * stretch,
                                                 sizeof *sweep->arrays.slab_attenuates);
  sweep->arrays.shade_volumes = hl_layout_take(layout, volumes, sizeof *sweep->arrays.shade_volumes);
  size_t cuts = 0;
  for (size_t g = 0; g < volumes; g++) cuts += sweep->content.grids[g].cut_count;
  sweep->arrays.shade_cuts = hl_layout_take(layout, cuts, sizeof *sweep->arrays.shade_cuts);
  sweep->arrays.shade_patches = hl_layout_take(layout, places, sizeof *sweep->arrays.shade_patches);
  sweep->arrays.scratch = hl_layout_take(layout, places, SHADE_SCRATCH_BYTES);
  sweep->arrays.scratch_volumes = hl_layout_take(layout, places, sizeof *sweep->arrays.scratch_volumes);
  sweep->arrays.srgb_decode = hl_layout_take(layout, SRGB_CODES, sizeof *sweep->arrays.srgb_decode);
  sweep->arrays.tint_decode = hl_layout_take(layout, SRGB_CODES, sizeof *sweep->arrays.tint_decode);
  sweep->arrays.counts = hl_layout_take(layout, threads, sizeof *sweep->arrays.counts);
}

/* The lights are planned. */
static void count_memory(sweep *sweep, sweeps_memory *memory) {
  hl_layout *passing = &memory->passing;
  hl_view_sheets_count(&sweep->content, &sweep->frame->eye, PIXEL_TO_SPARE, passing);
  if (sweep->geometry->back_to_front)
    hl_layout_take(passing, sweep->tiles * TILE_BLOCKS, sizeof *sweep->shown_from);
  for (int i = 0; i < sweep->geometry->light_count; i++) count_light(sweep, i, memory);
  lay_out(sweep, passing);
  hl_sweep_layers_count(sweep, passing);
  hl_light_reads_count(sweep, passing);
  hl_sweep_surfaces_count(sweep, passing);
  hl_layout_give_back(passing, 0);
}

hl_status hl_sweep_count_memory(sweep *sweep, vec3 *points, sweeps_memory *memory, hl_error *error) {
  hl_status status = HL_OK;
  find_tiles(sweep);
  for (int i = 0; i < sweep->geometry->light_count && status == HL_OK; i++)
    status = plan_light(sweep, i, points, error);
  choose_stretch(sweep);
  if (status == HL_OK) count_memory(sweep, memory);
  for (int i = 0; i < sweep->geometry->light_count; i++) end_light(sweep, &sweep->lights[i]);
  return status;
}

static hl_status begin_light(sweep *sweep, sweep_light *light, shadow_buffer *buffer, shadow_memory *memory,
                             hl_error *error) {
  const frame *frame = sweep->frame;
  const texture_use use = {frame->points, frame->point_count, frame->middle, frame->middle_pixel};
  hl_status status = hl_light_texture_create(sweep->content.context, light->source, &use, &light->texture,
                                             error);
  light_shadow *shadow = &light->shadow;
  if (status != HL_OK || shadow->method == NULL) return status;
  status = hl_light_shadow_begin(shadow, sweep->ring, buffer, memory, error);
  if (status == HL_OK)
    status = hl_view_sheets_begin(&sweep->content, &shadow->plan.view, true, shadow->plan.spare,
                                  &light->sheets, error);
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

/* Volumes with colours have at most 2^29 voxels. volume: null: there are none. */
static voxel_colors colors_of(const hl_volume *volume, const float *decode) {
  voxel_colors colors = {.decode = decode};
  if (volume == NULL || volume->colors == NULL) return colors;
  colors.voxels = volume->colors;
  int32_t step = HL_COLOR_BYTES;
  for (int axis = 0; axis < 3; axis++) {
    colors.last[axis] = (int32_t)volume->dimension[axis] - 1;
    colors.step_bytes[axis] = step;
    if (axis < 2) step *= (int32_t)volume->dimension[axis];
  }
  return colors;
}

static void set_up_colors(sweep *sweep) {
  bool any = false;
  for (int g = 0; g < sweep->content.volume_count; g++)
    any = any || sweep->content.volumes[g].scene->volume->colors != NULL;
  for (int code = 0; any && code < SRGB_CODES; code++)
    sweep->arrays.srgb_decode[code] = (float)hl_srgb_decode(code / 255.0);
  for (int code = 0; code < SRGB_CODES; code++)
    sweep->arrays.tint_decode[code] = (float)(code * code) * (1.0f / (255 * 255));
}

static void set_up_cut(const grid *grid, const cut_shape *shape, shade_cut *cut) {
  affine3 from_frame = affine3_multiply(shape->to_shape, grid->frame_to_index);
  *cut = (shade_cut){.type = (int)shape->type, .keep_inside = shape->keep_inside};
  affine3_store(cut->rows, &from_frame);
}

static void set_up_cuts(sweep *sweep) {
  shade_cut *cut = sweep->arrays.shade_cuts;
  for (int g = 0; g < sweep->content.volume_count; g++) {
    const grid *grid = &sweep->content.grids[g];
    shade_volume *shade = &sweep->arrays.shade_volumes[g];
    shade->cuts = cut;
    shade->cut_count = (int)grid->cut_count;
    shade->light_cut_count = grid->cut_casts_shadow ? 0 : shade->cut_count;
    shade->cut_shading = (int)sweep->content.volumes[g].scene->cut_shading;
    for (size_t i = 0; i < grid->cut_count; i++) set_up_cut(grid, &grid->cuts[i], cut++);
  }
}

/* Finds the faces of the box that cut through visible matter which no other volume continues. */
static void find_box_faces(const grid *grid, shade_volume *shade) {
  for (int axis = 0; axis < 3; axis++) {
    const float at[2] = {grid->face_low[axis], grid->face_high[axis]};
    for (int high = 0; high < 2; high++) {
      const bool cuts = grid->face_shows[axis][high] && fabsf(at[high]) < FACE_FAR_OUT;
      shade->face_cuts[axis][high] = cuts ? -1 : 0;
      shade->any_face = shade->any_face || cuts;
    }
  }
}

static void set_up_shading(sweep *sweep) {
  int rank = 0;
  set_up_colors(sweep);
  for (int g = 0; g < sweep->content.volume_count; g++) {
    const hl_scene_volume *volume = sweep->content.volumes[g].scene;
    shade_volume *shade = &sweep->arrays.shade_volumes[g];
    *shade = (shade_volume){
        .classifier = &sweep->content.volumes[g].classifier,
        .grid = &sweep->content.grids[g],
        .kernel = sweep->content.kernel,
        .phong = volume->shading == HL_SHADING_PHONG,
        .lit = volume->shading != HL_SHADING_FLAT,
        .object = sweep->frame->order->volumes[g] + 1,
        .visible = volume->visible,
        .receives_shadow = volume->receives_shadow,
        .ambient = (float)volume->material.ambient,
        .diffuse = (float)volume->material.diffuse,
        .specular = (float)volume->material.specular,
        .shininess = (float)volume->material.shininess,
        .anisotropy = (float)volume->anisotropy,
        .phase_once = hl_phase_table(sweep->phases, volume->anisotropy),
        .phase_twice = hl_phase_table(sweep->phases, volume->anisotropy * volume->anisotropy),
        .colors = colors_of(volume->volume, sweep->arrays.srgb_decode),
        .tints = colors_of(volume->mask.volume, sweep->arrays.tint_decode),
        .multiple = volume->multiple_scattering};
    for (int c = 0; c < 3; c++) {
      shade->albedo[c] = (float)volume->albedo[c];
      shade->absorbs = shade->absorbs || volume->albedo[c] != 1;
    }
    shade->emission = shade->lit ? (float)volume->material.emission : 1;
    if (!shade->lit) shade->ambient = shade->receives_shadow = 0;
    if (sweep->maximum->values != NULL && volume->visible) {
      shade->rank = rank++;
      shade->shown = (const float(*)[4])(sweep->maximum->shown +
                                         (size_t)shade->rank * (CLASSIFIER_ENTRIES + 2));
    }
    for (int c = 0; c < HL_CHANNELS; c++)
      shade->cast[c] = volume->casts_shadow ? (float)volume->attenuation_color[c] : 0;
    const grid *grid = &sweep->content.grids[g];
    double finest = 0;
    for (int axis = 0; axis < 3; axis++)
      finest = fmax(finest, vec3_length(grid->frame_to_index.linear.row[axis]));
    shade->voxel = (float)(1 / finest);
    affine3_store(shade->to_index, &grid->frame_to_index);
    for (int axis = 0; axis < 3; axis++) {
      shade->low[axis] = (float)grid->box_low[axis];
      shade->high[axis] = (float)grid->box_high[axis];
    }
    if (volume->cut_shading != HL_CUT_SHADING_GRADIENT) find_box_faces(grid, shade);
    shade->mask_faces = shade->phong && shade->classifier->mask.slopes != NULL &&
                        volume->cut_shading == HL_CUT_SHADING_FACE;
  }
  set_up_cuts(sweep);
}

static void set_up_light(sweep *sweep, const sweep_light *from, shade_light *light) {
  const hl_light *scene = from->source->light;
  vec3 normal = sweep->geometry->sheets.normal;
  double spacing = sweep->geometry->sheets.spacing;
  *light = (shade_light){
      .parallel = from->source->parallel,
      .shadowed = from->shadow.method != NULL,
      .inverse_square = scene->falloff == HL_FALLOFF_INVERSE_SQUARE,
      .texture = from->texture,
      .sector = hl_sector_fraction(from->source->sectors, from->source->sector),
      .number = (int)(light - sweep->shade_lights),
      .parallel_row = from->source->parallel && hl_light_is_wide(scene) ? (int)(scene - sweep->scene->lights)
                                                                        : -1,
      .cone = hl_light_cone(from->source, sweep->frame->middle, sweep->frame->middle_pixel),
      .nearest = sweep->scene->render.shadow_lookup == HL_LOOKUP_NEAREST,
      .cubic = from->shadow.plan.cubic};
  light->of_sky = (float)scene->of_sky;
  if (sweep->phases->count > 0) light->caps = hl_light_caps(from->source);
  vec3_store(light->towards, vec3_scale(from->source->direction, -1));
  vec3_store(light->position, from->source->position);
  for (int c = 0; c < 3; c++)
    light->color[c] = (float)(scene->color[c] * scene->intensity *
                              (from->emission == NULL ? 1 : from->emission->mean[c]));
  light->path = (float)spacing;
  if (from->source->parallel)
    light->path = (float)(spacing / fmax(fabs(vec3_dot(from->source->direction, normal)), 1e-3));
  if (from->shadow.buffer == NULL) return;
  light->channels = from->shadow.buffer->channels;
  light->lookups = from->shadow.lookups;
  light->sublights = from->shadow.sublights;
  light->sublight_count = from->shadow.sublight_count;
}

static void set_up_jobs(sweep *sweep) {
  const view *eye = &sweep->frame->eye;
  vec3 normal = sweep->geometry->sheets.normal;
  double spacing = sweep->geometry->sheets.spacing;
  shade_job *shade = &sweep->shade;
  *shade = (shade_job){.path = (float)spacing,
                       .spacing = (float)spacing,
                       .back_to_front = sweep->geometry->back_to_front,
                       .lights = sweep->shade_lights,
                       .light_count = sweep->geometry->light_count,
                       .channels = sweep->channels,
                       .scattered = sweep->first ? sweep->scattered : NULL};
  vec3_store(shade->normal, normal);
  vec3_store(shade->eye, eye->origin);
  if (!eye->perspective) {
    double climb = vec3_dot(eye->direction, normal);
    shade->path = (float)(spacing / fabs(climb));
    vec3_store(shade->through, vec3_scale(eye->direction, spacing / climb));
    vec3_store(shade->towards_eye, vec3_scale(eye->direction, -1));
  }
  for (int c = 0; c < 3 && sweep->first; c++) shade->ambient[c] = (float)sweep->scene->ambient[c];
  shade->emission = sweep->first ? 1 : 0;
  shade->sky = sweep->first ? sweep->sky : NULL;
  for (int i = 0; i < sweep->geometry->light_count; i++) {
    set_up_light(sweep, &sweep->lights[i], &sweep->shade_lights[i]);
    attenuate_job *job = &sweep->attenuate[i];
    *job = (attenuate_job){
        .path = sweep->shade_lights[i].path, .spacing = (float)spacing, .channels = sweep->channels};
    vec3 way = sweep->lights[i].source->direction;
    if (sweep->lights[i].source->parallel)
      vec3_store(job->through, vec3_scale(way, spacing / fmax(vec3_dot(way, normal), 1e-3)));
    if (sweep->lights[i].shadow.buffer != NULL) job->stride = sweep->lights[i].shadow.buffer->stride;
  }
}

/* Light that climbs by less than this fraction of its way counts as running along the sheets. */
static const double LEAST_CLIMB = 0.05;

/* The least rise of a light's rays per length, within the content. Directions within some angle of the normal
 * form a cone, so the least is at one of the content's corners. */
static double least_climb(const sweep *sweep, const light_source *source) {
  vec3 normal = sweep->geometry->sheets.normal;
  if (source->parallel) return vec3_dot(source->direction, normal);
  double least = 1;
  for (int i = 0; i < sweep->frame->point_count; i++)
    least = fmin(least,
                 vec3_dot(vec3_normalise(vec3_subtract(sweep->frame->points[i], source->position)), normal));
  return least;
}

static double longest_way(const sweep *sweep) {
  double least = 1;
  for (int i = 0; i < sweep->geometry->light_count; i++)
    if (sweep->lights[i].shadow.method != NULL)
      least = fmin(least, least_climb(sweep, sweep->lights[i].source));
  return least < LEAST_CLIMB ? INFINITY : sweep->geometry->sheets.spacing / least;
}

/* Plans the lights, and begins the picture's view and theirs. */
static hl_status begin_views(sweep *sweep, shadow_buffer *buffers, shadow_memory *memory, hl_error *error) {
  hl_context *context = sweep->content.context;
  vec3 *points = hl_allocate(context, (size_t)sweep->frame->point_count / 8 * CONTENT_POINTS + 1,
                             sizeof *points);
  if (points == NULL) return hl_fail_memory(error, sizeof *points, "the content's corners");
  hl_status status = HL_OK;
  for (int i = 0; i < sweep->geometry->light_count && status == HL_OK; i++)
    status = plan_light(sweep, i, points, error);
  choose_stretch(sweep);
  if (status == HL_OK)
    status = hl_view_sheets_begin(&sweep->content, &sweep->frame->eye, false, PIXEL_TO_SPARE, &sweep->image,
                                  error);
  for (int i = 0; i < sweep->geometry->light_count && status == HL_OK; i++)
    status = begin_light(sweep, &sweep->lights[i], &buffers[sweep->geometry->light[i]], &memory[i], error);
  hl_release(context, points);
  return status;
}

hl_status hl_sweep_begin(sweep *sweep, shadow_buffer *buffers, shadow_memory *memory, hl_error *error) {
  double start = hl_clock_seconds();
  find_tiles(sweep);
  hl_status status = begin_views(sweep, buffers, memory, error);
  if (status == HL_OK) status = allocate(sweep, error);
  if (status != HL_OK) return status;
  hl_sweep_open(sweep);
  set_up_shading(sweep);
  set_up_jobs(sweep);
  sweep->image.beside = longest_way(sweep);
  status = hl_sweep_layers_begin(sweep, error);
  if (status == HL_OK) status = hl_sweep_surfaces_begin(sweep, error);
  if (status == HL_OK) status = hl_light_reads_find(sweep, error);
  if (status == HL_OK) status = hl_sweep_surfaces_begin_lights(sweep, error);
  if (status == HL_OK) status = hl_light_reads_find_owned(sweep, error);
  sweep->times.seconds_sort = hl_clock_seconds() - start;
  return status;
}

hl_status hl_sweep_describe(sweep *sweep, hl_error *error) {
  hl_context *context = sweep->content.context;
  vec3 *points = hl_allocate(context, (size_t)sweep->frame->point_count / 8 * CONTENT_POINTS + 1,
                             sizeof *points);
  if (points == NULL) return hl_fail_memory(error, sizeof *points, "the content's corners");
  hl_status status = HL_OK;
  find_tiles(sweep);
  for (int i = 0; i < sweep->geometry->light_count && status == HL_OK; i++)
    status = plan_light(sweep, i, points, error);
  hl_release(context, points);
  choose_stretch(sweep);
  if (status == HL_OK) status = allocate(sweep, error);
  if (status != HL_OK) return status;
  set_up_shading(sweep);
  set_up_jobs(sweep);
  return HL_OK;
}

void hl_sweep_end(sweep *sweep) {
  hl_context *context = sweep->content.context;
  hl_sweep_layers_end(sweep);
  hl_sweep_surfaces_end(sweep);
  for (int i = 0; i < FRAME_LIGHTS; i++) end_light(sweep, &sweep->lights[i]);
  hl_view_sheets_end(&sweep->image);
  hl_release(context, sweep->arrays.memory);
}

/* ---- what is counted ---- */

double hl_clock_seconds(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

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
  if (!sweep->preparatory) statistics->sheets += sweep->geometry->sheets.count;
  statistics->seconds_sort += sweep->times.seconds_sort;
  double all = fill + shade + light, share = all > 0 ? sweep->times.seconds_tiles / all : 0;
  statistics->seconds_fill_image += fill * share;
  statistics->seconds_shade += shade * share;
  statistics->seconds_fill_light += light * share;
  statistics->seconds_composite_light += composite * share;
  statistics->waits += sweep->times.waits;
  statistics->seconds_soften += sweep->times.seconds_soften;
}
