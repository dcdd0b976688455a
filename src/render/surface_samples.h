/* render/surface_samples.h - samples of surfaces that are lit together: the input and the result of the hot
 * function for surfaces. */
#ifndef HL_RENDER_SURFACE_SAMPLES_H
#define HL_RENDER_SURFACE_SAMPLES_H

#include "render/slab.h"

enum { SURFACE_SAMPLES = 16 };

/* Up to sixteen samples of one mesh in one slab. Unused samples repeat the first one. */
typedef struct surface_samples {
  _Alignas(64) float position[3][SURFACE_SAMPLES]; /* frame space */
  float normal[3][SURFACE_SAMPLES];                /* unit normal on the eye's side; if it is 0, the sample is
                                                    * black */
  float towards_eye[3][SURFACE_SAMPLES];           /* unit */
  float color[3][SURFACE_SAMPLES];                 /* linear RGB */
  float lit[3][SURFACE_SAMPLES];                   /* the result: the light that leaves each sample towards
                                                    * the eye */
  float ambient, diffuse, specular, shininess, emission; /* ka kd ks n ke */
  float even; /* the fraction of light that the material sends on evenly to all sides, from whatever angle the
               * light comes, as a medium does */
  float behind[3]; /* R, G, B: if light comes from behind the surface, this fraction of the light that `even`
                    * counts is sent on */
  int receives_shadow;
  /* [lights of the sweep][channels]; the fraction of light that passes the surfaces close before the samples
   * (late/); if null, all light passes. */
  const float (*contact)[SURFACE_SAMPLES];
} surface_samples;

#endif
