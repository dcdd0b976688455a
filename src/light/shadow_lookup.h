/* light/shadow_lookup.h - what a sample needs to know of a shadow buffer: where it is in it, and the light that is left. */
#ifndef HL_LIGHT_SHADOW_LOOKUP_H
#define HL_LIGHT_SHADOW_LOOKUP_H

#include "light/shadow_buffer.h"

typedef struct shadow_lookup {
  float map[3][4];                /* frame space -> (w, w u, w v) of the buffer */
  const float *transmittance[HL_CHANNELS]; /* pixel (0,0); rows stride apart */
  float weight[HL_CHANNELS];      /* in the mean over several lookups; 1 but for lights with an image */
  size_t stride;
  int width, height;
} shadow_lookup;

/* Of a view; transmittance and stride are the caller's. */
shadow_lookup hl_lookup_of_view(const view *view);

#endif
