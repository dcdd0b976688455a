/* halflight/layers.h - layers beside a picture: the share of each light and of the sky, shadows, depth,
 * normals, objects.
 *
 * The sum of all lights' pictures, the sky, the ambient picture and the emission is the picture's RGB, up
 * to rounding: a program can brighten, dim or colour lights afterwards, without rendering again. The other
 * layers are means along each ray, weighted by what each sample adds to the picture's alpha (its opacity
 * times the transmittance up to it). They are divided by alpha, not premultiplied. Top row first, like the
 * picture. */
#ifndef HALFLIGHT_LAYERS_H
#define HALFLIGHT_LAYERS_H

#include "context.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The caller's buffers for the layers of one light. */
typedef struct hl_light_layers {
  float *picture; /* [height][width][3]; what the light adds to the linear premultiplied RGB; or null */
  float *shadow;  /* [height][width][3]; mean transmittance in R, G and B from the light to the visible
                   * samples. 1 is full light; lights without shadows and volumes that receive none have 1;
                   * 0 where alpha is 0; or null */
} hl_light_layers;

/* The caller's buffers; null where a layer is not wanted. They must not overlap. */
typedef struct hl_layers {
  size_t struct_size; /* set by the caller to sizeof(hl_layers) */
  float *ambient;     /* [height][width][3]; what ambient light adds to the linear premultiplied RGB */
  float *depth_first; /* [height][width]; where the ray's alpha first reaches 0.01; infinite where it never
                         does */
  float *depth_mean;  /* [height][width]; mean; infinite where alpha is 0 */
  float *normal;      /* [height][width][3]; mean of the unit normals that the samples were lit with, in the
                       * world; a medium has no normal and counts as 0; 0 where alpha is 0 */
  const hl_light_layers *lights; /* [light_count], in the order of the scene's lights; or null */
  size_t light_count;            /* the scene's; or 0 */
  float *emission; /* [height][width][3]; what volumes and meshes add to the linear premultiplied RGB without
                      any light: by their material's emission, or because they are shaded flat */
  float *sky; /* [height][width][3]; what the sky adds to the linear premultiplied RGB; 0 without a sky */
  float *sky_shadow; /* [height][width][3]; what the sky would add in R, G and B if all matter were white,
                        divided by what it would add then if nothing hid it: ambient occlusion, 1 where
                        nothing is hidden; 0 where nothing would be added */
  float *object;     /* [height][width]; what the ray meets at depth_first: volume v of the scene is v + 1,
                      * mesh m volume_count + m + 1, an isosurface has the number of its volume; 0 where the
                      * ray meets nothing. Where the rays of one pixel meet several things, the pixel has the
                      * number that most rays meet */
} hl_layers;

/* A depth is a length along the pixel's ray, in world units. It begins at the eye, or for an orthographic
 * camera at the plane through the camera's position (negative behind this plane). */

#ifdef __cplusplus
}
#endif
#endif
