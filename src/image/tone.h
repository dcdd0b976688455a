/* image/tone.h - how bright light fits into the range of a PNG. */
#ifndef HL_IMAGE_TONE_H
#define HL_IMAGE_TONE_H

#include <halflight/image.h>

/* The factor on light's red, green and blue. One factor serves all three, so that the hue stays. light:
 * linear, after the exposure. */
float hl_tone_factor(hl_tone tone, const float light[3]);

#endif
