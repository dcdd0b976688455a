/* surface/fragment.h - what a surface covers of one pixel.
 *
 * A fragment is what one triangle, or one side of a sphere, covers of one pixel. Each pixel has sixteen
 * sample positions; a fragment tells which of them it covers, at one height. Heights grow along every ray of
 * a light, and grow or fall along every ray of the eye: fragments sorted by height are sorted by depth.
 *
 * Opacity. Fragments of one pixel may cover the same samples or different ones. So that they can be
 * composited one after the other, each gets the fraction that it takes of the light which the fragments
 * before it let pass, averaged over the samples (derived: with t[i] the transmittance of sample i before the
 * fragment, it takes sum over its samples of t[i] a / sum over all samples of t[i]). Triangles that share an
 * edge thus leave no seam. */
#ifndef HL_SURFACE_FRAGMENT_H
#define HL_SURFACE_FRAGMENT_H

#include <math.h>
#include <stdint.h>

enum { FRAGMENT_SAMPLES = 16 };

typedef struct fragment {
  float height;  /* above the first sheet; frame units */
  float opacity; /* see above; above 0 */
  uint32_t primitive;
  int32_t slab;     /* k: between sheets k-1 and k */
  uint16_t samples; /* covered, one bit each */
  uint16_t seen;    /* of the eye's view, of these: those that no opaque fragment before it covers */
  uint16_t mesh;    /* that the primitive belongs to */
  uint8_t pixel;    /* in its tile, block after block: 16 * block + lane */
  uint8_t reach;    /* of the eye's view: see below */
} fragment;

/* The mean position of the covered samples in their pixel, 0 to 1. */
void hl_fragment_middle(uint16_t samples, double *u, double *v);

/* A fragment's reach: how far at most the surface lies above or below the fragment's height within its
 * samples. It is told in so many parts of the distance of sheets, rounded up; the greatest number stands for
 * any reach. */
enum { REACH_PARTS = 16, FARTHEST = UINT8_MAX };

/* The number that tells a reach. Both: in distances of sheets. */
static inline uint8_t hl_told_reach(double reach) {
  double parts = reach * REACH_PARTS;
  return parts < FARTHEST - 1 ? (uint8_t)(parts + 1) : FARTHEST; /* not a number: the farthest */
}

/* The reach that a number tells, in frame units; spacing: of the sheets. */
static inline double hl_reach_of(uint8_t told, double spacing) {
  return told == FARTHEST ? INFINITY : told * (spacing / REACH_PARTS);
}

#endif
