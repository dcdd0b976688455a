/* surface/fragments.h - makes the fragments of one view: the places where the view's rays meet surfaces.
 *
 * Heights grow along every ray of a light. Along the eye's rays, they either grow on all rays or fall on all
 * rays. So fragments that are sorted by height are also sorted by depth. */
#ifndef HL_SURFACE_FRAGMENTS_H
#define HL_SURFACE_FRAGMENTS_H

#include "core/memory.h"
#include "surface/tile_fragments.h"

/* The fragments of one view. */
typedef struct fragments {
  tile_list *of;          /* owned; [tiles]; the fragments of each tile; null if the view has no surfaces */
  fragment_block *blocks; /* owned; the blocks of memory in which the tiles' fragments lie */
  size_t tiles;
} fragments;

/* Counts approximately the memory that hl_fragments_create() takes. The number of fragments is known only
 * when they are made. The estimate is one fragment for each primitive plus two fragments for each pixel. */
void hl_fragments_count(const surfaces *all, const view *view, int threads, hl_layout *layout);

hl_status hl_fragments_create(const fragments_source *source, fragments *made, hl_error *error);
void hl_fragments_release(hl_context *context, fragments *made);

/* A tile's fragments in one slab. */
typedef struct fragment_range {
  const fragment *first;
  size_t count;
} fragment_range;

/* The fragments of a tile in one slab. The tile's owner asks for slabs in rising order. */
fragment_range hl_fragments_reach(const fragments *all, size_t tile, int slab);

/* The fragments of a tile from slab `first` to the slab that was asked for last. */
fragment_range hl_fragments_reached(const fragments *all, size_t tile, int first);

#endif
