/* surface/primitive_bins.c - see primitive_bins.h. */
#include "surface/primitive_bins.h"

#include <string.h>

#include "core/memory.h"
#include "surface/primitive_raster.h"

enum { LEAST_A_TASK = 1 << 8, MOST_TASKS = 32 };

/* A cluster of primitives with corners is put into tiles as a whole if it touches at most this many tiles;
 * its vertices are then projected together. A cluster of primitives without corners is put into tiles as a
 * whole only if it touches a single tile. The primitives of all other clusters are put into tiles one by
 * one. */
enum { MOST_TILES_TOGETHER = 9 };

/* The tiles that a primitive touches: from x0 and y0 to x1 and y1, both included. If x0 is greater than x1,
 * it touches no tiles. */
typedef struct tile_span {
  uint16_t x0, y0, x1, y1;
} tile_span;

typedef struct bin_work {
  const seen_surfaces *seen;
  const binned *wanted;
  primitive_bins *bins;
  tile_span *spans; /* [primitives]; the tiles that a primitive touches, for primitives that are put into
                     * tiles one by one */
  /* [tasks][tiles]; in the first pass the number of runs (primitive_bins.h) that a task adds to a tile, in
   * the second pass the index at which the task stores its next run for this tile */
  uint32_t *places;
  size_t tiles, tasks;
  size_t a_task; /* the number of clusters that a task sorts */
  int tiles_x, tiles_y;
} bin_work;

static uint16_t clamp_tile(int32_t tile, int tiles) {
  return (uint16_t)(tile < 0 ? 0 : tile >= tiles ? tiles - 1 : tile);
}

static void set_bounds_span(const bin_work *work, const seen_bounds *bounds, tile_span *span) {
  const double limit = 1 << 20; /* limits tiles to numbers that 32-bit whole numbers surely hold */
  int32_t at[4];
  const double ends[4] = {bounds->u0, bounds->v0, bounds->u1, bounds->v1};
  for (int i = 0; i < 4; i++) at[i] = (int32_t)floor(fmin(fmax(ends[i] / TILE, -limit), limit));
  *span = (tile_span){clamp_tile(at[0], work->tiles_x), clamp_tile(at[1], work->tiles_y),
                      clamp_tile(at[2], work->tiles_x), clamp_tile(at[3], work->tiles_y)};
}

static void find_span(const bin_work *work, uint32_t primitive, binned wanted, tile_span *span) {
  const surfaces *all = work->seen->all;
  seen_bounds bounds;
  *span = (tile_span){1, 1, 0, 0};
  const primitive_raster *raster = hl_primitive_kind(all, primitive)->raster;
  if (raster->see(work->seen, primitive, wanted == BINNED_FRONTS, &bounds))
    set_bounds_span(work, &bounds, span);
}

static int tiles_of(const tile_span *span) {
  return span->x0 > span->x1 ? 0 : (span->x1 - span->x0 + 1) * (span->y1 - span->y0 + 1);
}

/* Finds the tiles that a cluster touches. *whole: receives whether the cluster's primitives may be put into
 * each of these tiles together. */
static void find_cluster_span(const bin_work *work, const surface_cluster *cluster, tile_span *span,
                              bool *whole) {
  const view *view = work->seen->view;
  binned wanted = work->wanted[cluster->mesh];
  seen_bounds bounds;
  *span = (tile_span){1, 1, 0, 0};
  *whole = true;
  if (wanted == BINNED_NOTHING) return;
  if (wanted == BINNED_FRONTS && hl_cluster_faces_away(cluster, view)) return;
  seen_box box = hl_see_box(view, cluster->low, cluster->high, &bounds);
  if (box == BOX_UNSEEN) return;
  if (box == BOX_WHOLE) set_bounds_span(work, &bounds, span);
  *whole = box == BOX_WHOLE &&
           tiles_of(span) <= (hl_has_corners(work->seen->all, cluster->first) ? MOST_TILES_TOGETHER : 1);
}

static void task_range(const bin_work *work, size_t index, size_t *first, size_t *end) {
  size_t count = work->seen->all->cluster_count;
  *first = index * work->a_task;
  *end = *first + work->a_task < count ? *first + work->a_task : count;
}

/* Adds a run to each tile of a span. In the first pass the run is only counted, in the second pass it is
 * stored. */
static void add_run(const bin_work *work, uint32_t *places, const tile_span *span, primitive_run run) {
  for (int y = span->y0; y <= span->y1; y++)
    for (int x = span->x0; x <= span->x1; x++) {
      uint32_t place = places[(size_t)y * (size_t)work->tiles_x + (size_t)x]++;
      if (work->bins->runs != NULL) work->bins->runs[place] = run;
    }
}

static void add_one_by_one(const bin_work *work, uint32_t *places, const surface_cluster *cluster) {
  for (uint32_t i = cluster->first; i < cluster->first + cluster->count; i++) {
    uint32_t p = work->seen->all->order[i];
    if (work->bins->runs == NULL) find_span(work, p, work->wanted[cluster->mesh], &work->spans[p]);
    add_run(work, places, &work->spans[p], (primitive_run){p, NO_CLUSTER});
  }
}

