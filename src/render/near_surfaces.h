/* render/near_surfaces.h - what surfaces close before a volume's samples take of their light.
 *
 * A shadow buffer takes a surface into account from the next slab on, and later where the surface is delayed
 * (surface/tile_fragments.h). Until then matter behind the surface would be lit as if it were not there. In:
 * the fragments of the eye's view in a slab and in the few before it, with those of meshes that are not
 * visible. Out: what they let through to each pixel's piece of the slab. */
#ifndef HL_RENDER_NEAR_SURFACES_H
#define HL_RENDER_NEAR_SURFACES_H

#include "render/sweep.h"

/* Slabs before the current one whose fragments may not be in the buffers yet. */
enum { NEAR_SLABS = 2 };

/* Pixels of a light's buffer by which surfaces are delayed: as far as its look-ups reach beyond the way that
 * they are moved away from the surface (surface_lanes.h). */
double hl_surface_delay(const light_shadow *shadow);

/* A pixel's part of a slab; heights above the first sheet. */
typedef struct slab_piece {
  const float *from, *to; /* [256], block-major; null: the whole slab */
} slab_piece;

/* Those of meshes that are visible, at which slabs are cut, and of those that are not. */
typedef struct near_fragments {
  fragment_range seen, unseen;
} near_fragments;

/* The fraction of each light that passes the fragments of `near` which the light's buffer does not hold yet,
 * at the middle of each pixel's piece. passing: [lights][channels][256], rows of a tile; written only where
 * the function returns true: some light is taken. */
bool hl_near_surfaces_find(const sweep *sweep, const tile_slab *slab, const near_fragments *near,
                           slab_piece piece, float (*passing)[TILE_PIXELS]);

#endif
