/* render/hidden.c - finds what opaque matter hides from the eye, before a sweep that goes from back to front.
 * Without this, the sweep would first light hidden matter and later cover it.
 *
 * A preparatory sweep passes over the same sheets from front to back and composites opacity alone, until
 * blocks are opaque. The slabs behind these blocks are then left out. A few tiles are searched first. If
 * little is hidden in them, the search ends, and everything is lit. */
#include "core/memory.h"
#include "render/sweep.h"

/* The sheets in reverse order, for a sweep that goes from front to back. */
static sweep_sheets turned_round(const sheet_stack *sheets) {
  sweep_sheets turned = {.sheets = *sheets};
  turned.sheets.normal = vec3_scale(sheets->normal, -1);
  turned.sheets.first = -hl_sheet_height(sheets, sheets->count - 1);
  return turned;
}

/* Finds the first visible slab, counted from the light, of a block that has become opaque in the preparatory
 * sweep. slab: the slab, counted from the eye, after which the block was opaque. Derived: between n sheets
 * there are n - 1 slabs; the k slabs nearest to the eye are the last k slabs, from slab n - k on. */
static int32_t first_shown(const sweep *sweep, int slab) { return sweep->geometry->sheets.count - slab; }

/* The data of the function that the search calls for each tile. */
typedef struct hidden_search {
  int32_t *shown_from; /* [tiles][16]; the number of the first visible slab of each block; 0 if no opaque
                        * matter covers the block yet */
  bool trying; /* whether blocks stay open after they are opaque, so that the pixels that opaque matter covers
                * are counted */
} hidden_search;

static uint32_t uncovered_blocks(const int32_t shown_from[TILE_BLOCKS]) {
  uint32_t blocks = 0;
  for (int block = 0; block < TILE_BLOCKS; block++) blocks |= (uint32_t)(shown_from[block] == 0) << block;
  return blocks;
}

/* The function that the search calls for each tile of a slab. It composites opacity alone. */
static uint32_t cover_tile(const sweep *sweep, const tile_slab *slab) {
  const hidden_search *search = sweep->act.data;
  sweep_counts *counts = &sweep->arrays.counts[slab->worker];
  int32_t *shown_from = search->shown_from + slab->tile * TILE_BLOCKS;
  uint32_t seen = slab->blocks & uncovered_blocks(shown_from);
  counts->pixels_covered += hl_pixels_of_blocks(slab->blocks & ~seen);
  counts->pixels_seen += hl_pixels_of_blocks(seen);
  tile_slab uncovered = *slab;
  uncovered.blocks = seen;
  uint32_t open = sweep->content.hot->render->cover(
      slab->job, &uncovered, sweep->target.pixels + slab->tile * 4 * TILE_PIXELS, &counts->samples);
  for (uint32_t closed = seen & ~open; closed != 0; closed &= closed - 1)
    shown_from[__builtin_ctz(closed)] = first_shown(sweep, slab->job->sheet);
  return search->trying ? slab->blocks : open;
}

/* Returns whether a tile is searched first. One tile in 32 is searched first, and no two of these tiles are
 * neighbours. */
static bool is_tried(const sweep *sweep, size_t tile) {
  return (hl_tile_x(sweep, tile) + hl_tile_y(sweep, tile) * 11) % 32 == 0;
}

/* The search goes on to all tiles if the first tiles have more covered pixels for each seen pixel than this
 * number. Searching a seen pixel takes about half as long as lighting a covered pixel (measured), so from 0.5
 * on the search would pay. The number is higher because a few tiles are no sure sign. */
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
  double seen = 0, covered = 0; /* the counts are whole numbers, whose sums are the same in any order */
  for (size_t part = 0; part < parts; part++) {
    seen += (double)all[part * COUNTS + SEEN];
    covered += (double)all[part * COUNTS + COVERED];
  }
  if (with != NULL) hl_release(front->content.context, all);
  *worth = covered > COVERED_PER_SEEN * seen;
  return HL_OK;
}

/* Runs the search for hidden slabs. trying: the search visits only the tiles that are tried first, and keeps
 * opaque blocks open, so that the pixels which opaque matter covers are counted. Otherwise the search visits
 * all other tiles. */
static hl_status go_through(sweep *front, hidden_search *search, bool trying, hl_error *error) {
  search->trying = trying;
  for (size_t tile = 0; tile < front->frame_plan->picture.tiles; tile++)
    if (is_tried(front, tile) != trying) front->arrays.open[tile] = 0;
  return hl_sweep_run(front, error);
}

/* Searches the tiles that are tried first, and the other tiles if the result promises a gain. front: a sweep
 * that has begun. */
static hl_status search_tiles(sweep *front, hidden_search *search, hl_error *error) {
  /* If the tiles that are searched first depended on the part, the picture's bytes would depend on it, too.
   * So parts that exchange nothing all search first tiles of the whole picture */
  const picture_share *own = front->share, whole = {.parts = 1};
  bool worth = false;
  if (own->exchange == NULL) front->share = &whole;
  hl_sweep_open(front);
  hl_status status = go_through(front, search, true, error);
  if (status == HL_OK) status = is_worth_while(front, &worth, error);
  front->share = own;
  if (!worth) return status;
  hl_sweep_open(front);
  return go_through(front, search, false, error);
}

hl_status hl_find_hidden(const sweep_means *means, const frame_plan *frame_plan, const sweep_plan *plan,
                         float *pixels, int32_t **shown_from, hl_render_statistics *statistics,
                         hl_error *error) {
  const size_t tiles = frame_plan->picture.tiles;
  *shown_from = NULL;
  if (!plan->geometry->back_to_front) return HL_OK;
  *shown_from = hl_allocate_zeroed(means->context, tiles * TILE_BLOCKS, sizeof **shown_from);
  if (*shown_from == NULL)
    return hl_fail_memory(error, tiles * TILE_BLOCKS * sizeof **shown_from, "what is hidden");
  hidden_search search = {.shown_from = *shown_from};
  const sweep_sheets turned = turned_round(&plan->geometry->sheets);
  const sweep_plan of_search = {.geometry = &turned};
  const sweep_target target = {.pixels = pixels};
  sweep front;
  hl_sweep_set_up(&front, means, frame_plan, &of_search, &target);
  front.act = (sweep_act){SWEEP_SEARCH, cover_tile, &search};
  hl_status status = hl_sweep_begin(&front, NULL, NULL, error);
  if (status == HL_OK) status = search_tiles(&front, &search, error);
  if (status == HL_OK) hl_sweep_count(&front, statistics);
  hl_sweep_end(&front);
  /* the search has left opacities in the pixels; this sets them to zero again */
  hl_pool_clear(means->pool, pixels, tiles * TILE_PIXELS * 4 * sizeof *pixels);
  return status;
}
