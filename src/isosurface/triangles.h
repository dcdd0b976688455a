/* isosurface/triangles.h - describes the triangles of an isosurface while they are made, in index space.
 * Their normals are the directions of the field's gradient, and point away from the inside. */
#ifndef HL_ISOSURFACE_TRIANGLES_H
#define HL_ISOSURFACE_TRIANGLES_H

#include "isosurface/lattice.h"

typedef struct iso_triangles {
  float (*positions)[3]; /* owned; [vertex_count]; index space */
  float (*normals)[3];   /* owned; [vertex_count]; unit vectors in index coordinates */
  /* owned; [triangle_count]; indices of vertices, counter-clockwise as seen from outside */
  uint32_t (*triangles)[3];
  size_t vertex_count, triangle_count;
} iso_triangles;

/* Cuts the lattice's cells into triangles. Release the triangles after a failure, too. */
hl_status hl_iso_extract(hl_pool *pool, lattice *lattice, iso_triangles *made, hl_error *error);

/* Halves the edges that lie far from the surface, and moves their middles onto it. */
hl_status hl_iso_refine(hl_pool *pool, const lattice *lattice, iso_triangles *triangles, hl_error *error);

void hl_iso_triangles_release(hl_context *context, iso_triangles *triangles);

/* The unit normal, pointing away from the inside, of a surface at a point where the field has the gradient
 * `slope`. */
static inline vec3 hl_iso_normal(const lattice *lattice, vec3 slope) {
  return vec3_scale(vec3_normalise(slope), -lattice->sign);
}

#endif
