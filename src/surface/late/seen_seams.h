/* surface/late/seen_seams.h - how far fragments of a light's view reach where triangles meet at a corner.
 *
 * A fragment counts from a delayed height on (fragment_work.h: delay), the later the steeper its triangle is.
 * At a corner the two triangles' delays differ, and rays of other directions than the view's would pass
 * between the end of the one and the start of the other: fragments beside the corner fill the slabs between,
 * too. What the other triangle lights is not darkened: there its own plane goes on, as late. */
#ifndef HL_SURFACE_LATE_SEEN_SEAMS_H
#define HL_SURFACE_LATE_SEEN_SEAMS_H

#include "surface/fragment_work.h"
#include "surface/late/lateness.h"
#include "surface/surface_plane.h"

/* A corner as a light's view sees it. */
typedef struct seen_seam {
  double at[2][2], height[2]; /* of the ends: pixels, and above the first sheet */
  surface_plane other;        /* of the triangle beyond */
} seen_seam;

typedef struct seen_seams {
  seen_seam list[MOST_SEEN_SEAMS];
  int count;
} seen_seams;

/* Finds the corners of an opaque triangle with opaque ones of meshes that cast shadows. */
void hl_see_seams(const fragment_work *work, const fragment *f, seen_seams *seams);

/* The height up to which a fragment at a pixel's point fills slabs: `end`, or more close to a corner. */
double hl_seam_end(const fragments_source *source, const seen_seams *seams, double u, double v, double end);

#endif
