/* label/occupancy.h - labels of a label map as a smooth field with the labels' own surface.
 *
 * A label map's voxels are the numbers of things. The occupancy of a label, or of several together, is 1
 * within them and 0 outside, without the stairs of the voxels: reconstructed by the B-spline, it passes 1/2
 * at their surface. */
#ifndef HL_LABEL_OCCUPANCY_H
#define HL_LABEL_OCCUPANCY_H

#include "core/pool.h"
#include "volume/volume.h"

/* The part of a map's grid that holds labels, with a margin for their smooth surface. */
typedef struct hl_label_part {
  size_t first[3], size[3]; /* voxels along i, j, k; the size is 0 if no voxel has the label */
} hl_label_part;

/* Finds the parts of several labels in one pass over the map. labels: [count], rising; parts: [count]. */
hl_status hl_label_parts(hl_context *context, hl_pool *pool, const hl_volume *map, const int64_t *labels,
                         size_t count, hl_label_part *parts, hl_error *error);

/* The smallest part that holds several parts. Parts of size 0 do not count. */
hl_label_part hl_label_part_of_all(const hl_label_part *parts, size_t count);

/* The place of a voxel's label in a rising list; `count` if the list lacks it. */
size_t hl_label_place(const int64_t *labels, size_t count, const hl_volume *map, hl_number_row row, size_t i);

enum { HL_LABEL_STEPS = 6 }; /* the steps in which the voxels of a label's part are smoothed */

/* The smoothing of labels. */
typedef struct hl_label_work {
  const hl_context *context; /* its progress callback is told the fraction that is done, as the stage
                              * "prepare" */
  double whole;              /* voxels of all parts */
  double done;               /* sum, over all steps that were taken, of the voxels that took them */
} hl_label_work;

size_t hl_label_part_voxels(const hl_label_part *part);

/* Counts voxels that have taken some steps, and tells how far the work has come. */
void hl_label_worked(hl_label_work *work, size_t voxels, int steps);

/* Makes the occupancy of all labels of a list together, over their common part. labels: [count], rising.
 * *made is null if no voxel has one of the labels. The call takes seven and a half bytes of memory for each
 * voxel of the part, and *made keeps one of them. work: is told of the part's voxels. */
hl_status hl_label_occupancy(hl_context *context, hl_pool *pool, const hl_volume *map, const int64_t *labels,
                             size_t count, const hl_label_part *part, hl_label_work *work, hl_volume **made,
                             hl_error *error);

#endif
