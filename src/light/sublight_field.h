/* light/sublight_field.h - compositing a slab, seen from the light's centre, into the buffer of one part of the light. */
#ifndef HL_LIGHT_SUBLIGHT_FIELD_H
#define HL_LIGHT_SUBLIGHT_FIELD_H

#include "light/attenuate.h"

typedef struct sublight_job {
  const float *slab[HL_CHANNELS];    /* the slab's transmittance; pixel (0,0); rows slab_stride apart; ones around it */
  size_t slab_stride;
  float slab_width, slab_height;     /* with ones further out, up to 32 pixels */
  float scale[2], shift[2];          /* continuous pixel coordinates u and v of the slab: scale * the part's + shift */
  float *transmittance[HL_CHANNELS]; /* pixel (0,0) of the part's buffer; rows stride apart */
  size_t stride;
  int channels;
} sublight_job;

/* Multiplies a tile by the slab; returns whether light is left in it. */
typedef int sublight_tile_function(const sublight_job *job, int tile_x, int tile_y);

#endif
