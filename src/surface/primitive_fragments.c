/* surface/primitive_fragments.c - see primitive_fragments.h. */
#include "surface/primitive_fragments.h"

#include "core/memory.h"
#include "elementary/elementary.h"
#include "mesh/mesh.h"
#include "surface/primitive_raster.h"

bool hl_tile_make_room(hl_context *context, fragment_worker *worker, size_t more) {
  size_t wanted = worker->count + more;
  if (wanted <= worker->room) return true;
  size_t larger = wanted > 2 * worker->room ? wanted : 2 * worker->room;
  fragment *scratch = hl_reallocate(context, worker->scratch, larger * 2, sizeof *scratch);
  if (scratch != NULL) worker->scratch = scratch;
  order_key *keys = scratch != NULL ? hl_reallocate(context, worker->keys, larger * 2, sizeof *keys) : NULL;
  worker->failed = keys == NULL;
  if (worker->failed) return false;
  worker->keys = keys;
  worker->room = larger;
  return true;
}

/* Joins an opaque fragment to the last fragments of its pixel, if they belong to the same mesh and fill the
 * same slabs. The joined fragments absorb as much light as one surface does. Returns whether the fragments
 * were joined. */
static bool join_latest(fragment_worker *worker, const fragment *f, int32_t first, int32_t last) {
  latest_fragments *latest = &worker->latest[f->pixel];
  fragment *own = worker->scratch + latest->end - 1;
  if (latest->end > 0 && own->mesh == f->mesh && own->slab == first && latest->last == last) {
    for (int32_t i = 0; i <= last - first; i++) own[i].samples |= f->samples;
    return true;
  }
  *latest = (latest_fragments){(uint32_t)worker->count + 1, last};
  return false;
}

/* Records that an opaque fragment covers its samples from a height on. */
static void cover_pixel(fragment_worker *worker, const fragment *f, double height) {
  covered_so_far *covered = &worker->covered[f->pixel];
  if (covered->samples == 0xffff) return;
  if (covered->samples == 0 || (double)covered->height < height) covered->height = (float)height;
  covered->samples |= f->samples;
}

/* Divides a fragment's opacity among slabs. Derived: n slabs that each have the opacity 1 - (1 - a)^(1/n)
 * have the opacity a together. */
void hl_add_to_slabs(const fragment_work *work, fragment_worker *worker, fragment f, double start,
                     int32_t first, int32_t last) {
  if (work->least[f.mesh] < 1)
    last = first; /* an opacity that differs by colour cannot be divided among slabs */
  if (last - first >= MOST_SLABS) last = first + MOST_SLABS - 1;
  if (f.opacity >= 1 && work->least[f.mesh] >= 1) {
    cover_pixel(worker, &f, start);
    if (join_latest(worker, &f, first, last)) return;
  }
  if (last > first && f.opacity < 1) f.opacity = (float)(1 - hl_pow(1 - f.opacity, 1.0 / (last - first + 1)));
  for (int32_t slab = first; slab <= last; slab++) {
    f.slab = slab;
    f.height = (float)(start + (slab - first) * work->source->sheets->spacing);
    worker->scratch[worker->count++] = f;
    hl_mark_slab(work, worker, f.pixel, slab);
  }
}

/* Adds a fragment of a light's view to slabs. The first slab is the slab at the fragment's delayed height.
 * The last slab is the last slab that the fragment's plane crosses within the pixel. Near an edge at which
 * two triangles meet, it is the slab in which the other triangle begins. Fragments of back sides that get no
 * light have no delay. */
static void add_of_light(const fragment_work *work, fragment_worker *worker, const surface_plane *plane,
                         fragment f, double slope, const covered_pixel *at, const seen_seams *seams) {
  const fragments_source *source = work->source;
  double delay = plane->leaving ? 0 : source->delay * slope + LEAST_DELAY * source->sheets->spacing;
  double start = f.height + delay, highest = plane->highest + SEAM * source->sheets->spacing,
         end = fmin(f.height + source->rise * slope, highest) + delay;
  if (seams != NULL) end = hl_seam_end(source, seams, at->u, at->v, end);
  hl_add_to_slabs(work, worker, f, start, hl_slab_of(source->sheets, start), hl_slab_of(source->sheets, end));
}

static covered_pixel pixel_of(int x, int y, uint16_t samples) {
  covered_pixel pixel = {x, y, 0, 0};
  hl_fragment_middle(samples, &pixel.u, &pixel.v);
  pixel.u += x;
  pixel.v += y;
  return pixel;
}

void hl_add_pixel(const fragment_work *work, fragment_worker *worker, const surface_plane *plane, fragment f,
                  const covered_pixel *at, const seen_seams *seams) {
  const fragments_source *source = work->source;
  double height = hl_plane_height(plane, at->u, at->v);
  height = fmin(fmax(height, plane->lowest), plane->highest); /* a height that is not a number becomes the
                                                               * lowest height */
  f.slab = hl_slab_of(source->sheets, height);
  f.height = (float)height;
  f.pixel = (uint8_t)hl_pixel_number(at->x % TILE, at->y % TILE);
  hl_mark_slab(work, worker, f.pixel, f.slab);
  if (f.opacity <= 0) return;
  double slope = hl_plane_slope(plane, at->u, at->v);
  if (source->of_light) {
    add_of_light(work, worker, plane, f, slope, at, seams);
    return;
  }
  double range = plane->highest - plane->lowest,
         reach = slope < STEEPEST_SLOPE && slope < range ? slope : range;
  f.reach = hl_told_reach(reach / source->sheets->spacing);
  worker->scratch[worker->count++] = f;
}

bool hl_next_pixel(const view *view, const tile_part *part, const seen_part *seen, int at[2], fragment *f,
                   covered_pixel *pixel) {
  const pixel_span *span = &part->span;
  for (; at[1] <= span->y1; at[0] = span->x0, at[1]++)
    for (; at[0] <= span->x1; at[0]++) {
      int x = part->tile_x * TILE + at[0], y = part->tile_y * TILE + at[1];
      f->samples = part->covered[at[1] * TILE + at[0]];
      if (f->samples == 0 || x >= view->width || y >= view->height) continue;
      f->samples = hl_left_samples(seen, x, y, f->samples);
      if (f->samples == 0) continue;
      *pixel = pixel_of(x, y, f->samples);
      at[0]++;
      return true;
    }
  return false;
}

fragment hl_fragment_of(const fragment_work *work, size_t mesh_index, uint32_t primitive) {
  const fragments_source *source = work->source;
  const surface_mesh *mesh = &source->surfaces->meshes[mesh_index];
  bool counts = source->of_light || source->unseen ? mesh->look.casts_shadow : mesh->look.visible;
  return (fragment){.primitive = primitive,
                    .opacity = counts ? hl_primitive_opacity(source->surfaces, mesh, primitive) : 0,
                    .mesh = (uint16_t)mesh_index};
}

void hl_add_primitive(const fragment_work *work, fragment_worker *worker, tile_part *part, size_t mesh_index,
                      uint32_t primitive) {
  if (!hl_tile_make_room(work->source->context, worker, 2 * TILE_PIXELS * MOST_SLABS)) return;
  const surfaces *all = work->source->surfaces;
  cut_answer cut = hl_surface_cut(all, &all->meshes[mesh_index], primitive);
  if (cut == CUT_LEAVES_NOTHING) return;
  part->is_cut = cut == CUT_LEAVES_SOME;
  fragment f = hl_fragment_of(work, mesh_index, primitive);
  hl_primitive_kind(all, primitive)->raster->cover(work, worker, part, &f);
}
