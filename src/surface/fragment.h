/* surface/fragment.h - describes fragments: parts of single pixels that surfaces cover.
 *
 * A fragment is the part of one pixel that one triangle, or one side of a sphere, covers. Each pixel has
 * sixteen sample positions. A fragment has a set of covered samples, and one height for all of them. Heights
 * grow along every ray of a light. Along the rays of the eye, they either grow on all rays or fall on all
 * rays. So fragments that are sorted by height are also sorted by depth.
 *
 * Opacity. Fragments of one pixel may cover the same samples or different samples. They are composited one
 * after the other. So the opacity of a fragment is relative to the light that the fragments before it let
 * pass. The opacity is the fraction of this light that the fragment absorbs, averaged over the pixel's
 * samples. Derived: let t[i] be the transmittance of sample i before the fragment, and a the fragment's own
 * opacity. The fraction is the sum of t[i] a over the fragment's samples, divided by the sum of t[i] over all
 * samples. With such opacities, triangles that share an edge leave no seam. */
#ifndef HL_SURFACE_FRAGMENT_H
#define HL_SURFACE_FRAGMENT_H

#include <math.h>
#include <stdint.h>

enum { FRAGMENT_SAMPLES = 16 };

typedef struct fragment {
  float height; /* height above the first sheet; frame units */
  /* the fraction of the arriving light that the fragment absorbs, above 0; see "Opacity" at the head of the
   * file */
  float opacity;
  uint32_t primitive;
  int32_t slab;     /* number k of the slab that lies between the sheets k-1 and k */
  uint16_t samples; /* covered samples, one bit each */
  uint16_t seen; /* only in the eye's view: the covered samples that no opaque fragment before this fragment
                  * covers */
  uint16_t mesh; /* index of the mesh to which the primitive belongs */
  uint8_t pixel; /* the pixel's number in its tile, block after block: 16 * block + lane */
  uint8_t reach; /* only in the eye's view: the fragment's reach (see REACH_PARTS), in units of 1 /
                  * REACH_PARTS of the distance of sheets */
} fragment;

/* The mean position of the covered samples in their pixel, 0 to 1. */
void hl_fragment_middle(uint16_t samples, double *u, double *v);

/* The reach of a fragment: the greatest distance of its surface above or below the fragment's height, within
 * the fragment's samples. It is stored in units of 1 / REACH_PARTS of the distance of sheets, rounded up.
 * FARTHEST stands for an unlimited reach. */
enum { REACH_PARTS = 16, FARTHEST = UINT8_MAX };

/* Converts a reach, in units of the distance between sheets, to the number that is stored for it. */
static inline uint8_t hl_told_reach(double reach) {
  double parts = reach * REACH_PARTS;
  /* a reach that is NaN counts as unlimited */
  return parts < FARTHEST - 1 ? (uint8_t)(parts + 1) : FARTHEST;
}

/* The reach, in frame units, for which a stored number stands. spacing: distance of the sheets. */
static inline double hl_reach_of(uint8_t told, double spacing) {
  return told == FARTHEST ? INFINITY : told * (spacing / REACH_PARTS);
}

#endif
