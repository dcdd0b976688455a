/* halflight/layers.h - what a picture is made of, kept apart: lights, shadows, depth, normals.
 *
 * The sum of all lights' pictures, the ambient picture and the emission is the picture's RGB, up to rounding:
 * lights can be turned up, down and to other colours without rendering again. The other layers are means
 * along each ray, every sample weighted by what it adds to the picture's alpha (its opacity times what is
 * left of the ray); they are divided by alpha, not premultiplied. Top row first, like the picture. */
#ifndef HALFLIGHT_LAYERS_H
#define HALFLIGHT_LAYERS_H

#include "context.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The caller's buffers for the layers of one light. */
typedef struct hl_light_layers {
  float *picture; /* [height][width][3]; what the light adds to the linear premultiplied RGB; or null */
  float *shadow; /* [height][width][3]; mean part of the light, in R, G and B, that the volumes let through to
                    what is seen: 1 is full light; 1 too for lights and volumes without shadows; 0 where alpha
                    is 0; or null */
} hl_light_layers;

/* The caller's buffers; null where a layer is not wanted. They must not overlap. */
typedef struct hl_layers {
  size_t struct_size; /* set by the caller to sizeof(hl_layers) */
  float *ambient;     /* [height][width][3]; what ambient light adds to the linear premultiplied RGB */
  float *depth_first; /* [height][width]; where the ray's alpha first reaches 0.01; infinite where it never
                         does */
  float *depth_mean;  /* [height][width]; mean; infinite where alpha is 0 */
  float *normal; /* [height][width][3]; mean of the unit normals that the samples were lit with, in the world;
                    a medium has none and counts as 0; 0 where alpha is 0 */
  const hl_light_layers *lights; /* [light_count], in the order of the scene's lights; or null */
  size_t light_count;            /* the scene's; or 0 */
  float *emission; /* [height][width][3]; what volumes add to the linear premultiplied RGB without any light:
                      by their material's emission, or shaded flat */
} hl_layers;

/* Depths are world lengths along the pixel's ray: from the eye, or, orthographic, from the plane through the
 * camera's position (negative behind it). */

#ifdef __cplusplus
}
#endif
#endif
