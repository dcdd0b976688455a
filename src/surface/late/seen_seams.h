/* surface/late/seen_seams.h - finds how far fragments of a light's view reach beside a corner, an edge at
 * which two triangles meet.
 *
 * A fragment absorbs light from a delayed height on (fragment_work.h: delay). The steeper its triangle is,
 * the longer is the delay. So two triangles that meet at a corner have different delays. Slanted rays could
 * pass between the end of one triangle and the start of the other. Therefore fragments beside the corner also
 * fill the slabs between the two triangles. The lit side of the other triangle stays bright, because its own
 * delay is as long. */
#ifndef HL_SURFACE_LATE_SEEN_SEAMS_H
#define HL_SURFACE_LATE_SEEN_SEAMS_H

#include "surface/fragment_work.h"
#include "surface/late/lateness.h"
#include "surface/surface_plane.h"

/* A corner, which is an edge where two large triangles meet and bend, as a light's view sees it. */
typedef struct seen_seam {
  double at[2][2], height[2]; /* at: the places of the corner's two ends, in pixels; height: the heights of
                               * these ends above the first sheet */
  surface_plane other;        /* the plane of the triangle on the other side of the corner */
} seen_seam;

typedef struct seen_seams {
  seen_seam list[MOST_SEEN_SEAMS];
  int count;
} seen_seams;

/* Finds the corners at which an opaque triangle meets other opaque triangles. All of them belong to meshes
 * that cast shadows. */
void hl_see_seams(const fragment_work *work, const fragment *f, seen_seams *seams);

/* The height up to which a fragment of a light's view fills slabs, at the continuous pixel (u, v). The height
 * is `end`, or a greater height if the pixel is close to a corner. */
double hl_seam_end(const fragments_source *source, const seen_seams *seams, double u, double v, double end);

#endif
