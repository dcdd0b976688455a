/* render/late/late_surfaces.h - corrects the light close behind surfaces, which a shadow buffer takes into
 * account late. This header has all that a sweep calls in this folder.
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
 * that cuts cut; fragments of the eye's view. Out: the fractions of light that pass the
 * surfaces that are close. */
#ifndef HL_RENDER_LATE_LATE_SURFACES_H
#define HL_RENDER_LATE_LATE_SURFACES_H

#include "render/surface_batch.h"

/* The number of pixels of a light's buffer by which surfaces are delayed. It is how far look-ups still reach
 * towards the surface after they have been moved away from it (surface_lanes.h). */
double hl_surface_delay(const light_shadow *shadow);

/* ---- points of surfaces ---- */

/* The distance from boundary edges up to which the tree must hold triangles; frame units. It is a bound that
 * needs neither buffers nor sheets. */
double hl_contact_distance(const frame *frame);

/* Finds the points that stand for a light in this room. */
void hl_contact_points(const light_source *source, light_points *points);

/* Finds the fraction of each light that passes the surfaces close before the batch's samples, whose positions
 * must be set. Returns whether some light is taken; only then it sets passing, [lights][channels]. */
bool hl_contact_find(const sweep *sweep, const tile_slab *slab, const surface_batch *batch,
                     float (*passing)[SURFACE_SAMPLES]);

/* ---- samples of volumes ---- */

/* The part of a slab that each pixel of a tile shades, as heights above the first sheet. */
typedef struct slab_piece {
  const float *from, *to; /* [256], block-major; the heights of the ends of each pixel's piece; null: the
                           * piece is the whole slab */
} slab_piece;

/* The fragments in a slab and in the few slabs before it: `seen` of visible meshes, which cut the slabs into
 * pieces, and `unseen` of meshes that are not visible. */
typedef struct near_fragments {
  fragment_range seen, unseen;
} near_fragments;

/* Finds the fraction of each light that reaches the middle of each pixel's piece of a slab past those
 * fragments of `near` that the light's buffer does not hold yet. Returns whether some light is taken; only
 * then it sets passing, [lights][channels][256], in rows of a tile. */
bool hl_near_surfaces_find(const sweep *sweep, const tile_slab *slab, const near_fragments *near,
                           slab_piece piece, float (*passing)[TILE_PIXELS]);

#endif
