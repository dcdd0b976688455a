/* shadow_paper/paper.h - the paper's soft shadows (sections 5.1 and 5.2), kept faithful as the baseline.
 *
 * One accumulated buffer, convolved again and again with a box of the width that eq. (5) gives for the step
 * from the last convolved sheet to the next one, or with the light's own image at that width. Under
 * convolution variances add, not widths: the penumbra grows as the square root of distance. That is the
 * paper's method, and the error that others improve on. */
#ifndef HL_SHADOW_PAPER_PAPER_H
#define HL_SHADOW_PAPER_PAPER_H

#include "core/pool.h"
#include "light/light_image.h"
#include "shadow/blur.h"
#include "shadow/shadow_buffer.h"

typedef struct soft_paper {
  const light_image *image; /* null: boxes */
  bool parallel;
  double size;         /* L of the virtual light; parallel: L / Z */
  double light_height; /* of the light along the sheets' normal (not parallel) */
  double pixel;        /* buffer pixel: frame units; not parallel: at distance 1 */
  double last;         /* height of the last convolved sheet */
  double remainder;    /* accumulated width not yet convolved, pixels */
  int reach;           /* pixels beyond a tile that the buffer's margin lets blurs read */
} soft_paper;

/* first: height of the first sheet. image: of the light, null where it is even; its cells are placed here. */
void hl_soft_paper_begin(soft_paper *soft, const light_source *source, vec3 normal, double first,
                         const view *view, light_image *image);

/* Width in pixels of eq. (5) between two heights. */
double hl_soft_paper_width(const soft_paper *soft, double from, double to);

/* The greatest box that a sweep of these sheets can need, pixels. */
int hl_soft_paper_reach(soft_paper *soft, double first, double spacing, int sheets);

/* After a sheet's composite: convolves the buffer for the next sheet, at height next, if it is time to. */
void hl_soft_paper_convolve(soft_paper *soft, shadow_buffer *buffer, double next, hl_pool *pool,
                            const blur_functions *blur);

#endif
