/* surface/late/lateness.h - constants that say how late shadow buffers take surfaces into account, and how
 * the errors of this lateness are corrected. Each constant has its reason beside it.
 *
 * A look-up for a sample of a surface also reads pixels beside the sample, and the surface must not darken
 * itself in these pixels. So a shadow buffer takes a surface into account only some pixels behind the
 * surface's place. Light then leaks right behind the surface. The folders surface/late/ and render/late/
 * correct these leaks, and use the constants of this file. docs/experiments.md ("Meshes") tells how the
 * constants were found.
 *
 * Two kinds of constants are in other files. The table of each method of shadows has the number of pixels by
 * which surfaces are delayed, and the number by which they are moved towards the light
 * (shadow/shadow_method.h). The marks of dark pixels belong to the cascade (shadow/attenuate.h). */
#ifndef HL_SURFACE_LATE_LATENESS_H
#define HL_SURFACE_LATE_LATENESS_H

/* ---- fragments of a light's view ---- */

/* The greatest number of slabs that a fragment of a light's view fills. With 64 instead, no picture
 * changed. */
enum { MOST_SLABS = 16 };

/* The greatest slope of a surface that is used for its delay, in frame units per pixel. Without this limit, a
 * surface that light grazes would have an unlimited slope and an unlimited delay; but such a surface is
 * hardly lit. */
#define STEEPEST_SLOPE 12

/* The greatest distance, in distances of sheets, at which a fragment's slabs may lie above its triangle. A
 * pixel on the edge between two triangles has a fragment of each triangle. The two fragments must have a slab
 * in common, so that they cover the whole pixel in this slab. */
#define SEAM 2

/* The least delay, in distances of sheets. Without it, rounding could put a surface that runs along the
 * sheets into an earlier slab in the light's view than in the eye's view. */
#define LEAST_DELAY 0.02

/* ---- seams: corners at which large triangles meet (surface_seams.h, seen_seams.h) ---- */

/* A triangle is large if one of its edges is longer than this number of units. The unit is the diagonal of a
 * box around all clusters. Between smaller triangles, light that leaks at corners makes only specks. */
static const double LARGE_EDGE = 1.0 / 64;

/* Two ends of edges count as one place if the distance between them is smaller than this number of the units
 * of LARGE_EDGE. */
static const double SAME_PLACE = 1e-5;

/* Limits of memory and time. MOST_SEAMED: the greatest number of triangles whose edges are looked at; the
 * first triangles in the order of clusters are taken. MOST_AT_EDGE: the greatest number of neighbours that
 * are kept for an edge. MOST_SEAMS_ASKED: the greatest number of edges with which an edge is compared on
 * either side of it, in the order of keys. Only by chance do more edges have nearly the same key. */
enum { MOST_SEAMED = 1 << 14, MOST_AT_EDGE = 4, MOST_SEAMS_ASKED = 64 };

/* The greatest number of seams of a triangle that a light's view looks at: MOST_AT_EDGE for each edge. */
enum { MOST_SEEN_SEAMS = 12 };

/* A fragment beside a corner (an edge at which two large triangles meet) fills all slabs up to the other
 * triangle. It is beside the corner if its distance from the corner is less than this number of pixels. */
static const double BESIDE_SEAM = 1.5;

/* The length by which a fragment beside a corner overlaps the other triangle of the corner. The unit is the
 * height by which the other triangle's plane rises over a pixel, because the height at a pixel's middle may
 * differ by that much from the height at the corner. */
static const double SEAM_OVERLAP = 1;

/* ---- rims: triangles near boundary edges and corners (surface_rims.h) ---- */

/* The number of passes over all triangles. Passes go forwards and backwards in turn. Each pass carries
 * distances on, from vertex to vertex, over at least one edge. */
enum { RIM_PASSES = 8 };

/* A mesh is rough if more than MOST_CORNERS of its vertices, and more than one vertex in MOST_PARTS, lie at
 * corners. The corners of a rough mesh are ignored, for two reasons. Rays all over such a mesh would take
 * several times as long as the rest of the frame. And a rough mesh has no corners like the corners of rooms,
 * at which light could leak. */
enum { MOST_CORNERS = 4096, MOST_PARTS = 8 };

/* ---- look-ups ---- */

/* The distance by which look-ups are moved away from a surface, in pixels of the shadow buffer. They are
 * moved along the normal, but not to places where the buffer meets the surface earlier
 * (render/surface_lanes.h). So look-ups are affected as little as possible by light behind the surface, and
 * by the light that the surface itself absorbs. */
static const float LOOKUP_OFFSET = 1.25f;

/* The delay of surfaces, in pixels, if look-ups use cubic convolution: the distance that such look-ups
 * reach. */
static const double CUBIC_DELAY = 1.75;

/* The distance, in pixels of the buffer, up to which the look-up of a volume's sample reads around the
 * sample. For a sample behind an opaque surface, the surface may enter the neighbouring pixels later than the
 * sample's own pixel. So for volumes, the delay of an opaque surface counts as larger by this number of
 * pixels. The delay of a translucent surface does not, because it would absorb light twice. */
static const double READ_BESIDE = 1.25;

/* The number of slabs before the current slab whose fragments may be missing in the shadow buffers. */
enum { NEAR_SLABS = 2 };

/* ---- rays to what is close (render/late/contact.c) ---- */

/* Limits of the search for close surfaces. The unit is the length by which a buffer is late: one pixel of the
 * buffer plus one distance of sheets. A surface is close to a point if its plane is at most CLOSE units away
 * from the point. A ray that searches for close surfaces ends after FARTHEST_CLOSE units. */
static const double CLOSE = 3, FARTHEST_CLOSE = 10;

/* The distance from a point at which its ray begins, in pixels of the buffer. It is greater than the errors
 * of rounding. */
static const double RAY_START = 0.0005;

/* The greatest distance from a sample's place to the middle of the visible part of its pixel, in pixels of
 * the picture at the content. Without this limit, the middle could be arbitrarily far away if the eye's ray
 * grazes a surface. */
static const double MOST_PIXELS_ASIDE = 8;

/* ---- hollow surfaces (render/late/contact.c) ---- */

/* The sine of an angle between a light's ray and a hollow surface. Up to this angle it is tested whether the
 * surface shades itself; at greater angles the buffer is hardly late. */
static const double GRAZING = 0.2;

/* The greatest bend of a hollow surface that may shade itself, as the bend times the length by which the
 * buffer is late. A sharper bend counts as roughness. */
static const double SHARPEST_BEND = 0.12;

/* A triangle counts as rough, or as a saddle, if it bends the other way along one of its edges by more than
 * this fraction of its own bend. */
static const double OTHER_BEND = 0.25;

#endif
