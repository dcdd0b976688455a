/* surface/tile_fragments.c - see tile_fragments.h. */
#include "surface/tile_fragments.h"

#include <string.h>

#include "core/memory.h"
#include "surface/crossings.h"
#include "surface/primitive_fragments.h"
#include "surface/small_batch.h"

/* FIRST_BLOCK: the number of fragments for which a thread's first block has room. Each block is twice as
 * large as the block before, up to GREATEST_BLOCK fragments (6 MiB). A tile with more fragments gets a larger
 * block. */
enum { FIRST_BLOCK = 1 << 12, GREATEST_BLOCK = 1 << 18 };

/* Makes room for a tile's fragments in the worker's latest block, or in a new block. */
static bool make_room_for_tile(hl_context *context, fragment_worker *worker, size_t more) {
  fragment_block *before = worker->out;
  if (before != NULL && more <= before->room - before->count) return true;
  size_t room = before == NULL ? FIRST_BLOCK : 2 * before->room;
  room = room < GREATEST_BLOCK ? room : GREATEST_BLOCK;
  room = room > more ? room : more;
  fragment_block *block = hl_allocate(context, sizeof *block + room * sizeof *block->list, 1);
  worker->failed = block == NULL;
  if (worker->failed) return false;
  *block = (fragment_block){.before = before, .room = room};
  worker->out = block;
  return true;
}

void hl_fragment_blocks_release(hl_context *context, fragment_block *latest) {
  while (latest != NULL) {
    fragment_block *before = latest->before;
    hl_release(context, latest);
    latest = before;
  }
}

static void mark_tile(const fragment_work *work, int x, int y, int32_t slab) {
  const fragments_source *source = work->source;
  if (x < 0 || y < 0 || x >= work->tiles_x || y >= work->tiles_y) return;
  size_t tile = (size_t)y * (size_t)work->tiles_x + (size_t)x;
  uint64_t *word = source->marks + (size_t)slab * (size_t)source->tile_words + tile / 64;
  uint64_t bit = (uint64_t)1 << tile % 64;
  if ((__atomic_load_n(word, __ATOMIC_RELAXED) & bit) == 0) __atomic_fetch_or(word, bit, __ATOMIC_RELAXED);
}

/* Adds a worker's marks of slabs to the view's marks, and clears them in the worker. The marks are for the
 * tiles around the worker's current tile. */
static void write_marks(const fragment_work *work, fragment_worker *worker, int tile_x, int tile_y) {
  for (int32_t slab = worker->nearest; slab <= worker->farthest; slab++) {
    uint32_t near = work->source->marks != NULL ? worker->near[slab] : 0;
    for (; near != 0; near &= near - 1) {
      int beside = __builtin_ctz(near);
      mark_tile(work, tile_x + beside % 3 - 1, tile_y + beside / 3 - 1, slab);
    }
    worker->near[slab] = 0;
  }
  worker->nearest = INT32_MAX;
  worker->farthest = -1;
}

/* ---- small primitives ---- */

static int least(int a, int b) { return a < b ? a : b; }
static int greatest(int a, int b) { return a > b ? a : b; }

/* Adds one fragment of a primitive of a batch. lane: the primitive's number in the batch. k: the number of
 * the pixel among the primitive's pixels. */
static void add_small_pixel(const fragment_work *work, fragment_worker *worker, const small_batch *batch,
                            int lane, int k) {
  const small_cover *cover = &batch->cover;
  const fragment f = {.height = cover->height[k][lane],
                      .opacity = batch->opacity[lane],
                      .primitive = batch->primitives[lane],
                      .slab = cover->slab[k][lane],
                      .samples = cover->samples[k][lane],
                      .mesh = (uint16_t)batch->mesh,
                      .pixel = (uint8_t)cover->pixel[k][lane],
                      .reach = (uint8_t)cover->reach[k][lane]};
  hl_mark_slab(work, worker, f.pixel, f.slab);
  if (f.opacity <= 0) return;
  if (work->source->of_light) {
    hl_add_to_slabs(work, worker, f, (double)cover->start[k][lane], cover->first_slab[k][lane],
                    cover->last_slab[k][lane]);
    return;
  }
  worker->scratch[worker->count++] = f;
}

