/* render/maximum.h - makes maximum projections, pictures of the greatest value along each ray, in place of
 * pictures of lit matter.
 *
 * There is one sweep, without lights and with sheets parallel to the picture. For each pixel and visible
 * volume it keeps the greatest value that the volume's transfer function shows. Colours are looked up after
 * the sweep. */
#ifndef HL_RENDER_MAXIMUM_H
#define HL_RENDER_MAXIMUM_H

#include "render/sweep.h"

/* The greatest sheet spacing of a maximum projection, in voxels: the peak of a parabola through three
 * sheets then differs from the ray's greatest value by 0.2 % (root mean square, measured on noise with a
 * B-spline: tests/analytic/sheets_maximum.c). */
#define MAXIMUM_SPACING 0.5

/* Makes the projection's pixels and tables for the frame of a plan. If the scene uses another kind of
 * compositing, `values` stays null. Release the result in any case. */
hl_status hl_maximum_create(hl_context *context, hl_pool *pool, const frame_plan *plan,
                            maximum_values *maximum, hl_error *error);
void hl_maximum_release(hl_context *context, maximum_values *maximum);

/* Counts the memory that hl_maximum_create() takes. */
void hl_maximum_count(const frame_plan *plan, hl_layout *layout);

/* A sweep's tile action for a maximum projection, which replaces steps 12 to 16. */
uint32_t hl_maximum_tile(const sweep *sweep, const tile_slab *slab);

/* Takes the values of one visible volume from pixels in which a device has kept them, as the first of a
 * pixel's four numbers. Sets the pixels to 0. pixels: [tiles][16][R G B A][16]. */
void hl_maximum_take(const maximum_values *maximum, hl_pool *pool, float *pixels);

/* Makes the picture's pixels, [tiles][16][R G B A][16]. Each channel is the greatest among the colours of the
 * volumes, or the least one if the colours of all volumes begin bright. Alpha is 1 where any volume shows
 * something. */
void hl_maximum_color(const maximum_values *maximum, const frame_plan *plan, hl_pool *pool, float *pixels);

#endif
