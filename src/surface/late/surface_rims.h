/* surface/late/surface_rims.h - finds the triangles of a mesh near its open edges and its corners.
 *
 * An edge of a triangle is open if no other triangle has the same edge in the opposite direction. A corner is
 * an edge at which the mesh bends by more than 40 degrees. A mesh that is rough all over counts as having no
 * corners. */
#ifndef HL_SURFACE_LATE_SURFACE_RIMS_H
#define HL_SURFACE_LATE_SURFACE_RIMS_H

#include "core/memory.h"
#include "surface/surfaces.h"

/* Sets near[t] for each triangle t of a mesh: whether a vertex of the triangle lies within a distance of an
 * open edge, a cut or a corner. The distance is measured along edges, in frame units. The search follows only
 * RIM_PASSES successive edges, or a few more. So if triangles are very small, triangles beyond these edges do
 * not count as near. */
hl_status hl_surface_rims(hl_context *context, const surfaces *all, const surface_mesh *mesh, double distance,
                          bool *near, hl_error *error);

/* Counts the memory that hl_surface_rims() takes while it runs. */
void hl_surface_rims_count(const surface_mesh *mesh, hl_layout *layout);

#endif
