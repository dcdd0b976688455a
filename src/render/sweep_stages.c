/* render/sweep_stages.c - does the work on one tile in one slab. It is a tile of the picture, or of a light's
 * buffer. */
#include "core/context.h"
#include "platform/clock.h"
#include "render/sweep_layers.h"
#include "render/sweep_surfaces.h"

/* Returns whether the clock is read for a tile on a sheet. On each sheet it is read for one tile in 32, and
 * for other tiles on the next sheet. This is enough to measure how the time is divided among the stages. */
static bool is_timed(size_t tile, int sheet) {
  return ((tile * 11 + (tile >> 5) + (size_t)sheet * 5) & 31) == 0;
}
static double read_clock(bool timed) { return timed ? hl_clock_seconds() : 0; }

/* ---- the image ---- */

/* Prefetches the alpha of a tile's pixels, while the tile's densities are being filled. */
static void fetch_opacities(const float *pixels, uint32_t blocks) {
  for (; blocks != 0; blocks &= blocks - 1)
    __builtin_prefetch(pixels + (__builtin_ctz(blocks) * 4 + 3) * BLOCK_PIXELS, 1);
}

/* The blocks of a tile in which a slab is not hidden from the eye by opaque matter. */
static uint32_t shown_blocks(const sweep *sweep, size_t tile, int slab) {
  if (sweep->target.shown_from == NULL) return ALL_BLOCKS;
  const int32_t *shown_from = sweep->target.shown_from + tile * TILE_BLOCKS;
  uint32_t shown = 0;
  for (int block = 0; block < TILE_BLOCKS; block++) shown |= (uint32_t)(shown_from[block] <= slab) << block;
  return shown;
}

/* The number of the last slab in the run of a slab. Sheets are filled for one run of slabs at a time. */
static int last_of_run(int slab) { return (slab - 1) / RUN_SLABS * RUN_SLABS + RUN_SLABS; }

/* Does steps 6 and 8 to 11 for one tile: finds the tile's patches that have density in the needed blocks. */
static int fill_image_tile(sweep *sweep, slab_place place, uint32_t need, int worker, shade_patch *patches,
                           uint32_t *blocks) {
  size_t tile = place.tile;
  view_sheets *sheets = &sweep->image;
  sweep_counts *counts = &sweep->arrays.counts[worker];
  int count = 0;
  for (size_t p = sheets->occupancy.first_patch[tile]; p < sheets->occupancy.first_patch[tile + 1]; p++) {
    if (!hl_patch_is_touched(sheets, p, place.sheet)) continue;
    uint32_t g = sheets->occupancy.patch_grid[p];
    place.patch = p;
    uint32_t near = hl_patch_relevant(sheets, place, need);
    if (near == 0) continue;
    fetch_opacities(sweep->target.pixels + tile * 4 * TILE_PIXELS, near);
    patch_slab slab = hl_patch_slab(sheets, place, need, &counts->pixels_image);
    if (slab.blocks == 0) continue;
    *blocks |= slab.blocks;
    patches[count++] = (shade_patch){&sweep->constants.volumes[g],
                                     slab.before,
                                     slab.current,
                                     slab.blocks,
                                     slab.enter,
                                     slab.leave,
                                     slab.uncut};
  }
  return count;
}

uint32_t hl_light_tile(const sweep *sweep, const tile_slab *slab) {
  uint32_t open = sweep->content.hot->render->shade(slab->job, slab,
                                                    sweep->target.pixels + slab->tile * 4 * TILE_PIXELS,
                                                    &sweep->arrays.counts[slab->worker].samples);
  hl_sweep_layers_tile(sweep, slab);
  return open;
}

void hl_sweep_shade(sweep *sweep, const shade_job *job, size_t tile, int worker) {
  int sheet = job->sheet;
  sweep_counts *counts = &sweep->arrays.counts[worker];
  uint32_t blocks = 0, need = sweep->arrays.open[tile] & shown_blocks(sweep, tile, last_of_run(sheet));
  counts->pixels_skipped_image += hl_pixels_of_blocks(ALL_BLOCKS & ~need);
  fragment_range surfaces = hl_sweep_surfaces_reach(sweep, tile, sheet);
  if (need == 0) {
    counts->skipped_image++;
    return;
  }
  shade_patch *patches = sweep->arrays.shade_patches + (size_t)worker * (size_t)sweep->content.volume_count;
  bool timed = is_timed(tile, sheet);
  double start = read_clock(timed);
  int count = fill_image_tile(sweep, (slab_place){.tile = tile, .sheet = sheet}, need, worker, patches,
                              &blocks);
  double filled = read_clock(timed);
  counts->filled_image++;
  counts->seconds_fill += filled - start;
  uint32_t shown = shown_blocks(sweep, tile, sheet);
  blocks &= shown;
  if (blocks == 0 && surfaces.count == 0) return;
  void *scratch = sweep->arrays.scratch +
                  (size_t)worker * (size_t)sweep->content.volume_count * SHADE_SCRATCH_BYTES;
  const tile_slab slab = {
      job, tile, hl_tile_x(sweep, tile), hl_tile_y(sweep, tile), patches, count, blocks, worker, scratch};
  uint32_t open;
  if (surfaces.count > 0) {
    blocks = need & shown;
    open = hl_sweep_surfaces_tile(sweep, &slab, blocks, surfaces);
  } else {
    open = hl_sweep_surfaces_beside(sweep, &slab);
  }
  sweep->arrays.open[tile] = (uint16_t)((sweep->arrays.open[tile] & ~blocks) | open);
  counts->seconds_shade += read_clock(timed) - filled;
}

/* ---- the lights ---- */

