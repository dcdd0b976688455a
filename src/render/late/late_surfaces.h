/* render/late/late_surfaces.h - the light behind surfaces that a shadow buffer takes into account late: what
 * the sweep asks of this folder.
 *
 * A shadow buffer takes a surface into account some pixels late (surface/late/lateness.h), and at a boundary
 * edge its look-ups mix the last pixels with those beside the edge. Light would leak where a thin wall stands
 * on a floor, from a lit wall to the next one where both meet in the corner of a dark room, and into matter
 * right behind a surface.
 *
 * Points of surfaces therefore look for what is close before them by rays towards the light (contact.c).
 * Within a closed part of a mesh there is no light from outside, and no ray is needed. Points of hollow
 * surfaces that light grazes ask for the surface's own bend (hollow.h). Samples of volumes ask the fragments
 * of the eye's view in their slab and in the few before it (near_surfaces.c).
 *
 * In: the tree of triangles near the boundary edges and corners of meshes that are not closed, and of spheres
 * that cuts cut; fragments of the eye's view. Out: the fractions of light that pass what is close. */
#ifndef HL_RENDER_LATE_LATE_SURFACES_H
#define HL_RENDER_LATE_LATE_SURFACES_H

#include "render/surface_batch.h"

/* Pixels of a light's buffer by which surfaces are delayed: as far as its look-ups reach beyond the way that
 * they are moved away from the surface (surface_lanes.h). */
double hl_surface_delay(const light_shadow *shadow);

/* ---- points of surfaces ---- */

/* The distance from boundary edges up to which triangles are looked for, before buffers and sheets are known.
 */
double hl_contact_distance(const frame *frame);

/* The points that stand for a light. */
void hl_contact_points(const light_source *source, light_points *points);

/* The parts of each light that pass surfaces close before the batch's samples, which are placed. passing:
 * [lights][channels]; set only where the function returns true: some light is taken. */
bool hl_contact_find(const sweep *sweep, const tile_slab *slab, const surface_batch *batch,
                     float (*passing)[SURFACE_SAMPLES]);

/* ---- samples of volumes ---- */

/* A pixel's part of a slab; heights above the first sheet. */
typedef struct slab_piece {
  const float *from, *to; /* [256], block-major; null: the whole slab */
} slab_piece;

/* The fragments in a slab and in the few before it: those of meshes that are visible, at which slabs are cut,
 * and of those that are not. */
typedef struct near_fragments {
  fragment_range seen, unseen;
} near_fragments;

/* The fraction of each light that passes the fragments of `near` which the light's buffer does not hold yet,
 * at the middle of each pixel's piece. passing: [lights][channels][256], rows of a tile; written only where
 * the function returns true: some light is taken. */
bool hl_near_surfaces_find(const sweep *sweep, const tile_slab *slab, const near_fragments *near,
                           slab_piece piece, float (*passing)[TILE_PIXELS]);

#endif