/* Finds the opacities of some primitives of a batch. lanes: one bit for each primitive of the batch; only
 * primitives whose bit is set are looked at. */
static void find_opacities(const fragment_work *work, small_batch *batch, uint32_t lanes) {
  for (; lanes != 0; lanes &= lanes - 1) {
    int lane = __builtin_ctz(lanes);
    batch->opacity[lane] = hl_fragment_of(work, batch->mesh, batch->primitives[lane]).opacity;
  }
}

/* Adds the fragments of a batch's small primitives. small: one bit for each of these primitives. */
static void add_small(const fragment_work *work, fragment_worker *worker, small_batch *batch,
                      uint32_t small) {
  if (small == 0) return;
  uint32_t any = 0;
  for (int k = 0; k < SMALL_PIXELS; k++) any |= batch->cover.covered[k] & small;
  find_opacities(work, batch, any);
  for (int k = 0; k < SMALL_PIXELS; k++)
    for (uint32_t left = batch->cover.covered[k] & small; left != 0; left &= left - 1)
      add_small_pixel(work, worker, batch, __builtin_ctz(left), k);
}

/* Adds the fragments of a batch's primitives: of small primitives together, of the others one by one. */
static void add_batch(const fragment_work *work, fragment_worker *worker, tile_part *part,
                      small_batch *batch) {
  if (batch->count == 0 ||
      !hl_tile_make_room(work->source->context, worker, SMALL_TRIANGLES * SMALL_PIXELS * MOST_SLABS))
    return;
  uint32_t all = (1u << batch->count) - 1,
           small = batch->kind->raster->cover_small(work->source->functions, batch);
  add_small(work, worker, batch, all & small);
  for (uint32_t left = all & batch->cover.large; left != 0 && !worker->failed; left &= left - 1)
    hl_add_primitive(work, worker, part, batch->mesh, batch->primitives[__builtin_ctz(left)]);
  batch->count = 0;
}

/* Returns whether fragments cover a cluster: in all pixels that the cluster touches in a tile of a light's
 * view, opaque fragments lie before the cluster. If so, the cluster's fragments need not be made, because
 * each of them would be left out when fragments are sorted. */
static bool is_covered(const fragment_work *work, const fragment_worker *worker, const tile_part *part,
                       const cluster_shape *shape, const seen_cluster *seen) {
  const view *view = work->source->view;
  int32_t low[2] = {INT32_MAX, INT32_MAX}, high[2] = {INT32_MIN, INT32_MIN};
  float lowest = INFINITY;
  for (size_t v = 0; v < shape->vertices; v++) {
    lowest = seen->height[v] < lowest ? seen->height[v] : lowest;
    low[0] = least(low[0], seen->x[v]), high[0] = greatest(high[0], seen->x[v]);
    low[1] = least(low[1], seen->y[v]), high[1] = greatest(high[1], seen->y[v]);
  }
  int left = part->tile_x * TILE, top = part->tile_y * TILE,
      right = least(least(left + TILE, view->width) - 1, high[0] >> 8),
      bottom = least(least(top + TILE, view->height) - 1, high[1] >> 8);
  left = greatest(left, low[0] >> 8), top = greatest(top, low[1] >> 8);
  for (int y = top; y <= bottom; y++)
    for (int x = left; x <= right; x++) {
      const covered_so_far *covered = &worker->covered[hl_pixel_number(x % TILE, y % TILE)];
      if (covered->samples != 0xffff || covered->height >= lowest) return false;
    }
  return true;
}

