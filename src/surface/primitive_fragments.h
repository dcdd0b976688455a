/* surface/primitive_fragments.h - the fragments of one triangle or sphere in a tile.
 *
 * In: what a view shares (fragment_work.h), a primitive and a tile. Out: fragments at the end of the worker's
 * scratch, in the order of the tile's pixels, and marks about them. tile_fragments.c adds the primitives that
 * are small sixteen at a time, and the others here. */
#ifndef HL_SURFACE_PRIMITIVE_FRAGMENTS_H
#define HL_SURFACE_PRIMITIVE_FRAGMENTS_H

#include "surface/coverage.h"
#include "surface/fragment_work.h"
#include "surface/late/seen_seams.h"
#include "surface/surface_cuts.h"
#include "surface/surface_plane.h"

/* The part of a primitive in a tile: what its samples cover, and what cuts leave of that. */
typedef struct tile_part {
  int tile_x, tile_y;
  bool is_cut; /* cuts remove some of the primitive */
  pixel_span span;
  uint16_t covered[TILE_PIXELS];
} tile_part;

/* Makes room for so many more fragments of a tile; false, and the worker has failed: there is no memory. */
bool hl_tile_make_room(hl_context *context, fragment_worker *worker, size_t more);

/* Marks a slab about a pixel, block after block. */
static inline void hl_mark_slab(const fragment_work *work, fragment_worker *worker, int pixel, int32_t slab) {
  worker->near[slab] |= work->near[pixel];
  worker->nearest = slab < worker->nearest ? slab : worker->nearest;
  worker->farthest = slab > worker->farthest ? slab : worker->farthest;
}

/* A fragment of a primitive, as yet without a place: its opacity is 0 where it only marks slabs. */
fragment hl_fragment_of(const fragment_work *work, size_t mesh_index, uint32_t primitive);

/* Adds a fragment to the slabs first to last of a light's view, from its delayed height `start` on. There
 * must be room for MOST_SLABS. */
void hl_add_to_slabs(const fragment_work *work, fragment_worker *worker, fragment f, double start,
                     int32_t first, int32_t last);

/* A pixel of a view, and the middle of the samples that a surface covers of it. */
typedef struct covered_pixel {
  int x, y;
  double u, v;
} covered_pixel;

/* The next pixel of the view, from the tile's column at[0] and row at[1] on, of which samples are covered;
 * false: there is none. */
bool hl_next_pixel(const view *view, const tile_part *part, const seen_part *seen, int at[2], fragment *f,
                   covered_pixel *pixel);

/* Adds a fragment that lies at a pixel of a plane, and marks its slab. seams: of a light's view; null: none.
 */
void hl_add_pixel(const fragment_work *work, fragment_worker *worker, const surface_plane *plane, fragment f,
                  const covered_pixel *at, const seen_seams *seams);

/* Adds a primitive's fragments in a tile, and makes room for them. */
void hl_add_primitive(const fragment_work *work, fragment_worker *worker, tile_part *part, size_t mesh_index,
                      uint32_t primitive);

#endif
