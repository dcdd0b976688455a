/* surface/primitive_fragments.h - makes the fragments of one triangle or sphere in a tile.
 *
 * In: the data that the tiles of a view share (fragment_work.h), a primitive and a tile. Out: fragments at
 * the end of the worker's scratch, in the order of the tile's pixels, and marks of slabs that have surfaces.
 * tile_fragments.c adds small primitives, sixteen at a time; this file adds all others. */
#ifndef HL_SURFACE_PRIMITIVE_FRAGMENTS_H
#define HL_SURFACE_PRIMITIVE_FRAGMENTS_H

#include "surface/coverage.h"
#include "surface/fragment_work.h"
#include "surface/late/seen_seams.h"
#include "surface/surface_cuts.h"
#include "surface/surface_plane.h"

/* The part of a primitive that a view sees in one tile: the samples that the primitive covers, without the
 * samples that cuts remove. */
typedef struct tile_part {
  int tile_x, tile_y;
  bool is_cut; /* whether cuts remove some of the primitive */
  pixel_span span;
  uint16_t covered[TILE_PIXELS];
} tile_part;

/* Makes room for a number of further fragments of a tile. Returns false if there is no memory; the worker is
 * then marked as failed. */
bool hl_tile_make_room(hl_context *context, fragment_worker *worker, size_t more);

/* Marks that a slab has a surface in the tiles around a pixel. pixel: number of the pixel in the tile, block
 * after block. */
static inline void hl_mark_slab(const fragment_work *work, fragment_worker *worker, int pixel, int32_t slab) {
  worker->near[slab] |= work->near[pixel];
  worker->nearest = slab < worker->nearest ? slab : worker->nearest;
  worker->farthest = slab > worker->farthest ? slab : worker->farthest;
}

/* Makes a fragment of a primitive. The caller sets the fragment's pixel, height and slab. Its opacity is 0 if
 * the fragment only serves to mark slabs. */
fragment hl_fragment_of(const fragment_work *work, size_t mesh_index, uint32_t primitive);

/* Adds a fragment to slabs `first` to `last` of a light's view. Light meets the fragment at
 * the height `start`, which lies a little behind the surface, so that the surface does not shade itself.
 * There must be room for MOST_SLABS fragments. */
void hl_add_to_slabs(const fragment_work *work, fragment_worker *worker, fragment f, double start,
                     int32_t first, int32_t last);

/* A pixel of a view, and the mean position of the samples that a surface covers in it. */
typedef struct covered_pixel {
  int x, y;
  double u, v;
} covered_pixel;

/* Finds the next pixel with covered samples, from the tile's column at[0] and row at[1] on. Returns false if
 * there is no such pixel. */
bool hl_next_pixel(const view *view, const tile_part *part, const seen_part *seen, int at[2], fragment *f,
                   covered_pixel *pixel);

/* Adds the fragment of a plane at a pixel, and marks its slab. seams: in a light's view, the corners of the
 * triangle; null if there is none. */
void hl_add_pixel(const fragment_work *work, fragment_worker *worker, const surface_plane *plane, fragment f,
                  const covered_pixel *at, const seen_seams *seams);

/* Makes room for a primitive's fragments in a tile, and adds them. */
void hl_add_primitive(const fragment_work *work, fragment_worker *worker, tile_part *part, size_t mesh_index,
                      uint32_t primitive);

#endif
