/* json/color_space.h - mixes two sRGB colours in the spaces that files of colour maps name. */
#ifndef HL_JSON_COLOR_SPACE_H
#define HL_JSON_COLOR_SPACE_H

typedef enum hl_color_space {
  HL_SPACE_RGB = 0,
  HL_SPACE_HSV = 1,       /* hues are mixed as numbers from 0 (red) over green and blue to 1 (red again) */
  HL_SPACE_LAB = 2,       /* CIELAB, white point D65 */
  HL_SPACE_DIVERGING = 3, /* Moreland's Msh; between colours of very different hues, the mixture passes
                           * through white */
  HL_SPACE_STEP = 4,      /* colours are not mixed: the second colour begins right after the first point,
                           * as in VTK */
  HL_SPACE_HSV_ARC = 5    /* hues are mixed along the shorter arc of the colour circle */
} hl_color_space;

/* Sets *mixed to the mixture of the colours a and b at t. The mixture is a if t is 0, and b if t is 1. All
 * colours are sRGB from 0 to 1. */
void hl_color_mix(hl_color_space space, const double a[3], const double b[3], double t, double mixed[3]);

#endif
