/* shadow/shadow_lookup.h - looking up shadow buffers at samples: the map to their pixels, and the
 * transmittance. */
#ifndef HL_SHADOW_SHADOW_LOOKUP_H
#define HL_SHADOW_SHADOW_LOOKUP_H

#include "shadow/shadow_buffer.h"

/* The map from frame space to a buffer's pixels. */
typedef struct shadow_map {
  float rows[3][4]; /* frame space -> (w, w u, w v) of the buffer */
  size_t stride;    /* of its pixels' rows */
  int width, height;
} shadow_map;

typedef struct shadow_lookup {
  shadow_map map;
  const float *transmittance[HL_CHANNELS]; /* pixel (0,0) */
  const float
      *older[HL_CHANNELS]; /* pixel (0,0); null: none. The earlier transmittance, from which samples fade */
  float young;             /* how far samples have faded to `transmittance`, 0 to 1 */
} shadow_lookup;

/* Transmittance in units of 1 / SUBLIGHT_ONE, to halve the memory traffic of floats. */
typedef uint16_t sublight_pixel;
enum { SUBLIGHT_ONE = 65535 };

/* The buffer of one sub-light. */
typedef struct sublight_lookup {
  shadow_map map;
  const sublight_pixel *transmittance[HL_CHANNELS]; /* pixel (0,0) */
  float weight[HL_CHANNELS]; /* in the mean over all sub-lights; 1 for lights without an emission image */
} sublight_lookup;

/* The map of a view's pixels; the caller sets its stride. */
shadow_map hl_map_of_view(const view *view);

#endif
