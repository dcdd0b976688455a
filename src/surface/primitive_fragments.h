/* surface/primitive_fragments.h - the fragments of one triangle or sphere in a tile.
 *
 * In: what a view shares (fragment_work.h), a primitive and a tile. Out: fragments at the end of the
 * worker's scratch, in the order of the tile's pixels, and marks about them. tile_fragments.c adds small
 * primitives, sixteen at a time; this file adds all others. */
#ifndef HL_SURFACE_PRIMITIVE_FRAGMENTS_H
#define HL_SURFACE_PRIMITIVE_FRAGMENTS_H

#include "surface/coverage.h"
#include "surface/fragment_work.h"
#include "surface/late/seen_seams.h"
#include "surface/surface_cuts.h"
#include "surface/surface_plane.h"

/* The part of a primitive in a tile: the samples that it covers, without those that cuts remove. */
typedef struct tile_part {
  int tile_x, tile_y;
  bool is_cut; /* cuts remove some of the primitive */
  pixel_span span;
  uint16_t covered[TILE_PIXELS];
} tile_part;

/* Makes room for a number of further fragments of a tile. False: there is no memory, and the worker is
 * marked as failed. */
bool hl_tile_make_room(hl_context *context, fragment_worker *worker, size_t more);

/* Marks that a slab has a surface in the tiles around a pixel. pixel: the pixel's number in the tile, block
 * after block. */
static inline void hl_mark_slab(const fragment_work *work, fragment_worker *worker, int pixel, int32_t slab) {
  worker->near[slab] |= work->near[pixel];
  worker->nearest = slab < worker->nearest ? slab : worker->nearest;
  worker->farthest = slab > worker->farthest ? slab : worker->farthest;
}

/* A fragment of a primitive, whose pixel, height and slab are not set yet. Its opacity is 0 where it only
 * marks slabs. */
fragment hl_fragment_of(const fragment_work *work, size_t mesh_index, uint32_t primitive);

/* Adds a fragment to the slabs from `first` to `last` of a light's view, from its delayed height `start`
 * on. There must be room for MOST_SLABS. */
void hl_add_to_slabs(const fragment_work *work, fragment_worker *worker, fragment f, double start,
                     int32_t first, int32_t last);

/* A pixel of a view, and the mean position of the samples that a surface covers in it. */
typedef struct covered_pixel {
  int x, y;
  double u, v;
} covered_pixel;

/* Finds the next pixel that has covered samples, from the tile's column at[0] and row at[1] on. False: there
 * is no such pixel. */
bool hl_next_pixel(const view *view, const tile_part *part, const seen_part *seen, int at[2], fragment *f,
                   covered_pixel *pixel);

/* Adds a fragment that lies at a pixel of a plane, and marks its slab. seams: the corners of the triangle
 * in a light's view; null: none. */
void hl_add_pixel(const fragment_work *work, fragment_worker *worker, const surface_plane *plane, fragment f,
                  const covered_pixel *at, const seen_seams *seams);

/* Adds a primitive's fragments in a tile, and makes room for them. */
void hl_add_primitive(const fragment_work *work, fragment_worker *worker, tile_part *part, size_t mesh_index,
                      uint32_t primitive);

#endif
