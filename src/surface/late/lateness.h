/* surface/late/lateness.h - by how much light's buffers are late where surfaces take light: all the numbers
 * that were chosen for it, each with its reason.
 *
 * A surface takes light out of a shadow buffer later than where it is, because look-ups read pixels beside a
 * sample, whose surface must not darken itself. Light leaks where the surface is late. The folders
 * surface/late/ and render/late/ hold all that mends the leaks. Their numbers stand here; docs/experiments.md
 * has the trials ("Meshes").
 *
 * Two kinds of numbers stand elsewhere, where what they belong to is defined. A method of shadows says in its
 * table by how many pixels surfaces are delayed and rise (shadow/shadow_method.h). Marks of dark pixels are
 * the cascade's (shadow/attenuate.h). */
#ifndef HL_SURFACE_LATE_LATENESS_H
#define HL_SURFACE_LATE_LATENESS_H

/* ---- fragments of a light's view ---- */

/* The most slabs that a fragment fills: room for 64 changed no picture. */
enum { MOST_SLABS = 16 };

/* The surface's slope in frame units a pixel is no steeper: one that light almost grazes would be delayed
 * without end, and it is hardly lit. */
#define STEEPEST_SLOPE 12

/* Distances of sheets by which a fragment's slabs may lie above its triangle: the neighbour's fragment of a
 * pixel on their edge lies beyond it, and both must fill one slab for the pixel to be full there. */
#define SEAM 2

/* The least delay, in distances of sheets: a surface along the sheets must not come to lie in an earlier slab
 * in the light's view than in the eye's, for rounding. */
#define LEAST_DELAY 0.02

/* ---- seams: corners at which large triangles meet (surface_seams.h, seen_seams.h) ---- */

/* In diagonals of the box around all clusters: edges of large triangles are longer. The corners of small ones
 * leave specks alone. */
static const double LARGE_EDGE = 1.0 / 64;

/* In the same diagonals: ends of edges that lie closer lie in one place. */
static const double SAME_PLACE = 1e-5;

/* The most triangles whose edges are asked, in the order of clusters, and the most neighbours of an edge:
 * they bound the memory. Edges that follow in the order of their keys and are asked at most: others with the
 * same key are chance. */
enum { MOST_SEAMED = 1 << 14, MOST_AT_EDGE = 4, MOST_SEAMS_ASKED = 64 };

/* The most seams of a triangle that a light's view looks at: MOST_AT_EDGE for each of its edges. */
enum { MOST_SEEN_SEAMS = 12 };

/* Pixels from a corner within which fragments fill the slabs up to the other triangle. */
static const double BESIDE_SEAM = 1.5;

/* Slopes by which these fragments overlap with the other triangle: a pixel's height may differ from the
 * corner's by as many. */
static const double SEAM_OVERLAP = 1;

/* ---- rims: triangles near boundary edges and corners (surface_rims.h) ---- */

/* Passes over all triangles, forwards and backwards in turn: each follows a distance over an edge or more. */
enum { RIM_PASSES = 8 };

/* A mesh with more vertices at corners is rough, unless these are fewer than one in MOST_PARTS: it has no
 * corners of rooms, but rays all over it, which would cost several times the frame. */
enum { MOST_CORNERS = 4096, MOST_PARTS = 8 };

/* ---- look-ups ---- */

/* Pixels of a shadow buffer by which look-ups move away from a surface, along its normal: so that they read
 * as little as possible of what lies behind it, and of its own matter. */
static const float LOOKUP_OFFSET = 1.25f;

/* Pixels by which surfaces are delayed where look-ups are by cubic convolution: these reach so far. */
static const double CUBIC_DELAY = 1.75;

/* Pixels of a buffer that a look-up of a volume's sample reads around it: behind what is opaque, those that
 * come later than the sample's own count, too. A part that passes must not be taken twice. */
static const double READ_BESIDE = 1.25;

/* Slabs before the current one whose fragments may not be in the buffers yet. */
enum { NEAR_SLABS = 2 };

/* ---- rays to what is close (render/late/contact.c) ---- */

/* A buffer is late by some of its pixels and some sheets. Up to so many times the sum of one of each from a
 * point, the plane of a surface that hides the light from it is close; a ray looks so far. */
static const double CLOSE = 3, FARTHEST_CLOSE = 10;

/* A ray begins so many pixels away from its point: beyond what rounding may do to it. */
static const double RAY_START = 0.0005;

/* Where the eye grazes a surface, a pixel's middle is found again up to so many pixels of the picture aside.
 */
static const double MOST_PIXELS_ASIDE = 8;

/* ---- hollow surfaces (render/late/hollow.h) ---- */

/* The greatest sine of the angle between a light and a hollow surface at which the surface is asked whether
 * it shades itself: the less light grazes a surface, the less late the buffer is. */
static const double GRAZING = 0.2;

/* The sharpest bend of a hollow surface that is asked, in parts of what a buffer is late by: sharper ones are
 * roughness. */
static const double SHARPEST_BEND = 0.12;

/* A triangle that bends the other way along an edge by more than this part of its bend is rough, or a saddle.
 */
static const double OTHER_BEND = 0.25;

#endif
