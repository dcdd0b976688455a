/* render/sweep_stages.c - the stages of a sheet, each a set of tiles shared out to the threads. */
#include "core/context.h"
#include "render/sweep_layers.h"
#include "render/sweep_surfaces.h"

enum { TILES_A_TASK = 2 };

/* The tiles that a sheet or the one before may touch. */
static int list_tiles(const occupancy *occupancy, int sheet, uint32_t *list) {
  const uint64_t *after = occupancy->by_sheet + (size_t)sheet * (size_t)occupancy->tile_words;
  const uint64_t *before = after - occupancy->tile_words;
  int count = 0;
  for (int word = 0; word < occupancy->tile_words; word++)
    for (uint64_t bits = before[word] | after[word]; bits != 0; bits &= bits - 1)
      list[count++] = (uint32_t)word * 64 + (uint32_t)__builtin_ctzll(bits);
  return count;
}

/* The clock is read at one tile in 32, each sheet at other tiles: enough to measure how a stage's time
 * divides. */
static bool is_timed(size_t tile, int sheet) {
  return ((tile * 11 + (tile >> 5) + (size_t)sheet * 5) & 31) == 0;
}
static double read_clock(bool timed) { return timed ? hl_clock_seconds() : 0; }

/* ---- the image ---- */

/* Prefetches a tile's alpha while its densities are being filled. */
static void fetch_opacities(const float *pixels, uint32_t blocks) {
  for (; blocks != 0; blocks &= blocks - 1)
    __builtin_prefetch(pixels + (__builtin_ctz(blocks) * 4 + 3) * BLOCK_PIXELS, 1);
}

/* The blocks of a tile in which a slab is not hidden. */
static uint32_t shown_blocks(const sweep *sweep, size_t tile, int slab) {
  if (sweep->shown_from == NULL) return ALL_BLOCKS;
  const int32_t *shown_from = sweep->shown_from + tile * TILE_BLOCKS;
  uint32_t shown = 0;
  for (int block = 0; block < TILE_BLOCKS; block++) shown |= (uint32_t)(shown_from[block] <= slab) << block;
  return shown;
}

/* Sheets are filled for a run of slabs at a time. */
static int last_of_run(int slab) { return (slab - 1) / RUN_SLABS * RUN_SLABS + RUN_SLABS; }

/* Steps 6 and 8 to 11 for one tile: its patches with density in the needed blocks. */
static int fill_image_tile(sweep *sweep, size_t tile, uint32_t need, int worker, shade_patch *patches,
                           uint32_t *blocks) {
  view_sheets *sheets = &sweep->image;
  sweep_counts *counts = &sweep->counts[worker];
  int count = 0;
  for (size_t p = sheets->occupancy.first_patch[tile]; p < sheets->occupancy.first_patch[tile + 1]; p++) {
    uint32_t g = sheets->occupancy.patch_grid[p];
    slab_place place = {tile, p, sweep->sheet};
    uint32_t near = hl_patch_relevant(sheets, place, need);
    if (near == 0) continue;
    fetch_opacities(sweep->pixels + tile * 4 * TILE_PIXELS, near);
    patch_slab slab = hl_patch_slab(sheets, place, need, &counts->pixels_image);
    if (slab.blocks == 0) continue;
    *blocks |= slab.blocks;
    patches[count++] = (shade_patch){
        &sweep->shade_volumes[g], slab.before, slab.current, slab.blocks, slab.enter, slab.leave, slab.uncut};
  }
  return count;
}

uint32_t hl_light_tile(const sweep *sweep, const tile_slab *slab) {
  uint32_t open = sweep->content.hot->render.shade(&sweep->shade, slab,
                                                   sweep->pixels + slab->tile * 4 * TILE_PIXELS,
                                                   &sweep->counts[slab->worker].samples);
  hl_sweep_layers_tile(sweep, slab);
  return open;
}

