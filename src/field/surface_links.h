/* field/surface_links.h - finds the links between the cells of a lattice that the surfaces of meshes cut.
 *
 * A link is the straight line between the middles of two cells in slices that follow each other: a cell has
 * nine links to the slice before. Light moves from cell to cell along links. A surface absorbs a part of the
 * light of each link that it meets. So a closed wall lets no light through, however thin it is and whatever
 * its direction. And a thin wall does not fill whole cells. */
#ifndef HL_FIELD_SURFACE_LINKS_H
#define HL_FIELD_SURFACE_LINKS_H

#include "core/pool.h"
#include "field/field.h"
#include "surface/surfaces.h"

/* The links along one axis. */
typedef struct surface_links {
  unsigned char
      /* [slices + 1][FIELD_LINKS][rows + 2][stride + 2 FIELD_LANES]; the fraction, in 255ths, that surfaces
       * absorb of the light that goes along each link from the slice before. The links of slice s lead to
       * slice s - 1. The links of slice number `slices`, beyond the last slice, are never cut. */
      *taken;
  /* [slices][rows][stride / FIELD_LANES]; the flags LINKS_BEFORE and LINKS_AFTER of each block of cells */
  unsigned char *cut;
} surface_links;

/* Lays out the arrays of links; they have room for the links along any axis of the lattice. */
void hl_surface_links_lay_out(const field_lattice *lattice, surface_links *links, hl_layout *layout);

/* The places at which surfaces cut the links between neighbours along an axis. */
typedef struct link_places {
  float *first;   /* the float of the first cell that receives a place */
  size_t step[3]; /* numbers of floats from one cell to the next along x, y and z */
} link_places;

/* Finds which links along an axis surfaces cut. places: receives, for each cell, the fraction (above 0) of
 * the way to the next cell along the axis at which the first surface lies. Where no surface cuts the way, the
 * cell's float stays as it is. */
void hl_surface_links_find(const surfaces *all, const field_lattice *lattice, int axis,
                           const surface_links *links, const link_places *places, hl_pool *pool);

/* Marks the cells in which meshes may be seen. */
void hl_surface_mark_seen(const surfaces *all, opacity_field *field);

#endif
