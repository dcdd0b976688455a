/* shadow_paper/paper.h - tells a device when the shadow buffer of a light is convolved, and by how much. */
#ifndef HL_SHADOW_PAPER_PAPER_H
#define HL_SHADOW_PAPER_PAPER_H

#include "shadow/shadow_method.h"

/* Finds the width, in pixels, of the box with which the buffer of a planned shadow is convolved at each
 * sheet. The light must not have an emission image. first: the first sheet at which the buffer may be
 * convolved. widths: [sheets]; 0 where the buffer is not convolved. */
void hl_paper_find_widths(const light_shadow *planned, int first, int32_t *widths);

/* The number of pixels to each side of a pixel that a convolution with a box of some width reads. */
int hl_paper_reach(int width);

#endif
