/* splat/coverage.h - how much of a sheet's slab along a ray lies inside a volume's box.
 *
 * A homogeneous box must be as thick as it is: counting sheets would round its depth to whole sheets.
 * So each ray keeps the heights at which it enters and leaves the box, and the slab between two sheets counts
 * with the part that lies in between (derived; exact for a homogeneous medium). */
#ifndef HL_SPLAT_COVERAGE_H
#define HL_SPLAT_COVERAGE_H

#include "splat/view.h"

/* Rays of a view in one grid's index space: start + s * direction, s > least, both linear in the pixel, and
 * heights above the first sheet: start_height + s * climb. */
typedef struct box_rays {
  float start[3], start_u[3], start_v[3];
  float direction[3], direction_u[3], direction_v[3];
  float start_height, start_height_u, start_height_v;
  float climb, climb_u, climb_v;
  float low[3], high[3]; /* the box, index space */
  float least;           /* of s: the eye of a perspective view */
} box_rays;

/* enter, leave: [256], block-major, one tile; heights above the first sheet. A ray that misses
 * has enter > leave. */
typedef void coverage_tile_function(const box_rays *rays, int tile_x, int tile_y, float *enter, float *leave);

void hl_box_rays(const view *view, vec3 normal, double first_height, affine3 frame_to_index,
                 const double low[3], const double high[3], box_rays *rays);

#endif