/* Steps 6 and 8 to 16 for one tile. */
static void shade_one(sweep *sweep, size_t tile, int worker) {
  sweep_counts *counts = &sweep->counts[worker];
  uint32_t blocks = 0, need = sweep->open[tile] & shown_blocks(sweep, tile, last_of_run(sweep->sheet));
  counts->pixels_skipped_image += hl_pixels_of_blocks(ALL_BLOCKS & ~need);
  fragment_range surfaces = hl_sweep_surfaces_reach(sweep, tile, sweep->sheet);
  if (need == 0) {
    counts->skipped_image++;
    return;
  }
  shade_patch *patches = sweep->shade_patches + (size_t)worker * (size_t)sweep->content.volume_count;
  bool timed = is_timed(tile, sweep->sheet);
  double start = read_clock(timed);
  int count = fill_image_tile(sweep, tile, need, worker, patches, &blocks);
  double filled = read_clock(timed);
  counts->filled_image++;
  counts->seconds_fill += filled - start;
  uint32_t shown = shown_blocks(sweep, tile, sweep->sheet);
  blocks &= shown;
  if (blocks == 0 && surfaces.count == 0) return;
  void *scratch = sweep->scratch + (size_t)worker * (size_t)sweep->content.volume_count * SHADE_SCRATCH_BYTES;
  const tile_slab slab = {
      tile, hl_tile_x(sweep, tile), hl_tile_y(sweep, tile), patches, count, blocks, worker, scratch};
  uint32_t open;
  if (surfaces.count > 0) {
    blocks = need & shown;
    open = hl_sweep_surfaces_tile(sweep, &slab, blocks, surfaces);
  } else {
    open = sweep->act(sweep, &slab);
  }
  sweep->open[tile] = (uint16_t)((sweep->open[tile] & ~blocks) | open);
  counts->seconds_shade += read_clock(timed) - filled;
}

static void shade_task(void *data, size_t index, int worker) {
  sweep *sweep = data;
  int end = (int)(index + 1) * TILES_A_TASK < sweep->task_start[1] ? (int)(index + 1) * TILES_A_TASK
                                                                   : sweep->task_start[1];
  for (int task = (int)index * TILES_A_TASK; task < end; task++) shade_one(sweep, sweep->tasks[task], worker);
}

static void prepare_lookup(light_shadow *shadow, int sheet) {
  if (shadow->method != NULL && shadow->method->before_shading != NULL)
    shadow->method->before_shading(shadow, sheet);
}

void hl_sweep_shade(sweep *sweep, int sheet) {
  double start = hl_clock_seconds();
  const sheet_stack *sheets = &sweep->geometry->sheets;
  sweep->sheet = sheet;
  sweep->task_start[1] = list_tiles(&sweep->image.occupancy, sheet, sweep->tasks);
  hl_view_sheets_reach(&sweep->image, sheet);
  hl_view_sheet_rays(&sweep->frame->eye, sheets->normal,
                     hl_sheet_height(sheets, sheet) - 0.5 * sheets->spacing, affine3_identity(),
                     &sweep->shade.rays);
  sweep->shade.height = (float)(sheet * sheets->spacing);
  sweep->shade.sheet = sheet;
  for (int i = 0; i < sweep->geometry->light_count; i++) prepare_lookup(&sweep->lights[i].shadow, sheet);
  hl_sweep_layers_sheet(sweep);
  hl_pool_run(sweep->content.pool, (size_t)(sweep->task_start[1] + TILES_A_TASK - 1) / TILES_A_TASK,
              shade_task, sweep);
  sweep->seconds_image += hl_clock_seconds() - start;
}

/* ---- the lights ---- */

/* Steps 7 to 11 for one tile: its volumes that cast shadows. */
static int fill_light_tile(sweep *sweep, sweep_light *light, size_t tile, int worker, uint32_t need,
                           attenuate_volume *volumes) {
  view_sheets *sheets = &light->sheets;
  uint64_t *pixels = &sweep->counts[worker].pixels_light;
  int count = 0;
  for (size_t p = sheets->occupancy.first_patch[tile]; p < sheets->occupancy.first_patch[tile + 1]; p++) {
    uint32_t g = sheets->occupancy.patch_grid[p];
    const hl_scene_volume *scene = sweep->content.volumes[g].scene;
    if (!scene->casts_shadow) continue;
    slab_place place = {tile, p, sweep->sheet};
    if (hl_patch_relevant(sheets, place, need) == 0) continue;
    patch_slab slab = hl_patch_slab(sheets, place, need, pixels);
    if (slab.blocks == 0) continue;
    volumes[count] = (attenuate_volume){.classifier = &sweep->content.volumes[g].classifier,
                                        .blocks = slab.blocks,
                                        .before = slab.before,
                                        .density = slab.current,
                                        .enter = slab.enter,
                                        .leave = slab.leave,
                                        .uncut = slab.uncut};
    for (int c = 0; c < HL_CHANNELS; c++) volumes[count].weight[c] = (float)scene->attenuation_color[c];
    count++;
  }
  return count;
}

