/* render/sweep_stages.c - the stages of a sheet, each a set of tiles shared out to the threads. */
#include <string.h>

#include "render/clock.h"
#include "render/sweep.h"

static double sheet_height(const sweep *sweep, int sheet) {
  return sweep->geometry->sheets.first + sheet * sweep->geometry->sheets.spacing;
}

/* Sets one bit in the list for each marked tile; two rows of bits may be joined (null: none). */
static int list_tiles(const uint64_t *a, const uint64_t *b, int words, uint32_t *list) {
  int count = 0;
  for (int word = 0; word < words; word++) {
    uint64_t bits = (a == NULL ? 0 : a[word]) | (b == NULL ? 0 : b[word]);
    for (; bits != 0; bits &= bits - 1) list[count++] = (uint32_t)word * 64 + (uint32_t)__builtin_ctzll(bits);
  }
  return count;
}

static const uint64_t *tiles_of_sheet(const occupancy *occupancy, int sheet) {
  if (sheet < 0 || sheet >= occupancy->sheets) return NULL;
  return occupancy->by_sheet + (size_t)sheet * (size_t)occupancy->tile_words;
}

/* Open blocks and their neighbours: what central differences of open pixels read. */
static uint32_t needed_blocks(const sweep *sweep, size_t tile) {
  if (sweep->geometry->back_to_front) return ALL_BLOCKS;
  int x = (int)(tile % (size_t)sweep->tiles_x), y = (int)(tile / (size_t)sweep->tiles_x);
  uint32_t own = sweep->open[tile];
  uint32_t need = own | (own & 0x7777u) << 1 | (own & 0xeeeeu) >> 1 | own << 4 | own >> 4;
  if (x > 0) need |= (sweep->open[tile - 1] & 0x8888u) >> 3;
  if (x + 1 < sweep->tiles_x) need |= (sweep->open[tile + 1] & 0x1111u) << 3;
  if (y > 0) need |= (uint32_t)sweep->open[tile - (size_t)sweep->tiles_x] >> 12;
  if (y + 1 < sweep->tiles_y) need |= (sweep->open[tile + (size_t)sweep->tiles_x] & 0xfu) << 12;
  return need & ALL_BLOCKS;
}

static uint64_t pixels_in(uint32_t blocks) { return (uint64_t)__builtin_popcount(blocks) * BLOCK_PIXELS; }

static uint32_t fill_tile(const sweep *sweep, const fill_source *source, int tile_x, int tile_y, uint32_t need,
                          float *density) {
  return sweep->splat ? sweep->hot->splat_tile(source, tile_x, tile_y, need, density)
                      : sweep->hot->gather_tile(source, tile_x, tile_y, need, density);
}

static void copy_block(float *to, size_t stride, const float *block) {
  for (int row = 0; row < BLOCK; row++) memcpy(to + (size_t)row * stride, block + row * BLOCK, BLOCK * sizeof(float));
}

/* Where a tile starts in a volume's sheets. */
static size_t place_in_sheets(const sweep *sweep, int g, int tile_x, int tile_y) {
  const tile_rectangle *r = &sweep->occupancy.rectangle[g];
  return (size_t)(tile_y - r->y) * TILE * sweep->sheets[g].stride + (size_t)(tile_x - r->x) * TILE;
}

/* Steps 6 and 8 to 11 for one volume's patch of a tile of the image sheet. */
static void fill_image_patch(sweep *sweep, size_t tile, size_t patch, int worker) {
  int slot = sweep->fill_sheet % RING, g = (int)sweep->occupancy.patch_grid[patch];
  const image_sheets *sheets = &sweep->sheets[g];
  int tile_x = (int)(tile % (size_t)sweep->tiles_x), tile_y = (int)(tile / (size_t)sweep->tiles_x);
  float *to = sheets->density[slot] + place_in_sheets(sweep, g, tile_x, tile_y);
  bool occupied = sweep->fill_sheet < sweep->occupancy.sheets &&
                  hl_occupancy_has(&sweep->occupancy, patch, sweep->fill_sheet);
  uint32_t need = occupied ? needed_blocks(sweep, tile) : 0;
  uint32_t filled = 0;
  float *density = sweep->scratch + (size_t)worker * (size_t)sweep->volume_count * TILE_PIXELS;
  if (!occupied && sweep->filled[slot][patch] == 0) return;
  if (need != 0) {
    filled = fill_tile(sweep, &sweep->image_sources[g], tile_x, tile_y, need, density);
    sweep->counts[worker].filled_image++;
    sweep->counts[worker].pixels_image += pixels_in(filled);
    sweep->counts[worker].pixels_skipped_image += pixels_in(ALL_BLOCKS & ~need);
  } else if (occupied) {
    sweep->counts[worker].skipped_image++;
    sweep->counts[worker].pixels_skipped_image += TILE_PIXELS;
  }
  if (filled == 0 && sweep->filled[slot][patch] != 0)
    for (int row = 0; row < TILE; row++) memset(to + (size_t)row * sheets->stride, 0, TILE * sizeof(float));
  for (int block = 0; filled != 0 && block < TILE_BLOCKS; block++)
    if (need >> block & 1)
      copy_block(to + (size_t)(block / 4 * BLOCK) * sheets->stride + block % 4 * BLOCK, sheets->stride,
                 density + block * BLOCK_PIXELS);
  sweep->filled[slot][patch] = (uint16_t)filled;
}

