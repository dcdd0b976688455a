/* field/surface_links.h - which links between the cells of a lattice the surfaces of meshes cut.
 *
 * A link is the straight line between the middles of two cells in slices that follow each other: a cell has
 * nine links to the slice before. Light moves from cell to cell along links. A surface takes its part of the
 * light of each link that it meets. So a closed wall lets no light through, however thin it is and whatever
 * its direction, and it counts as no thicker than it is. */
#ifndef HL_FIELD_SURFACE_LINKS_H
#define HL_FIELD_SURFACE_LINKS_H

#include "core/pool.h"
#include "field/field.h"
#include "surface/surfaces.h"

/* The links along one axis. */
typedef struct surface_links {
  unsigned char
      /* [slices + 1][FIELD_LINKS][rows + 2][stride + 2 FIELD_LANES]; the part, in 255ths, that surfaces take
       * of the light from the slice before. A slice has its own links; the last slice has none. */
      *taken;
  unsigned char *cut; /* [slices][rows][stride / FIELD_LANES]; LINKS_BEFORE and LINKS_AFTER */
} surface_links;

/* Takes the arrays, which have room for the links along any axis. */
void hl_surface_links_lay_out(const field_lattice *lattice, surface_links *links, hl_layout *layout);

/* The places where links that join neighbours along an axis are cut. */
typedef struct link_places {
  float *first;   /* the number of the first cell */
  size_t step[3]; /* floats from cell to cell along x, y and z */
} link_places;

/* Finds the links along an axis. places: for each cell, the fraction (above 0) of the way to the next cell
 * along the axis at which the first surface lies. Places without a surface are not changed. */
void hl_surface_links_find(const surfaces *all, const field_lattice *lattice, int axis,
                           const surface_links *links, const link_places *places, hl_pool *pool);

/* Marks the cells in which meshes may be seen. */
void hl_surface_mark_seen(const surfaces *all, opacity_field *field);

#endif