/* Step 17 for one tile of a light's shadow buffer. */
static void composite_light_tile(sweep *sweep, int light_index, size_t tile, uint32_t need,
                                 const attenuate_volume *volumes, int count, fragment_range surfaces) {
  light_shadow *shadow = &sweep->lights[light_index].shadow;
  const shadow_method *method = shadow->method;
  shadow_buffer *buffer = shadow->buffer;
  attenuate_job job = sweep->attenuate[light_index];
  int tile_x = (int)(tile % (size_t)buffer->tiles_x), tile_y = (int)(tile / (size_t)buffer->tiles_x);
  job.volumes = volumes;
  job.volume_count = count;
  for (int c = 0; c < job.channels; c++)
    job.transmittance[c] = buffer->transmittance[c] + (size_t)tile_y * TILE * buffer->stride +
                           (size_t)tile_x * TILE;
  if (method->before_tile != NULL) method->before_tile(shadow, tile, &job);
  uint32_t worked = 0;
  for (int i = 0; i < count; i++) worked |= volumes[i].blocks;
  attenuated_blocks blocks = sweep->content.hot->shadow.attenuate(&job, tile_x, tile_y);
  if (method->find_lit == NULL) buffer->tile_lit[tile] = (uint16_t)((need & ~worked) | blocks.lit);
  bool taken = hl_sweep_surfaces_attenuate(&job, surfaces);
  if (blocks.taken == 0 && !taken) return;
  buffer->tile_touched[tile] = 1;
  if (method->after_tile != NULL) method->after_tile(shadow, tile);
}

static void attenuate_one(sweep *sweep, int light_index, size_t tile, int worker) {
  sweep_counts *counts = &sweep->counts[worker];
  light_shadow *shadow = &sweep->lights[light_index].shadow;
  if (shadow->method->find_lit != NULL) shadow->method->find_lit(shadow, tile);
  uint32_t need = shadow->buffer->tile_lit[tile];
  fragment_range surfaces = hl_sweep_surfaces_reach_light(sweep, light_index, tile, sweep->sheet);
  counts->pixels_skipped_light += hl_pixels_of_blocks(ALL_BLOCKS & ~need);
  if (need == 0) {
    counts->skipped_light++;
    return;
  }
  attenuate_volume *volumes = sweep->scratch_volumes + (size_t)worker * (size_t)sweep->content.volume_count;
  bool timed = is_timed(tile, sweep->sheet);
  double start = read_clock(timed);
  int count = fill_light_tile(sweep, &sweep->lights[light_index], tile, worker, need, volumes);
  double filled = read_clock(timed);
  if (count > 0 || surfaces.count > 0)
    composite_light_tile(sweep, light_index, tile, need, volumes, count, surfaces);
  double end = read_clock(timed);
  counts->filled_light++;
  counts->seconds_light += end - start;
  counts->seconds_composite += end - filled;
}

static void attenuate_task(void *data, size_t index, int worker) {
  sweep *sweep = data;
  int last = sweep->task_start[sweep->geometry->light_count], light = 0;
  int first = (int)index * TILES_A_TASK, end = first + TILES_A_TASK < last ? first + TILES_A_TASK : last;
  for (int task = first; task < end; task++) {
    while (task >= sweep->task_start[light + 1]) light++;
    attenuate_one(sweep, light, sweep->tasks[task], worker);
  }
}

/* Whether a slab lies beyond the light, on the side that its rays travel to in this sweep. */
static bool is_beyond(const sweep *sweep, const light_source *source, int sheet) {
  const sheet_stack *sheets = &sweep->geometry->sheets;
  return source->parallel || hl_sheet_height(sheets, sheet - 1) >= vec3_dot(sheets->normal, source->position);
}