/* Adds the fragments of a cluster of triangles, none of which is cut, all together. */
static void add_cluster(const fragment_work *work, fragment_worker *worker, tile_part *part,
                        small_batch *batch, const surface_cluster *cluster) {
  const surfaces *all = work->source->surfaces;
  const surface_functions *functions = work->source->functions;
  const cluster_shape shape = hl_cluster_shape(all, cluster);
  const uint32_t *order = all->order + cluster->first;
  seen_cluster seen;
  functions->see_cluster(&batch->view, &shape, &seen);
  if (batch->may_be_covered && is_covered(work, worker, part, &shape, &seen)) return;
  for (int first = 0; first < cluster->count; first += SMALL_TRIANGLES) {
    int count = least(cluster->count - first, SMALL_TRIANGLES);
    if (!hl_tile_make_room(work->source->context, worker, SMALL_TRIANGLES * SMALL_PIXELS * MOST_SLABS))
      return;
    memcpy(batch->primitives, order + first, (size_t)count * sizeof *order);
    uint32_t small = functions->cover_cluster(&batch->view, &shape, &seen, first, (1u << count) - 1,
                                              &batch->cover);
    add_small(work, worker, batch, small);
    for (uint32_t left = batch->cover.large; left != 0 && !worker->failed; left &= left - 1) {
      uint32_t primitive = batch->primitives[__builtin_ctz(left)];
      if (!batch->view.fronts || hl_faces_view(work->seen, primitive))
        hl_add_primitive(work, worker, part, batch->mesh, primitive);
    }
  }
}

/* ---- all primitives of a tile ---- */

/* Prepares a batch for the mesh of a primitive. own: receives the mesh's primitives of this kind. */
static void begin_mesh(const fragment_work *work, small_batch *batch, uint32_t primitive,
                       primitive_range *own) {
  const surfaces *all = work->source->surfaces;
  batch->mesh = hl_surface_mesh_of(all, primitive);
  const int kind = hl_primitive_number(all, primitive);
  batch->kind = hl_primitive_kinds[kind];
  batch->view.dark_backs = work->dark_backs[batch->mesh];
  batch->view.fronts = work->wanted[batch->mesh] == BINNED_FRONTS;
  *own = all->meshes[batch->mesh].primitives[kind];
}

/* Adds the fragments of a run of primitives; cuts may remove parts of these primitives. */
static void add_run(const fragment_work *work, fragment_worker *worker, tile_part *part, small_batch *batch,
                    primitive_run run) {
  const surfaces *all = work->source->surfaces;
  const surface_cluster *cluster = run.cluster != NO_CLUSTER ? &all->clusters[run.cluster] : NULL;
  const primitive_kind *kind = batch->kind;
  if (cluster != NULL && kind->has_corners && !all->meshes[batch->mesh].is_cut) {
    add_batch(work, worker, part, batch);
    if (!worker->failed) add_cluster(work, worker, part, batch, cluster);
    return;
  }
  uint32_t count = cluster != NULL ? cluster->count : 1;
  for (uint32_t i = 0; i < count && !worker->failed; i++) {
    uint32_t p = cluster != NULL ? all->order[cluster->first + i] : run.primitive;
    if (cluster != NULL && batch->view.fronts && kind->has_corners && !hl_faces_view(work->seen, p)) continue;
    if (!kind->raster->collect(work, part, batch, p)) hl_add_primitive(work, worker, part, batch->mesh, p);
    if (batch->count == SMALL_TRIANGLES) add_batch(work, worker, part, batch);
  }
}

static void add_next_run(const fragment_work *work, fragment_worker *worker, tile_part *part,
                         small_batch *batch, primitive_run run, primitive_range *own) {
  if (run.primitive < own->first || run.primitive - own->first >= own->count) {
    add_batch(work, worker, part, batch);
    begin_mesh(work, batch, run.primitive, own);
  }
  if (!worker->failed) add_run(work, worker, part, batch, run);
}

