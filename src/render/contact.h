/* render/contact.h - the light that reaches points of surfaces close behind others, at their open edges and
 * in the corners of rooms.
 *
 * A shadow buffer takes a surface into account some pixels late (surface/tile_fragments.h), and at an open
 * edge its look-ups mix the last pixels with those beside the edge: light would leak where a thin wall stands
 * on a floor, and from a lit wall to the next one where both meet in the corner of a dark room. So points of
 * surfaces look for what is close before them by rays towards the light. Within a closed part of a mesh there
 * is no light from outside, and no ray is needed. In: the tree of triangles near the open edges and corners
 * of meshes that are not closed, and of spheres that cuts cut. Out: the fractions of light that pass what is
 * close. */
#ifndef HL_RENDER_CONTACT_H
#define HL_RENDER_CONTACT_H

#include "render/surface_batch.h"

/* The distance from open edges up to which triangles are looked for, before buffers and sheets are known. */
double hl_contact_distance(const frame *frame);

/* The points that stand for a light. */
void hl_contact_points(const light_source *source, light_points *points);

/* The parts of each light that pass surfaces close before the batch's samples, which are placed. passing:
 * [lights][channels]; set only where the function returns true: some light is taken. */
bool hl_contact_find(const sweep *sweep, const tile_slab *slab, const surface_batch *batch,
                     float (*passing)[SURFACE_SAMPLES]);

#endif