static bool is_reached(const sweep *sweep, const light_shadow *shadow, int sheet) {
  return is_beyond(sweep, shadow->setup.source, sheet + 1 - shadow->method->first_slab);
}

static void reach_sheet(sweep *sweep, int light_index, int sheet) {
  sweep_light *light = &sweep->lights[light_index];
  attenuate_job *job = &sweep->attenuate[light_index];
  const sheet_stack *sheets = &sweep->geometry->sheets;
  light_shadow *shadow = &light->shadow;
  const view *view = &shadow->buffer->view;
  hl_view_sheets_reach(&light->sheets, sheet);
  hl_view_sheet_rays(view, sheets->normal, hl_sheet_height(sheets, sheet), affine3_identity(), &job->rays);
  job->height = (float)(sheet * sheets->spacing);
  if (shadow->method->before_slab != NULL) shadow->method->before_slab(shadow, sheet);
}

void hl_sweep_attenuate(sweep *sweep, int sheet) {
  double start = hl_clock_seconds();
  sweep->sheet = sheet;
  for (int i = 0; i < sweep->geometry->light_count; i++) {
    int count = 0;
    if (sweep->lights[i].shadow.method != NULL) {
      reach_sheet(sweep, i, sheet);
      if (is_reached(sweep, &sweep->lights[i].shadow, sheet))
        count = list_tiles(&sweep->lights[i].sheets.occupancy, sheet, sweep->tasks + sweep->task_start[i]);
    }
    sweep->task_start[i + 1] = sweep->task_start[i] + count;
  }
  size_t tasks = (size_t)sweep->task_start[sweep->geometry->light_count];
  if (tasks == 0) return;
  hl_pool_run(sweep->content.pool, (tasks + TILES_A_TASK - 1) / TILES_A_TASK, attenuate_task, sweep);
  sweep->seconds_light += hl_clock_seconds() - start;
}

void hl_sweep_soften(sweep *sweep, int sheet) {
  double start = hl_clock_seconds();
  for (int i = 0; i < sweep->geometry->light_count; i++) {
    sweep_light *light = &sweep->lights[i];
    light_shadow *shadow = &light->shadow;
    if (shadow->method != NULL && shadow->method->advance != NULL && is_beyond(sweep, light->source, sheet))
      shadow->method->advance(shadow, &light->sheets.occupancy, sheet);
  }
  sweep->seconds_soften += hl_clock_seconds() - start;
}

/* The paper's loop over the sheets (section 3.1, eighteen steps).
 *
 *    1. transform voxels to the half-way vector's frame      hl_sweep_begin
 *    2. bucket sort them by height                           hl_sweep_begin
 *    3. opacity map = 0                                      hl_sweep_begin
 *    4. shadow buffer = full light                           hl_sweep_begin
 *    5. for each sheet
 *    6, 7.   image and shadow sheets = 0                     hl_sweep_shade, hl_sweep_attenuate
 *    8 - 11. add every footprint to both                     hl_sweep_shade, hl_sweep_attenuate
 *   12 - 15. gradient, classification, shadow, illumination  hl_sweep_shade
 *   16.      composite to the frame buffer                   hl_sweep_shade
 *   17.      classify and composite the shadow sheet         hl_sweep_attenuate
 *            (soft: convolve for the next sheet)             hl_sweep_soften
 *   18. end
 *
 * The slab between a sheet and the one before is classified, lit and composited, not the sheet: so nothing
 * that a sharp transfer function shows falls between sheets. A slab is lit by the light that has passed the
 * slabs before it. The first and the last sheet lie outside the content. */
hl_status hl_sweep_run(sweep *sweep, hl_error *error) {
  int sheets = sweep->geometry->sheets.count;
  for (int sheet = 1; sheet < sheets; sheet++) {
    hl_sweep_shade(sweep, sheet);
    hl_sweep_attenuate(sweep, sheet);
    hl_sweep_soften(sweep, sheet);
    if ((sheet & 7) == 0 && !sweep->preparatory)
      hl_progress(sweep->content.context, "render", (double)sheet / sheets);
    if (hl_pool_cancelled(sweep->content.pool))
      return hl_fail(error, HL_ERROR_CANCELLED, "cancelled while rendering");
  }
  return HL_OK;
}
