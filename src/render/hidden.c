/* render/hidden.c - what opaque matter hides from the eye, found before a sweep that goes from back to front:
 * it would shade all of that first, to cover it later.
 *
 * The same sheets are gone through the other way, opacity alone, until blocks of pixels are opaque. What lies
 * behind is left out, as it is where sheets go from front to back. A few tiles are tried first: where little
 * is hidden, all is shaded. */
#include "core/memory.h"
#include "render/sweep.h"

/* The same sheets, the last one first. */
static frame_sweep turned_round(const frame_sweep *geometry) {
  const sheet_stack *sheets = &geometry->sheets;
  frame_sweep turned = {.sheets = *sheets};
  turned.sheets.normal = vec3_scale(sheets->normal, -1);
  turned.sheets.first = -hl_sheet_height(sheets, sheets->count - 1);
  return turned;
}

/* Derived: what is opaque after slab k from the eye, of the n - 1 between n sheets, hides those before slab n
 * - k from the light. */
static int32_t first_shown(const sweep *sweep, int slab) { return sweep->geometry->sheets.count - slab; }

uint32_t hl_shown_blocks(const int32_t shown_from[TILE_BLOCKS], int slab) {
  uint32_t shown = 0;
  for (int block = 0; block < TILE_BLOCKS; block++) shown |= (uint32_t)(shown_from[block] <= slab) << block;
  return shown;
}

uint32_t hl_sweep_cover(const sweep *sweep, const shade_patch *patches, int patch_count, size_t tile,
                        uint32_t blocks, int worker, void *scratch) {
  sweep_counts *counts = &sweep->counts[worker];
  int32_t *shown_from = sweep->covering + tile * TILE_BLOCKS;
  uint32_t seen = blocks & hl_shown_blocks(shown_from, 0); /* 0: not covered yet */
  counts->pixels_covered += hl_pixels_of_blocks(blocks & ~seen);
  counts->pixels_seen += hl_pixels_of_blocks(seen);
  uint32_t open = sweep->hot->render.cover(&sweep->shade, patches, patch_count,
                                           (int)(tile % (size_t)sweep->tiles_x),
                                           (int)(tile / (size_t)sweep->tiles_x), seen, scratch,
                                           sweep->pixels + tile * 4 * TILE_PIXELS, &counts->samples);
  for (uint32_t closed = seen & ~open; closed != 0; closed &= closed - 1)
    shown_from[__builtin_ctz(closed)] = first_shown(sweep, sweep->sheet);
  return sweep->trying ? blocks : open;
}

/* One tile in 32, none near another. */
static bool is_tried(const sweep *sweep, size_t tile) {
  return (tile % (size_t)sweep->tiles_x + tile / (size_t)sweep->tiles_x * 11) % 32 == 0;
}

/* To find what covers a pixel takes about half of what it takes to fill and to light one that is covered
 * (measured); and some more, as few tiles tell. */
static const double COVERED_PER_SEEN = 0.75;

static bool is_worth_while(const sweep *front) {
  uint64_t seen = 0, covered = 0;
  for (int i = 0; i < hl_pool_threads(front->pool); i++) {
    seen += front->counts[i].pixels_seen;
    covered += front->counts[i].pixels_covered;
  }
  return (double)covered > COVERED_PER_SEEN * (double)seen;
}

/* The tiles that are tried, also behind what covers them, to see whether there is much; or the others. */
static hl_status go_through(sweep *front, bool trying, hl_error *error) {
  front->trying = trying;
  for (size_t tile = 0; tile < front->tiles; tile++)
    if (is_tried(front, tile) != trying) front->open[tile] = 0;
  return hl_sweep_run(front, error);
}

hl_status hl_sweep_find_hidden(sweep *sweep, hl_render_statistics *statistics, hl_error *error) {
  size_t tiles = (size_t)hl_tiles(sweep->frame->width) * (size_t)hl_tiles(sweep->frame->height);
  frame_sweep turned = turned_round(sweep->geometry);
  struct sweep front = *sweep;
  sweep->shown_from = hl_allocate_zeroed(sweep->context, tiles * TILE_BLOCKS, sizeof *sweep->shown_from);
  if (sweep->shown_from == NULL)
    return hl_fail_memory(error, tiles * TILE_BLOCKS * sizeof *sweep->shown_from, "what is hidden");
  front.geometry = &turned;
  front.layer_pixels = NULL;
  front.first = front.measures = false;
  front.covering = sweep->shown_from;
  hl_status status = hl_sweep_begin(&front, NULL, NULL, error);
  if (status == HL_OK) status = go_through(&front, true, error);
  if (status == HL_OK && is_worth_while(&front)) {
    hl_sweep_open(&front);
    status = go_through(&front, false, error);
  }
  if (status == HL_OK) hl_sweep_count(&front, statistics);
  hl_sweep_end(&front);
  hl_pool_clear(sweep->pool, sweep->pixels, tiles * TILE_PIXELS * 4 * sizeof *sweep->pixels); /* opacities */
  return status;
}