/* One volume's densities on a sheet of a light's tile, in the needed blocks at least: kept from the slab before, or
 * filled now. Null: empty. */
static const float *light_density(sweep *sweep, int light_index, size_t tile, size_t patch, int sheet, uint32_t need,
                                  int worker, uint32_t *blocks) {
  sweep_light *light = &sweep->lights[light_index];
  if (sheet < 0 || !hl_occupancy_has(&light->occupancy, patch, sheet)) return NULL;
  int g = (int)light->occupancy.patch_grid[patch];
  size_t at = patch * RING + (size_t)(sheet % RING);
  kept_tile *kept = &light->kept[at];
  if (kept->sheet != sheet || (need & ~(uint32_t)kept->need) != 0) {
    int source = (light_index * RING + (sweep->light_sheet - sheet)) * sweep->volume_count + g;
    kept->blocks = (uint16_t)fill_tile(sweep, &sweep->light_sources[source], (int)(tile % (size_t)light->occupancy.tiles_x),
                                       (int)(tile / (size_t)light->occupancy.tiles_x), need,
                                       light->density + at * TILE_PIXELS);
    kept->sheet = sheet;
    kept->need = (uint16_t)need;
    sweep->counts[worker].pixels_light += pixels_in(kept->blocks);
  }
  *blocks |= kept->blocks & need;
  return light->density + at * TILE_PIXELS;
}

/* Steps 7 to 11 and 17 for one tile of a light's shadow sheet and buffer. */
static void fill_light_tile(sweep *sweep, int light_index, size_t tile, int worker) {
  static const float nothing[TILE_PIXELS];
  sweep_light *light = &sweep->lights[light_index];
  shadow_buffer *buffer = light->buffer;
  uint32_t need = buffer->tile_lit[tile];
  if (need == 0) {
    sweep->counts[worker].skipped_light++;
    sweep->counts[worker].pixels_skipped_light += TILE_PIXELS;
    return;
  }
  int found = 0;
  attenuate_volume *volumes = sweep->scratch_volumes + (size_t)worker * (size_t)sweep->volume_count;
  const uint32_t *patches = light->occupancy.first_patch + tile;
  for (size_t patch = patches[0]; patch < patches[1]; patch++) {
    uint32_t g = light->occupancy.patch_grid[patch], blocks = 0;
    const hl_scene_volume *scene = sweep->volumes[g].scene;
    if (!scene->casts_shadow) continue;
    const float *before = light_density(sweep, light_index, tile, patch, sweep->light_sheet - 1, need, worker, &blocks);
    const float *density = light_density(sweep, light_index, tile, patch, sweep->light_sheet, need, worker, &blocks);
    if (blocks == 0) continue;
    size_t at = patch * TILE_PIXELS;
    bool cut = sweep->grids[g].cut;
    volumes[found] = (attenuate_volume){.classifier = &sweep->volumes[g].classifier, .blocks = blocks,
                                        .before = before == NULL ? nothing : before,
                                        .density = density == NULL ? nothing : density,
                                        .enter = cut ? light->enter + at : NULL,
                                        .leave = cut ? light->leave + at : NULL};
    for (int c = 0; c < HL_CHANNELS; c++) volumes[found].weight[c] = (float)scene->attenuation_color[c];
    found++;
  }
  sweep->counts[worker].filled_light++;
  sweep->counts[worker].pixels_skipped_light += pixels_in(ALL_BLOCKS & ~need);
  if (found == 0) return;
  attenuate_job job = sweep->attenuate[light_index];
  int tile_x = (int)(tile % (size_t)buffer->tiles_x), tile_y = (int)(tile / (size_t)buffer->tiles_x);
  job.volumes = volumes;
  job.volume_count = found;
  for (int c = 0; c < job.channels; c++)
    job.transmittance[c] = buffer->transmittance[c] + (size_t)tile_y * TILE * buffer->stride + (size_t)tile_x * TILE;
  for (int c = 0; c < job.channels && light->cascade.level_count > 0; c++) {
    job.also_stride = light->cascade.level[0].stride;
    job.also[c] = light->cascade.current[c].pixels + (size_t)tile_y * TILE * job.also_stride + (size_t)tile_x * TILE;
    light->cascade.current[c].ones[tile] = 0;
  }
  uint32_t worked = 0;
  for (int i = 0; i < found; i++) worked |= volumes[i].blocks;
  double start = hl_clock_seconds();
  buffer->tile_lit[tile] = (uint16_t)((need & ~worked) | sweep->hot->attenuate_tile(&job, tile_x, tile_y));
  buffer->tile_touched[tile] = 1;
  sweep->counts[worker].seconds_composite += hl_clock_seconds() - start;
}

