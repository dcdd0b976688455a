/* label/solids.h - makes one volume of several labels that are solid together.
 *
 * If two labels that touch were drawn by their own fields, which are rounded, a groove would appear between
 * them. Labels that are solid together have one field. So their surface, normals and shadows look like one
 * body, in which the labels differ by their colours. */
#ifndef HL_LABEL_SOLIDS_H
#define HL_LABEL_SOLIDS_H

#include <halflight/scene.h>

#include "core/error.h"

/* Makes the occupancy (occupancy.h) of all labels together, with the labels' colours as the volume's own
 * (volume/colors.h). Where labels meet, their colours blend over about a voxel and a half. Labels of one
 * colour give a volume without colours. labels: [count]; the solid labels, rising by value. *made is retained
 * for the caller, and null if no voxel has one of the labels. threads: 0 for one per processor. */
hl_status hl_label_solids(hl_context *context, int threads, hl_volume *map, const hl_label *labels,
                          size_t count, hl_volume **made, hl_error *error);

#endif
