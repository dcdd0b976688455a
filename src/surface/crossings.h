/* surface/crossings.h - cuts fragments of a pixel into parts where their surfaces cross within the pixel.
 *
 * Each fragment is composited at one height. But if two surfaces cross within a pixel, their order differs
 * from sample to sample. Fragments that cross within a pixel are therefore cut into parts. The line on which
 * the surfaces cross then looks as smooth as the edges of surfaces. */
#ifndef HL_SURFACE_CROSSINGS_H
#define HL_SURFACE_CROSSINGS_H

#include "surface/fragment_order.h"
#include "surface/seen.h"
#include "surface/surface_plane.h"

/* A tile of the eye's view. All members are borrowed. */
typedef struct crossing_tile {
  const seen_surfaces *seen;
  const sheet_stack *sheets;
  const fragment_order *order;
  int x, y; /* column and row of the tile's first pixel in the view */
} crossing_tile;

/* Cuts the fragments of a tile into parts where their surfaces cross. The fragments must be sorted by pixels,
 * and within a pixel in the view's order. If three surfaces cross in one pixel, and two or more of them let
 * light through, the order of their parts may be wrong. A pixel with more than 32 fragments is not changed.
 * to: [2 count]; receives the fragments and their parts, sorted like the input. *parted: set if any fragment
 * changed; a changed fragment may lie in another slab than before. Returns the number of fragments in
 * `to`. */
size_t hl_part_crossings(const crossing_tile *tile, const fragment *list, size_t count, fragment *to,
                         bool *parted);

#endif
