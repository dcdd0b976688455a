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

#include <stdint.h>

enum { FRAGMENT_SAMPLES = 16 };

typedef struct fragment {
  float height;  /* above the first sheet; frame units */
  float opacity; /* see above; above 0 */
  uint32_t primitive;
  int32_t slab;     /* k: between sheets k-1 and k */
  uint16_t samples; /* covered, one bit each */
  uint16_t mesh;    /* that the primitive belongs to */
  uint8_t pixel;    /* in its tile, block after block: 16 * block + lane */
} fragment;

#endif
