/* surface/fragments.c - makes the fragments of a view, tile by tile, with several threads. */
#include "surface/fragments.h"

#include <string.h>

#include "core/memory.h"
#include "mesh/mesh.h"
#include "scene/check/limits.h"

_Static_assert(HL_LIMIT_MESHES + HL_LIMIT_VOLUMES * HL_LIMIT_ISO <= 65536, "a fragment's mesh has 16 bits");

void hl_fragments_count(const surfaces *all, const view *view, int threads, hl_layout *layout) {
  const size_t primitives = hl_surfaces_count(all), pixels = hl_view_tiles(view) * TILE_PIXELS;
  hl_layout_take(layout, primitives + 2 * pixels, sizeof(fragment));
  const size_t kept = layout->bytes;
  hl_primitive_bins_count(all, view, layout);
  hl_layout_take(layout, (size_t)threads * 2 * 2 * TILE_PIXELS * MOST_SLABS,
                 sizeof(fragment) + sizeof(order_key));
  hl_layout_give_back(layout, kept);
}

/* Takes over, from a worker, the memory blocks with the fragments of the tiles that the worker has
 * finished. */
static void keep_blocks(fragment_worker *worker, fragments *made) {
  fragment_block *first = worker->out;
  if (first == NULL) return;
  while (first->before != NULL) first = first->before;
  first->before = made->blocks;
  made->blocks = worker->out;
  worker->out = NULL;
}

static hl_status rasterise(fragment_work *work, fragments *made, hl_error *error) {
  hl_context *context = work->source->context;
  size_t threads = (size_t)hl_pool_threads(work->source->pool);
  bool room = true;
  for (size_t w = 0; w < threads; w++) {
    fragment_worker *worker = &work->workers[w];
    worker->failed = !hl_fragment_worker_begin(context, worker, work->source->sheets->count);
  }
  hl_pool_run(work->source->pool, made->tiles, hl_make_tile_fragments, work);
  for (size_t w = 0; w < threads; w++) room = room && !work->workers[w].failed;
  hl_status status = HL_OK;
  if (hl_pool_cancelled(work->source->pool))
    status = hl_fail(error, HL_ERROR_CANCELLED, "cancelled while rendering");
  else status = room ? HL_OK : hl_fail_memory(error, sizeof(fragment), "the surfaces' fragments");
  for (size_t w = 0; w < threads; w++) {
    keep_blocks(&work->workers[w], made);
    hl_fragment_worker_end(context, &work->workers[w]);
  }
  return status;
}

/* Returns whether the origin of a view's rays surely lies outside of a mesh. If the rays begin at a point, it
 * does if this point lies outside of the mesh's box. */
static bool is_outside(const view *view, const surface_mesh *mesh) {
  return !view->perspective || hl_surface_is_outside(mesh, view->origin, 0);
}

/* Returns whether the eye sees no back side of a mesh: the mesh is closed and opaque, and the eye is outside
 * of it. */
static bool has_hidden_backs(const fragments_source *source, const surface_mesh *mesh) {
  return !source->of_light && !source->unseen && hl_surface_is_closed(mesh) && mesh->colors == NULL &&
         mesh->face_colors == NULL && is_outside(source->view, mesh);
}

/* Returns whether a light lights no back side of a mesh: the mesh is closed and lets no light through, and
 * the light is outside of it. */
static bool has_dark_backs(const fragments_source *source, const surface_mesh *mesh) {
  return source->of_light && hl_surface_is_closed(mesh) && hl_surface_is_opaque(mesh) &&
         is_outside(source->view, mesh);
}

/* Decides which primitives of a mesh are made into fragments in a view. */
static binned wanted_of(const fragments_source *source, const surface_mesh *mesh) {
  bool shades = mesh->look.casts_shadow, seen_here = source->unseen
                                                         ? shades && !mesh->look.visible
                                                         : mesh->look.visible || (source->of_light && shades);
  return !seen_here ? BINNED_NOTHING : has_hidden_backs(source, mesh) ? BINNED_FRONTS : BINNED_ALL;
}