enum { TILES_A_TASK = 4 };

static void fill_task(void *data, size_t index, int worker) {
  sweep *sweep = data;
  int last = sweep->task_start[sweep->geometry->light_count + 1];
  int first = (int)index * TILES_A_TASK, end = first + TILES_A_TASK < last ? first + TILES_A_TASK : last;
  double start = hl_clock_seconds();
  for (int task = first; task < end; task++) {
    size_t tile = sweep->tasks[task];
    if (task < sweep->task_start[1]) {
      const uint32_t *patches = sweep->occupancy.first_patch + tile;
      for (size_t patch = patches[0]; patch < patches[1]; patch++) fill_image_patch(sweep, tile, patch, worker);
      continue;
    }
    int light = 0;
    while (task >= sweep->task_start[light + 2]) light++;
    fill_light_tile(sweep, light, tile, worker);
  }
  double spent = hl_clock_seconds() - start;
  if (first < sweep->task_start[1]) sweep->counts[worker].seconds_image += spent;
  else sweep->counts[worker].seconds_light += spent;
}

static void set_source(const sweep *sweep, const view *view, int g, const voxel_lists *lists, int sheet,
                       fill_source *source) {
  *source = (fill_source){.grid = &sweep->grids[g], .kernel = sweep->kernel, .sheet = sheet,
                          .lists = lists == NULL ? NULL : &lists[g]};
  hl_view_sheet_rays(view, sweep->geometry->sheets.normal, sheet_height(sweep, sheet), sweep->grids[g].frame_to_index,
                     &source->rays);
}

static void prepare_light(sweep *sweep, int light_index, int sheet) {
  sweep_light *light = &sweep->lights[light_index];
  attenuate_job *job = &sweep->attenuate[light_index];
  for (int back = 0; back < RING; back++)
    for (int g = 0; g < sweep->volume_count; g++)
      set_source(sweep, &light->buffer->view, g, light->lists, sheet - back,
                 &sweep->light_sources[(light_index * RING + back) * sweep->volume_count + g]);
  hl_view_sheet_rays(&light->buffer->view, sweep->geometry->sheets.normal, sheet_height(sweep, sheet), affine3_identity(),
                     &job->rays);
  job->height = (float)(sheet * sweep->geometry->sheets.spacing);
}

void hl_sweep_fill(sweep *sweep, int image_sheet, int light_sheet) {
  double start = hl_clock_seconds();
  sweep->fill_sheet = image_sheet;
  sweep->light_sheet = light_sheet;
  for (int g = 0; g < sweep->volume_count; g++)
    set_source(sweep, &sweep->frame->eye, g, sweep->lists, image_sheet, &sweep->image_sources[g]);
  const occupancy *image = &sweep->occupancy;
  sweep->task_start[0] = 0;
  sweep->task_start[1] = list_tiles(tiles_of_sheet(image, image_sheet), tiles_of_sheet(image, image_sheet - RING),
                                    image->tile_words, sweep->tasks);
  for (int i = 0; i < sweep->geometry->light_count; i++) {
    int count = 0;
    if (light_sheet >= 0 && sweep->lights[i].buffer != NULL) {
      const occupancy *light = &sweep->lights[i].occupancy;
      count = list_tiles(tiles_of_sheet(light, light_sheet), tiles_of_sheet(light, light_sheet - 1), light->tile_words,
                         sweep->tasks + sweep->task_start[i + 1]);
      if (count > 0) prepare_light(sweep, i, light_sheet);
    }
    sweep->task_start[i + 2] = sweep->task_start[i + 1] + count;
  }
  size_t tasks = (size_t)sweep->task_start[sweep->geometry->light_count + 1];
  hl_pool_run(sweep->pool, (tasks + TILES_A_TASK - 1) / TILES_A_TASK, fill_task, sweep);
  sweep->seconds_fill += hl_clock_seconds() - start;
}