/* A lower bound of the heights of a run's primitives. */
static float lowest_of(const fragment_work *work, primitive_run run) {
  const surfaces *all = work->source->surfaces;
  const sheet_stack *sheets = work->source->sheets;
  if (run.cluster != NO_CLUSTER) return (float)hl_lowest_height(sheets, &all->clusters[run.cluster]);
  return hl_primitive_kind(all, run.primitive)->raster->lowest(all, sheets, run.primitive);
}

static bool make_room_for_runs(hl_context *context, fragment_worker *worker, size_t count) {
  if (count <= worker->run_room) return true;
  order_key *runs = hl_reallocate(context, worker->runs, 4 * count, sizeof *runs);
  worker->failed = runs == NULL;
  if (worker->failed) return false;
  worker->runs = runs;
  worker->run_room = 2 * count;
  return true;
}

/* Adds the fragments of a tile's runs. If lower runs may cover higher runs completely, the runs are added
 * from the lowest to the highest. */
static void add_runs(const fragment_work *work, fragment_worker *worker, tile_part *part, size_t tile,
                     small_batch *batch) {
  const primitive_run *runs = work->bins->runs + work->bins->first[tile];
  uint32_t count = work->bins->first[tile + 1] - work->bins->first[tile];
  primitive_range own = {0, 0};
  if (batch->may_be_covered && !make_room_for_runs(work->source->context, worker, count)) return;
  order_key *order = worker->runs;
  for (uint32_t i = 0; batch->may_be_covered && i < count; i++)
    order[i] = (order_key){hl_ordered_bits(lowest_of(work, runs[i]), false), i};
  if (batch->may_be_covered && count > 1) hl_sort_keys(order, order + count, count);
  for (uint32_t i = 0; i < count && !worker->failed; i++)
    add_next_run(work, worker, part, batch, runs[batch->may_be_covered ? order[i].index : i], &own);
  if (!worker->failed) add_batch(work, worker, part, batch);
}

static void add_primitives(const fragment_work *work, fragment_worker *worker, tile_part *part, size_t tile) {
  small_batch batch;
  memset(&batch.triangles, 0, sizeof batch.triangles); /* cleared, because some lanes of a batch stay empty */
  memset(&batch.spheres, 0, sizeof batch.spheres);
  batch.kind = NULL;
  batch.view = work->small;
  batch.view.left = part->tile_x * TILE * SUBPIXELS;
  batch.view.top = part->tile_y * TILE * SUBPIXELS;
  batch.view.columns = least(work->source->view->width - part->tile_x * TILE, TILE);
  batch.view.rows = least(work->source->view->height - part->tile_y * TILE, TILE);
  batch.count = 0;
  batch.mesh = 0;
  batch.may_be_covered = work->source->of_light && work->source->rise <= 0;
  add_runs(work, worker, part, tile, &batch);
}

/* Sorts a tile's fragments; in the eye's view, also cuts the fragments that cross. Returns the number of
 * fragments in *sorted, which the worker owns. */
static size_t order_fragments(const fragment_work *work, fragment_worker *worker, const fragment_order *order,
                              const tile_part *part, fragment **sorted) {
  const fragments_source *source = work->source;
  *sorted = NULL;
  if (worker->count == 0) return 0;
  fragment *list = worker->scratch, *other = list + worker->room;
  size_t kept = hl_sort_by_pixel(list, worker->count, order, worker->keys, other);
  const crossing_tile crossing = {work->seen, source->sheets, order, part->tile_x * TILE,
                                  part->tile_y * TILE};
  bool parted;
  *sorted = source->of_light || source->unseen ? other : list;
  if (*sorted == other) return kept;
  kept = hl_part_crossings(&crossing, other, kept, list, &parted);
  for (size_t i = 0; parted && i < kept; i++) hl_mark_slab(work, worker, list[i].pixel, list[i].slab);
  return kept;
}

