/* render/late/late_surfaces.h - corrects the light close behind surfaces, because a shadow buffer takes
 * surfaces into account late. A sweep calls only the functions of this header from this folder.
 *
 * A shadow buffer takes a surface into account some pixels late (surface/late/lateness.h). At a boundary
 * edge, look-ups also mix pixels of the surface with pixels beside the edge. Without a correction light leaks
 * in three places: where a thin wall stands on a floor, in the corner of a dark room whose outside is lit,
 * and into matter right behind a surface.
 *
 * For points of surfaces, short rays towards the light find the surfaces that are close (contact.c). Points
 * within a closed part of a mesh get no light from outside, and need no rays. For points of hollow surfaces
 * that light grazes, the bend of the surface tells whether it shades itself (contact.c). For samples of
 * volumes, the fragments of the eye's view in the same slab and in the few slabs before it are looked at
 * (near_surfaces.c).
 *
 * In: the tree of triangles near the boundary edges and corners of meshes that are not closed, and of spheres
 * that cuts cut; fragments of the eye's view. Out: the fractions of light that pass close surfaces. */
#ifndef HL_RENDER_LATE_LATE_SURFACES_H
#define HL_RENDER_LATE_LATE_SURFACES_H

#include "render/surface_batch.h"

/* The delay of surfaces in a light's buffer, in pixels of the buffer. It is the distance by which look-ups
 * still reach towards the surface after they have been moved away from it (surface_lanes.h). */
double hl_surface_delay(const light_shadow *shadow);

/* ---- points of surfaces ---- */

/* The distance from boundary edges within which the tree must hold triangles; frame units. It is an upper
 * bound that can be found without buffers and sheets. */
double hl_contact_distance(const frame *frame);

/* Finds the points of a light to which the rays of the folder late are cast. */
void hl_contact_points(const light_source *source, light_points *points);

/* Finds the fraction of each light that passes the surfaces close before the batch's samples, whose positions
 * must be set. Returns whether any surface absorbs light; only then it sets passing, [lights][channels]. */
bool hl_contact_find(const sweep *sweep, const tile_slab *slab, const surface_batch *batch,
                     float (*passing)[SURFACE_SAMPLES]);

/* ---- samples of volumes ---- */

/* The part of a slab that is shaded in each pixel of a tile, as heights above the first sheet. */
typedef struct slab_piece {
  const float *from, *to; /* [256], block-major; the heights at which each pixel's piece begins and ends; if
                           * null, the piece is the whole slab */
} slab_piece;

/* The fragments in a slab and in the few slabs before it. seen: fragments of visible meshes, which cut the
 * slabs into pieces. unseen: fragments of meshes that are not visible. */
typedef struct near_fragments {
  fragment_range seen, unseen;
} near_fragments;

/* Finds the fraction of each light that reaches each pixel's piece of a slab. The fraction is found at the
 * middle of the piece. Only the fragments of `near` absorb light that the light's buffer does not hold yet.
 * Returns whether any light is absorbed; only then it sets passing, [lights][channels][256], in rows of a
 * tile. */
bool hl_near_surfaces_find(const sweep *sweep, const tile_slab *slab, const near_fragments *near,
                           slab_piece piece, float (*passing)[TILE_PIXELS]);

#endif