/* Finds the properties of each mesh that its fragments need in this view. */
static void describe_meshes(const fragments_source *source, float *least, bool *dark_backs) {
  for (size_t m = 0; m < source->surfaces->mesh_count; m++) {
    const surface_mesh *mesh = &source->surfaces->meshes[m];
    const double *color = mesh->look.attenuation_color;
    least[m] = source->of_light ? (float)fmin(color[0], fmin(color[1], color[2])) : 1;
    dark_backs[m] = has_dark_backs(source, mesh);
  }
}

static hl_status make_tiles(fragment_work *work, fragments *made, hl_error *error) {
  const fragments_source *source = work->source;
  hl_context *context = source->context;
  work->least = hl_allocate(context, source->surfaces->mesh_count, sizeof *work->least);
  work->dark_backs = hl_allocate(context, source->surfaces->mesh_count, sizeof *work->dark_backs);
  work->workers = hl_allocate_zeroed(context, (size_t)hl_pool_threads(source->pool), sizeof *work->workers);
  work->tiles = made->of = hl_allocate_zeroed(context, made->tiles, sizeof *made->of);
  hl_status status;
  if (made->of == NULL || work->workers == NULL || work->least == NULL || work->dark_backs == NULL) {
    status = hl_fail_memory(error, made->tiles * sizeof *work->tiles, "the surfaces' fragments");
  } else {
    describe_meshes(source, work->least, work->dark_backs);
    hl_fragment_work_begin(work);
    status = rasterise(work, made, error);
  }
  hl_release(context, work->least);
  hl_release(context, work->dark_backs);
  hl_release(context, work->workers);
  return status;
}

/* Sorts the primitives into tiles, and makes the tiles' fragments. work->seen must have been set before. */
static hl_status bin_and_make(fragment_work *work, fragments *made, hl_error *error) {
  const fragments_source *source = work->source;
  const surfaces *all = source->surfaces;
  primitive_bins bins = {0};
  hl_status status = HL_OK;
  work->wanted = hl_allocate(source->context, all->mesh_count, sizeof *work->wanted);
  if (work->wanted == NULL)
    return hl_fail_memory(error, all->mesh_count * sizeof *work->wanted, "the meshes");
  for (size_t m = 0; m < all->mesh_count; m++) work->wanted[m] = wanted_of(source, &all->meshes[m]);
  status = hl_primitive_bins_create(source->context, source->pool, work->seen, work->wanted, &bins, error);
  work->bins = &bins;
  if (status == HL_OK) status = make_tiles(work, made, error);
  hl_primitive_bins_release(source->context, &bins);
  hl_release(source->context, work->wanted);
  return status;
}

hl_status hl_fragments_create(const fragments_source *source, fragments *made, hl_error *error) {
  const seen_surfaces seen = {source->view, source->surfaces};
  fragment_work work = {.source = source,
                        .seen = &seen,
                        .tiles_x = hl_tiles(source->view->width),
                        .tiles_y = hl_tiles(source->view->height)};
  *made = (fragments){.tiles = (size_t)work.tiles_x * (size_t)work.tiles_y};
  hl_status status = bin_and_make(&work, made, error);
  if (status != HL_OK) hl_fragments_release(source->context, made);
  return status;
}

void hl_fragments_release(hl_context *context, fragments *made) {
  hl_fragment_blocks_release(context, made->blocks);
  hl_release(context, made->of);
  *made = (fragments){0};
}

fragment_range hl_fragments_reach(const fragments *all, size_t tile, int slab) {
  tile_list *of = &all->of[tile];
  uint32_t at = of->reached;
  if (at == of->count) return (fragment_range){NULL, 0};
  while (at < of->count && of->list[at].slab < slab) at++;
  fragment_range range = {of->list + at, 0};
  while (at < of->count && of->list[at].slab == slab) at++, range.count++;
  of->reached = at;
  return range;
}

fragment_range hl_fragments_reached(const fragments *all, size_t tile, int first) {
  const tile_list *of = &all->of[tile];
  uint32_t at = of->reached;
  if (at == 0) return (fragment_range){NULL, 0};
  while (at > 0 && of->list[at - 1].slab >= first) at--;
  return (fragment_range){of->list + at, of->reached - at};
}