void hl_make_tile_fragments(void *data, size_t tile, int worker_index) {
  const fragment_work *work = data;
  const fragments_source *source = work->source;
  fragment_worker *worker = &work->workers[worker_index];
  const fragment_order order = {work->least, source->falling, source->rise > 0, source->unseen,
                                source->sheets->spacing};
  tile_part part = {.tile_x = (int)(tile % (size_t)work->tiles_x),
                    .tile_y = (int)(tile / (size_t)work->tiles_x)};
  fragment *sorted = NULL;
  size_t kept = 0;
  work->tiles[tile] = (tile_list){0};
  worker->count = 0;
  memset(worker->latest, 0, sizeof worker->latest);
  memset(worker->covered, 0, sizeof worker->covered);
  if (worker->failed || (source->needed != NULL && source->needed[tile] == 0)) return;
  add_primitives(work, worker, &part, tile);
  /* Makes room for the parts into which crossing fragments are cut. */
  if (!worker->failed && hl_tile_make_room(source->context, worker, worker->count))
    kept = order_fragments(work, worker, &order, &part, &sorted);
  write_marks(work, worker, part.tile_x, part.tile_y);
  kept = hl_resolve_fragments(sorted, kept, &order);
  if (kept == 0 || !make_room_for_tile(source->context, worker, kept)) return;
  fragment *list = worker->out->list + worker->out->count;
  hl_sort_by_slab(sorted, kept, &order, worker->places, source->sheets->count, list);
  work->tiles[tile] = (tile_list){.list = list, .count = (uint32_t)kept};
  worker->out->count += kept;
}

/* ---- begin and end ---- */

static void set_small_view(const fragments_source *source, small_view *small) {
  const view *view = source->view;
  const sheet_stack *sheets = source->sheets;
  *small = (small_view){.first = (float)sheets->first,
                        .spacing = (float)sheets->spacing,
                        .last_slab = (float)(sheets->count - 1),
                        .of_light = source->of_light,
                        .perspective = view->perspective,
                        .delay = (float)source->delay,
                        .rise = (float)source->rise,
                        .view = view,
                        .sheets = sheets};
  vec3_store(small->normal, sheets->normal);
  vec3_store(small->from, view->perspective ? view->origin : view->direction);
  vec3_store(small->du, view->du);
  vec3_store(small->dv, view->dv);
  vec3_store(small->depth, view->inverse.row[0]);
  const vec3 *rows = view->inverse.row, origin = view->perspective ? view->origin : view->corner;
  for (int i = 0; i < 3; i++)
    small->inverse[i][0] = rows[i].x, small->inverse[i][1] = rows[i].y, small->inverse[i][2] = rows[i].z;
  small->origin[0] = origin.x, small->origin[1] = origin.y, small->origin[2] = origin.z;
}

/* The tiles that look-ups around a pixel may read: the pixel's own tile, and the tiles less than three pixels
 * away. */
static uint16_t tiles_near(int column, int row) {
  uint32_t across = 2u | (column < 3) | (uint32_t)(column >= TILE - 3) << 2;
  return (uint16_t)((row < 3 ? across : 0) | across << 3 | (row >= TILE - 3 ? across << 6 : 0));
}

void hl_fragment_work_begin(fragment_work *work) {
  set_small_view(work->source, &work->small);
  for (int row = 0; row < TILE; row++)
    for (int column = 0; column < TILE; column++)
      work->near[hl_pixel_number(column, row)] = tiles_near(column, row);
}

bool hl_fragment_worker_begin(hl_context *context, fragment_worker *worker, int sheets) {
  worker->places = hl_allocate(context, (size_t)sheets + 2, sizeof *worker->places);
  worker->near = hl_allocate_zeroed(context, (size_t)sheets + 1, sizeof *worker->near);
  worker->nearest = INT32_MAX;
  worker->farthest = -1;
  return worker->places != NULL && worker->near != NULL;
}

void hl_fragment_worker_end(hl_context *context, fragment_worker *worker) {
  void *owned[] = {worker->scratch, worker->keys, worker->runs, worker->places, worker->near};
  for (size_t i = 0; i < sizeof owned / sizeof *owned; i++) hl_release(context, owned[i]);
}
