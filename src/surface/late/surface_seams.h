/* surface/late/surface_seams.h - finds corners: edges at which large triangles of meshes that are not closed
 * meet and bend.
 *
 * Two edges count as the same edge if their ends lie in the same places. So triangles that meet need not
 * share vertices, nor belong to one mesh. In: triangles in frame space. Out: the neighbours of each triangle
 * at corners, which the fragments of a light's view need (seen_seams.h). */
#ifndef HL_SURFACE_LATE_SURFACE_SEAMS_H
#define HL_SURFACE_LATE_SURFACE_SEAMS_H

#include "core/memory.h"
#include "surface/late/lateness.h"
#include "surface/surfaces.h"

/* An edge at which a triangle meets another triangle at an angle of more than 40 degrees. */
struct surface_seam {
  uint32_t triangle, other; /* indices in surfaces->triangles: the triangle, and the other triangle that it
                             * meets */
  uint32_t ends[2];         /* the ends of the edge of `triangle`, as indices in surfaces->positions */
};

/* Counts the greatest amount of memory that hl_surface_seams_create() takes for a given number of
 * triangles. */
void hl_surface_seams_count(uint64_t triangles, hl_layout *layout);

/* Fills all->seams, sorted by their triangles. The clusters must have been made. A triangle is large if one
 * of its edges is longer than a 64th of the diagonal of a box around all clusters. */
hl_status hl_surface_seams_create(hl_context *context, surfaces *all, hl_error *error);
void hl_surface_seams_release(hl_context *context, surfaces *all);

/* The seams of a triangle, borrowed. *count receives their number. */
const surface_seam *hl_surface_seams_of(const surfaces *all, uint32_t triangle, size_t *count);

#endif
