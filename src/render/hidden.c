/* render/hidden.c - finds what opaque matter hides from the eye, before a sweep that goes from back to front:
 * that sweep would light hidden matter first, only to cover it later.
 *
 * A preparatory sweep passes over the same sheets from front to back and composites opacity alone, until
 * blocks are opaque. The slabs behind these blocks are then left out. A few tiles are tried first: where
 * little is hidden, everything is lit. */
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

/* The first visible slab, counted from the light, of a block that is opaque after slab k, counted from the
 * eye. Derived: between n sheets there are n - 1 slabs; the k nearest to the eye are the last k, from slab n
 * - k on. */
static int32_t first_shown(const sweep *sweep, int slab) { return sweep->geometry->sheets.count - slab; }

/* The tile action's data. */
typedef struct hidden_search {
  int32_t *shown_from; /* [tiles][16]; first visible slab; 0: the block is not covered yet */
  bool trying;         /* blocks stay open after they are opaque, so that what they cover is counted */
} hidden_search;

static uint32_t uncovered_blocks(const int32_t shown_from[TILE_BLOCKS]) {
  uint32_t blocks = 0;
  for (int block = 0; block < TILE_BLOCKS; block++) blocks |= (uint32_t)(shown_from[block] == 0) << block;
  return blocks;
}

/* The tile action: composites opacity alone. */
static uint32_t cover_tile(const sweep *sweep, const tile_slab *slab) {
  const hidden_search *search = sweep->action;
  sweep_counts *counts = &sweep->arrays.counts[slab->worker];
  int32_t *shown_from = search->shown_from + slab->tile * TILE_BLOCKS;
  uint32_t seen = slab->blocks & uncovered_blocks(shown_from);
  counts->pixels_covered += hl_pixels_of_blocks(slab->blocks & ~seen);
  counts->pixels_seen += hl_pixels_of_blocks(seen);
  tile_slab uncovered = *slab;
  uncovered.blocks = seen;
  uint32_t open = sweep->content.hot->render.cover(
      slab->job, &uncovered, sweep->pixels + slab->tile * 4 * TILE_PIXELS, &counts->samples);
  for (uint32_t closed = seen & ~open; closed != 0; closed &= closed - 1)
    shown_from[__builtin_ctz(closed)] = first_shown(sweep, slab->job->sheet);
  return search->trying ? slab->blocks : open;
}

/* Whether a tile is tried first: one tile in 32, none beside another. */
static bool is_tried(const sweep *sweep, size_t tile) {
  return (hl_tile_x(sweep, tile) + hl_tile_y(sweep, tile) * 11) % 32 == 0;
}

/* The search pays where, for each pixel that is seen, more pixels than this are covered. A seen pixel costs
 * the search about half of the time that lighting a covered one takes (measured); the number is higher than
 * that, because a few tried tiles are no sure sign. */
static const double COVERED_PER_SEEN = 0.75;

static hl_status is_worth_while(const sweep *front, bool *worth, hl_error *error) {
  enum { SEEN, COVERED, COUNTS };
  const light_exchange *with = front->share->exchange;
  uint64_t own[COUNTS] = {0}, *all = own;
  size_t parts = with == NULL ? 1 : (size_t)with->parts;
  for (int i = 0; i < hl_pool_threads(front->content.pool); i++) {
    own[SEEN] += front->arrays.counts[i].pixels_seen;
    own[COVERED] += front->arrays.counts[i].pixels_covered;
  }
  if (with != NULL) {
    all = hl_allocate(front->content.context, parts, sizeof own);
    if (all == NULL) return hl_fail_memory(error, parts * sizeof own, "what is hidden");
    with->gather(with->data, own, sizeof own, all);
  }
  double seen = 0, covered = 0; /* whole numbers: in any order the same sums */
  for (size_t part = 0; part < parts; part++) {
    seen += (double)all[part * COUNTS + SEEN];
    covered += (double)all[part * COUNTS + COVERED];
  }
  if (with != NULL) hl_release(front->content.context, all);
  *worth = covered > COVERED_PER_SEEN * seen;
  return HL_OK;
}

/* Runs the search for hidden slabs. trying: in the tried tiles alone, where opaque blocks stay open, so that
 * the pixels they cover are counted; else in all other tiles. */
static hl_status go_through(sweep *front, hidden_search *search, bool trying, hl_error *error) {
  search->trying = trying;
  for (size_t tile = 0; tile < front->tiles; tile++)
    if (is_tried(front, tile) != trying) front->arrays.open[tile] = 0;
  return hl_sweep_run(front, error);
}

hl_status hl_sweep_find_hidden(sweep *sweep, hl_render_statistics *statistics, hl_error *error) {
  size_t tiles = (size_t)hl_tiles(sweep->frame->width) * (size_t)hl_tiles(sweep->frame->height);
  frame_sweep turned = turned_round(sweep->geometry);
  const picture_share whole = {.parts = 1};
  struct sweep front = *sweep;
  hl_context *context = sweep->content.context;
  sweep->shown_from = hl_allocate_zeroed(context, tiles * TILE_BLOCKS, sizeof *sweep->shown_from);
  if (sweep->shown_from == NULL)
    return hl_fail_memory(error, tiles * TILE_BLOCKS * sizeof *sweep->shown_from, "what is hidden");
  hidden_search search = {.shown_from = sweep->shown_from};
  front.geometry = &turned;
  front.content.sheets = &turned.sheets;
  front.layer_pixels = NULL;
  front.first = front.measures = false;
  front.preparatory = true;
  /* what is tried must not depend on the part, which would change bytes: parts that exchange nothing all try
   * the whole picture's tiles */
  bool together = sweep->share->exchange != NULL, worth = false;
  front.share = together ? sweep->share : &whole;
  front.act = cover_tile;
  front.action = &search;
  hl_status status = hl_sweep_begin(&front, NULL, NULL, error);
  if (status == HL_OK) status = go_through(&front, &search, true, error);
  if (status == HL_OK) status = is_worth_while(&front, &worth, error);
  if (worth) {
    front.share = sweep->share;
    hl_sweep_open(&front);
    status = go_through(&front, &search, false, error);
  }
  if (status == HL_OK) hl_sweep_count(&front, statistics);
  hl_sweep_end(&front);
  /* removes the opacities that the search left */
  hl_pool_clear(sweep->content.pool, sweep->pixels, tiles * TILE_PIXELS * 4 * sizeof *sweep->pixels);
  return status;
}
