/* label/occupancy.h - makes a smooth field, the occupancy, of labels of a label map. The surface of the field
 * is the labels' surface.
 *
 * The voxels of a label map are numbers that name regions. The occupancy of a label, or of several labels
 * together, is a field that is 1 within them and 0 outside. The occupancy is reconstructed by the B-spline,
 * and passes 1/2 at a smooth surface without the stairs of the voxels. */
#ifndef HL_LABEL_OCCUPANCY_H
#define HL_LABEL_OCCUPANCY_H

#include "core/pool.h"
#include "volume/volume.h"

/* A part of a map's grid: the box that holds some labels, with a margin for their smooth surface. */
typedef struct hl_label_part {
  size_t first[3], size[3]; /* first voxel and number of voxels along i, j and k; the size is 0 if no voxel
                             * has the label */
} hl_label_part;

/* Finds the parts of several labels in one pass over the map. labels: [count], rising. parts: [count];
 * receives the part of each label. */
hl_status hl_label_parts(hl_context *context, hl_pool *pool, const hl_volume *map, const int64_t *labels,
                         size_t count, hl_label_part *parts, hl_error *error);

/* The smallest part that holds several parts. Parts of size 0 do not count. */
hl_label_part hl_label_part_of_all(const hl_label_part *parts, size_t count);

/* The index of a voxel's label in a rising list of labels; `count` if the list lacks the label. */
size_t hl_label_place(const int64_t *labels, size_t count, const hl_volume *map, hl_number_row row, size_t i);

enum { HL_LABEL_STEPS = 6 }; /* the number of passes over the voxels that smooth a box around a label */

/* The work of smoothing labels, for reports of progress. */
typedef struct hl_label_work {
  const hl_context *context; /* its progress callback gets the fraction of the work that is done, as the stage
                              * "prepare" */
  double whole;              /* number of voxels of all boxes that are smoothed */
  double done;               /* number of voxels that passes have visited so far, each visit counted */
} hl_label_work;

size_t hl_label_part_voxels(const hl_label_part *part);

/* Adds the voxels of a box that have taken some steps to the work that is done, and reports the progress. */
void hl_label_worked(hl_label_work *work, size_t voxels, int steps);

/* Makes the occupancy of all labels of a list together, over their common part. labels: [count], rising.
 * *made is null if no voxel has one of the labels. The call takes seven and a half bytes of memory for each
 * voxel of the part, of which *made keeps one. work: the function reports the part's voxels to it. */
hl_status hl_label_occupancy(hl_context *context, hl_pool *pool, const hl_volume *map, const int64_t *labels,
                             size_t count, const hl_label_part *part, hl_label_work *work, hl_volume **made,
                             hl_error *error);

#endif
