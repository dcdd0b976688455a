/* shadow/shadow_lookup.h - what a sample needs to know of shadow buffers: where it is in them, and the light
 * that is left. */
#ifndef HL_SHADOW_SHADOW_LOOKUP_H
#define HL_SHADOW_SHADOW_LOOKUP_H

#include "shadow/shadow_buffer.h"

/* Where samples are in a buffer. */
typedef struct shadow_map {
  float rows[3][4]; /* frame space -> (w, w u, w v) of the buffer */
  size_t stride;    /* of its pixels' rows */
  int width, height;
} shadow_map;

typedef struct shadow_lookup {
  shadow_map map;
  const float *transmittance[HL_CHANNELS]; /* pixel (0,0) */
  const float
      *older[HL_CHANNELS]; /* pixel (0,0); null: none. The light that samples fade from, to transmittance */
  float young;             /* how far they have faded, 0 to 1 */
} shadow_lookup;

/* Transmittance in SUBLIGHT_ONEths: half as much memory to go through as floats. */
typedef uint16_t sublight_pixel;
enum { SUBLIGHT_ONE = 65535 };

/* The buffer of one sub-light. */
typedef struct sublight_lookup {
  shadow_map map;
  const sublight_pixel *transmittance[HL_CHANNELS]; /* pixel (0,0) */
  float weight[HL_CHANNELS]; /* in the mean over all sub-lights; 1 but for lights with an emission image */
} sublight_lookup;

/* Of a view; the stride is the caller's. */
shadow_map hl_map_of_view(const view *view);

#endif
