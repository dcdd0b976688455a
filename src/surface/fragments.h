/* surface/fragments.h - where the rays of one view meet surfaces.
 *
 * Heights grow along every ray of a light, and grow or fall along every ray of the eye: fragments sorted by
 * height are sorted by depth.
 */
#ifndef HL_SURFACE_FRAGMENTS_H
#define HL_SURFACE_FRAGMENTS_H

#include "core/pool.h"
#include "surface/fragment.h"
#include "surface/surfaces.h"
#include "view/view.h"

/* The fragments of one view. */
typedef struct fragments {
  fragment *list;   /* owned; tile after tile; within a tile by slab, then pixel, then height */
  uint32_t *first;  /* owned; [tiles + 1]; where a tile's fragments begin */
  uint32_t *cursor; /* owned; [tiles]; the next fragment that the sweep reaches */
  size_t tiles;
} fragments;

/* The input of hl_fragments_create(); borrowed. */
typedef struct fragments_source {
  hl_context *context;
  hl_pool *pool;
  const surfaces *surfaces;
  const view *view;
  const sheet_stack *sheets;
  bool falling;  /* the view meets great heights first */
  bool of_light; /* a light's view: of the meshes that cast shadows; else of those that are visible */
  double delay;  /* pixels of the view: a fragment counts from the height that its surface's plane has so far
                    away, so that a surface does not darken itself where buffers are interpolated */
  double rise;   /* pixels of the view: a fragment of a light's view fills all slabs that its surface's plane
                    crosses within so many, so that rays of other directions than the view's find no gap
                    between pixels of a slanted surface; 0: one slab */
  uint64_t *marks; /* [sheets][tile_words], bit = tile; may be null. Bits are set for each sheet that ends a
                      slab with a visible or shadow-casting surface in the tile, and in tiles beside it */
  int tile_words;
} fragments_source;

/* About the bytes of a view's fragments, with one for each primitive and two for each pixel; *making: those
 * that making them takes besides, for a while. */
uint64_t hl_fragments_bytes(const surfaces *all, const view *view, int threads, uint64_t *making);

hl_status hl_fragments_create(const fragments_source *source, fragments *made, hl_error *error);
void hl_fragments_release(hl_context *context, fragments *made);

/* A tile's fragments in one slab. */
typedef struct fragment_range {
  const fragment *first;
  size_t count;
} fragment_range;

/* Slabs are asked for in rising order; the tile's owner asks. */
fragment_range hl_fragments_reach(const fragments *all, size_t tile, int slab);

/* The mean position of the covered samples in their pixel, 0 to 1. */
void hl_fragment_middle(uint16_t samples, double *u, double *v);

#endif