/* Steps 12 to 16 for one tile: its patches with density, shaded together. */
static void shade_one(sweep *sweep, size_t tile, int worker) {
  int tile_x = (int)(tile % (size_t)sweep->tiles_x), tile_y = (int)(tile / (size_t)sweep->tiles_x), count = 0;
  shade_patch *patches = sweep->shade_patches + (size_t)worker * (size_t)sweep->volume_count;
  uint32_t blocks = 0;
  for (size_t p = sweep->occupancy.first_patch[tile]; p < sweep->occupancy.first_patch[tile + 1]; p++) {
    uint32_t filled = (uint32_t)sweep->filled[0][p] | sweep->filled[1][p], g = sweep->occupancy.patch_grid[p];
    if (filled == 0) continue;
    blocks |= filled;
    bool cut = sweep->grids[g].cut;
    patches[count++] = (shade_patch){&sweep->shade_volumes[g], place_in_sheets(sweep, (int)g, tile_x, tile_y),
                                     cut ? sweep->enter + p * TILE_PIXELS : NULL,
                                     cut ? sweep->leave + p * TILE_PIXELS : NULL};
  }
  blocks &= sweep->open[tile];
  if (blocks == 0) return;
  uint32_t open = sweep->hot->shade_tile(&sweep->shade, patches, count, tile_x, tile_y, blocks,
                                         sweep->scratch + (size_t)worker * (size_t)sweep->volume_count * TILE_PIXELS,
                                         sweep->pixels + tile * 4 * TILE_PIXELS, &sweep->counts[worker].samples);
  sweep->open[tile] = (uint16_t)((sweep->open[tile] & ~blocks) | open);
}

static void shade_task(void *data, size_t index, int worker) {
  sweep *sweep = data;
  int end = (int)(index + 1) * TILES_A_TASK < sweep->task_start[1] ? (int)(index + 1) * TILES_A_TASK : sweep->task_start[1];
  for (int task = (int)index * TILES_A_TASK; task < end; task++) shade_one(sweep, sweep->tasks[task], worker);
}

void hl_sweep_shade(sweep *sweep, int sheet) {
  double start = hl_clock_seconds();
  hl_view_sheet_rays(&sweep->frame->eye, sweep->geometry->sheets.normal,
                     sheet_height(sweep, sheet) - 0.5 * sweep->geometry->sheets.spacing, affine3_identity(),
                     &sweep->shade.rays);
  sweep->shade.height = (float)(sheet * sweep->geometry->sheets.spacing);
  for (int g = 0; g < sweep->volume_count; g++) {
    shade_volume *volume = &sweep->shade_volumes[g];
    volume->before = sweep->sheets[g].density[(sheet - 1) % RING];
    volume->current = sweep->sheets[g].density[sheet % RING];
  }
  sweep->task_start[1] = list_tiles(tiles_of_sheet(&sweep->occupancy, sheet), tiles_of_sheet(&sweep->occupancy, sheet - 1),
                                    sweep->occupancy.tile_words, sweep->tasks);
  hl_pool_run(sweep->pool, (size_t)(sweep->task_start[1] + TILES_A_TASK - 1) / TILES_A_TASK, shade_task, sweep);
  sweep->seconds_shade += hl_clock_seconds() - start;
}

void hl_sweep_soften(sweep *sweep, int sheet) {
  double start = hl_clock_seconds();
  const hot_functions *hot = sweep->hot;
  const blur_functions blur = {hot->blur_rows_tile, hot->blur_columns_tile, hot->lit_blocks_tile};
  const cascade_functions cascade = {hot->lit_blocks_tile, hot->blur_multiply_tile, hot->multiply_tile,
                                     hot->multiply_half_tile, hot->multiply_double_tile};
  for (int i = 0; i < sweep->geometry->light_count; i++) {
    sweep_light *light = &sweep->lights[i];
    if (light->buffer == NULL || light->source->shadows != HL_SHADOWS_SOFT) continue;
    if (light->source->soft_method == HL_SOFT_PAPER)
      hl_soft_paper_convolve(&light->paper, light->buffer, sheet_height(sweep, sheet + 1), sweep->pool, &blur);
    else if (sheet > 0)
      hl_soft_cascade_advance(&light->cascade, light->buffer, sheet_height(sweep, sheet - 1), sheet_height(sweep, sheet),
                              sweep->pool, &cascade);
  }
  sweep->seconds_soften += hl_clock_seconds() - start;
}
