/* isosurface/vertex_colors.h - gives the vertices of an isosurface the colours of another volume's values. */
#ifndef HL_ISOSURFACE_VERTEX_COLORS_H
#define HL_ISOSURFACE_VERTEX_COLORS_H

#include "isosurface/triangles.h"

/* The colours that the curves of a volume's transfer function give to the vertices of an isosurface. */
typedef struct iso_coloring {
  const hl_scene_volume *second; /* the volume whose values the colours stand for */
  affine3 index_to_second; /* maps the index space of the surface's volume to the index space of the second
                              volume */
  const double *own_color; /* [3]; linear RGB; the colour where the volume keeps its own */
} iso_coloring;

/* Whether isosurface i of a volume has the colours of another volume's values. */
bool hl_iso_has_second_color(const hl_scene_volume *volume, size_t i);

/* Finds the colours of vertices in the grid's index space. *colors: [vertex_count]; linear RGB and an opacity
 * of 1; owned by the caller, in a block of hl_allocate(); null after a failure. */
hl_status hl_iso_color_vertices(hl_pool *pool, const hl_scene_volume *volume, const grid *grid,
                                const iso_coloring *coloring, const iso_triangles *made, float (**colors)[4],
                                hl_error *error);

#endif