/* Counts the runs that a task's clusters add to each tile. Once there is memory for the runs, a second call
 * stores the runs. */
static void bin_task(void *data, size_t index, int worker) {
  (void)worker;
  const bin_work *work = data;
  uint32_t *places = work->places + index * work->tiles;
  size_t first, end;
  task_range(work, index, &first, &end);
  for (size_t c = first; c < end; c++) {
    const surface_cluster *cluster = &work->seen->all->clusters[c];
    tile_span span;
    bool whole;
    find_cluster_span(work, cluster, &span, &whole);
    if (whole)
      add_run(work, places, &span, (primitive_run){work->seen->all->order[cluster->first], (uint32_t)c});
    else add_one_by_one(work, places, cluster);
  }
}

/* Turns the number of runs that each task adds to each tile into the index of the first of these runs.
 * Returns false if there are more than 2^32 runs. */
static bool find_places(bin_work *work) {
  uint64_t sum = 0;
  for (size_t tile = 0; tile < work->tiles; tile++) {
    work->bins->first[tile] = (uint32_t)sum;
    for (size_t task = 0; task < work->tasks; task++) {
      uint32_t count = work->places[task * work->tiles + tile];
      work->places[task * work->tiles + tile] = (uint32_t)sum;
      sum += count;
    }
  }
  work->bins->first[work->tiles] = (uint32_t)sum;
  return sum <= UINT32_MAX;
}

/* ---- memory ---- */

static bin_work work_of(const surfaces *all, const view *view) {
  bin_work work = {.tiles_x = hl_tiles(view->width), .tiles_y = hl_tiles(view->height)};
  work.tiles = (size_t)work.tiles_x * (size_t)work.tiles_y;
  work.a_task = all->cluster_count / MOST_TASKS + 1;
  if (work.a_task < LEAST_A_TASK) work.a_task = LEAST_A_TASK;
  work.tasks = (all->cluster_count + work.a_task - 1) / work.a_task;
  return work;
}

static void lay_out(const surfaces *all, bin_work *work, hl_layout *layout) {
  work->places = hl_layout_take(layout, work->tasks * work->tiles, sizeof *work->places);
  work->spans = hl_layout_take(layout, hl_surfaces_count(all), sizeof *work->spans);
}

static void lay_out_bins(const bin_work *work, primitive_bins *bins, hl_layout *layout) {
  bins->first = hl_layout_take(layout, work->tiles + 1, sizeof *bins->first);
}

static void lay_out_runs(size_t runs, primitive_bins *bins, hl_layout *layout) {
  bins->runs = hl_layout_take(layout, runs, sizeof *bins->runs);
}

void hl_primitive_bins_count(const surfaces *all, const view *view, hl_layout *layout) {
  bin_work work = work_of(all, view);
  primitive_bins bins;
  lay_out_bins(&work, &bins, layout);
  lay_out_runs(hl_surfaces_count(all), &bins, layout);
  const size_t kept = layout->bytes;
  lay_out(all, &work, layout);
  hl_layout_give_back(layout, kept);
}

/* ---- all bins ---- */

static hl_status fill_bins(hl_context *context, hl_pool *pool, bin_work *work, hl_error *error) {
  hl_layout passing = {0}, runs = {0};
  while (hl_layout_pass(&passing, context)) lay_out(work->seen->all, work, &passing);
  if (passing.base == NULL) return hl_fail_memory(error, passing.bytes, "surfaces sorted by tiles");
  memset(work->places, 0, work->tasks * work->tiles * sizeof *work->places);
  hl_pool_run(pool, work->tasks, bin_task, work);
  if (find_places(work))
    while (hl_layout_pass(&runs, context)) lay_out_runs(work->bins->first[work->tiles], work->bins, &runs);
  if (runs.base != NULL) hl_pool_run(pool, work->tasks, bin_task, work);
  hl_release(context, passing.base);
  return runs.base != NULL ? HL_OK : hl_fail_memory(error, runs.bytes, "surfaces sorted by tiles");
}

hl_status hl_primitive_bins_create(hl_context *context, hl_pool *pool, const seen_surfaces *seen,
                                   const binned *wanted, primitive_bins *bins, hl_error *error) {
  bin_work work = work_of(seen->all, seen->view);
  hl_layout layout = {0};
  work.seen = seen;
  work.wanted = wanted;
  work.bins = bins;
  *bins = (primitive_bins){0};
  while (hl_layout_pass(&layout, context)) lay_out_bins(&work, bins, &layout);
  if (layout.base == NULL) return hl_fail_memory(error, layout.bytes, "surfaces sorted by tiles");
  hl_status status = fill_bins(context, pool, &work, error);
  if (status != HL_OK) hl_primitive_bins_release(context, bins);
  return status;
}

void hl_primitive_bins_release(hl_context *context, primitive_bins *bins) {
  hl_release(context, bins->first);
  hl_release(context, bins->runs);
  *bins = (primitive_bins){0};
}