/* Returns whether faces that cut a volume's visible matter are lit as surfaces, and such a face is near the
 * slab. */
static bool faces_are_lit(const shade_volume *volume, const patch_slab *slab) {
  return volume->phong && volume->cut_shading == HL_CUT_SHADING_FACE &&
         (volume->any_face || volume->light_cut_count > 0) && slab->enter != NULL && !slab->uncut;
}

/* Does steps 7 to 11 for one tile, with the volumes that cast shadows. */
static int fill_light_tile(sweep *sweep, sweep_light *light, slab_place place, int worker, uint32_t need,
                           attenuate_volume *volumes) {
  size_t tile = place.tile;
  view_sheets *sheets = &light->sheets;
  uint64_t *pixels = &sweep->arrays.counts[worker].pixels_light;
  int count = 0;
  for (size_t p = sheets->occupancy.first_patch[tile]; p < sheets->occupancy.first_patch[tile + 1]; p++) {
    if (!hl_patch_is_touched(sheets, p, place.sheet)) continue;
    uint32_t g = sheets->occupancy.patch_grid[p];
    const frame_volume *of = &sweep->content.volumes[g];
    if (!of->casts_shadow) continue;
    place.patch = p;
    if (hl_patch_relevant(sheets, place, need) == 0) continue;
    patch_slab slab = hl_patch_slab(sheets, place, need, pixels);
    if (slab.blocks == 0) continue;
    volumes[count] = (attenuate_volume){
        .classifier = of->classifier,
        .blocks = slab.blocks,
        .surface = of->look.shading == HL_SHADING_PHONG,
        .voxel = sweep->constants.volumes[g].voxel,
        .before = slab.before,
        .density = slab.current,
        .enter = slab.enter,
        .leave = slab.leave,
        .uncut = slab.uncut,
        .faces = faces_are_lit(&sweep->constants.volumes[g], &slab) ? slab.run : NULL,
        .slab = slab.slab,
        .grid = &sweep->content.grids[g],
        .kernel = sweep->content.kernel,
        .to_index = sweep->constants.volumes[g].to_index};
    for (int c = 0; c < HL_CHANNELS; c++) volumes[count].weight[c] = (float)of->look.attenuation_color[c];
    count++;
  }
  return count;
}

/* Does step 17 for one tile of a light's shadow buffer: lets the matter of the slab absorb light in the
 * pixels of the tile. */
static void composite_light_tile(sweep *sweep, light_shadow *shadow, attenuate_job job, size_t tile,
                                 uint32_t need, fragment_range surfaces) {
  const shadow_method *method = shadow->method;
  shadow_buffer *buffer = shadow->buffer;
  int tile_x = (int)(tile % (size_t)buffer->tiles_x), tile_y = (int)(tile / (size_t)buffer->tiles_x);
  size_t first = (size_t)tile_y * TILE * buffer->stride + (size_t)tile_x * TILE;
  for (int c = 0; c < job.channels; c++) {
    job.transmittance[c] = hl_shadow_plane_at(buffer, job.sheet, SHADOW_TRANSMITTANCE, c) + first;
    if (buffer->has_outside)
      job.outside[c] = hl_shadow_plane_at(buffer, job.sheet, SHADOW_OUTSIDE, c) + first;
  }
  job.left = job.transmittance[0];
  if (method->before_tile != NULL) method->before_tile(shadow, tile, &job);
  uint32_t worked = 0;
  for (int i = 0; i < job.volume_count; i++) worked |= job.volumes[i].blocks;
  attenuated_blocks blocks = sweep->content.hot->shadow->attenuate(&job, tile_x, tile_y);
  if (method->find_lit == NULL) buffer->tile_lit[tile] = (uint16_t)((need & ~worked) | blocks.lit);
  bool taken = hl_sweep_surfaces_attenuate(sweep, &job, surfaces);
  if (blocks.changed == 0 && !taken) return;
  buffer->changed[tile] = job.sheet;
  if (blocks.taken == 0 && !taken) return;
  buffer->tile_touched[tile] = 1;
  if (method->after_tile != NULL) method->after_tile(shadow, tile);
}

void hl_sweep_attenuate(sweep *sweep, int light_index, const attenuate_job *job, size_t tile, int worker) {
  sweep_counts *counts = &sweep->arrays.counts[worker];
  sweep_light *light = &sweep->lights[light_index];
  light_shadow *shadow = &light->shadow;
  if (shadow->method->find_lit != NULL) shadow->method->find_lit(shadow, tile);
  uint32_t need = shadow->buffer->tile_lit[tile];
  fragment_range surfaces = hl_sweep_surfaces_reach_light(sweep, light_index, tile, job->sheet);
  counts->pixels_skipped_light += hl_pixels_of_blocks(ALL_BLOCKS & ~need);
  if (need == 0 && !(job->marks && surfaces.count > 0)) {
    counts->skipped_light++;
    return;
  }
  attenuate_volume *volumes = sweep->arrays.scratch_volumes +
                              (size_t)worker * (size_t)sweep->content.volume_count;
  bool timed = is_timed(tile, job->sheet);
  double start = read_clock(timed);
  int count = fill_light_tile(sweep, light, (slab_place){.tile = tile, .sheet = job->sheet}, worker, need,
                              volumes);
  double filled = read_clock(timed);
  attenuate_job own = *job;
  own.volumes = volumes;
  own.volume_count = count;
  if (count > 0 || surfaces.count > 0) composite_light_tile(sweep, shadow, own, tile, need, surfaces);
  double end = read_clock(timed);
  counts->filled_light++;
  counts->seconds_light += end - start;
  counts->seconds_composite += end - filled;
}
