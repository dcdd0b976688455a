/* surface/late/surface_rims.h - the triangles of a mesh near its open edges and its corners.
 *
 * An edge is open where no other triangle goes along it the other way. A corner is an edge at which the mesh
 * bends by more than 40 degrees; a mesh that is rough all over has none. */
#ifndef HL_SURFACE_LATE_SURFACE_RIMS_H
#define HL_SURFACE_LATE_SURFACE_RIMS_H

#include "core/memory.h"
#include "surface/surfaces.h"

/* Sets near[t], of the mesh's triangles, where triangle t has a vertex within a distance, along edges, of an
 * open edge, a cut or a corner; frame units. The distance is followed over few edges: where triangles are
 * very small it is less.
 */
hl_status hl_surface_rims(hl_context *context, const surfaces *all, const surface_mesh *mesh, double distance,
                          bool *near, hl_error *error);

/* Counts what hl_surface_rims() takes for a while. */
void hl_surface_rims_count(const surface_mesh *mesh, hl_layout *layout);

#endif
